"""No controller stops shorter than the ideal stop or the proved bound, whatever rail, mass, seed and noise."""

from dataclasses import fields, replace
from unittest.mock import patch

import pytest
from hypothesis import example, given, reject, settings
from hypothesis import strategies as st

from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.search import adhesion_peaks as peak_search
from wspd_design.certificates.theorems.shortest_stop import adhesion_peaks
from wspd_design.certificates.theorems.shortest_stop.adhesion_limit import NoBound
from wspd_design.certificates.theorems.shortest_stop.extremes import exactly
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import Rail
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import Scenario, Sensing
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate

CONTROLLERS = ("afsmc", "smc", "trenitalia", "knorr-bremse", "mitsubishi", "none")

rails = st.builds(
    Rail,
    name=st.just("random"),
    mu0=st.floats(0.05, 0.6),
    friction_ratio=st.floats(0.2, 1.0),
    friction_decay=st.floats(0.0, 0.8),
    adhesion_reduction=st.floats(0.3, 1.0),
    slip_reduction=st.floats(0.05, 0.3),
    bounds=st.just(Bounds.of({"mu0": (0.05, 0.6)})),
)

# Every number of a vehicle that moves a stop, as a share of the paper's; the damping may be the largest loss of all.
SHARES = {
    "mass": (0.6, 1.4),
    "wheel_radius": (0.7, 1.1),
    "wheelset_inertia": (0.2, 2.0),
    "resistance_constant": (0.0, 2.0),
    "resistance_linear": (0.0, 2.0),
    "resistance_quadratic": (0.0, 2.0),
    "brake.max_torque": (0.4, 1.5),
    "brake.supply_rate": (0.3, 10.0),
    "brake.fill_time": (0.2, 2.0),
    "brake.vent_time": (0.2, 2.0),
    "contact.semi_axis_rolling": (0.8, 1.3),
    "contact.semi_axis_lateral": (0.8, 1.3),
    "contact.kalker_c11": (0.8, 1.2),
}


def _scaled(shares, damping):
    """The paper's vehicle with other numbers; the body takes up what the mass gains."""
    vehicle = load_vehicle("er24pc")
    for name, share in shares.items():
        *part, field = name.split(".")
        record = getattr(vehicle, part[0]) if part else vehicle
        changed = replace(record, **{field: share * getattr(record, field)})
        vehicle = replace(vehicle, **{part[0]: changed}) if part else changed
    return replace(
        vehicle,
        wheel_damping=damping,
        wheel_damping_decay=0.0,
        body_mass=vehicle.mass - 2.0 * vehicle.bogie_mass,
    )


vehicles = st.builds(
    _scaled,
    st.fixed_dictionaries({name: st.floats(*ends) for name, ends in SHARES.items()}),
    st.one_of(st.just(0.0), st.floats(0.0, 600.0)),
)
DAMPED = _scaled(dict.fromkeys(SHARES, 1.0), 600.0)


@settings(max_examples=25, deadline=None)
@given(
    rail=rails,
    share=st.floats(0.8, 1.2),
    name=st.sampled_from(CONTROLLERS),
    seed=st.integers(0, 1000),
    noise=st.floats(0.0, 0.5),
    plant=st.sampled_from(("planar", "quarter")),
)
def test_no_controller_beats_the_ideal_stop(make_controller, rail, share, name, seed, noise, plant):
    vehicle = load_vehicle("er24pc")
    mass = share * vehicle.mass
    vehicle = replace(vehicle, mass=mass, body_mass=mass - 2.0 * vehicle.bogie_mass)
    scenario = Scenario(rail=rail, initial_speed=70.0 / 3.6, seed=seed, sensing=Sensing(speed_noise=noise))
    run = simulate(vehicle, make_controller(name), scenario, plant=plant)
    ideal = ideal_stop(vehicle, replace(scenario, sensing=Sensing()), plant=plant)
    assert run.totals.distance >= ideal.distance * (1.0 - 1e-4)


TWO_HUMPS = Rail(
    name="two humps",  # at high and at low speed it gives most at full slip, between them at a fifth of it
    mu0=0.5,
    friction_ratio=0.890625,
    friction_decay=0.5,
    adhesion_reduction=1.0,
    slip_reduction=0.21875,
)


