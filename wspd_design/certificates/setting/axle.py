"""The range of the load on one axle and of the common deceleration, from the load transfer of the vehicle.

Body and bogies pitch as in :mod:`wspd_design.plants.planar`. With B and G the transfer by body and bogie over the
static wheel load, the loads of the four axles are 1 + B + G, 1 + B - G, 1 - B + G, 1 - B - G. Without inertia of the
pitch, at a deceleration d on level track,

    B = 2 (body mass / mass) (d / g) (body height - rod height) / spacing,
    G = 4 (bogie mass / mass) (d / g) (bogie height - rod height) / wheelbase + 2 mu (1 +- B) (rod height) / wheelbase,

mu being what the wheels of the bogie make use of. The body takes up what the mass gains or loses. On a grade i,
positive uphill, the vehicle slows down by d + g i, of which d, with the same range as on level track, moves the load.

Each transfer follows its static value u as y'' = w^2 (u - y) - 2 zeta w y'. With the impulse response h,
the integral of h is 1 and that of abs(h) is N = coth(pi zeta / (2 sqrt(1 - zeta^2))), the bang-bang input being the
worst; so u in [0, U] gives y in [U (1 - N)/2, U (1 + N)/2]. An input that only rises is a sum of steps, so that y
lies in [0, U (1 + exp(-pi zeta / sqrt(1 - zeta^2)))]. Neither depends on the frequency w.
"""

import math
from dataclasses import replace
from enum import Enum
from itertools import pairwise, product

from wspd_design.certificates.kernel.arb import Ball, above, ball, below, point
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Problem
from wspd_design.model.slip import resistance
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Vehicle

PIECES = 8
"""Of a range that stands in parts of opposite sign."""


class Pitching(Enum):
    """Which motions of the pitch a range of the load share covers."""

    STATIC = "the load transfer follows the deceleration without delay"
    RISING = "the static load transfer only rises"
    ANY = "any course of the braking force"


def deceleration(problem: Problem) -> Ends:
    """Range of the train deceleration [m/s2]: from the least resistance alone to all wheels at their friction.

    Every wheel brakes or rolls (no creep force pushes the train), the track is level, and friction limits the sum of
    the forces by mu0 times the weight, whatever the load transfer.
    """
    low, high = _deceleration(problem)
    return max(below(low), 0.0), above(high)


def load_share(problem: Problem, pitching: Pitching = Pitching.STATIC) -> Ends:
    """Range of the load of an axle over its static load, over all axles and all bounds of the vehicle.

    Parameters
    ----------
    problem : Problem
        Vehicle, rail and domain.
    pitching : Pitching
        Motions of the pitch that the range covers.

    Returns
    -------
    tuple of float
        Rounded outwards.

    Raises
    ------
    OutsideModel
        If an axle may lose its load.
    """
    vehicle = problem.vehicle
    up, down = _gains(vehicle, pitching)

    def response(low: Ball, high: Ball) -> tuple[Ball, Ball]:
        low, high = min(low, point(0.0), key=below), max(high, point(0.0), key=above)
        return up * low + down * high, up * high + down * low

    slowest, fastest = _deceleration(problem)
    pull = (fastest / point(constants().gravity)).union(slowest / point(constants().gravity))
    used = ball(0.0, problem.span("mu0")[1]) * grip(problem)
    spacing, wheelbase = _range(vehicle, "bogie_spacing"), _range(vehicle, "wheelbase")
    spare = (
        point(vehicle.body_mass) + 2 * point(vehicle.bogie_mass) - point(vehicle.mass)
    )  # what the file rounds
    shares: list[Ball] = []
    # The height of the rod and the mass act in opposite ways on parts of the transfer: they are taken in pieces.
    for rod, mass in product(_pieces(_ends(vehicle, "traction_rod_height")), _pieces(problem.span("mass"))):
        bogie_share = _range(vehicle, "bogie_mass") / mass
        body_share = 1 - 2 * bogie_share + spare / mass
        body_static = 2 * body_share * pull * (_range(vehicle, "body_height") - rod) / spacing
        own = 4 * bogie_share * pull * (_range(vehicle, "bogie_height") - rod) / wheelbase
        by_rod = 2 * used * rod / wheelbase
        # Every share bends outwards in the transfer by the body, so that its extremes lie at the ends.
        for body in response(point(below(body_static)), point(above(body_static))):
            for load in (1 + body, 1 - body):
                static = own + by_rod * load
                low, high = response(point(below(static)), point(above(static)))
                shares += [load + low, load + high, load - low, load - high]
    least, most = min(map(below, shares)), max(map(above, shares))
    if not (least > 0.0 and math.isfinite(most)):
        raise OutsideModel(
            f"the load transfer of {vehicle.name} leaves an axle between {least:.3g} and {most:.3g} of its static load"
        )
    return least, most


def grip(problem: Problem) -> Ball:
    """Return the most that Polach's law gives of mu0 times the load.

    Its shape (x/(1 + x^2) + atan(k x)) 2/pi, k = kS/kA, stays below 1 if k <= 1, since it rises to 1 at k = 1; it
    stays below 1 + 1/pi always.
    """
    (reduced, _), (_, slid) = problem.span("adhesion reduction"), problem.span("slip reduction")
    return point(1.0) if slid <= reduced else 1 + 1 / point(1.0).pi()


def _deceleration(problem: Problem) -> tuple[Ball, Ball]:
    """Least and largest deceleration [m/s2]."""
    names = ("resistance constant", "resistance linear", "resistance quadratic")
    rolling = []
    for end in (0, 1):
        numbers = {name.replace(" ", "_"): point(problem.span(name)[end]) for name in names}
        rolling.append(resistance(replace(problem.vehicle, **numbers), point(problem.speeds[end])))
    light, heavy = (point(each) for each in problem.span("mass"))
    friction = point(problem.span("mu0")[1]) * grip(problem) * point(constants().gravity)
    return rolling[0] / heavy, friction + rolling[1] / light


def _gains(vehicle: Vehicle, pitching: Pitching) -> tuple[Ball, Ball]:
    """Factors up and down: a static transfer in [0, U] gives one in [down U, up U]."""
    if pitching is Pitching.STATIC:
        return point(1.0), point(0.0)
    least = _range(vehicle, "pitch_damping_ratio").lower()
    if least >= 1:
        return point(1.0), point(0.0)
    falling = (-least.pi() * least / (1 - least * least).sqrt()).exp()
    if pitching is Pitching.RISING:
        return 1 + falling, point(0.0)
    if below(least) <= 0.0:
        raise OutsideModel(f"pitch_damping_ratio of {vehicle.name} may be 0: the load transfer has no bound")
    most = (1 + falling) / (1 - falling)
    return (1 + most) / 2, (1 - most) / 2


def _ends(vehicle: Vehicle, name: str) -> Ends:
    return vehicle.bounds.around(name, getattr(vehicle, name))


def _range(vehicle: Vehicle, name: str) -> Ball:
    return ball(*_ends(vehicle, name))


def _pieces(ends: Ends) -> list[Ball]:
    """Balls that cover a range."""
    low, high = ends
    edges = [low + (high - low) * k / PIECES for k in range(PIECES)] + [high]
    return [ball(*pair) for pair in pairwise(edges)]
