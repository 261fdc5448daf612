"""Sections of the page about the paper: Section 7, computed again."""
