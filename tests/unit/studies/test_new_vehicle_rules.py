"""The rules of ``wspd new vehicle`` and ``wspd new rail`` by hand and against what is published."""

import math
from dataclasses import replace

import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, load_rail
from wspd_design.parameters.records import Contact
from wspd_design.studies.new_rail import NUMBERS, fit_rail
from wspd_design.studies.new_vehicle import Wanted, derived_entries, derived_vehicle, wanted_like

CAR = Wanted(
    kind="metro",
    mass=40e3,
    laden_mass=60e3,
    weighs=True,
    wheelsets=4,
    bogie_spacing=14.0,
    wheelbase=2.2,
    wheel_diameter=0.84,
    rotating_mass=4e3,
    speed=100 / 3.6,
    deceleration=1.0,
    build_up="main-pipe",
    build_up_delay=0.0,
    build_up_time=1.2,
    fill_time=0.3,
    vent_time=0.1,
)


def test_torque_by_hand():
    """Force of the brake and mean resistance together slow mass and rotating mass; at 1 m/s2 the sum is 44 kN."""
    car = derived_vehicle("car", CAR)
    speed = CAR.speed
    resistance = (6.3743 * 40 + 128.998 * 4) + 0.32905 * 40 * speed * 2 / 3 + 2.3 * speed**2 / 2
    assert car.brake.max_torque == pytest.approx((44e3 - resistance) * 0.42 / 4, rel=5e-4)
    laden = {entry.name: entry for entry in derived_entries(CAR)}["laden.max_torque"].value
    assert laden == pytest.approx((64e3 - resistance) * 0.42 / 4, rel=5e-4)


def test_other_numbers_by_hand():
    car = derived_vehicle("car", CAR)
    assert car.wheelset_inertia == pytest.approx(1000 * 0.42**2, rel=5e-4)
    assert 1 - math.exp(-1.2 * car.brake.supply_rate) == pytest.approx(0.95, abs=1e-4)
    assert car.contact.reference_load == pytest.approx(40e3 * constants().gravity / 8, rel=5e-4)
    assert car.body_mass + 2 * car.bogie_mass == car.mass == 40e3
    assert car.bogie_mass == pytest.approx(40e3 / 6, abs=1)  # a third of a metro car are its bogies
    assert car.bogie_height == pytest.approx(0.5 * 0.42 / 0.425, rel=5e-4)


def test_bounds_hold_their_numbers_and_say_what_is_exact():
    entries = {entry.name: entry for entry in derived_entries(CAR)}
    for entry in entries.values():
        if entry.bounds is not None:
            assert entry.bounds[0] <= entry.value <= entry.bounds[1], entry.name
    exact = {name for name, entry in entries.items() if entry.bounds is None}
    assert {"wheelsets", "bogie_spacing", "wheelbase", "contact.reference_load"} <= exact
    assert entries["wheel_radius"].bounds == pytest.approx((0.3885, 0.42))


def test_a_brake_by_wire_and_one_by_the_main_pipe():
    """Only the numbers of its own build-up stand in a file, whatever the kind has."""
    wired = replace(CAR, build_up="electro-pneumatic", build_up_delay=0.3, build_up_time=0.9)
    for wanted, kind in ((CAR, "metro"), (CAR, "coach"), (wired, "metro"), (wired, "coach")):
        names = {entry.name for entry in derived_entries(replace(wanted, kind=kind))}
        by_wire = {"brake.build_up", "brake.build_up_delay", "brake.build_up_ramp"}
        assert names & (by_wire | {"brake.supply_rate"}) == (
            by_wire if wanted is wired else {"brake.supply_rate"}
        )
    brake = derived_vehicle("car", wired).brake
    assert (brake.build_up, brake.build_up_delay, brake.build_up_ramp) == ("electro-pneumatic", 0.3, 0.9)


def test_a_kind_whose_axles_do_not_fit_is_refused():
    with pytest.raises(UserError, match="axles = 5 must be a multiple of 2"):
        derived_entries(replace(CAR, wheelsets=5))


def test_the_kind_gives_its_own_answers():
    like = wanted_like("two-axle-wagon")
    assert (like.wheelsets, like.wheelbase, like.laden_mass, like.weighs) == (2, 0.0, 40e3, True)
    assert like.deceleration == pytest.approx(0.85, rel=1e-3)


# Creep curve of the EuroSprinter 127 at 10 m/s, reference output of the program CONTACT.
CURVE = {
    0.001: 0.0602,
    0.002: 0.1154,
    0.004: 0.2013,
    0.006: 0.2554,
    0.008: 0.2856,
    0.01: 0.3009,
    0.012: 0.3083,
    0.014: 0.3111,
    0.016: 0.3117,
    0.02: 0.3099,
    0.03: 0.3015,
    0.05: 0.2845,
    0.1: 0.2495,
    0.15: 0.2230,
    0.2: 0.2028,
    0.25: 0.1876,
}


def test_the_fit_of_the_eurosprinter_is_the_published_one():
    contact = Contact(
        shear_modulus=82e9,
        semi_axis_rolling=6.304e-3,
        semi_axis_lateral=12.61e-3,
        kalker_c11=3.79,
        reference_load=106.7e3,
    )
    fit = fit_rail("es", list(CURVE), list(CURVE.values()), speed=10.0, wheel_load=106.7e3, contact=contact)
    shipped = load_rail("eurosprinter127")
    for name in NUMBERS:
        assert getattr(fit.rail, name) == pytest.approx(getattr(shipped, name), rel=3e-3), name
    assert fit.rms < 4.5e-4
    assert fit.rms < fit.largest < 1e-3
