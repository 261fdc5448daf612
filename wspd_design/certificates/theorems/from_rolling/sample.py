"""What a sample makes of the pull P, of z, p and of the wanted way x, for all numbers of a cell.

With g the effect of the torque, rho the part of the way that the valve goes, lambda the share of the sample that sees
it, S the slope of the friction and k that of the pull, all of them anything in their ranges, c = rho x,
d = lambda (g rho - 0.6) x, y = P - x + z + beta p - e and known = (1 - kept) e - a (z + p/theta + d):

    P+ = P + k (ahead (known - c) - y - g lambda c),   x+ = x - c + known + P+ - P,
    z+ = theta z - S y + (g - 1) c - (1 - theta) d,    p+ = theta p + theta^2 (z + d).

The map is affine in the state, and in each of the numbers while the others stay: corners of their ranges decide.
"""

from itertools import product
from math import exp, log1p
from typing import NamedTuple

import numpy as np

from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between, Wheels
from wspd_design.certificates.theorems.from_rolling.support import Array, Polytope
from wspd_design.certificates.theorems.slip_band.statement import BandLaw

STATES = ("P", "z", "p", "x")
PULL, Z, P, WAY = np.eye(len(STATES))
LATE = 0.007  # by which the mean place of a pulse differs from its middle at most, over its length
UNLIKE = 0.02  # of the change of the torque that the law works out, that differs from 0.6 lambda x at most
CUTS = (0.0, 0.5, 1.0)  # of the way of a whole sample, between which ways have their own lambda
GRAIN = 0.02  # of the range of x, that a piece is wide at least


class LawNumbers(NamedTuple):
    """Of the law, in units of a sample."""

    theta: float
    kept: float
    ahead: float
    gain: float  # k h
    sigma: float  # slew of the braking curve [rad/s]
    begins: float  # rad/s, predicted error at which it begins
    nominal: float  # part of the way that the law counts with in its mean torque
    fills: float  # share of the room that a pulse of the whole sample fills, as the law takes it
    vents: float

    @property
    def over_fill(self) -> float:
        """Sample time over the time of filling that the inversion assumes."""
        return -log1p(-self.fills)

    @property
    def a(self) -> float:
        """Gain of the observer."""
        return (1.0 - self.theta) ** 2

    @property
    def falling(self) -> Array:
        """Row of y from the state, beside the error e."""
        found: Array = PULL + Z + P * ((1.0 - self.theta) / self.theta) - WAY
        return found

    @property
    def innovation(self) -> Array:
        """Row of z + p/theta."""
        found: Array = Z + P / self.theta
        return found

    def pull(self, predicted: float) -> float:
        """Pull at a predicted error."""
        if predicted <= self.begins:
            return self.gain * predicted
        return float((2.0 * self.sigma * (predicted - 0.5 * self.begins)) ** 0.5)

    def predicted(self, pull: float) -> float:
        """Error at which there is a pull."""
        if pull <= self.gain * self.begins:
            return pull / self.gain
        return pull * pull / (2.0 * self.sigma) + 0.5 * self.begins

    def steepness(self, pull: float) -> float:
        """Slope of the pull where there is a pull."""
        return min(self.gain, self.sigma / pull) if pull > 0.0 else self.gain


def law_numbers(law: BandLaw) -> LawNumbers:
    """Return the numbers of a law with a braking curve."""
    h = float(law.sample_time)
    assert law.torque_slew is not None
    slew, rate = float(law.torque_slew / law.inertia), float(law.approach_rate)
    return LawNumbers(
        theta=exp(-float(law.observer_rate) * h),
        kept=exp(-h / float(law.acceleration_time)),
        ahead=float(law.ahead),
        gain=rate * h,
        sigma=slew * h * h,
        begins=slew / rate**2,
        nominal=float(law.time_share),
        fills=1.0 - exp(-h / float(law.fill_time)),
        vents=1.0 - exp(-h / float(law.vent_time)),
    )


def pulls(law: LawNumbers, seen: Array) -> Array:
    """Pulls at many predicted errors, of either sign."""
    curve = np.sqrt(np.maximum(2.0 * law.sigma * (seen - 0.5 * law.begins), 0.0))
    found: Array = np.where(seen > law.begins, curve, law.gain * seen)
    return found


class Pulse(NamedTuple):
    """Ways within a range, and what the valve makes of them."""

    ways: Between  # rad/s
    part: Between  # rho
    seen: Between  # lambda
    held: float  # rad/s, way of the whole sample, if it may be more that is wanted; else 0


class Ranges(NamedTuple):
    """Of the numbers that may differ from sample to sample."""

    slope: Between
    steepness: Between  # k
    error: Between  # e
    friction: Between  # rad/s, of Df beside S y
    known: Between  # rad/s, of d beside what the law knows


def part_of(speed: Between, share: float) -> Between:
    """Return the part of ways up to a share of the room that a valve goes, with times over assumed ones."""
    return speed.union(speed.at(lambda rho: (1.0 - (1.0 - share) ** rho) / share))


