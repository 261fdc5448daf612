"""Where a function rises along a run for certain: its derivative at a state of the run, in balls.

A rise between two instants of a run is what its floats say; a derivative that is positive here is positive.
"""

from collections.abc import Callable, Iterable
from itertools import islice
from typing import Any

from wspd_design.certificates.checks.ideal_run import ProofRun
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.theorems import ideal_loop
from wspd_design.certificates.theorems.ideal_loop import Flow, State

MOST_TRIED = 50  # states of a run whose derivative is evaluated exactly


def certain_rise(
    candidate: Callable[[State], Any],
    flow: Flow,
    run: ProofRun,
    order: Iterable[int],
    *,
    speaks: Callable[[State], bool] = lambda _: True,
) -> int | None:
    """Look for an instant of a run at whose state a function rises for certain.

    Parameters
    ----------
    candidate, flow : callable, Flow
        As in :func:`ideal_loop.exact_rate`.
    run : ProofRun
        Its states are taken as exact.
    order : iterable of int
        Instants, the most promising first.
    speaks : callable, optional
        Whether the claim speaks about a state of balls.

    Returns
    -------
    int or None
        None if there is none among the instants that are tried.
    """
    for index in islice(order, MOST_TRIED):
        state = run.states[:, index].tolist()
        if ideal_loop.exact_rate(candidate, flow, state) > 0 and speaks(tuple(map(point, state))):
            return index
    return None
