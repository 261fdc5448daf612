"""The slip once it has reached its reference, and the build-up of the brake: known numbers, made up and simulated."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.unit.reporting.sample_dossier import trial
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.held_slip import build_up, held_slip_of, perfect_hold
from wspd_design.simulation.ideal import ideal_run, ideal_stop
from wspd_design.simulation.records import Patch, Scenario

SPEED = 120.0 / 3.6


def _with_slip(column):
    """A stop of ten seconds with the same slip of all wheelsets, as a function of time."""
    run = trial("mine").run
    slip = np.array([column(t) for t in run.time])[:, np.newaxis] * np.ones((1, 4))
    return replace(run, slip=slip)


def test_what_lies_before_the_reference_does_not_count():
    held = held_slip_of(_with_slip(lambda t: 0.0 if t < 3.0 else 0.14), 0.14)
    assert held.reached == pytest.approx(3.0, abs=0.03)
    assert (held.wheelsets, held.overshoot, held.undershoot) == (4, 0.0, 0.0)
    assert held.rms == pytest.approx(0.0, abs=1e-12)


def test_overshoot_and_undershoot_are_told_apart():
    # From 2 s on by turns .04 above and .09 below the reference, as long each: rms sqrt((.04^2 + .09^2)/2).
    held = held_slip_of(_with_slip(lambda t: 0.0 if t < 2.0 else 0.18 if t % 1.0 < 0.5 else 0.05), 0.14)
    assert held.overshoot == pytest.approx(0.04)
    assert held.undershoot == pytest.approx(0.09)
    assert held.rms == pytest.approx(math.sqrt((0.04**2 + 0.09**2) / 2.0), rel=0.03)


def test_a_slip_that_never_gets_there_has_no_figures():
    held = held_slip_of(_with_slip(lambda _: 0.1), 0.14)
    assert held.wheelsets == 0
    assert all(math.isnan(each) for each in (held.reached, held.rms, held.overshoot, held.undershoot))


def test_the_build_up_is_that_of_the_torque_and_never_negative():
    run = trial("mine").run
    ramp = np.minimum(run.time / 2.0, 1.0)[:, np.newaxis] * 30e3 * np.ones((1, 4))
    time, distance = build_up(replace(run, torque=ramp))
    assert time == pytest.approx(1.8, abs=0.03)
    assert distance == pytest.approx(float(np.interp(1.8, run.time, run.distance)), abs=1.0)
    falling = (6e4 - 5e3 * run.time)[:, np.newaxis] * np.ones((1, 4))
    assert build_up(replace(run, torque=falling)) == (0.0, float(run.distance[0]))


# By an independent simulation of a quarter locomotive that fills until slip .14 and holds it then.
@pytest.mark.parametrize(
    ("rail", "rms", "distance"),
    [
        ("polach-dry", 0.0714, 213.9),
        ("table10-dry", 0.0766, None),
        ("polach-wet", 0.0441, 289.9),
        ("low-adhesion", 0.0206, None),
    ],
)
def test_the_perfect_law_misses_a_tolerance_that_counts_the_build_up(er24pc, rail, rms, distance):
    stop = Scenario(rail=load_rail(rail), initial_speed=SPEED)
    totals = ideal_run(er24pc, stop, slip=0.14, plant="quarter").totals
    mean, square = totals.slip / totals.judged_time, totals.slip_squared / totals.judged_time
    assert math.sqrt(square - 2.0 * 0.14 * mean + 0.14**2) == pytest.approx(rms, abs=1e-4)
    if distance is not None:
        assert totals.distance == pytest.approx(distance, abs=0.1)
    assert totals.distance == pytest.approx(
        ideal_stop(er24pc, stop, slip=0.14, plant="quarter").distance, rel=1e-9
    )
    held = perfect_hold(er24pc, stop, slip=0.14, plant="quarter")
    assert held.rms < 0.02
    assert held.overshoot < 1e-6


def test_there_is_no_perfect_law_where_there_is_no_ideal_stop(er24pc):
    stop = Scenario(
        rail=load_rail("polach-wet"),
        initial_speed=SPEED,
        patches=(Patch(start=50.0, rail=load_rail("low-adhesion")),),
    )
    assert perfect_hold(er24pc, stop, slip=0.14) is None
