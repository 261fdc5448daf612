"""Limits on drawn stops: kept, missed and wrongly asked for; the stops are those of the command."""

import csv
from dataclasses import replace
from pathlib import Path

import pytest

from wspd_design.cli.app import run
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.parameters.errors import UserError
from wspd_design.simulation.campaign import simulate_many
from wspd_design.testing import assert_stops
from wspd_design.testing.stops import longest_locks

FEW = {"runs": 6, "seed": 3, "speed": "40 km/h", "rail": "polach-dry"}


def test_the_stops_are_those_of_the_command(tmp_path):
    rows = tmp_path / "rows.csv"
    words = ["--runs", "6", "--seed", "3", "--speed", "40 km/h", "--rail", "polach-dry", "-o", str(rows)]
    assert run(["simulate", "none", *words]) == 0
    with rows.open(newline="") as file:
        wanted = [float(row["distance_m"]) for row in csv.DictReader(file)]
    found = assert_stops("none", within="10 km", **FEW)
    assert found.table["distance_m"].tolist() == wanted


def test_a_missed_distance_names_the_worst_run_and_a_command_that_shows_it(capsys):
    with pytest.raises(AssertionError) as failure:
        assert_stops("none", within="20 m", **FEW)
    head, first, *_, last = str(failure.value).splitlines()
    assert head == "6 of 6 drawn stops of none on polach-dry miss 20 m of distance"
    number = first.split()[1].removesuffix(":")
    assert last.strip() == (
        f"see the first one: wspd simulate none --rail polach-dry --speed '40 km/h' --seed 3 --only-run {number}"
    )
    capsys.readouterr()
    words = ["--rail", "polach-dry", "--speed", "40 km/h", "--seed", "3", "--only-run", number]
    assert run(["simulate", "none", *words]) == 0
    assert first.split()[2] in capsys.readouterr().out


def test_locked_wheels_are_seen():
    """Without a protection the wheels lock on the wet rail; 10 km/h is where locks stop to count."""
    words = FEW | {"rail": "low-adhesion"}
    with pytest.raises(AssertionError, match=r"miss 0\.5 s of a locked wheel"):
        assert_stops("none", locked_below="0.5 s", **words)
    found = assert_stops("none", locked_below="60 s", **words)
    assert longest_locks(found).max() > 0.5


def test_a_lock_of_just_the_limit_is_not_below_it():
    words = FEW | {"rail": "low-adhesion", "runs": 1}
    longest = float(longest_locks(assert_stops("none", within="10 km", **words)).max())
    with pytest.raises(AssertionError):
        assert_stops("none", locked_below=f"{longest!r} s", **words)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({}, "no limit is given"),
        ({"within": "900"}, "within"),
        ({"within": 900.0}, "must be text with a unit"),
        ({"within": "900 s"}, "900 s"),
        ({"locked_below": "-1 s"}, "must be above 0"),
        ({"within": "nan m"}, "within"),
        ({"within": "1 km", "runs": 0}, "must be at least 1"),
        ({"within": "1 km", "rail": "polach-wte"}, "polach-wet"),
        ({"within": "1 km", "speed": "40"}, "no unit"),
    ],
)
def test_what_is_refused(asked, words):
    with pytest.raises(UserError, match=words):
        assert_stops("none", **asked)


def test_the_default_speed_is_the_top_of_the_range_of_the_design():
    assert load_case("none", CaseOptions()).specification.speeds[1] == pytest.approx(120 / 3.6)
    found = assert_stops(Path("none"), within="10 km", runs=1)
    assert found.table["distance_m"][0] > 300.0


def test_interrupted_stops_keep_no_limit(monkeypatch):
    def interrupted(*arguments, **options):
        return replace(simulate_many(*arguments, **options), complete=False)

    monkeypatch.setattr("wspd_design.testing.stops.simulate_many", interrupted)
    with pytest.raises(KeyboardInterrupt):
        assert_stops("trenitalia", within="9 km", runs=1, speed="20 km/h")
