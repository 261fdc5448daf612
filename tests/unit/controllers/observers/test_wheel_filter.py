"""The filter on the wheels, sample by sample: releases, holds, lost sensors; the same code traced."""

from dataclasses import replace

import casadi
import numpy as np
import pytest

from wspd_design.controllers.observers.selection import speed_source
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.observers.wheel_filter import WheelFilter
from wspd_design.controllers.protocol import VehicleMeasurement
from wspd_design.design.records import Specification
from wspd_design.design.selection import named_design
from wspd_design.parameters.loading import load_rail

PERIOD, RADIUS, SLIP = 0.02, 0.55, 0.03


@pytest.fixture
def source(er24pc):
    """Make a filter."""

    def make(wheelsets=4, **sensors):
        made = speed_source(Sensors(speed="wheels", **sensors), replace(er24pc, wheelsets=wheelsets), PERIOD)
        assert isinstance(made, WheelFilter)
        return made

    return make


class Train:
    """A train that slows down evenly; its wheels do what the filter asks for at once, or are told otherwise."""

    def __init__(self, source, *, speed=30.0, deceleration=1.0, slide_from=1.0, free_speed_up=8.0):
        self.source, self.speed, self.deceleration = source, speed, deceleration
        self.slide_from, self.free = slide_from, free_speed_up
        self.rims = [speed] * source.wheelsets
        self.time, self.state, self.estimate, self.log = 0.0, None, None, []
        self.healthy = (1.0,) * source.wheelsets
        self.stuck = ()  # wheelsets that do not spin up

    @property
    def sliding_torque(self):
        vehicle = self.source.vehicle
        return self.deceleration * RADIUS * vehicle.mass / self.source.wheelsets

    def run(self, seconds):
        """Go on for some seconds."""
        for _ in range(round(seconds / PERIOD)):
            self._sample()
        return self

    def _sample(self):
        count = self.source.wheelsets
        slides = self.time >= self.slide_from
        self.speed -= self.deceleration * PERIOD
        torques = []
        for axle in range(count):
            asked = self.estimate is not None and (self.estimate.release[axle] + self.estimate.hold[axle]) > 0
            if not slides or (asked and axle not in self.stuck):
                self.rims[axle] = min(self.speed, self.rims[axle] + self.free * PERIOD)
            else:
                believed = self.state[0] if self.state else self.speed
                self.rims[axle] = max((1.0 - SLIP) * believed, self.rims[axle] - 6.0 * PERIOD, 0.0)
            rolls = self.rims[axle] == self.speed
            torques.append(0.0 if rolls and slides else self.sliding_torque)
        seen = VehicleMeasurement(
            speed=0.0,
            wheel_speeds=tuple(h * rim / RADIUS for h, rim in zip(self.healthy, self.rims, strict=True)),
            torques=(0.0,) * count,
            healthy=self.healthy,
            pressures=(0.0,) * count,
            acceleration=-self.deceleration,
            demand=min(self.time, 1.0),
            reservoir=6e5,
        )
        if self.state is None:
            self.state = self.source.start(seen)
        self.state, self.estimate = self.source.step(self.state, seen, tuple(torques), (SLIP,) * count)
        self.log.append((self.time, self.speed, self.estimate))
        self.time += PERIOD

    def released(self):
        """Samples of each release: wheelset and time at which it began."""
        began = []
        for (_, _, before), (time, _, now) in zip(self.log, self.log[1:], strict=False):
            began += [(axle, time) for axle, on in enumerate(now.release) if on > before.release[axle]]
        return began


def test_memory_names_every_element_of_the_state(source):
    for sensors in ({}, {"accelerometer": True}, {"accelerometer": True, "grade": True}):
        for wheelsets in (1, 4, 6):
            train = Train(source(wheelsets, **sensors)).run(0.1)
            assert len(train.state) == len(train.source.memory) == len(set(train.source.memory))
            assert train.source.memory[0] == "train_speed"


def test_nobody_is_released_while_wheels_roll(source):
    train = Train(source(), slide_from=1e9).run(8.0)
    assert train.released() == []
    assert train.state[0] == pytest.approx(train.speed, abs=0.1)


