"""Momentum and energy of every shipped vehicle with blending, magnets, fading pads and a reservoir that runs low."""

from dataclasses import replace

import pytest

from wspd_design.controllers.baselines.trenitalia import Trenitalia
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail, load_trenitalia, load_vehicle
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake
from wspd_design.simulation.metrics import energy_residual, momentum_residual
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

PADS = Pads(
    speeds=(0.0, 10.0, 30.0),
    speed_factors=(1.15, 1.0, 0.8),
    temperatures=(0.0, 40.0, 120.0),
    temperature_factors=(1.0, 1.0, 0.8),
    heat_capacity=4e4,
)


def fitted(vehicle):
    """All of them, as strong as the vehicle needs."""
    torque = vehicle.brake.max_torque
    brake = replace(
        vehicle.brake, cylinder_volume=0.01, reservoir_volume=0.01 * vehicle.wheelsets, reservoir_pressure=7e5
    )
    return replace(
        vehicle,
        brake=brake,
        pads=PADS,
        dynamic=DynamicBrake(
            torque=0.6 * torque,
            power=0.4 * torque * 20.0 / vehicle.wheel_radius,
            build_up_time=0.5,
            fade_speed=3.0,
            cut_out_speed=1.0,
            drop_slip=0.25,
        ),
        track_brake=TrackBrake(force=0.03 * vehicle.mass * 9.81, build_up_time=0.8, cut_out_speed=5.0),
    )


HARDEST = ("co-co", "two-axle-wagon")  # the most axles, and a wagon on single ones


@pytest.mark.parametrize("rail", ["polach-dry", "low-adhesion"])
@pytest.mark.parametrize(
    "name",
    [
        each if each in HARDEST else pytest.param(each, marks=pytest.mark.reference)
        for each in available("vehicle")
    ],
)
def test_residuals(name, rail):
    vehicle = fitted(load_vehicle(name))
    law = Trenitalia(
        name="trenitalia",
        sample_time=0.1,
        wheel_radius=vehicle.wheel_radius,
        table=load_trenitalia("textbook"),
    )
    run = simulate(vehicle, law, Scenario(rail=load_rail(rail), initial_speed=15.0))
    assert abs(momentum_residual(run, vehicle)) < 1e-6
    assert abs(energy_residual(run, vehicle)) < 1e-6
    assert run.dynamic_torque is not None
    assert run.dynamic_torque.max() > 0.2 * vehicle.brake.max_torque
    assert run.track_brake_force is not None
    assert run.track_brake_force.max() > 0.02 * vehicle.mass * 9.81
