"""A bug report says what the program is and hides what is private."""

import getpass
import io
import platform
import tempfile
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from wspd_design.cli.app import run
from wspd_design.cli.bug_report import bug_report, without_paths
from wspd_design.exchange.version import program_version
from wspd_design.studies.package import package


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The report of a user whose folders have a name with a space in it."""
    home = tmp_path_factory.mktemp("home") / "Jane Doe" / "line 7"
    home.mkdir(parents=True)
    out = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out):
        for name in ("HOME", "TMPDIR", "XDG_CACHE_HOME", "MPLCONFIGDIR"):
            patch.setenv(name, str(home))
        patch.setattr(tempfile, "tempdir", None)  # what Python found before
        assert run(["doctor", "--report"]) == 0
    return out.getvalue()


def test_it_names_program_and_machine(report):
    assert report.startswith(f"wspd-design      {program_version()}")
    for fact in (package().sha256, package().tree, platform.python_version(), "casadi", "C compiler"):
        assert fact in report


def test_it_names_no_folder_and_no_user(report):
    assert "Jane" not in report
    assert "Doe" not in report
    assert str(Path.home()) not in report
    assert platform.node() not in report.replace(package().tree, "")
    assert f"/{getpass.getuser()}" not in report


@pytest.mark.parametrize(
    ("text", "hidden"),
    [
        ("/usr/bin/cc, version 12", "(path), version 12"),
        ("cc -I/home/jane/x -O2", "cc (path) -O2"),
        (r"C:\Users\jane\cc.exe failed", "(path) failed"),
        ("[Errno 2] '/home/jane/tmp'", "[Errno 2] '(path)'"),
        ("5/3 of 1.5/s", "5/3 of 1.5/s"),
    ],
)
def test_paths_are_hidden(text, hidden):
    assert without_paths(text) == hidden


def test_a_finding_on_several_lines_becomes_one():
    assert "cc       no\n" not in bug_report([("cc", "no\nlicence")])
    assert "no licence" in bug_report([("cc", "no\nlicence")])
