"""The way in: enclosed, accepted, compared with simulated stops, and refused where it would be false."""

import json
from dataclasses import replace
from fractions import Fraction
from itertools import islice

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.forging import Q
from wspd_design.certificates import suite
from wspd_design.certificates.checks.region import slip_way_in
from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.slip_band import way_in as search
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.slip_band import (
    approach,
    arrival,
    computed_law,
    followed_law,
    followed_plant,
    motion,
)
from wspd_design.certificates.theorems.slip_band.way_in import (
    FRICTION,
    NEAR,
    SUPPLY,
    TILTING,
    Piece,
    Row,
    Strip,
    _boxes,
    around,
    checker,
    followed,
    supply_rises,
    tilt,
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
LEVEL = (0.0,) * len(TILTING)  # slopes of strips whose supply rate goes with nothing


@pytest.fixture(scope="module")
def low():
    """The rail on which wheels slide first; the range of the supply rate is a narrow one, for speed."""
    problem = problem_of(1.0, rail=LOW)
    ends = {name: problem.span(name) for name in (FRICTION,)} | {SUPPLY: (0.75, 0.756)}
    return replace(problem, bounds=type(problem.bounds).of(ends))


@pytest.fixture(scope="module")
def piece(low):
    mu0 = low.nominal(FRICTION)
    alone = Piece(friction=(mu0, mu0), slopes=LEVEL, borders=(0.75, 0.756), samples=(1,))
    return replace(alone, samples=search._samples(low, low.controller, alone, 0.3))


@pytest.fixture(scope="module")
def numbers(low, piece):
    return followed(low, low.controller, [Strip(piece, 0)])


def sloping(**slopes):
    """Slopes over these numbers, and none over others."""
    return tuple(slopes.get(name.replace(" ", "_"), 0.0) for name in TILTING)


def rows(*pieces, supply=(0.75, 0.756)):
    return [Row(supply=supply, pieces=pieces)]


NONE = Fraction(0)


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
    course = approach.follow(
        low.controller, low.vehicle, low.rail, _boxes(low, [Strip(piece, 0)]), low.speeds[1]
    )
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


SHORT = 20  # samples, after which no wheel slides yet


def test_proof_is_accepted_and_told(low, piece):
    proof = write(rows(replace(piece, samples=(SHORT,))), NONE)
    found = checker(low, low.controller)(json.loads(json.dumps(proof)), Work(PLENTY))
    assert found["friction low"] == found["friction high"] == low.nominal(FRICTION)


@pytest.fixture(scope="module")
def stop():
    """The whole stop at the nominal friction, down to a speed above which there are few windows."""
    problem = problem_of(1.0, rail=LOW)
    ends = {name: problem.span(name) for name in NEAR} | {SUPPLY: (0.75, 0.756)}
    nominal = replace(problem, bounds=type(problem.bounds).of(ends), speeds=(80.0 / 3.6, problem.speeds[1]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(slip_way_in, "IN_CELLS", ())
        patch.setattr(search, "HALVES", (0.02,))
        patch.setattr(search, "ROWS", 1)
        (found,) = suite.verify(nominal, only=["slip_way_in"], figures=False)
    return nominal, found


def test_whole_stop_is_shown(stop):
    nominal, found = stop
    assert found.status is Status.PROVED
    assert "never above 0.1" in found.explanation
    assert "down to 80 km/h: The slip stays within" in found.explanation
    assert "stays in a band around it down to 80 km/h" in found.claim
    numbers = found.findings[STRIPS].numbers
    assert numbers["band 0 below"] < 0.002
    assert numbers["time"] < 4.5
    assert replay(nominal, certificate_text(found)).accepted


def test_verdict_says_how_far_other_numbers_lie_from_their_nominal_values(stop):
    _, found = stop
    assert found.findings[STRIPS].numbers["share"] == 1.0 / 16.0
    words = "each of mass, wheelset inertia, wheel radius, max torque, fill time and vent time no farther from its "
    words += "nominal value than 6.25 % of the way to either end of its range, and all other numbers"
    assert words in found.claim
    assert words in found.assumptions[0]
    within = {each.name: (each.low, each.high) for each in found.domain.varied}
    assert within.keys() == {SUPPLY, *NEAR}
    assert within["fill time"] == pytest.approx((0.58125, 0.61875))
    assert within["wheel radius"] == pytest.approx((0.5475, 0.55))
    assert found.varied == (SUPPLY,)  # over all of its range
    assert {*NEAR} <= {*found.held}


def test_end_before_the_filters_have_settled_is_refused(stop):
    nominal, found = stop
    proof = json.loads(json.dumps(found.findings[STRIPS].stated.proof))
    alone = proof["rows"][0]["pieces"][0]
    alone["samples"] = [150] * len(alone["samples"])
    assert "not in the ellipsoid" in refused(nominal, proof)


def test_forged_band_is_refused(stop):
    nominal, found = stop
    proof = json.loads(json.dumps(found.findings[STRIPS].stated.proof))
    alone = proof["rows"][0]["pieces"][0]
    alone["samples"] = [2] * len(alone["samples"])
    each = proof["band"]["ellipsoids"][-1]
    each[Q] = [repr(0.01 * float(number)) for number in each[Q]]
    assert "a sample may lead out of an ellipsoid" in refused(nominal, proof)


def test_supply_that_lags_behind_the_train_is_refused(stop):
    nominal, found = stop
    band = found.findings[STRIPS].stated.proof["band"]
    supply_rises(around(nominal), band, 0.7, 32.0)
    slow = around(replace(nominal, bounds=type(nominal.bounds).of({SUPPLY: (0.001, 0.002)})))
    with pytest.raises(Refused, match="the supply may have"):
        supply_rises(slow, band, 0.1, 32.0)


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
    whole = dict(zip(("friction low", "friction high"), low.span(FRICTION), strict=True)) | {"share": 0.02}
    assert told(low, numbers | whole).status is Status.PROVED
    part = told(low, numbers | whole | {"friction low": 0.08, "friction high": 0.08})
    assert part.status is Status.UNDECIDED
    assert part.explanation.startswith("Shown for mu0 = 0.08 alone.")
    assert part.margin is None
    early = told(low, numbers | whole | {"below": 0.05})
    assert early.status is Status.UNDECIDED
    assert "not come to its reference" in early.explanation


def test_gaps_are_refused(low, piece):
    narrow = write(rows(replace(piece, borders=(0.751, 0.756))), NONE)
    assert "do not cover" in refused(low, narrow)
    tilted = write(rows(replace(piece, friction=(0.079, 0.081), slopes=sloping(mu0=1.0))), NONE)
    assert "do not cover" in refused(low, tilted)
    apart = write(rows(replace(piece, friction=(0.06, 0.07)), replace(piece, friction=(0.0701, 0.1))), NONE)
    assert "do not follow" in refused(low, apart)
    falling = write(rows(replace(piece, borders=(0.756, 0.75))), NONE)
    assert "do not rise" in refused(low, falling)
    reversed_row = write(rows(piece, supply=(0.756, 0.75)), NONE)
    assert "of a row do not rise" in refused(low, reversed_row)
    no_band = write(rows(replace(piece, samples=(2,))), NONE) | {"band": []}
    assert "no object" in refused(low, no_band)
    part = write(rows(piece, supply=(0.75, 0.755)), NONE)
    assert "rows do not cover" in refused(low, part)
    gap = write([*rows(piece, supply=(0.75, 0.752)), *rows(piece, supply=(0.753, 0.756))], NONE)
    assert "rows of the supply rate do not follow" in refused(low, gap)


def test_strips_that_follow_a_number_have_to_reach_further(low, piece):
    """Heavy vehicles slide later: along a strip the supply rises faster with them."""
    masses = problem_of(1.0, rail=LOW).span("mass")
    near = replace(low, bounds=type(low.bounds).of({**dict(low.bounds.entries), "mass": masses}))
    share = Fraction(1, 100)
    shift = 1e-6 * 0.01 * 0.5 * (masses[1] - masses[0])
    following = replace(piece, slopes=sloping(mass=1e-6), samples=(2,))
    assert "do not cover" in refused(near, write(rows(following), share))
    for low_end, high_end in ((0.999, 1.001), (1.001, 0.999)):
        borders = (0.75 - low_end * shift, 0.756 + high_end * shift)
        assert "do not cover" in refused(near, write(rows(replace(following, borders=borders)), share))
    enough = replace(following, borders=(0.75 - 1.001 * shift, 0.756 + 1.001 * shift))
    checker(near, near.controller)(write(rows(enough), share), Work(PLENTY))
    assert "needs 7 slopes" in refused(near, write(rows(replace(piece, slopes=(0.0,))), share))


def test_only_the_friction_of_all_rows_counts(low, piece):
    one = replace(piece, friction=(0.0795, 0.0805), borders=(0.749, 0.757), samples=(2,))
    other = replace(piece, friction=(0.08, 0.081), borders=(0.749, 0.757), samples=(2,))
    both = write([*rows(one, supply=(0.75, 0.753)), *rows(other, supply=(0.753, 0.756))], NONE)
    found = checker(low, low.controller)(both, Work(PLENTY))
    assert (found["friction low"], found["friction high"]) == (0.08, 0.0805)


def test_too_wide_a_strip_is_lost(low, piece):
    wide = replace(piece, friction=(0.06, 0.1), borders=(0.7, 0.8))
    assert "lost" in refused(low, write(rows(wide), NONE))


def test_end_before_the_reference_does_not_count_as_there(low, piece):
    early = followed(low, low.controller, [Strip(replace(piece, samples=(30,)), 0)])
    assert early["below"] > 0.05


@pytest.fixture(scope="module")
def slow():
    """A slow supply and the best friction, with all numbers in their ranges; and a strip that follows the friction."""
    problem = problem_of(1.0, rail=LOW)
    middle, supply = 0.097, (0.378, 0.38)
    friction = (0.97 * middle, 1.03 * middle)
    ends = {name: problem.span(name) for name in NEAR} | {FRICTION: friction, SUPPLY: supply}
    problem = replace(problem, bounds=type(problem.bounds).of(ends))
    powers = search._powers(problem, problem.controller, middle, supply)
    by_friction = dict.fromkeys(TILTING, 0.0) | {FRICTION: powers[FRICTION]}
    alone = search._whole(problem, friction, supply, by_friction)
    shift = tilt(problem, alone) + 1e-6
    alone = replace(alone, borders=(supply[0] - shift, supply[1] + shift))
    return problem, replace(alone, samples=(120,))


def test_a_larger_share_than_strips_bear_is_refused(slow):
    """A checker that ignores the share accepts both, and this test fails."""
    problem, wide = slow
    rows_of = rows(wide, supply=problem.span(SUPPLY))
    found = checker(problem, problem.controller)(write(rows_of, Fraction(1, 200)), Work(PLENTY))
    assert found["share"] == 1 / 200
    assert "lost" in refused(problem, write(rows_of, Fraction(1, 16)))
    assert "between 0 and 1/2" in refused(problem, write(rows_of, Fraction(6, 10)))
    assert "between 0 and 1/2" in refused(problem, write(rows_of, Fraction(-1, 100)))


def enclosed(problem, strip, samples):
    """Ends of slip and torque at the samples of a strip."""
    course = approach.follow(
        problem.controller, problem.vehicle, problem.rail, _boxes(problem, [strip]), problem.speeds[1]
    )
    found = []
    for _, state, _ in islice(course, samples):
        slip = state.sliding / state.speed
        found.append((slip.low[0], slip.high[0]))
    return np.array(found)


def test_stops_with_numbers_at_the_ends_of_the_share_are_enclosed(slow):
    """In the box of the share, and not in that of the nominal numbers."""
    problem, wide = slow
    near, law = around(problem, Fraction(1, 50)), problem.controller
    mu0, supply = wide.middle, 0.379
    narrow = Strip(Piece(friction=(mu0, mu0), slopes=LEVEL, borders=(0.3789, 0.3791), samples=(190,)), 0)
    box, bare = (enclosed(each, narrow, 190) for each in (near, around(problem, NONE)))
    outside = 0
    for side in (0, 1):
        numbers = {name: near.span(name)[side if k % 2 else 1 - side] for k, name in enumerate(NEAR)}
        vehicle, rail = plant_with(problem, numbers | {FRICTION: mu0})
        vehicle = replace(vehicle, brake=replace(vehicle.brake, supply_rate=supply))
        run = simulate(vehicle, law, Scenario(rail=rail, initial_speed=near.speeds[1]), plant="quarter")
        slips = np.interp([law.sample_time * (k + 1) for k in range(190)], run.time, run.slip[:, 0])
        assert np.all((box[:, 0] - 2e-5 <= slips) & (slips <= box[:, 1] + 2e-5))
        outside += np.count_nonzero((bare[:, 0] - 2e-5 > slips) | (slips > bare[:, 1] + 2e-5))
    assert outside > 100


def test_stops_whose_supply_goes_with_the_other_numbers_are_enclosed(slow):
    """Numbers at the ends of the share that let wheels slide later, and the faster supply of the strip there."""
    problem, wide = slow
    near, law, mu0, samples = around(problem, Fraction(1, 50)), problem.controller, wide.middle, 150
    powers = search._powers(problem, law, mu0, (0.3789, 0.3791))
    whole = search._whole(problem, (mu0, mu0), (0.3789, 0.3791), powers)
    boxes = _boxes(near, [Strip(whole, 0)])
    course = approach.follow(law, near.vehicle, near.rail, boxes, near.speeds[1])
    found = [(state.sliding / state.speed, state.supply) for _, state, _ in islice(course, samples)]
    level = enclosed(near, Strip(replace(whole, slopes=LEVEL), 0), samples)
    assert (found[-1][0].high - found[-1][0].low)[0] < 0.5 * np.diff(level[-1])[0]
    later = {name: near.span(name)[int(powers[name] > 0.0)] for name in NEAR}
    supply = 0.379 + tilt(near, whole)
    vehicle, rail = plant_with(problem, later | {FRICTION: mu0})
    vehicle = replace(vehicle, brake=replace(vehicle.brake, supply_rate=supply))
    run = simulate(vehicle, law, Scenario(rail=rail, initial_speed=near.speeds[1]), plant="quarter")
    times = law.sample_time * np.arange(1, samples + 1)
    slips, supplied = np.interp(times, run.time, run.slip[:, 0]), -np.expm1(-supply * times)
    for (slip, share), there, pressure in zip(found, slips, supplied, strict=True):
        assert slip.low[0] - 2e-5 <= there <= slip.high[0] + 2e-5
        assert share.low[0] - 1e-9 <= pressure <= share.high[0] + 1e-9
    assert supply > 1.01 * 0.3791  # out of a strip whose supply follows nothing


def test_another_law_is_noticed(low, monkeypatch):
    assert computed_law.unlike(low, low.controller) == ""
    original = followed_law._pull
    monkeypatch.setattr(followed_law, "_pull", lambda error, rate, slew: original(error, rate, 1.001 * slew))
    assert "computes another" in computed_law.unlike(low, low.controller)
    alone = Piece(friction=(0.08, 0.08), slopes=LEVEL, borders=(0.75, 0.756), samples=(5,))
    proof = write(rows(alone), NONE)
    assert "computes another" in refused(low, proof)


def test_laws_that_are_not_followed(low):
    law = low.controller

    def reason(changed):
        return SLIP_WAY_IN.speaks_about(replace(low, controller=changed))

    assert reason(law) == ""
    assert "constant" in reason(replace(law, pressure_sensors=False))
    falling = FallingSlip(slip=0.16, largest=0.35)
    assert "holds no constant slip" in reason(replace(law, reference=falling))


def test_scale_of_the_train_speed_counts(low):
    """Worn wheels: the law takes the scale of its speed from them while they roll."""
    worn = replace(low, bounds=type(low.bounds).of({"wheel radius": (0.53, 0.55)}))
    assert computed_law.unlike(worn, low.controller) == ""
    source = replace(low.controller.source, largest_scale_error=0.01)
    assert "scale" in computed_law.unlike(worn, replace(low.controller, source=source))


def test_a_change_that_is_not_in_proportion_is_noticed(low, monkeypatch):
    original = followed_law.went
    monkeypatch.setattr(followed_law, "went", lambda *given: original(*given) * 1.001)
    assert "computes another" in computed_law.unlike(low, low.controller)


@pytest.mark.parametrize("ends", [(-500.0, 800.0), (200.0, 800.0), (-800.0, -200.0)])
def test_ways_up_and_down_go_with_the_power_of_their_own_valve(ends):
    """In rooms so large that a pulse goes in proportion to its length."""
    low, high = ends
    way = Affine(np.array([0.5 * (low + high)]), np.array([[0.5 * (high - low)]]), np.zeros(1))
    room, filling, venting = (Affine(np.array([x]), np.zeros((1, 1)), np.zeros(1)) for x in (1e9, 1.2, 0.4))
    change = followed_law.went(way, (room, room), (filling, venting), (18.0, 18.0), 0.0)
    for z in np.linspace(-1.0, 1.0, 21):
        asked = way.center[0] + z * way.slopes[0, 0]
        exact = (1.2 if asked > 0.0 else 0.4) * asked
        about = change.center[0] + z * change.slopes[0, 0]
        assert abs(exact - about) <= change.error[0]
    if low * high > 0.0:
        assert change.error[0] < 1e-3


# Around a way of none, around the longest way of filling, and between both.
TORQUES = [(22_000.0, 1_500.0), (21_300.0, 600.0), (21_700.0, 150.0)]


def a_sample(problem, torques, numbers, count):
    """What decide and motion make of a state with these torques, all else known, and of these numbers of the plant."""
    law, size = problem.controller, 64
    free = iter(range(24, size))

    def form(value, half=0.0, symbol=None):
        slopes = np.zeros((count, size))
        if symbol is not None:
            slopes[:, symbol] = half
        return Affine(np.broadcast_to(value, (count,)).astype(float), slopes, np.zeros(count))

    names = followed_plant.NUMBERS
    given = {name: form(value, half, names.index(name)) for name, (value, half) in numbers.items()}
    plant = followed_plant.plant_of(problem.vehicle, problem.rail, law.valve.brake.max_torque, given, 8)
    middle, half = torques
    state = followed_plant.State(
        *map(form, (32.0, 3.0, 0.0, 17_000.0)), form(middle, half, 16), *map(form, (-0.7, -0.0145, 0.42))
    )
    decided = followed_law.decide(law, plant, state, lambda each: each.named(next(free)))
    return decided, motion.motion(plant, law, state, decided, 23, lambda each: each.named(next(free)))


@pytest.mark.parametrize("torques", TORQUES)
def test_a_wide_state_encloses_its_points(low, torques):
    """Torques about that at which the valve neither fills nor vents, and valve times in a range."""
    rng, count = np.random.default_rng(5), 400
    halves = {"fill time": 0.02, "vent time": 0.02}
    names = {name: (low.nominal(name), halves.get(name, 0.0)) for name in followed_plant.NUMBERS}
    wide, moved = a_sample(low, torques, names, 1)
    (middle, half) = torques
    drawn = {name: (v + h * rng.uniform(-1, 1, count), 0.0) for name, (v, h) in names.items()}
    points, there = a_sample(low, (middle + half * rng.uniform(-1, 1, count), 0.0), drawn, count)
    assert wide.even[0]
    for one, other in ((wide, points), (moved, there)):
        for name in ("fill", "vent", "friction", "acceleration", "innovation", "speed", "sliding", "torque"):
            if hasattr(one, name):
                box, inside = getattr(one, name), getattr(other, name)
                slack = 1e-9 * (1.0 + np.abs(inside.center))
                assert np.all(inside.low >= box.low[0] - slack), name
                assert np.all(inside.high <= box.high[0] + slack), name
    assert np.all(there.top <= moved.top[0] + 1e-12)
