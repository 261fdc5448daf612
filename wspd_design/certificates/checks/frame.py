"""What all checks share: fingerprint of the model, time, plots, and what to do outside the model."""

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from fractions import Fraction
from functools import wraps
from math import inf, nextafter
from typing import TYPE_CHECKING, Any, TypeAlias

from wspd_design.certificates.records import Certificate, Problem, Range, Series, Status
from wspd_design.parameters.errors import UserError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Check: TypeAlias = Callable[[Problem], Certificate]

MOST_PLOT_POINTS = 500


class OutsideModel(UserError):
    """The claim cannot be examined, because the model does not hold there."""


def certified(*, name: str, title: str) -> Callable[[Check], Check]:
    """Complete what a check returns by the fingerprint of its model and the time that it took.

    A check that finds no ground to stand on raises :class:`OutsideModel`; the claim is then undecided.
    """

    def decorate(check: Check) -> Check:
        @wraps(check)
        def timed(problem: Problem) -> Certificate:
            started = time.perf_counter()
            try:
                certificate = check(problem)
            except OutsideModel as reason:
                certificate = Certificate(
                    name=name,
                    title=title,
                    claim=f"The check found no ground to stand on: {reason}.",
                    status=Status.UNDECIDED,
                    explanation="Nothing was examined, so nothing is known.",
                    method="none",
                )
            seconds = time.perf_counter() - started
            return replace(
                certificate, name=name, title=title, model_hash=model_hash(problem), seconds=seconds
            )

        return timed

    return decorate


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


def enclosure(low: Fraction, high: Fraction, unit: str) -> Range:
    """Enclose exact numbers by floats, rounded outwards."""
    below, above = float(low), float(high)
    return Range(
        low=below if Fraction(below) <= low else nextafter(below, -inf),
        high=above if Fraction(above) >= high else nextafter(above, inf),
        unit=unit,
    )


def series(
    name: str, x_label: str, y_label: str, x: "NDArray[np.float64]", y: "NDArray[np.float64]"
) -> Series:
    """Keep as many samples of a curve as a plot can show."""
    step = max(1, -(-len(x) // MOST_PLOT_POINTS))
    keep = [*range(0, len(x) - 1, step), len(x) - 1]
    return Series(
        name=name,
        x_label=x_label,
        y_label=y_label,
        x=tuple(float(x[i]) for i in keep),
        y=tuple(float(y[i]) for i in keep),
    )


def level(
    name: str, x_label: str, y_label: str, x: "NDArray[np.float64] | Sequence[float]", value: float
) -> Series:
    """Return a horizontal line, the limit that a curve must respect."""
    return Series(
        name=name, x_label=x_label, y_label=y_label, x=(float(x[0]), float(x[-1])), y=(value, value)
    )
