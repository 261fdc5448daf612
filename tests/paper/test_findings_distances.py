"""Distances of an independent trial simulation of the four-axle locomotive, on four rails.

It was another program with the same calibrated data: bound, ideal slip and no WSP within 1.5 %, the printed adaptive
fuzzy law, whose limit cycle depends on details, within 3 %.
"""

import pytest

from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

RAILS = ("table10-dry", "table10-wet", "polach-dry", "polach-wet")
BOUND = (183.6, 211.7, 183.4, 275.0)
CONSTANT_SLIP = (184.1, 220.4, 214.2, 290.1)
NO_WSP = (183.6, 211.7, 249.3, 424.4)
PRINTED_LAW = (184.9, 219.8, 223.4, 315.7)
TRENITALIA = (185.4, 220.9, 212.9, 307.3)


@pytest.mark.parametrize(("rail", "distance"), list(zip(RAILS, BOUND, strict=True)))
def test_bound(er24pc, rail, distance):
    stop = ideal_stop(er24pc, Scenario.stop(from_kmh=120.0, rail=load_rail(rail)))
    assert stop.distance == pytest.approx(distance, rel=0.015)


@pytest.mark.parametrize(("rail", "distance"), list(zip(RAILS, CONSTANT_SLIP, strict=True)))
def test_constant_slip(er24pc, rail, distance):
    stop = ideal_stop(er24pc, Scenario.stop(from_kmh=120.0, rail=load_rail(rail)), slip=0.14)
    assert stop.distance == pytest.approx(distance, rel=0.015)


@pytest.mark.parametrize(
    ("controller", "rail", "distance", "tolerance"),
    [
        (controller, rail, distance, tolerance)
        for controller, distances, tolerance in (
            ("none", NO_WSP, 0.015),
            ("afsmc", PRINTED_LAW, 0.03),
            ("trenitalia", TRENITALIA, 0.015),
        )
        for rail, distance in zip(RAILS, distances, strict=True)
    ],
)
def test_controllers(er24pc, make_controller, controller, rail, distance, tolerance):
    scenario = Scenario.stop(from_kmh=120.0, rail=load_rail(rail))
    run = simulate(er24pc, make_controller(controller, rail), scenario)
    assert run.totals.distance == pytest.approx(distance, rel=tolerance)


def test_nobody_stops_in_the_printed_time_on_the_published_wet_rail(er24pc):
    stop = ideal_stop(er24pc, Scenario.stop(from_kmh=120.0, rail=load_rail("polach-wet")))
    assert stop.stopping_time > 14.4
