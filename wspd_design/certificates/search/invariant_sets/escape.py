"""Simulated courses of the parameters that take a loop out of the range of slip: why a set may not exist.

A set that holds a state at the reference holds all that can follow from it. If from every torque at the reference
some course of mass, inertia and mu0 within their ranges leaves the range of slip, at a train speed that does not
change, no set inside that range is there to be found, however fine the cells. Plain numbers: evidence, no proof.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.controllers.protocol import Measurement
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SPEEDS = 12  # that are tried at most
TORQUES = 11  # shares of T_max from which the brake starts
SPANS = (math.inf, 1.6, 1.0, 0.6, 0.3)  # after which the friction changes, in time constants of venting
DURATION = 6.0  # of a course, in time constants of venting
LONGEST_STEP = 2e-3  # s, of the integration


@dataclass(frozen=True, slots=True, kw_only=True)
class Escapes:
    """For each speed whether some course leaves from every torque at the reference."""

    constant: "NDArray[np.bool_]"  # already with parameters that never change
    changing: "NDArray[np.bool_]"  # with any of the courses


def described(problem: Problem, speeds: Sequence[float]) -> str:
    """Say at which of some train speeds [m/s], each held, no set can be."""
    spread = max(1, -(-len(speeds) // SPEEDS))
    tried = [*speeds[: len(speeds) - 1 : spread], speeds[-1]]
    found = escapes(problem, tried)
    limits = f"slip {problem.slips[0]:g} to {problem.slips[1]:g}"
    if not found.changing.any():
        return (
            f"Simulated at {len(tried)} of these speeds, the extremes of mass, inertia and mu0 do not leave {limits}, "
            "so that finer cells might find a set"
        )
    alone = f"; at {_span(tried, found.constant)} extremes that never change will do"
    return (
        f"Simulated at {len(tried)} of these speeds, each held, changes between the extremes of mass, inertia and mu0 "
        f"drive the wheel out of {limits} at {_span(tried, found.changing)}, from each of {TORQUES} torques at the "
        f"reference{alone if found.constant.any() else ''}. This is evidence that there is no set to be found"
    )


def _span(speeds: Sequence[float], chosen: "NDArray[np.bool_]") -> str:
    """Ranges of neighbors that are chosen."""
    runs = [
        [speed for speed, _ in run]
        for yes, run in groupby(zip(speeds, chosen, strict=True), lambda p: p[1])
        if yes
    ]
    return ", ".join(
        f"{run[0] * KMH:.0f} km/h" if len(run) == 1 else f"{run[0] * KMH:.0f} to {run[-1] * KMH:.0f} km/h"
        for run in runs
    )


def escapes(problem: Problem, speeds: Sequence[float]) -> Escapes:
    """Simulate the extremes of the parameters, constant and alternating.

    Parameters
    ----------
    problem : Problem
        Closed loop with a law without memory.
    speeds : sequence of float
        Train speeds, each held [m/s].
    """
    import numpy as np

    axes = (
        np.asarray(speeds),
        np.linspace(0.0, 1.0, TORQUES),
        np.array(SPANS),
        problem.span("wheelset inertia"),
        (0.0, 1.0),
    )
    lanes = (each.ravel() for each in np.meshgrid(*axes, indexing="ij"))
    gone = _leaves(problem, *lanes).reshape(len(speeds), TORQUES, len(SPANS), -1)
    courses = np.logical_or.reduce(gone, axis=3)
    always = np.logical_and.reduce
    return Escapes(
        constant=always(courses[:, :, 0], axis=1),
        changing=always(np.logical_or.reduce(courses, axis=2), axis=1),
    )


def _leaves(
    problem: Problem, speed: "Array", share: "Array", span: "Array", inertia: "Array", first: "Array"
) -> "NDArray[np.bool_]":
    """Follow many courses at once; true for those that leave the range of slip."""
    import numpy as np

    brake, radius = problem.vehicle.brake, problem.vehicle.wheel_radius
    sample, full = problem.sample_time, brake.max_torque
    slip, torque = np.full(len(speed), problem.slip), share * full
    gone = np.full(len(speed), False)
    steps = math.ceil(sample / LONGEST_STEP)
    for k in range(math.ceil(DURATION * brake.vent_time / sample)):
        heavy = (np.floor(k * sample / (span * brake.vent_time)) + first) % 2.0
        mass, mu0 = (low + heavy * (high - low) for low, high in (problem.span("mass"), problem.span("mu0")))
        vehicle, rail = plant_with(problem, {"mass": mass, "wheelset inertia": inertia, "mu0": mu0})
        _, command = problem.wheelset_law.step((), Measurement(speed, speed * (1.0 - slip) / radius, torque))
        fill, vent = (np.broadcast_to(each, speed.shape) for each in command)
        for part, aim, lag in (
            (fill, full, brake.fill_time),
            (vent, 0.0, brake.vent_time),
            (1.0 - fill - vent, 0.0, math.inf),
        ):
            step = np.maximum(part, 0.0) * sample / steps
            if not step.any():
                continue
            for _ in range(steps):
                here = slip_dynamics(vehicle, rail, slip, speed)
                middle = torque + 0.5 * step * (aim - torque) / lag
                half = np.clip(slip + 0.5 * step * (here.drift + here.gain * torque), 0.0, 1.0)
                there = slip_dynamics(vehicle, rail, half, speed)
                moved = np.clip(slip + step * (there.drift + there.gain * middle), 0.0, 1.0)
                # Those that have left stay where they are: nothing more is asked about them.
                slip = np.where(gone, slip, moved)
                torque = torque + step * (aim - middle) / lag
                gone |= (slip < problem.slips[0]) | (slip > problem.slips[1])
    return gone
