"""The way in: enclosed, accepted, compared with simulated stops, and refused where it would be false."""

import json
from dataclasses import replace

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.conftest import problem_of
from wspd_design.certificates import suite
from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.slip_band import way_in as search
from wspd_design.certificates.theorems.slip_band import (
    approach,
    arrival,
    computed_law,
    followed_law,
    followed_plant,
)
from wspd_design.certificates.theorems.slip_band.way_in import (
    FRICTION,
    SUPPLY,
    Piece,
    _supply_rises,
    around,
    checker,
    followed,
    write,
)
from wspd_design.certificates.theorems.way_in import SLIP_WAY_IN, STRIPS
from wspd_design.controllers.references import FallingSlip
from wspd_design.model.slip import slip_dynamics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

pytestmark = pytest.mark.slow
PLENTY = 10**9
LOW = wd.load_rail("low-adhesion")


@pytest.fixture(scope="module")
def low():
    """The rail on which wheels slide first; the range of the supply rate is a narrow one, for speed."""
    problem = problem_of(1.0, rail=LOW)
    ends = {name: problem.span(name) for name in (FRICTION,)} | {SUPPLY: (0.75, 0.756)}
    return replace(problem, bounds=type(problem.bounds).of(ends))


@pytest.fixture(scope="module")
def piece(low):
    mu0 = low.nominal(FRICTION)
    alone = Piece(friction=(mu0, mu0), slope=0.0, borders=(0.75, 0.756), samples=(1,))
    return replace(alone, samples=search._samples(low, low.controller, alone, 0.3))


@pytest.fixture(scope="module")
def numbers(low, piece):
    return followed(low, low.controller, [piece])


def refused(problem, proof):
    with pytest.raises(Refused) as reason:
        checker(problem, problem.controller)(proof, Work(PLENTY))
    return str(reason.value)


def test_no_wheel_goes_beyond_the_reference(low, numbers):
    assert numbers["largest slip"] < low.slip + 0.001
    assert 0.0 <= numbers["below"] < 0.002
    assert 0.5 < numbers["supply"] < 1.0


def test_simulated_stops_are_enclosed(low, piece, numbers):
    """Stops of the engine with supply rates in the strip, at the samples and in between."""
    course = approach.follow(low.controller, low.vehicle, low.rail, _boxes(low, piece), low.speeds[1])
    enclosed = []
    for (top, state, _), _ in zip(course, range(piece.samples[0]), strict=False):
        slip = state.sliding / state.speed
        enclosed.append((slip.low[0], slip.high[0], state.torque.low[0], state.torque.high[0], top[0]))
    for supply in (0.75, 0.753, 0.756):
        vehicle = replace(low.vehicle, brake=replace(low.vehicle.brake, supply_rate=supply))
        run = simulate(
            vehicle, low.controller, Scenario(rail=low.rail, initial_speed=low.speeds[1]), plant="quarter"
        )
        slips = np.interp([low.sample_time * (k + 1) for k in range(len(enclosed))], run.time, run.slip[:, 0])
        for slip, (least, most, *_) in zip(slips, enclosed, strict=True):
            assert least - 2e-5 <= slip <= most + 2e-5  # traces are interpolated
        before_end = run.time <= low.sample_time * len(enclosed)
        assert run.slip[before_end].max() <= numbers["largest slip"]


def _boxes(problem, *pieces):
    from wspd_design.certificates.theorems.slip_band.way_in import _boxes

    return _boxes(problem, [(each, 0) for each in pieces])


SHORT = 20  # samples, after which no wheel slides yet


def test_proof_is_accepted_and_told(low, piece):
    proof = write([replace(piece, samples=(SHORT,))])
    found = checker(low, low.controller)(json.loads(json.dumps(proof)), Work(PLENTY))
    assert found["friction low"] == found["friction high"] == low.nominal(FRICTION)


