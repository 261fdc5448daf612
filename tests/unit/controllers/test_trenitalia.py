"""The Trenitalia controller, cell by cell of Table 3."""

from dataclasses import replace

import pytest

from wspd_design.controllers.protocol import Measurement

RADIUS, PERIOD = 0.55, 0.1
FILL, VENT, HOLD = "fill", "vent", "hold"

# Table 3. Rows: d(R omega)/dt above ACC, below DEC, between; columns: above V_max, below V_min, between.
TABLE_3 = {
    ("above ACC", "above V_max"): FILL,
    ("above ACC", "below V_min"): VENT,
    ("above ACC", "between"): FILL,
    ("below DEC", "above V_max"): FILL,
    ("below DEC", "below V_min"): VENT,
    ("below DEC", "between"): VENT,
    ("between", "above V_max"): FILL,
    ("between", "below V_min"): VENT,
    ("between", "between"): HOLD,
}
SPEED_RATIO = {"above V_max": 0.901, "below V_min": 0.779, "between": 0.85}  # eq. (16): 0.78 and 0.90
PULSES = {"calibrated": (0.96, 0.95), "textbook": (0.5, 0.33)}  # data book 13; Section 4.2 for |u| = 2 and 1
LIMITS = {"calibrated": (4.16, -10.9), "textbook": (2.0, -6.0)}  # data book 13 and 5


def decide(controller, ratio, acceleration, speed=20.0):
    rim = ratio * speed
    before = Measurement(speed=speed, wheel_speed=(rim - acceleration * PERIOD) / RADIUS, torque=0.0)
    now = Measurement(speed=speed, wheel_speed=rim / RADIUS, torque=0.0)
    return controller.step(controller.start(before), now)[1]


@pytest.mark.parametrize("preset", ["calibrated", "textbook"])
@pytest.mark.parametrize(("cell", "decision"), TABLE_3.items())
def test_every_cell(make_controller, preset, cell, decision):
    acc, dec = LIMITS[preset]
    acceleration = {"above ACC": acc + 0.05, "below DEC": dec - 0.05, "between": 0.5 * (acc + dec)}[cell[0]]
    fill, vent = PULSES[preset]
    expected = {FILL: (fill, 0.0), VENT: (0.0, vent), HOLD: (0.0, 0.0)}[decision]
    command = decide(make_controller("trenitalia", preset=preset), SPEED_RATIO[cell[1]], acceleration)
    assert tuple(command) == expected


def test_thresholds_lie_where_they_are_stated(make_controller):
    controller = make_controller("trenitalia", preset="textbook")
    assert decide(controller, 0.85, 1.999).fill == 0.0
    assert decide(controller, 0.85, 2.001).fill == 0.5
    assert decide(controller, 0.85, -5.999).vent == 0.0
    assert decide(controller, 0.85, -6.001).vent == 0.33
    assert decide(controller, 0.899, 0.0) == decide(controller, 0.781, 0.0)


def test_first_sample_knows_no_acceleration(make_controller):
    controller = make_controller("trenitalia")
    first = Measurement(speed=30.0, wheel_speed=25.0 / RADIUS, torque=0.0)  # between the speed limits
    state, command = controller.step(controller.start(first), first)
    assert tuple(command) == (0.0, 0.0)
    assert state == (pytest.approx(25.0),)


def test_a_swapped_pulse_is_seen(make_controller):
    good = make_controller("trenitalia", preset="textbook")
    bad = replace(good, table=replace(good.table, fill_pulse=0.33))
    assert decide(bad, 0.95, 0.0) != decide(good, 0.95, 0.0)
