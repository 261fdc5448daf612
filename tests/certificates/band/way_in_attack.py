"""Attack a proof of the way in over cells: ``python -m tests.certificates.band.way_in_attack RAIL SHARE WHEELS TIME``.

Wheels with all of the friction and supply rate, and the other numbers within a share of their ranges, half of them at
corners, are braked from rolling with the plant of the attacker and the law written once more. Told are the largest slip
on the way, and between what slips they are at the end of what is followed and after.
"""

import sys
from fractions import Fraction

from tests.certificates.band import from_rolling
from wspd_design.certificates.theorems.from_rolling.ways_in import ALL, box_around
from wspd_design.certificates.theorems.slip_band.way_in import around

AT_ONCE = 1_500  # wheels
AFTER = 20  # samples, that are followed after the last time


def attack(rail: str, share: Fraction, wheels: int, time: float) -> tuple[float, float, float]:
    """Return the largest slip, and the least and the largest one after some time [s]."""
    numbers = dict(zip(ALL, box_around(around(from_rolling.problem(rail), share)), strict=True))
    last = int(time / 0.02)
    top, least, most = 0.0, 1.0, 0.0
    for seed in range(0, wheels, AT_ONCE):
        points = from_rolling.members(rail, numbers, min(AT_ONCE, wheels - seed), seed)
        slip = from_rolling.courses(rail, points, last + AFTER, parts=2)["slip"]
        top, least, most = max(top, slip.max()), min(least, slip[last:].min()), max(most, slip[last:].max())
    return top, least, most


if __name__ == "__main__":
    found = attack(sys.argv[1], Fraction(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4]))
    print("slip at most {:.5f}, then from {:.6f} to {:.6f}".format(*found))