@pytest.mark.parametrize("plant", ["planar", "quarter"])
def test_an_ideal_stop_ends_where_the_best_slip_jumps(make_controller, plant):
    """Held wheels once drifted away from it, rolled with a fixed speed and drove the train."""
    vehicle = load_vehicle("er24pc")
    scenario = Scenario(rail=TWO_HUMPS, initial_speed=70.0 / 3.6)
    ideal = ideal_stop(vehicle, scenario, plant=plant)
    assert ideal.ending is Ending.STOPPED
    held = ideal_stop(vehicle, scenario, plant=plant, slip=0.2)
    assert 0.9 * held.distance < ideal.distance < held.distance
    assert ideal.distance < simulate(vehicle, make_controller("afsmc"), scenario, plant=plant).totals.distance


@settings(max_examples=10, deadline=None)
@example(rail=load_rail("polach-wet"), vehicle=DAMPED, kmh=120.0)
@given(rail=rails, vehicle=vehicles, kmh=st.floats(15.0, 160.0))
def test_what_is_proved_lies_below_ideal_stops(rail, vehicle, kmh):
    """The search finds peaks and cuts that the checker accepts on every rail, for every vehicle."""
    plant = exactly(vehicle, rail), kmh / 3.6
    with patch.object(peak_search, "SPEEDS", 40):
        try:
            found, _ = adhesion_peaks.decide(*plant, peak_search.search(*plant), Work())
        except NoBound:  # with such a resistance a wheel could outrun the train
            assert vehicle != DAMPED
            reject()
    ideal = ideal_stop(vehicle, Scenario(rail=rail, initial_speed=kmh / 3.6), plant="quarter")
    assert 0.5 * ideal.distance < found.distance < ideal.distance
    assert found.time < ideal.stopping_time


def _given(record):
    """Names of the numbers of a record, without those of things that the vehicle does not have."""
    known = (each for each in fields(record) if each.name != "bounds")
    return {each.name for each in known if getattr(record, each.name) != each.default}


def test_every_number_of_the_vehicle_is_drawn():
    """What is not drawn has no part in a stop of the quarter vehicle on level track."""
    geometry = {"body_height", "bogie_height", "traction_rod_height", "bogie_spacing", "wheelbase"}
    pitch = {"body_pitch_frequency", "bogie_pitch_frequency", "pitch_damping_ratio"}
    scale = {"brake.max_pressure", "contact.shear_modulus", "contact.reference_load"}  # only products count
    disturbance = {f"brake.disturbance_{name}" for name in ("gain", "decay", "frequency")}
    made = {"wheelsets", "body_mass", "bogie_mass", "wheel_damping", "wheel_damping_decay"}
    vehicle = load_vehicle("er24pc")
    parts = {"brake": vehicle.brake, "contact": vehicle.contact}
    words = {"name", "multibody"}
    names = _given(vehicle) - parts.keys() - words
    names |= {f"{part}.{name}" for part, record in parts.items() for name in _given(record)}
    assert names == SHARES.keys() | geometry | pitch | scale | disturbance | made


def test_a_brake_of_more_torque_would_beat_it(er24pc, make_controller):
    """The ideal stop knows the brake: with twice the torque a stop is shorter than that of the weaker brake."""
    strong = replace(er24pc, brake=replace(er24pc.brake, max_torque=2.0 * er24pc.brake.max_torque))
    scenario = Scenario(
        rail=load_rail("table10-dry"), initial_speed=70.0 / 3.6
    )  # locked wheels are at the peak
    run = simulate(strong, make_controller("none"), scenario)
    assert run.totals.distance < ideal_stop(er24pc, scenario).distance


@pytest.mark.parametrize("plant", ["planar", "quarter"])
def test_full_torque_at_once_and_the_peak_are_shortest(er24pc, plant):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=120.0 / 3.6)
    at_once, peak, held = (
        ideal_stop(er24pc, scenario, plant=plant, **how).distance
        for how in ({"instantaneous": True}, {}, {"slip": 0.14})
    )
    assert at_once < peak < held