@pytest.fixture(scope="module")
def stop(low):
    """The whole stop at the nominal friction, down to a speed above which there are few windows."""
    nominal = replace(
        low, bounds=type(low.bounds).of({SUPPLY: (0.75, 0.756)}), speeds=(40.0 / 3.6, low.speeds[1])
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(search, "WIDTHS", ((0.01, 0.01),))
        patch.setattr(search, "_corners_hold", lambda *_: True)
        (found,) = suite.verify(nominal, only=["slip_way_in"], figures=False)
    return nominal, found


def test_whole_stop_is_shown(stop):
    nominal, found = stop
    assert found.status is Status.PROVED
    assert "never above 0.1" in found.explanation
    assert "down to 40 km/h: The slip stays within" in found.explanation
    assert "stays in a band around it down to 40 km/h" in found.claim
    numbers = found.findings[STRIPS].numbers
    assert numbers["band 0 below"] < 0.002
    assert replay(nominal, certificate_text(found)).accepted


def test_end_before_the_filters_have_settled_is_refused(stop):
    nominal, found = stop
    proof = json.loads(json.dumps(found.findings[STRIPS].stated.proof))
    proof["pieces"][0]["samples"] = [count - 45 for count in proof["pieces"][0]["samples"]]
    assert "not in the ellipsoid" in refused(nominal, proof)


def test_forged_band_is_refused(stop):
    nominal, found = stop
    proof = json.loads(json.dumps(found.findings[STRIPS].stated.proof))
    proof["pieces"][0]["samples"] = [2]
    each = proof["band"]["ellipsoids"][-1]
    each[6:21] = [repr(0.01 * float(number)) for number in each[6:21]]
    assert "may" in refused(nominal, proof)


def test_supply_that_lags_behind_the_train_is_refused(stop):
    nominal, found = stop
    band = found.findings[STRIPS].stated.proof["band"]
    _supply_rises(around(nominal), band, 0.7, 32.0)
    slow = around(replace(nominal, bounds=type(nominal.bounds).of({SUPPLY: (0.001, 0.002)})))
    with pytest.raises(Refused, match="the supply may have"):
        _supply_rises(slow, band, 0.1, 32.0)


@pytest.mark.parametrize("settled", [0.0, 0.04, -0.01])
def test_state_in_the_coordinates_of_the_band(low, settled):
    """Against the definitions of the band, written once more, at one state."""
    law, vehicle, rail = low.controller, low.vehicle, low.rail
    speed, sliding, innovation, friction, torque = 30.0, 4.0, 0.003, 7600.0, 7500.0
    acceleration, change = -0.7, -0.0145

    def form(value):
        return Affine(np.array([value]), np.zeros((1, 32)), np.zeros(1))

    numbers = {name: form(low.nominal(name)) for name in followed_plant.NUMBERS}
    plant = followed_plant.plant_of(vehicle, rail, law.valve.brake.max_torque, numbers, 16)
    state = followed_plant.State(
        *map(form, (speed, sliding, innovation, friction, torque, acceleration, change, 0.9))
    )
    found = arrival.in_band(law, plant, state, settled)
    radius, inertia, h = vehicle.wheel_radius, 2.0 * vehicle.wheel_inertia, law.sample_time
    away = 0.86 * speed / radius + settled  # rad/s, that errors are counted from
    here, there = (
        slip_dynamics(vehicle, rail, slip, speed) for slip in (sliding / speed, 1.0 - radius * away / speed)
    )
    rate = -0.86 * here.deceleration / radius
    damping = 2.0 * vehicle.wheel_damping * away
    t0 = (2.0 * radius * there.creep_force - damping - inertia * rate) / law.wheelset_inertia
    pole, wheel = np.exp(-law.observer_rate * h), (speed - sliding) / radius
    expected = wheel - innovation / radius
    observed = expected + (1.0 - pole**2) * (wheel - expected)
    learned = friction + law.wheelset_inertia / h * (1.0 - pole) ** 2 * (wheel - expected)
    new = -np.expm1(-h / law.source.acceleration_time)
    known = 0.86 / radius * (acceleration + new * (change / h - acceleration))
    wanted = (
        wheel - away,
        observed - wheel,
        h * (learned / law.wheelset_inertia - t0 - rate),
        h * (torque / law.wheelset_inertia - t0),
        h * (rate - known),
    )
    np.testing.assert_allclose([x.center[0] for x in found], wanted, rtol=1e-6, atol=1e-9)


def told(problem, numbers):
    """Verdict on what a checker may show."""
    finding = Finding(status=Status.PROVED, asked="strips", shown="strips", numbers=numbers)
    open_ones = {each.key: each.decide(Stated(), Work()) for each in SLIP_WAY_IN.obligations(problem)}
    return SLIP_WAY_IN.tell(problem, open_ones | {STRIPS: finding})


def test_verdict_says_what_was_shown(low, numbers):
    whole = dict(zip(("friction low", "friction high"), low.span(FRICTION), strict=True))
    assert told(low, numbers | whole).status is Status.PROVED
    part = told(low, numbers | {"friction low": 0.08, "friction high": 0.08})
    assert part.status is Status.UNDECIDED
    assert part.explanation.startswith("Shown for mu0 = 0.08 alone.")
    assert part.margin is None
    early = told(low, numbers | whole | {"below": 0.05})
    assert early.status is Status.UNDECIDED
    assert "not come to its reference" in early.explanation


def test_gaps_are_refused(low, piece):
    narrow = write([replace(piece, borders=(0.751, 0.756))])
    assert "do not cover" in refused(low, narrow)
    tilted = write([replace(piece, friction=(0.079, 0.081), slope=1.0)])
    assert "do not cover" in refused(low, tilted)
    apart = write([replace(piece, friction=(0.06, 0.07)), replace(piece, friction=(0.0701, 0.1))])
    assert "do not follow" in refused(low, apart)
    falling = write([replace(piece, borders=(0.756, 0.75))])
    assert "do not rise" in refused(low, falling)


def test_too_wide_a_strip_is_lost(low, piece):
    wide = replace(piece, friction=(0.06, 0.1), borders=(0.7, 0.8))
    assert "lost" in refused(low, write([wide]))


def test_end_before_the_reference_does_not_count_as_there(low, piece):
    early = followed(low, low.controller, [replace(piece, samples=(30,))])
    assert early["below"] > 0.05


def test_another_law_is_noticed(low, monkeypatch):
    assert computed_law.unlike(low, low.controller) == ""
    original = followed_law._pull
    monkeypatch.setattr(followed_law, "_pull", lambda error, rate, slew: original(error, rate, 1.001 * slew))
    assert "computes another" in computed_law.unlike(low, low.controller)
    proof = write([Piece(friction=(0.08, 0.08), slope=0.0, borders=(0.75, 0.756), samples=(5,))])
    assert "computes another" in refused(low, proof)


def test_laws_that_are_not_followed(low):
    law = low.controller

    def reason(changed):
        return SLIP_WAY_IN.speaks_about(replace(low, controller=changed))

    assert reason(law) == ""
    assert "constant" in reason(replace(law, pressure_sensors=False))
    falling = FallingSlip(slip=0.16, largest=0.35)
    assert "holds no constant slip" in reason(replace(law, reference=falling))
