"""The loop near its reference at a frozen speed: a law as three gains, and the cubic that decides.

With e = slip_reference - slip, E its integral and T the torque, every law here is
u = u0 + P e + I E - K (T - T0) as long as nothing saturates. On e' = p e - G (T - T0), tau T' + T = u the loop has
the characteristic polynomial

    tau q^3 + (1 + K - p tau) q^2 + (G P - (1 + K) p) q + G I.

For the sliding mode on its own design model this is tau q^3 + (1 - p tau) q^2 + (c + k) q + k c.
"""

from typing import NamedTuple, TypeAlias

from wspd_design.certificates.balls import above, below, point
from wspd_design.certificates.plant import (
    Values,
    forces,
    model_variables,
    plant_dynamics,
    plant_forces,
    plant_variables,
    records_of,
)
from wspd_design.certificates.proof.claim import Variable, variable
from wspd_design.certificates.records import Problem
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains, firing_strengths
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.controllers.torque_feedback import TorqueFeedback
from wspd_design.model.generated.slip import slip_gain
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

LinearLaw: TypeAlias = AdaptiveFuzzy | SlidingMode | TorqueFeedback
"""Laws that are linear near their reference."""


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
    speed, slip = values["speed"], values["slip"]
    if arranged:
        gain = slip_gain(speed, values["wheelset inertia"] / 2.0, values["wheel_radius"])
        plant = Plant(pole=plant_forces(problem, values).pole, gain=gain)
    else:
        dynamics = plant_dynamics(problem, values)
        plant = Plant(pole=dynamics.pole, gain=dynamics.gain)
    if not isinstance(law, SlidingMode):
        return plant, feedback(law, speed, slope=values.get("du/ds"))
    vehicle, rail = records_of(values, law.vehicle, law.rail, "model ")
    model = nominal(vehicle, rail, slip, speed)
    if arranged:
        gain = slip_gain(speed, vehicle.wheel_inertia, vehicle.wheel_radius)
        model = Plant(pole=forces(vehicle, rail, slip, speed).pole, gain=gain)
    return plant, feedback(law, speed, model=model)
