"""The loop near its reference at a frozen speed: a law as four gains, a valve as two rates.

With e = slip_reference - slip, E its integral and EE that of E, every law here is
u = u0 + P e + I E + J EE - K (T - T0) as long as nothing saturates. On e' = p e - G t, t = T - T0, and the averaged
valve t' = -a t + b (u - u0) of :mod:`wspd_design.certificates.setting.pulsed_valve` the loop has the polynomial

    q^2 ((q - p)(q + a + b K) + G b P) + G b (I q + J),

of degree 3 if J = 0, and 2 if I = 0 too. For T_F = T_V = tau both rates are 1/tau.
"""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import Ball, above, ball, below, point
from wspd_design.certificates.kernel.claim import Variable, variable
from wspd_design.certificates.quantities import PLANT
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
from wspd_design.certificates.setting.pulsed_valve import Times, sample_of
from wspd_design.certificates.setting.traced_law import law_of_theorem
from wspd_design.certificates.setting.written_laws import WRITTEN
from wspd_design.controllers.offers import Feedback, Linear, SlipModel
from wspd_design.model.generated.slip import slip_gain
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.records import Rail, Vehicle

PRECISION = 128  # bits, of enclosed poles
BRAKE = ("max torque", "fill time", "vent time")
SHARE = "share of T_max that holds the slip"
DECAY, RATE = "valve rate a", "valve rate b"


class Valve(NamedTuple):
    """Rates of the averaged valve."""

    decay: Number  # 1/s, a
    rate: Number  # 1/s, b


class Quartic(NamedTuple):
    """Coefficients of q^3, q^2, q, 1 behind that of q^4, which is 1; fewer integrals leave the last ones zero."""

    third: Number
    second: Number
    first: Number
    constant: Number


def linear_law(problem: Problem) -> str:
    """Say why a theorem about the linear loop does not speak about a law."""
    law = problem.controller
    if not isinstance(law, Linear):
        return "offers no linear form near a slip that it holds"
    if law.slip_reference != problem.slip:
        return f"holds slip {law.slip_reference:g}, not {problem.slip:g}"
    reasons = [law_of_theorem(problem, family) for family in WRITTEN]
    if None in reasons:
        return ""
    return "is none of the laws whose linear form is known: " + "; ".join(each for each in reasons if each)


def law_of(problem: Problem) -> Linear:
    """Return a law that :func:`linear_law` has nothing against."""
    law = problem.controller
    assert isinstance(law, Linear)
    return law


def valve(fill: Number, vent: Number, share: Number) -> Valve:
    """Rates of the averaged valve at a share of T_max."""
    rate = (1.0 - share) / fill + share / vent
    return Valve(decay=1.0 / (fill * vent * rate), rate=rate)


def one_time(problem: Problem) -> bool:
    """Whether the valve fills and vents with one known time constant, so that no share of T_max counts."""
    fill, vent = problem.span("fill time"), problem.span("vent time")
    return fill == vent and fill[0] == fill[1]


def any_rates(problem: Problem) -> bool:
    """Whether both rates may be any between the same ends: filling and venting have one range, and any share counts."""
    fill, vent = problem.span("fill time"), problem.span("vent time")
    return fill == vent and fill[0] < fill[1]


def on_brake(law: Linear, gains: Feedback, max_torque: Number) -> Feedback:
    """Return the gains of a law on a brake with another T_max [N m] than its own: a duty is worth that torque."""
    return Feedback(*(gain * max_torque / law.max_torque for gain in gains))


def nominal(vehicle: Vehicle, rail: Rail, slip: Number, speed: Number) -> SlipModel:
    """Pole and gain of a vehicle on a rail, from the kernels."""
    dynamics = slip_dynamics(vehicle, rail, slip, speed)
    return SlipModel(pole=dynamics.pole, gain=dynamics.gain)


def holding_torque(problem: Problem, speed: float) -> Number:
    """Torque that holds the reference with nominal parameters at a speed [m/s], whatever the brake has [N m]."""
    dynamics = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speed)
    return -dynamics.drift / dynamics.gain


def quartic(plant: SlipModel, valve: Valve, law: Feedback) -> Quartic:
    """Characteristic polynomial of the loop."""
    back = valve.decay + valve.rate * law.torque
    gain = plant.gain * valve.rate
    return Quartic(
        third=back - plant.pole,
        second=gain * law.proportional - back * plant.pole,
        first=gain * law.integral,
        constant=gain * law.twice,
    )


def slips(problem: Problem) -> float | Ends:
    """Where the loop may rest: at the reference if the law integrates the error, else within the tolerance."""
    return problem.slip if law_of(problem).linear_form(problem.speeds[1]).integral else problem.near


def variables(problem: Problem) -> tuple[Variable, ...]:
    """Quantities of the loop where it rests, for claims: plant and brake on the domain, law as it is."""
    law = law_of(problem)
    uses = (*PLANT, "max torque") if any_rates(problem) else (*PLANT, *BRAKE)
    plant = plant_variables(problem, uses=uses, hold=OTHERS, ranges={"slip": slips(problem)})
    numbers = tuple(
        variable(name, (below(number), above(number)), "N m")
        for name, number in law.linear_numbers(point(0.0)).items()
    )
    model = law.linear_model
    return (*plant, *_valve_variables(problem), *(model_variables(*model) if model else ()), *numbers)


