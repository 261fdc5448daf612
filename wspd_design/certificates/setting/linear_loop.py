"""The loop near its reference at a frozen speed: a law as three gains, and the cubic that decides.

With e = slip_reference - slip, E its integral and T the torque, every law here is
u = u0 + P e + I E - K (T - T0) as long as nothing saturates. On e' = p e - G (T - T0), tau T' + T = u the loop has
the characteristic polynomial

    tau q^3 + (1 + K - p tau) q^2 + (G P - (1 + K) p) q + G I.

For the sliding mode on its own design model this is tau q^3 + (1 - p tau) q^2 + (c + k) q + k c.
"""

import math
from typing import NamedTuple, TypeAlias

from wspd_design.certificates.kernel.arb import Ball, above, ball, below, point
from wspd_design.certificates.kernel.claim import Variable, variable
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import (
    Values,
    forces,
    model_variables,
    plant_dynamics,
    plant_forces,
    plant_variables,
    records_of,
)
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains, firing_strengths
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.controllers.torque_feedback import TorqueFeedback
from wspd_design.model.generated.slip import slip_gain
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

LinearLaw: TypeAlias = AdaptiveFuzzy | SlidingMode | TorqueFeedback
"""Laws that are linear near their reference."""

PRECISION = 128  # bits, of enclosed poles


class Plant(NamedTuple):
    """What the loop needs to know of (19)."""

    pole: Number  # 1/s, p
    gain: Number  # 1/(N m s), G


class Feedback(NamedTuple):
    """Gains of a law near its reference."""

    proportional: Number  # N m per slip, P
    integral: Number  # N m/s per slip, I
    torque: Number  # -, K


class Cubic(NamedTuple):
    """Coefficients of q^3, q^2, q, 1."""

    third: Number
    second: Number
    first: Number
    constant: Number


def feedback(
    law: LinearLaw, speed: Number, *, slope: Number | None = None, model: Plant | None = None
) -> Feedback:
    """Linear form of a law at its reference and a train speed [m/s].

    ``slope`` is that of the adaptive law, du/ds [N m], and ``model`` the design model of the sliding mode; both are
    worked out by default.
    """
    if isinstance(law, TorqueFeedback):
        per_slip = speed * law.gains.sliding_gain * law.vehicle.brake.max_torque
        return Feedback(proportional=per_slip, integral=0.0, torque=law.gains.torque_gain)
    if isinstance(law, SlidingMode):
        gains = law.gains
        model = model or nominal(law.vehicle, law.rail, gains.slip_reference, speed)
        layer_rate = 1.0 / speed * gains.switching_gain / gains.boundary_layer  # k
        return Feedback(
            proportional=(model.pole + gains.surface_rate + layer_rate) / model.gain,
            integral=layer_rate * gains.surface_rate / model.gain,
            torque=0.0,
        )
    if slope is None:
        slope = torque_per_surface(law.gains, 0.0)
    return Feedback(
        proportional=slope * law.gains.proportional_gain, integral=slope * law.gains.integral_gain, torque=0.0
    )


def on_brake(law: LinearLaw, gains: Feedback, max_torque: float) -> Feedback:
    """Return the gains of a law on a brake with another T_max [N m] than its own: a duty is worth that torque.

    The gain of the torque is rounded to the next double; P and I are what the numbers they are made of have them.
    """
    own = law.max_torque if isinstance(law, AdaptiveFuzzy) else law.vehicle.brake.max_torque
    if own == max_torque:
        return gains
    return Feedback(*(gain * max_torque / own for gain in gains))


def nominal(vehicle: Vehicle, rail: Rail, slip: Number, speed: Number) -> Plant:
    """Pole and gain of a vehicle on a rail, from the kernels."""
    dynamics = slip_dynamics(vehicle, rail, slip, speed)
    return Plant(pole=dynamics.pole, gain=dynamics.gain)


def torque_per_surface(gains: AdaptiveFuzzyGains, zero: Number) -> Number:
    """Slope du/ds of the adaptive law on its surface, with what it adapts as at the start [N m].

    The rule strengths are memberships exp(-(s - center)^2/width^2) over their sum, so that each has the slope
    w (d - mean of d), d = 2 center/width^2, at s = 0. The type of ``zero`` is that of the arithmetic.
    """
    strengths = firing_strengths(gains, zero)
    pulls = [
        (zero + 2.0 * center) / width / width
        for center, width in zip(gains.centres, gains.widths, strict=True)
    ]
    mean = sum(w * pull for w, pull in zip(strengths, pulls, strict=True))
    moved = sum(
        b * w * (pull - mean) for b, w, pull in zip(gains.initial_weights, strengths, pulls, strict=True)
    )
    return gains.torque_unit * (moved + (zero + gains.initial_bound) / gains.boundary_layer)


