"""Stops with a fault: what each does, where, and what is a fault of the law."""

from dataclasses import replace

import numpy as np
import pytest

from tests.unit.reporting.sample_dossier import trial
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.records import FAULT_KINDS, Scenario
from wspd_design.studies.faults import LONGEST_LOCK, longest_locks, robustness

LOCO, WET = load_vehicle("er24pc"), load_rail("polach-wet")
STOP = Scenario.stop(from_kmh=80.0, rail=WET)


def found(law, stop=STOP, vehicle=LOCO):
    made = controller(law, vehicle, stop.rail, Specification(sample_time=0.02))
    return robustness(vehicle, made, stop, plant="planar")


@pytest.fixture(scope="module")
def protected():
    return found("trenitalia")


def test_locks_are_those_of_the_traces_above_10_km_h():
    """The second wheelset stands from 5 s to 5.975 s; the train runs faster than 10 km/h until 9.17 s."""
    run = trial("mine").run
    assert longest_locks(run) == pytest.approx((0.0, 0.975, 0.0, 0.0))
    wheels = run.wheel_speed.copy()
    wheels[-20:, 0] = 0.0  # from 9.525 s on
    wheels[10:20, 1] = 0.0  # a shorter one before
    assert longest_locks(replace(run, wheel_speed=wheels)) == pytest.approx((0.0, 0.975, 0.0, 0.0))


def test_every_fault_is_tried_and_does_what_it_is_called(protected):
    assert [each.fault.kind for each in protected.faults] == list(FAULT_KINDS)
    by_kind = {each.fault.kind: each for each in protected.faults}
    assert by_kind["valve-vents"].distance > 1.02 * protected.plain  # a quarter of the brake is gone
    assert by_kind["valve-vents"].own_lock == 0.0
    assert by_kind["valve-fills"].own_lock > LONGEST_LOCK
    assert protected.patches.distance > protected.plain


def test_a_filled_brake_locks_on_wet_rail_whatever_the_law_does(protected):
    low, high = protected.most_adhesion
    assert low < high < protected.full_torque == 60e3
    fills = protected.faults[FAULT_KINDS.index("valve-fills")]
    assert protected.forced(fills)
    assert protected.holds(fills)


def test_adhesion_torque_by_hand():
    """m g/4 on a wheelset, times peak friction below mu0 = 0.3, times the radius; the peak falls with speed."""
    most = found("none").most_adhesion[1]
    assert most < 0.3 * 76841.0 * 9.81 / 4.0 * 0.55
    assert most > 0.8 * 0.3 * 76841.0 * 9.81 / 4.0 * 0.55


def test_a_brake_without_protection_does_not_hold():
    bare = found("none")
    vents = bare.faults[FAULT_KINDS.index("valve-vents")]
    assert vents.other_lock > LONGEST_LOCK
    assert not bare.holds(vents)
    assert not bare.holds(bare.patches)


def test_one_wheelset_for_all_has_no_single_faults():
    made = controller("none", LOCO, WET, Specification())
    assert robustness(LOCO, made, STOP, plant="quarter") is None


def test_a_stop_with_changes_of_rail_is_not_put_on_patches():
    mixed = replace(STOP, axle_rails=(WET,) * 4)
    assert found("none", mixed).patches is None


def test_axles_without_a_brake_have_no_fault():
    shares = (0.0, 1.0, 1.0, 1.0)
    vehicle = replace(LOCO, brake=replace(LOCO.brake, axle_shares=shares))
    assert all(each.fault.axle != 1 for each in found("none", vehicle=vehicle).faults)
    assert np.isfinite(found("none", vehicle=vehicle).plain)
