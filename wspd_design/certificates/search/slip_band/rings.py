"""Search for a ring: an ellipsoid that is as large as limits allow, and leads far inwards."""

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.search.common_quadratic import unit_matrices
from wspd_design.certificates.search.matrix_inequalities import Inequalities
from wspd_design.certificates.search.slip_band.ellipsoids import (
    CROSS,
    FIRST,
    FIRST_CORNERS,
    LEAST,
    MORE_CORNERS,
    ROUNDS,
    SECOND,
    SLACK,
    _left,
    _reached,
    _rounded,
)
from wspd_design.certificates.search.slip_band.task import Task, centered, task_of
from wspd_design.certificates.setting.slip_loop import STATES
from wspd_design.certificates.theorems.from_rolling.ring import scaled
from wspd_design.certificates.theorems.slip_band.loop import Loop
from wspd_design.certificates.theorems.slip_band.proof import Choice, Ellipsoid
from wspd_design.certificates.theorems.slip_band.statement import BandLaw

if TYPE_CHECKING:
    from collections.abc import Sequence

    from wspd_design.certificates.search.matrix_inequalities import Array


def ring(
    law: BandLaw,
    loop: Loop,
    choice: Choice,
    supply: Fraction,
    kept: float,
    added: float,
    around: "Sequence[float]",
) -> tuple[Ellipsoid, float] | None:
    """Find an ellipsoid that holds as large a multiple as possible of one with some half axes, and return both.

    Parameters
    ----------
    law, loop, choice, supply : BandLaw, Loop, Choice, Fraction
        Numbers of law, cell and window, and what they were made for.
    kept, added : float
        alpha of the ring, and what all shares add up to.
    around : sequence of float
        Half axes along e, p, N, Y and D [rad/s].
    """
    import numpy as np

    task = task_of(law, *centered(law, loop), kept)
    if task is None:
        return None
    back = np.linalg.inv(task.basis)
    inner = back @ np.diag(np.square(around)) @ back.T
    count = len(task.maps)
    chosen = list(range(0, count, max(1, count // FIRST_CORNERS)))
    for _ in range(ROUNDS):
        solved = _inequalities(task, chosen, inner, added)
        if solved is None:
            return None
        q, shares, size = solved
        left = _left(q, shares, task.kept, task.maps)
        worst = [int(k) for k in np.argsort(left)[:MORE_CORNERS] if left[k] < 0.0 and int(k) not in chosen]
        if not worst:
            return _rounded(task, choice, supply, q, shares, 0.5), size**0.5
        chosen += worst
    return None


def _inequalities(
    task: Task, chosen: "Sequence[int]", inner: "Array", added: float
) -> "tuple[Array, Array, float] | None":
    """Maximize t with Q - t inner positive semidefinite, over Q, one over each share, and each share."""
    import numpy as np

    units, count = unit_matrices(STATES), task.maps.shape[2] - STATES
    first, second, last = len(units), len(units) + count, len(units) + 2 * count
    sizes = np.linalg.norm(task.maps[:, :, STATES:], axis=1).max(axis=0)
    sizes += LEAST * sizes.max()
    asked = Inequalities(last + 1)
    for each in task.maps[list(chosen)]:
        state, columns = each[:, :STATES], each[:, STATES:].T
        parts = [
            (k, (1.0 - SLACK) * unit - state @ unit @ state.T / task.kept) for k, unit in enumerate(units)
        ]
        parts += [(first + k, -np.outer(column, column) / sizes[k]) for k, column in enumerate(columns)]
        asked.semidefinite(np.zeros((STATES, STATES)), parts)
    for k in range(count):
        asked.semidefinite(np.array(CROSS), [(first + k, np.array(FIRST)), (second + k, np.array(SECOND))])
    total = np.zeros((1, last + 1))
    total[0, second:last] = sizes
    asked.at_most(total, np.array([added]))
    for row, room in task.limits:
        length = float(np.linalg.norm(row))
        reached = np.zeros((1, last + 1))
        reached[0, :first] = _reached(row / length)
        asked.at_most(reached, np.array([(room / length * (1.0 - SLACK)) ** 2]))
    asked.semidefinite(np.zeros((STATES, STATES)), [*enumerate(units), (last, -inner)])
    x = asked.minimize(-np.eye(last + 1)[last], rough=True)
    if x is None:
        return None
    q = sum((x[k] * unit for k, unit in enumerate(units)), np.zeros((STATES, STATES)))
    return q, np.maximum(x[second:last] * sizes, 1e-12), float(x[last])


def widened(band: Ellipsoid, times: Fraction, supply: Fraction) -> Ellipsoid:
    """Return the ellipsoid of a band with a multiple of Q: what disturbs adds so much less of it."""
    shares = {name: getattr(band, name) / times for name in ("offset", "steady", "change")}
    return replace(
        scaled(band, times), shares=tuple(each / times for each in band.shares), supply=supply, **shares
    )
