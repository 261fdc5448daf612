"""The Knorr-Bremse controller: regions of eq. (18) and every cell of both decision tables."""

from itertools import pairwise

import pytest

from wspd_design.controllers.protocol import Measurement

RADIUS, PERIOD = 0.55, 0.1
SHARE = {0: 0.0, 1: 0.33, 2: 0.5, 3: 1.0}  # Section 4.2

# Data book sections 13 and 6: rising limits of the wheel acceleration, then a row for each band between them.
TABLES = {
    "calibrated": (
        (-8.39, -4.47, -0.54, 2.83, 7.32),
        (
            (-1, -3, -3, -3),
            (0, -3, -3, -3),
            (1, -2, -2, -3),
            (1, -1, -1, -2),
            (1, 0, 0, -1),
            (1, 1, 1, 0),
        ),
    ),
    "textbook": (
        (-6, -3.5, -1, 1, 3),
        (
            (-1, -2, -3, -3),
            (0, -1, -2, -3),
            (2, 0, -1, -3),
            (3, 1, 0, -2),
            (3, 2, 1, -1),
            (3, 3, 2, 0),
        ),
    ),
}


def regions(v):
    """Limits of the absolute slide in km/h at a speed in km/h, eq. (18) as printed."""
    if v <= 60.0:
        return 7 * v / 60 + 3, 9 * v / 60 + 6, 11 * v / 60 + 9
    return 10.0, 15.0, 20.0


def decide(controller, speed_kmh, slide_kmh, acceleration):
    speed = speed_kmh / 3.6
    rim = speed - slide_kmh / 3.6
    before = Measurement(speed=speed, wheel_speed=(rim - acceleration * PERIOD) / RADIUS, torque=0.0)
    now = Measurement(speed=speed, wheel_speed=rim / RADIUS, torque=0.0)
    return controller.step(controller.start(before), now)[1]


def expected(decision):
    return (SHARE[decision], 0.0) if decision > 0 else (0.0, SHARE[-decision])


@pytest.mark.parametrize("preset", ["calibrated", "textbook"])
@pytest.mark.parametrize("speed", [110.0, 45.0])
def test_every_cell(make_controller, preset, speed):
    controller = make_controller("knorr-bremse", preset=preset)
    limits, rows = TABLES[preset]
    inside = [limits[0] - 1.0]
    inside += [0.5 * (a + b) for a, b in pairwise(limits)]
    inside.append(limits[-1] + 1.0)
    one, two, three = regions(speed)
    slides = (0.5 * one, 0.5 * (one + two), 0.5 * (two + three), three + 1.0)
    for acceleration, row in zip(inside, rows, strict=True):
        for slide, decision in zip(slides, row, strict=True):
            command = decide(controller, speed, slide, acceleration)
            assert tuple(command) == expected(decision), (acceleration, slide)


@pytest.mark.parametrize("speed", [15.0, 30.0, 59.9, 60.1, 140.0])
def test_regions_of_eq_18(make_controller, speed):
    # In the row of the textbook table around zero acceleration the regions decide: 3, 1, 0, -2.
    controller = make_controller("knorr-bremse", preset="textbook")
    for limit, below, above in zip(regions(speed), (3, 1, 0), (1, 0, -2), strict=True):
        assert tuple(decide(controller, speed, limit - 0.01, 0.0)) == expected(below)
        assert tuple(decide(controller, speed, limit + 0.01, 0.0)) == expected(above)


def test_region_iv_cannot_be_reached_below_11_kmh(make_controller):
    # Even a locked wheel slides by no more than the speed (findings, eq. (18)).
    controller = make_controller("knorr-bremse", preset="textbook")
    assert tuple(decide(controller, 10.7, 10.7, 0.0)) == expected(0)
    assert tuple(decide(controller, 11.3, 11.3, 0.0)) == expected(-2)
