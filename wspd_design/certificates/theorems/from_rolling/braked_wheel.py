"""Numbers of all wheels of a cell, and bounds of the friction that brakes them, in doubles that are rounded outwards.

Units are those of a sample: rates and torques over the inertia of the law times h [rad/s].
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise

import numpy as np

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.slip_band.statement import NAMES, BandLaw
from wspd_design.model.adhesion import contact_stiffness
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail

ULPS = 16  # by which the end of a result is moved outwards
SLICES = 6  # of a range of slip, in each of which the friction is bounded
SUPPLY = "supply rate"


@dataclass(frozen=True, slots=True)
class Between:
    """All numbers from one to another."""

    low: float
    high: float

    @classmethod
    def hull(cls, *ends: float) -> "Between":
        """Enclose what doubles are the nearest ones of, or within some units in the last place."""
        low, high = min(ends), max(ends)
        return cls(low - ULPS * math.ulp(low), high + ULPS * math.ulp(high))

    def __add__(self, other: "Between | float") -> "Between":
        other = _between(other)
        return Between.hull(self.low + other.low, self.high + other.high)

    __radd__ = __add__

    def __neg__(self) -> "Between":
        return Between(-self.high, -self.low)

    def __sub__(self, other: "Between | float") -> "Between":
        return self + -_between(other)

    def __rsub__(self, other: "Between | float") -> "Between":
        return -self + other

    def __mul__(self, other: "Between | float") -> "Between":
        other = _between(other)
        return Between.hull(*(a * b for a in (self.low, self.high) for b in (other.low, other.high)))

    __rmul__ = __mul__

    def __truediv__(self, other: "Between | float") -> "Between":
        other = _between(other)
        if other.low <= 0.0 <= other.high:
            raise Refused("a range of a divisor holds 0")
        return Between.hull(*(a / b for a in (self.low, self.high) for b in (other.low, other.high)))

    def __rtruediv__(self, other: "Between | float") -> "Between":
        return _between(other) / self

    def at(self, monotonic: Callable[[float], float]) -> "Between":
        """Enclose what a monotonic function makes of it."""
        return Between.hull(monotonic(self.low), monotonic(self.high))

    def union(self, other: "Between") -> "Between":
        """Enclose both, and what lies between them."""
        return Between(min(self.low, other.low), max(self.high, other.high))

    @property
    def size(self) -> float:
        """Largest distance from 0."""
        return max(-self.low, self.high)


def _between(value: "Between | float") -> Between:
    return value if isinstance(value, Between) else Between(value, value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Friction:
    """Of all wheels in a range of slip and speed."""

    torque: Between  # f [rad/s]
    seen: Between  # f over g: the torque of the law that holds it [rad/s]
    slope: Between  # S [-], that f rises by as the wheel falls behind by 1
    fading: float  # what f rises by at most in a sample, for the speed that the train loses in it [rad/s]
    loss: Between  # m/s, that the train loses in a sample
    falls: Between  # D, that the reference wheel speed falls by in a sample [rad/s]
    drag_change: Between  # of the drag in a sample [rad/s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Wheels:
    """All wheels of a cell."""

    effect: Between  # g [-]
    fills: Between  # rho of filling [-], without what a rising supply adds
    vents: Between
    full: float  # torque that the law takes for the full pressure [rad/s]
    supply_rate: Between  # -, per sample
    share: Between  # kappa [-]
    damping: Between  # q [-]
    damping_seen: Between  # q over g [-]
    radius: Between  # m
    mass: Between  # kg
    grip: Between  # torque of a friction of mu0 Q [rad/s]
    grip_seen: Between  # that over g [rad/s]
    pulled: Between  # m/s, that a friction of mu0 Q on all wheels takes off in a sample
    gradient: Between  # torque over the slip, while all of the contact adheres [rad/s]
    steepness: Between  # B [-]
    resistance: tuple[Between, Between, Between]  # N, N s/m and N s2/m2
    slip: float  # -, reference
    h: float  # s
    rail: Rail

    def friction(self, slip: Between, speed: Between, moves: float) -> Friction:
        """Bound the friction; ``moves`` is what the error changes by in a sample at most [rad/s]."""
        edges = np.linspace(slip.low, slip.high, SLICES + 1)
        parts = [self._sliced(Between(float(a), float(b)), speed) for a, b in pairwise(edges)]
        used, slope, _ = reduce(lambda a, b: (a[0].union(b[0]), a[1].union(b[1]), max(a[2], b[2])), parts)
        turning = speed * (1.0 - slip) / self.radius
        torque = self.grip * used - self.damping * turning
        constant, linear, square = self.resistance
        reduced = (1.0 - self.slip) * self.h / (self.radius * self.mass)
        # What the damping takes off f it adds to the drag, and what is left of the friction is g mu0 of the train.
        falls = self.pulled * used * ((1.0 - self.slip) / self.radius)
        falls += (constant + linear * speed + square * speed * speed) * reduced
        loss = self.radius * falls / (1.0 - self.slip)
        if loss.low <= 0.0:
            raise Refused("a train may not slow down")
        stiff = (linear + 2.0 * square * speed) * loss * reduced
        wheel = self.share * self.damping * (loss / self.radius + Between(-moves, moves))
        return Friction(
            torque=torque,
            seen=self.grip_seen * used - self.damping_seen * turning,
            slope=slope + self.damping,
            fading=(max(each[2] for each in parts) * loss + self.damping * loss / self.radius).high,
            loss=loss,
            falls=falls,
            drag_change=-(stiff + wheel),
        )

    def _sliced(self, slip: Between, speed: Between) -> tuple[Between, Between, float]:
        """Friction over mu0 Q, slope, and what the friction gains over the speed that is lost at most."""
        rail = self.rail
        if slip.low < 0.0:
            raise Refused("a wheel may turn faster than it rolls")
        faded = (slip * speed).at(lambda u: math.exp(-rail.friction_decay * u)) * (1.0 - rail.friction_ratio)
        steeply = faded * rail.friction_decay  # what phi falls by over the sliding speed
        phi = faded + rail.friction_ratio
        reach = self.steepness * slip / phi
        shape, steep, apart = _shape(reach, rail)
        slope = self.gradient * self.radius * steep / speed - self.radius * self.grip * steeply * apart
        return phi * shape, slope, (self.grip * steeply * apart * slip).high


def _shape(reach: Between, rail: Rail) -> tuple[Between, Between, Between]:
    """Shape of the force over the part of the contact that adheres, its derivative, and the shape less z times that.

    With a = kA z and b = kS z it is (2/pi)(a/(1 + a^2) + atan b), its derivative (2/pi)(kA (1 - a^2)/(1 + a^2)^2 +
    kS/(1 + b^2)), and the rest (2/pi)(2 a^3/(1 + a^2)^2 + atan b - b/(1 + b^2)).
    """
    adhering, sliding = rail.adhesion_reduction, rail.slip_reduction
    a, b = reach * adhering, reach * sliding
    turn = math.sqrt(3.0)
    rises = [_part(a.low), _part(a.high), *([0.5] if a.low <= 1.0 <= a.high else [])]
    bends = [_bend(a.low), _bend(a.high), *([-0.125] if a.low <= turn <= a.high else [])]
    leaves = [_left(a.low), _left(a.high), *([_left(turn)] if a.low <= turn <= a.high else [])]
    level = Between.hull(*rises) + b.at(math.atan)
    steep = Between.hull(*bends) * adhering + b.at(lambda x: 1.0 / (1.0 + x * x)) * sliding
    apart = Between.hull(*leaves) + Between.hull(
        *(max(math.atan(x) - x / (1.0 + x * x), 0.0) for x in (b.low, b.high))
    )
    factor = 2.0 / math.pi
    # What is left is a difference of numbers near 1, which counts as rounded more.
    return level * factor, steep * factor, (apart + Between(-1e-14, 1e-14)) * factor


def _part(a: float) -> float:
    return a / (1.0 + a * a)


def _bend(a: float) -> float:
    return (1.0 - a * a) / (1.0 + a * a) ** 2


def _left(a: float) -> float:
    return 2.0 * a**3 / (1.0 + a * a) ** 2


def wheels_of(problem: Problem, law: BandLaw, numbers: Mapping[str, tuple[float, float]]) -> Wheels:
    """Work out the numbers of all wheels whose eight numbers lie in a cell."""
    vehicle, rail = problem.vehicle, problem.rail
    mass, inertia, radius, mu0, torque, fill, vent, supply = (
        Between(*map(float, numbers[name])) for name in (*NAMES, SUPPLY)
    )
    h, assumed, full, slip = (
        float(each) for each in (law.sample_time, law.inertia, law.full_torque, law.slip)
    )
    count = vehicle.wheelsets
    load = mass * (constants().gravity / (2.0 * count))
    stiffness = contact_stiffness(vehicle.contact, 1.0)
    pads = torque / full
    return Wheels(
        effect=pads * assumed / inertia,
        fills=float(law.fill_time) / fill,
        vents=float(law.vent_time) / vent,
        full=full * h / assumed,
        supply_rate=supply * h,
        share=(1.0 - slip) * count * inertia / (radius * radius * mass),
        damping=2.0 * vehicle.wheel_damping * h / inertia,
        damping_seen=2.0 * vehicle.wheel_damping * h / (assumed * pads),
        radius=radius,
        mass=mass,
        grip=2.0 * radius * load * mu0 * h / inertia,
        grip_seen=2.0 * radius * load * mu0 * (h / assumed) / pads,
        pulled=constants().gravity * mu0 * h,
        gradient=2.0 * radius * h * stiffness * load.at(lambda x: x ** (2.0 / 3.0)) / inertia,
        steepness=stiffness * load.at(lambda x: x ** (-1.0 / 3.0)) / mu0,
        resistance=tuple(  # type: ignore[arg-type]
            Between(*map(float, problem.span(f"resistance {part}")))
            for part in ("constant", "linear", "quadratic")
        ),
        slip=slip,
        h=h,
        rail=rail,
    )
