"""The mended adaptive fuzzy law: which way it moves the valve, what it adapts, and where it does not."""

import pytest

from tests.unit.controllers.vehicle_cases import protection
from wspd_design.controllers.wheel_law import WheelView

FULL = 6e4


@pytest.fixture
def law(er24pc):
    return protection(er24pc, "afsmc-mended").core


def view(slip, *, speed=20.0, torque=2e4, available=FULL, desired=0.04, radius=0.55):
    return WheelView(
        speed=speed,
        acceleration=-1.5,
        wheel_speed=speed * (1.0 - slip) / radius,
        rolling_speed=speed / radius,
        desired_speed=speed * (1.0 - desired) / radius,
        desired_acceleration=-2.6,
        friction_torque=0.0,
        torque=torque,
        available=available,
        full_torque=FULL,
    )


def stepped(law, *slips, **changes):
    state = law.start(view(slips[0], **changes))
    for slip in slips:
        state, command = law.step(state, view(slip, **changes))
    return dict(zip(law.memory, state, strict=True)), command


def test_it_fills_below_the_desired_slip_and_vents_above(law):
    assert stepped(law, 0.0)[1].fill > 0.3
    assert stepped(law, 0.2)[1].vent == 1.0
    assert stepped(law, 0.04)[1] == (0.0, 0.0)


def test_a_slip_that_grows_vents_before_it_is_too_large(law):
    assert stepped(law, 0.0, 0.01, 0.03)[1].vent > 0.0


def weights(state):
    return [value for name, value in state.items() if name.startswith("weight")]


def test_weights_adapt_outside_the_layer_and_stay_bounded(law):
    state, _ = stepped(law, *[0.3] * 400)
    assert min(weights(state)) < -0.5
    assert all(-1.0 <= weight <= 1.0 for weight in weights(state))
    assert all(weight == 0.0 for weight in weights(stepped(law, *[0.041] * 50)[0]))


def test_nothing_adapts_where_the_brake_has_no_more_to_give(law):
    assert all(weight == 0.0 for weight in weights(stepped(law, *[0.0] * 50, torque=3e4, available=3e4)[0]))
    assert all(weight == 0.0 for weight in weights(stepped(law, *[0.3] * 50, torque=0.0)[0]))


def test_it_reads_neither_friction_nor_inertia(law):
    """The law has no such numbers, and what is observed of the friction does not matter to it."""
    assert set(law.__slots__) == {"sample_time", "wheel_radius", "gains"}
    state = law.start(view(0.02))
    assert law.step(state, view(0.02)) == law.step(state, view(0.02)._replace(friction_torque=9e4))
