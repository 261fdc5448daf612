"""Stops of a vehicle whose pads fade over speed against a published brake table.

Distances of the table HSP160 of ARTC's ESD-05-03, as digitized in the repository rafidmorshedi/train-brake-curves
(MIT). Its stops on the level are v t_e + v^2 / (2 (a0 + a1 v)) with t_e = 1.886 s, a0 = 0.845 m/s2 and a1 = -0.00406
1/s; a deceleration a0 + 3/2 a1 v at each speed gives that. Nothing was fitted to the grades.
"""

from dataclasses import replace

import pytest

from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.model.slip import resistance
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import Pads
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

START, FALL, DELAY = 0.845, 1.5 * -0.00406, 1.886  # m/s2 at standstill, 1/s, s
GRADES = (1 / 60, 0.01, 0.005, 0.0, -0.005, -0.01, -1 / 60)
TABLE = {  # m, by km/h, along the grades
    50: (127, 135, 142, 149, 157, 167, 182),
    80: (308, 328, 346, 366, 389, 415, 456),
    100: (482, 516, 546, 579, 617, 662, 733),
    120: (701, 754, 799, 851, 911, 980, 1092),
    140: (963, 1038, 1103, 1177, 1263, 1363, 1527),
    150: (1110, 1197, 1274, 1361, 1462, 1580, 1774),
}


@pytest.fixture(scope="module")
def fading():
    """A vehicle with the deceleration of the table, by the friction of its pads over speed."""
    vehicle = load_vehicle("er24pc-service")
    radius, axles = vehicle.wheel_radius, vehicle.wheelsets
    turning = vehicle.mass + axles * vehicle.wheelset_inertia / radius**2
    speeds = (0.0, 10.0, 20.0, 30.0, 45.0)
    torques = [
        (turning * (START + FALL * speed) - resistance(vehicle, speed)) * radius / axles for speed in speeds
    ]
    factors = tuple(torque / torques[0] for torque in torques)
    brake = replace(vehicle.brake, max_torque=torques[0], fill_time=DELAY - 1.0 / vehicle.brake.supply_rate)
    return replace(vehicle, brake=brake, pads=Pads(speeds=speeds, speed_factors=factors))


def distance(vehicle, kmh, grade):
    scenario = Scenario(rail=load_rail("polach-dry"), initial_speed=kmh / 3.6, grade=grade)
    return simulate(
        vehicle, Unprotected(name="none", sample_time=0.1), scenario, plant="quarter"
    ).totals.distance


@pytest.mark.parametrize("kmh", TABLE)
def test_published_distances(fading, kmh):
    for grade, published in zip(GRADES, TABLE[kmh], strict=True):
        found = distance(fading, kmh, grade)
        assert found == pytest.approx(published, rel=0.02 if grade == 0.0 else 0.03), (kmh, grade)


def test_pads_that_do_not_fade_miss_them(fading):
    constant = replace(fading, pads=None)
    assert distance(constant, 150, 0.0) < 0.9 * TABLE[150][3]
