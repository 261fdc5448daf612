"""Executable SymPy mathematics of the paper: one claim per file, printed form beside corrected form."""
