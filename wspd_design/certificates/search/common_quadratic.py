"""Search for one quadratic function that falls along the sampled loop at all corners; in doubles, not trusted."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from wspd_design.certificates.search.matrix_inequalities import Inequalities
from wspd_design.certificates.setting.slip_loop import STATES, Matrix

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

LEAST = 1e-6  # by which P - A'PA has to be positive, P below 1: what is smaller may be rounding of the solver


def unit_matrices(size: int) -> list["Array"]:
    """Return symmetric matrices of which any other one is a combination."""
    import numpy as np

    found = []
    for i in range(size):
        for j in range(i + 1):
            unit = np.zeros((size, size))
            unit[i, j] = unit[j, i] = 1.0
            found.append(unit)
    return found


def contraction(matrices: Iterable[Matrix]) -> float | None:
    """Return a factor by which some norm of the undisturbed state falls per sample at all corners.

    Parameters
    ----------
    matrices : iterable
        [A B] of the corners.

    Returns
    -------
    float or None
        Below 1; None if no quadratic function was found. It need not be the smallest one that exists.
    """
    import numpy as np

    maps = [np.array(each, dtype=float)[:, :STATES] for each in matrices]
    units = unit_matrices(STATES)
    margin = len(units)
    asked = Inequalities(margin + 1)
    one = np.eye(STATES)
    for each in maps:
        falls = [(k, unit - each.T @ unit @ each) for k, unit in enumerate(units)]
        asked.semidefinite(np.zeros((STATES, STATES)), [*falls, (margin, -one)])
    asked.semidefinite(one, [(k, -unit) for k, unit in enumerate(units)])
    found = asked.minimize(-np.eye(margin + 1)[margin])
    if found is None or not found[margin] > LEAST:
        return None
    p = np.tensordot(found[:margin], units, 1)
    if not np.linalg.eigvalsh(p)[0] > 0.0:
        return None
    root = np.linalg.cholesky(p).T
    largest = max(float(np.linalg.norm(root @ each @ np.linalg.inv(root), 2)) for each in maps)
    return largest if largest < 1.0 else None
