"""The protection of the demo: its rules meet the requirements of its specification, and a planted fault does not."""

from dataclasses import replace
from pathlib import Path

import pytest

from wspd_design.design.file import read_design
from wspd_design.design.judging import judge
from wspd_design.parameters.loading import load_rail

FOLDER = Path(__file__).parents[2] / "reports" / "protection-polach-wet"
STOPS = 48  # the first of the held-out ones: the report judges all


@pytest.fixture
def protection(wspd, tmp_path):
    arguments = ("design", str(FOLDER / "specification.toml"), "--rules-only", "-o", "made.toml")
    assert wspd(*arguments).code == 0
    made = read_design(tmp_path / "made.toml")
    held_out = replace(made.requirements.held_out, sets=STOPS)
    return replace(made, requirements=replace(made.requirements, held_out=held_out))


def judged(design):
    return {each.requirement: each for each in judge(design, load_rail(design.rail))}


def test_the_committed_design_is_that_of_the_rules(protection):
    committed = read_design(FOLDER / "design.toml")
    assert {gain.name: gain.value for gain in committed.gains} == pytest.approx(
        {gain.name: gain.value for gain in protection.gains}
    )
    assert committed.specification == protection.specification


def test_it_meets_its_requirements(protection):
    found = judged(protection)
    assert [name for name, each in found.items() if each.met is False] == []
    assert sum(each.met is True for each in found.values()) == 8


def test_without_releases_the_same_law_does_not(protection):
    """The fastest wheelset shows no speed where all slide, as on rails with very low adhesion."""
    sensors = replace(protection.specification.sensors, speed="fastest-axle", accelerometer=False)
    blind = replace(protection, specification=replace(protection.specification, sensors=sensors))
    found = judged(blind)
    assert found["speed_error"].met is False
    assert found["distance_error"].met is False
