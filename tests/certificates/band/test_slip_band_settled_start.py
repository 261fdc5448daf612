"""A stop that begins settled: the law expects what it measures next, and the torque holds the reference."""

from dataclasses import replace

import pytest

from tests.certificates.band.conftest import WET, problem_of
from tests.certificates.band.courses import Course, falling_problem
from wspd_design.certificates.theorems.slip_band import departure
from wspd_design.certificates.theorems.slip_band.reference import slip_at, turning_at
from wspd_design.certificates.theorems.slip_band.statement import NAMES, law_of
from wspd_design.controllers.observers.protocol import TRAIN_ACCELERATION
from wspd_design.controllers.protocol import VehicleMeasurement

SPEED, WORN = 12.0, 0.51
TOLD = ("friction_torque_1", "observed_speed_1", TRAIN_ACCELERATION, "speed_scale")


@pytest.fixture(scope="module", params=["constant", "falling"])
def problem(request):
    """With wheels that are damped all the time: those of the locomotive are only at first."""
    found = (
        problem_of(1.0) if request.param == "constant" else falling_problem(WET, 1.0, slip=0.4, largest=0.4)
    )
    return replace(found, vehicle=replace(found.vehicle, wheel_damping=20.0, wheel_damping_decay=0.0))


@pytest.fixture
def place(problem):
    """Worn wheels, and pads that are not the nominal ones."""
    return {name: problem.nominal(name) for name in NAMES} | {
        "wheel radius": WORN,
        "max torque": 1.1 * problem.nominal("max torque"),
        "speed": SPEED,
    }


def test_first_sample_of_a_settled_start_changes_nothing_of_what_is_observed(problem, place):
    at = departure.settled_stop(problem, place)
    law, count = at.law, problem.controller.wheelsets
    wheel = (1.0 - at.start.slip) * SPEED / WORN
    measured = VehicleMeasurement(
        speed=SPEED,
        wheel_speeds=(wheel,) * count,
        torques=(at.start.torque,) * count,
        healthy=(1.0,) * count,
        pressures=(at.start.torque / at.vehicle.brake.max_torque * at.vehicle.brake.max_pressure,) * count,
        acceleration=0.0,
        demand=1.0,
        reservoir=at.vehicle.brake.max_pressure,
    )
    state = law.start(measured)
    begun = dict(zip(law.memory, state, strict=True))
    after, _ = law.step(state, measured)
    found = dict(zip(law.memory, after, strict=True))
    for name in (TOLD[0], *TOLD[2:]):
        assert found[name] == pytest.approx(begun[name], rel=1e-9), name
    assert found[TOLD[1]] == pytest.approx(wheel, rel=1e-12)
    assert begun[TRAIN_ACCELERATION] < -0.1
    assert begun["speed_scale"] == pytest.approx(problem.controller.wheel_radius / WORN)


def test_torque_that_holds_the_reference_is_that_of_its_wheels(problem, place):
    """Of worn ones, which hold another slip where it falls, and take part in more of the deceleration."""
    law = law_of(problem.controller)
    worn = replace(problem, vehicle=replace(problem.vehicle, wheel_radius=WORN))
    course, slip = Course(worn, law, None), slip_at(law, SPEED, WORN)
    assert slip == pytest.approx(
        float(law.slip) * (WORN / (SPEED * float(law.radius))) ** 0.5 if law.falls else float(law.slip)
    )
    braking = course.braking(SPEED, slip)
    expected = course.holding(SPEED, slip, 0.0)
    expected += worn.vehicle.wheelset_inertia * turning_at(law, SPEED, WORN) * braking / WORN
    at = departure.settled_stop(problem, place)
    assert at.holding == pytest.approx(expected, rel=1e-6)
    assert departure.holding_share(problem, place) == pytest.approx(expected / place["max torque"], rel=1e-6)
    missing = departure.missing_torque(problem, place | {"max torque": 0.999 * expected})
    assert missing == pytest.approx(
        dict(zip(departure.LIMIT, (expected, 0.999 * expected), strict=True)), rel=1e-6
    )
    assert departure.missing_torque(problem, place | {"max torque": 1.001 * expected}) == {}
