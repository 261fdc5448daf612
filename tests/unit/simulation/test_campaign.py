"""Many stops: drawn within their bounds, repeatable, the same numbers as single stops, interruptible."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.simulation import campaign
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.records import Scenario, Sensing
from wspd_design.simulation.stop import simulate

RAIL = "table10-wet"


@pytest.fixture(scope="module")
def scenario():
    return Scenario(rail=load_rail(RAIL), initial_speed=60.0 / 3.6, seed=5)


@pytest.fixture(scope="module")
def bounds():
    return [load_entries("vehicle", "er24pc"), load_entries("rail", RAIL)]


def test_nominal_runs_are_the_single_stop(er24pc, make_controller, scenario):
    controller = make_controller("trenitalia", RAIL)
    many = simulate_many(er24pc, controller, scenario, runs=18)
    single = simulate(er24pc, controller, scenario)
    assert many.complete
    assert many.table["stopped"].all()
    np.testing.assert_allclose(many.table["distance_m"], single.totals.distance, rtol=1e-9)
    np.testing.assert_allclose(many.table["torque_integral_Nms"], single.totals.torque, rtol=1e-9)


def test_parameters_are_drawn_within_their_bounds_and_used(er24pc, make_controller, scenario, bounds):
    controller = make_controller("none", RAIL)
    many = simulate_many(er24pc, controller, scenario, runs=40, bounds=bounds)
    for parameters in bounds:
        for name, (low, high) in parameters.bounds.items():
            drawn = many.table[f"{parameters.kind}.{name}"]
            assert ((drawn >= low) & (drawn <= high)).all()
            assert np.ptp(drawn) > 0.3 * (high - low)
    # Locked wheels: the distance falls with friction.
    assert np.corrcoef(many.table["rail.mu0"], many.table["distance_m"])[0, 1] < -0.4
    # One row again, as a single stop of its own.
    row = many.table[7]
    names = [name for name in many.sampled if name.startswith("vehicle.")]
    values = {name.partition(".")[2]: float(row[name]) for name in names}
    vehicle = campaign._vehicle_with(load_vehicle("er24pc"), values)
    rail_values = {n.partition(".")[2]: float(row[n]) for n in many.sampled if n.startswith("rail.")}
    own = replace(scenario, rail=replace(scenario.rail, **rail_values))
    assert simulate(vehicle, controller, own).totals.distance == pytest.approx(row["distance_m"], rel=1e-6)


@pytest.mark.parametrize("mass", [61473.0, 92209.0])
def test_the_body_takes_up_what_a_drawn_mass_adds(er24pc, make_controller, scenario, mass):
    """The parts weigh what the whole does; the load transfer, and with it the distance, is that of the heavy body."""
    changed = campaign._vehicle_with(er24pc, {"mass": mass})
    assert changed.mass == mass
    assert changed.body_mass + 2.0 * changed.bogie_mass == pytest.approx(mass)
    light = replace(changed, body_mass=er24pc.body_mass)
    controller = make_controller("trenitalia", RAIL)
    heavy, kept = (simulate(each, controller, scenario).totals.distance for each in (changed, light))
    assert heavy != pytest.approx(kept, rel=1e-6)


def test_same_seed_same_table(er24pc, make_controller, scenario, bounds):
    noisy = replace(scenario, sensing=Sensing(speed_noise=0.1))
    controller = make_controller("trenitalia", RAIL)
    first, again = (simulate_many(er24pc, controller, noisy, runs=20, bounds=bounds).table for _ in range(2))
    assert first.tobytes() == again.tobytes()
    other = simulate_many(er24pc, controller, replace(noisy, seed=6), runs=20, bounds=bounds).table
    assert not np.array_equal(first["distance_m"], other["distance_m"])


def test_an_interrupt_keeps_what_is_done(er24pc, make_controller, scenario):
    def interrupt(finished):
        if finished >= campaign.STOPS_SIDE_BY_SIDE:
            raise KeyboardInterrupt

    many = simulate_many(er24pc, make_controller("none", RAIL), scenario, runs=100, progress=interrupt)
    assert not many.complete
    assert campaign.STOPS_SIDE_BY_SIDE <= len(many.table) < 100
    assert (many.table["distance_m"] > 0.0).all()


def test_no_runs_are_refused(er24pc, make_controller, scenario):
    with pytest.raises(UserError, match="runs = 0 must be at least 1"):
        simulate_many(er24pc, make_controller("none", RAIL), scenario, runs=0)


def test_a_drawn_mass_is_carried_by_the_body(er24pc):
    heavy = campaign._vehicle_with(er24pc, {"mass": 1.1 * er24pc.mass})
    assert heavy.body_mass == pytest.approx(er24pc.body_mass + 0.1 * er24pc.mass, rel=1e-12)
    assert heavy.bogie_mass == er24pc.bogie_mass
