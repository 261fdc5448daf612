"""Common quadratic functions of a sampled loop: found where they exist, and never where a corner is unstable."""

import math
from itertools import product

import numpy as np
import pytest

from wspd_design.certificates.search.common_quadratic import contraction
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    STATES,
    LoopLaw,
    LoopRanges,
    Way,
    corners,
    latest_share,
)

UNITS = list(np.eye(STATES + len(DISTURBANCES)))
STEADY = LoopRanges(
    secants=(-3.0, 1.0),
    effects=(0.8, 0.8),
    ways=tuple(
        Way(part, part, late, seen)
        for part, late, seen in product((0.55, 0.65), (0.0, latest_share(0.02, 1.0, 0.0, 0.0)), (0.3, 0.62))
    ),
    shares_center=(0.0, 0.5),
)


def law(gain):
    return LoopLaw(sample_time=0.02, gain=gain, ahead=0.5, pole=math.exp(-0.6), kept=math.exp(-0.2))


def maps_of(gain):
    """[A B] of the rest beside a center at all corners."""
    return [rest for rest, _ in corners(law(gain), STEADY, UNITS)]


def test_factor_is_one_by_which_products_of_the_corners_fall():
    maps = [np.array(each)[:, :STATES] for each in maps_of(0.16)]
    factor = contraction(maps_of(0.16))
    assert factor is not None
    assert factor < 1.0
    random, steps = np.random.default_rng(5), 400
    together = np.eye(STATES)
    for number in random.integers(len(maps), size=steps):
        together = maps[number] @ together
    assert np.linalg.norm(together, 2) < 1e3 * factor**steps


@pytest.mark.parametrize("gain", [0.16, 3.0])
def test_no_function_is_found_where_a_corner_grows(gain):
    grows = any(max(abs(np.linalg.eigvals(np.array(each)[:, :STATES]))) > 1.0 for each in maps_of(gain))
    assert grows == (gain == 3.0)
    assert (contraction(maps_of(gain)) is None) == grows


def test_same_factor_each_time():
    assert len({contraction(maps_of(0.16)) for _ in range(3)}) == 1
