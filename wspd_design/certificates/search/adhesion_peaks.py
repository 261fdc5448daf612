"""Searches the adhesion peaks and the cuts of the slip that let the checker of ``adhesion_peaks.py`` see them.

Nobody has to trust this: a peak that is too low, or cuts that are too coarse, are refused.
"""

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from wspd_design.certificates.theorems.shortest_stop.adhesion_peaks import (
    FORMAT,
    MOST_CUTS,
    PartTest,
    part_test,
)
from wspd_design.certificates.theorems.shortest_stop.extremes import Extremes
from wspd_design.model import adhesion
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.loading import constants

SPEEDS, CROWDING = 200, 1.25  # intervals of the speed, closer together at low speed
SAMPLES = 2000  # of the slip, for a peak
MARGIN = 5e-5  # -, of a peak above its samples
DECIMALS = 6
LEAST_SLIP = 1e-6  # that is sampled
NEAR_LAST = Fraction(4, 5)  # of the last cut at the speed before, from where the rest may be one part
FIRST, WIDER, NARROWER, LEAST_STEP = 0.5, 1.5, 0.6, 1e-4  # relative steps from cut to cut


def search(plants: Extremes, start: float, intervals: int = SPEEDS) -> dict[str, Any]:
    """Return a certificate of the adhesion peaks from standstill to the initial speed [m/s]."""
    speeds = tuple(_decimal(start * (k / intervals) ** CROWDING) for k in range(intervals))
    tops = peaks(plants, speeds)
    cuts: list[tuple[Fraction, ...]] = []
    for speed, top in zip(speeds, tops, strict=True):
        last = cuts[-1][-1] if cuts and cuts[-1] else Fraction(0)
        cuts.append(_cuts(part_test(plants, speed), top, last))
    return {
        "format": FORMAT,
        "speeds": _written(speeds),
        "peaks": _written(tops),
        "cuts": [_written(each) for each in cuts],
    }


def peaks(plants: Extremes, speeds: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """Sample f/Q over the slip at each speed [m/s] and add a margin to its largest value."""
    import numpy as np

    load = float(static_wheel_load(plants.strong)) * plants.share
    stiffness = adhesion.contact_stiffness(plants.strong.contact, load)
    slips = np.geomspace(LEAST_SLIP, 1.0, SAMPLES)
    referred = np.maximum([float(speed) for speed in speeds], constants().slip_regularization_speed)
    sliding = referred[:, np.newaxis] * slips
    forces = adhesion.creep_force(slips, sliding, load, plants.strong_rail, stiffness)
    return tuple(_decimal(float(top) / load + MARGIN) for top in forces.max(axis=1))


def _cuts(holds: PartTest, top: Fraction, last: Fraction) -> tuple[Fraction, ...]:
    """Go from cut to cut as far as the test of a part allows; give up where it allows next to nothing.

    Whether the rest is one part is asked near the last cut of the speed before, since the peak moves little.
    """
    cuts: list[Fraction] = []
    low, step = Fraction(0), 1.0
    while len(cuts) < MOST_CUTS and not (low >= NEAR_LAST * last and holds(low, Fraction(1), top)):
        high = low
        while not (low < high < 1 and holds(low, high, top)) and step > LEAST_STEP:
            high = _decimal(float(low) * (1.0 + step) if low else step)
            step *= NARROWER
        if step <= LEAST_STEP:
            break
        cuts.append(high)
        low, step = high, step / NARROWER * WIDER if len(cuts) > 1 else FIRST
    return tuple(cuts)


def _decimal(number: float) -> Fraction:
    return Fraction(round(number * 10**DECIMALS), 10**DECIMALS)


def _written(decimals: Iterable[Fraction]) -> str:
    """Write decimals without loss."""
    return " ".join(f"{float(each):.{DECIMALS}f}".rstrip("0").rstrip(".") for each in decimals)
