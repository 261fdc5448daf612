"""The range of q = p - a/v near the reference, with the numbers of contact and friction on their ranges.

The creep force depends on few combinations of its numbers. With the stiffness over the load C, the steepness
z = kA C slip / mu0, k = kS/kA and the sliding speed s = slip v,

    p - a/v = -mu0 N S(z, k, A, B, s) - B_W / I,   N = Q R^2 / I + (1 - slip) 8 g / (number of wheels),

where S is the slope of the force over mu0 Q and v, the same for every wheel load, mass and radius. It is that of a
wheel with kA = mu0 = slip = N = 1, C = z and kS = k at the speed s, on which the kernels are evaluated. The quantity
"steepness" is the shear modulus that gives this wheel its C.
"""

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise, product
from typing import Any

from wspd_design.certificates.kernel.arb import Ball, above, below, point
from wspd_design.certificates.kernel.checker import Ends as Balls
from wspd_design.certificates.kernel.checker import Refused, add, inverse, mul, power
from wspd_design.certificates.kernel.claim import Claim, Expression, Relation, variable
from wspd_design.certificates.quantities import QUANTITIES
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.plant import EXPONENT, Values, forces
from wspd_design.model.adhesion import contact_stiffness
from wspd_design.model.generated.adhesion import creep_force, creep_force_speed_derivative
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics, static_wheel_load, wheels
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

BITS = 128  # of the balls that the bend of the force is enclosed in
PARTS = (
    16,
    4,
    8,
)  # of speed, what a wheel slides slower, and steepness, in which derivatives of the force are enclosed
FINER = 32, 16  # parts of speed and steepness, in which differences of its change are enclosed
REDUCTIONS = "slip reduction", "adhesion reduction"
STEEPNESS, RATIO, SLIDING, NORMAL_MASS = "steepness", "kS/kA", "sliding speed", "normal mass"
USED = (
    "speed",
    "mass",
    "wheelset inertia",
    "wheel radius",
    "wheel damping",
    "shear modulus",
    "semi axis rolling",
    "semi axis lateral",
    "kalker c11",
    "reference load",
    "mu0",
    "adhesion reduction",
    "slip reduction",
)
"""What q depends on, beside the slip, and the claims vary."""

HELD = ("friction ratio", "friction decay")
"""What q depends on and the claims hold: with their ranges too a proof would take some 50 000 boxes."""


def steepness_of(problem: Problem) -> Ends:
    """Range of the steepness over the slip, as the shear modulus that stands for it [Pa]."""
    from flint import ctx

    with ctx.workprec(BITS):
        return _doubles(_steepness(problem))


def slope_claim(problem: Problem, slips: Ends, relation: Relation, bound: Fraction) -> Claim:
    """Claim that -S stays on one side of a bound [s/m], for all slips of a range and all numbers of the domain."""

    def expression(x: Values) -> Number:
        return slip_dynamics(*_normal(problem, x), 1.0, x[SLIDING], deceleration=0.0).pole

    def arranged(x: Values) -> Number:
        return forces(*_normal(problem, x), 1.0, x[SLIDING], deceleration=0.0).pole

    name = "slope of the creep force over mu0 Q v, falling"
    return _claim(problem, slips, name, expression, relation, bound, "s/m", form=arranged)


def level_claim(problem: Problem, slips: Ends, relation: Relation, bound: Fraction) -> Claim:
    """Claim that the creep force over mu0 Q stays on one side of a bound [-]; the rest as in :func:`slope_claim`."""

    def expression(x: Values) -> Number:
        vehicle, rail = _normal(problem, x)
        force = slip_dynamics(vehicle, rail, 1.0, x[SLIDING], deceleration=0.0).creep_force
        return force / static_wheel_load(vehicle)

    return _claim(problem, slips, "creep force over mu0 Q", expression, relation, bound, "-")


