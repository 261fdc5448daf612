"""The lag of the filtered acceleration goes with the steady drift: what is left beside it, and what a forgery says."""

import json
import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import ctx

import wspd_design as wd
from tests.certificates.band.conftest import SLOW, problem_of, refused, told_of
from tests.certificates.band.courses import (
    EXACT,
    WINDOW,
    Course,
    doubles,
    everywhere,
    falling_problem,
    friction_at,
    left_beside,
    within,
)
from wspd_design.certificates.checks.region.slip_band import bounded_friction
from wspd_design.certificates.kernel.arb import above, ball, below, ends_of, point
from wspd_design.certificates.search.slip_band import task
from wspd_design.certificates.search.slip_band.chain import FIRST, Sought, Spent, begun, continued
from wspd_design.certificates.search.slip_band.search import exactly, proof_of
from wspd_design.certificates.setting.creep_slope import fading_beside
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, REFERENCE_DRIFT
from wspd_design.certificates.theorems.band import SLIP_BAND, contact_held
from wspd_design.certificates.theorems.slip_band import checker, loop
from wspd_design.certificates.theorems.slip_band.checker import drifting
from wspd_design.certificates.theorems.slip_band.lag import Fading, lag_of
from wspd_design.certificates.theorems.slip_band.loop import loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice, write
from wspd_design.certificates.theorems.slip_band.statement import NAMES, box_of, law_of
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import constants

EURO = wd.load_rail("eurosprinter127")
LAG = -4
REFERENCE, LAG_DRIFT = (DISTURBANCES.index(each) for each in (REFERENCE_DRIFT, "lag drift"))
SHARES = Fraction(0), Fraction(1, 2), Fraction(1)
RESISTED, DAMPED, LOSS = 0.004, 0.02, 1e-3


def fading(along, beside, width=0.0):
    """What fades, all of it known but the force, which is known within a width."""
    force = ball(Fraction(along - width), Fraction(along + width))
    return Fading(
        pulled=point(3.0),
        weight=point(14.0),
        along=force,
        at_reference=force + point(beside),
        beside=point(beside),
        damping=point(DAMPED),
        resistance=point(RESISTED),
    )


@pytest.mark.parametrize("share", SHARES)
@pytest.mark.parametrize("beside", [-0.004, 0.003])
def test_known_numbers_leave_what_the_jerk_differs_by(share, beside):
    """With all numbers known the ends are those of the jerk, worked out from lag and drift themselves."""
    with ctx.workprec(128):
        turned = 1.6
        k, left = lag_of(fading(-0.03, beside), share, point(turned), point(LOSS), point(0))
        steady = -LOSS * (14.0 * 3.0 * -0.03 - DAMPED)
        lags = [LOSS * j * turned * (3.0 * (-0.03 + beside) + RESISTED) for j in (0.75, 1.25)]
        expected = sorted(each - float(k.mid()) * steady for each in lags)
        assert float(k.mid()) == pytest.approx(-float(share) * turned / 14.0)
        assert (below(left), above(left)) == pytest.approx(expected, rel=1e-9)


def test_drift_counts_until_later_in_the_sample():
    """It is taken off as at the beginning, and has changed by as much as all of its change when the sample ends."""
    with ctx.workprec(128):
        still, changing = (
            lag_of(fading(-0.03, 0.0), Fraction(1), point(1.6), point(LOSS), point(each))
            for each in (0.0, 1e-5)
        )
        k = float(changing[0].mid())
        assert below(changing[1]) == pytest.approx(below(still[1]) + k * 1e-5, rel=1e-9)
        assert above(changing[1]) == pytest.approx(above(still[1]), rel=1e-9)


def test_what_goes_with_the_drift_leaves_less_of_an_uncertain_force():
    with ctx.workprec(128):
        widths = [
            float(lag_of(fading(-0.03, 1e-4, 0.01), share, point(1.6), point(LOSS), point(0))[1].rad())
            for share in SHARES
        ]
    assert widths[2] < widths[1] < widths[0]
    assert widths[2] < 0.6 * widths[0]


