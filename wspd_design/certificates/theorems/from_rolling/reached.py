"""Whether all wheels of a sample are in the ellipsoid of a band.

The deviations that a band speaks about are, of the same instant and with P = k h Ehat below the braking curve,

    e = P/(k h) - ahead (x - P) - E,   g Y = y + (1 + kappa) (f - f_E) + drag - drag_E,   D = -e_law,
    N = Y + x - P - D,

with f_E and drag_E those of a wheel that is at E, from which the band counts errors. f and D of a sample are means, so
that they differ from those of the instant by what both change by in a sample.
"""

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from wspd_design.certificates.theorems.from_rolling.sample import PULL, WAY, P
from wspd_design.certificates.theorems.slip_band.arrival import INWARD, Asked

if TYPE_CHECKING:
    from wspd_design.certificates.theorems.from_rolling.settling import Sample


def arrived(sample: "Sample", asked: Asked) -> bool:
    """Whether the wheels are in the ellipsoid for sure."""
    law, state, ranges, wheels = sample.law, sample.state, sample.ranges, sample.wheels
    ((_, highest),) = state.states.ends(PULL[None])
    if highest > law.gain * law.begins:
        return False
    speed, (slow, fast) = state.speed, asked.speeds
    if not (slow <= speed.low and speed.high <= fast and state.supply >= asked.supply):
        return False
    # The slope is bounded between all errors of the sample and the next.
    if not sample.errors.low - sample.reach.high <= asked.settled <= sample.errors.high - sample.reach.low:
        return False
    root = np.linalg.cholesky(np.asarray(asked.matrix, dtype=float)).T
    center = np.asarray(asked.center, dtype=float)
    error = PULL / law.gain - law.ahead * (WAY - PULL)
    change = ranges.slope.size * sample.moves + sample.friction.fading
    drag = sample.friction.drag_change.size + (wheels.share * wheels.damping).high * sample.moves
    drag += (wheels.share * wheels.damping).high * max(sample.errors.size, abs(asked.settled))
    share = wheels.share
    farthest = np.zeros(len(root))
    for g, slope, kappa in product(*((each.low, each.high) for each in (wheels.effect, ranges.slope, share))):
        # The further a wheel is from the reference, the less it slides: f - f_E = -S (e).
        torque = (law.falling - (1.0 + kappa) * slope * error) / g
        constant = (
            np.array([-asked.settled, 0.0, 0.0, (1.0 + kappa) * slope * asked.settled / g, 0.0]) - center
        )
        constant[2] += (1.0 + kappa) * slope * asked.settled / g
        rows = np.stack([error, P, torque + WAY - PULL, torque, 0.0 * P])
        of_error = np.array([0.0, 0.0, 1.0 - 1.0 / g, -1.0 / g, -1.0])
        of_torque = np.array([0.0, 0.0, 1.0, 1.0, 0.0]) * (((1.0 + kappa) * change + drag) / g)
        of_lag = np.array([0.0, 0.0, 1.0, 0.0, 1.0]) * (kappa * change + drag)
        ends = state.states.ends(root @ rows)
        beside = root @ of_error
        aside = np.abs(root @ of_torque) + np.abs(root @ of_lag)
        low = (
            ends[:, 0]
            + np.minimum(beside * state.error.low, beside * state.error.high)
            - aside
            + root @ constant
        )
        high = (
            ends[:, 1]
            + np.maximum(beside * state.error.low, beside * state.error.high)
            + aside
            + root @ constant
        )
        farthest = np.maximum(farthest, np.maximum(-low, high))
    length = float(np.linalg.norm(farthest) + np.linalg.norm(root @ np.asarray(asked.moved, dtype=float)))
    return length < 1.0 - INWARD
