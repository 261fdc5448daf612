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

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import ceil, nextafter, pi
from typing import NamedTuple

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.claim import Claim, Variable, variable
from wspd_design.certificates.kernel.finding import Finding, Place, below
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, OnPart, Special
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import BUILT_UP
from wspd_design.certificates.setting.plant import (
    EXPONENT,
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
    plant_with,
    records_of,
)
from wspd_design.certificates.theorems.invariant_sets.ball_plant import BallPlant
from wspd_design.certificates.theorems.rounding import few_digits
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis
from wspd_design.model.generated import adhesion as generated
from wspd_design.model.number import Number, atan, exp
from wspd_design.model.slip import resistance, static_wheel_load
from wspd_design.parameters.bounds import EXACT, Ends
from wspd_design.parameters.loading import constants
from wspd_design.parameters.units import KMH

REFERENCE = "slip reference"
SPAN, MOST_SPANS = 2e-3, 5000  # s, steps of the integration in balls
OPERATIONS = 300  # of one step
VALVE = ("vent time",)
DEVIATION = 0.05  # of the slip, to be brought back: as wide as the usual band around a reference
STATIC = "axle at static load, all axles alike"
HELD = (
    "semi axis rolling",
    "semi axis lateral",
    "friction ratio",
    "friction decay",
    "adhesion reduction",
    "slip reduction",
)
"""Numbers that the condition depends on and that the theorem holds: on their ranges its enclosures are too wide."""
USED = (*(name for name in PLANT if name not in ("slip", "speed", *HELD)), *VALVE)
"""Numbers that the theorem varies."""