def fading_claim(problem: Problem, slips: Ends, relation: Relation, bound: Fraction) -> Claim:
    """Claim a bound on how the creep force over mu0 Q changes with the sliding speed at a fixed slip [s/m]."""

    def expression(x: Values) -> Number:
        vehicle, rail = _normal(problem, x)
        load = static_wheel_load(vehicle)
        stiffness = contact_stiffness(vehicle.contact, load)
        friction = (rail.mu0, rail.friction_ratio, rail.friction_decay)
        reductions = (rail.adhesion_reduction, rail.slip_reduction)
        return creep_force_speed_derivative(1.0, x[SLIDING], load, *friction, *reductions, stiffness) / load

    name = "change of the creep force over mu0 Q with the sliding speed"
    return _claim(problem, slips, name, expression, relation, bound, "s/m")


def for_steepness(claim: Claim, slips: Ends, steepness: Ends) -> Claim:
    """Restrict a claim about a range of slips to those numbers whose steepness lies in a range, a part of all of it."""
    part = variable(STEEPNESS, _doubles(mul(_wide(slips), _wide(steepness))), "Pa")
    return replace(
        claim, variables=tuple(part if each.name == STEEPNESS else each for each in claim.variables)
    )


@lru_cache(maxsize=1000)
def along_speed(problem: Problem, slip: float, beside: Ends) -> tuple[Ends, Ends]:
    """Enclose both derivatives of the creep force over mu0 Q in the train speed [s/m, s2/m2].

    The wheel slides slower than at a slip by a speed that does not change, from a range [m/s]. The derivatives are
    those of power series in balls, over parts of the ranges.
    """
    from flint import ctx

    with ctx.workprec(BITS):
        ratio = _quotient(problem, *REDUCTIONS)
        found = [
            _force_along(problem, slip, (*parts, ratio[0].union(ratio[1])))
            for parts in product(
                _parts(_span(problem, "speed"), PARTS[0]),
                _parts(_wide(beside), PARTS[1]),
                _parts(_steepness(problem), PARTS[2]),
            )
        ]
        first, second = ([times * each[times] for each in found] for times in (1, 2))
        return (min(map(below, first)), max(map(above, first))), (
            min(map(below, second)),
            max(map(above, second)),
        )


@lru_cache(maxsize=1000)
def fading_beside(problem: Problem, slip: float, beside: Ends) -> Ends:
    """Enclose what the creep force over mu0 Q changes by with the train speed, at a slip less than beside it [s/m].

    Beside it the wheel slides slower by a speed that does not change, from a range [m/s].
    """
    from flint import ctx

    with ctx.workprec(BITS):
        ratio = _quotient(problem, *REDUCTIONS)
        found = []
        for at, steepness in product(
            _parts(_span(problem, "speed"), FINER[0]), _parts(_steepness(problem), FINER[1])
        ):
            own, other = (
                _force_along(problem, slip, (at, less, steepness, ratio[0].union(ratio[1])))[1]
                for less in (point(0), point(beside[0]).union(point(beside[1])))
            )
            found.append(own - other)
        return min(map(below, found)), max(map(above, found))


def _force_along(problem: Problem, slip: float, numbers: tuple[Ball, Ball, Ball, Ball]) -> Any:
    """Return the creep force over mu0 Q as a series in the train speed.

    For balls of that, of what the wheel slides slower, of the modulus for slip 1, and of kS/kA.
    """
    from flint import arb_series

    at, less, steepness, ratio = numbers
    speed = arb_series([at, 1], prec=3)
    sliding = speed * point(slip) - less
    # Of a wheel that turns faster than the train the friction falls with what this number rises by.
    if not sliding[0] > 0:
        raise Refused("errors are counted from where wheels may turn faster than the train")
    values = {name: problem.nominal(name) for name in HELD} | {NORMAL_MASS: 1.0, RATIO: ratio}
    vehicle, rail = _normal(problem, values | {STEEPNESS: steepness * (point(slip) - less / speed)})
    load = static_wheel_load(vehicle)
    force = creep_force(
        1.0,
        sliding,
        load,
        rail.mu0,
        rail.friction_ratio,
        rail.friction_decay,
        rail.adhesion_reduction,
        rail.slip_reduction,
        contact_stiffness(vehicle.contact, load),
    )
    return force / load


def _parts(ends: Balls, count: int) -> tuple[Ball, ...]:
    """Divide a range into balls; one number is one."""
    low, high = ends
    if low == high:
        return (low,)
    edges = [low + (high - low) * k / count for k in range(count + 1)]
    return tuple(one.union(other) for one, other in pairwise(edges))


