"""What is compiled, and when: a plant once for as many axles, a law once whatever its numbers are."""

import subprocess
from dataclasses import fields, replace

import pytest

from wspd_design.codegen import closed_loop, compiler
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import clip
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

pytestmark = pytest.mark.usefixtures("compiled_quickly")

WET = load_rail("polach-wet")


@pytest.fixture
def compilations(cache, monkeypatch):  # noqa: ARG001 - an empty one
    """Sources that a compiler was run on; nothing is in the cache, and no library is remembered."""
    sources, true = [], subprocess.run

    def run(command, **options):
        if "-o" in command:
            text = command[command.index("-o") - 1]
            with open(text, encoding="utf-8") as file:
                sources.append(file.read())
        return true(command, **options)

    monkeypatch.setattr(compiler.subprocess, "run", run)
    monkeypatch.setattr(closed_loop, "load_library", lambda source: compiler.load_library(source))  # forget
    return sources


def stop_of(vehicle, law, rail=WET, plant=Planar):
    return simulate(vehicle, law, Scenario(rail=rail, initial_speed=8.0), plant=plant.name).totals.distance


def heavier(vehicle):
    return replace(vehicle, mass=1.1 * vehicle.mass, body_mass=vehicle.body_mass + 0.1 * vehicle.mass)


@pytest.mark.parametrize("name", ["smc", "torque-feedback", "afsmc"])
def test_a_new_gain_vehicle_or_rail_compiles_nothing(er24pc, make_controller, compilations, name):
    law = make_controller(name, "polach-wet")
    other, dry = heavier(er24pc), load_rail("table10-dry")
    distances = [stop_of(er24pc, law)]
    assert len(compilations) == 2  # the plant and the law
    distances += [stop_of(other, law), stop_of(er24pc, law, dry)]
    distances += [stop_of(er24pc, replace(law, gains=changed)) for changed in changes(law.gains)]
    if name != "afsmc":  # the others know their design model
        distances += [stop_of(er24pc, replace(law, vehicle=other)), stop_of(er24pc, replace(law, rail=dry))]
    assert len(compilations) == 2
    assert len(set(distances)) == len(distances)


def changes(gains):
    """The slip reference, and another gain."""
    name = next(
        f.name for f in fields(gains) if f.name != "slip_reference" and type(getattr(gains, f.name)) is float
    )
    yield replace(gains, slip_reference=0.08)
    yield replace(gains, **{name: 0.7 * getattr(gains, name)})


def test_a_new_law_compiles_itself_alone(er24pc, make_controller, compilations):
    for number, name in enumerate(("trenitalia", "knorr-bremse", "mitsubishi", "none")):
        stop_of(er24pc, make_controller(name))
        assert len(compilations) == 2 + number
    plants = [source for source in compilations if "wspd_run" in source]
    laws = [source for source in compilations if "step_kernel" in source]
    assert (len(plants), len(laws)) == (1, 4)


def test_another_number_of_axles_is_another_plant(er24pc, make_controller, compilations):
    law = make_controller("none")
    stop_of(er24pc, law, plant=Quarter)
    stop_of(replace(er24pc, wheelsets=2), law, plant=Quarter)
    assert len(compilations) == 4


class Own:
    """A law of a user, whose number decides a branch as well."""

    name, sample_time = "own", 0.1

    def __init__(self, duty):
        self.duty = duty

    def start(self, measurement):  # noqa: ARG002
        return ()

    def step(self, state, measurement):
        lower = 0.5 if self.duty > 0.6 else 0.0
        return state, Command(fill=clip(self.duty + 1e-3 * measurement.speed, lower, 1.0), vent=0.0)


def test_a_number_of_a_users_law_compiles_nothing_until_it_decides_a_branch(er24pc, compilations):
    distances = [stop_of(er24pc, Own(duty)) for duty in (0.2, 0.25, 0.3)]
    assert len(compilations) == 2
    distances += [stop_of(er24pc, Own(duty)) for duty in (0.7, 0.8)]
    assert len(compilations) == 3
    assert distances == sorted(distances, reverse=True)
    assert len(set(distances)) == 5
