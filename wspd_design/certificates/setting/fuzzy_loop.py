"""The sampled loop of the mended adaptive fuzzy law inside its layer: what one sample makes of a small deviation.

The state x = (e, e before, filtered e', W) and the map stand in :mod:`derivations.fuzzy_loop`. The map is linear while
the valve fills, and another linear one while it vents; both differ in the authority of the valve alone. It is affine in
each of phi, psi and the authority, so that corners of their ranges decide about all values in between.

Written for every number type: doubles search, balls prove.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import NamedTuple, TypeAlias

from wspd_design.certificates.records import Problem
from wspd_design.controllers.fuzzy_surface import FuzzySurface, FuzzySurfaceGains
from wspd_design.controllers.protection import Protection
from wspd_design.model.generated import fuzzy_loop as generated
from wspd_design.model.number import Number, exp

Matrix: TypeAlias = tuple[tuple[Number, ...], ...]
Course: TypeAlias = tuple[int, ...]
"""Which valve a sample opens, over and over: 0 fills, 1 vents."""

STATES = 4
FILL, VENT = 0, 1


class LayerLaw(NamedTuple):
    """Numbers of the law inside its layer, where psi and the weights have faded."""

    sample_time: Number  # s
    radius: Number  # m, that the law counts with
    surface_rate: Number  # 1/s
    new: Number  # -, share of the newest difference in the filtered rate
    command: Number  # s2/m, command for one unit of the surface


def core_of(problem: Problem) -> FuzzySurface:
    """Return the law of a wheelset of a protection that is the mended adaptive fuzzy law."""
    law = problem.controller
    assert isinstance(law, Protection)
    assert isinstance(law.core, FuzzySurface)
    return law.core


def layer_law(core: FuzzySurface, number: Callable[[float], Number] = float) -> LayerLaw:
    """Numbers of the law; in balls if ``number`` makes these of doubles."""
    gains: FuzzySurfaceGains = core.gains
    h = number(core.sample_time)
    return LayerLaw(
        sample_time=h,
        radius=number(core.wheel_radius),
        surface_rate=number(gains.surface_rate),
        new=1.0 - exp(-h / number(gains.rate_filter)),
        command=number(gains.initial_bound) / number(gains.layer),
    )


def sample(law: LayerLaw, phi: Number, psi: Number, rate: Number) -> Matrix:
    """Return A of x+ = A x; ``rate`` is that of W while the valve is open [m/s3]."""
    columns = []
    for j in range(STATES):
        e, before, filtered, w = (float(i == j) for i in range(STATES))
        gain = rate * law.sample_time * law.command
        columns.append(
            generated.next_sample(
                e, before, filtered, w, phi, psi, gain, law.new, law.surface_rate, law.sample_time
            )
        )
    return tuple(zip(*columns, strict=True))


def corners(
    law: LayerLaw, phis: Sequence[Number], psis: Sequence[Number], rates: Sequence[Number]
) -> Iterator[Matrix]:
    """Return A at all corners of the numbers of a sample."""
    for phi, psi, rate in product(phis, psis, rates):
        yield sample(law, phi, psi, rate)


def surface_row(law: LayerLaw) -> tuple[Number, ...]:
    """Return the row that gives the surface from the state."""
    units = [[float(i == j) for i in range(STATES)] for j in range(STATES)]
    return tuple(
        generated.surface(e, before, rate, law.new, law.surface_rate, law.sample_time)
        for e, before, rate, _ in units
    )


def courses(longest: int) -> tuple[Course, ...]:
    """Return all courses of filling and venting up to a length, each from one beginning and run through once."""
    found = []
    for length in range(1, longest + 1):
        for course in product((FILL, VENT), repeat=length):
            turned = [course[k:] + course[:k] for k in range(1, length)]
            if all(course < each for each in turned):
                found.append(course)
    return tuple(found)
