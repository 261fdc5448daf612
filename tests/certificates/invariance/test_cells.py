"""The removal of cells on a system of which the largest invariant set is known."""

import numpy as np
import pytest

from wspd_design.certificates.search.invariant_sets.cells import CellSet, inside, largest_kept, touched
from wspd_design.certificates.search.invariant_sets.one_sample import Images, Window

GROWTH, LIMIT, DISTURBANCE = 1.25, 0.0625, 0.0225


def kept(per_unit, *, shrink=0.0):
    """Largest set of x' = a x - u + d with u = sat(x/4, u_max) and any d up to its bound, on cells."""
    start = CellSet(
        window=Window(low=1.0, high=1.0, tilt=0.0),
        per_unit=per_unit,
        first=(-per_unit // 2, 0),
        members=np.full((per_unit, 1), True),
    )
    slip, level = start.edges()

    def law(x):
        return GROWTH * x - np.clip(x, -LIMIT, LIMIT)  # rising in x

    spread = DISTURBANCE - shrink
    image = Images(
        slip_low=law(slip.inf) - spread,
        slip_high=law(slip.sup) + spread,
        level_low=level.inf,
        level_high=level.sup,
        between_low=slip.inf,
        between_high=slip.sup,
    )
    members = largest_kept(start.members, touched(start, image), np.zeros(per_unit, dtype=bool))
    at = slip.inf[members.ravel()], slip.sup[members.ravel()]
    return (float(at[0].min()), float(at[1].max())) if members.any() else None


def test_known_largest_set():
    """Outside the linear part (a - 1) x = u_max - d bounds what the limited input can hold."""
    exact = (LIMIT - DISTURBANCE) / (GROWTH - 1.0)
    previous = 0.0
    for per_unit in (32, 64, 128, 256, 1024, 4096):
        low, high = kept(per_unit)
        assert -low == high <= exact
        assert high >= previous  # finer cells lose nothing
        previous = high
    assert previous > exact - 2e-3


def test_shrunk_images_would_claim_too_much():
    exact = (LIMIT - DISTURBANCE) / (GROWTH - 1.0)
    assert kept(4096, shrink=0.5 * DISTURBANCE)[1] > exact


def test_nothing_is_left_without_authority():
    assert kept(256, shrink=-LIMIT) is None


@pytest.mark.parametrize("seed", range(3))
def test_inside_by_counting_is_inside_by_looking(seed):
    rng = np.random.default_rng(seed)
    grid = CellSet(
        window=Window(low=1.0, high=1.0, tilt=0.0),
        per_unit=16,
        first=(2, -3),
        members=rng.random((9, 7)) < 0.8,
    )
    low = rng.uniform(-0.1, 0.6, (2, 400)) + np.array([[0.1], [-0.2]])
    high = low + rng.uniform(0.0, 0.2, (2, 400))
    image = Images(
        slip_low=low[0],
        slip_high=high[0],
        level_low=low[1],
        level_high=high[1],
        between_low=low[0],
        between_high=high[0],
    )
    answers = inside(grid.members, touched(grid, image))
    assert 0 < answers.sum() < 400
    for k in range(400):
        cells = [
            (i - 2, j + 3)
            for i in range(int(np.floor(low[0, k] * 16)), int(np.ceil(high[0, k] * 16)))
            for j in range(int(np.floor(low[1, k] * 16)), int(np.ceil(high[1, k] * 16)))
        ]
        assert answers[k] == all(0 <= i < 9 and 0 <= j < 7 and grid.members[i, j] for i, j in cells)


def test_a_point_on_an_edge_is_somewhere():
    grid = CellSet(
        window=Window(low=1.0, high=1.0, tilt=0.0), per_unit=4, first=(0, 0), members=np.full((4, 4), False)
    )
    edge = np.array([0.5])
    point = Images(
        slip_low=edge, slip_high=edge, level_low=edge, level_high=edge, between_low=edge, between_high=edge
    )
    assert not inside(grid.members, touched(grid, point)).any()
