"""Many stops in one command: the rows, their spread, and what an interrupt keeps."""

import csv
import json
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.cli import campaign as command
from wspd_design.cli.console import progress_bar
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.exchange.columns import with_unit
from wspd_design.parameters.files import load_entries
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.draws import within_bounds
from wspd_design.simulation.records import Scenario

SLOW = ("--speed", "20 km/h")


def rows(path):
    with path.open() as stream:
        return list(csv.DictReader(stream))


def test_rows_are_those_of_the_package(wspd, tmp_path):
    outcome = wspd("simulate", "trenitalia", *SLOW, "--runs", "24", "--seed", "7", "-o", "rows.csv")
    assert (outcome.code, outcome.err) == (0, "")
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-wet")
    table = simulate_many(
        vehicle,
        controller("trenitalia", vehicle, rail, Specification()),
        Scenario(rail=rail, initial_speed=20.0 / 3.6, seed=7),
        count=24,
        draws=within_bounds(load_entries("vehicle", "er24pc"), load_entries("rail", "polach-wet")),
    ).table
    found = rows(tmp_path / "rows.csv")
    assert list(found[0]) == [with_unit(name) for name in table.dtype.names]
    for name in ("vehicle.mass", "rail.mu0", "distance_m", "lock_time_s"):
        assert [float(row[with_unit(name)]) for row in found] == table[name].tolist()
    assert "vehicle.mass_kg" in found[0]
    assert f"{np.median(table['distance_m']):.2f}" in outcome.out
    assert f"{table['distance_m'].max():.2f}" in outcome.out
    assert "Not stopped within the time limit: 0 %" in outcome.out
    assert "vehicle.mass" in outcome.out


def test_parquet(wspd, tmp_path):
    duckdb = pytest.importorskip("duckdb")
    wspd("simulate", "none", *SLOW, "--runs", "17", "-o", "rows.csv")
    assert wspd("simulate", "none", *SLOW, "--runs", "17", "-o", "rows.parquet").code == 0
    with duckdb.connect() as database:
        found = database.from_parquet(str(tmp_path / "rows.parquet")).fetchnumpy()
    expected = [float(row["distance_m"]) for row in rows(tmp_path / "rows.csv")]
    assert found["distance_m"].tolist() == expected


def test_nominal_draws_seeds_only(wspd, tmp_path):
    noisy = ("--speed-noise", "0.1 m/s")
    outcome = wspd("simulate", "trenitalia", *SLOW, *noisy, "--runs", "8", "--nominal", "-o", "rows.csv")
    found = rows(tmp_path / "rows.csv")
    assert list(found[0])[:3] == ["run", "seed", "distance_m"]
    assert len({row["distance_m"] for row in found}) > 1
    assert "All stops are the same" not in outcome.out
    assert "All stops are the same" in wspd("simulate", "none", *SLOW, "--runs", "2", "--nominal").out


def test_rails_of_single_axles_are_not_drawn(wspd):
    rails = "polach-wet,polach-wet,polach-dry,polach-dry"
    outcome = wspd("simulate", "none", *SLOW, "--axle-rails", rails, "--runs", "2", "--json")
    sampled = json.loads(outcome.out)["sampled"]
    assert "vehicle.mass" in sampled
    assert not [name for name in sampled if name.startswith("rail.")]


@pytest.fixture
def interrupt_after(monkeypatch):
    """Press Ctrl-C when so many stops are done."""

    def plant(count):
        @contextmanager
        def bar(_what, _total):
            def tell(done):
                if done >= count:
                    raise KeyboardInterrupt

            yield tell

        monkeypatch.setattr(command, "progress_bar", bar)

    return plant


def test_an_interrupt_keeps_what_is_done(wspd, tmp_path, interrupt_after):
    interrupt_after(20)
    outcome = wspd("simulate", "none", *SLOW, "--runs", "500", "-o", "rows.csv")
    done = len(rows(tmp_path / "rows.csv"))
    assert 20 <= done < 500
    assert outcome.code == 130
    assert outcome.err == f"wspd: interrupted after {done} of 500 stops; they are in rows.csv.\n"
    assert f"{done} stops of none" in outcome.out


def test_with_a_store_the_same_command_goes_on(wspd, tmp_path, interrupt_after, monkeypatch):
    words = ("simulate", "none", *SLOW, "--runs", "300", "-o", "rows.csv", "--store", "kept")
    interrupt_after(20)
    left = wspd(*words)
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "kept").iterdir()}
    assert 1 <= len(kept) < 3
    assert (left.code, "rows.csv" in left.err) == (130, False)
    assert left.err.endswith("of 300 stops; they are in kept, and the same command goes on from there.\n")
    assert not (tmp_path / "rows.csv").exists()  # which the same command would refuse to replace
    monkeypatch.setattr(command, "progress_bar", progress_bar)
    assert wspd(*words).code == 0
    assert {path: path.stat().st_mtime_ns for path in kept} == kept  # read, not simulated again
    assert wspd("simulate", "none", *SLOW, "--runs", "300", "-o", "anew.csv").code == 0
    assert (tmp_path / "rows.csv").read_bytes() == (tmp_path / "anew.csv").read_bytes()


def test_a_store_is_for_many_stops(wspd):
    outcome = wspd("simulate", "none", *SLOW, "--store", "kept")
    assert (outcome.code, outcome.err) == (
        2,
        "wspd: --store keeps many stops; add --runs, for example --runs 1000.\n",
    )


def test_an_interrupt_leaves_json_clean(wspd, interrupt_after):
    interrupt_after(1)
    outcome = wspd("simulate", "none", *SLOW, "--runs", "500", "--json")
    found = json.loads(outcome.out)
    assert outcome.code == 130
    assert (found["complete"], found["runs_wanted"]) == (False, 500)
    assert found["runs"] < 500


def test_an_interrupt_before_the_first_stop_writes_nothing(wspd, tmp_path, monkeypatch):
    def early(*arguments, **options):
        done = simulate_many(*arguments, **options | {"count": 1})
        return replace(done, table=done.table[:0], complete=False)

    monkeypatch.setattr(command, "simulate_many", early)
    outcome = wspd("simulate", "none", *SLOW, "--runs", "9", "-o", "rows.csv")
    assert (outcome.code, outcome.out) == (130, "")
    assert outcome.err == "wspd: interrupted after 0 of 9 stops.\n"
    assert list(tmp_path.iterdir()) == []
