"""Outlines of invariant sets for the plot beside the verdict."""

from collections.abc import Sequence

from wspd_design.certificates.checks.frame import level, series
from wspd_design.certificates.records import Problem, Role, Series
from wspd_design.certificates.search.invariant_sets.search import Found
from wspd_design.parameters.units import KMH

OUTLINES = 5  # sets that the plot shows
AXES = ("slip [-]", "braking torque [kN m]")


def outlines(problem: Problem, found: Sequence[Found], kind: str) -> tuple[Series, ...]:
    """Outlines of a few sets in slip and torque [kN m], the fastest last, beside reference and full torque.

    Parameters
    ----------
    problem : Problem
        Reference and brake.
    found : sequence of Found
        Sets, the slowest first; there may be none.
    kind : str
        What they are; each is also named by its speed.
    """
    import numpy as np

    if not found:
        return ()
    step = -(-len(found) // OUTLINES)
    sets = tuple(_outline(problem, each, kind) for each in found[::-step][::-1])
    full = problem.vehicle.brake.max_torque / 1e3
    slips = [slip for each in sets for slip in each.x]
    return (
        *sets,
        series("reference", *AXES, np.array([problem.slip] * 2), np.array([0.0, full]), Role.LIMIT),
        level("full torque", *AXES, (min(slips), max(slips)), full),
    )


def _outline(problem: Problem, found: Found, kind: str) -> Series:
    """Lower edge of a set from small to large slip, and its upper edge back."""
    import numpy as np

    cells, full = found.cells, problem.vehicle.brake.max_torque / 1e3
    rows = np.flatnonzero(found.states.any(axis=1))
    columns = [np.flatnonzero(found.states[row]) for row in rows]
    middle = (rows + cells.first[0] + 0.5) / cells.per_unit
    held = cells.window.tilt * (middle - problem.slip)
    lowest = (np.array([each[0] for each in columns]) + cells.first[1]) / cells.per_unit
    highest = (np.array([each[-1] + 1 for each in columns]) + cells.first[1]) / cells.per_unit
    lower, upper = (full * np.clip(edge - held, 0.0, 1.0) for edge in (lowest, highest))
    x = np.concatenate([middle, middle[::-1], middle[:1]])
    y = np.concatenate([lower, upper[::-1], lower[:1]])
    return series(f"{kind} at {cells.window.high * KMH:.3g} km/h", *AXES, x, y, Role.OUTLINE)
