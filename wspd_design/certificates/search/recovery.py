"""How large a deviation of the slip a brake can bring back by venting fully, whatever law commands it.

The slip stands above its reference by x while the torque is T*, which holds the reference. No valve empties the
cylinder faster than T* exp(-t/tau), and less torque means less slip: full venting is the best that any law can do.
With it x' = F - F* - g (1 - exp(-t/tau)), F* = F at the reference, g = G T* = -F*. Let p be the largest slope of F
from the reference up to slip_max, which lies X above it. A deviation d that is seen one sample late, as
A = d exp(p h), then stays below X and falls back if

    (A/X)^2 + A p (1 + p tau)/g <= 1.

docs/theory.md#hard-limits has the proof. The condition is sufficient: friction that falls less and less with sliding
allows more. What is possible at single points of the domain is found by integration.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from math import ceil, nextafter, pi
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.kernel.claim import Claim, Variable, variable
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import INERTIA, MASS, MU0, SLIP, SPEED
from wspd_design.certificates.setting.plant import (
    EXPONENT,
    Values,
    plant_dynamics,
    plant_forces,
    plant_variables,
    records_of,
)
from wspd_design.certificates.theorems.invariant_sets.ball_plant import BallPlant
from wspd_design.model.generated import adhesion as generated
from wspd_design.model.number import Number, atan, exp
from wspd_design.model.slip import resistance, static_wheel_load
from wspd_design.parameters.loading import constants

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

REFERENCE = "slip reference"
VENT_STEPS, HOLD_STEPS = 80, 24  # of the integration
SPAN, MOST_SPANS = 2e-3, 5000  # s, steps of the integration in balls


def share_claim(problem: Problem, deviation: float, **ranges: float | tuple[float, float]) -> Claim:
    """Claim that venting brings a deviation back: it uses at most the whole of what the condition allows.

    Parameters
    ----------
    problem : Problem
        Plant, domain and sample time; the slip range ends at slip_max.
    deviation : float
        Of the slip above its reference when it appears [-].
    **ranges : float or tuple of float
        Other ranges of the quantities, as in :func:`plant_variables`.

    Returns
    -------
    Claim
        d/d_max <= 1, d_max the largest deviation that meets the condition with the slope at one slip.
    """

    def expression(x: Values) -> Number:
        held = plant_dynamics(problem, {**x, "slip": x[REFERENCE]})
        pole = plant_dynamics(problem, x).pole
        return deviation * per_deviation(problem, pole, pole / (-held.drift))

    def arranged(x: Values) -> Number:
        found = _slopes(problem, x)
        return deviation * per_deviation(problem, found.pole, found.pole_over_fall)

    return Claim(
        name="share of the recoverable deviation",
        variables=(*_above_reference(problem, **ranges), variable(REFERENCE, problem.slip, "-")),
        expression=expression,
        form=arranged,
        relation="<=",
        bound=Fraction(1),
        unit="-",
    )


def growth_claim(problem: Problem, bound: float = 1.0) -> Claim:
    """Claim about the factor exp(p h) by which a deviation grows until the next sample."""
    sample = problem.sample_time
    return Claim(
        name="growth within a sample",
        variables=_above_reference(problem),
        expression=lambda x: exp(plant_dynamics(problem, x).pole * sample),
        form=lambda x: exp(plant_forces(problem, x).pole * sample),
        relation="<=",
        bound=Fraction(bound),
        unit="-",
    )


def torque_claim(problem: Problem) -> Claim:
    """Claim that some torque holds the reference: T* > 0, here at least 1 N m."""

    def arranged(x: Values) -> Number:
        found = plant_forces(problem, x)
        slowing = x["wheelset inertia"] * found.deceleration - 2.0 * x["speed"] * x["wheel_damping"]
        return found.creep_force * x["wheel_radius"] * 2.0 + (1.0 - x["slip"]) * slowing / x["wheel_radius"]

    def expression(x: Values) -> Number:
        plant = plant_dynamics(problem, x)
        return -plant.drift / plant.gain

    return Claim(
        name="holding torque",
        variables=plant_variables(problem, slip=problem.slip),
        expression=expression,
        form=arranged,
        relation=">=",
        bound=Fraction(1),
        unit="N m",
    )


def per_deviation(problem: Problem, pole: Number, pole_over_fall: Number) -> Number:
    """Return 1/d_max, the reciprocal of the largest deviation that meets the condition.

    Where the pole is negative a deviation falls by itself and d_max may exceed the room up to slip_max; the magnitude
    only keeps the expression monotone there.

    Parameters
    ----------
    problem : Problem
        Valve, sample time and range of slip.
    pole : number
        Slope p of F [1/s].
    pole_over_fall : number
        p/g [-].
    """
    slope = pole_over_fall * (1.0 + abs(pole) * problem.vehicle.brake.vent_time) / 2.0
    return exp(pole * problem.sample_time) * (slope + (slope**2 + 1.0 / reach(problem) ** 2) ** 0.5)


def reach(problem: Problem) -> float:
    """Return how far slip_max, where the range of slip ends, lies above the reference [-]."""
    return nextafter(problem.slips[1] - problem.slip, 0.0)  # rounded down


def _above_reference(problem: Problem, **ranges: float | tuple[float, float]) -> tuple[Variable, ...]:
    return plant_variables(problem, slip=(problem.slip, problem.slips[1]), **ranges)


class _Slopes(NamedTuple):
    """What the condition is made of, arranged for intervals."""

    pole: Number  # p, 1/s
    pole_over_fall: Number  # p/g, -


def _slopes(problem: Problem, x: Values) -> _Slopes:
    """Arrange p and p/g: over friction, load and inertia, which p and g have in common.

    The load that an inertia carries, R^2 Q/I, and mu0 are divided out of both; see ``plant.forces`` for Polach's force.
    """
    vehicle, rail = records_of(x, problem.vehicle, problem.rail)
    contact, speed, slip, reference = vehicle.contact, x["speed"], x["slip"], x[REFERENCE]
    load = static_wheel_load(vehicle)
    if problem.contact_grows_with_load:
        per_load = (load / contact.reference_load) ** (EXPONENT - 1.0) / contact.reference_load
    else:
        nominal = static_wheel_load(replace(vehicle, mass=x["nominal mass"]))
        per_load = (nominal / contact.reference_load) ** EXPONENT / load
    stiffness = generated.contact_stiffness(
        contact.shear_modulus, contact.semi_axis_rolling, contact.semi_axis_lateral, contact.kalker_c11
    )
    steep = stiffness * per_load / rail.mu0
    carried = load * vehicle.wheel_radius**2
    ratio = vehicle.wheel_inertia / carried
    gravity = 8.0 * constants().gravity / (2 * vehicle.wheelsets)
    drag = resistance(vehicle, speed) / (vehicle.mass * rail.mu0)
    damping = speed * vehicle.wheel_damping / (carried * rail.mu0)

    def used(at: Number) -> tuple[Number, Number]:
        """Force over load and mu0, and its slope in the slip."""
        falling = (1.0 - rail.friction_ratio) * exp(-rail.friction_decay * (at * speed))
        friction = rail.friction_ratio + falling
        gradient = steep * at / friction
        weak, slow = rail.adhesion_reduction * gradient, rail.slip_reduction * gradient
        adhesion, sliding = weak**2 + 1.0, slow**2 + 1.0
        by_creep = steep * (
            rail.adhesion_reduction * (2.0 - adhesion) / adhesion**2 + rail.slip_reduction / sliding
        )
        shape = weak**3 * 2.0 / adhesion**2 + atan(slow) - slow / sliding
        force = friction * (weak / adhesion + atan(slow)) * 2.0 / pi
        return force, (by_creep - rail.friction_decay * falling * shape * speed) * (2.0 / pi)

    (held, _), (force, slope) = used(reference), used(slip)
    fall = held + (1.0 - reference) * (ratio * (held * gravity + drag) - damping)
    rise = ratio * (force * gravity + drag) - slope * (1.0 + (1.0 - slip) * (ratio * gravity)) - damping
    return _Slopes(pole=rise * rail.mu0 / (ratio * speed), pole_over_fall=rise / fall)


def recoverable(problem: Problem, points: "Array") -> "Array":
    """Integrate how large a deviation may be that full venting, one sample late, keeps below slip_max [-].

    The path that just touches slip_max is followed backwards, from where its slip stands still to where it began.

    Parameters
    ----------
    problem : Problem
        Plant and sample time.
    points : ndarray
        Points of the domain, in the order of its columns; their slip does not matter.
    """
    import numpy as np

    brake, room = problem.vehicle.brake, reach(problem)
    at = points.copy()

    def dynamics(slip: "float | Array") -> tuple["Array", "Array"]:
        at[:, SLIP] = slip
        plant = domain.dynamics(problem, at)
        return plant.drift, plant.gain

    def back(x: "Array", torque: Callable[[float], "Array"], step: "float | Array", count: int) -> "Array":
        """Follow the deviation backwards through steps of Runge and Kutta; the torque takes the count of steps."""

        def rate(k: float, x: "Array") -> "Array":
            drift, gain = dynamics(problem.slip + x)
            found: Array = -(drift + gain * torque(k))
            return found

        for k in range(count):
            one = rate(k, x)
            two = rate(k + 0.5, x + 0.5 * step * one)
            three = rate(k + 0.5, x + 0.5 * step * two)
            four = rate(k + 1, x + step * three)
            x = np.clip(x + step * (one + 2.0 * two + 2.0 * three + four) / 6.0, 0.0, room)
        return x

    drift, gain = dynamics(problem.slip)
    start = np.minimum(-drift / gain, brake.max_torque)
    drift, gain = dynamics(problem.slips[1])
    touching = np.clip(-drift / gain, 1e-9 * start, start)
    step = brake.vent_time * np.log(start / touching) / VENT_STEPS
    seen = back(
        np.full(len(points), room), lambda k: touching * np.exp(k * step / brake.vent_time), step, VENT_STEPS
    )
    return back(seen, lambda _: start, problem.sample_time / HOLD_STEPS, HOLD_STEPS)


class Seen(NamedTuple):
    """The state in which a law sees a deviation for the first time."""

    slip: float  # -, a lower bound
    torque: float  # N m per wheelset


def passes(problem: Problem, at: "Array", deviation: float) -> Seen | None:
    """Decide in balls whether the slip passes slip_max for certain, although the brake vents fully.

    Parameters
    ----------
    problem : Problem
        Plant and sample time.
    at : ndarray
        One point of the domain; its slip does not matter.
    deviation : float
        Of the slip above its reference, one sample before the venting starts [-].

    Returns
    -------
    Seen or None
        The state from which it vents, or None if it is not certain that the slip passes.
    """
    mass, inertia, mu0, brake = float(at[MASS]), float(at[INERTIA]), float(at[MU0]), problem.vehicle.brake
    pinned = replace(problem, mass_bounds=(mass,) * 2, inertia_bounds=(inertia,) * 2, mu0_bounds=(mu0,) * 2)
    plant = BallPlant(pinned)
    point, speed, edge = plant.point, plant.point(float(at[SPEED])), plant.point(problem.slips[1])
    gain = plant.radius / (2 * plant.inertia * speed)
    start = (-plant.rate(plant.reference, speed, point(0)) / gain).lower().min(plant.full)
    slip = (plant.reference + deviation).lower()
    holding, seen = ceil(problem.sample_time / SPAN), slip
    for k in range(1 - holding, MOST_SPANS):
        # The torque falls, so that its value at the end of a step bounds the whole step.
        torque = start if k <= 0 else (start * (-k * point(SPAN) / brake.vent_time).exp()).lower()
        span = plant.sample / holding if k <= 0 else point(SPAN)
        moved = plant.advance(slip, speed, torque, span, -1)
        if moved is None or not moved[0] > slip:
            return None  # once it falls it falls for good: the torque only gets smaller
        slip = moved[0]
        seen = slip if k <= 0 else seen
        if slip > edge:
            return Seen(float(seen), float(start))
    return None
