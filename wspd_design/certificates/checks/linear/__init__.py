"""Checks of the loop near its reference: Routh's conditions and margins."""
