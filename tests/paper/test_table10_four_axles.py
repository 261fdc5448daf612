"""All 24 numbers of Table 10 beside the four-axle locomotive on the calibrated rails: the goal of the calibration.

Printed gains, calibrated rule tables, sample time 100 ms.
"""

from dataclasses import replace

import pytest

from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.records import Scenario
from wspd_design.studies.paper.published import load_table10
from wspd_design.studies.paper.table10 import largest, root_mean_square, table10_rows

RMS, LARGEST = 0.015, 0.04


def _rows(vehicle, published):
    trials = {}
    for each in published.stops:
        rail = load_rail(each.rail)
        law = controller(each.controller, vehicle, rail, Specification())
        scenario = Scenario.stop(from_kmh=published.initial_speed_kmh, rail=rail)
        trials[each.controller, each.rail] = trial(vehicle, law, scenario, slip_reference=0.14)
    return table10_rows(published.stops, trials, vehicle)


@pytest.fixture(scope="module")
def rows(er24pc):
    return _rows(er24pc, load_table10())


def test_all_24_numbers(rows):
    assert sum(len(row.deviations) for row in rows) == 24
    assert root_mean_square(rows) <= RMS
    assert largest(rows) <= LARGEST


def test_the_momentum_balance_gives_the_torque_integral(rows):
    for row in rows:
        # The train still moves at 5 mm/s when a stop ends: that is 1.5e-4 of its momentum.
        assert row.metrics.torque_integral == pytest.approx(row.momentum, rel=2e-4)
        assert row.momentum / 1e3 == pytest.approx(row.published.torque_integral_kNms, rel=0.01)


def test_lag_makes_the_ranking(rows):
    start = 120.0 / 3.6
    for rail in ("table10-dry", "table10-wet"):
        of_rail = {row.published.controller: row for row in rows if row.published.rail == rail}
        slow, fast = of_rail["knorr-bremse"], of_rail["afsmc"]
        printed = slow.published.distance_m - fast.published.distance_m
        assert start * (slow.published.lag(start) - fast.published.lag(start)) > 0.8 * printed
        ours = slow.metrics.distance - fast.metrics.distance
        assert start * (slow.metrics.lag - fast.metrics.lag) > 0.8 * ours


def test_another_inertia_is_caught(er24pc):
    """The planted fault: half the rotating mass is missing."""
    rows = _rows(replace(er24pc, wheelset_inertia=0.5 * er24pc.wheelset_inertia), load_table10())
    assert root_mean_square(rows) > RMS


def test_a_slow_valve_is_caught(er24pc):
    brake = replace(er24pc.brake, fill_time=1.2, vent_time=1.2)
    rows = _rows(replace(er24pc, brake=brake), load_table10())
    assert largest(rows) > LARGEST
