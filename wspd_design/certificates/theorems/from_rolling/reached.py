"""Whether all wheels of a sample are in the ellipsoids of a band.

The deviations that a band speaks about are, of the same instant and with P = k h Ehat below the braking curve,

    e = P/(k h) - ahead (x - P) - E,   g Y = y + f - f_E,   D = -e_law,   N = Y + x - P - D,

with f_E the friction of a wheel that is at E, from which the band counts errors. y has means over the sample, so that
it differs from that of the instant by what friction and drag change by in a sample.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import product
from math import ceil, floor
from typing import TYPE_CHECKING

import numpy as np

from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between
from wspd_design.certificates.theorems.from_rolling.sample import PULL, WAY, P
from wspd_design.certificates.theorems.from_rolling.support import Array
from wspd_design.certificates.theorems.slip_band.arrival import INWARD, Asked
from wspd_design.certificates.theorems.slip_band.statement import NAMES

if TYPE_CHECKING:
    from wspd_design.certificates.theorems.from_rolling.braked_sample import Sample


def arrived(sample: "Sample", asked: Sequence[Asked], numbers: Mapping[str, tuple[float, float]]) -> bool:
    """Whether wheels with some ranges of their numbers are in the ellipsoids of all windows that they may be in."""
    law, state = sample.law, sample.state
    ((_, highest),) = state.states.ends(PULL[None])
    if highest > law.gain * law.begins:
        return False
    # In this sample and the next.
    slow, fast = state.speed.low - 2.0 * sample.friction.loss.high, state.speed.high
    met = [each for each in asked if each.speeds[0] <= fast and slow <= each.speeds[1]]
    return _cover([each.speeds for each in met], slow, fast) and all(
        _is_in(sample, each, numbers, (slow, fast)) for each in met
    )


def _cover(windows: Sequence[tuple[float, float]], slow: float, fast: float) -> bool:
    """Whether windows leave out no speed between two."""
    end = slow
    for low, high in sorted(windows):
        if low > end:
            return False
        end = max(end, high)
    return bool(windows) and end >= fast


def _is_in(
    sample: "Sample", asked: Asked, numbers: Mapping[str, tuple[float, float]], speeds: tuple[float, float]
) -> bool:
    """Whether wheels are in the ellipsoid of a window, as long as they are in that."""
    if sample.state.supply < asked.supply:
        return False
    root = np.linalg.cholesky(np.asarray(asked.matrix, dtype=float)).T
    found = deviations(sample, asked.settled, root)
    if asked.closer is None:
        center, moved = asked.center, asked.moved
    else:
        # The center is where it is for the drifts of these wheels.
        (low, high), (slow, fast) = asked.speeds, speeds
        near = max(low, floor(2.0 * slow) / 2.0), min(high, ceil(2.0 * fast) / 2.0)
        ranges = tuple((Fraction(low), Fraction(high)) for low, high in (numbers[name] for name in NAMES))
        center, moved = asked.closer(ranges, near)
    least, most = (each - root @ np.asarray(center, dtype=float) for each in found)
    shift = root @ np.asarray(moved, dtype=float)
    return float(np.linalg.norm(np.maximum(-least, most)) + np.linalg.norm(shift)) < 1.0 - INWARD


def deviations(sample: "Sample", settled: float, functions: Array) -> tuple[Array, Array]:
    """Return between what functions of (e, p, N, Y, D) lie, counted from the error ``settled``."""
    law, states, ranges, wheels = sample.law, sample.state.states, sample.ranges, sample.wheels
    # The friction is bounded over all errors of the sample and from there to the one that they are counted from.
    errors = (sample.errors - sample.reach).union(Between(settled, settled))
    speed = Between(sample.state.speed.low - 2.0 * sample.friction.loss.high, sample.state.speed.high)
    between = wheels.friction(wheels.slip - errors * wheels.radius / speed, speed, sample.moves).slope
    error = PULL / law.gain - law.ahead * (WAY - PULL)
    change = ranges.slope.size * sample.moves + sample.friction.fading
    drag = sample.friction.drag_change.size
    lag = wheels.share.high * change + drag
    lows, highs = [], []
    for g, slope in product(*((each.low, each.high) for each in (wheels.effect, between))):
        # The further a wheel is from the reference, the less it slides: f - f_E = -S e.
        torque = (law.falling - slope * error) / g
        rows = functions @ np.stack([error, P, torque + WAY - PULL, torque, 0.0 * P])
        constant = functions @ np.array([-settled, 0.0, slope * settled / g, slope * settled / g, 0.0])
        of_error = functions @ np.array([0.0, 0.0, 1.0 - 1.0 / g, -1.0 / g, -1.0])
        aside = np.abs(functions @ np.array([0.0, 0.0, 1.0, 1.0, 0.0])) * ((change + lag) / g)
        aside += np.abs(functions @ np.array([0.0, 0.0, 1.0, 0.0, -1.0])) * lag
        ends, seen = (
            states.ends(rows),
            (of_error * sample.state.error.low, of_error * sample.state.error.high),
        )
        lows.append(ends[:, 0] + np.minimum(*seen) - aside + constant)
        highs.append(ends[:, 1] + np.maximum(*seen) + aside + constant)
    return np.min(lows, axis=0), np.max(highs, axis=0)
