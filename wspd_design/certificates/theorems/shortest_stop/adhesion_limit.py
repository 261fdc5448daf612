"""What no controller can beat: the stop that upper bounds of the adhesion peak and a filling brake leave at best.

* **Adhesion.** A wheel gives at most Q mu(v), mu(v) the largest of f/Q over all slips at speed v. Hence
  v' >= -P(v), P = (f_d + m g mu)/m, and from v to standstill a train needs at least the time int dv/P and the
  distance int v dv/P. ``adhesion_peaks.py`` shows the bounds of mu that are taken here.
* **Momentum.** Adding (1) and (2) of all wheels, R m v' + I_w sum omega' = -R f_d - sum T - 2 B sum omega with the
  inertia I_w of a wheelset. A wheel is hardly ever faster than the train: at a slip of -s its creep force slows it
  down at least as much as the train is slowed down. If all wheelsets are alike that is by resistance alone,
  |f(s)| (8/m + 2 R^2/I_w) >= (1 + s) f_d/m; else the others may brake, |f(s)| 2 R^2/I_w >= (1 + s) (f_d/m + g mu).
  So R omega <= (1 + s) v for good. With n wheelsets, T at most the torque T_fill of a brake that only fills, and f_d
  and B largest at the start,

      (m + n I_w/R^2) (v0 - v(t)) <= (f_d(v0) + 2 n B v0 (1 + s)/R^2) t + (n/R) int T_fill dt + n I_w s v0/R^2.

  Until any instant t1 this bounds the speed from below, and from then on adhesion does; the best t1 counts.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from wspd_design.certificates.kernel.arb import Ball, below, in_balls, point
from wspd_design.certificates.theorems.shortest_stop.extremes import Extremes
from wspd_design.model import adhesion, brake
from wspd_design.model.generated import adhesion as generated
from wspd_design.model.slip import resistance
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Vehicle

INSTANTS = 120  # of the change from momentum to adhesion
OVERSPEEDS = (1e-4, 1e-3, 2e-3, 5e-3, 1e-2, 1.4e-2, 2e-2, 3e-2, 5e-2)
"""Slips of which a wheel does not exceed the first that will do forwards; wheelsets that are alike need the first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """Lower bounds for every controller, and what they are made of."""

    time: float  # s
    distance: float  # m
    adhesion_time: float  # s, from the adhesion peak alone
    adhesion_distance: float  # m
    handover: float  # s, t1
    speeds: tuple[Fraction, ...]  # m/s, rising from standstill to the start
    peaks: tuple[Fraction, ...]  # -, upper bounds of f/Q on the interval above each speed but the last


class NoBound(UserError):
    """What the bound rests on does not hold for a vehicle or a rail."""


def overspeed(plants: Extremes, initial_speed: float) -> float:
    """Return a slip that no wheel ever exceeds forwards, or refuse what the derivation does not cover.

    Parameters
    ----------
    plants : Extremes
        Plants on level track.
    initial_speed : float
        Wheels roll and cylinders are empty there [m/s].

    Raises
    ------
    NoBound
        If friction does not fall with the sliding speed, the resistance does not grow with speed, or a wheel might
        outrun the train.
    """
    vehicle, rail = plants.weak, plants.weak_rail
    positive = (rail.mu0, rail.friction_ratio, rail.adhesion_reduction, rail.slip_reduction)
    growing = plants.strong_rail.friction_ratio > 1.0 or plants.strong_rail.friction_decay < 0.0
    if growing or not min(positive) > 0.0:
        raise NoBound("a bound on the stop needs friction that is positive and never grows with sliding")
    for least in (vehicle, plants.strong):
        if min(least.resistance_constant, least.resistance_linear, least.resistance_quadratic) < 0.0:
            raise NoBound("a bound on the stop needs a resistance without negative parts")
    for slip in OVERSPEEDS[: 1 if plants.others is None else None]:
        if _held_back(plants, slip, initial_speed):
            return slip
    raise NoBound(
        "the resistance or the other wheels could make a wheel outrun the train; a bound on the stop does not hold then"
    )


def _held_back(plants: Extremes, slip: float, initial_speed: float) -> bool:
    """Whether the creep force at a small slip forwards is certain to slow a wheel down as much as the train.

    Both sides are divided by mu0, since rail and wheels share it.
    """
    vehicle, speed = in_balls(plants.weak), point(initial_speed)
    force = _least_force(plants, point(slip), speed)
    back = force * 2 * vehicle.wheel_radius**2 / vehicle.wheelset_inertia
    train = resistance(vehicle, speed) / vehicle.mass / point(plants.weak_rail.mu0)
    if plants.others is None:
        back += force * 2 * vehicle.wheelsets / vehicle.mass
    else:
        train += point(plants.others)
    return bool(back >= (1 + point(slip)) * train)


