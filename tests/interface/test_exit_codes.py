"""Exit codes: 0 good, 1 refuted, 2 wrong use, 3 undecided, 70 a fault, 130 interrupted."""

import signal
import subprocess
import sys

import pytest

from wspd_design.certificates import suite
from wspd_design.certificates.records import Certificate, Status
from wspd_design.cli.commands import simulate

GOOD = (Status.PROVED, Status.EVIDENCE, Status.VACUOUS, Status.NOT_APPLICABLE)


def certificate(status):
    return Certificate(
        name=status.name.lower(), title="t", claim="c", status=status, explanation="e", method="m"
    )


def finding(*made):
    """Stand in for the checks: find these certificates, each told as it is found."""

    def verify(*_arguments, found, **_options):
        for each in made:
            found(each)
        return made

    return verify


@pytest.mark.parametrize(
    ("statuses", "code"),
    [
        (GOOD, 0),
        ((*GOOD, Status.UNDECIDED), 3),
        ((Status.REFUTED, *GOOD), 1),
        ((Status.UNDECIDED, Status.REFUTED), 1),
        ((*GOOD, Status.UNDECIDED, Status.LIMITATION), 1),
    ],
    ids=["good", "undecided", "refuted", "refuted wins", "a limitation is bad news"],
)
@pytest.mark.parametrize("options", [(), ("--json",)], ids=["table", "json"])
def test_verification(statuses, code, options, wspd, monkeypatch):
    monkeypatch.setattr(suite, "verify", finding(*map(certificate, statuses)))
    outcome = wspd("verify", "none", *options)
    assert (outcome.code, outcome.err) == (code, "")
    for status in statuses:
        assert status.name.replace("_", " ") in outcome.out.replace("_", " ")


@pytest.mark.parametrize("status", Status)
@pytest.mark.parametrize("options", [(), ("--json",)], ids=["table", "json"])
def test_a_check_that_is_asked_for_is_open_unless_it_is_proved(status, options, wspd, monkeypatch):
    monkeypatch.setattr(suite, "verify", finding(certificate(status)))
    code = {Status.PROVED: 0, Status.REFUTED: 1, Status.LIMITATION: 1}.get(status, 3)
    assert wspd("verify", "none", "--only", "reaching", *options).code == code


def test_a_law_without_torque_feedback_is_refuted_on_the_dry_rail(wspd):
    """Findings, section 2: with the valve lag, every equilibrium with p > 1/tau is unstable."""
    outcome = wspd("verify", "smc", "--rail", "polach-dry", "--only", "open_loop_pole")
    assert outcome.code == 1
    assert "REFUTED" in outcome.out
    assert "Witness" in outcome.out


def test_interrupted(wspd, monkeypatch):
    def interrupted(*_arguments, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr(simulate, "trial", interrupted)
    outcome = wspd("simulate", "none", "--output", "run.csv")
    assert outcome.code == 130
    assert outcome.out == ""
    assert "Traceback" not in outcome.err


def test_fault_of_the_program_is_no_verdict(wspd, monkeypatch):
    def broken(*_arguments, **_options):
        raise ZeroDivisionError("planted")

    monkeypatch.setattr(simulate, "trial", broken)
    outcome = wspd("simulate", "none", "--json")
    assert outcome.code == 70
    assert outcome.out == ""
    assert "planted" in outcome.err
    assert "fault of the program" in outcome.err


@pytest.mark.parametrize(
    "arguments", [("--help",), ("--version",), ("simulate", "--help"), ("equations",), ("sources",)]
)
def test_good(arguments, wspd):
    outcome = wspd(*arguments)
    assert (outcome.code, outcome.err) == (0, "")
    assert outcome.out


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="no SIGPIPE on this system")
def test_reader_of_a_pipe_that_goes_away():
    """``wspd equations | head -1`` ends silently."""
    code = "from wspd_design.cli import main; main()"
    with subprocess.Popen(
        [sys.executable, "-c", code, "equations"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={"COLUMNS": "60"},
        text=True,
    ) as process:
        process.stdout.close()
        assert process.stderr.read() == ""
        assert process.wait(timeout=60) == -signal.SIGPIPE
