"""The domain of a claim: the range of each quantity of the table, in numbers and in words."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, cast

from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import AXLE, QUANTITIES, STATE
from wspd_design.certificates.records import SHOWN as SHOWN
from wspd_design.certificates.records import Domain, Interval, Point, Problem
from wspd_design.certificates.setting import axle
from wspd_design.controllers.protocol import Law
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.units import KMH as KMH

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

BASIC = ("slip", "speed", "mass", "wheelset inertia", "mu0")
"""Quantities that every map and sampled point has; more can be named."""

PARAMETERS = BASIC[2:]

SLIP, SPEED, MASS, INERTIA, MU0 = range(5)
"""Columns of an array of points of :data:`BASIC`, in SI units; the inertia is that of a wheelset."""


def span(problem: Problem, name: str) -> Ends:
    """Range of a quantity on the domain, in SI units; one without bounds is known.

    The axle load share and the train deceleration have the ranges that the problem states for them, or those that
    follow from the load transfer of the vehicle.

    Raises
    ------
    OutsideModel
        If the load transfer has no range in which all wheels stay on the rail.
    """
    if name in AXLE and name not in problem.bounds:
        return _axle_span(name, replace(problem, controller=cast(Law, None)))
    return problem.span(name)


@lru_cache(maxsize=64)
def _axle_span(name: str, lawless: Problem) -> Ends:
    """Work out a range that many claims of a problem share; it does not depend on the law."""
    return axle.load_share(lawless) if name == AXLE[0] else axle.deceleration(lawless)


def uncertain(problem: Problem) -> tuple[str, ...]:
    """Names of all numbers that vary on the domain, in the order of the table; slip and speed are not numbers."""
    return tuple(
        name for name in QUANTITIES if name not in STATE and (name in AXLE or _wide(problem.span(name)))
    )


def not_varied(problem: Problem, names: Iterable[str]) -> tuple[str, ...]:
    """Return the numbers with a range that are not among ``names``, in the order of the table."""
    varied = set(names)
    return tuple(name for name in uncertain(problem) if name not in varied)


def box(problem: Problem, names: Sequence[str] = BASIC) -> tuple["Array", "Array"]:
    """Lowest and highest corner of the domain, in the order of the names.

    Raises
    ------
    OutsideModel
        If the box holds a speed, mass, inertia or friction that is not positive, or any value without meaning.
    """
    import numpy as np

    ranges = {name: span(problem, name) for name in names}
    for name, (low, high) in ranges.items():
        if low < 0.0 or (low == 0.0 and QUANTITIES[name].positive):
            kind = "not positive" if QUANTITIES[name].positive else "negative"
            raise OutsideModel(f"the {name} range {low:g} to {high:g} holds values that are {kind}")
    return np.array([low for low, _ in ranges.values()]), np.array([high for _, high in ranges.values()])


def slip_held(problem: Problem, names: Sequence[str] = BASIC) -> tuple["Array", "Array"]:
    """Return the domain with the slip at its reference."""
    low, high = box(problem, names)
    column = names.index("slip")
    low[column] = high[column] = problem.slip
    return low, high


def readable(point: "Array", names: Sequence[str] = BASIC) -> tuple[Point, ...]:
    """One point of the domain in the units that people read."""
    found = []
    for name, value in zip(names, point, strict=True):
        factor, unit = SHOWN.get(QUANTITIES[name].unit, (1.0, QUANTITIES[name].unit))
        found.append(Point(name=name, value=float(value) * factor, unit=unit))
    return tuple(found)


def domain_of(problem: Problem, names: Iterable[str] = BASIC, held: Iterable[str] = ()) -> Domain:
    """Return the domain of a claim.

    Parameters
    ----------
    problem : Problem
        Domain.
    names : iterable of str
        Quantities that vary; those that are exactly known are left out.
    held : iterable of str
        Quantities with a range that the claim depends on and does not vary: they stand at their nominal values.
    """
    spans = {name: span(problem, name) for name in names}
    return Domain(
        varied=tuple(_interval(name, ends) for name, ends in spans.items() if name in STATE or _wide(ends)),
        held=tuple(_interval(name, 2 * (problem.nominal(name),)) for name in held),
    )


def _interval(name: str, ends: Ends) -> Interval:
    return Interval(name=name, low=ends[0], high=ends[1], unit=QUANTITIES[name].unit)


def _wide(ends: Ends) -> bool:
    return ends[0] < ends[1]
