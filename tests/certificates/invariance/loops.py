"""A law with torque feedback, the box in which it is certified, and an integration that shares nothing with it."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.invariant_sets.checker import decide
from wspd_design.controllers.protocol import Measurement
from wspd_design.controllers.torque_feedback import TorqueFeedback, TorqueFeedbackGains
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import load_rail, load_vehicle

SAMPLE, REFERENCE = 0.02, 0.14


@dataclass(frozen=True)
class Verdict:
    """What the checker says about sets."""

    accepted: bool
    reason: str = ""
    slips: tuple[float, float] = (math.nan, math.nan)


def check(problem, written):
    """Let the checker decide about sets."""
    try:
        found = decide(problem, written, Work())
    except Refused as refusal:
        return Verdict(False, str(refusal))
    return Verdict(True, slips=(found["lowest slip"], found["highest slip"]))


def around(value, share):
    return (value * (1.0 - share), value * (1.0 + share))


def feedback_problem(*, spread=0.01, speeds=(23.0, 26.0), rail="polach-wet", sliding_gain=1.0, **changes):
    """Problem of the torque feedback on a box of a relative width around the nominal parameters."""
    vehicle, friction = load_vehicle("er24pc"), load_rail(rail)
    gains = TorqueFeedbackGains(slip_reference=REFERENCE, sliding_gain=sliding_gain, torque_gain=10.0)
    law = TorqueFeedback(name="feedback", sample_time=SAMPLE, vehicle=vehicle, rail=friction, gains=gains)
    stated = {
        "vehicle": vehicle,
        "rail": friction,
        "controller": law,
        "slip": REFERENCE,
        "speeds": speeds,
        "slips": (0.02, 0.6),
        "bounds": Bounds.of(
            {
                "mass": around(vehicle.mass, spread),
                "wheelset inertia": around(vehicle.wheelset_inertia, spread),
                "mu0": around(friction.mu0, spread),
            }
        ),
        "sample_time": SAMPLE,
    }
    return Problem(**{**stated, **changes})


def drawn(problem, rng):
    """Plant with parameters from the box."""
    mass, inertia, mu0 = (
        rng.uniform(*b) for b in (problem.span("mass"), problem.span("wheelset inertia"), problem.span("mu0"))
    )
    vehicle = replace(problem.vehicle, mass=mass, wheelset_inertia=inertia)
    return vehicle, replace(problem.rail, mu0=mu0)


def one_sample(problem, plant, slip, torque, speed):
    """Slip at and between samples, torque and speed one sample later, by a fine integration of eqs. (1)-(14)."""
    vehicle, rail = plant
    brake, sample = vehicle.brake, problem.sample_time
    _, command = problem.controller.step(
        (), Measurement(speed, speed * (1.0 - slip) / vehicle.wheel_radius, torque)
    )
    edges = sorted({0.0, command.fill * sample, (command.fill + command.vent) * sample, sample})
    state, path = np.array([slip, speed, torque]), [slip]
    for start, end in pairwise(edges):
        filling, venting = start < command.fill * sample, start < (command.fill + command.vent) * sample

        def rates(_t, y, filling=filling, venting=venting):
            at = slip_dynamics(vehicle, rail, y[0], y[1])
            torque_rate = (brake.max_torque - y[2]) / brake.fill_time if filling else 0.0
            if venting and not filling:
                torque_rate = -y[2] / brake.vent_time
            return [at.drift + at.gain * y[2], -at.deceleration, torque_rate]

        done = solve_ivp(rates, (start, end), state, rtol=1e-9, atol=1e-12, max_step=sample / 4.0)
        state, path = done.y[:, -1], [*path, *done.y[0]]
    return state[0], state[2], state[1], min(path), max(path)
