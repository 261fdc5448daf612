"""Checks of whole stops: tracking and the shortest stop."""
