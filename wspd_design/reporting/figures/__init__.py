"""Figures of the report: each function draws records on a figure that it is given, and returns it."""
