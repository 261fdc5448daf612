"""One number at a time: what it does to a stop, on the planar model, whose load transfer is known in closed form."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.planar import Planar
from wspd_design.simulation.records import Scenario
from wspd_design.studies.tornado import tornado

LOCO = load_vehicle("er24pc")
LOCO = replace(LOCO, brake=replace(LOCO.brake, max_torque=15e3))  # which dry rail takes
STOP = Scenario.stop(from_kmh=60.0, rail=load_rail("polach-dry"))
BOUNDS = {"traction_rod_height": (0.0, 1.1), "wheel_damping": (0.2, 0.3), "mass": (61e3, 92e3)}


def varied(name, value):
    return Planar(replace(LOCO, **{name: value}))


@pytest.fixture(scope="module")
def found():
    with ThreadPoolExecutor(2) as pool:
        return tornado(
            Planar(LOCO),
            Unprotected(name="none", sample_time=0.1),
            STOP,
            BOUNDS,
            varied=varied,
            build_up=3.0,
            pool=pool,
        )


def test_every_number_is_simulated_at_both_ends_and_the_stops_are_counted(found):
    assert found.stops == 7
    assert [(each.name, each.low, each.high) for each in found.swings] == [
        (name, *ends) for name, ends in BOUNDS.items()
    ]
    assert (found.plant, found.controller, found.rail) == ("planar", "none", "polach-dry")


def test_the_strongest_number_comes_first(found):
    assert next(each.name for each in found.strongest("distance")) == "mass"
    assert [each.name for each in found.strongest("transfer")] == [
        "mass",
        "traction_rod_height",
        "wheel_damping",
    ]


def test_the_height_of_the_traction_rods_moves_load_as_the_formula_says(found):
    """From the balance of moments: of the body over the pivots, and of a bogie under the pull of the body."""
    swing = found.swings[0]
    rigid = LOCO.mass + 4 * LOCO.wheelset_inertia / LOCO.wheel_radius**2
    held = 4 * 15e3 / LOCO.wheel_radius / rigid  # resistance adds 2 %

    def transfer(height):
        body = LOCO.body_mass * held * (LOCO.body_height - height) / LOCO.bogie_spacing
        pull = 0.5 * LOCO.body_mass * held
        bogie = LOCO.bogie_mass * held * LOCO.bogie_height + pull * height
        return (0.25 * body + 0.5 * bogie / LOCO.wheelbase) / static_wheel_load(LOCO)

    for end, height in ((swing.at_low, 0.0), (swing.at_high, 1.1)):
        assert end.transfer == pytest.approx(transfer(height), rel=0.05)


def test_nothing_but_the_number_moves(found):
    heights, damping, mass = found.swings
    # Where no wheel slides, height moves load alone.
    assert heights.reach("distance", found.nominal) < 0.05
    assert damping.reach("transfer", found.nominal) < 1e-4
    assert mass.at_low.distance < found.nominal.distance < mass.at_high.distance
