"""CasADi functions of the plant compute what the Python kernels compute."""

import numpy as np
import pytest

from wspd_design.codegen.functions import quarter_plant, slip_plant
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.quarter import quarter


def random_states(vehicle, count):
    rng = np.random.default_rng(3)
    for _ in range(count):
        speed = rng.uniform(0.02, 34.0)
        slip = rng.uniform(-0.01, 1.0)
        yield {
            "time": rng.uniform(0.0, 20.0),
            "speed": speed,
            "slip": slip,
            "wheel_speed": (1.0 - slip) * speed / vehicle.wheel_radius,
            "share": rng.uniform(0.0, 1.0),
            "valve": ((1.0, 0.0), (0.0, 1.0), (0.0, 0.0))[rng.integers(3)],
        }


@pytest.mark.parametrize("name", uniform_rails())
def test_quarter_plant(er24pc, name):
    rail, brake = load_rail(name), er24pc.brake
    function, plant = quarter_plant(er24pc, rail), quarter(er24pc, rail)
    for point in random_states(er24pc, 50):
        pressure = point["share"] * brake.max_pressure
        state = (point["speed"], point["wheel_speed"], pressure)
        got = np.array(function(point["time"], state, point["valve"])).ravel()
        motion = plant.motion(
            point["time"], point["speed"], point["wheel_speed"], point["share"] * brake.max_torque
        )
        fill, vent = point["valve"]
        supply = brake.max_pressure * -np.expm1(-0.75 * point["time"])
        filling = fill * (supply - pressure) / brake.fill_time - vent * pressure / brake.vent_time
        np.testing.assert_allclose(
            got, (motion.acceleration, motion.wheel_acceleration, filling), rtol=1e-12, atol=1e-9
        )


@pytest.mark.parametrize("name", uniform_rails())
def test_slip_plant_and_its_jacobians(er24pc, name):
    rail, brake = load_rail(name), er24pc.brake
    plant = slip_plant(er24pc, rail)
    for point in random_states(er24pc, 50):
        speed, slip, duty = point["speed"], abs(point["slip"]), point["share"]
        torque = (1.0 - duty) * brake.max_torque
        dynamics = slip_dynamics(er24pc, rail, slip, speed)
        np.testing.assert_allclose(
            [float(x) for x in plant.drift_and_gain(slip, speed)], [dynamics.drift, dynamics.gain], rtol=1e-12
        )
        rates = np.array(plant.derivative(slip, torque, speed, duty)).ravel()
        expected = (
            dynamics.drift + dynamics.gain * torque,
            (duty * brake.max_torque - torque) / brake.fill_time,
        )
        np.testing.assert_allclose(rates, expected, rtol=1e-11, atol=1e-9)
        # CasADi differentiates the drift by itself; the kernel has the slope from SymPy.
        a, b = (np.array(x) for x in plant.jacobians(slip, torque, speed, duty))
        np.testing.assert_allclose(
            a, [[dynamics.pole, dynamics.gain], [0.0, -1.0 / brake.fill_time]], rtol=1e-9, atol=1e-12
        )
        np.testing.assert_allclose(b, [[0.0], [brake.max_torque / brake.fill_time]], rtol=1e-14)


def test_a_changed_vehicle_gets_its_own_function(er24pc):
    from dataclasses import replace

    rail = load_rail("polach-dry")
    heavier = replace(er24pc, mass=2.0 * er24pc.mass)
    state = (20.0, 30.0, 3e5)
    assert float(quarter_plant(heavier, rail)(1.0, state, (1, 0))[0]) != float(
        quarter_plant(er24pc, rail)(1.0, state, (1, 0))[0]
    )
