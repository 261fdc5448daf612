"""``wspd design SPEC`` and ``wspd tune``: what they write, and what a killed search leaves."""

import json
import signal
import subprocess
import sys
import time

import pytest
from jsonschema import Draft202012Validator

from wspd_design.design.file import read_design
from wspd_design.exchange.files import read_schema

SPEC = """schema = "wspd-specification/1"
name = "small"
law = "torque-feedback"
vehicle = "er24pc"
sample_time = "100 ms"
[requirements]
rails = ["polach-dry"]
held_out = { sets = 16, seed = 9000 }
[requirements.limits]
efficiency_mean = "50 %"
[requirements.stop]
initial_speed = "30 km/h"
[requirements.draw]
vehicle.brake.max_torque = { uniform = ["45 kN m", "75 kN m"] }
[search]
evaluations = 14
sets = 16
seed = 1
"""
HELD = """
import time
from pathlib import Path
from wspd_design.cli import main
from wspd_design.design.search.journal import Journal

add = Journal.add

def hold(journal, *evaluation):
    if journal.path.read_bytes().count(b"\\n") >= LINES:
        Path("held").touch()
        time.sleep(600.0)
    add(journal, *evaluation)

Journal.add = hold
main()
"""


@pytest.fixture
def spec(tmp_path):
    path = tmp_path / "spec.toml"
    path.write_text(SPEC)
    return path


def test_a_design_with_its_record(wspd, spec, tmp_path):
    outcome = wspd("design", spec.name, "-o", "made.toml")
    assert (outcome.code, outcome.err) == (0, "")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["made.search.json", "made.toml", "spec.toml"]
    record = json.loads((tmp_path / "made.search.json").read_text())
    Draft202012Validator(read_schema("wspd-search/1")).validate(record)
    assert (record["evaluations"], len(record["points"])) == (14, 14)
    made = read_design(tmp_path / "made.toml")
    assert made.requirements.held_out.seed == record["held_out_sets"]["seed"] == 9000
    assert "met" in outcome.out
    assert "On 16 held-out sets of seed 9000, looked at once (polach-dry):" in outcome.out
    again = wspd("simulate", "made.toml", "--speed", "30 km/h", "--json")
    assert json.loads(again.out)["controller"] == made.name == "torque-feedback-small"


def test_a_missed_requirement_is_bad_news(wspd, spec):
    spec.write_text(SPEC.replace('"50 %"', '"99.9 %"'))
    outcome = wspd("design", spec.name)
    assert outcome.code == 1
    assert "missed" in outcome.out


def test_a_tuned_table_is_a_controller_that_says_its_effort(wspd, spec, tmp_path):
    outcome = wspd("tune", "knorr-bremse", spec.name)
    assert (outcome.code, outcome.err) == (0, "")
    file = "knorr-bremse-small-tuned.toml"
    made = read_design(tmp_path / file)
    assert (made.law, made.name) == ("knorr-bremse", "knorr-bremse (tuned, 14 evaluations)")
    compared = wspd("compare", file, "knorr-bremse", "--speed", "30 km/h", "--json")
    assert [each["controller"] for each in json.loads(compared.out)["stops"]] == [made.name, "knorr-bremse"]
    distances = [each["distance_m"] for each in json.loads(compared.out)["stops"]]
    assert distances[0] != distances[1]
    assert "tuned" in wspd("compare", file, "--speed", "30 km/h").out


