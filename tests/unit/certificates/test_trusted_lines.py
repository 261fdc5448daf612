"""What has to be trusted is counted: docs/certificates.md names the files and how many lines each has."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
ROOM = ROOT / "wspd_design" / "certificates"
PAGE = ROOT / "docs" / "certificates.md"
TRUSTED = {
    "kernel/checker.py": "inequalities on boxes, identities, signs; one statement at one place",
    "kernel/obligation.py": "whether what is stated is about this statement, and what it shows",
    "kernel/claim.py": "builds statements: writes a formula of the model as steps",
    "replay.py": "makes the certificate again and compares it word for word",
    "theorems/": "builds statements from a design, tells the verdict; special checkers of `stop_bound`, "
    "`sampled_invariance` and `lpv_lyapunov`",
    "setting/": "builds statements: domain, plant, axle, and what the `step` of a law is",
}
ROUNDED = 100  # lines of a folder


def lines(name):
    place = ROOM / name
    files = sorted(place.rglob("*.py")) if place.is_dir() else [place]
    count = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in files)
    return f"about {round(count, -2)}" if place.is_dir() else f"below {(count // ROUNDED + 1) * ROUNDED}"


def test_the_page_tells_the_lines_as_they_are():
    rows = [f"| `certificates/{name}` | {lines(name)} | {what} |" for name, what in TRUSTED.items()]
    found = re.findall(r"^\| `certificates/.*$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert found == rows, "\n".join(rows)


def test_the_checker_can_be_read_in_one_sitting():
    assert len((ROOM / "kernel" / "checker.py").read_text(encoding="utf-8").splitlines()) < 500


@pytest.fixture
def alone(tmp_path):
    """Run a copy of the checker where the package cannot be imported."""
    shutil.copy(ROOM / "kernel" / "checker.py", tmp_path)

    def run(*files):
        command = [sys.executable, "-I", str(tmp_path / "checker.py"), *map(str, files)]
        return subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)

    return run


def test_the_checker_decides_alone(alone, tmp_path):
    import wspd_design as wd

    wd.certify("smc", rail="polach-wet", only=("gain_positive", "surface_hurwitz", "no_go"), folder=tmp_path)
    files = sorted(tmp_path.glob("*.json"))
    done = alone(*files)
    assert done.returncode == 0, done.stdout
    assert len(files) == 3 <= done.stdout.count(": holds, ")
    forged = (tmp_path / "no_go.json").read_text().replace('"bound": "', '"bound": "-1', 1)
    (tmp_path / "no_go.json").write_text(forged)
    assert alone(tmp_path / "no_go.json").returncode == 1
    (tmp_path / "no_go.json").write_text("{}")
    assert alone(tmp_path / "no_go.json").returncode == 1