def test_one_wheelset_at_a_time_is_released_in_turn(source):
    train = Train(source()).run(20.0)
    began = train.released()
    assert len(began) >= 4
    assert [axle for axle, _ in began[:4]] == [0, 1, 2, 3]
    assert all(sum(estimate.release) <= 1.0 for _, _, estimate in train.log)
    assert train.state[0] == pytest.approx(train.speed, rel=0.04)


def test_a_wheel_that_was_found_is_held_and_then_let_go(source):
    train = Train(source()).run(20.0)
    for axle in range(4):
        held = [time for time, _, estimate in train.log if estimate.hold[axle] > 0]
        assert held
    for _, _, estimate in train.log:
        assert all(
            release * hold == 0.0 for release, hold in zip(estimate.release, estimate.hold, strict=True)
        )


def test_an_accelerometer_needs_fewer_releases(source):
    alone = Train(source()).run(20.0).released()
    with_it = Train(source(accelerometer=True)).run(20.0).released()
    assert 1 <= len(with_it) < len(alone)


def test_a_wheel_that_does_not_spin_up_is_given_up(source):
    train = Train(source())
    train.stuck = (0,)
    train.run(20.0)
    first, second = train.released()[:2]
    assert (first[0], second[0]) == (0, 1)
    assert second[1] - first[1] > train.source.numbers.give_up_time


def test_a_lost_sensor_changes_nothing_but_that_its_wheelset_is_not_asked(source):
    train = Train(source()).run(0.5)
    train.healthy = (1.0, 0.0, 1.0, 1.0)
    train.run(20.0)
    assert {axle for axle, _ in train.released()} == {0, 2, 3}
    assert max(abs(estimate.speed / speed - 1.0) for _, speed, estimate in train.log) < 0.05


@pytest.mark.parametrize("wheelsets", [1, 2])
def test_few_wheelsets_are_enough(source, wheelsets):
    train = Train(source(wheelsets)).run(20.0)
    assert max(abs(estimate.speed / speed - 1.0) for _, speed, estimate in train.log) < 0.05


def test_traced_filter_computes_what_python_does(source):
    train = Train(source(accelerometer=True, grade=True))
    law, count = train.source, 4
    seen = casadi.SX.sym("seen", 4 + 4 * count)
    state = casadi.SX.sym("state", len(law.memory))
    torques, slips = casadi.SX.sym("torques", count), casadi.SX.sym("slips", count)

    def part(k):
        return tuple(seen[1 + k * count + i] for i in range(count))

    symbols = VehicleMeasurement(
        seen[0], part(0), part(1), part(2), part(3), *(seen[1 + 4 * count + i] for i in range(3))
    )
    after, estimate = law.step(
        tuple(casadi.vertsplit(state)),
        symbols,
        tuple(casadi.vertsplit(torques)),
        tuple(casadi.vertsplit(slips)),
    )
    traced = casadi.Function(
        "step",
        [state, seen, torques, slips],
        [casadi.vertcat(*after), casadi.vertcat(*map(casadi.SX, estimate.release))],
    )
    compared = 0
    original = law.step

    class Compared:
        def __getattr__(self, name):
            return getattr(law, name)

        def step(self, state, seen, torques, slips):
            nonlocal compared
            after, estimate = original(state, seen, torques, slips)
            flat = [seen.speed, *seen.wheel_speeds, *seen.torques, *seen.healthy, *seen.pressures]
            got = traced(
                np.array(state), [*flat, seen.acceleration, seen.demand, seen.reservoir], torques, slips
            )
            assert np.array(got[0]).ravel() == pytest.approx(
                np.array(after, dtype=float), rel=1e-9, abs=1e-12
            )
            assert np.array(got[1]).ravel() == pytest.approx(estimate.release)
            compared += 1
            return after, estimate

    train.source = Compared()
    train.run(8.0)
    assert compared == 400
    assert train.released()


def test_names_of_the_filter_are_not_those_of_the_protection_around_it(er24pc):
    rail = load_rail("polach-wet")
    sensors = Sensors(speed="wheels", accelerometer=True, grade=True)
    law = named_design("observer-smc", er24pc, rail, Specification(sensors=sensors)).build(er24pc, rail)
    assert len(set(law.memory)) == len(law.memory)
