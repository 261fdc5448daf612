"""Ranges for which a loop is worked out: secants, windows of speed, errors, steepness; and those for which none is."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise, product

import numpy as np
import pytest

from tests.certificates.band.conftest import WET
from tests.certificates.band.courses import (
    EXACT,
    PULSE,
    WINDOW,
    Course,
    doubles,
    falling_problem,
    friction_of,
    laws,
    loop_in,
)
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.setting import creep_slope
from wspd_design.certificates.theorems.slip_band import loop
from wspd_design.certificates.theorems.slip_band.friction import REACHES, reached
from wspd_design.certificates.theorems.slip_band.loop import loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice
from wspd_design.certificates.theorems.slip_band.reference import slip_at
from wspd_design.certificates.theorems.slip_band.statement import (
    NAMES,
    box_of,
    fastest_loss,
    halved,
    law_of,
    windows_of,
)
from wspd_design.parameters.bounds import Bounds


@pytest.mark.parametrize("settled", [-0.06, 0.0, 0.13])
@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("kind", ["plain", "damped"])
def test_secants_from_where_errors_are_counted_are_within_their_bounds(request, kind, number, settled):
    """Friction and damping of a wheel at any error that is reached, over its inertia."""
    problem = request.getfixturevalue(kind)
    law = laws(problem)[2 * number]
    low, high = doubles(loop_in(problem, law, settled).ranges.secants)
    radius, inertia = problem.vehicle.wheel_radius, problem.vehicle.wheelset_inertia
    course = Course(problem, law, None)
    for v, x in product(WINDOW, np.linspace(-0.0199, 0.0399, 40)):
        slip, error = slip_at(law, v, radius), x * problem.speeds[0] / radius
        if abs(error - settled) > 1e-4:
            torque = course.holding(v, slip, error) - course.holding(v, slip, settled)
            assert low <= torque / inertia / (error - settled) <= high


@pytest.mark.parametrize("near", range(len(REACHES)))
def test_errors_are_kept_where_the_slope_is_bounded_for_every_wheel(plain, near):
    worn = replace(
        plain, bounds=type(plain.bounds).of(dict(plain.bounds.items()) | {"wheel radius": (0.5, 0.55)})
    )
    for low, high in (doubles(each) for each in (loop_in(worn, laws(plain)[0], near=near).widest,)):
        for radius in (0.5, 0.55):
            ends = (low * radius / plain.speeds[0], high * radius / plain.speeds[0])
            assert float(reached(near)[0]) - 1e-12 <= ends[0] < ends[1] <= float(reached(near)[1]) + 1e-12


@pytest.mark.parametrize("letters", ["", "m", "u", "mu", "i"])
def test_cell_takes_the_bounds_for_the_steepness_of_its_masses_and_frictions(monkeypatch, letters):
    """Wheels are the steeper, the lighter they are and the less friction there is."""
    problem = falling_problem(WET, 1.0)
    cells = [box_of(problem, Fraction(1))]
    for letter in letters:
        cells = [half for each in cells for half in halved(each, letter)]
    asked = []
    monkeypatch.setattr(loop, "bounds_for", lambda _, steepness: asked.append(steepness) or 1 / 0)
    for cell in cells:
        with pytest.raises(ZeroDivisionError):
            loop_of(problem, law_of(problem.controller), cell, WINDOW, (), Choice(PULSE, 0), EXACT)
    nominal = creep_slope.steepness_of(replace(problem, bounds=Bounds.of({})))[0]
    for cell, (low, high) in zip(cells, asked, strict=True):
        mass, mu0 = ([float(end) for end in cell[NAMES.index(name)]] for name in ("mass", "mu0"))
        ends = [
            nominal * (problem.nominal("mass") / m) ** (1.0 / 3.0) * problem.nominal("mu0") / u
            for m, u in zip(mass, mu0, strict=True)
        ]
        assert (high, low) == pytest.approx(ends, rel=1e-9)


def test_windows_overlap_by_what_a_sample_takes_off(plain):
    windows, loss = (
        windows_of(plain),
        float(fastest_loss(plain)) * float(law_of(plain.controller).sample_time),
    )
    rail, course = plain.rail, Course(plain, None, None)
    most = max(course.braking(v, s) for v, s in product(plain.speeds, np.linspace(0.01, 0.5, 50)))
    assert plain.span("mu0")[1] >= rail.mu0
    assert most < float(fastest_loss(plain))
    assert windows[0][0] <= plain.speeds[0] - loss
    assert windows[-1][1] >= plain.speeds[1]
    for (_, fast), (slow, _) in pairwise(windows):
        assert slow <= fast - (1.0 - 1e-9) * loss


def test_share_of_the_pressure_that_holds_is_no_more_than_it_is(damped):
    law = laws(damped)[0]
    course = Course(damped, law, None)
    held = [course.holding(v, 0.18, 0.0) / float(law.full_torque) for v in WINDOW]
    told = loop_in(damped, law).holding
    assert 0.98 * min(held) < told <= min(held)


def test_train_that_may_lose_more_speed_than_windows_overlap_or_gain_some_is_refused(plain):
    law = laws(plain)[0]
    friction = friction_of(plain, law, WINDOW)
    windy = replace(plain, vehicle=replace(plain.vehicle, resistance_linear=0.2 * plain.vehicle.mass))
    windy = replace(
        windy, bounds=type(plain.bounds).of({n: e for n, e in plain.bounds.items() if n in NAMES})
    )
    pushed = friction._replace(level=(-friction.level[1], friction.level[1]))
    for problem, bounds in ((windy, friction), (plain, pushed)):
        with pytest.raises(Refused, match="lose more speed in a sample than the windows overlap, or gain"):
            loop_in(problem, law, friction=bounds)


def test_late_pulses_end_in_their_sample_and_noise_is_less_than_half_of_a_speed(plain):
    law = laws(plain)[0]
    friction = friction_of(plain, law, WINDOW)
    with pytest.raises(Refused, match="into the next sample"):
        loop_in(plain, law, friction=friction, conditions=EXACT._replace(delay=Fraction(3, 5)))
    with pytest.raises(Refused, match="more than half of a speed"):
        loop_in(plain, law, friction=friction, conditions=EXACT._replace(noise=Fraction(5)))
