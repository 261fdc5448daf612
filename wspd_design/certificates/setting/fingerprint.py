"""Fingerprint of all that a verdict rests on."""

import hashlib
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

from wspd_design.certificates.records import Problem


def model_hash(problem: Problem) -> str:
    """Return the SHA-256 of all numbers that a verdict rests on."""
    return hashlib.sha256(_canonical(problem).encode()).hexdigest()


def _canonical(value: Any) -> str:
    """Text that is the same for the same numbers, whatever the run."""
    if is_dataclass(value) and not isinstance(value, type):
        inside = ",".join(f"{field.name}={_canonical(getattr(value, field.name))}" for field in fields(value))
        return f"{type(value).__qualname__}({inside})"
    if isinstance(value, Enum):
        return f"{type(value).__qualname__}.{value.name}"
    if isinstance(value, tuple):
        return "(" + ",".join(_canonical(item) for item in value) + ")"
    if isinstance(value, float):
        return float(value).hex()
    if value is None or isinstance(value, (bool, int, str)):
        return repr(value)
    # A user's own controller may hold anything; its class and public numbers identify it.
    public = sorted((key, item) for key, item in vars(value).items() if isinstance(item, (int, float, str)))
    return f"{type(value).__module__}.{type(value).__qualname__}({public!r})"
