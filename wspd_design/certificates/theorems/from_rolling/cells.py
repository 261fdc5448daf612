"""Wheels of many cells at a time, and the friction that brakes them over slip and speed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from wspd_design.certificates.kernel.interval import Array, Interval, about, chosen, interval
from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between, Wheels

TURN = 1.0 / np.sqrt(3.0)  # where the derivative of a/(1 + a^2)^2 changes its sign


@dataclass(frozen=True, slots=True, kw_only=True)
class Cells:
    """The numbers of :class:`Wheels`, one of each for a cell or a column of cells."""

    effect: Interval  # g [-]
    fills: Interval  # rho of filling [-]
    vents: Interval
    supply_rate: Interval  # per sample
    share: Interval  # kappa [-]
    damping: Interval  # q [-]
    radius: Interval  # m
    mass: Interval  # kg
    grip: Interval  # rad/s
    gradient: Interval  # rad/s
    steepness: Interval  # B [-]
    resistance: tuple[Interval, Interval, Interval]
    one: Wheels  # any of them, for what they have in common

    def at(self, key: Any) -> "Cells":
        """Return the numbers of some of the cells, in any shape that an index gives."""
        return Cells(
            **{name: getattr(self, name)[key] for name in NUMBERS}, resistance=self.resistance, one=self.one
        )


NUMBERS = (
    "effect",
    "fills",
    "vents",
    "supply_rate",
    "share",
    "damping",
    "radius",
    "mass",
    "grip",
    "gradient",
    "steepness",
)


def gathered(wheels: Sequence[Wheels]) -> Cells:
    """Put the numbers of cells into arrays; the resistance is that of all of them."""

    def array(name: str) -> Interval:
        values: list[Between] = [getattr(each, name) for each in wheels]
        return Interval(np.array([each.low for each in values]), np.array([each.high for each in values]))

    first = wheels[0]
    constant, linear, square = (Interval(each.low, each.high) for each in first.resistance)
    return Cells(**{name: array(name) for name in NUMBERS}, resistance=(constant, linear, square), one=first)


class Sliding(NamedTuple):
    """Friction and what it does, over ranges of slip and speed."""

    friction: Interval  # f [rad/s]
    slope: Interval  # S [-]
    bends: Array  # -, what S rises by at most over the slip, 0 where it falls for sure
    rises: Array  # -, S_l: what S rises by over the relative fall of the speed at most
    fading: Array  # rad/s, what f rises by in a sample at a slip that stays, at most
    drag: Interval  # rad/s
    falls: Interval  # D [rad/s]
    loss: Interval  # m/s, of the train in a sample
    slides: Interval  # w [rad/s]
    eases: Array  # rad/s, what the drag falls by in a sample for the speed at most


def sliding(cells: Cells, slip: Interval, speed: Interval) -> Sliding:
    """Bound the friction; the cells in a column, slip and speed in rows, both with any sign of a small slip."""
    rail, reference, h = cells.one.rail, cells.one.slip, cells.one.h
    slides = Interval(np.maximum(slip.low, 0.0), np.maximum(slip.high, -slip.low))
    sliding_speed = slides * speed
    faded = sliding_speed.falling(lambda u: np.exp(-rail.friction_decay * u)) * (1.0 - rail.friction_ratio)
    steeply = faded * rail.friction_decay
    phi = faded + rail.friction_ratio
    reach = cells.steepness * slides / phi
    level, steep, apart, curved = _shape(reach, rail.adhesion_reduction, rail.slip_reduction)
    adhering = cells.gradient * cells.radius * steep / speed
    lacking = cells.radius * cells.grip * steeply * apart
    turning = speed * (1.0 - slip) / cells.radius
    friction = cells.grip * phi * level - cells.damping * turning
    # Below 0 the force is that of the same slip the other way.
    back = cells.gradient * slip.at_most(0.0)
    friction = friction + back
    constant, linear, square = cells.resistance
    reduced = (1.0 - reference) * h / (cells.radius * cells.mass)
    drag = (
        cells.share * cells.damping * turning + (constant + linear * speed + square * speed * speed) * reduced
    )
    falls = cells.share * friction + drag
    loss = (cells.radius * falls / (1.0 - reference)).at_least(0.0)
    loses = loss / speed  # L
    stretched = 1.0 + sliding_speed * steeply / phi
    # dS/ds = R grip (v phi'' W - |Sz''| z_s (|phi'| z + B/v)), z_s = (B/phi) (1 + u |phi'|/phi).
    along = cells.steepness / phi * stretched
    bends = (
        cells.radius
        * cells.grip
        * (
            speed * steeply * rail.friction_decay * apart
            - curved * along * (steeply * reach + cells.steepness / speed)
        )
    )
    rises = adhering - sliding_speed * rail.friction_decay * lacking
    rises = rises + cells.radius * cells.grip * curved * reach * reach * steeply * stretched
    fading = cells.grip * steeply * apart * sliding_speed + cells.damping * turning
    eases = loses * (
        (linear + 2.0 * square * speed) * speed * reduced + cells.share * cells.damping * turning
    )
    return Sliding(
        friction=friction,
        slope=adhering - lacking + cells.damping,
        bends=np.maximum(bends.high, 0.0),
        rises=np.maximum(rises.high, 0.0),
        fading=np.maximum((fading * loses).high, 0.0),
        drag=drag,
        falls=falls,
        loss=loss,
        slides=falls * (reference - slip) / (1.0 - reference),
        eases=eases.high,
    )


def _shape(reach: Interval, adhesion: float, slip: float) -> tuple[Interval, Interval, Interval, Interval]:
    """Shape of the force over the part that adheres, its derivative, the shape less z times that, and -Sz''.

    With a = kA z and b = kS z: (2/pi) (a/(1 + a^2) + atan b), (2/pi) (kA (1 - a^2)/(1 + a^2)^2 + kS/(1 + b^2)),
    (2/pi) (2 a^3/(1 + a^2)^2 + atan b - b/(1 + b^2)), (2/pi) (kA^2 2 a (3 - a^2)/(1 + a^2)^3 + kS^2 2 b/(1 + b^2)^2).
    """
    a, b, factor = reach * adhesion, reach * slip, about(2.0 / np.pi)

    def bounded(number: Interval, function: Callable[[Array], Array], turns: Sequence[float]) -> Interval:
        found = _ends(number, function)
        for turn in turns:
            there = (number.low <= turn) & (number.high >= turn)
            found = chosen(there, found.hull(_ends(interval(np.full(number.shape, turn)), function)), found)
        return found

    level = bounded(a, lambda x: x / (1.0 + x * x), (1.0,)) + b.rising(np.arctan)
    steep = bounded(a, lambda x: (1.0 - x * x) / (1.0 + x * x) ** 2, (np.sqrt(3.0),)) * adhesion
    steep = steep + b.falling(lambda x: 1.0 / (1.0 + x * x)) * slip
    apart = bounded(a, lambda x: 2.0 * x**3 / (1.0 + x * x) ** 2, (np.sqrt(3.0),))
    apart = apart + Interval(-1e-14, 1e-14)  # a difference of numbers near 1
    apart = (apart + b.rising(lambda x: np.arctan(x) - x / (1.0 + x * x))).at_least(0.0)
    root = np.sqrt(2.0)
    curved = bounded(a, lambda x: 2.0 * x * (3.0 - x * x) / (1.0 + x * x) ** 3, (root - 1.0, root + 1.0)) * (
        adhesion * adhesion
    )
    curved = curved + bounded(b, lambda x: 2.0 * x / (1.0 + x * x) ** 2, (TURN,)) * (slip * slip)
    return level * factor, steep * factor, apart * factor, curved * factor


def _ends(number: Interval, function: Callable[[Array], Array]) -> Interval:
    one, other = function(number.low), function(number.high)
    low, high = np.minimum(one, other), np.maximum(one, other)
    spare = 4e-15 * (1.0 + np.abs(high))
    return Interval(low - spare, high + spare)
