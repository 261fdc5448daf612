"""The protection of the demo: it meets the requirements of its specification, and a planted fault does not."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.unit.reporting.sample_dossier import SOUND
from wspd_design.certificates.records import Status
from wspd_design.design.catalog import controller_of
from wspd_design.design.file import read_design
from wspd_design.design.judging import judge
from wspd_design.design.specification_file import read_task
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.records import Scenario
from wspd_design.studies.judgment import judged_drawn

FOLDER = Path(__file__).parents[2] / "reports" / "protection-polach-wet"
STOPS = 48  # of the held-out ones, which are enough for what fails by far


COMMITTED = read_design(FOLDER / "design.toml")


@pytest.fixture(scope="module")
def on_fewer_stops():
    assert COMMITTED.requirements is not None
    held_out = replace(COMMITTED.requirements.held_out, sets=STOPS)
    return replace(COMMITTED, requirements=replace(COMMITTED.requirements, held_out=held_out))


def judged(design):
    return {each.requirement: each for each in judge(design, load_rail(design.rail))}


@pytest.fixture(scope="module")
def reached():
    return judged(COMMITTED)


def test_the_design_was_made_for_the_specification_beside_it():
    task = read_task(str(FOLDER / "specification.toml"))
    assert COMMITTED.requirements == task.requirements
    assert COMMITTED.specification == task.specification


def test_it_meets_its_requirements(reached):
    assert [name for name, each in reached.items() if each.met is False] == []
    assert sum(each.met is True for each in reached.values()) == 8


def test_its_report_accepts_it_and_names_what_would_reject_it_first(reached, er24pc):
    wanted, rail = COMMITTED.requirements, load_rail(COMMITTED.rail)
    stop = Scenario.stop(from_kmh=120.0, rail=rail)
    own = trial(er24pc, controller_of(COMMITTED, er24pc, rail), stop, slip_reference=0.14)
    sound = {each.name: each for each in SOUND}

    def decided(judged, found=sound):
        return judged_drawn(wanted, tuple(judged), own, found)

    accepted = decided(reached.values())
    assert accepted.verdict == "accepted"
    assert accepted.weakest.name == "efficiency_mean"
    broken = {name: replace(each, status=Status.REFUTED) for name, each in sound.items()}
    assert decided(reached.values(), broken).missed[0].name == "sound"
    stricter = replace(reached["efficiency_worst"], limit=0.99, met=False)
    assert [each.name for each in decided((reached | {"efficiency_worst": stricter}).values()).missed] == [
        "efficiency_worst"
    ]


def test_without_releases_the_same_law_does_not(on_fewer_stops):
    """The fastest wheelset shows no speed where all slide, as on rails with very low adhesion."""
    sensors = replace(on_fewer_stops.specification.sensors, speed="fastest-axle", accelerometer=False)
    blind = replace(on_fewer_stops, specification=replace(on_fewer_stops.specification, sensors=sensors))
    found = judged(blind)
    assert found["speed_error"].met is False
    assert found["distance_error"].met is False
