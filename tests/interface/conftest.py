"""Calls of the real entry point, and files for them."""

from dataclasses import dataclass

import pytest

from wspd_design.cli.app import run
from wspd_design.design.file import design_text
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.loading import load_rail, load_vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    code: int
    out: str
    err: str


@pytest.fixture
def wspd(capsys, monkeypatch, tmp_path):
    """Run one command line in an empty folder, without a terminal, and return what came out."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")

    def call(*arguments):
        capsys.readouterr()
        code = run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Outcome(code=code, out=captured.out, err=captured.err)

    return call


@pytest.fixture(scope="session")
def smc_text():
    """Text of a sliding-mode design for the paper's vehicle on the wet rail."""
    return design_text(
        design_controller(load_vehicle("er24pc"), load_rail("polach-wet"), Specification(), law="smc")
    )


@pytest.fixture
def smc_file(tmp_path, smc_text):
    path = tmp_path / "smc.toml"
    path.write_text(smc_text)
    return path
