"""Ellipsoids of which one number is another one: refused for what that would leave out."""

import json
from dataclasses import replace

import pytest

from tests.certificates.band.conftest import refused
from tests.certificates.band.forging import (
    ALPHA,
    BACK,
    CENTER,
    CHANGE,
    DRIFT,
    DRIFTS,
    INSIDE,
    LONGEST,
    MOVES,
    NEAR,
    OFFSET,
    STEADY,
    SUPPLY,
    Q,
    told_with,
)
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems.band import CELLS, SLIP_BAND
from wspd_design.certificates.theorems.slip_band.friction import REACHES
from wspd_design.certificates.theorems.slip_band.statement import windows_of

pytestmark = pytest.mark.slow


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


def test_drift_that_a_center_is_for_is_part_of_the_statement(half, proof):
    each = proof["ellipsoids"][0]
    for by in (0.0, 2.0):
        forged = json.loads(json.dumps(proof))
        forged["ellipsoids"][0][DRIFT] = repr(by * float(each[DRIFT]))
        assert "may" in refused(half, forged)


def test_narrower_slope_counts_only_as_far_as_it_is_bounded(half, proof):
    """An error that leaves the narrower range is refused there, whatever the slope is in it."""
    each = proof["ellipsoids"][0]
    # At 10 km/h the band reaches nearer to the reference than a reach that begins beside it.
    assert float(each[NEAR]) == 1.0
    each[NEAR] = "11.0"
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
