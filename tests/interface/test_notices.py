"""Notices of the engine reach the user as one plain line, and never the standard output."""

import json
import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from wspd_design.cli.notices import plain_notices

SLOW = ("--speed", "10 km/h")
UNTRACEABLE = """
class Branching:
    name = "branching"
    sample_time = 0.1

    def start(self, measurement):
        return ()

    def step(self, state, measurement):
        from wspd_design.controllers.protocol import Command

        return state, Command(1.0, 0.0) if measurement.speed > 1.0 else Command(0.0, 1.0)
"""


WITHOUT_ZIGLANG = "import sys; sys.modules['ziglang'] = None"


def run(folder, *arguments, before="", **environment):
    return subprocess.run(
        [sys.executable, "-c", f"{before}\nfrom wspd_design.cli import main; main()", *arguments],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])} | environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_without_a_compiler_the_numbers_are_the_same(tmp_path):
    compiled = run(tmp_path, "simulate", "trenitalia", *SLOW, "--json")
    hidden = {"PATH": "/nonexistent", "CC": "", "before": WITHOUT_ZIGLANG}
    virtual = run(tmp_path, "simulate", "trenitalia", *SLOW, "--json", **hidden)
    assert (compiled.stderr, virtual.returncode) == ("", 0)
    assert virtual.stderr.startswith("wspd: no C compiler")
    assert virtual.stderr.count("\n") == 1
    found, expected = json.loads(virtual.stdout), json.loads(compiled.stdout)
    assert (expected["engine"], found["engine"]) == ("compiled", "CasADi virtual machine")
    assert found["distance_m"] == pytest.approx(expected["distance_m"], rel=1e-9)


def test_a_controller_that_cannot_be_traced_is_told_once(wspd, tmp_path):
    (tmp_path / "own.py").write_text(UNTRACEABLE)
    outcome = wspd("compare", "own.py:Branching", "none", *SLOW, "--json")
    assert outcome.code == 0
    assert outcome.err.startswith("wspd: controller branching")
    assert "runs in Python" in outcome.err
    assert outcome.err.count("\n") == 1
    branching, unprotected = json.loads(outcome.out)["stops"]
    assert branching["engine"] == "compiled plant, controller in Python"
    assert unprotected["engine"] == "compiled"


def test_many_stops_tell_it_once(wspd, tmp_path):
    (tmp_path / "own.py").write_text(UNTRACEABLE)
    outcome = wspd("simulate", "own.py:Branching", *SLOW, "--runs", "3")
    assert outcome.code == 0
    assert outcome.err.count("\n") == 1


def test_other_warnings_stay_what_they_are():
    """Also inside a command, where pytest makes them errors."""
    with plain_notices(), pytest.raises(DeprecationWarning):
        warnings.warn("old", DeprecationWarning, stacklevel=1)
