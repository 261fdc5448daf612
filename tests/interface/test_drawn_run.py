"""``wspd simulate --only-run``: one of many stops alone, and the worst set of a report again by its command."""

import csv
import json
import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.report_call import ReportCall
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.exchange.columns import with_unit
from wspd_design.parameters.loading import load_entries
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.records import Scenario, Sensing
from wspd_design.studies.uncertainty import uncertainty

CASE = ("smc", "--rail", "polach-dry", "--speed", "30 km/h", "--seed", "4", "--dead-time", "20 ms")


def only_object(outcome):
    assert (outcome.code, outcome.err) == (0, "")
    return json.loads(outcome.out)


def test_it_is_that_row_of_the_table(wspd):
    assert wspd("simulate", *CASE, "--runs", "3", "-o", "rows.csv").code == 0
    with open("rows.csv", newline="") as stream:
        row = list(csv.DictReader(stream))[2]
    alone = only_object(wspd("simulate", *CASE, "--only-run", "2", "--json"))
    assert alone["drawn"] == {name: float(row[with_unit(name)]) for name in alone["drawn"]}
    assert alone["distance_m"] == pytest.approx(float(row["distance_m"]), rel=1e-4)
    assert alone["seed"] == int(row["seed"]) == 6
    assert only_object(wspd("simulate", *CASE, "--json"))["drawn"] is None


def test_it_says_which_numbers_it_draws(wspd):
    shown = " ".join(wspd("simulate", *CASE, "--only-run", "0").out.split())
    assert shown.startswith("Run 0 draws vehicle.mass ")
    assert "vehicle.wheel_radius 5" in shown
    assert "mm" in shown


@pytest.mark.parametrize(("other", "words"), [("--runs", "3"), ("--from-witness", "w.json")])
def test_it_stands_alone(wspd, other, words):
    outcome = wspd("simulate", "--only-run", "0", other, words)
    assert outcome.code == 2
    assert f"leave {other} out" in outcome.err


def test_exact_numbers_are_not_drawn(wspd):
    Path("rail.toml").write_text(
        'base = "polach-wet"\n'
        + "".join(
            f'[{name}]\nvalue = {entry.value}\nunit = "{"s/m" if name == "friction_decay" else "-"}"\n'
            'source = "own"\nat = "here"\nstatus = "assumed"\n'
            for name, entry in load_entries("rail", "polach-wet").entries.items()
        )
    )
    drawn = only_object(
        wspd("simulate", "smc", "--rail", "rail.toml", "--speed", "20 km/h", "--only-run", "0", "--json")
    )
    assert not [name for name in drawn["drawn"] if name.startswith("rail.")]


def test_the_command_of_the_worst_set_gives_its_number(wspd):
    """What a report prints, a reader can run: the same digits."""
    call = ReportCall(
        law="smc",
        vehicle="er24pc",
        rail="polach-dry",
        speed="30 km/h",
        seed=4,
        template="template.toml",
        disturbances=StopOptions(dead_time="20 ms"),
    )
    assert "template" in call.text
    assert "template" not in call.simulation
    case = load_case("smc", CaseOptions(rail="polach-dry"))
    start = Scenario.stop(from_kmh=30.0, rail=case.rail, seed=4)
    stop = replace(start, sensing=Sensing(dead_time=0.02))
    nominal = trial(case.vehicle, case.controller, stop, slip_reference=case.specification.slip)
    found = uncertainty(
        case.vehicle,
        case.controller,
        stop,
        nominal,
        slip_reference=case.specification.slip,
        parameters=(load_entries("vehicle", "er24pc"), load_entries("rail", "polach-dry")),
        laden=None,
        plant="planar",
        command=call.simulation,
        sets=16,
    )
    keys = {"distance": "distance_m", "efficiency": "efficiency", "slip_rms": "slip_rms"}
    for name, key in keys.items():
        worst = found.spread_of(name).worst
        program, *words = shlex.split(worst.command)
        again = only_object(wspd(*words, "--json"))
        assert program == "wspd"
        assert again[key] == worst.value
        assert again["drawn"] == dict(worst.parameters)
