"""The closed loop in the setting of the proofs: torque equal to command, no sampling, no limits, no valve.

Its states are the speed, the slip, the integral of the slip error, and what the law adapts. A derivative along the flow
at one state, in balls, is certain.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

from wspd_design.certificates.kernel.arb import Ball, point
from wspd_design.certificates.setting.plant import known_variables, records_of
from wspd_design.certificates.theorems.invariant_sets.ball_slopes import law_slopes
from wspd_design.controllers.adaptive_fuzzy import (
    AdaptiveFuzzyGains,
    adaptation,
    sliding_variable,
    torque_demand,
)
from wspd_design.controllers.sliding_mode import SlidingMode, sliding_torque
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

ASSUMPTIONS = (
    "T = u: torque equals command, without valve lag, sampling or limits of the brake",
    "quarter model with static wheel load and nominal parameters",
    "slip reference constant",
)
EVALUATION_WORK = 20_000  # of a budget of operations: what a derivative at a state takes

State: TypeAlias = Any
"""Speed [m/s], slip, integral of e [s], what the law adapts: at one instant, or arrays over time."""

Flow: TypeAlias = Callable[[State], list[Any]]
"""Time derivatives of the states, in whatever numbers the states are."""


def adaptive_flow(vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains) -> Flow:
    """Return the loop of the adaptive fuzzy law with continuous adaptation."""

    def rates(state: State) -> list[Any]:
        speed, slip, integral, *weights, bound = state
        error = sliding_surface.slip_error(gains.slip_reference, slip)
        surface = sliding_variable(gains, error, integral)
        torque = torque_demand(gains, surface, tuple(weights), bound)
        plant = slip_dynamics(vehicle, rail, slip, speed)
        adapted = adaptation(gains, surface, speed)
        return [
            -plant.deceleration,
            plant.drift + plant.gain * torque,
            error,
            *adapted.weights,
            adapted.bound,
        ]

    return rates


def sliding_flow(vehicle: Vehicle, rail: Rail, law: SlidingMode) -> Flow:
    """Return the loop of the sliding-mode law."""

    def rates(state: State) -> list[Any]:
        speed, slip, integral = state
        plant = slip_dynamics(vehicle, rail, slip, speed)
        torque = sliding_torque(law, slip, speed, integral)
        error = sliding_surface.slip_error(law.gains.slip_reference, slip)
        return [-plant.deceleration, plant.drift + plant.gain * torque, error]

    return rates


def exact_law(law: SlidingMode) -> SlidingMode:
    """Return a law with the numbers of its design model as balls."""
    known = {v.name: point(v.low) for v in known_variables(law.vehicle, law.rail, "model ")}
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
