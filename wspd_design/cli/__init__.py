"""The command ``wspd``: it reads words, calls the package and shows the records that come back."""

from wspd_design.cli.app import main

__all__ = ["main"]
