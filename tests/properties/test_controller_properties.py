"""What holds for every controller at every state and measurement."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wspd_design.controllers.protocol import Measurement

RADIUS = 0.55
CONTROLLERS = ("afsmc", "afsmc-repaired", "smc", "trenitalia", "knorr-bremse", "mitsubishi", "none")

measurements = st.builds(
    lambda speed, slip, torque: Measurement(
        speed=speed, wheel_speed=max(0.0, (1.0 - slip) * speed / RADIUS), torque=torque
    ),
    speed=st.floats(0.0, 60.0),
    slip=st.floats(-0.2, 1.0),
    torque=st.floats(0.0, 60e3),
)


def legal(command):
    return (
        0.0 <= command.fill <= 1.0
        and 0.0 <= command.vent <= 1.0
        and command.fill + command.vent <= 1.0 + 1e-12
    )


@pytest.mark.parametrize("name", CONTROLLERS)
@settings(max_examples=60, deadline=None)
@given(seen=st.lists(measurements, min_size=2, max_size=6))
def test_commands_are_possible_along_any_history(make_controller, name, seen):
    controller = make_controller(name)
    state = controller.start(seen[0])
    for measurement in seen:
        state, command = controller.step(state, measurement)
        assert legal(command)
        assert all(math.isfinite(x) for x in state)


@pytest.mark.parametrize("name", ["afsmc", "afsmc-repaired", "smc"])
@settings(max_examples=60, deadline=None)
@given(measurement=measurements, scale=st.floats(-1e4, 1e4), integral=st.floats(-50.0, 50.0))
def test_commands_are_possible_at_any_state(make_controller, name, measurement, scale, integral):
    controller = make_controller(name)
    state = tuple(integral if k == 0 else scale * (k + 1) for k in range(len(controller.start(measurement))))
    assert legal(controller.step(state, measurement)[1])


@pytest.mark.parametrize("name", CONTROLLERS)
@settings(max_examples=20, deadline=None)
@given(first=measurements, second=measurements)
def test_a_step_has_no_memory_of_its_own(make_controller, name, first, second):
    # Everything that is remembered is in the state: asking twice, with another question between, changes nothing.
    controller = make_controller(name)
    state = controller.start(first)
    once = controller.step(state, second)
    controller.step(once[0], first)
    assert controller.step(state, second) == once


@pytest.mark.parametrize("name", ["trenitalia", "knorr-bremse", "mitsubishi"])
@settings(max_examples=40, deadline=None)
@given(speed=st.floats(1.0, 50.0))
def test_baselines_fill_a_rolling_wheel(make_controller, name, speed):
    controller = make_controller(name)
    rolling = Measurement(speed=speed, wheel_speed=speed / RADIUS, torque=1e4)
    fill, vent = controller.step(controller.start(rolling), rolling)[1]
    assert fill > vent


@pytest.mark.parametrize("name", ["trenitalia", "knorr-bremse"])
@settings(max_examples=40, deadline=None)
@given(speed=st.floats(4.0, 50.0))
def test_baselines_relieve_a_locked_wheel(make_controller, name, speed):
    # Table 5 does not: a slide that is large but does not grow is (BZO, SPB), "increase small".
    controller = make_controller(name)
    locked = Measurement(speed=speed, wheel_speed=0.0, torque=1e4)
    fill, vent = controller.step(controller.start(locked), locked)[1]
    assert vent > fill
