"""The protection of the demo: it meets the requirements of its specification, and a planted fault does not."""

from dataclasses import replace
from pathlib import Path

import pytest

from wspd_design.design.file import read_design
from wspd_design.design.judging import judge
from wspd_design.design.specification_file import read_task
from wspd_design.parameters.loading import load_rail

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


def test_the_design_was_made_for_the_specification_beside_it():
    task = read_task(str(FOLDER / "specification.toml"))
    assert COMMITTED.requirements == task.requirements
    assert COMMITTED.specification == task.specification


def test_it_meets_its_requirements():
    found = judged(COMMITTED)
    assert [name for name, each in found.items() if each.met is False] == []
    assert sum(each.met is True for each in found.values()) == 8


def test_without_releases_the_same_law_does_not(on_fewer_stops):
    """The fastest wheelset shows no speed where all slide, as on rails with very low adhesion."""
    sensors = replace(on_fewer_stops.specification.sensors, speed="fastest-axle", accelerometer=False)
    blind = replace(on_fewer_stops, specification=replace(on_fewer_stops.specification, sensors=sensors))
    found = judged(blind)
    assert found["speed_error"].met is False
    assert found["distance_error"].met is False
