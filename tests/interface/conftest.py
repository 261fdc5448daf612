"""Calls of the real entry point, and files for them."""

from dataclasses import dataclass

import pytest

from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Certificate, Point, Status
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
    monkeypatch.setattr(
        "wspd_design.cli.console._MINUTE", float("inf")
    )  # on a busy machine, too, nothing is told of progress

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


@pytest.fixture
def witness_file(tmp_path):
    """A certificate that is refuted at 36 km/h, with other mass, inertia and friction than the paper's vehicle."""
    values = (("slip", 0.2, "-"), ("speed", 36.0, "km/h"), ("mass", 70e3, "kg"), ("mu0", 0.3, "-"))
    certificate = Certificate(
        name="open_loop_pole",
        title="Slip pole",
        claim="The slip pole does not exceed 1/tau.",
        status=Status.REFUTED,
        explanation="It does.",
        witness=(
            *(Point(name=name, value=value, unit=unit) for name, value, unit in values),
            Point(name="wheelset inertia", value=700.0, unit="kg m2"),
            Point(name="slip pole", value=3.0, unit="1/s"),
        ),
        method="none",
    )
    path = tmp_path / "witness.json"
    path.write_text(certificate_text(certificate))
    return path
