"""Checks of what the valve leaves possible: poles, limits, sampling."""
