"""What the band is stated about: numbers of the law that runs, and cells that leave nothing of the box out."""

import math
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from tests.certificates.band.conftest import LOCO, problem_of
from tests.certificates.band.sampled_runs import Law
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    NAMES,
    box_of,
    halved,
    law_of,
)
from wspd_design.controllers.observer_form import ObserverForm, TorqueObserver
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import VehicleMeasurement
from wspd_design.controllers.references import ConstantSlip, FallingSlip
from wspd_design.parameters.bounds import Bounds

SAMPLES = 400
WORN = 0.53  # m


class Stated(Law):
    """The law of the attacker with the numbers of the statement."""

    def __init__(self, numbers):
        n = SimpleNamespace(**{name: float(x) for name, x in vars_of(numbers).items() if x is not None})
        brake = SimpleNamespace(fill_time=n.fill_time / n.time_share, vent_time=n.vent_time / n.time_share)
        self.valve = SimpleNamespace(brake=brake, time_share=n.time_share, least_pulse=n.least_pulse)
        self.tracking = n  # has the names of its numbers
        self.source = SimpleNamespace(largest_scale_error=getattr(n, "largest_scale_error", math.inf))
        self.h, self.inertia, self.radius = n.sample_time, n.inertia, n.radius
        self.slip, self.slew = n.slip, getattr(n, "torque_slew", 1e15) / n.inertia
        self.full = n.full_torque
        self.theta = math.exp(-n.observer_rate * n.sample_time)
        self.new = 1.0 - math.exp(-n.sample_time / n.acceleration_time)
        self.falls = bool(n.falls)

    def desired(self, memory):
        """With a slip that falls the rims take part in more of a change of the speed."""
        if not self.falls:
            return super().desired(memory)
        slip = self.slip / np.sqrt(memory.told)
        return (
            (1.0 - slip) * memory.told / self.radius,
            (1.0 - slip / 2.0) * memory.acceleration / self.radius,
        )


def vars_of(numbers):
    return {name: getattr(numbers, name) for name in type(numbers).__dataclass_fields__}


# What leaves small changes of the torque out: dead band [N m], its share of the desired slip, shortest pulse [s]
KINDS = {
    "constant": (ConstantSlip(slip=0.14), 0.0, 0.0, 0.0),
    "falling": (FallingSlip(slip=0.5, largest=0.4), 0.0, 0.0, 0.0),
    "dead band": (ConstantSlip(slip=0.14), 900.0, 100.0, 0.0),
    "dead band that narrows": (ConstantSlip(slip=0.14), 3000.0, 0.05, 0.0),
    "shortest pulse": (ConstantSlip(slip=0.14), 0.0, 0.0, 0.002),
}


@pytest.fixture(scope="module")
def problem():
    return problem_of(1.0)


def protection_with(problem, kind):
    """A law with numbers that differ from each other."""
    reference, dead_band, share, least = KINDS[kind]
    law = problem.controller
    brake = replace(law.valve.brake, fill_time=0.7, vent_time=0.45)
    valve = replace(law.valve, brake=brake, least_pulse=least)
    core = replace(
        law.core,
        tracking=replace(
            law.core.tracking, valve=valve, dead_band=dead_band, dead_band_share=share, ahead=0.37
        ),
        torque_slew=0.4 * law.core.torque_slew,
    )
    return replace(law, core=core, valve=valve, reference=reference, observer_rate=23.0)


@pytest.fixture(params=KINDS)
def protection(request, problem):
    return protection_with(problem, request.param)


def test_law_of_the_statement_commands_what_the_protection_does(protection):
    """Beside the reference and far from it, on the same course of speeds and torques."""
    random, stated = np.random.default_rng(6), Stated(law_of(protection))
    count, h, full = protection.wheelsets, protection.sample_time, protection.valve.brake.max_torque
    pressure = protection.valve.brake.max_pressure

    def measured(speed, wheel, torque):
        return VehicleMeasurement(
            speed=speed,
            wheel_speeds=(wheel,) * count,
            torques=(torque,) * count,
            healthy=(1.0,) * count,
            pressures=(torque / full * pressure,) * count,
            acceleration=0.0,
            demand=1.0 if torque else 0.0,
            reservoir=pressure,
        )

    speed = 24.0
    rolling = measured(speed, speed / WORN, 0.0)
    state = protection.start(rolling)
    memory = stated.rolling(np.array([speed]), WORN)
    mean, seen, opened = None, np.zeros(2), set()
    for k in range(SAMPLES):
        slip = 0.0 if k < 3 else float(stated.slip / (math.sqrt(speed) if stated.falls else 1.0))
        far = 0.05 if k % 7 == 0 else 0.004
        wheel = (1.0 - slip + random.uniform(-far, far) * (k >= 3)) * speed / WORN
        torque = 0.0 if k < 3 else full * random.uniform(0.25, 0.45)
        if k:
            memory = stated.measured(memory, mean, np.array([speed]), np.array([wheel]))
        state, commands = protection.step(state, measured(speed, wheel, torque))
        fill, vent, mean = stated.pulses(memory, np.array([wheel]), np.array([torque]), full * (k >= 3))
        expected = np.array([fill[0], vent[0]]) / h
        if k >= 3:
            np.testing.assert_allclose([commands[0].fill, commands[0].vent], expected, atol=1e-9)
            seen += expected
            opened.add(tuple(expected > 0.0))
        speed -= h * random.uniform(0.3, 1.0)
        if speed < 6.0:
            break
    assert min(seen) > 1.0
    assert {(True, False), (False, True)} <= opened


