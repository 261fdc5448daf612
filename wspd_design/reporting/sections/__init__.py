"""Sections of the report: each turns the records of a dossier into blocks, and computes nothing."""
