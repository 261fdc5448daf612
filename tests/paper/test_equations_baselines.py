"""Eqs. (16)-(18), Tables 3 and 5."""

import numpy as np
import pytest

from derivations import baselines


def limits(v):
    """Region limits of eq. (18), in km/h, written down again from the paper."""
    if v > 60:
        return 10.0, 15.0, 20.0
    return 7 * v / 60 + 3, 9 * v / 60 + 6, 11 * v / 60 + 9


def test_speed_limits_are_a_slip_band():
    assert [float(x) for x in baselines.slip_band] == pytest.approx([1 - 0.90, 1 - 0.78])
    assert baselines.slip_band[0] < 0.14 < baselines.slip_band[1]


def test_slide_is_slip_times_speed():
    assert baselines.slide_residual == 0


def test_slide_regions():
    assert limits(60.0) == limits(60.0 + 1e-9)
    assert all(jump == 0 for jump in baselines.jumps)
    reachable = [v for v in np.arange(0.5, 60.0, 0.01) if limits(v)[2] < v]  # a slide is at most the speed
    assert min(reachable) == pytest.approx(float(baselines.region_four_from), abs=0.02)
    assert 11.0 < baselines.region_four_from < 11.1


def test_sign_missing_in_table_3():
    assert len(baselines.table_3_wrong) == 4
    assert {arrow for arrow, _ in baselines.table_3_wrong} == {baselines.DOWN}
    assert baselines.table_3_wrong_with_sign == []


def test_row_variable_of_table_5():
    levels = np.array(baselines.TABLE_5.tolist(), dtype=float)
    assert levels.shape == (7, 4)
    # More slide never asks for more pressure once the wheel decelerates (rows below BZO) ...
    assert (levels[4:, 3] <= levels[4:, 0]).all()
    # ... and so the rows have to ask for less pressure as the slide grows, which is +d sigma/dt.
    slope = np.polyfit(np.arange(7), levels.mean(axis=1), 1)[0]
    assert slope < 0
    assert np.sign(slope) == np.sign(baselines.level_per_slide_rate_corrected)
    assert baselines.level_per_slide_rate_printed > 0