def test_scale_that_the_law_does_not_take_is_that_of_the_statement(protection):
    """From wheels that roll too fast or too slowly to be worn."""
    largest = float(law_of(protection).largest_scale_error)
    for part in (0.99, 1.01):
        radius = protection.wheel_radius / (1.0 + part * largest)
        start = Stated(law_of(protection)).rolling(np.array([20.0]), np.array([radius]))
        count = protection.wheelsets
        state = protection.start(
            VehicleMeasurement(
                speed=20.0,
                wheel_speeds=(20.0 / radius,) * count,
                torques=(0.0,) * count,
                healthy=(1.0,) * count,
                pressures=(0.0,) * count,
                acceleration=0.0,
                demand=0.0,
                reservoir=protection.valve.brake.max_pressure,
            )
        )
        scale = dict(zip(protection.memory, state, strict=True))["speed_scale"]
        assert scale == pytest.approx(float(start.scale[0]))


class Declared(SimpleNamespace):
    """A law that says the numbers of a protection."""

    memory = ()
    name = "declared"

    def start(self, measurement):
        raise NotImplementedError

    step = observed = start


def test_numbers_that_are_declared_are_those_of_a_protection_that_has_them(problem):
    protection = protection_with(problem, "falling")
    brake, tracking = protection.valve.brake, protection.core.tracking
    form = ObserverForm(
        slip=protection.reference.slip,
        falls=True,
        approach_rate=tracking.approach_rate,
        ahead=tracking.ahead,
        observer_rate=protection.observer_rate,
        acceleration_time=protection.source.acceleration_time,
        wheelset_inertia=protection.wheelset_inertia,
        wheel_radius=protection.wheel_radius,
        full_torque=brake.max_torque,
        full_pressure=brake.max_pressure,
        fill_time=brake.fill_time,
        vent_time=brake.vent_time,
        time_share=protection.valve.time_share,
        torque_slew=protection.core.torque_slew,
        slip_error=0.01,
        slip_drift=0.3,
    )
    law = Declared(observer_form=form, sample_time=protection.sample_time, wheelsets=protection.wheelsets)
    assert isinstance(law, TorqueObserver)
    assert not isinstance(law, Protection)
    found = replace(law_of(law), slip_error=Fraction(0), slip_drift=Fraction(0))
    assert found == replace(law_of(protection), largest_scale_error=None)
    assert (law_of(law).slip_error, law_of(law).slip_drift) == (Fraction(0.01), Fraction(0.3))
    other = Declared(observer_form=replace(form, torque_slew=None), sample_time=0.02, wheelsets=4)
    assert law_of(other).torque_slew is None


# --- the box and its cells ----------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def uneven(problem):
    """Ranges that reach farther up than down, but for that of the radius."""
    ends = {name: (0.8 * problem.nominal(name), 1.3 * problem.nominal(name)) for name in NAMES}
    return replace(problem, bounds=Bounds.of(ends | {"wheel radius": (0.5, LOCO.wheel_radius)}))


@pytest.mark.parametrize("share", [1.0, 0.5, 0.0625])
def test_share_of_the_box_is_that_of_the_way_to_either_end(uneven, share):
    for name, ends in zip(NAMES, box_of(uneven, Fraction(share)), strict=True):
        nominal = uneven.nominal(name)
        low, high = (1.0 - 0.2 * share) * nominal, (1.0 + 0.3 * share) * nominal
        if name == "wheel radius":
            low, high = 0.55 - 0.05 * share, 0.55
        assert tuple(map(float, ends)) == pytest.approx((low, high))


@pytest.mark.parametrize("letter", LETTERS)
def test_both_halves_of_a_cell_are_all_of_it(uneven, letter):
    cell = box_of(uneven, Fraction(1))
    lower, upper = halved(cell, letter)
    (k,) = (n for n in range(len(NAMES)) if lower[n] != cell[n])
    assert NAMES[k] == dict(zip(LETTERS, NAMES, strict=True))[letter]
    assert (lower[k][0], upper[k][1]) == cell[k]
    assert lower[k][1] == upper[k][0]
    assert lower[k][1] - lower[k][0] == upper[k][1] - upper[k][0] > 0
    assert all(
        one == other == whole
        for n, (one, other, whole) in enumerate(zip(lower, upper, cell, strict=True))
        if n != k
    )
