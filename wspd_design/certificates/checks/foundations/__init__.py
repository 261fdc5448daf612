"""Checks of the model itself: equations, signs, existence."""
