"""The checker is one short file that runs without the package, and answers with exit codes and printable text."""

import ast
import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import flint
import pytest

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.obligation import Sign
from wspd_design.certificates.records import Certificate, Status
from wspd_design.certificates.search.settle import exact

FILE = Path(checker.__file__)
MOST_LINES = 500
ALONE = "import runpy, sys; sys.path.append(sys.argv[1]); sys.argv = sys.argv[2:]; "
RUN = ALONE + "runpy.run_path(sys.argv[0], run_name='__main__')"


def test_the_checker_can_be_read_in_one_sitting():
    assert len(FILE.read_text().splitlines()) < MOST_LINES


def test_the_checker_imports_flint_and_the_standard_library_alone():
    found = set()
    for node in ast.walk(ast.parse(FILE.read_text())):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0
            found.add(node.module)
    assert "flint" in found
    assert {name.partition(".")[0] for name in found - {"flint"}} <= sys.stdlib_module_names


@pytest.fixture(scope="module")
def content(proved):
    """A certificate with two proofs, as it is kept."""
    sign = Sign(key="speed", quantity="speed", value=Fraction(2), unit="m/s")
    positive = sign.decide(exact(sign), Work())
    assert positive.status is Status.PROVED
    certificate = Certificate(
        name="reaching",
        title="Reaching",
        claim="It is reached.",
        status=Status.PROVED,
        explanation="It is.",
        method="none",
        findings={"gain": proved, "speed": positive},
    )
    return json.loads(certificate_text(certificate))


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """Run a copy of the checker in a folder of its own, with python-flint and without anything else."""
    folder = tmp_path_factory.mktemp("alone")
    copy, packages = folder / "copy.py", folder / "packages"
    copy.write_bytes(FILE.read_bytes())
    packages.mkdir()
    installed = Path(flint.__file__).parent
    for each in (installed, installed.parent / "python_flint.libs"):
        if each.exists():
            (packages / each.name).symlink_to(each)

    def run(*files, code=RUN):
        arguments = [sys.executable, "-I", "-S", "-c", code, str(packages), str(copy), *map(str, files)]
        return subprocess.run(arguments, capture_output=True, cwd=folder, check=False)

    return run


@pytest.fixture
def kept(tmp_path, content):
    """Write a certificate with changed findings."""

    def write(change=lambda _: None, name="reaching.json"):
        copy = json.loads(json.dumps(content))
        change(copy["findings"])
        path = tmp_path / name
        path.write_text(json.dumps(copy))
        return path

    return write


def test_the_package_is_not_there(alone):
    assert alone(code=ALONE + "import flint").returncode == 0
    for missing in ("wspd_design", "numpy", "sympy"):
        assert b"ModuleNotFoundError" in alone(code=ALONE + f"import {missing}").stderr


def test_a_genuine_file_holds(alone, kept):
    done = alone(kept())
    assert (done.returncode, done.stderr) == (0, b"")
    lines = done.stdout.decode("ascii").splitlines()
    assert len(lines) == 2
    assert "'gain': holds, " in lines[0]
    assert "(r + eta)/rho <= 25.10" in lines[0]
    assert lines[0].endswith("for all slip 0.02 to 0.6, speed 2 to 33.4, mass 61472.8 to 92209.2")
    assert lines[1].endswith("speed = 2 m/s > 0")


def cut(findings):
    findings["gain"]["proof"]["tree"] = findings["gain"]["proof"]["tree"][:-1]


def tighter(findings):
    findings["gain"]["proof"]["statement"]["bound"] = "25.0"


def wider(findings):
    rows = findings["gain"]["proof"]["statement"]["variables"]
    next(row for row in rows if row[0] == "mass")[2] = "92210.0"


def other_formula(findings):
    steps = findings["gain"]["proof"]["statement"]["model"]
    steps += [["n", "2.0"], ["mul", len(steps) - 1, len(steps)]]


def unprintable(findings):
    findings["gain"]["proof"]["statement"]["name"] = "\x1b[2Jall is proved"


@pytest.mark.parametrize("forge", [cut, tighter, wider, other_formula, unprintable])
def test_a_forged_file_is_refused(alone, kept, forge):
    done = alone(kept(forge))
    assert (done.returncode, done.stderr) == (1, b"")
    assert b"refused: " in done.stdout
    assert b"\x1b" not in done.stdout


def test_one_forged_file_among_good_ones_decides(alone, kept):
    done = alone(kept(name="one.json"), kept(cut, name="two.json"), kept(name="three.json"))
    assert done.returncode == 1
    assert done.stdout.count(b"holds, ") == 4
    assert done.stdout.count(b"refused: ") == 1


def test_a_file_without_a_proof_decides_nothing(alone, kept):
    assert alone(kept(dict.clear)).returncode == 3
    assert alone().returncode == 3


@pytest.mark.parametrize("written", [b"", b"[]", b"{", b"\xff\xfe\x00", b'{"findings": 5}', b"[" * 100_000])
def test_what_is_not_a_certificate_is_refused(alone, tmp_path, written):
    path = tmp_path / "x.json"
    path.write_bytes(written)
    done = alone(path, tmp_path / "missing.json", tmp_path)
    assert (done.returncode, done.stderr) == (1, b"")
    assert done.stdout.count(b"refused: ") == 3


def test_names_reach_the_terminal_escaped(alone, kept):
    def renamed(findings):
        findings["\x1b[2J\x07"] = findings.pop("gain")

    done = alone(kept(renamed, name="\x1b[32mgood\x1b[0m.json"))
    assert done.returncode == 0
    assert b"\\x1b[2J" in done.stdout
    assert b"\x1b" not in done.stdout + done.stderr


def test_a_name_that_stands_twice_is_refused(alone, kept):
    path = kept()
    path.write_text(path.read_text().replace('"tree": "', '"tree": ".", "tree": "'))
    done = alone(path)
    assert done.returncode == 1
    assert b"a name stands twice" in done.stdout
