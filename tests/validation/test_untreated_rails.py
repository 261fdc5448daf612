"""Stops on untreated rails as they were published: class 387 from 55 mph on rails of 0.02, Rail Engineer 2018."""

from dataclasses import replace

import pytest

import wspd_design as wd

DEMAND = 0.9  # m/s2, step 3
PRINTED = 1200.0  # m, "more than" that without sand
BOUND = 1441.0  # m, if the rails gave 0.02 at every slip; ../shared/practice.md 2.1


@pytest.mark.parametrize("law", ["trenitalia", "none"])
def test_more_than_1200_m_without_sand(law):
    metro, rail = wd.load_vehicle("metro"), replace(wd.load_rail("very-low"), mu0=0.02)
    brake = replace(metro.brake, max_torque=metro.brake.max_torque * DEMAND / 1.3)  # 1.3 m/s2 is its own
    metro = replace(metro, brake=brake)
    controller = wd.controller(law, metro, rail, wd.Specification())
    stop = wd.simulate(metro, controller, wd.Scenario.stop(from_kmh=55 * 1.609344, rail=rail))
    assert stop.totals.distance > PRINTED
    if (
        law == "trenitalia"
    ):  # running resistance shortens the stop, friction that falls with sliding lengthens it
        assert stop.totals.distance == pytest.approx(BOUND, rel=0.1)
