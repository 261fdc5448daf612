"""Whether all wheels of a sample are in the ellipsoid of a band.

The deviations that a band speaks about are, of the same instant and with P = k h Ehat below the braking curve,

    e = P/(k h) - ahead (x - P) - E,   g Y = y + f - f_E,   D = -e_law,   N = Y + x - P - D,

with f_E the friction of a wheel that is at E, from which the band counts errors. y has means over the sample, so that
it differs from that of the instant by what friction and drag change by in a sample.
"""

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from wspd_design.certificates.theorems.from_rolling.sample import PULL, WAY, P
from wspd_design.certificates.theorems.from_rolling.support import Array
from wspd_design.certificates.theorems.slip_band.arrival import INWARD, Asked

if TYPE_CHECKING:
    from wspd_design.certificates.theorems.from_rolling.braked_sample import Sample


def arrived(sample: "Sample", asked: Asked) -> bool:
    """Whether the wheels are in the ellipsoid for sure."""
    law, state = sample.law, sample.state
    ((_, highest),) = state.states.ends(PULL[None])
    if highest > law.gain * law.begins:
        return False
    speed, (slow, fast) = state.speed, asked.speeds
    if not (slow <= speed.low and speed.high <= fast and state.supply >= asked.supply):
        return False
    root = np.linalg.cholesky(np.asarray(asked.matrix, dtype=float)).T
    found = deviations(sample, asked.settled, root)
    if found is None:
        return False
    low, high = (each - root @ np.asarray(asked.center, dtype=float) for each in found)
    moved = root @ np.asarray(asked.moved, dtype=float)
    return float(np.linalg.norm(np.maximum(-low, high)) + np.linalg.norm(moved)) < 1.0 - INWARD


def deviations(sample: "Sample", settled: float, functions: Array) -> tuple[Array, Array] | None:
    """Return between what functions of (e, p, N, Y, D) lie; None if the friction is not bounded as far as E."""
    law, states, ranges, wheels = sample.law, sample.state.states, sample.ranges, sample.wheels
    # The slope is bounded between all errors of the sample and the next.
    if not sample.errors.low - sample.reach.high <= settled <= sample.errors.high - sample.reach.low:
        return None
    error = PULL / law.gain - law.ahead * (WAY - PULL)
    change = ranges.slope.size * sample.moves + sample.friction.fading
    drag = sample.friction.drag_change.size
    lag = wheels.share.high * change + drag
    lows, highs = [], []
    for g, slope in product(*((each.low, each.high) for each in (wheels.effect, ranges.slope))):
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
