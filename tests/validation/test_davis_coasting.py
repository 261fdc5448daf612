"""Trains that coast against the closed form of M v' = -(a0 + a1 v + a2 v^2), M with what turns."""

import math
from dataclasses import dataclass, replace

import pytest

import wspd_design as wd
from wspd_design.controllers.protocol import Command

KMH = 3.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Released:
    """A law that keeps the brake released."""

    name: str = "released"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002 - it looks at nothing
        return ()

    def step(self, state, measurement):  # noqa: ARG002 - it looks at nothing
        return state, Command(fill=0.0, vent=1.0)


def coasted(vehicle, start, end):
    """Time [s] and distance [m] from one speed to another [m/s]."""
    a0, a1, a2 = (getattr(vehicle, f"resistance_{name}") for name in ("constant", "linear", "quadratic"))
    whole = vehicle.mass + vehicle.wheelsets * vehicle.wheelset_inertia / vehicle.wheel_radius**2
    root = math.sqrt(4.0 * a0 * a2 - a1**2)

    def angle(speed):
        return math.atan((2.0 * a2 * speed + a1) / root)

    def force(speed):
        return a0 + a1 * speed + a2 * speed**2

    time = 2.0 * whole / root * (angle(start) - angle(end))
    return time, whole / (2.0 * a2) * math.log(force(start) / force(end)) - a1 / (2.0 * a2) * time


@pytest.mark.parametrize(
    ("name", "speed"), [("coach", 25.0), ("freight-wagon", 30.0), ("two-axle-wagon", 30.0), ("co-co", 15.0)]
)
def test_coasting_follows_the_closed_form(name, speed):
    vehicle = replace(wd.load_vehicle(name), wheel_damping=0.0)
    stop = wd.Scenario.stop(from_kmh=speed, rail=wd.load_rail("polach-dry"))
    run = wd.simulate(vehicle, Released(), stop)
    time, distance = coasted(vehicle, speed / KMH, float(run.speed[-1]))
    assert run.time[-1] > 60.0
    assert run.time[-1] == pytest.approx(time, rel=2e-4)
    assert run.totals.distance == pytest.approx(distance, rel=2e-4)
    light = replace(vehicle, wheelset_inertia=1.0)  # without what turns the closed form is another one
    assert coasted(light, speed / KMH, float(run.speed[-1]))[0] < 0.995 * time