def _claim(
    problem: Problem,
    slips: Ends,
    name: str,
    expression: Expression,
    relation: Relation,
    bound: Fraction,
    unit: str,
    *,
    form: Expression | None = None,
) -> Claim:
    """Claim a bound about the normal wheel."""
    return Claim(
        name=name,
        variables=(
            variable(STEEPNESS, _doubles(mul(_wide(slips), _steepness(problem))), "Pa"),
            variable(RATIO, _doubles(_quotient(problem, *REDUCTIONS)), "-"),
            *(variable(held, problem.nominal(held), QUANTITIES[held].unit) for held in HELD),
            variable(NORMAL_MASS, 1.0, "kg"),
            variable(SLIDING, _doubles(mul(_wide(slips), _span(problem, "speed"))), "m/s"),
        ),
        expression=expression,
        form=form,
        relation=relation,
        bound=bound,
        unit=unit,
    )


def poles(problem: Problem, slips: Ends, least: float, most: float) -> Ends:
    """Return a range that q cannot leave while -S lies between two numbers [1/s]."""
    inertia = mul(_span(problem, "wheelset inertia"), _one(0.5))
    radius, share = _span(problem, "wheel radius"), _gravity(problem)
    rim = mul(mul(mul(_span(problem, "mass"), share), inverse(inertia)), mul(radius, radius))
    rolling = mul(_wide((1.0 - slips[1], 1.0 - slips[0])), mul(share, _one(wheels(problem.vehicle))))
    low, high = mul(mul(_wide((least, most)), _span(problem, "mu0")), add(rim, rolling))
    least_damping, most_damping = mul(_span(problem, "wheel damping"), inverse(inertia))
    return _doubles((low - most_damping, high - least_damping))


def _normal(problem: Problem, x: Values) -> tuple[Vehicle, Rail]:
    """Wheel with N = 1 at slip 1, kA = mu0 = 1 and its steepness in place of the shear modulus."""
    vehicle = replace(problem.vehicle, mass=x[NORMAL_MASS])
    load = static_wheel_load(vehicle)
    contact = replace(
        vehicle.contact,
        shear_modulus=x[STEEPNESS],
        semi_axis_rolling=1.0,
        semi_axis_lateral=1.0,
        kalker_c11=1.0,
        reference_load=load,
    )
    normal = replace(
        vehicle,
        wheelset_inertia=2.0 * load,
        wheel_radius=1.0,
        wheel_damping=0.0,
        contact=contact,
    )
    rail = replace(
        problem.rail,
        mu0=1.0,
        adhesion_reduction=1.0,
        slip_reduction=x[RATIO],
        friction_ratio=x["friction ratio"],
        friction_decay=x["friction decay"],
    )
    return normal, rail


def _steepness(problem: Problem) -> Balls:
    """Range of the shear modulus that gives the normal wheel at slip 1 the steepness z = kA C slip / mu0."""
    share, power_of_load = _gravity(problem), Fraction(EXPONENT)
    load, reference = mul(_span(problem, "mass"), share), _span(problem, "reference load")
    found = share
    for name in ("shear modulus", "semi axis rolling", "semi axis lateral", "kalker c11"):
        found = mul(found, _span(problem, name))
    if problem.contact_grows_with_load:
        per_load = mul(power(load, power_of_load - 1), power(reference, -power_of_load))
    else:
        growth = mul(mul(_one(problem.vehicle.mass), share), inverse(reference))
        per_load = mul(power(growth, power_of_load), inverse(load))
    return mul(mul(found, per_load), _quotient(problem, "adhesion reduction", "mu0"))


def _quotient(problem: Problem, above: str, below: str) -> Balls:
    return mul(_span(problem, above), inverse(_span(problem, below)))


def _gravity(problem: Problem) -> Balls:
    """Static wheel load per mass [m/s2]."""
    return mul(_one(constants().gravity), inverse(_one(wheels(problem.vehicle))))


def _span(problem: Problem, name: str) -> Balls:
    return _wide(domain.span(problem, name))


def _wide(ends: Ends) -> Balls:
    return point(ends[0]), point(ends[1])


def _one(number: float) -> Balls:
    return _wide((number, number))


def _doubles(found: Balls) -> Ends:
    return below(found[0]), above(found[1])
