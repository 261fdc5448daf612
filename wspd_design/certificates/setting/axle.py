"""The range of the load on one axle and of the common deceleration, from the load transfer of the vehicle.

Bodies and supports (bogies or single axles) pitch as in :mod:`wspd_design.plants.planar`. On n axles, a at each of
N = n/a supports, support k rests r_k of its load over the mean (1 where one body rests on all), and has the share b_k
of a body's moment, 1 at the front to -1 at the rear for two. With B and G_k the transfer by body and bogie over the
mean static wheel load, axle j of bogie k carries r_k + b_k B + g_j G_k, g_j being 1 at the first, -1 at the last and 0
at a middle axle; for two two-axle bogies these are 1 + B + G, 1 + B - G, 1 - B + G, 1 - B - G. Without inertia of the
pitch, at a deceleration d on level track,

    B = N (body mass / mass) (d / g) (body height - rod height) / spacing,
    G_k = n (bogie mass / mass) (d / g) (bogie height - rod height) / wheelbase
          + a mu (r_k + b_k B) (rod height) / wheelbase,

mu being what the wheels of the bogie make use of: its creep force is mu times its load, which its own pitch does not
change. Single axles do not pitch; the bodies take up their moments, those of all N = n of them in equal parts:

    B = N [(body mass) (d / g) (body height - rod height) + (N/bodies) (axle mass) (d / g) (axle height - rod height)
        + mu mass (rod height) / bodies] / (mass spacing).

The bodies take up what the mass gains or loses. On a grade i, positive uphill, the vehicle slows down by d + g i, of
which d, with the same range as on level track, moves the load.

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
from wspd_design.parameters.gear import gear_of
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
    gear, axles = gear_of(vehicle), vehicle.wheelsets
    spacing = _range(vehicle, "bogie_spacing")
    parts = gear.bodies * point(vehicle.body_mass) + gear.supports * point(vehicle.bogie_mass)
    spare = parts - point(vehicle.mass)  # what the file rounds
    shares: list[Ball] = []
    # The height of the rod and the mass act in opposite ways on parts of the transfer: they are taken in pieces.
    for rod, mass in product(_pieces(_ends(vehicle, "traction_rod_height")), _pieces(problem.span("mass"))):
        bogie_share = _range(vehicle, "bogie_mass") / mass
        body_share = (1 - gear.supports * bogie_share + spare / mass) / gear.bodies
        body_static = gear.supports * body_share * pull * (_range(vehicle, "body_height") - rod) / spacing
        own = axles * bogie_share * pull * (_range(vehicle, "bogie_height") - rod)
        if gear.axles == 1:
            body_static += gear.supports * (own + used * rod) / gear.bodies / spacing
        # Every share bends outwards in the transfer by the body, so that its extremes lie at the ends.
        for body in response(point(below(body_static)), point(above(body_static))):
            for support in range(gear.supports):
                resting = gear.resting[support] * gear.supports - gear.bodies
                load = 1 + point(resting) * body_share + point(gear.body_shares[support]) * body
                if gear.axles == 1:
                    shares.append(load)
                    continue
                wheelbase = _range(vehicle, "wheelbase")
                static = own / wheelbase + gear.axles * used * rod / wheelbase * load
                low, high = response(point(below(static)), point(above(static)))
                shares += [load + part * moved for part in gear.axle_shares for moved in (low, high)]
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