def test_a_law_of_ones_own_is_tuned_beside_its_file(wspd, spec, tmp_path):
    (tmp_path / "band.py").write_text(
        """from dataclasses import dataclass
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where

@dataclass(frozen=True)
class Band:
    vehicle: object
    slip: float = 0.3
    width: float = 0.5
    sample_time: float = 0.1
    name: str = "band"

    def start(self, measurement):
        return ()

    def step(self, state, measurement):
        slide = measurement.speed - self.vehicle.wheel_radius * measurement.wheel_speed
        vent = where(slide > (1.0 + self.width) * self.slip * measurement.speed, 1.0, 0.0)
        fill = where(slide < (1.0 - self.width) * self.slip * measurement.speed, 1.0, 0.0)
        return state, Command(fill=fill, vent=vent)
"""
    )
    outcome = wspd("tune", "band.py:Band", spec.name)
    assert (outcome.code, outcome.err) == (0, "")
    assert "wspd simulate band_tuned.py:tuned" in outcome.out
    compared = wspd("compare", "band_tuned.py:tuned", "band.py:Band", "--speed", "30 km/h", "--json")
    names = [each["controller"] for each in json.loads(compared.out)["stops"]]
    assert names == ["band (tuned, 14 evaluations)", "band"]
    refused = wspd("tune", "band.py:Band", spec.name, "-o", "band.toml")
    assert (refused.code, refused.out) == (2, "")
    assert "band.toml must be a .py file beside band.py, from which it imports" in refused.err


def test_a_file_in_the_way_is_refused_before_anything_is_computed(wspd, spec, tmp_path):
    (tmp_path / "made.search.json").write_text("")
    outcome = wspd("design", spec.name, "-o", "made.toml")
    assert (outcome.code, outcome.out) == (2, "")
    assert outcome.err.startswith("wspd: made.search.json exists; ")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            ("design", "spec.toml", "--law", "smc"),
            "--law is stated by the specification spec.toml; leave it out",
        ),
        (("design", "er24pc-20m"), 'unknown specification "er24pc-20m"'),
        (("design", "nothing.toml"), "nothing.toml does not exist"),
        (("tune", "none", "spec.toml"), 'law "none" cannot be tuned'),
    ],
)
def test_wrong_use_is_one_sentence(wspd, spec, arguments, sentence):
    assert spec.exists()
    outcome = wspd(*arguments)
    assert (outcome.code, outcome.out) == (2, "")
    assert sentence in outcome.err
    assert outcome.err.count("\n") == 1


def held(folder, lines):
    """Start the search, and return it when its journal has that many lines and it waits for a signal."""
    process = subprocess.Popen(
        [sys.executable, "-c", HELD.replace("LINES", str(lines)), "design", "spec.toml", "-o", "made.toml"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    end = time.monotonic() + 120.0
    while not (folder / "held").exists():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.005)
    (folder / "held").unlink()
    return process


@pytest.mark.slow
def test_a_killed_search_goes_on_and_ends_as_a_whole_one(wspd, spec, tmp_path):
    spec.write_text(SPEC.replace("evaluations = 14", "evaluations = 24"))
    assert wspd("design", spec.name, "-o", "made.toml").code == 0
    whole = {name: (tmp_path / name).read_bytes() for name in ("made.toml", "made.search.json")}
    for name in whole:
        (tmp_path / name).unlink()
    journal = tmp_path / "made.search.journal"
    for lines in (3, 12):
        process = held(tmp_path, lines)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        assert process.returncode == -signal.SIGKILL
    process = held(tmp_path, 20)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, "")
    assert err == (
        "wspd: interrupted after 19 of 24 evaluations; they are in made.search.journal, and the same command goes on "
        "from there.\n"
    )
    assert wspd("design", spec.name, "-o", "made.toml").code == 0
    assert {name: (tmp_path / name).read_bytes() for name in whole} == whole
    assert not journal.exists()


def test_rules_alone_make_a_design_that_knows_its_requirements(wspd, spec, tmp_path):
    outcome = wspd("design", spec.name, "--rules-only", "-o", "made.toml")
    assert (outcome.code, outcome.err) == (0, "")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["made.toml", "spec.toml"]
    made = read_design(tmp_path / "made.toml")
    assert made.requirements.held_out.seed == 9000
    assert not any("searched" in gain.why for gain in made.gains)
    assert "--rules-only goes with a specification" in wspd("design", "--rules-only", "-o", "b.toml").err
