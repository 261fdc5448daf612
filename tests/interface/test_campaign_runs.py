"""Campaigns that are killed, interrupted or run out of space go on; every way of running gives the same bytes."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest
from jsonschema import Draft202012Validator

from wspd_design.exchange.files import read_schema

FILE = """
stops = 400
controllers = ["trenitalia"]
speed = "10 km/h"
seed = 3
within_bounds = ["vehicle", "rail"]

[draw]
stop.sensing.speed_noise = { uniform = ["0 m/s", "0.05 m/s"] }
"""
COMMAND = "import sys; from wspd_design.cli import main; main()"
HELD = """
import time
from pathlib import Path
from wspd_design.cli import main
from wspd_design.simulation.campaign_store import Store

write = Store.write

def hold(store, *chunk):
    if len(list(store.folder.glob("*.parquet"))) >= CHUNKS:
        Path("held").touch()
        time.sleep(600.0)
    write(store, *chunk)

Store.write = hold
main()
"""
LIMITED = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)); " + COMMAND


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "campaign.toml"
    path.write_text(FILE)
    return path


@pytest.fixture(scope="session")
def expected(tmp_path_factory):
    """Content of the table of the campaign by one thread."""
    from wspd_design.cli.app import run

    folder = tmp_path_factory.mktemp("expected")
    path = folder / "campaign.toml"
    path.write_text(FILE)
    assert run(["campaign", str(path), "--workers", "1", "-o", str(folder / "rows.parquet"), "--json"]) == 0
    return (folder / "rows.parquet").read_bytes()


def started(file, *options, command=COMMAND):
    return subprocess.Popen(
        [sys.executable, "-c", command, "campaign", file.name, *options],
        cwd=file.parent,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def held(file, chunks):
    """Start the campaign, and return it when that many chunks are in its store and it waits for a signal."""
    process = started(file, "--workers", "1", command=HELD.replace("CHUNKS", str(chunks)))
    wait(lambda: (file.parent / "held").exists(), process)
    (file.parent / "held").unlink()
    return process


def wait_for_chunks(store, count, process):
    wait(lambda: len(list(store.glob("*.parquet"))) >= count, process)


def wait(reached, process, limit=120.0):
    end = time.monotonic() + limit
    while not reached():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.005)


def resumed(wspd, file, expected, *options):
    outcome = wspd("campaign", file.name, "-o", "rows.parquet", "--force", *options)
    assert outcome.code == 0, outcome.err
    assert (file.parent / "rows.parquet").read_bytes() == expected
    return outcome


def test_kill_9_loses_no_finished_chunk(wspd, file, expected):
    store = file.with_suffix(".store")
    for chunks in (1, 2):
        process = held(file, chunks)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        assert process.returncode == -signal.SIGKILL
    kept = {path: path.stat().st_mtime_ns for path in store.glob("*.parquet")}
    assert len(kept) == 2
    resumed(wspd, file, expected)
    assert {path: path.stat().st_mtime_ns for path in kept} == kept  # read, not written again
    assert len(list(store.iterdir())) == 4


def test_ctrl_c_says_how_to_go_on(wspd, file, expected):
    process = held(file, 1)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert err.startswith("wspd: interrupted after ")
    assert err.endswith(
        " of 400 stops; they are in campaign.store, and the same command goes on from there.\n"
    )
    resumed(wspd, file, expected)


def test_a_full_disk_is_one_sentence(wspd, file, expected):
    """The system refuses to write more than 20 kB to a file, as a full disk does."""
    wspd("campaign", file.name, "--shard", "1/4")  # compiles, so that only the store has to write
    store = file.with_suffix(".store")
    before = sorted(store.iterdir())
    process = started(file, command=LIMITED)
    out, err = process.communicate(timeout=120)
    assert (process.returncode, out) == (2, "")
    assert err.startswith("wspd: campaign.store/")
    assert err.endswith("cannot be written (File too large); free some space.\n")
    assert err.count("\n") == 1
    assert sorted(store.iterdir()) == before
    resumed(wspd, file, expected)


def test_parts_and_processes_give_the_same_bytes(wspd, file, expected):
    for part in ("2/3", "3/3"):
        outcome = wspd("campaign", file.name, "--executor", "processes", "--workers", "2", "--shard", part)
        assert (outcome.code, outcome.err) == (0, "")
    assert len(list(file.with_suffix(".store").iterdir())) == 3
    resumed(wspd, file, expected, "--workers", "8")


@pytest.mark.slow
def test_a_dask_cluster_that_loses_a_worker_gives_the_same_bytes(wspd, file, expected):
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        process = started(file, "--executor", "dask", "--scheduler", cluster.scheduler_address)
        wait_for_chunks(file.with_suffix(".store"), 1, process)
        victim = next(iter(client.run(os.getpid).values()))
        os.kill(victim, signal.SIGKILL)
        out, err = process.communicate(timeout=180)
        assert process.returncode == 0, err
        assert "400 stops of trenitalia" in out
        assert victim not in client.run(os.getpid).values()
    resumed(wspd, file, expected)


@pytest.mark.slow
def test_a_local_dask_cluster_needs_no_address(wspd, file, expected):
    pytest.importorskip("distributed")
    resumed(wspd, file, expected, "--executor", "dask", "--workers", "2")


def test_a_lost_process_is_told(wspd, file, expected, monkeypatch):
    """A worker process that dies breaks the pool; what is done stays."""
    from wspd_design.cli import executors

    monkeypatch.setattr(executors, "_leave_interrupts", _die)
    outcome = wspd("campaign", file.name, "--executor", "processes", "--workers", "1")
    assert outcome.code == 2
    assert "a worker of the campaign was lost" in outcome.err
    assert "the same command goes on from there" in outcome.err
    monkeypatch.undo()
    os.chdir(file.parent)
    resumed(wspd, file, expected)


def _die():
    os._exit(1)


def test_several_laws_and_rails_in_one_table_and_one_object(wspd, tmp_path):
    (tmp_path / "c.toml").write_text(
        'stops = 3\ncontrollers = ["none", "afsmc"]\nrails = ["polach-wet", "polach-dry"]\nspeed = "10 km/h"\n'
        '[draw]\n"vehicle.mass" = { uniform = ["70 t", "80 t"] }\n'
    )
    outcome = wspd("campaign", "c.toml", "-o", "rows.csv", "--json")
    assert (outcome.code, outcome.err) == (0, "")
    found = json.loads(outcome.out)
    Draft202012Validator(read_schema("wspd-campaigns/1")).validate(found)
    assert [(each["controller"], each["rail"]) for each in found["campaigns"]] == [
        ("none", "polach-wet"),
        ("none", "polach-dry"),
        ("afsmc", "polach-wet"),
        ("afsmc", "polach-dry"),
    ]
    assert found["campaigns"][0]["step_checks"]["rows"] == 1
    lines = (tmp_path / "rows.csv").read_text().splitlines()
    assert lines[0].startswith("controller,rail,run,seed,vehicle.mass_kg,distance_m,")
    rows = [line.split(",") for line in lines[1:]]
    assert [row[:3] for row in rows[2:5]] == [
        ["none", "polach-wet", "2"],
        ["none", "polach-dry", "0"],
        ["none", "polach-dry", "1"],
    ]
    masses = [row[4] for row in rows]
    assert masses[:3] == masses[3:6] == masses[6:9] == masses[9:]  # stop by stop the same train
    assert len(set(masses)) == 3


BASE = 'stops = 2\nspeed = "10 km/h"\n'


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "campaign.toml does not say how many stops; add a line such as stops = 1000"),
        ("stops = 0", "stops = 0 in campaign.toml must be at least 1"),
        ('stops = "many"', "stops = 'many' in campaign.toml must be a whole number"),
        ("stops = 1\nspede = 3", 'unknown key in campaign.toml: "spede" (did you mean "speed"?)'),
        (BASE + "controllers = []", "controllers = [] in campaign.toml must name one or more"),
        (BASE + 'rails = ["polach-wet", "polach-wet"]', "each once"),
        (BASE + 'rails = "polach-wet"', "must be a list of texts"),
        (BASE + 'rails = ["polach-wett"]', 'unknown rail "polach-wett" (did you mean "polach-wet"?)'),
        (BASE + 'within_bounds = ["stop"]', 'names "stop"; it may name vehicle and rail'),
        (BASE + "draw = 3", "draw = 3 in campaign.toml must be a table; write [draw]"),
        (BASE + "[disturbances]\ngrad = 3", 'did you mean "grade"?'),
        (BASE + "[disturbances]\ngrade = 3", "grade = 3 in campaign.toml must be text with its unit"),
        (BASE + '[disturbances]\ngrade = "3 m"', 'grade "3 m" is not a number'),
        (
            BASE + "[draw]\nvehicle.mass = 3",
            "vehicle.mass of [draw] in campaign.toml must be one of { uniform",
        ),
        (BASE + '[draw]\nvehicle.mass = { uniform = ["70 t"] }', "must be a list of 2 quantities"),
        (BASE + '[draw]\nvehicle.mass = { uniform = ["70 t", "80 m"] }', "has a unit of length, not of mass"),
        (BASE + '[draw]\nvehicle.mass = { uniform = [70, "80 t"] }', "must be text with its unit"),
        (BASE + '[draw]\nvehicle.mass = { uniform = ["80 t", "70 t"] }', "the first below the second"),
        (BASE + '[draw]\nvehicle.mas = { uniform = ["1 %", "2 %"] }', 'did you mean "vehicle.mass"?'),
        (BASE + '[draw]\nvehicle.mass = { normal = ["75 t", "2 t"] }', "within of vehicle.mass of [draw]"),
        (
            BASE + '[draw]\nrail.mu0 = { uniform = ["0.1", "0.2"], within = ["0", "1"] }',
            'unknown key "within"',
        ),
        (
            BASE + '[draw]\nstop.sensing.dead_time = { uniform = ["0 s", "-1 s"] }',
            "the first below the second",
        ),
    ],
)
def test_a_wrong_file_is_one_sentence_and_makes_nothing(wspd, file, text, sentence):
    file.write_text(text)
    outcome = wspd("campaign", file.name)
    assert (outcome.code, outcome.out) == (2, "")
    assert sentence in outcome.err
    assert outcome.err.count("\n") == 1
    assert list(file.parent.iterdir()) == [file]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--shard", "0/3"), '--shard "0/3" must be I/N with I from 1 to N'),
        (("--shard", "4/3"), '--shard "4/3" must be'),
        (("--shard", "half"), '--shard "half" must be'),
        (("--shard", "1/100"), '--shard "1/100" is empty: 400 stops have fewer chunks than parts'),
        (("--executor", "gpu"), 'unknown executor "gpu"; available: threads, processes, dask'),
        (("--scheduler", "tcp://x:1"), "--scheduler is about Dask; add --executor dask"),
        (
            ("--executor", "dask", "--scheduler", "tcp://x:1", "--workers", "2"),
            "--workers is about this machine",
        ),
        (("-o", "rows.txt"), "rows.txt must end in .csv, .parquet or .mat"),
        (("--store", "no/store"), "the store no/store cannot be made"),
    ],
)
def test_wrong_options_are_one_sentence(wspd, file, options, sentence):
    outcome = wspd("campaign", file.name, *options)
    assert (outcome.code, outcome.out) == (2, "")
    assert sentence in outcome.err
    assert outcome.err.count("\n") == 1


def test_a_law_of_a_file_runs_with_threads_alone(wspd, tmp_path):
    (tmp_path / "mine.py").write_text(
        "from wspd_design import Command\n\n\nclass Mine:\n    name, sample_time = 'mine', 0.1\n\n"
        "    def start(self, measurement):\n        return ()\n\n"
        "    def step(self, state, measurement):\n        return (), Command(fill=0.9, vent=0.0)\n"
    )
    (tmp_path / "c.toml").write_text('stops = 2\ncontrollers = ["mine.py:Mine"]\nspeed = "10 km/h"\n')
    assert wspd("campaign", "c.toml").code == 0
    outcome = wspd("campaign", "c.toml", "--executor", "processes", "--store", "other")
    assert outcome.code == 2
    assert "controller mine comes from a file that other processes do not import" in outcome.err