def parts_of(problem, window, share=0.0):
    """The problem in a window, with a share of its ranges about the nominal numbers."""
    ends = {}
    for name in NAMES:
        (low, high), middle = problem.span(name), problem.nominal(name)
        ends[name] = middle + share * (low - middle), middle + share * (high - middle)
    return replace(problem, speeds=window, bounds=Bounds.of(dict(problem.bounds.items()) | ends))


@pytest.mark.parametrize("less", [-0.02, 0.02, 0.04])
def test_more_fading_along_the_reference_is_enclosed(less):
    """Against differences of the force; what another speed beside the reference gives lies outside."""
    problem = parts_of(falling_problem(EURO, 0.0), (8.0, 8.05))
    course, slip, d = Course(problem, None, None), 0.14, 1e-4

    def along(speed, less):
        sides = (course.force(v, slip - less / v) for v in (speed + d, speed - d))
        weight = problem.nominal("mass") * 9.80665 / 8.0 * problem.rail.mu0
        return float(np.subtract(*sides)) / (2.0 * d) / weight

    low, high = fading_beside(problem, slip, (less, less))
    for speed in (8.0, 8.02, 8.05):
        assert low < along(speed, 0.0) - along(speed, less) < high
        assert not low < along(speed, 0.0) - along(speed, 2.0 * less) < high
    assert not low < 0.0 < high


@pytest.mark.parametrize("settled", [0.0, 0.05])
@pytest.mark.parametrize("share", SHARES)
def test_lag_of_a_train_lies_beside_its_share_of_the_drift(settled, share):
    """A train whose wheels are at the reference, its deceleration rising 3/4 to 5/4 times as fast."""
    problem = falling_problem(EURO, 0.0)
    law = replace(law_of(problem.controller), falls=False, slip=Fraction(7, 50))
    course, kept = (
        Course(problem, law, lambda *_: 0.14),
        math.exp(-float(law.sample_time / law.acceleration_time)),
    )
    with ctx.workprec(128):
        cell = tuple((Fraction(problem.nominal(name)),) * 2 for name in NAMES)
        friction = friction_at(problem, WINDOW, (0.14 - 4e-3, 0.14 + 1e-3))
        choice = Choice(Fraction(1, 2), 0, Fraction(settled), lag=share)
        found = loop_of(problem, law, cell, WINDOW, everywhere(friction), choice, EXACT)
    h, d, speed = float(law.sample_time), 1e-3, 8.049
    falls = (course.holding(speed + d, 0.14, settled) - course.holding(speed - d, 0.14, settled)) / (2.0 * d)
    steady = -h * h * falls * course.braking(speed, 0.14) / problem.vehicle.wheelset_inertia
    before, after = course.lags(speed, 1)
    moved, (_, turned, _) = after - kept * before, course.numbers(speed)
    for j, place in product((0.75, 1.0, 1.25), (REFERENCE, LAG_DRIFT)):
        left = left_beside(found, {REFERENCE: j * turned, LAG_DRIFT: j * moved}, steady)
        assert within(left[place], doubles(found.disturbances[place])), place
    low, high = doubles(found.disturbances[REFERENCE])
    assert high - low < 0.75 * abs(turned)
    assert bool(within(turned, (low, high))) is (share == 0)


