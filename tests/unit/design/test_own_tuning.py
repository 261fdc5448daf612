"""Tuning a law from a Python file: what varies, and the file that comes out."""

import pytest

from wspd_design.design.finding import find
from wspd_design.design.own_controller import load_controller
from wspd_design.design.own_tuning import own_space, tuned_source
from wspd_design.design.specification_file import read_task
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail

LAW = """
from dataclasses import dataclass
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where

COUNT = 0

@dataclass(frozen=True)
class Band:
    vehicle: object
    slip: float
    sample_time: float = 0.02
    width: float = 0.3
    turns: int = 3
    name: str = "band"

    def start(self, measurement):
        return ()

    def step(self, state, measurement):
        slide = measurement.speed - self.vehicle.wheel_radius * measurement.wheel_speed
        vent = where(slide > (1.0 + self.width) * self.slip * measurement.speed, 1.0, 0.0)
        fill = where(slide < (1.0 - self.width) * self.slip * measurement.speed, 1.0, 0.0)
        return state, Command(fill=fill, vent=vent)

def fixed():
    return Band(None, 0.1)

made = Band(type("V", (), {"wheel_radius": 0.5})(), 0.1)
"""
SPEC = """schema = "wspd-specification/1"
name = "small"
law = "afsmc"
vehicle = "er24pc"
sample_time = "50 ms"
[requirements]
rails = ["polach-dry"]
held_out = { sets = 4, seed = 9000 }
limits = {}
stop = { initial_speed = "30 km/h" }
[search]
evaluations = 12
sets = 4
seed = 1
"""


@pytest.fixture
def rail():
    return load_rail("polach-dry")


@pytest.fixture
def task(tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)
    (tmp_path / "band.py").write_text(LAW)
    return read_task(str(tmp_path / "spec.toml"))


def test_what_varies_are_the_slip_and_numbers_with_a_default(task, er24pc, rail, tmp_path):
    space, own = own_space(f"{tmp_path}/band.py:Band", task, er24pc, rail)
    assert own.numbers == {"slip": 0.14, "width": 0.3}
    assert [(each.name, each.start) for each in space.variables] == [("width", 0.3), ("slip", 0.14)]
    law = space.build((0.5, 0.2))
    assert (law.width, law.slip, law.sample_time, law.turns) == (0.5, 0.2, 0.05, 3)


def test_the_file_makes_the_law_that_was_found(task, er24pc, rail, tmp_path):
    name = f"{tmp_path}/band.py:Band"
    space, own = own_space(name, task, er24pc, rail)
    found = find(task, space, keep=False, journal=tmp_path / "journal")
    assert found.chosen.score.objective < found.tried[0].score.objective
    (tmp_path / "band_tuned.py").write_text(tuned_source(name, "band (tuned)", own, found))
    law = load_controller(f"{tmp_path}/band_tuned.py:tuned", vehicle=er24pc, rail=rail, sample_time=0.05)
    assert law.name == "band (tuned)"
    assert (law.width, law.slip) == found.chosen.values
    other = load_controller(f"{tmp_path}/band_tuned.py:tuned", vehicle=er24pc, rail=rail, slip=0.3)
    assert other.slip == 0.3  # an option goes before


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("made", "has no numbers to vary; let NAME be a class or function"),
        ("fixed", "has no numbers to vary; give its parameters numbers above 0 as defaults"),
        ("COUNT", "has no numbers to vary"),
    ],
)
def test_what_cannot_vary_is_told(task, er24pc, rail, tmp_path, name, sentence):
    with pytest.raises(UserError, match=sentence):
        own_space(f"{tmp_path}/band.py:{name}", task, er24pc, rail)


def test_a_law_with_another_sample_time_is_refused(task, er24pc, rail, tmp_path):
    (tmp_path / "band.py").write_text(
        LAW.replace("sample_time: float = 0.02", "period: float = 0.02").replace(
            "    def start", "    sample_time = 0.02\n\n    def start", 1
        )
    )
    with pytest.raises(
        UserError, match=r"has a sample time of 0\.02 s, small one of 0\.05 s; let it take sample_time"
    ):
        own_space(f"{tmp_path}/band.py:Band", task, er24pc, rail)


def test_a_file_that_no_other_can_import_is_refused(task, er24pc, rail, tmp_path):
    (tmp_path / "my-band.py").write_text(LAW)
    with pytest.raises(UserError, match=r"cannot be imported .*; rename it to a Python name"):
        own_space(f"{tmp_path}/my-band.py:Band", task, er24pc, rail)