def pulses_of(
    law: LawNumbers, wheels: Wheels, ways: Between, room: float, torque: float, added: float
) -> list[Pulse]:
    """Divide the ways: filling and venting, short and long, and those that a sample does not do.

    Parameters
    ----------
    law, wheels : LawNumbers, Wheels
        What is known of both.
    ways : Between
        All that are wanted [rad/s].
    room, torque : float
        That may be filled, and vented, at least [rad/s].
    added : float
        What a rising supply adds to what is filled at most, over it.
    """
    grain = GRAIN * (ways.high - ways.low)
    fills = part_of(wheels.fills, law.fills) * Between(1.0, 1.0 + added)
    vents = part_of(wheels.vents, law.vents)
    found = []
    for sign, part, most, late in (
        (1.0, fills, law.fills * room, LATE + added),
        (-1.0, vents, law.vents * torque, LATE),
    ):
        share = law.fills if sign > 0.0 else law.vents
        for begin, end in ((0.0, 0.5), (0.5, 1.0), (1.0, np.inf)):
            # A thin piece is made wider; a way counts in any piece that it lies in.
            near, far = begin * most - grain, end * most + (grain if end < 1.0 else 0.0)
            if sign * (ways.high if sign > 0.0 else ways.low) <= begin * most:
                continue
            shortest, longest = (
                min(log1p(-share * min(max(each / most, 0.0), 1.0)) / log1p(-share), 1.0)
                for each in (near, far)
            )
            seen = Between(1.0 - (0.5 + late) * longest, 1.0 - (0.5 - LATE) * shortest)
            near = max(near, 0.0)
            reach = Between(near, far) if sign > 0.0 else Between(-far, -near)
            found.append(Pulse(reach, part, seen, sign * most if far > most else 0.0))
    return found


def _maps(law: LawNumbers, effect: Between, ranges: Ranges, pulse: Pulse) -> tuple[Array, Array, Array]:
    """Return what a sample makes of state and 1, of the error e, and of d beside what is known, at all corners."""
    held = (0.0, pulse.held) if pulse.held else (0.0,)
    corners = np.array(
        list(
            product(
                *(
                    (each.low, each.high)
                    for each in (effect, pulse.part, pulse.seen, ranges.slope, ranges.steepness)
                ),
                held,
            )
        )
    )
    g, rho, seen, slope, steep, stays = (each[:, None] for each in corners.T)
    theta, unit = law.theta, np.eye(len(STATES) + 1)
    pull, z, p, x = (unit[k][None] for k in range(len(STATES)))
    way = np.where(stays == 0.0, x, stays * unit[len(STATES)])
    change, error = rho * way, seen * (g * rho - law.nominal) * way
    y = np.append(law.falling, 0.0)[None]
    known = -law.a * (np.append(law.innovation, 0.0)[None] + error)
    moved = steep * (law.ahead * (known - change) - y - g * seen * change)
    of_state = np.stack(
        [
            pull + moved,
            theta * z - slope * y + (g - 1.0) * change - (1.0 - theta) * error,
            theta * p + theta**2 * (z + error),
            x - change + known + moved,
        ],
        axis=1,
    )
    new = 1.0 - law.kept
    of_error = np.concatenate(
        [steep * (1.0 + law.ahead * new), slope, 0.0 * slope, new + steep * (1.0 + law.ahead * new)], axis=1
    )
    pulled = -law.a * law.ahead * steep
    of_known = np.concatenate(
        [pulled, 0.0 * steep - (1.0 - theta), 0.0 * steep + theta**2, pulled - law.a], axis=1
    )
    return of_state, of_error, of_known


def image(
    law: LawNumbers,
    wheels: Wheels,
    states: Polytope,
    ranges: Ranges,
    pulses: list[Pulse],
    rows: Array,
    before: Array | None = None,
) -> Array:
    """Return what ``rows`` u+ + ``before`` u do not exceed, with u+ the state after a sample."""
    size = len(STATES)
    found = np.full(len(rows), -np.inf)
    for pulse in pulses:
        cuts = [(WAY, pulse.ways.high)] if np.isfinite(pulse.ways.high) else []
        cuts += [(-WAY, -pulse.ways.low)] if np.isfinite(pulse.ways.low) else []
        of_state, of_error, of_known = _maps(law, wheels.effect, ranges, pulse)
        functions = np.einsum("ki,nij->nkj", rows, of_state[:, :, :size])
        if before is not None:
            functions = functions + before
        most = states.cut(*cuts).most(functions.reshape(-1, size)).reshape(functions.shape[:2])
        most = most + np.einsum("ki,ni->nk", rows, of_state[:, :, size])
        for column, each in ((of_error, ranges.error), (of_known, ranges.known)):
            share = np.einsum("ki,ni->nk", rows, column)
            most = most + np.maximum(share * each.low, share * each.high)
        most = most + np.maximum(-rows[:, 1] * ranges.friction.low, -rows[:, 1] * ranges.friction.high)
        found = np.maximum(found, most.max(axis=0))
    return found + 1e-12
