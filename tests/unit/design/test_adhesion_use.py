"""How much of the adhesion a brake uses, told before anything is simulated."""

from dataclasses import replace

import pytest

from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.design.adhesion_use import adhesion_sentence, used_adhesion
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

SPEEDS = (10 / 3.6, 120 / 3.6)
WET = load_rail("polach-wet")


def braked(share):
    """A locomotive whose brake asks for a share of what the wet rail gives at worst."""
    vehicle = load_vehicle("er24pc-service")
    now, _ = used_adhesion(vehicle, WET, SPEEDS)
    return replace(vehicle, brake=replace(vehicle.brake, max_torque=vehicle.brake.max_torque * share / now))


@pytest.mark.parametrize(("share", "slides"), [(0.97, False), (1.2, True)])
def test_wheels_slide_above_one_and_not_below(share, slides):
    scenario = Scenario.stop(from_kmh=120, rail=WET)
    run = simulate(braked(share), Unprotected(name="none", sample_time=0.1), scenario, plant="quarter")
    assert bool(run.slip.max() > 0.9) == slides


def test_sentence():
    assert "97 % of what polach-wet gives at 120 km/h" in adhesion_sentence(braked(0.97), WET, SPEEDS)
    assert "stays idle" in adhesion_sentence(braked(0.97), WET, SPEEDS)
    assert "wheels slide without a protection" in adhesion_sentence(braked(1.2), WET, SPEEDS)


def test_the_rails_on_which_wheels_slide_are_named():
    said = adhesion_sentence(braked(0.97), WET, SPEEDS).partition("idle; wheels slide on ")[2]
    named = said.removesuffix(".").split(", ")
    assert "very-low" in named
    for rail in uniform_rails():
        assert (used_adhesion(braked(0.97), load_rail(rail), SPEEDS)[0] >= 1.0) == (rail in named)
    assert adhesion_sentence(braked(0.01), WET, SPEEDS).endswith("idle; so it does on every shipped rail.")
