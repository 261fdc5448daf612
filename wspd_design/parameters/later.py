"""What stands higher in the house, loaded when it is first used.

Imports go only upwards. A record shows itself all the same: its methods ``plot``, ``table`` and the like hand it to the
room that does so, which is named here by its module and loaded by the call. A test holds that each of these names
exists.
"""

from importlib import import_module
from typing import Any


def later(module: str, name: str) -> Any:
    """Return a function by its module within the package and its name.

    Parameters
    ----------
    module : str
        Such as ``plotting.stops``.
    name : str
        Of the function.
    """
    return getattr(import_module(f"wspd_design.{module}"), name)
