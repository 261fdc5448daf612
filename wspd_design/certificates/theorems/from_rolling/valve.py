"""What the valves do in a sample that the law may end early: they fill in a room, and vent from a torque.

All are arrays, with a number for each box of wheels. See docs/theory.md#bounds-of-ways-in.
"""

from collections.abc import Callable
from itertools import product
from typing import NamedTuple

import numpy as np

from wspd_design.certificates.kernel.interval import Array, Interval
from wspd_design.certificates.theorems.from_rolling.cells import Cells
from wspd_design.certificates.theorems.from_rolling.sample import LawNumbers


class Part(NamedTuple):
    """Ways of one sign that a sample does, and what it makes of them."""

    way: Interval  # rad/s
    rho: Interval  # -, part that the valve goes
    share: Interval  # -, lambda
    unlike: Interval  # rad/s, of d beside what these numbers say
    length: Interval  # -, of the pulse


class Valve:
    """What the valves do in a sample: they fill in a room, and vent from a torque."""

    def __init__(
        self, law: LawNumbers, cells: Cells, room: Interval, rise: Interval, torque: Interval
    ) -> None:
        self.law, self.room, self.rise = law, room, rise
        self.over = cells.fills * law.over_fill, cells.vents * law.over_fill
        # The rise over the room; what is left of the room after a sample, from a supply that only rises.
        left = room.low * np.exp(-self.over[0].high) * (1.0 - 1e-12)
        self.ratio, self.ratio_later = (
            np.minimum(rise.high / np.maximum(each, 1e-9), 1.0) for each in (room.low, left)
        )
        # Later the room may be larger by what the supply rises, or what is vented, and the torque by what fills.
        self.whole = room.at_least(0.0) * law.fills, torque.at_least(0.0) * law.vents
        farther = self.over[0].high * (room.high + rise.high), self.over[1].high * torque.high
        self.whole_later = (
            Interval(0.0 * room.low, law.fills * (room.high + rise.high + farther[1])),
            Interval(
                law.vents * np.maximum(torque.low - farther[1], 0.0), law.vents * (torque.high + farther[0])
            ),
        )
        self.fills, self.fills_later = (
            _powers(cells.fills, law.fills) * Interval(1.0, 1.0 + 0.5056 * each)
            for each in (self.ratio, self.ratio_later)
        )
        self.vents = _powers(cells.vents, law.vents)

    def parts(self, way: Interval, later: bool = False) -> tuple[Part, Part]:
        """Return what fills and what vents."""
        law = self.law
        filling, venting = self.whole_later if later else self.whole
        fills, late_rise = (self.fills_later, self.ratio_later) if later else (self.fills, self.ratio)
        up = Interval(
            np.minimum(np.maximum(way.low, 0.0), filling.low),
            np.minimum(np.maximum(way.high, 0.0), filling.high),
        )
        down = Interval(
            np.maximum(np.minimum(way.low, 0.0), -venting.high),
            np.maximum(np.minimum(way.high, 0.0), -venting.low),
        )
        found = []
        for size, whole, rho, over, ratio in (
            (up, filling, fills, self.over[0], late_rise),
            (-down, venting, self.vents, self.over[1], 0.0 * late_rise),
        ):
            shortest = 0.9727 * np.where(size.low > 0.0, size.low / whole.high, 0.0)
            longest = np.where(
                size.high > 0.0, np.minimum(size.high / np.maximum(whole.low, 1e-300), 1.0), 0.0
            )
            length = Interval(np.clip(shortest * (1.0 - 1e-12), 0.0, 1.0), longest)
            late = 0.506 * ratio / 6.0
            share = Interval(
                1.0 - 0.5 * length.high - late * length.high,
                1.0 - 0.5 * length.low + over.high * length.high**2 / 12.0,
            )
            unlike = size.high * law.nominal
            beside = Interval(-unlike * (0.0139 + late), unlike * over.high / 12.0)
            found.append((size, rho, share, beside, length))
        (a, *filled), (b, rho, share, beside, length) = found
        return Part(a, *filled), Part(-b, rho, share, -beside, length)

    @staticmethod
    def change(parts: tuple[Part, Part]) -> Interval:
        """Change of the torque."""
        up, down = parts
        return up.way * up.rho + down.way * down.rho

    @staticmethod
    def least_share(parts: tuple[Part, Part]) -> Array:
        """Least share of a change in the mean."""
        return np.minimum(parts[0].share.low, parts[1].share.low)

    def learned(self, g: Interval, parts: tuple[Part, Part]) -> tuple[Interval, Interval]:
        """What z gains by the change of the torque, and d."""
        theta, nominal = self.law.theta, self.law.nominal

        def z_of(g: Array, rho: Array, share: Array) -> Array:
            return (g - 1.0) * rho - (1.0 - theta) * share * (g * rho - nominal)

        def d_of(g: Array, rho: Array, share: Array) -> Array:
            return share * (g * rho - nominal)

        z = unlike = Interval(0.0, 0.0)
        for part in parts:
            z = z + part.way * corners(z_of, g, part.rho, part.share) - (1.0 - theta) * part.unlike
            unlike = unlike + part.way * corners(d_of, g, part.rho, part.share) + part.unlike
        return z, unlike

    def in_first(self, parts: tuple[Part, Part]) -> Array:
        """Change of the torque upwards as a weight that rises over its sample counts it, at most."""
        up = parts[0]
        part = np.minimum(up.way.high / np.maximum(self.whole[0].high, 1e-300), 1.0)
        return up.rho.high * up.way.high * (1.0 - part**2 / 3.0) * (1.0 + 0.5 * self.over[0].high)

    def in_second(self, change: Interval) -> Array:
        """Change of the torque upwards in the next sample, as a weight that falls counts it, at most."""
        most = np.maximum(self.fills_later.high * self.whole_later[0].high, 1e-300)
        part = np.minimum(np.maximum(change.high, 0.0) / most, 1.0)
        return np.maximum(change.high, 0.0) * (1.0 - part + part**2 / 3.0) * (1.0 + 0.5 * self.over[0].high)

    def next_room(self, parts: tuple[Part, Part], way: Interval) -> Interval:
        """Room of the supply in the next sample."""
        change, tau = self.change(parts), self.over[0]
        left = (-tau).exp()
        filled_all = self.room * left + self.rise * Interval(1.0 - 0.5 * tau.high, 1.0 + 0.0 * tau.high)
        found = self.room + self.rise - change
        whole = way.low >= self.whole[0].high
        return Interval(
            np.maximum(found.low, np.where(change.low >= 0.0, filled_all.low, found.low)),
            np.where(whole, np.minimum(found.high, filled_all.high), found.high),
        )


def _powers(rho: Interval, share: float) -> Interval:
    """Part of ways up to a share of the room that a valve goes, with times over assumed ones."""
    whole = rho.rising(lambda x: (1.0 - (1.0 - share) ** x) / share)
    return rho.hull(whole)


def corners(function: Callable[..., Array], *ranges: Interval) -> Interval:
    """Values of a function that is affine in each of its arguments."""
    low, high = np.asarray(np.inf), np.asarray(-np.inf)
    for ends in product(*((each.low, each.high) for each in ranges)):
        value = function(*ends)
        low, high = np.minimum(low, value), np.maximum(high, value)
    return Interval(low - 1e-14, high + 1e-14)
