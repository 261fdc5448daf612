"""Integrals of super-twisting and of the integral sliding mode: they learn an error, and do not wind up."""

import pytest

from tests.unit.controllers.vehicle_cases import protection
from wspd_design.controllers.super_twisting import twisting
from wspd_design.controllers.wheel_law import WheelView

FULL = 6e4


def view(error, *, torque=2e4, available=FULL, desired=30.0):
    return WheelView(
        speed=17.0,
        acceleration=-1.5,
        wheel_speed=desired + error,
        rolling_speed=1.03 * desired,
        desired_speed=desired,
        desired_acceleration=-2.6,
        friction_torque=2e4,
        torque=torque,
        available=available,
        full_torque=FULL,
    )


@pytest.mark.parametrize("law", ["super-twisting", "integral-smc"])
def test_an_error_that_stays_is_pulled_harder_and_harder_up_to_a_limit(er24pc, law):
    core = protection(er24pc, law).core
    state, sizes = core.start(view(0.05)), []
    for _ in range(300):
        state, _ = core.step(state, view(0.05))
        sizes.append(state[0])
    assert sizes[10] > sizes[1] > 0.0
    assert sizes[-1] == sizes[-2]


@pytest.mark.parametrize("law", ["super-twisting", "integral-smc"])
def test_nothing_grows_while_the_brake_has_no_more_to_give(er24pc, law):
    core = protection(er24pc, law).core
    for seen in (view(3.0, torque=1e4, available=1e4), view(-29.0, torque=0.0)):
        state = core.start(seen)
        for _ in range(5):
            state, _ = core.step(state, seen)
        assert state == (0.0,)


def test_twisting_grows_with_the_root_beyond_its_layer():
    assert twisting(0.1, 8.0, 0.2) == pytest.approx(0.8)
    assert twisting(0.8, 8.0, 0.2) == pytest.approx(8.0 * 0.4)
    assert twisting(-0.8, 8.0, 0.2) == -twisting(0.8, 8.0, 0.2)