def _valve_variables(problem: Problem) -> tuple[Variable, ...]:
    if any_rates(problem):
        fast, slow = problem.span("fill time")
        ends = below(1 / point(slow)), above(1 / point(fast))
        return variable(DECAY, ends, "1/s"), variable(RATE, ends, "1/s")
    return (variable(SHARE, 0.0 if one_time(problem) else (0.0, 1.0), "-"),)


def loop_at(problem: Problem, values: Values, *, arranged: bool = False) -> tuple[SlipModel, Valve, Feedback]:
    """Plant, valve and linear form of the law for the quantities of :func:`variables`.

    ``arranged`` gives the same functions in the form that is tight on intervals.
    """
    law = law_of(problem)
    speed = values["speed"]
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
        # As a quantity, with which arithmetic is exact; doubles would round differently in both forms.
        reference = values["slip"] if isinstance(slips(problem), float) else problem.slip
        model = nominal(vehicle, rail, reference, speed)
        if arranged:
            gain = slip_gain(speed, vehicle.wheel_inertia, vehicle.wheel_radius)
            model = SlipModel(pole=forces(vehicle, rail, reference, speed).pole, gain=gain)
    gains = on_brake(law, law.linear_form(speed, model=model, numbers=numbers), values["max torque"])
    return plant, _rates(problem, values), gains


def _rates(problem: Problem, values: Values) -> Valve:
    if DECAY in values:
        return Valve(decay=values[DECAY], rate=values[RATE])
    if one_time(problem):
        return Valve(decay=1.0 / values["fill time"], rate=1.0 / values["fill time"])
    return valve(values["fill time"], values["vent time"], values[SHARE])


def nominal_values(problem: Problem, speed: float) -> dict[str, Ball]:
    """Balls around the nominal quantities at the reference and a speed [m/s]."""
    found = {v.name: ball(v.low, v.high) for v in variables(problem)}
    names = [name for name in (*PLANT, *BRAKE) if name not in ("slip", "speed")]
    found |= {name: point(problem.nominal(name)) for name in names}
    found |= {"slip": point(problem.slip), "speed": point(speed)}
    at = plant_dynamics(problem, found)
    found[SHARE] = -at.drift / at.gain / found["max torque"]
    found[DECAY], found[RATE] = valve(found["fill time"], found["vent time"], found[SHARE])
    return found


def outermost(problem: Problem, speed: float, *, sampled: bool) -> float:
    """Lower bound of how far a pole of the loop lies out, with the nominal parameters at a speed [m/s].

    In balls, with the integral of the law as it is summed if it is sampled. The poles are enclosed by Arb.

    Returns
    -------
    float
        Of the largest real part [1/s], or of the largest magnitude [-] if sampled; minus infinity if the poles cannot
        be enclosed.
    """
    from flint import acb_mat, ctx

    with ctx.workprec(PRECISION):
        values = nominal_values(problem, speed)
        plant, rates, gains = loop_at(problem, values)
        duty = _duty(values, rates)
        matrix = _sampled(problem, plant, gains, duty) if sampled else _continuous(plant, rates, gains)
        size = 2 + (gains.integral != 0.0) + (gains.twice != 0.0)
        matrix = [row[:size] for row in matrix[:size]]
        try:
            poles = acb_mat(matrix).eig(multiple=True)
        except ValueError:
            return -math.inf
        return max(below(abs(pole) if sampled else pole.real) for pole in poles)


def _duty(values: Mapping[str, Ball], rates: Valve) -> Ball:
    """Duty that holds the torque on average."""
    return values[SHARE] / values["vent time"] / rates.rate


def _continuous(plant: SlipModel, rates: Valve, gains: Feedback) -> list[list[Ball]]:
    """Matrix of the loop in error, torque, integral and double integral."""
    back = rates.decay + rates.rate * gains.torque
    row = [rates.rate * each for each in (gains.proportional, gains.integral, gains.twice)]
    return [[plant.pole, -plant.gain, 0, 0], [row[0], -back, row[1], row[2]], [1, 0, 0, 0], [0, 0, 1, 0]]


def _sampled(problem: Problem, plant: SlipModel, gains: Feedback, duty: Ball) -> list[list[Ball]]:
    """Matrix from one sample to the next, with the pulses of filling and venting around a duty."""
    span = point(problem.sample_time)
    fill, vent = (Fraction(problem.nominal(name)) for name in BRAKE[1:])
    low, high = _fractions(plant.pole)
    found = sample_of(
        Times((fill, fill), (vent, vent)), (low, high), Fraction(problem.sample_time), _fractions(duty)
    )
    kept, forced, held, moved, delay = (ball(*each) for each in found)
    # Gains on (e, t, E, EE), t in the slip that it takes off per second; dU likewise.
    row = [
        plant.gain * gains.proportional,
        -gains.torque,
        plant.gain * gains.integral,
        plant.gain * gains.twice,
    ]
    first = [-moved * delay * each for each in row]
    second = [moved * each for each in row]
    return [
        [kept + first[0], -forced + first[1], first[2], first[3]],
        [second[0], held + second[1], second[2], second[3]],
        [span, 0, 1, 0],
        [0, 0, span, 1],
    ]


def _fractions(found: Ball) -> tuple[Fraction, Fraction]:
    return Fraction(below(found)), Fraction(above(found))
