"""The spread of many stops, compared with a table whose quantiles are known."""

import math

import numpy as np
import pytest

from wspd_design.cli.summary import summarize
from wspd_design.simulation.campaign import Campaign


def campaign(stopped):
    table = np.zeros(
        101,
        dtype=[("distance_m", "f8"), ("stopping_time_s", "f8"), ("lock_time_s", "f8"), ("stopped", "?")],
    )
    table["distance_m"] = np.arange(101)[::-1]
    table["stopped"] = stopped
    return Campaign(controller="c", plant="quarter", sampled=(), table=table, complete=True)


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
