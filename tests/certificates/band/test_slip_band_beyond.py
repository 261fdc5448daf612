"""Ways beyond the longest pulse, and errors on the braking curve: a share of what is asked is left of them."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from flint import arb

import wspd_design as wd
from tests.certificates.band.band_attack import SETTLED, boundary, follow, sets_of
from tests.certificates.band.conftest import certificate_of, problem_of, refused, told_of
from tests.certificates.band.courses import everywhere
from tests.certificates.band.forging import BACK, BEYOND, CURVE
from tests.certificates.band.sampled_runs import Law, supplied
from wspd_design.certificates.checks.region.slip_band import bounded_friction
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.search.slip_band.chain import Sought, Spent, begun, continued
from wspd_design.certificates.search.slip_band.search import exactly, proof_of
from wspd_design.certificates.setting.slip_loop import STATES
from wspd_design.certificates.theorems.band import CELLS, SLIP_BAND, contact_held
from wspd_design.certificates.theorems.slip_band.center import Lengths, about
from wspd_design.certificates.theorems.slip_band.checker import DIGITS
from wspd_design.certificates.theorems.slip_band.friction import FADINGS, SLOPES, Friction
from wspd_design.certificates.theorems.slip_band.loop import Conditions, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice, write
from wspd_design.certificates.theorems.slip_band.statement import box_of, law_of, windows_of
from wspd_design.controllers.observer_smc import approach
from wspd_design.model.generated.slip_loop import share_left

LOW = wd.load_rail("low-adhesion")
STARTS = 20_000
SHARE = Fraction(3, 8)  # of each range
FAST = 100.0 / 3.6, 120.0 / 3.6  # m/s, a window
ANY = Friction(((-0.2, 0.02),) * len(SLOPES), (0.86, 0.91), ((-0.3, 0.0),) * len(FADINGS))
EXACT = Conditions(supply=Fraction(63, 64), delay=Fraction(0), noise=Fraction(0))


@pytest.fixture(scope="module")
def resting():
    """Low adhesion, with valves that rest within 100 N m."""
    return problem_of(1.0, rail=LOW, speeds=FAST, dead_band=100.0)


@pytest.fixture(scope="module")
def proof(resting):
    """States that ask for twice what the longest pulse does, and have twice the error of the curve."""
    _, friction = bounded_friction(resting, SLIP_BAND.obligations(resting))
    law = law_of(resting.controller)
    sought = Sought(
        problem=contact_held(resting), law=law, friction=friction, conditions=exactly(resting, law)
    )
    cell = box_of(resting, SHARE)
    first = begun(sought, cell, Choice(Fraction(1), 0, beyond=Fraction(2), curve=Fraction(2)))
    return write(proof_of(sought, SHARE, ".", [continued(sought, cell, first, Spent()).ellipsoids[::-1]]))


def changed(proof, place, number):
    """The proof with another number in all ellipsoids."""
    found = json.loads(json.dumps(proof))
    for each in found["ellipsoids"]:
        each[place] = str(number)
    return found


# --- what is left, against the functions that leave it ----------------------------------------------------------------
@pytest.mark.parametrize("beyond", [1.2, 2.0, 6.0])
@pytest.mark.parametrize("own", [-0.7, 0.0, 0.6, 0.95])
def test_a_limit_leaves_no_less_of_what_is_asked_beside_the_center(beyond, own):
    asked = np.linspace(-3.0, beyond, 4001)
    asked = asked[np.abs(asked - own) > 1e-6]
    left = (np.minimum(asked, 1.0) - own) / (asked - own)
    assert left.max() == pytest.approx(1.0)
    assert left.min() == pytest.approx(share_left(1.0, beyond, own))
    assert share_left(1.0, beyond, own) < share_left(
        1.0, beyond, own - 0.1
    )  # less beside a center near the limit


@pytest.mark.parametrize("beyond", [1.2, 2.0, 6.0])
@pytest.mark.parametrize("own", [-0.7, 0.0, 0.6, 0.95])
def test_the_curve_of_the_law_leaves_no_less_of_the_pull(beyond, own):
    rate, slew = 8.0, 3.0
    begins = slew / rate**2
    errors = np.linspace(-3.0, beyond, 4001)
    errors = errors[np.abs(errors - own) > 1e-6]
    pulls = approach(begins * errors, rate, slew)
    left = (pulls / (rate * begins) - own) / (errors - own)
    assert left.max() == pytest.approx(1.0)
    assert left.min() == pytest.approx(share_left((2.0 * beyond - 1.0) ** 0.5, beyond, own))


# --- the proof --------------------------------------------------------------------------------------------------------
def test_states_that_ask_for_more_than_a_pulse_does_are_proved(resting, proof):
    told = told_of(resting, proof)
    assert 0.0005 < told["band 0 above"] < 0.002
    assert {(each[BEYOND], each[CURVE]) for each in proof["ellipsoids"]} == {("2.0", "2.0")}


def test_the_search_takes_such_states_where_no_others_are_left():
    """With the usual limits no ellipsoid is found; the search goes beyond them, and what it finds is proved."""
    part = problem_of(float(SHARE), rail=LOW, speeds=FAST, dead_band=100.0)
    found = certificate_of(part).findings[CELLS]
    assert found.numbers["share"] == 1.0
    assert any(Fraction(each[BEYOND]) > 1 for each in found.stated.proof["ellipsoids"])
    assert "what venting takes off" in refused(part, changed(found.stated.proof, BEYOND, 1))


@pytest.mark.slow
def test_starts_that_vent_all_of_a_sample_or_are_on_the_curve_stay(resting, proof):
    """Their commands are those of the law of the attack, whose valve and pull have such limits."""
    sets, law = sets_of(resting, proof, told_of(resting, proof)), Law(resting.controller, resting.slip)
    runs = boundary(resting, law, sets, np.random.default_rng(5), STARTS)
    seen = runs.torque * law.full / runs.plant.max_torque
    _, vent, _ = law.pulses(runs.memory, runs.measured, seen, law.full * supplied(runs))
    wanted, rate = law.desired(runs.memory)
    error = runs.measured - wanted
    error += law.tracking.ahead * law.h * ((runs.memory.friction - seen) / law.inertia - rate)
    for beyond in (vent >= law.h, error * law.tracking.approach_rate**2 > law.slew):
        assert np.sum(beyond) > 20
        chosen = runs.some(beyond)
        chosen = replace(chosen, number=np.arange(np.sum(beyond)))
        found = follow(law, sets, chosen, samples=SETTLED)
        assert found.entered.all()
        assert not found.left.any()


@pytest.mark.parametrize(
    ("place", "number", "reason"),
    [
        (BEYOND, 1, "what venting takes off in its longest pulse"),
        (CURVE, 1, "the beginning of the braking curve"),
        (CURVE, "1.05", "errors on the braking curve"),
        (BEYOND, 8, "a sample may lead out of an ellipsoid"),
        (CURVE, 20, "a sample may lead out of an ellipsoid"),
        (BEYOND, "0.9", "stated as 1 or more times its limit"),
        (CURVE, "0.9", "stated as 1 or more times its limit"),
        (BACK, "1/2", "pulses back are kept to shorter ones"),
    ],
)
def test_other_limits_than_those_of_the_states_are_refused(resting, proof, place, number, reason):
    assert reason in refused(resting, changed(proof, place, number))


@pytest.mark.parametrize("name", ["cut_to", "_on_curve"])
def test_a_checker_that_leaves_nothing_out_would_take_larger_limits(resting, proof, name, monkeypatch):
    """What is refused above is refused for what the limits leave: without it the same proof would be taken."""
    whole = {"cut_to": lambda ways, _: ways, "_on_curve": lambda _, loop, __: loop}
    monkeypatch.setattr(f"wspd_design.certificates.theorems.slip_band.center.{name}", whole[name])
    place, number = {"cut_to": (BEYOND, 8), "_on_curve": (CURVE, 20)}[name]
    assert told_of(resting, changed(proof, place, number))["share"] == SHARE


# --- what the checker does not speak about ----------------------------------------------------------------------------
def loop_for(problem, choice, **numbers):
    law = replace(law_of(problem.controller), **numbers)
    cell = box_of(problem, Fraction(1, 8))
    return law, loop_of(
        contact_held(problem), law, cell, windows_of(problem)[0], everywhere(ANY), choice, EXACT
    )


def states(**numbers):
    return [arb(numbers.get(name, 0.0)) for name in ("error", "observer", "friction", "torque", "lag")]


@pytest.fixture(autouse=True)
def digits():
    from flint import ctx

    with ctx.workprec(DIGITS):
        yield


def test_more_than_a_shorter_pulse_does_is_not_asked_for(resting):
    """Only a pulse of the whole sample is what the valve has no more than."""
    with pytest.raises(Refused, match="which is shorter than the sample"):
        loop_for(resting, Choice(Fraction(3, 4), 0, beyond=Fraction(2)))


def test_a_law_without_a_braking_curve_has_no_errors_on_it(resting):
    choice = Choice(Fraction(1), 0, curve=Fraction(2))
    with pytest.raises(Refused, match="has no braking curve"):
        loop_for(resting, choice, torque_slew=None)


def test_limits_are_counted_from_a_center_below_them(resting):
    lengths = Lengths(Fraction(0), Fraction(1), Fraction(1))
    law, loop = loop_for(resting, Choice(Fraction(1), 0, curve=Fraction(2)))
    begins = float((loop.curve.error).mid())
    about(law, loop, states(error=0.9 * begins), lengths)
    with pytest.raises(Refused, match="center is on the braking curve"):
        about(law, loop, states(error=1.1 * begins), lengths)
    law, loop = loop_for(resting, Choice(Fraction(1), 0, beyond=Fraction(2)))
    with pytest.raises(Refused, match="may have either sign"):
        about(law, loop, states(), lengths)


def test_all_that_is_asked_is_left_within_the_limits(resting):
    """Limits of once themselves are those of a loop that knows none beyond."""
    law, loop = loop_for(resting, Choice(Fraction(1), 0))
    there = about(law, loop, states(error=0.001), Lengths(Fraction(0), Fraction(1, 2), Fraction(1)))
    assert loop.ranges.pulls == there.ranges.pulls == (1.0,)
    assert len(loop.wants) == 1
    assert len(loop.limits[0].row) == STATES
