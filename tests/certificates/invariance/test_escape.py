"""Courses that leave the range of slip, against an integration by SciPy and against proved sets."""

from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.invariance.loops import feedback_problem, one_sample
from wspd_design.certificates.search.invariant_sets import escape
from wspd_design.certificates.search.invariant_sets.escape import described, escapes
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.loading import load_rail


@pytest.fixture(scope="module")
def designed(er24pc):
    """The designed law on the wet rail, with the whole box of the parameters."""
    rail, specification = load_rail("polach-wet"), Specification(sample_time=0.02)
    made = design_controller(er24pc, rail, specification, law="torque-feedback")
    return stability_problem(er24pc, rail, made.build(er24pc, rail), specification)


def leaves(problem, plant, share, speed, *, seconds=3.0):
    """Whether one plant leaves the range of slip at a held speed, by SciPy."""
    slip, torque = problem.slip, share * problem.vehicle.brake.max_torque
    for _ in range(round(seconds / problem.sample_time)):
        slip, torque, _, low, high = one_sample(problem, plant, slip, torque, speed)
        if low < problem.slips[0] or high > problem.slips[1]:
            return True
    return False


def test_plants_that_never_change_leave_as_scipy_finds(designed):
    speed = 2.85
    assert escapes(designed, [speed]).constant.all()
    # The law gives up too little torque there: with little friction the wheel slides on.
    slippery = (
        replace(designed.vehicle, mass=designed.mass_bounds[0], wheelset_inertia=designed.inertia_bounds[0]),
        replace(designed.rail, mu0=designed.mu0_bounds[0]),
    )
    for share in (0.2, 0.6, 1.0):
        assert leaves(designed, slippery, share, speed)


def test_nominal_parameters_stay_as_scipy_finds(designed):
    nominal = replace(
        designed,
        mass_bounds=2 * (designed.vehicle.mass,),
        inertia_bounds=2 * (designed.vehicle.wheelset_inertia,),
        mu0_bounds=2 * (designed.rail.mu0,),
    )
    speeds = [3.0, 12.0, 30.0]
    found = escapes(nominal, speeds)
    assert not found.changing.any()
    assert not leaves(nominal, (designed.vehicle, designed.rail), 0.4, 12.0, seconds=1.0)
    assert "finer cells might find a set" in described(nominal, speeds)


def test_what_is_proved_cannot_be_left(problem, found):
    """Sets for the whole of this box are accepted by the checker: no course may leave from all torques."""
    assert None not in found
    assert not escapes(problem, [23.0, 24.5, 26.0]).changing.any()


def test_change_does_more_than_its_absence(designed):
    found = escapes(designed, [2.8, 8.0, 30.0])
    assert found.constant.tolist() == [True, False, False]
    assert found.changing.tolist() == [True, True, False]
    words = described(designed, [2.8, 8.0, 30.0])
    assert "at 10 to 29 km/h, from each of" in words
    assert "at 10 km/h extremes that never change" in words


def test_wheels_that_lock_leave(designed, make_controller):
    locking = replace(designed, controller=replace(make_controller("none"), sample_time=0.02))
    assert escapes(locking, [10.0]).constant.all()


def test_an_integration_that_stands_still_would_see_nothing(designed, monkeypatch):
    monkeypatch.setattr(escape, "slip_dynamics", lambda *_: escape_free())
    assert not escapes(designed, [2.8]).changing.any()


def escape_free():
    """Dynamics of a slip that never moves."""
    return type("Still", (), {"drift": np.float64(0.0), "gain": np.float64(0.0)})


def test_no_more_speeds_are_tried_than_said():
    words = described(feedback_problem(spread=0.2), list(np.linspace(24.0, 26.0, 40)))
    assert f"Simulated at {escape.SPEEDS - 1} of" in words or f"Simulated at {escape.SPEEDS} of" in words
