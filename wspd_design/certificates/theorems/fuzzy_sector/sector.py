"""Small deviations inside the layer: a function that falls however the valve fills and vents, or a course that grows.

The speeds are covered by pieces. For each the proof states P > 0 and a contraction c < 1; c^2 P - A'PA has to be
positive definite at all corners of the numbers of a sample, enclosed for the whole box. A place is refuted by a course
of filling and venting along which deviations grow. If the surface has the sign that each step of the course asks for,
the loop itself takes it.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from math import ceil, isfinite, log
from typing import Any, NamedTuple

from wspd_design.certificates.kernel.arb import Ball, above, ball, below, point
from wspd_design.certificates.kernel.checker import Refused, Work, number
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.fuzzy_loop import (
    FILL,
    STATES,
    Course,
    LayerLaw,
    Matrix,
    core_of,
    corners,
    courses,
    layer_law,
    sample,
    surface_row,
)
from wspd_design.certificates.setting.plant import complete, plant_forces
from wspd_design.certificates.theorems.equilibrium import holding_torque
from wspd_design.certificates.theorems.slip_band.checker import is_positive
from wspd_design.model.number import Number, exp
from wspd_design.parameters.bounds import Ends

FORMAT = "wspd-fuzzy-sector/1"
DIGITS = 128  # bits of the balls
WORK = 20_000  # operations on intervals that a piece, or a course, is worth
PIECE = 1.05  # ratio of the speeds of a piece
LONGEST = 6  # samples of a course
MOST_LETTERS = 60  # of a number in the proof
ENTRIES = [(i, j) for i in range(STATES) for j in range(i + 1)]
NAMES = ("mass", "wheelset inertia", "mu0", "max torque", "fill time", "vent time")
"""Numbers that do not change during a stop, and have ranges."""


class Reference(NamedTuple):
    """The plant at the slip reference."""

    slope: Number  # 1/s, q in e' = q e - W
    rates: tuple[Number, Number]  # m/s3, at which W changes while the valve fills, and while it vents
    held: Number  # N m, torque that holds the reference
    room: Number  # N m, what is left to the full torque


def reference_of(problem: Problem, radius: Number, values: Mapping[str, Number]) -> Reference:
    """Return the plant at the reference, for all numbers of vehicle, rail and brake, slip and speed.

    Parameters
    ----------
    problem : Problem
        Vehicle and rail.
    radius : Number
        That the law counts with [m].
    values : mapping of str to Number
        By name.
    """
    plant = plant_forces(problem, values)
    held = holding_torque(plant, values, "")
    room = values["max torque"] - held
    per_torque = radius / values["wheelset inertia"]
    return Reference(
        slope=plant.pole - plant.deceleration / values["speed"],
        rates=(per_torque * room / values["fill time"], per_torque * held / values["vent time"]),
        held=held,
        room=room,
    )


def place_ranges(problem: Problem) -> dict[str, Ends]:
    """Coordinates of a place, with their ranges: the numbers of the box and the speed [SI units]."""
    return {name: problem.span(name) for name in NAMES} | {"speed": problem.speeds}


def pieces(problem: Problem) -> list[tuple[float, float]]:
    """Pieces of the range of speed [m/s]."""
    low, high = problem.speeds
    count = ceil(log(high / low) / log(PIECE))
    edges = [low * (high / low) ** (k / count) for k in range(count)] + [high]
    return list(pairwise(edges))


def box(problem: Problem, piece: tuple[float, float]) -> dict[str, Ball]:
    """Return all numbers in balls: those that vary over their range, in a piece of the speeds."""
    values = {
        "slip": point(problem.slip),
        "speed": ball(*map(Fraction, piece)),
        **{name: ball(*map(Fraction, problem.span(name))) for name in NAMES},
    }
    return {
        name: point(each) if isinstance(each, float) else each
        for name, each in complete(problem, values).items()
    }


def corners_of(problem: Problem, law: LayerLaw, piece: tuple[float, float]) -> list[Matrix]:
    """Return A at the corners of the numbers of a sample in a piece of the speeds, or refuse."""
    at = reference_of(problem, law.radius, box(problem, piece))
    if not at.held > 0 or not at.room > 0:
        raise Refused("the brake may not be able to hold the reference")
    ends = below(at.slope), above(at.slope)
    if not all(isfinite(end) and end != 0.0 for end in ends):
        raise Refused("the slope of the friction is not bounded, or 0 at an end")
    slopes = [point(end) for end in ends]
    rates = [point(Fraction(min(map(below, at.rates)))), point(Fraction(max(map(above, at.rates))))]
    h = law.sample_time
    return list(corners(law, [(q * h).exp() for q in slopes], [(q * h).expm1() / q for q in slopes], rates))


def write(functions: Sequence[tuple[Sequence[Sequence[float]], float]]) -> dict[str, Any]:
    """Write the matrix P and the contraction of each piece as JSON."""
    return {
        "format": FORMAT,
        "pieces": [
            [text(Fraction(each)) for each in (*(p[i][j] for i, j in ENTRIES), contraction)]
            for p, contraction in functions
        ],
    }


def falls(problem: Problem, proof: Mapping[str, Any], work: Work) -> dict[str, float]:
    """Decide whether the functions of a proof fall along every course; tell the largest contraction."""
    from flint import ctx

    spans = pieces(problem)
    if proof.keys() != {"format", "pieces"} or proof["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    if not isinstance(proof["pieces"], list) or len(proof["pieces"]) != len(spans):
        raise Refused(f"the proof does not have one function for each of {len(spans)} pieces of the speeds")
    slowest = Fraction(0)
    with ctx.workprec(DIGITS):
        law = layer_law(core_of(problem), point)
        for piece, written in zip(spans, proof["pieces"], strict=True):
            work.spend(WORK)
            p, contraction = _function(written)
            if not 0 < contraction < 1 or not is_positive(p):
                raise Refused("a matrix P is not positive definite, or a contraction not between 0 and 1")
            for a in corners_of(problem, law, piece):
                if not is_positive(_left_over(p, a, point(contraction))):
                    raise Refused("a function may not fall along a sample")
            slowest = max(slowest, contraction)
    return {"contraction": above(point(slowest))}


def _function(written: object) -> tuple[list[list[Ball]], Fraction]:
    if not isinstance(written, list) or len(written) != len(ENTRIES) + 1:
        raise Refused("a function lacks numbers")
    if any(len(str(each)) > MOST_LETTERS for each in written):
        raise Refused(f"a number of the proof has more than {MOST_LETTERS} letters")
    *numbers, contraction = (number(each) for each in written)
    entries = dict(zip(ENTRIES, numbers, strict=True))
    p = [[point(entries[max(i, j), min(i, j)]) for j in range(STATES)] for i in range(STATES)]
    return p, contraction


def _left_over(p: Sequence[Sequence[Ball]], a: Matrix, contraction: Ball) -> list[list[Ball]]:
    """c^2 P - A'PA."""
    span = range(STATES)
    pa = [[sum((p[i][k] * a[k][j] for k in span), point(0)) for j in span] for i in span]
    return [
        [contraction**2 * p[i][j] - sum((a[k][i] * pa[k][j] for k in span), point(0)) for j in span]
        for i in span
    ]


