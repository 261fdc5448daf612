"""The loop near its reference at a frozen speed: a law as three gains, and the cubic that decides.

With e = slip_reference - slip, E its integral and T the torque, every law here is
u = u0 + P e + I E - K (T - T0) as long as nothing saturates. On e' = p e - G (T - T0), tau T' + T = u the loop has
the characteristic polynomial

    tau q^3 + (1 + K - p tau) q^2 + (G P - (1 + K) p) q + G I.

For the sliding mode on its own design model this is tau q^3 + (1 - p tau) q^2 + (c + k) q + k c.
"""

import math
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import Ball, above, ball, below, point
from wspd_design.certificates.kernel.claim import Variable, variable
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import (
    OTHERS,
    Values,
    forces,
    model_variables,
    plant_dynamics,
    plant_forces,
    plant_variables,
    records_of,
)
from wspd_design.controllers.offers import Feedback, Linear, SlipModel
from wspd_design.model.generated.slip import slip_gain
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

PRECISION = 128  # bits, of enclosed poles


class Cubic(NamedTuple):
    """Coefficients of q^3, q^2, q, 1."""

    third: Number
    second: Number
    first: Number
    constant: Number


def on_brake(law: Linear, gains: Feedback, max_torque: float) -> Feedback:
    """Return the gains of a law on a brake with another T_max [N m] than its own: a duty is worth that torque.

    The gain of the torque is rounded to the next double; P and I are what the numbers they are made of have them.
    """
    if law.max_torque == max_torque:
        return gains
    return Feedback(*(gain * max_torque / law.max_torque for gain in gains))


def nominal(vehicle: Vehicle, rail: Rail, slip: Number, speed: Number) -> SlipModel:
    """Pole and gain of a vehicle on a rail, from the kernels."""
    dynamics = slip_dynamics(vehicle, rail, slip, speed)
    return SlipModel(pole=dynamics.pole, gain=dynamics.gain)


def cubic(plant: SlipModel, lag: float, law: Feedback) -> Cubic:
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


def variables(problem: Problem, law: Linear) -> tuple[Variable, ...]:
    """Quantities of the loop at the slip reference, for claims: plant on its domain, law as it is."""
    plant = plant_variables(problem, hold=OTHERS, ranges={"slip": problem.slip})
    numbers = tuple(
        variable(name, (below(number), above(number)), "N m")
        for name, number in law.linear_numbers(point(0.0)).items()
    )
    model = law.linear_model
    return (*plant, *(model_variables(*model) if model else ()), *numbers)


def loop_at(
    problem: Problem, law: Linear, values: Values, *, arranged: bool = False
) -> tuple[SlipModel, Feedback]:
    """Plant and linear form of the law for the quantities of :func:`variables`.

    ``arranged`` gives the same functions in the form that is tight on intervals.
    """
    max_torque = problem.vehicle.brake.max_torque
    speed, slip = values["speed"], values["slip"]
    if arranged:
        gain = slip_gain(speed, values["wheelset inertia"] / 2.0, values["wheel radius"])
        plant = SlipModel(pole=plant_forces(problem, values).pole, gain=gain)
    else:
        dynamics = plant_dynamics(problem, values)
        plant = SlipModel(pole=dynamics.pole, gain=dynamics.gain)
    numbers = {name: values[name] for name in law.linear_numbers(0.0)}
    own, model = law.linear_model, None
    if own is not None:
        vehicle, rail = records_of(values, *own, "model ")
        model = nominal(vehicle, rail, slip, speed)
        if arranged:
            gain = slip_gain(speed, vehicle.wheel_inertia, vehicle.wheel_radius)
            model = SlipModel(pole=forces(vehicle, rail, slip, speed).pole, gain=gain)
    return plant, on_brake(law, law.linear_form(speed, model=model, numbers=numbers), max_torque)


def outermost(problem: Problem, law: Linear, speed: float, *, sampled: bool) -> float:
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


def _continuous(plant: SlipModel, lag: Ball, gains: Feedback, _: Ball) -> list[list[Ball]]:
    """Matrix of the loop in error, torque and integral."""
    row = [gains.proportional / lag, -(1 + gains.torque) / lag, gains.integral / lag]
    return [[plant.pole, -plant.gain, 0], row, [1, 0, 0]]


def _sampled(plant: SlipModel, lag: Ball, gains: Feedback, span: Ball) -> list[list[Ball]]:
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
