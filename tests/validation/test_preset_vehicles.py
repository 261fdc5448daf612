"""Shipped vehicles: their sources' arithmetic, the rules that their numbers follow, and stops after EN 14531-1."""

import math

import pytest

from wspd_design.analysis.stopping import full_adhesion_stop
from wspd_design.parameters.loading import available, load_entries, load_rail, load_vehicle
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.studies.new_vehicle import RATED_SPEEDS, derived_entries, wanted_like

PRESETS = ("co-co", "coach", "freight-wagon", "metro", "two-axle-wagon")
LADEN = tuple(f"{name}:laden" for name in PRESETS if name != "co-co")


def test_these_are_the_shipped_vehicles():
    assert set(available("vehicle")) == {*PRESETS, "er24pc", "er24pc-service"}
    assert set(RATED_SPEEDS) == set(PRESETS)


@pytest.mark.parametrize("name", PRESETS)
def test_no_number_is_taken_over(name):
    entries = load_entries("vehicle", name).entries.values()
    assert not any(entry.inherited for entry in entries)
    assert all(entry.at and entry.status for entry in entries)


@pytest.mark.parametrize("name", PRESETS)
def test_a_vehicle_like_it_is_the_same(name):
    """The rules of ``wspd new vehicle`` give the shipped numbers back, to the rounding of four digits."""
    shipped = load_entries("vehicle", name).entries
    derived = {entry.name: entry for entry in derived_entries(wanted_like(name))}
    assert set(derived) == set(shipped)
    for key, entry in shipped.items():
        if isinstance(entry.value, float):
            assert derived[key].value == pytest.approx(entry.value, rel=2e-4), key
        else:
            assert derived[key].value == entry.value, key


@pytest.mark.parametrize("name", [*PRESETS, *LADEN])
def test_stop_on_full_adhesion_is_that_of_en_14531(name, make_controller):
    vehicle, speed = load_vehicle(name), RATED_SPEEDS[name.partition(":")[0]]
    stop = Scenario(rail=load_rail("polach-dry"), initial_speed=speed)
    made = trial(vehicle, make_controller("none"), stop, slip_reference=0.14, plant="quarter")
    assert made.run.ending is Ending.STOPPED
    assert made.run.slip_max < 0.02
    assert made.metrics.distance == pytest.approx(full_adhesion_stop(vehicle, speed).distance, rel=0.01)


def test_pitch_of_the_manchester_coach():
    """Data of the benchmark: springs and dampers of each bogie, inertias of body and frame."""
    coach = load_vehicle("coach")
    stiffness, frequency = 0.0, 1.0
    for _ in range(20):
        omega = 2j * math.pi * frequency
        primary, secondary = 4.8e6 + omega * 16e3, 0.86e6 + omega * 40e3
        stiffness = primary * secondary / (primary + secondary)
        frequency = math.sqrt(2 * 9.5**2 * stiffness.real / 1.97e6) / (2 * math.pi)
    assert coach.body_pitch_frequency == pytest.approx(frequency, rel=0.005)
    assert coach.pitch_damping_ratio == pytest.approx(stiffness.imag / stiffness.real / 2, rel=0.02)
    frame = math.sqrt(2 * 2.4e6 * 1.28**2 / 1476) / (2 * math.pi)
    assert coach.bogie_pitch_frequency == pytest.approx(frame, rel=0.005)
    assert coach.mass == 32000 + 2 * (2615 + 2 * 1813)


def test_the_supply_of_position_p_builds_up_in_four_seconds():
    assert 1 - math.exp(-4.0 * load_vehicle("coach").brake.supply_rate) == pytest.approx(0.95, abs=1e-3)
