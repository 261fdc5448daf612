"""No wheel slide protection."""

from wspd_design.controllers.protocol import Measurement


def test_it_fills_whatever_happens(make_controller):
    controller = make_controller("none")
    locked = Measurement(speed=20.0, wheel_speed=0.0, torque=6e4)
    state, command = controller.step(controller.start(locked), locked)
    assert tuple(command) == (1.0, 0.0)
    assert state == ()
