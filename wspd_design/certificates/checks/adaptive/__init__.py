"""Checks of the adaptive fuzzy law: Lyapunov functions and Barbalat's lemma."""