def cubic(plant: Plant, lag: float, law: Feedback) -> Cubic:
    """Characteristic polynomial of the loop with the valve lag tau [s]."""
    opened = 1.0 + law.torque
    return Cubic(
        third=lag,
        second=opened - plant.pole * lag,
        first=plant.gain * law.proportional - opened * plant.pole,
        constant=plant.gain * law.integral,
    )


def lag_of(problem: Problem) -> float:
    """Time constant of the valve, the slower of filling and venting [s]."""
    return max(problem.vehicle.brake.fill_time, problem.vehicle.brake.vent_time)


def variables(problem: Problem, law: LinearLaw) -> tuple[Variable, ...]:
    """Quantities of the loop at the slip reference, for claims: plant on its domain, law as it is."""
    plant = plant_variables(problem, slip=problem.slip)
    if isinstance(law, SlidingMode):
        return plant + model_variables(law.vehicle, law.rail)
    if isinstance(law, AdaptiveFuzzy):
        slope = torque_per_surface(law.gains, point(0.0))
        return (*plant, variable("du/ds", (below(slope), above(slope)), "N m"))
    return plant


def loop_at(
    problem: Problem, law: LinearLaw, values: Values, *, arranged: bool = False
) -> tuple[Plant, Feedback]:
    """Plant and linear form of the law for the quantities of :func:`variables`.

    ``arranged`` gives the same functions in the form that is tight on intervals.
    """
    max_torque = problem.vehicle.brake.max_torque
    speed, slip = values["speed"], values["slip"]
    if arranged:
        gain = slip_gain(speed, values["wheelset inertia"] / 2.0, values["wheel_radius"])
        plant = Plant(pole=plant_forces(problem, values).pole, gain=gain)
    else:
        dynamics = plant_dynamics(problem, values)
        plant = Plant(pole=dynamics.pole, gain=dynamics.gain)
    if not isinstance(law, SlidingMode):
        return plant, on_brake(law, feedback(law, speed, slope=values.get("du/ds")), max_torque)
    vehicle, rail = records_of(values, law.vehicle, law.rail, "model ")
    model = nominal(vehicle, rail, slip, speed)
    if arranged:
        gain = slip_gain(speed, vehicle.wheel_inertia, vehicle.wheel_radius)
        model = Plant(pole=forces(vehicle, rail, slip, speed).pole, gain=gain)
    return plant, on_brake(law, feedback(law, speed, model=model), max_torque)


def outermost(problem: Problem, law: LinearLaw, speed: float, *, sampled: bool) -> float:
    """Lower bound of how far a pole of the loop lies out, with the nominal parameters at a speed [m/s].

    In balls, with the integral of the law as it is summed if it is sampled. The poles are enclosed by Arb.

    Returns
    -------
    float
        Of the largest real part [1/s], or of the largest magnitude [-] if sampled; minus infinity if the poles cannot
        be enclosed.
    """
    from flint import acb_mat, ctx

    vehicle = problem.vehicle
    nominal_values = {
        "speed": speed,
        "mass": vehicle.mass,
        "wheelset inertia": vehicle.wheelset_inertia,
        "mu0": problem.rail.mu0,
    }
    with ctx.workprec(PRECISION):
        values = {v.name: ball(v.low, v.high) for v in variables(problem, law)}
        values |= {name: point(value) for name, value in nominal_values.items()}
        plant, gains = loop_at(problem, law, values)
        make = _sampled if sampled else _continuous
        matrix = make(plant, point(lag_of(problem)), gains, point(problem.sample_time))
        if gains.integral == 0.0:
            matrix = [row[:2] for row in matrix[:2]]
        try:
            poles = acb_mat(matrix).eig(multiple=True)
        except ValueError:
            return -math.inf
        return max(below(abs(pole) if sampled else pole.real) for pole in poles)


def _continuous(plant: Plant, lag: Ball, gains: Feedback, _: Ball) -> list[list[Ball]]:
    """Matrix of the loop in error, torque and integral."""
    row = [gains.proportional / lag, -(1 + gains.torque) / lag, gains.integral / lag]
    return [[plant.pole, -plant.gain, 0], row, [1, 0, 0]]


def _sampled(plant: Plant, lag: Ball, gains: Feedback, span: Ball) -> list[list[Ball]]:
    """Matrix from one sample to the next, the command held in between."""
    from flint import arb_mat

    generator = arb_mat([[plant.pole, -plant.gain, 0], [0, -1 / lag, 1 / lag], [0, 0, 0]])
    step = (generator * span).exp()
    rows = [
        [
            step[k, 0] + step[k, 2] * gains.proportional,
            step[k, 1] - step[k, 2] * gains.torque,
            step[k, 2] * gains.integral,
        ]
        for k in range(2)
    ]
    return [*rows, [span, 0, 1]]
