"""Whether a function rises along a run for certain: its derivative at a state of the run, in balls.

A rise between two instants of a run is what its floats say; a derivative that is positive here is positive.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any, TypeAlias

from wspd_design.certificates.checks.ideal_run import Flow, ProofRun, State
from wspd_design.certificates.kernel.arb import Ball, below, point
from wspd_design.certificates.records import Point
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import model_variables, records_of
from wspd_design.certificates.theorems.invariant_sets.ball_slopes import law_slopes
from wspd_design.controllers.sliding_mode import SlidingMode

MOST_TRIED = 50  # states of a run whose derivative is evaluated exactly

Rise: TypeAlias = tuple[int, float]
"""An instant of a run, and a number that the derivative of the function exceeds there."""


def exact_law(law: SlidingMode) -> SlidingMode:
    """Return a law with the numbers of its design model as balls."""
    known = {v.name: point(v.low) for v in model_variables(law.vehicle, law.rail)}
    vehicle, rail = records_of(known, law.vehicle, law.rail, "model ")
    return replace(law, vehicle=vehicle, rail=rail)


def exact_rate(candidate: Callable[[State], Any], flow: Flow, state: Sequence[float]) -> Ball:
    """Enclose the derivative of a function of the states along the flow, at one state without rounding.

    Parameters
    ----------
    candidate : callable
        The function; it has to run on balls with slopes.
    flow : Flow
        Of the loop, with its numbers as balls.
    state : sequence of float
        Taken as exact.
    """
    balls = tuple(point(float(each)) for each in state)
    ((_, slopes),) = law_slopes(lambda *x: (candidate(x),), balls)
    return sum((slope * rate for slope, rate in zip(slopes, flow(balls), strict=True)), point(0.0))


def certain_rise(
    candidate: Callable[[State], Any],
    flow: Flow,
    run: ProofRun,
    order: Iterable[int],
    *,
    speaks: Callable[[State], bool] = lambda _: True,
) -> Rise | None:
    """Look for an instant of a run at whose state a function rises for certain.

    Parameters
    ----------
    candidate, flow : callable, Flow
        As in :func:`exact_rate`.
    run : ProofRun
        Its states are taken as exact.
    order : iterable of int
        Instants, the most promising first.
    speaks : callable, optional
        Whether the claim speaks about a state of balls.

    Returns
    -------
    Rise or None
        None if there is none among the instants that are tried.
    """
    for index in islice(order, MOST_TRIED):
        state = run.states[:, index].tolist()
        rate = exact_rate(candidate, flow, state)
        if rate > 0 and speaks(tuple(map(point, state))):
            return index, below(rate)
    return None


def rising_state(run: ProofRun, shown: Rise, name: str, unit: str) -> tuple[Point, ...]:
    """Return the state at which a function of this name rises for certain, in readable units."""
    index, rate = shown
    _, _, integral, *adapted = run.states[:, index].tolist()
    names = [*(f"weight {k}" for k in range(1, len(adapted))), "bound"] if adapted else []
    return (
        Point(name="slip", value=float(run.slip[index]), unit="-"),
        Point(name="speed", value=float(run.speed[index]) * KMH, unit="km/h"),
        Point(name="integral of the slip error", value=integral, unit="s"),
        *(Point(name=each, value=x, unit="of u") for each, x in zip(names, adapted, strict=True)),
        Point(name=f"least {name}", value=rate, unit=unit),
        Point(name="time", value=float(run.time[index]), unit="s"),
    )


def certainty(run: ProofRun, shown: Rise | None, name: str, unit: str) -> str:
    """Say what :func:`certain_rise` found."""
    if shown is None:
        return "But at no state of the run that was tried is its derivative positive for certain."
    index, rate = shown
    return (
        f"At {run.time[index]:.3g} s, with {run.speed[index] * KMH:.3g} km/h and slip {run.slip[index]:.4f}, "
        f"{name} is at least {rate:.3g} {unit} in exact arithmetic."
    )
