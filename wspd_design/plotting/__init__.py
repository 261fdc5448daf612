"""Plots of single records on axes that are given or new; nothing is shown or saved here."""