def test_loop_tells_what_fades(monkeypatch):
    """Numbers that move the lag little, against the train's own."""
    problem, seen = falling_problem(EURO, 0.0), []
    law = replace(law_of(problem.controller), falls=False, slip=Fraction(7, 50))
    monkeypatch.setattr(loop, "lag_of", lambda *given: seen.append(given) or lag_of(*given))
    with ctx.workprec(128):
        cell = tuple((Fraction(problem.nominal(name)),) * 2 for name in NAMES)
        friction = friction_at(problem, WINDOW, (0.14 - 4e-3, 0.14 + 1e-3))
        choice = Choice(Fraction(1, 2), 0, Fraction(0.05), lag=Fraction(1))
        found = loop.loop_of(problem, law, cell, WINDOW, everywhere(friction), choice, EXACT)
        ((fades, _, _, _, change),) = seen
        ends = [[float(end.mid()) for end in each] for each in (found.steady.change, ends_of(change))]
    vehicle, fast = problem.vehicle, WINDOW[1]
    assert ends[0] == ends[1]
    resisted = (vehicle.resistance_linear + 2.0 * vehicle.resistance_quadratic * fast) / vehicle.mass
    assert above(fades.resistance) == pytest.approx(resisted, rel=1e-6)
    damped = 2.0 * vehicle.wheel_damping * 0.86 / vehicle.wheel_radius / vehicle.wheelset_inertia
    assert above(fades.damping) == pytest.approx(damped, rel=1e-6)
    # Along the reference the friction fades as it does, by no more than the slip times the bound of the window.
    low, high = (0.14 * each for each in friction.fadings[0])
    course = Course(problem, law, None)
    weight = problem.nominal("mass") * constants().gravity / 8.0 * problem.rail.mu0
    seen = [
        (course.force(v + 1e-4, 0.14) - course.force(v - 1e-4, 0.14)) / 2e-4 / weight for v in (*WINDOW, 8.02)
    ]
    assert low < below(fades.at_reference) < min(seen)
    assert max(seen) < above(fades.at_reference) < high


@pytest.fixture(scope="module")
def euro():
    """A sixteenth of each range in two windows."""
    return replace(problem_of(0.0625, rail=EURO), speeds=SLOW)


@pytest.fixture(scope="module")
def sought(euro):
    _, friction = bounded_friction(euro, SLIP_BAND.obligations(euro))
    law = law_of(euro.controller)
    return Sought(problem=contact_held(euro), law=law, friction=friction, conditions=exactly(euro, law))


def followed_in(sought):
    """A proof in which the lag goes with the drift in all windows, as JSON."""
    cell = box_of(sought.problem, Fraction(1))
    found = continued(sought, cell, begun(sought, cell, FIRST._replace(lag=Fraction(1))), Spent())
    assert len(found.ellipsoids) == len(sought.windows)
    return json.loads(json.dumps(write(proof_of(sought, Fraction(1), ".", (found.ellipsoids[::-1],)))))


@pytest.fixture(scope="module")
def followed(sought):
    return followed_in(sought)


@pytest.mark.slow
def test_checker_accepts_a_lag_that_goes_with_the_drift(euro, followed):
    assert [float(each[LAG]) for each in followed["ellipsoids"]] == [1.0, 1.0]
    assert told_of(euro, followed)["cells"] == 1


@pytest.mark.slow
@pytest.mark.parametrize("said", ["0", "0.5", "1.5"])
@pytest.mark.parametrize("window", [0, 1])
def test_another_share_of_the_lag_than_the_center_moves_with_is_refused(euro, followed, said, window):
    forged = json.loads(json.dumps(followed))
    forged["ellipsoids"][window][LAG] = said
    assert "may lead out of an ellipsoid" in refused(euro, forged)


def left_out(steady):
    """The fault itself: what goes with the drift is taken off what disturbs, and does not come with the drift."""
    return drifting(steady._replace(lag=point(0)))


@pytest.mark.slow
def test_lag_that_neither_disturbs_nor_goes_with_the_drift_is_refused(euro, sought, monkeypatch):
    with monkeypatch.context() as patch:
        for module in (checker, task):
            patch.setattr(module, "drifting", left_out)
        proof = followed_in(sought)
        assert told_of(euro, proof)["cells"] == 1
    assert "may lead out of an ellipsoid" in refused(euro, proof)
