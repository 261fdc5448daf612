"""The mended adaptive fuzzy law inside its layer: functions that fall, or a course along which a deviation grows."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Place, Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.common_quadratic import unit_matrices
from wspd_design.certificates.search.matrix_inequalities import Inequalities
from wspd_design.certificates.setting.fuzzy_loop import (
    FILL,
    STATES,
    VENT,
    core_of,
    courses,
    layer_law,
    surface_row,
)
from wspd_design.certificates.setting.plant import complete
from wspd_design.certificates.theorems.fuzzy_sector.sector import (
    DIGITS,
    LONGEST,
    NAMES,
    both,
    corners_of,
    grows,
    pieces,
    write,
)
from wspd_design.certificates.theorems.fuzzy_sector.theorem import COURSES, FUZZY_SECTOR, LOOP
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

CONTRACTIONS = (0.9, 0.95, 0.97, 0.98, 0.99, 0.995, 0.999)  # that are asked for; the first that is met
SLACK = (
    1e-6  # by which c^2 P - A'PA has to be positive, P below 1: what is smaller may be rounding of the solver
)
SPEEDS = 25


def search(problem: Problem) -> Mapping[str, Stated]:
    """Look for a function in each piece of the speeds, and for places where deviations grow."""
    functions = _functions(problem)
    if functions is not None:
        return {COURSES: Stated(proof=write([(p.tolist(), contraction) for p, contraction in functions]))}
    loop, every = (_growing(problem, taken=taken) for taken in (True, False))
    return {LOOP: loop, COURSES: every}


def _functions(problem: Problem) -> list[tuple["Array", float]] | None:
    """P and contraction for each piece of the speeds, or None if one has none."""
    import numpy as np
    from flint import ctx

    found = []
    for piece in pieces(problem):
        with ctx.workprec(DIGITS):
            try:
                matrices = corners_of(problem, layer_law(core_of(problem), point), piece)
            except Refused:
                return None
        maps = np.array([[[float(each) for each in row] for row in matrix] for matrix in matrices])
        each = _function(maps)
        if each is None:
            return None
        found.append(each)
    return found


def _function(maps: "Array") -> "tuple[Array, float] | None":
    """P and the smallest of the contractions for which c^2 P - A'PA is positive definite at all corners."""
    import numpy as np

    units = unit_matrices(STATES)
    margin, one = len(units), np.eye(STATES)
    for contraction in CONTRACTIONS:
        asked = Inequalities(margin + 1)
        for each in maps:
            falls = [(k, contraction**2 * unit - each.T @ unit @ each) for k, unit in enumerate(units)]
            asked.semidefinite(np.zeros((STATES, STATES)), [*falls, (margin, -one)])
        asked.semidefinite(one, [(k, -unit) for k, unit in enumerate(units)])
        solved = asked.minimize(-np.eye(margin + 1)[margin])
        if solved is not None and solved[margin] > SLACK:
            return np.tensordot(solved[:margin], units, 1), contraction
    return None


def _growing(problem: Problem, *, taken: bool) -> Stated:
    """Return the first place, nominal numbers before corners of the box, where a deviation grows."""
    for at in _places(problem):
        if not _may_grow(problem, at, taken=taken):
            continue
        try:
            grows(problem, at, Work(), taken=taken)
        except Refused:
            continue
        return Stated(place=at)
    return Stated()


def _places(problem: Problem) -> Iterator[Place]:
    """Yield the nominal numbers, then the corners of the box, at the ends of the speeds and between them."""
    low, high = problem.speeds
    boxed = (
        {name: problem.span(name)[end] for name, end in zip(NAMES, ends, strict=True)}
        for ends in product((1, 0), repeat=len(NAMES))
    )
    for each in chain([_nominal(problem)], boxed):
        for speed in (low, (low * high) ** 0.5, high):
            yield {**each, "speed": speed}


def _nominal(problem: Problem) -> dict[str, float]:
    return {name: problem.nominal(name) for name in NAMES}


def _may_grow(problem: Problem, at: Place, *, taken: bool) -> bool:
    """Whether doubles find a course along which a deviation grows."""
    found = _matrices(problem, at)
    return found is not None and any(
        _growth(problem, found, each, taken=taken) > 1.0 for each in courses(LONGEST)
    )


def _matrices(problem: Problem, at: Place) -> "tuple[Array, Array] | None":
    import numpy as np

    try:
        fills, vents = both(
            problem, layer_law(core_of(problem)), complete(problem, {"slip": problem.slip, **at})
        )
    except Refused:
        return None
    return np.array(fills, dtype=float), np.array(vents, dtype=float)


def _growth(
    problem: Problem, matrices: "tuple[Array, Array]", course: Sequence[int], *, taken: bool
) -> float:
    """Growth of a deviation over a course; of one that takes it by the sign of its surface, if that is asked."""
    import numpy as np

    product = np.eye(STATES)
    for valve in course:
        product = matrices[valve] @ product
    values, vectors = np.linalg.eig(product)
    if not taken:
        return float(np.abs(values).max())
    largest = 0.0
    for value, vector in zip(values, vectors.T, strict=True):
        if abs(value.imag) > 0.0 or value.real <= largest:
            continue
        row, x = np.array(surface_row(layer_law(core_of(problem)))), vector.real
        signs = []
        for valve in course:
            signs.append(np.sign(row @ x) * (1.0 if valve == FILL else -1.0))
            x = matrices[valve] @ x
        if abs(sum(signs)) == len(course):
            largest = float(value.real)
    return largest


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - samples of the nominal loop
    """What a deviation keeps per sample while the valve fills and while it vents, and how far both are apart."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    found = [(speed, _matrices(problem, {**_nominal(problem), "speed": float(speed)})) for speed in speeds]
    known = [(speed, each) for speed, each in found if each is not None]
    if len(known) < 2:
        return Figures()
    at = np.array([speed for speed, _ in known]) * KMH
    axes = ("speed [km/h]", "magnitude of the largest eigenvalue [-]")
    return Figures(
        series=(
            *(
                series(
                    name,
                    *axes,
                    at,
                    np.array([np.abs(np.linalg.eigvals(each[valve])).max() for _, each in known]),
                )
                for name, valve in (("while it fills", FILL), ("while it vents", VENT))
            ),
            level("limit", *axes, at, 1.0),
        ),
        remark="Of one sample inside the layer with the nominal numbers; both alone below 1 do not show that a course "
        "of both dies out.",
    )


CHECK = Check(theorem=FUZZY_SECTOR, search=search, figures=figures)
