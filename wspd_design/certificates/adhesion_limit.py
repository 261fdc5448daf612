"""What no controller can beat: enclosures of the adhesion peak, and the stop that it leaves at best.

* **Adhesion.** A wheel gives at most Q mu(v), mu(v) the largest of f/Q over all slips at speed v. Hence
  v' >= -P(v), P = (f_d + m g mu)/m, and from v to standstill a train needs at least the time int dv/P and the
  distance int v dv/P.
* **Peak.** f = (2/pi) Q m S(eps), m the friction at the sliding speed and eps = stiffness slip/(m Q), grows with
  m: its derivative is (2/pi) Q (S - eps S') with S - eps S' = 2 x^3/(1 + x^2)^2 + atan y - y/(1 + y^2) >= 0 for
  x = kA eps, y = kS eps. Friction falls with the sliding speed, so that f falls with v at a fixed slip: on an
  interval of speeds the peak is highest at its lower end. There the slip is covered by parts; on a part the
  friction is largest at its lower end, x/(1 + x^2) has its maximum 1/2 at x = 1, and atan is monotone.
* **Momentum.** Adding (1) and (2) of all wheels, R m v' + I_w sum omega' = -R f_d - sum T - 2 B sum omega with the
  inertia I_w of a wheelset. A wheel is hardly ever faster than the train: at a slip of -s its creep force exceeds
  what the resistance can do, |f(s)| (8/m + 2 R^2/I_w) >= (1 + s) f_d/m, so that R omega <= (1 + s) v for good. With
  n wheelsets, T at most the torque T_fill of a brake that only fills, and f_d and B largest at the start,

      (m + n I_w/R^2) (v0 - v(t)) <= (f_d(v0) + 2 n B v0 (1 + s)/R^2) t + (n/R) int T_fill dt + n I_w s v0/R^2.

  Until any instant t1 this bounds the speed from below, and from then on adhesion does; the best t1 counts.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from wspd_design.certificates.balls import Ball, above, ball, below, point
from wspd_design.model import adhesion, brake
from wspd_design.model.generated import adhesion as generated
from wspd_design.model.slip import resistance
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

SPEEDS, CROWDING = 200, 1.25  # intervals of the speed, closer together at low speed
INSTANTS = 120  # of the change from momentum to adhesion
PEAK_TOLERANCE = 2e-4  # -, of an enclosed peak
OVERSPEED = 1e-4  # -, slip that a wheel never exceeds forwards
LEAST_SLIP, PARTS = 1e-6, 96  # first part of the slip, and parts above it


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """Lower bounds for every controller, and what they are made of."""

    time: float  # s
    distance: float  # m
    adhesion_time: float  # s, from the adhesion peak alone
    adhesion_distance: float  # m
    handover: float  # s, t1
    speeds: tuple[float, ...]  # m/s, rising
    peaks: tuple[float, ...]  # -, upper bounds of f/Q on the interval above each speed but the last


class NoBound(UserError):
    """What the bound rests on does not hold for a vehicle."""


def stop_limit(vehicle: Vehicle, rail: Rail, initial_speed: float) -> Limit:
    """Bound time and distance of every stop from below.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Nominal plant with static wheel loads, on level track.
    initial_speed : float
        Wheels roll and cylinders are empty there [m/s].

    Raises
    ------
    NoBound
        If the resistance does not grow with speed, or a wheel might outrun the train.
    """
    _require(vehicle, rail, initial_speed)
    speeds = _grid(initial_speed)
    peaks = tuple(peak(vehicle, rail, low) for low, _ in pairwise(speeds))
    times, distances = _remaining(vehicle, speeds, peaks)
    time, distance, start = _filling(vehicle, initial_speed, (times, distances), speeds)
    return Limit(
        time=below(time),
        distance=below(distance),
        adhesion_time=below(times[-1]),
        adhesion_distance=below(distances[-1]),
        handover=start,
        speeds=speeds,
        peaks=peaks,
    )


def peak(vehicle: Vehicle, rail: Rail, speed: float) -> float:
    """Upper bound of f/Q over all slips at one train speed, under the static load."""
    load = point(vehicle.mass) * constants().gravity / (2 * vehicle.wheelsets)
    stiffness = adhesion.contact_stiffness(vehicle.contact, load)
    # Below the regularization speed the slip is referred to that speed, and sliding is no faster than there.
    referred = point(max(speed, constants().slip_regularization_speed))

    def reached(slip: float) -> Ball:
        """f/Q at one slip."""
        return adhesion.creep_force(point(slip), point(slip) * referred, load, rail, stiffness) / load

    def bound(low: float, high: float) -> Ball:
        """Upper bound of f/Q on a part of the slip."""
        friction = generated.friction_coefficient(
            point(low) * referred, rail.mu0, rail.friction_ratio, rail.friction_decay
        )
        ends = [stiffness * point(slip) / (friction * load) for slip in (low, high)]
        first, second = (rail.adhesion_reduction * end for end in ends)
        if second < 1:
            hump = second / (1 + second * second)
        elif first > 1:
            hump = first / (1 + first * first)
        else:
            hump = point(0.5)
        return 2 * friction / point(math.pi) * (hump + (rail.slip_reduction * ends[1]).atan())

    def curved(low: float, high: float) -> Ball:
        """Upper bound of f/Q on a part of the slip by its slope there."""
        part, middle = ball(low, high), 0.5 * (low + high)
        slope = adhesion.creep_force_slip_derivative(part, referred, load, rail, stiffness) / load
        return reached(middle) + slope * (part - point(middle))

    slips = [LEAST_SLIP ** (1.0 - k / PARTS) for k in range(PARTS + 1)]
    # A part that cannot exceed what another slip reaches need not be split.
    known, highest = max(below(reached(slip)) for slip in slips), 0.0
    waiting = [(0.0, LEAST_SLIP), *pairwise(slips)]
    while waiting:
        low, high = waiting.pop()
        top = min(above(bound(low, high)), above(curved(low, high)))
        if top <= known + PEAK_TOLERANCE or high - low < LEAST_SLIP:
            highest = max(highest, top)
        else:
            middle = 0.5 * (low + high)
            waiting += [(low, middle), (middle, high)]
    return highest


def _grid(initial_speed: float) -> tuple[float, ...]:
    """Speeds from standstill to the start, closer where the peak changes most."""
    return (*(initial_speed * (k / SPEEDS) ** CROWDING for k in range(SPEEDS)), initial_speed)


def _remaining(
    vehicle: Vehicle, speeds: Sequence[float], peaks: Sequence[float]
) -> tuple[list[Ball], list[Ball]]:
    """Least time and distance from each speed to standstill, by adhesion."""
    times, distances = [point(0.0)], [point(0.0)]
    gravity = point(constants().gravity)
    for (low, high), top in zip(pairwise(speeds), peaks, strict=True):
        strongest = resistance(vehicle, point(high)) / vehicle.mass + gravity * top
        span = (point(high) - point(low)) / strongest
        times.append(times[-1] + span)
        distances.append(distances[-1] + span * (point(low) + point(high)) / 2)
    return times, distances


def _filling(
    vehicle: Vehicle,
    initial_speed: float,
    remaining: tuple[list[Ball], list[Ball]],
    speeds: Sequence[float],
) -> tuple[Ball, Ball, float]:
    """Least time and distance with the momentum that a filling brake can take until it hands over."""
    times, distances = remaining
    best_time, best_distance, handover = times[-1], distances[-1], 0.0
    end = below(times[-1])
    passed = point(0.0)
    for k in range(1, INSTANTS + 1):
        instant = end * k / INSTANTS
        speed = _slowest(vehicle, initial_speed, instant)
        if not speed > 0:
            break
        # The speed falls, so that its value at the end of a step bounds the whole step.
        passed += speed * (point(instant) - point(end * (k - 1) / INSTANTS))
        index = max(i for i, low in enumerate(speeds) if speed >= low)
        least_time, least_distance = point(instant) + times[index], passed + distances[index]
        if least_distance > best_distance:
            best_distance, handover = least_distance, instant
        if least_time > best_time:
            best_time = least_time
    return best_time, best_distance, handover


def _slowest(vehicle: Vehicle, initial_speed: float, time: float) -> Ball:
    """Lower bound of the speed by momentum."""
    count, radius = vehicle.wheelsets, point(vehicle.wheel_radius)
    inertia, start = point(vehicle.wheelset_inertia), point(initial_speed)
    overspeed = point(OVERSPEED)
    drag = (
        resistance(vehicle, start) + 2 * count * vehicle.wheel_damping * start * (1 + overspeed) / radius**2
    )
    impulse = (
        drag * time
        + count / radius * _filled(vehicle, time)
        + count * inertia * overspeed * start / radius**2
    )
    return start - impulse / (vehicle.mass + count * inertia / radius**2)


def _filled(vehicle: Vehicle, time: float) -> Ball:
    """Integral of the torque of one wheelset whose brake only fills [N m s].

    From (9), T_F p' = P - p, it is that of the supply less T_F times the torque reached.
    """
    device = vehicle.brake
    instant = point(time)
    pressure = brake.pressure_after(device, brake.Valve.FILL, instant, point(0.0), point(0.0))
    supplied = instant - (1 - (-device.supply_rate * instant).exp()) / device.supply_rate
    return device.max_torque * (supplied - device.fill_time * pressure / device.max_pressure)


def _require(vehicle: Vehicle, rail: Rail, initial_speed: float) -> None:
    """Refuse what the derivation does not cover."""
    if min(vehicle.resistance_constant, vehicle.resistance_linear, vehicle.resistance_quadratic) < 0.0:
        raise NoBound("the bound of the stop needs a resistance without negative parts")
    load = point(vehicle.mass) * constants().gravity / (2 * vehicle.wheelsets)
    stiffness = adhesion.contact_stiffness(vehicle.contact, load)
    slip, speed, radius = point(OVERSPEED), point(initial_speed), point(vehicle.wheel_radius)
    force = adhesion.creep_force(slip, slip * speed, load, rail, stiffness)
    per_force = 2 * vehicle.wheelsets / point(vehicle.mass) + 2 * radius**2 / vehicle.wheelset_inertia
    if not force * per_force >= (1 + slip) * resistance(vehicle, speed) / vehicle.mass:
        raise NoBound(
            "the resistance could make a wheel outrun the train; the bound of the stop does not hold then"
        )
