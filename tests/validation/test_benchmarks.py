"""``make bench`` in a tiny form: every benchmark runs, all ways give the same stop, and the page has the same rows."""

import ast
import math
import re
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest

from wspd_design.cli.lazy import COMMANDS
from wspd_design.parameters.loading import load_vehicle

FOLDER = Path(__file__).parents[2] / "benchmarks"
ROOMS = ("case", "locomotive", "proofs", "references", "rows", "run")
COMMAND = re.compile(r"sys\.exit\(run\((\[.*?\])\)")


def quick(vehicle):
    """Return the vehicle with a supply that is full in an eighth of the time."""
    return replace(vehicle, brake=replace(vehicle.brake, supply_rate=8.0 * vehicle.brake.supply_rate))


@pytest.fixture
def rooms(monkeypatch):
    """Load the benchmarks with a stop from walking pace, one round, and a small multibody vehicle."""
    monkeypatch.syspath_prepend(FOLDER)
    for name in ROOMS:
        monkeypatch.delitem(sys.modules, name, raising=False)
    case = import_module("case")
    case.SPEED, case.SAMPLE_TIME = 1.0 / 3.6, 0.1
    case.VEHICLE = quick(case.VEHICLE)
    case.LAW = case.controller(
        "afsmc", case.VEHICLE, case.RAIL, case.Specification(sample_time=case.SAMPLE_TIME)
    )
    loaded = {name: import_module(name) for name in ROOMS}
    run, locomotive = loaded["run"], loaded["locomotive"]
    run.ROUNDS = run.QUICK = loaded["proofs"].ROUNDS = 1
    run.SHORT, run.CAMPAIGN, run.FREE = 0.1, 32, math.inf
    loaded["references"].NEAR_ROUNDING = {"rtol": 1e-9, "atol": 1e-9}
    locomotive.VEHICLE, locomotive.SHORT = quick(load_vehicle("two-axle-wagon")), 0.1
    locomotive.CASES = tuple(
        (*case[:2], 1, case[3]) for case in locomotive.CASES
    )  # one kind of loop for each plant
    yield loaded
    for name in ROOMS:
        sys.modules.pop(name, None)


def here(*command, **_environment):
    """Do in this process what a benchmark starts: code of Python runs, commands of wspd are parsed."""
    if command[1] == "-c":
        called = COMMAND.search(command[2])
        if called is None:
            exec(command[2], {})  # code of the benchmarks
        else:
            name, *words = ast.literal_eval(called[1])
            COMMANDS[name].load(name).make_context(name, words)
    return 1.0


def rows(page):
    """Return first cells of the table, without their numbers and how many stops of the locomotive ran side by side."""
    cells = [line.split(" | ")[0] for line in page.splitlines() if line.startswith("| ")]
    return [re.sub(r"\d+", "N", re.sub(r", \d+ stops side by side", "", cell)) for cell in cells]


@pytest.mark.slow
def test_all_benchmarks_run_and_their_ways_give_the_same_stop(rooms, monkeypatch, tmp_path):
    run = rooms["run"]
    for name in ("run", "proofs"):
        monkeypatch.setattr(rooms[name], "process_cpu", here)
    written = run.PAGE.read_text()
    monkeypatch.setattr(run, "PAGE", tmp_path / "benchmarks.md")
    assert run.main() in (0, 1)  # the goals are about the whole stop on a free machine
    page = run.PAGE.read_text()
    assert rows(page) == rows(written)
    errors = [tuple(map(float, pair)) for pair in re.findall(r"errors .*?(\de-\d+) and (\de-\d+)", page)]
    assert len(errors) == 3
    assert all(own < 2e-5 and other < 1e-7 for own, other in errors)  # in steps of up to 5 ms at walking pace


def test_a_command_that_a_benchmark_gets_wrong_is_seen():
    with pytest.raises(Exception, match="No such option"):
        here("python", "-c", "sys.exit(run(['certify', 'design.toml', '--froce']) not in (0, 1, 3))")
    with pytest.raises(ImportError):
        here("python", "-c", "from wspd_design.simulation.stop import simulated")
