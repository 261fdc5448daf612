"""The compiled loop of the four-axle locomotive against an independent simulation by SciPy's Radau method."""

from dataclasses import replace

import numpy as np
import pytest
from independent_axles import IndependentAxles

from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

SPEED = 25.0 / 3.6
X = 5  # place of the distance in the state of four axles
CASES = (("none", "polach-wet"), ("trenitalia", "table10-dry"), ("afsmc", "polach-dry"))


@pytest.mark.parametrize(("controller", "rail"), CASES)
def test_stop_with_load_transfer(er24pc, make_controller, controller, rail):
    law, scenario = make_controller(controller, rail), Scenario(rail=load_rail(rail), initial_speed=SPEED)
    run = simulate(er24pc, law, scenario, plant="planar")
    time, y = IndependentAxles(er24pc, scenario.rail).run(law, SPEED)
    assert run.totals.distance == pytest.approx(y[X], rel=1e-5)
    assert run.time[-1] == pytest.approx(time, rel=1e-5)
    assert np.ptp(run.wheel_load[len(run.time) // 2]) > 5e3  # N: there is load transfer


def test_a_load_transfer_that_is_too_great_is_seen(er24pc, make_controller):
    # The planted fault: the body stands one fifth higher.
    law, scenario = (
        make_controller("trenitalia"),
        Scenario(rail=load_rail("table10-dry"), initial_speed=SPEED),
    )
    high = replace(er24pc, body_height=1.2 * er24pc.body_height)
    run = simulate(high, law, scenario, plant="planar")
    _, y = IndependentAxles(er24pc, scenario.rail).run(law, SPEED)
    assert abs(run.totals.distance / y[X] - 1.0) > 1e-5


@pytest.mark.parametrize(("controller", "rail"), CASES)
def test_the_quarter_locomotive_is_the_symmetric_case(er24pc, make_controller, controller, rail):
    law, scenario = make_controller(controller, rail), Scenario(rail=load_rail(rail), initial_speed=SPEED)
    flat = replace(er24pc, body_height=0.0, bogie_height=0.0, traction_rod_height=0.0)
    four, quarter = (
        simulate(vehicle, law, scenario, plant=plant)
        for vehicle, plant in ((flat, "planar"), (er24pc, "quarter"))
    )
    assert (four.wheel_speed == four.wheel_speed[:, :1]).all()  # the axles cannot be told apart
    np.testing.assert_array_equal(four.wheel_speed[:, :1], quarter.wheel_speed)
    assert four.totals == quarter.totals
    np.testing.assert_allclose(four.wheel_load, er24pc.mass * 9.81 / 8.0, rtol=1e-12)
