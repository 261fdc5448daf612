"""Wheel lock as a state: it begins at omega = 0, is held by the brake, and is released by venting."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from wspd_design.codegen import closed_loop
from wspd_design.controllers.protocol import Command
from wspd_design.model.brake import Valve, pressure_after
from wspd_design.model.number import where
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.quarter import quarter
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate

INITIAL_SPEED = 120.0 / 3.6
RESOLUTION = 7e-3  # s, two points of the traces and a step


@dataclass(frozen=True, kw_only=True)
class Schedule:
    """Fill, hold, vent and brake gently, each from its time on; a user's own controller."""

    hold_from: float
    vent_from: float
    gentle_from: float
    name: str = "schedule"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return (1e-9,)  # the time, a little late, so that rounding moves no edge

    def step(self, state, measurement):  # noqa: ARG002
        (time,) = state
        fill = where(time < self.hold_from, 1.0, where(time > self.gentle_from, 0.2, 0.0))
        vent = where(time > self.gentle_from, 0.8, where(time > self.vent_from, 1.0, 0.0))
        return (time + self.sample_time,), Command(fill=fill, vent=vent)


LOCK_AND_RELEASE = Schedule(hold_from=4.0, vent_from=6.0, gentle_from=12.0)


@pytest.fixture(scope="module")
def rail():
    return load_rail("polach-wet")


@pytest.fixture(scope="module")
def locked_and_released(er24pc, rail):
    scenario = Scenario(rail=rail, initial_speed=INITIAL_SPEED)
    return simulate(er24pc, LOCK_AND_RELEASE, scenario, plant="quarter")


def locked(run):
    """Points of the traces at which the wheel stands while the train moves."""
    return (run.wheel_speed[:, 0] == 0.0) & (run.speed > 0.1)


def test_lock_is_held_and_transmits_what_the_rail_gives(er24pc, stop):
    run = stop("none", "polach-wet")
    standing = locked(run)
    first = np.argmax(standing)
    assert standing.sum() > 100
    assert (run.wheel_speed[first:, 0] == 0.0).all()  # 60 kN m holds it to the end
    np.testing.assert_array_equal(run.slip[first:][run.speed[first:] >= 0.1], 1.0)
    # Polach's force at slip 1 written out again: transmitted torque 2 R f per wheelset.
    c, load = er24pc.contact, er24pc.mass * 9.81 / 8
    mu = 0.30 * (0.6 * np.exp(-0.2 * run.speed[standing]) + 0.4)
    axes = c.semi_axis_rolling * c.semi_axis_lateral * (load / c.reference_load) ** (2 / 3)
    epsilon = 0.25 * np.pi * c.shear_modulus * axes * c.kalker_c11 / (load * mu)
    force = 2 * load * mu / np.pi * (0.3 * epsilon / (1 + (0.3 * epsilon) ** 2) + np.arctan(0.1 * epsilon))
    np.testing.assert_allclose(run.torque[standing, 0][1:], 2 * 0.55 * force[1:], rtol=1e-9)
    assert np.max(2 * 0.55 * force) < 0.95 * er24pc.brake.max_torque


def test_lock_time_is_the_time_at_rest(stop):
    run = stop("none", "polach-wet")
    at_rest = run.time[-1] - run.time[np.argmax(run.wheel_speed[:, 0] == 0.0)]
    assert run.totals.lock_time == pytest.approx(at_rest, abs=RESOLUTION)


def test_venting_releases_the_wheel(er24pc, rail, locked_and_released):
    run = locked_and_released
    standing = np.flatnonzero(locked(run))
    begin, end = run.time[standing[0]], run.time[standing[-1]]
    assert begin < 4.0  # it locks while filling
    assert end > 6.0  # and stays locked while the pressure is held
    assert run.totals.lock_time == pytest.approx(end - begin, abs=2.0 * RESOLUTION)
    # At the release the braking torque has just come down to what the rail gives.
    brake = er24pc.brake
    filled = pressure_after(brake, Valve.FILL, 4.0, 0.0, 0.0)
    falling = brake.max_torque * filled / brake.max_pressure * np.exp(-(end - 6.0) / brake.vent_time)
    last = quarter(er24pc, rail).motion(end, run.speed[standing[-1]], 0.0, falling)
    assert falling == pytest.approx(2.0 * er24pc.wheel_radius * last.creep_force, rel=RESOLUTION / 0.6)
    # The free wheel then runs up to the speed of the train.
    assert run.slip[np.argmax(run.time > 11.9), 0] < 1e-3


def test_wheel_never_runs_backwards(locked_and_released, stop):
    for run in (locked_and_released, stop("none", "table10-wet"), stop("mitsubishi", "polach-wet")):
        assert run.wheel_speed.min() >= 0.0


def test_a_lock_that_is_held_too_long_is_seen(monkeypatch, er24pc, rail, locked_and_released):
    # The planted fault: the lock is left at half of what the rail gives, 0.6 s ln 2 of venting too late.
    true = closed_loop.closed_loop_source
    condition = "(1.0 - BALANCED) < at->passed[l]"

    def faulty(*arguments, **options):
        source = true(*arguments, **options)
        assert condition in source
        return source.replace(condition, condition.replace("at", "0.5 * at"))

    monkeypatch.setattr(closed_loop, "closed_loop_source", faulty)
    named = replace(er24pc, name="held too long")  # so that the loop is made anew
    scenario = Scenario(rail=rail, initial_speed=INITIAL_SPEED)
    run = simulate(named, LOCK_AND_RELEASE, scenario, plant="quarter")
    assert run.totals.lock_time == pytest.approx(
        locked_and_released.totals.lock_time + 0.6 * np.log(2.0), abs=0.05
    )


def test_weak_brake_does_not_lock(er24pc, make_controller, rail):
    weak = replace(er24pc, brake=replace(er24pc.brake, max_torque=12e3))
    run = simulate(
        weak, make_controller("none"), Scenario(rail=rail, initial_speed=INITIAL_SPEED), plant="quarter"
    )
    assert run.totals.lock_time == 0.0
    assert run.ending is Ending.STOPPED
    assert run.slip_max < 0.02
