"""Wheel loads with the shape of a track."""

import numpy as np
import pytest

from wspd_design.parameters.loading import load_rail, load_track_spectrum
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.track import SPACING, irregular_load, standard_deviation, synthesize
from wspd_design.studies.paper.disturbances import (
    LOAD_SPREAD,
    Disturbance,
    ideal_change,
    largest_change,
)

TRACK = load_track_spectrum("erri-b176")


@pytest.fixture(scope="module")
def load(er24pc):
    sigma = standard_deviation(TRACK, "vertical-high")
    return irregular_load(
        er24pc, synthesize(TRACK, ("vertical-high",), seed=1), sigma=sigma, spread=LOAD_SPREAD
    )


def test_loads_have_the_stated_spread_about_the_static_load(load):
    factors = np.array(load.factors)[:, round(60.0 / SPACING) :]
    assert factors.mean(axis=1) == pytest.approx(np.ones(4), abs=0.01)
    assert factors.std(axis=1) == pytest.approx(np.full(4, LOAD_SPREAD), rel=0.03)
    assert [row[0] for row in load.factors] == [1.0] * 4


def test_each_axle_meets_the_same_track_later(er24pc, load):
    distance = np.arange(len(load.factors[0])) * load.spacing
    first, last = np.array(load.factors[0]), np.array(load.factors[3])
    behind = er24pc.bogie_spacing + er24pc.wheelbase
    later = np.interp(distance[200:] - behind, distance, first)
    assert last[200:] == pytest.approx(later, abs=0.1 * LOAD_SPREAD)


@pytest.mark.parametrize(
    ("rail", "most"), [("table10-dry", 0.1), ("table10-wet", 0.1), ("polach-wet", 0.1), ("polach-dry", 0.5)]
)
def test_the_track_costs_a_perfect_brake_next_to_nothing(er24pc, load, rail, most):
    # Findings section 3.7: less than 0.1 m in a multibody stop. The dry rail has a sharp peak, which the slip
    # misses while the load moves.
    scenario = Scenario.stop(from_kmh=120.0, rail=load_rail(rail))
    assert 0.0 < abs(ideal_change(er24pc, scenario, load)) < most


def test_sensitive_stops_are_told_apart():
    def row(spread, by_pads, by_track):
        return Disturbance(controller="c", rail="r", spread=spread, by_pads=by_pads, by_track=by_track)

    rows = (row(0.0, 0.1, -0.7), row(2.0, 1.0, -8.0))
    assert largest_change(rows, sensitive=False) == 0.7
    assert largest_change(rows, sensitive=True) == 8.0
    assert largest_change(rows[:1], sensitive=True) == 0.0
