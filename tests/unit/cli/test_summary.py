"""The spread of many stops, compared with a table whose quantiles are known."""

import math

import numpy as np
import pytest

from wspd_design.cli.summary import SUMMARIZED, summarize
from wspd_design.simulation.campaign import Campaign

NAMES = [name for name in SUMMARIZED if name != "longest_lock_s"]
AXLES = [f"longest_lock_s_{axle}" for axle in (1, 2)]
CHECKED = ["step_distance_change", "step_slip_change"]


def campaign(stopped, **columns):
    table = np.zeros(101, dtype=[*((name, "f8") for name in (*NAMES, *AXLES, *CHECKED)), ("stopped", "?")])
    table["distance_m"] = np.arange(101)[::-1]
    table["stopped"] = stopped
    for name in CHECKED:
        table[name] = math.nan
    for name, values in columns.items():
        table[name] = values
    return Campaign(
        controller="c", rail="r", plant="quarter", sampled=(), check_every=50, table=table, complete=True
    )


def test_quantiles():
    found = summarize(campaign(True), wanted=101)
    spread = found.spreads["distance_m"]
    assert (spread.min, spread.p05, spread.median, spread.p95, spread.max) == (0.0, 5.0, 50.0, 95.0, 100.0)
    assert found.not_stopped_share == 0.0


def test_trains_that_do_not_stop_are_counted_and_left_out():
    found = summarize(campaign(np.arange(101) >= 50), wanted=101)
    assert found.not_stopped_share == pytest.approx(50.0 / 101.0)
    assert found.spreads["distance_m"].max == 50.0


def test_no_train_stops():
    found = summarize(campaign(False), wanted=101)
    assert found.not_stopped_share == 1.0
    assert math.isnan(found.spreads["distance_m"].median)


def test_the_longest_lock_is_that_of_any_axle():
    locks = {"longest_lock_s_1": np.arange(101), "longest_lock_s_2": 60.0}
    spread = summarize(campaign(True, **locks), wanted=101).spreads["longest_lock_s"]
    assert (spread.min, spread.max) == (60.0, 100.0)


def test_figures_that_are_not_there_are_left_out():
    some = np.where(np.arange(101) < 3, (1.0,) * 101, math.nan)
    assert summarize(campaign(True, efficiency=some), wanted=101).spreads["efficiency"].median == 1.0
    none = summarize(campaign(True, slip_rms=math.nan), wanted=101).spreads["slip_rms"]
    assert math.isnan(none.max)


def test_step_checks_are_counted():
    change = np.full(101, math.nan)
    change[[0, 50, 100]] = 1e-9, 2e-6, 3e-7
    slip = np.full(101, math.nan)
    slip[[0, 50, 100]] = 2e-4, 1e-5, 1e-6
    checks = summarize(campaign(True, step_distance_change=change, step_slip_change=slip), wanted=101).checks
    assert (checks.rows, checks.failed) == (3, 2)  # one by its distance, one by its slip
    assert (checks.distance_change, checks.slip_change) == (2e-6, 2e-4)
    nothing = summarize(campaign(True), wanted=101).checks
    assert (nothing.rows, nothing.failed) == (0, 0)
    assert math.isnan(nothing.distance_change)
