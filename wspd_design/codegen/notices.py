"""What a user is told once: that this machine is slower than it could be, and why."""

import warnings

_told: set[str] = set()


def tell_once(reason: str, consequence: str) -> None:
    """Warn of a reason the first time it comes up; later consequences of the same reason say nothing new."""
    if reason not in _told:
        _told.add(reason)
        warnings.warn(f"{reason}; {consequence}", stacklevel=5)
