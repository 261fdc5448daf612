"""Version of the program, which every object carries."""

from importlib.metadata import version


def program_version() -> str:
    """Return the version of the installed program."""
    return version("wspd-design")
