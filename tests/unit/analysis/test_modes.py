"""Modes of small systems whose answers are known by hand."""

import math
import re

import numpy as np
import pytest

from wspd_design.analysis.modes import SmallMotion, modes, undamped_frequencies
from wspd_design.parameters.errors import UserError


def small_motion(coordinates, mass, stiffness, damping=None):
    mass, stiffness = np.array(mass, dtype=float), np.array(stiffness, dtype=float)
    damping = np.zeros_like(mass) if damping is None else np.array(damping, dtype=float)
    kinds = tuple(re.sub(r"(_\d+)?\..*", "", each) for each in coordinates)
    return SmallMotion(coordinates=coordinates, kinds=kinds, mass=mass, damping=damping, stiffness=stiffness)


def test_an_oscillator_has_the_frequency_and_damping_of_the_textbook():
    (mode,) = modes(small_motion(("car_body.z",), [[2.0]], [[8.0]], [[0.8]]))
    assert mode.name == "car body bounce"
    assert abs(mode.pole) == pytest.approx(2.0)
    assert mode.damping == pytest.approx(0.8 / (2.0 * math.sqrt(16.0)))
    assert mode.frequency == pytest.approx(2.0 * math.sqrt(1.0 - 0.1**2) / (2.0 * math.pi))
    assert not mode.unstable


def test_two_equal_bodies_move_together_and_against_each_other():
    motion = small_motion(("bogie_1.z", "bogie_2.z"), np.eye(2), [[3.0, -1.0], [-1.0, 3.0]])
    first, second = modes(motion)
    assert (first.name, second.name) == ("bogies bounce, in phase", "bogies bounce, in opposition")
    assert first.pole.imag == pytest.approx(math.sqrt(2.0))
    assert second.pole.imag == pytest.approx(2.0)
    assert first.shares[0].share == pytest.approx(1.0)


def test_a_mode_of_one_body_has_its_number_and_modes_of_one_name_are_counted():
    coordinates = ("bogie_1.z", "bogie_2.z", "rotor_1.turn", "rotor_2.turn", "rotor_3.turn")
    stiffness = np.diag([1.0, 2.0, 9.0, 9.0, 9.0])
    stiffness[2:, 2:] -= 1.0
    names = [mode.name for mode in modes(small_motion(coordinates, np.eye(5), stiffness))]
    assert names[:2] == ["bogie 1 bounce", "bogie 2 bounce"]
    assert all(name.startswith("driveline") for name in names[2:])
    assert len(set(names)) == 5


def test_sway_with_a_low_pole_is_told_from_sway_with_a_high_one():
    # A rigid body on a lateral spring below its center: y and roll are coupled by the height.
    height, stiff, roll = 1.0, 10.0, 5.0
    stiffness = [[stiff, stiff * height], [stiff * height, stiff * height**2 + roll]]
    lower, upper = modes(small_motion(("car_body.y", "car_body.roll"), [[4.0, 0.0], [0.0, 5.0]], stiffness))
    assert lower.name == "car body lower sway"
    assert upper.name == "car body upper sway"


def test_what_spins_with_an_axle_is_a_driveline_where_it_oscillates_and_slip_where_not():
    coordinates = ("wheelset_1.pitch", "rotor_1.turn", "wheelset_2.pitch", "rotor_2.turn")
    twist = np.array([[1.0, -1.0], [-1.0, 1.0]])
    stiffness = np.kron(np.diag([1.0, 2.0]), twist) + 1e-3 * np.eye(4)
    damping = np.diag([1.0, 0.0, 1.0, 0.0])
    found = modes(small_motion(coordinates, np.eye(4), stiffness, damping))
    assert {mode.name for mode in found if mode.oscillates} == {"driveline 1", "driveline 2"}
    assert all(mode.name.startswith("slip ") for mode in found if not mode.oscillates)
    without = modes(small_motion(("wheelset_1.pitch",), [[1.0]], [[1.0]]))
    assert [mode.name for mode in without] == ["wheelset 1 pitch"]


def test_a_mode_that_grows_is_told_and_neutral_motion_left_out():
    motion = small_motion(
        ("car_body.z", "car_body.x", "car_body.y"),
        np.eye(3),
        np.diag([4.0, 0.0, 0.0]),
        np.diag([-0.2, 0.0, 3.0]),
    )
    growing, decaying = modes(motion)
    assert growing.unstable
    assert growing.damping == pytest.approx(-0.05)
    assert not decaying.oscillates
    assert decaying.pole == pytest.approx(-3.0)


def test_an_unstable_equilibrium_has_no_eigenfrequencies():
    with pytest.raises(UserError, match="equilibrium is not stable"):
        undamped_frequencies(np.eye(2), np.diag([4.0, -1.0]))
    assert undamped_frequencies(np.eye(2), np.diag([4.0, 1.0])) == pytest.approx(
        [1.0 / (2.0 * math.pi), 2.0 / (2.0 * math.pi)]
    )
