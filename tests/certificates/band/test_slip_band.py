"""The band of slip on half of the box: proved, accepted, and refused where it would be false."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest
from flint import ctx

import wspd_design as wd
from tests.certificates.band.conftest import SLOW, certificate_of, everywhere, problem_of, refused, told_of
from wspd_design.certificates.checks.frame import accepted
from wspd_design.certificates.checks.region.slip_band import bounded_friction
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.slip_band.search import Sought, Spent, alone, cover, exactly
from wspd_design.certificates.setting.creep_slope import STEEPNESS
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES
from wspd_design.certificates.setting.written_protection import not_written
from wspd_design.certificates.theorems.band import CELLS, RESERVED, SLIP_BAND, contact_held, covered
from wspd_design.certificates.theorems.slip_band.checker import lies_in
from wspd_design.certificates.theorems.slip_band.friction import (
    FADINGS,
    NAMES,
    PARTS,
    REACHES,
    SLOPES,
    Friction,
)
from wspd_design.certificates.theorems.slip_band.loop import Conditions, Steady, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice, Ellipsoid, Proof, read, write
from wspd_design.certificates.theorems.slip_band.statement import box_of, law_of, windows_of
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.valve_inversion import ValveInversion

pytestmark = pytest.mark.slow


def test_band_of_half_of_the_box_is_proved_and_accepted(half, proved, document):
    assert proved.status is Status.PROVED
    assert len(proved.varied) == 11
    numbers = proved.findings[CELLS].numbers
    for side, slowest, fastest in (("above", 0.016, 0.001), ("below", 0.024, 0.002)):
        bands = [numbers[f"band {k} {side}"] for k in range(len(windows_of(half)))]
        assert bands == sorted(bands, reverse=True)
        assert bands[0] < slowest
        assert bands[-1] < fastest
    assert replay(half, json.dumps(document)).accepted


@pytest.fixture
def proof(document):
    return document["findings"][CELLS]["proof"]


def test_checker_alone_accepts_it(half, proof):
    assert told_of(half, proof)["cells"] >= 1


SUPPLY, NEAR, SETTLES, SHORTEST, LONGEST, BACK, ROOM, BEYOND, CURVE = range(1, 10)
Q, CENTER, DRIFT, MOVES, ALPHA, OFFSET, SHARES, INSIDE = slice(10, 25), 25, 30, slice(31, 36), 36, 37, 38, -1
STEADY, CHANGE = -3, -2  # shares of the steady drift and of its change
# Shares of what disturbs without noise, with a constant slip and without dead band
DRIFTS = tuple(
    SHARES + k for k, name in enumerate(DISTURBANCES) if name.endswith("drift") and name != "slip drift"
)


def test_ellipsoid_that_is_too_small_is_refused(half, proof):
    for window in range(len(windows_of(half))):
        forged = json.loads(json.dumps(proof))
        each = forged["ellipsoids"][window]
        each[Q] = [repr(0.25 * float(number)) for number in each[Q]]
        assert "may lead out of an ellipsoid" in refused(half, forged)


def test_ellipsoid_that_is_too_large_is_refused(half, proof):
    each = proof["ellipsoids"][0]
    each[Q] = [repr(100.0 * float(number)) for number in each[Q]]
    assert "may" in refused(half, proof)


def test_center_that_moves_otherwise_than_the_loop_settles_is_refused(half, proof):
    """With another way to go with the steady drift, or none, what it adds is not in its share."""
    for by in (0.0, -1.0, 2.0):
        forged = json.loads(json.dumps(proof))
        each = forged["ellipsoids"][0]
        each[MOVES] = [repr(by * float(number)) for number in each[MOVES]]
        assert "may" in refused(half, forged)
    proof["ellipsoids"][0][STEADY] = repr(0.001 * float(proof["ellipsoids"][0][STEADY]))
    assert "may lead out of an ellipsoid" in refused(half, proof)


def test_center_that_the_loop_leaves_is_refused(half, proof):
    each = proof["ellipsoids"][0]
    each[CENTER] = repr(3.0 * float(each[CENTER]))
    assert "may lead out of an ellipsoid" in refused(half, proof)


def test_shorter_pulse_than_the_state_asks_for_is_refused(half, proof):
    each = proof["ellipsoids"][0]
    each[0] = each[BACK] = each[LONGEST] = "0.05"
    assert "in its longest pulse" in refused(half, proof)


def test_less_supply_than_the_states_have_room_in_is_refused(half, proof):
    each = proof["ellipsoids"][-1]
    assert 0.0 < float(each[SUPPLY]) < 1.0
    each[SUPPLY] = repr(float(each[SUPPLY]) - 1 / 64)
    assert "may go beyond" in refused(half, proof)
    each[SUPPLY] = "1.01"
    assert "from 0 to 1" in refused(half, proof)


def test_supply_that_rises_fast_is_refused(half, proof):
    """A pulse goes further while the supply rises: a bound that leaves that out does not hold."""
    fast = replace(half, bounds=half.bounds | {"supply rate": (20.0, 30.0)})
    assert "may" in refused(fast, proof)


def test_valves_with_a_dead_time_need_a_proof_about_them(half, proved, proof):
    brake = replace(half.vehicle.brake, dead_time=0.005)
    late = replace(half, vehicle=replace(half.vehicle, brake=brake))
    assert SLIP_BAND.speaks_about(late) == ""
    assert "begin later" in refused(late, proof)
    assert told_with(late, proved, {CELLS: proof}).status is Status.UNDECIDED
    proof["delay"] = "0.25"
    for each in proof["ellipsoids"]:
        each[0] = "1.0"
    assert "into the next sample" in refused(late, proof)
    for each in proof["ellipsoids"]:
        each[0] = "0.5"
    assert "may" in refused(late, proof)
    later = replace(late, vehicle=replace(half.vehicle, brake=replace(brake, dead_time=0.02)))
    assert "dead time of 20 ms, a sample or more" in SLIP_BAND.speaks_about(later)


def test_noise_that_the_sets_leave_no_room_for_is_refused(half, proof):
    proof["noise"] = "0.001"
    assert "no share" in refused(half, proof)
    proof["noise"] = "2.5"
    assert "hold its valves" in refused(half, proof)
    proof["noise"] = "-0.001"
    assert "below 0" in refused(half, proof)


def test_shares_above_one_are_refused(half, proof):
    proof["ellipsoids"][0][ALPHA] = "0.9999"
    assert "add up to more than 1" in refused(half, proof)


def test_disturbance_without_share_is_refused(half, proof):
    for place in (OFFSET, *DRIFTS, STEADY, CHANGE):
        forged = json.loads(json.dumps(proof))
        forged["ellipsoids"][0][place] = "0.0"
        assert "no share" in refused(half, forged)


def test_numbers_with_a_sign_that_makes_a_term_vanish_or_turn_are_refused(half, proof):
    """Dividing by a number below 0 takes off what is to be added, or leaves more than there is."""
    for place, sign in ((ALPHA, -1.0), (ALPHA, 0.0), (OFFSET, -1.0), (DRIFTS[0], -1.0)):
        forged = json.loads(json.dumps(proof))
        each = forged["ellipsoids"][0]
        each[place] = repr(sign * float(each[place]))
        assert "add up to more than 1" in refused(half, forged)
    for multiplier in ("-0.5", "0.0", "1.0", "1.5"):
        forged = json.loads(json.dumps(proof))
        forged["ellipsoids"][0][INSIDE] = multiplier
        assert "next slower" in refused(half, forged)


def test_alpha_that_the_loop_does_not_reach_is_refused(half, proof):
    proof["ellipsoids"][0][ALPHA] = "0.5"
    assert "may lead out of an ellipsoid" in refused(half, proof)


def ellipse(size, center, inside, moves=0, drift=0):
    """A ball of this radius about a point on the first axis."""
    matrix = tuple(tuple(Fraction(size) ** 2 * (i == j) for j in range(STATES)) for i in range(STATES))
    numbers = dict.fromkeys(
        ("pulse", "supply", "alpha", "offset", "longest", "back", "room", "lag", "beyond", "curve"),
        Fraction(1),
    )
    return Ellipsoid(
        **numbers,
        near=0,
        settled=Fraction(0),
        shortest=Fraction(0),
        matrix=matrix,
        center=(Fraction(center), *[Fraction(0)] * (STATES - 1)),
        drift=Fraction(drift),
        moves=(Fraction(moves), *[Fraction(0)] * (STATES - 1)),
        shares=(),
        steady=Fraction(1),
        change=Fraction(1),
        inside=inside,
    )


def steady(low, high):
    """A steady drift between two ends."""
    low, high, none, half = (point(Fraction(each)) for each in (low, high, 0, "1/2"))
    return Steady(low, high, (none, none), half, none)


CALM = steady(0, 0)


@pytest.mark.parametrize(("apart", "lies"), [("0.49", True), ("0.51", False)])
def test_balls_lie_in_each_other_as_long_as_radius_and_way_reach(apart, lies):
    inner = ellipse("1/2", apart, Fraction(0))
    assert any(lies_in((inner, CALM), (each, CALM)) for each in around_it()) is lies


def around_it():
    """The ball of radius 1 about 0 with every multiplier."""
    return [ellipse(1, 0, Fraction(t, 100)) for t in range(1, 100)]


def test_balls_about_other_errors_do_not_lie_in_each_other():
    inner = ellipse("1/2", "0", Fraction(0))
    assert any(lies_in((inner, CALM), (each, CALM)) for each in around_it())
    other = replace(inner, settled=Fraction(1, 10**6))
    assert not any(lies_in((other, CALM), (each, CALM)) for each in around_it())


@pytest.mark.parametrize(
    ("faster", "slower", "moves", "center", "lies"),
    [
        ((-9, 11), (-9, 11), "1/10", 0, True),  # alike: apart at no drift
        ((0, 10), (-10, 10), "1/10", "1/2", False),
        (("-4.9", "4.9"), ("-4.9", "4.9"), 0, 0, True),
        (("-5.1", "5.1"), ("-5.1", "5.1"), 0, 0, False),
        ((-9, 9), ("-4.9", "4.9"), 0, 0, True),  # only drifts that both know
        ((-9, 9), ("-4.9", "5.1"), 0, 0, False),
        ((-9, 9), ("-5.1", "4.9"), 0, 0, False),
    ],
)
def test_balls_whose_centers_move_lie_in_each_other_at_every_drift_that_both_know(
    faster, slower, moves, center, lies
):
    inner = ellipse("1/2", 0, Fraction(0), moves="1/10"), steady(*faster)
    outer = [ellipse(1, center, each.inside, moves=moves) for each in around_it()]
    assert any(lies_in(inner, (each, steady(*slower))) for each in outer) is lies


def test_centers_for_other_drifts_are_compared_at_one():
    """A center that is for another drift is where it moves to from there."""
    inner = ellipse("1/2", 0, Fraction(0), moves="1/10"), steady(-9, 9)
    for center, lies in (("1/2", True), (0, False)):
        outer = [ellipse(1, center, each.inside, moves="1/10", drift=5) for each in around_it()]
        assert any(lies_in(inner, (each, steady(-9, 9))) for each in outer) is lies


def test_drift_that_a_center_is_for_is_part_of_the_statement(half, proof):
    each = proof["ellipsoids"][0]
    for by in (0.0, 2.0):
        forged = json.loads(json.dumps(proof))
        forged["ellipsoids"][0][DRIFT] = repr(by * float(each[DRIFT]))
        assert "may" in refused(half, forged)


def told_with(problem, certificate, proofs):
    """The certificate with other proofs of ellipsoids; what is known of the friction is not decided again."""
    wanted = [each for each in SLIP_BAND.obligations(problem) if each.key in proofs]
    decided = accepted(wanted, {key: Stated(proof=proof) for key, proof in proofs.items()})
    return SLIP_BAND.tell(problem, {**certificate.findings, **decided})


def test_window_without_ellipsoid_is_refused_where_less_may_be_held(half, proof):
    """Nothing is left out of the claim with the full reserve, nor where holding may take less, nor above a gap."""
    slow = proof["cells"][0]
    for reserve, places, reason in (
        ("1.0", [0], "may take less"),
        ("0.9", [0], "may take less"),
        ("0.9", [1], "after a slower one"),
    ):
        forged = proof | {
            "reserve": reserve,
            "cells": [[None if k in places else n for k, n in enumerate(slow)]],
        }
        assert reason in refused(half, forged)
    for reserve in ("0.0", "1.1"):
        assert "1 at most" in refused(half, proof | {"reserve": reserve})


def test_windows_in_which_more_is_held_are_left_out_and_leave_the_claim_open(half, proved, proof):
    """On half of the wet box holding takes 31 % at 10 km/h and more: nothing is claimed there of less."""
    law = law_of(half.controller)
    friction = read(proof, len(windows_of(half))).friction
    sought = Sought(
        problem=contact_held(half),
        law=law,
        friction=friction,
        conditions=exactly(half, law)._replace(reserve=Fraction("0.3")),
    )
    held = write(alone(sought, Fraction(1)))
    assert held["cells"][0][0] is None
    assert held["cells"][0][-1] is not None
    assert "leaves out" in refused(half, held)
    numbers = told_of(half, held, reserved=True)
    assert numbers["reserve"] == 0.3
    assert "band 0 above" not in numbers
    told = told_with(half, proved, {CELLS: held})
    assert told.status is Status.UNDECIDED
    assert told.explanation.startswith("No ellipsoids were found")
    told = told_with(half, proved, {RESERVED: held})
    assert told.status is Status.PROVED
    assert "takes at most 30 % of the full pressure" in told.explanation


def test_clip_of_what_is_held_is_that_of_the_reserve(half):
    """Half of the wet box takes up to 69 %; a reserve takes what is beyond off the room for filling, and no more."""
    with ctx.workprec(128):
        law, box = law_of(half.controller), box_of(half, Fraction(1))
        friction = Friction(((-0.2, 0.02),) * len(SLOPES), (0.86, 0.91), ((-0.1, -0.09),) * len(FADINGS))
        exact = Conditions(supply=Fraction(1), delay=Fraction(0), noise=Fraction(0))
        found = {
            reserve: loop_of(
                contact_held(half),
                law,
                box,
                windows_of(half)[0],
                everywhere(friction),
                Choice(Fraction(1, 2), 0),
                exact._replace(reserve=reserve),
            )
            for reserve in map(Fraction, ("1", "0.9", "0.6", "0.5"))
        }
        full = float(law.full_torque / law.inertia * law.sample_time)
        least = float(law.sample_time) * 0.001 * float(law.full_torque / law.inertia)
        rooms = [float(each.limits[-1].bound.mid()) for each in found.values()]
        assert rooms[0] == pytest.approx(rooms[1])
        assert rooms[1] < rooms[2] < rooms[3] == pytest.approx(0.5 * full, abs=2.0 * least)
        assert len({each.holding for each in found.values()}) == 1
        assert 0.3 < found[Fraction(1)].holding < 0.45


def test_narrower_slope_counts_only_as_far_as_it_is_bounded(half, proof):
    """An error that leaves the narrower range is refused there, whatever the slope is in it."""
    each = proof["ellipsoids"][0]
    # At 10 km/h the band reaches farther above the reference than the narrowest reach, which lies below it.
    assert float(each[NEAR]) == 1.0
    each[NEAR] = "2.0"
    assert "range in which the slope of the friction is bounded" in refused(half, proof)
    each[NEAR] = "1.0"
    each[Q] = [repr(9.0 * float(number)) for number in each[Q]]
    assert "may" in refused(half, proof)
    each[NEAR] = repr(float(len(REACHES)))
    assert "not there" in refused(half, proof)


def test_matrix_that_is_not_positive_is_refused(half, proof):
    """-Q has all that is asked of it but that."""
    each = proof["ellipsoids"][0]
    each[Q] = [repr(-float(number)) for number in each[Q]]
    assert "not positive definite" in refused(half, proof)


def test_each_share_is_needed(half, proof):
    """A disturbance whose share is a thousandth of what the search gives it: what it adds is not left out."""
    for window, number in (*((0, each) for each in (*DRIFTS, STEADY)), (5, OFFSET)):
        forged = json.loads(json.dumps(proof))
        each = forged["ellipsoids"][window]
        each[number] = repr(0.001 * float(each[number]))
        assert "may lead out of an ellipsoid" in refused(half, forged)


def test_share_of_the_box_is_part_of_the_statement(half, proof):
    """A share below 1 is a proof about less than the box, one above it about numbers that are not in it."""
    proof["share"] = "1.5"
    assert "1 at most" in refused(half, proof)
    proof["share"] = "0.5"
    assert told_of(half, proof)["share"] == 0.5


def test_share_of_the_box_is_told_and_leaves_the_claim_open(half, proved, proof):
    told = told_with(half, proved, {CELLS: proof | {"share": "0.5"}})
    assert told.status is Status.UNDECIDED
    assert told.explanation.startswith(
        "Shown on 50 % of each range about its nominal value, not on all of it."
    )
    assert told.margin is None


def test_whole_box_of_low_adhesion_is_proved():
    certificate = certificate_of(problem_of(1.0, rail=wd.load_rail("low-adhesion"), speeds=SLOW))
    assert certificate.status is Status.PROVED
    numbers = certificate.findings[CELLS].numbers
    assert numbers["share"] == 1.0
    assert max(numbers["band 0 above"], numbers["band 0 below"]) < 0.0015


def test_ellipsoid_that_is_not_there_is_refused(half, proof):
    proof["cells"][0][0] = 99
    assert "not there" in refused(half, proof)


def test_hole_between_windows_is_refused(half, proof):
    """An ellipsoid may be invariant in its own window and still not lie in that of the next slower one."""
    cells = proof["cells"][0]
    cells[0], cells[-1] = cells[-1], cells[0]
    assert "may" in refused(half, proof)
    cells[0], cells[-1] = cells[-1], cells[0]
    proof["ellipsoids"][0][INSIDE] = "0.9999"
    assert "next slower" in refused(half, proof)


def test_dropped_window_and_dropped_cell_are_refused(half, proof):
    missing = json.loads(json.dumps(proof))
    missing["cells"][0].pop()
    assert "one entry for each" in refused(half, missing)
    halved = json.loads(json.dumps(proof))
    halved["steps"] = "m.."
    assert "do not match" in refused(half, halved)


def test_narrower_friction_proves_less_than_the_theorem_asks(half, proof, document):
    """Bounds that are narrower than the proved ones are a true statement about another friction."""
    low, high = (float(each) for each in proof["friction"][0][2:4])
    proof["friction"][0][2:4] = [repr(0.5 * low), repr(0.5 * high)]
    assert not replay(half, json.dumps(document)).accepted


def parts_in(proof, window=0):
    """Numbers of the parts of a window: the range of the steepness, then the bounds."""
    numbers = proof["friction"][window]
    count = len(numbers) // PARTS
    assert count == 2 * (1 + len(NAMES))
    return [numbers[k * count : (k + 1) * count] for k in range(PARTS)]


def with_parts(proof, parts, window=0):
    """Return a proof that states other parts in a window."""
    friction = list(proof["friction"])
    friction[window] = [number for each in parts for number in each]
    return {**proof, "friction": friction}


def test_parts_of_the_steepness_that_leave_some_out_are_refused(half, proof):
    """Exchanged ones among them, with their bounds."""
    first, second, *others = parts_in(proof)
    *before, last = parts_in(proof)
    low, high = map(float, second[:2])
    middle = repr(0.5 * (low + high))
    for parts in (
        [second, first, *others],
        [first, *others[::-1], second],
        [first, [second[0], middle, *second[2:]], *others],
        [first, [middle, *second[1:]], *others],
        [[repr(1.001 * float(first[0])), *first[1:]], second, *others],
        [*before, [last[0], repr(0.999 * float(last[1])), *last[2:]]],
    ):
        assert "leave out some of a cell" in refused(half, with_parts(proof, parts))


def test_part_that_is_no_range_of_doubles_is_refused(half, proof):
    first, *others = parts_in(proof)
    for forged, reason in (
        ([*first[1::-1], *first[2:]], "is none"),
        (["1/3", *first[1:]], "is not a double"),
    ):
        assert reason in refused(half, with_parts(proof, [forged, *others]))
    assert "lacks" in refused(half, with_parts(proof, others))


@pytest.mark.parametrize("window", [0, -1])
def test_parts_for_which_other_bounds_are_proved_prove_nothing(half, proved, proof, window):
    """Whatever the checker says: a part must lie in the one for which something is proved, and hold what is."""
    finding = proved.findings[CELLS]
    assert covered(half, proved.findings, CELLS) is finding
    first, second, *others = parts_in(proof, window)
    for parts in (
        [[*first[:2], *second[2:]], [*second[:2], *first[2:]], *others],  # bounds of another part
        [second, first, *others],
        [[first[0], second[1], *first[2:]], second, *others],  # a part that reaches into the next one
        [first, [first[0], *second[1:]], *others],
    ):
        forged = with_parts(proof, parts, window)
        assert told_with(half, proved, {CELLS: forged}).status is Status.UNDECIDED
        stated = {
            f"{name} {k} {window % len(windows_of(half))} {end}": value
            for k, each in enumerate(read(forged, len(windows_of(half))).friction[window])
            for name, ends in ((STEEPNESS, each.steepness), *each.friction.named.items())
            for end, value in zip(("low", "high"), ends, strict=True)
        }
        assert stated.keys() <= finding.numbers.keys()
        other = replace(finding, numbers={**finding.numbers, **stated})
        assert covered(half, {**proved.findings, CELLS: other}, CELLS).status is Status.UNDECIDED


def test_proof_of_half_of_the_box_does_not_hold_for_all_of_it(document):
    assert not replay(problem_of(1.0), json.dumps(document)).accepted


def test_nominal_inversion_with_a_fast_valve_is_not_proved():
    """Full steps through a valve that is twice as fast: the loop oscillates, and no ellipsoid is found."""
    problem = problem_of(0.0, speeds=(10.0 / 3.6, 12.0 / 3.6))
    assert certificate_of(problem).status is Status.PROVED
    law = problem.controller
    valve = replace(law.valve, time_share=1.0)
    assert isinstance(valve, ValveInversion)
    law = replace(law, valve=valve, core=replace(law.core, tracking=replace(law.core.tracking, valve=valve)))
    fast = problem.bounds | {"fill time": (0.25, 0.25), "vent time": (0.25, 0.25)}
    found = certificate_of(replace(problem, controller=law, bounds=fast))
    assert found.status is Status.UNDECIDED


def test_other_laws_are_not_spoken_about(half):
    def reason(**changed):
        return SLIP_BAND.speaks_about(replace(half, **changed))

    assert reason() == ""
    sliding = wd.design_controller(half.vehicle, half.rail, wd.Specification(), law="smc")
    assert "observer" in reason(controller=sliding.build(half.vehicle, half.rail))
    assert "holds slip 0.14" in reason(slip=0.15)
    law = half.controller
    assert "pressure sensors" in reason(controller=replace(law, pressure_sensors=False))
    seeking = replace(wd.Specification(), sample_time=0.02, reference="seeking", speeds=half.speeds)
    searching = wd.design_controller(half.vehicle, half.rail, seeking, law="observer-smc")
    assert "searches for the peak" in reason(controller=searching.build(half.vehicle, half.rail))
    wheels = wd.Specification(sample_time=0.02, sensors=Sensors(speed="wheels"), speeds=half.speeds)
    estimating = wd.design_controller(half.vehicle, half.rail, wheels, law="observer-smc")
    assert "estimates the train speed" in reason(controller=estimating.build(half.vehicle, half.rail))
    assert "holds its valves" in reason(controller=replace(law, cut_out_speed=5.0))


class Gentle(type(problem_of(0.0).controller)):
    """Claims to be the protection and commands other pulses."""

    def step(self, state, measurement):
        state, commands = super().step(state, measurement)
        return state, tuple(each._replace(fill=0.9 * each.fill) for each in commands)


def test_step_that_runs_is_what_counts(half):
    law = half.controller
    assert not_written(law) == ""
    gentle = Gentle(**{name: getattr(law, name) for name in law.__dataclass_fields__})
    assert "is not shown" in not_written(gentle)
    assert "is not shown" in SLIP_BAND.speaks_about(replace(half, controller=gentle))


def test_worn_wheels_of_which_the_law_takes_no_scale_are_refused(half, proof):
    """A law that does not take the scale from them holds another slip: with 5 %, .2 in place of .14 at 510 mm."""
    law = half.controller
    careless = replace(half, controller=replace(law, source=replace(law.source, largest_scale_error=0.03)))
    assert "does not take its scale" in refused(careless, proof)


def test_cells_that_go_on_with_the_ellipsoids_of_a_larger_one_are_accepted():
    """Tangents of a smaller range touch elsewhere: an ellipsoid of a cell may not be one of its half."""
    problem = problem_of(0.9, speeds=(14.0 / 3.6, 20.0 / 3.6))
    _, friction = bounded_friction(problem, SLIP_BAND.obligations(problem))
    assert friction is not None
    law = law_of(problem.controller)
    sought = Sought(
        problem=contact_held(problem), law=law, friction=friction, conditions=exactly(problem, law)
    )
    proof = cover(sought, Fraction(1), Spent(200))
    assert isinstance(proof, Proof)
    assert len(proof.cells) > 1
    numbers = told_of(problem, write(proof))
    assert numbers["cells"] == len(proof.cells)
