"""Checks of the sliding surface: existence, reaching, boundary layer."""