def _least_force(plants: Extremes, slip: Ball, speed: Ball) -> Ball:
    """Bound the creep force at a slip, over mu0, from below [N].

    It grows with load and friction; x/(1 + x^2) is least at an end of the range of x.
    """
    weak, strong = in_balls(plants.weak_rail), in_balls(plants.strong_rail)
    friction = generated.friction_coefficient(
        slip * speed, point(1.0), weak.friction_ratio, weak.friction_decay
    )
    load, softest = loaded(in_balls(plants.weak), plants.share)
    _, stiffest = loaded(in_balls(plants.strong), plants.most)
    gradient, steepest = (
        stiffness * slip / (mu0 * friction * load)
        for stiffness, mu0 in ((softest, strong.mu0), (stiffest, weak.mu0))
    )
    ends = (weak.adhesion_reduction * gradient, strong.adhesion_reduction * steepest)
    first, second = (x / (1 + x * x) for x in ends)
    shape = first.min(second) + (weak.slip_reduction * gradient).atan()
    return 2 * friction * load / point(0.0).pi() * shape


def loaded(vehicle: Vehicle, share: float) -> tuple[Ball, Ball]:
    """Return a wheel load [N] and the contact stiffness there [N], for a share of the static load."""
    load = vehicle.mass * constants().gravity / (2 * vehicle.wheelsets) * point(share)
    return load, adhesion.contact_stiffness(vehicle.contact, load)


def stop_limit(plants: Extremes, speeds: Sequence[Fraction], peaks: Sequence[Fraction]) -> Limit:
    """Bound time and distance of every stop from below.

    Parameters
    ----------
    plants : Extremes
        Plants that the bound covers.
    speeds : sequence of Fraction
        Rising from standstill to the initial speed [m/s].
    peaks : sequence of Fraction
        Upper bounds of f/Q on the interval above each speed but the last [-]. They have to be shown elsewhere.

    Raises
    ------
    NoBound
        If the derivation does not cover the plants.
    """
    ahead = overspeed(plants, float(speeds[-1]))
    times, distances = _remaining(in_balls(plants.strong), speeds, peaks)
    time, distance, handover = _filling(plants, ahead, speeds, times, distances)
    return Limit(
        time=below(time),
        distance=below(distance),
        adhesion_time=below(times[-1]),
        adhesion_distance=below(distances[-1]),
        handover=handover,
        speeds=tuple(speeds),
        peaks=tuple(peaks),
    )


def slowest(plants: Extremes, ahead: float, initial_speed: Fraction, time: float) -> Ball:
    """Lower bound of the speed by momentum [m/s], ``time`` [s] after the start; no slip falls below -``ahead``."""
    vehicle, weak = in_balls(plants.strong), in_balls(plants.weak)
    count, radius = vehicle.wheelsets, weak.wheel_radius
    start, overspeed = point(initial_speed), point(ahead)
    drag = (
        resistance(vehicle, start) + 2 * count * vehicle.wheel_damping * start * (1 + overspeed) / radius**2
    )
    impulse = (
        drag * time
        + count / radius * _filled(vehicle, time)
        + count * weak.wheelset_inertia * overspeed * start / radius**2
    )
    return start - impulse / (vehicle.mass + count * vehicle.wheelset_inertia / vehicle.wheel_radius**2)


def _remaining(
    vehicle: Vehicle, speeds: Sequence[Fraction], peaks: Sequence[Fraction]
) -> tuple[list[Ball], list[Ball]]:
    """Least time and distance from each speed to standstill, by adhesion."""
    times, distances = [point(0.0)], [point(0.0)]
    gravity = point(constants().gravity)
    for (low, high), top in zip(pairwise(speeds), peaks, strict=True):
        strongest = resistance(vehicle, point(high)) / vehicle.mass + gravity * point(top)
        span = point(high - low) / strongest
        times.append(times[-1] + span)
        distances.append(distances[-1] + span * point((low + high) / 2))
    return times, distances


def _filling(
    plants: Extremes,
    ahead: float,
    speeds: Sequence[Fraction],
    times: Sequence[Ball],
    distances: Sequence[Ball],
) -> tuple[Ball, Ball, float]:
    """Least time and distance with the momentum that a filling brake can take until it hands over."""
    best_time, best_distance, handover = times[-1], distances[-1], 0.0
    end = below(times[-1])
    passed = point(0.0)
    for k in range(1, INSTANTS + 1):
        instant = end * k / INSTANTS
        speed = slowest(plants, ahead, speeds[-1], instant)
        if not speed > 0:
            break
        # The speed falls, so that its value at the end of a step bounds the whole step.
        passed += speed * (point(instant) - point(end * (k - 1) / INSTANTS))
        index = bisect_right(speeds, Fraction(below(speed))) - 1
        least_time, least_distance = point(instant) + times[index], passed + distances[index]
        if least_distance > best_distance:
            best_distance, handover = least_distance, instant
        if least_time > best_time:
            best_time = least_time
    return best_time, best_distance, handover


def _filled(vehicle: Vehicle, time: float) -> Ball:
    """Integral of the torque of one wheelset whose brake only fills [N m s].

    From (9), T_F p' = P - p, it is that of the supply less T_F times the torque reached.
    """
    device = vehicle.brake
    instant = point(time)
    pressure = brake.pressure_after(device, brake.Valve.FILL, instant, point(0.0), point(0.0))
    supplied = instant - (1 - (-device.supply_rate * instant).exp()) / device.supply_rate
    return device.max_torque * (supplied - device.fill_time * pressure / device.max_pressure)