def both(problem: Problem, law: LayerLaw, values: Mapping[str, Number]) -> tuple[Matrix, Matrix]:
    """Return A while the valve fills, and while it vents, with numbers that are known, or refuse."""
    at = reference_of(problem, law.radius, values)
    if not at.held > 0 or not at.room > 0:
        raise Refused("the brake cannot hold the reference there")
    phi = exp(at.slope * law.sample_time)
    psi = (phi - 1.0) / at.slope
    fills, vents = (sample(law, phi, psi, rate) for rate in at.rates)
    return fills, vents


def grows(problem: Problem, place: Place, work: Work, *, taken: bool) -> dict[str, float]:
    """Tell the course of filling and venting along which deviations grow most at a place, or refuse.

    Parameters
    ----------
    problem : Problem
        Closed loop.
    place : mapping of str to float
        Speed and numbers of the box.
    work : Work
        To be spent.
    taken : bool
        Whether the loop itself has to take the course, by the sign of its surface.
    """
    from flint import ctx

    best: tuple[float, Course] | None = None
    with ctx.workprec(DIGITS):
        law = layer_law(core_of(problem), point)
        values = complete(problem, {"slip": problem.slip, **place})
        matrices = both(problem, law, {name: point(float(each)) for name, each in values.items()})
        for course in courses(LONGEST):
            work.spend(WORK)
            growth = _growth(law, matrices, course, taken=taken)
            if growth > 1.0 and (best is None or growth > best[0]):
                best = growth, course
    if best is None:
        raise Refused("no deviation was found to grow at this place")
    return {"growth": best[0], "samples": float(len(best[1])), "course": coded(best[1])}


def _growth(law: LayerLaw, matrices: tuple[Matrix, Matrix], course: Course, *, taken: bool) -> float:
    """Lower bound of the growth of a deviation per sample along a course; 0 if none is found."""
    from flint import acb_mat, arb_mat

    steps = [arb_mat([list(row) for row in matrices[each]]) for each in course]
    product = steps[0]
    for step in steps[1:]:
        product = step * product
    try:
        values, vectors = acb_mat(product).eig(right=True)
    except ValueError:
        return 0.0
    found = [below(abs(value)) for value in values]
    if taken:
        found = [
            size
            for k, size in enumerate(found)
            if _is_real(values, k)
            and values[k].real > 0
            and _takes(law, steps, course, [vectors[i, k] for i in range(STATES)])
        ]
    largest = max(found, default=0.0)
    return below(point(largest) ** (point(1) / len(course))) if largest > 1.0 else 0.0


def _is_real(values: Sequence[Any], k: int) -> bool:
    """Whether an eigenvalue that is enclosed apart from the others is real: its conjugate is one as well."""
    mirrored = values[k].conjugate()
    return not any(mirrored.overlaps(each) for i, each in enumerate(values) if i != k)


def _takes(law: LayerLaw, steps: Sequence[Any], course: Course, vector: Sequence[Any]) -> bool:
    """Whether a deviation along a real eigenvector, or its opposite, has the surface that each step asks for."""
    from flint import arb_mat

    largest = max(vector, key=lambda each: below(abs(each)))
    if not below(abs(largest)) > 0.0:
        return False
    row = surface_row(law)
    signs = []
    x = arb_mat([[(each / largest).real] for each in vector])
    for step, valve in zip(steps, course, strict=True):
        surface = sum((a * x[i, 0] for i, a in enumerate(row)), point(0))
        asked = 1 if valve == FILL else -1
        signs.append(asked if surface > 0 else -asked if surface < 0 else 0)
        x = step * x
    return all(each == 1 for each in signs) or all(each == -1 for each in signs)


def one_valve(coded_course: float) -> int | None:
    """Return the valve that a course opens all the time, or none if it changes."""
    digits = set(f"{int(coded_course):b}"[1:])
    return int(digits.pop()) if len(digits) == 1 else None


def coded(course: Course) -> float:
    """Return a course as a number: binary digits behind a leading one."""
    return float(int("1" + "".join(map(str, course)), 2))


def in_words(coded_course: float) -> str:
    """Say a course."""
    digits = f"{int(coded_course):b}"[1:]
    return ", ".join("fill" if int(each) == FILL else "vent" for each in digits)
