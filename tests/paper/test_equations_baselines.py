"""Eqs. (16)-(18), Tables 3 and 5."""

import numpy as np
import pytest

from derivations.notation import symbol
from tests.lazily import Lazily
from wspd_design.parameters.loading import load_knorr_bremse

baselines = Lazily("baselines")


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
    assert [float(v) for v in baselines.regions_from] == pytest.approx([3.40, 7.06, 11.02], abs=0.005)
    for region, lowest in enumerate(baselines.regions_from):
        reachable = [v for v in np.arange(0.5, 60.0, 0.01) if limits(v)[region] < v]  # a slide is at most v
        assert min(reachable) == pytest.approx(float(lowest), abs=0.02)


def test_duty_of_the_levels():
    table = load_knorr_bremse("calibrated")
    assert [float(dc) for dc in baselines.DUTY_OF_LEVEL.values()] == list(table.pulses)


def test_disturbing_torque():
    torque, times = 6e4, np.linspace(0.0, 2.0, 9)
    shown = [float(baselines.disturbing_torque_printed.subs(_of(torque, t))) for t in times]
    assert shown == pytest.approx(
        0.05 * torque * np.exp(-4.0 * times) * np.sin(10.0 * np.pi * times), abs=1e-6
    )


def _of(torque, time):
    return {symbol("braking_torque"): torque, symbol("time"): time}


def test_signs_of_table_3():
    assert baselines.table_3_ambiguities == 0  # as a code: one number for each arrow
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


def test_variable_of_table_5_stays_open():
    # A wheel of the rim speed 20 - 5 t on a train of the speed 22 - 3.5 t: its deceleration and d sigma/dt differ by a.
    slide_rate, wheel_deceleration, deceleration = -3.5 + 5.0, 5.0, 3.5
    assert wheel_deceleration - slide_rate == deceleration
    assert str(baselines.wheel_deceleration_apart) == "deceleration"
    levels = np.array(baselines.TABLE_5.tolist(), dtype=float)
    assert levels[3, 3] == int(baselines.level_at_largest_slide) == 1  # (BZO, SPB) = IS: fills
    assert baselines.levels_of_locked_wheel == (1, 1, 1, 1)  # rows BNB to BZO of the largest slide