def share_claim(problem: Problem, deviation: float, **ranges: float | Ends) -> Claim:
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
        return deviation * per_deviation(problem, x["vent time"], pole, pole / (-held.drift))

    def arranged(x: Values) -> Number:
        found = _slopes(problem, x)
        return deviation * per_deviation(problem, x["vent time"], found.pole, found.pole_over_fall)

    return Claim(
        name="share of the recoverable deviation",
        variables=(*_above_reference(problem, *VALVE, **ranges), variable(REFERENCE, problem.slip, "-")),
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
        slowing = x["wheelset inertia"] * found.deceleration - 2.0 * x["speed"] * x["wheel damping"]
        return found.creep_force * x["wheel radius"] * 2.0 + (1.0 - x["slip"]) * slowing / x["wheel radius"]

    def expression(x: Values) -> Number:
        plant = plant_dynamics(problem, x)
        return -plant.drift / plant.gain

    return Claim(
        name="holding torque",
        variables=plant_variables(problem, hold=HELD, ranges={"slip": problem.slip}),
        expression=expression,
        form=arranged,
        relation=">=",
        bound=Fraction(1),
        unit="N m",
    )


def per_deviation(problem: Problem, vent_time: Number, pole: Number, pole_over_fall: Number) -> Number:
    """Return 1/d_max, the reciprocal of the largest deviation that meets the condition.

    Where the pole is negative a deviation falls by itself and d_max may exceed the room up to slip_max; the magnitude
    only keeps the expression monotone there.

    Parameters
    ----------
    problem : Problem
        Sample time and range of slip.
    vent_time : number
        Time constant of the venting valve [s].
    pole : number
        Slope p of F [1/s].
    pole_over_fall : number
        p/g [-].
    """
    slope = pole_over_fall * (1.0 + abs(pole) * vent_time) / 2.0
    return exp(pole * problem.sample_time) * (slope + (slope**2 + 1.0 / reach(problem) ** 2) ** 0.5)


def reach(problem: Problem) -> float:
    """Return how far slip_max, where the range of slip ends, lies above the reference [-]."""
    return nextafter(problem.slips[1] - problem.slip, 0.0)  # rounded down


def _above_reference(problem: Problem, *more: str, **ranges: float | Ends) -> tuple[Variable, ...]:
    above = {"slip": (problem.slip, problem.slips[1]), **ranges}
    return plant_variables(problem, uses=(*PLANT, *more), hold=HELD, ranges=above)


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
    gravity = constants().gravity
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


class Seen(NamedTuple):
    """The state in which a law sees a deviation for the first time."""

    slip: float  # -, a lower bound
    torque: float  # N m per wheelset


def passes(problem: Problem, at: Mapping[str, float], deviation: float, work: Work) -> Seen:
    """Decide in balls whether the slip passes slip_max for certain, although the brake vents fully.

    Parameters
    ----------
    problem : Problem
        Plant and sample time.
    at : mapping
        Speed and numbers of the plant, by their names in the table [SI units].
    deviation : float
        Of the slip above its reference, one sample before the venting starts [-].
    work : Work
        What may be spent.

    Returns
    -------
    Seen
        The state from which it vents.

    Raises
    ------
    Refused
        If it is not certain that the slip passes.
    """
    plant = BallPlant(pinned(problem, at))
    point, speed, edge = plant.point, plant.point(at["speed"]), plant.point(problem.slips[1])
    gain = plant.radius / (2 * plant.inertia * speed)
    start = (-plant.rate(plant.reference, speed, point(0)) / gain).lower().min(plant.full)
    slip = (plant.reference + deviation).lower()
    holding, seen = ceil(problem.sample_time / SPAN), slip
    for k in range(1 - holding, MOST_SPANS):
        work.spend(OPERATIONS)
        # The torque falls, so that its value at the end of a step bounds the whole step.
        torque = start if k <= 0 else (start * (-k * point(SPAN) / at["vent time"]).exp()).lower()
        span = plant.sample / holding if k <= 0 else point(SPAN)
        moved = plant.advance(slip, speed, torque, span, -1)
        if moved is None or not moved[0] > slip:
            break  # once it falls it falls for good: the torque only gets smaller
        slip = moved[0]
        seen = slip if k <= 0 else seen
        if slip > edge:
            return Seen(float(seen), float(start))
    raise Refused("it is not certain that the slip passes the end of its range there")


def pinned(problem: Problem, at: Mapping[str, float]) -> Problem:
    """Return the problem at one point of the numbers of its plant, all of them known."""
    vehicle, rail = plant_with(problem, {name: x for name, x in at.items() if name in PLANT})
    return replace(problem, vehicle=vehicle, rail=rail, bounds=EXACT)


def has_room(problem: Problem) -> bool:
    """Whether the deviation lies within the range of slip."""
    return problem.slips[0] <= problem.slip < problem.slip + DEVIATION < problem.slips[1]


def place_of(problem: Problem) -> dict[str, Ends]:
    """Return the ranges in which a counterexample may lie: the speed, and the numbers that vary [SI units]."""
    numbers = {name: problem.span(name) for name in USED if problem.span(name)[0] < problem.span(name)[1]}
    return {"speed": problem.speeds, **numbers}


def _evaluate(problem: Problem, place: Place, work: Work) -> dict[str, float]:
    seen = passes(problem, {**{name: problem.nominal(name) for name in USED}, **place}, DEVIATION, work)
    return {"slip": seen.slip, "torque": seen.torque}


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    if not has_room(problem):
        raise OutsideModel(
            f"the slips {problem.slips[0]:g} to {problem.slips[1]:g} leave no room for a deviation of {DEVIATION:g} "
            f"from the reference {problem.slip:g}"
        )
    return (
        Inequality(key="torque", claim=torque_claim(problem)),
        Inequality(key="growth", claim=growth_claim(problem)),
        OnPart(
            key="share",
            claim=lambda speeds: share_claim(problem, DEVIATION, speed=speeds),
            quantity="speed",
            within=problem.speeds,
        ),
        Special(
            key="escape",
            text=f"full venting keeps the slip below {problem.slips[1]:g} at every point",
            evaluate=partial(_evaluate, problem),
            within=place_of(problem),
        ),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    torque, growth, share, escape = (findings[key] for key in ("torque", "growth", "share", "escape"))
    sound = torque.status is Status.PROVED
    lowest = _lowest(problem, share) if sound else None
    everywhere = lowest == problem.speeds[0]
    refuted = sound and escape.status is Status.REFUTED
    status = Status.REFUTED if refuted else Status.PROVED if everywhere else Status.UNDECIDED
    known = below(Fraction(DEVIATION) / Fraction(share.high)) if everywhere else 0.0
    grown = max(growth.high, 1.0)
    growing = (
        f"Until it is seen a deviation grows by a factor of at most {grown:.4g}." if growth.proved else ""
    )
    fast = escape.place["speed"] * KMH if refuted else None
    passing = (
        ""
        if fast is None
        else f"At {few_digits(fast, up=False)} km/h, frozen, no law keeps it below {problem.slips[1]:g}. "
    )
    if everywhere:
        reached = f"A deviation of {few_digits(known, up=False)} is proved to be recoverable."
    elif lowest is None:
        reached = "The recovery is proved from no speed on."
    else:
        slow = few_digits(lowest * KMH, up=True)
        between = (
            f"lies between {few_digits(fast, up=False)} and {slow}"
            if fast is not None
            else f"is at most {slow}"
        )
        reached = f"The lowest controllable speed {between} km/h; from there on the recovery is proved."
    held = tuple(name for name in HELD if problem.span(name)[0] < problem.span(name)[1])
    within = domain.domain_of(problem, ("speed", *USED), held)
    where = (
        (
            *place(escape.place, tuple(escape.place)),
            Point(name="slip", value=escape.numbers["slip"], unit="-"),
            Point(name="torque", value=escape.numbers["torque"], unit="N m"),
        )
        if refuted
        else ()
    )
    return Certificate(
        claim=f"At every frozen speed a deviation of the slip of {DEVIATION:g} above the reference {problem.slip:g}, "
        f"seen one sample of {problem.sample_time * 1e3:g} ms late, is brought back by full venting without passing "
        f"{problem.slips[1]:g}; {STATIC}, on {within.text}. Where it is not, "
        "no law can do it: venting is all that a brake can do.",
        status=status,
        explanation=" ".join(f"{passing} {growing} {reached}".split()),
        method="interval branch and bound of a sufficient condition, replayed by the independent checker; a "
        "counterexample is integrated in balls",
        margin=Range(low=known - DEVIATION, high=None, unit="-"),
        worst_point=place(share.values, ("slip", "speed", *USED)) if share.values else (),
        witness=where,
        hypotheses=(
            hypothesis("T* > 0: some torque holds the reference", torque),
            *(
                ()
                if lowest is None
                else (
                    hypothesis(
                        f"the condition holds from {few_digits(lowest * KMH, up=True)} km/h on", share
                    ),
                )
            ),
        ),
        assumptions=(
            "frozen train speed: a train that slows down meanwhile is left out, which counts at the lowest speeds",
            STATIC,
            "the slip stood at its reference and the torque at T* before; the law holds it until its next sample",
            "exact measurement, no computing time, full supply pressure",
            "a deviation below the reference is benign: the wheel falls back to rolling and brakes less",
        ),
        domain=within,
        varied=USED,
        held=held,
        reference="eqs. (9), (19); docs/theory.md#hard-limits",
    )


def _lowest(problem: Problem, share: Finding) -> float | None:
    """Return the speed from which up to the highest one the condition is proved [m/s]."""
    if share.status is not Status.PROVED or share.part is None or share.part[1] < problem.speeds[1]:
        return None
    return share.part[0]


def _always(problem: Problem) -> str:  # noqa: ARG001 - whatever the law does, venting is the most it can do
    return ""


HARD_LIMITS = Theorem(
    name="hard_limits",
    title="Limits of recovery",
    claim="Full venting brings a deviation of the slip back.",
    speaks_about=_always,
    obligations=_obligations,
    tell=_tell,
    assumes=BUILT_UP,
)
