"""The contracts on the derivations are kept, and a planted import breaks each of them."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LINT = Path(sys.executable).with_name("lint-imports")


def lint(folder):
    command = [str(LINT), "--config", "pyproject.toml", "--no-cache"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture
def copy(tmp_path):
    for name in ("derivations", "wspd_design"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "data"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return tmp_path


def test_contracts_are_kept(copy):
    assert lint(copy).returncode == 0


@pytest.mark.parametrize(
    ("file", "planted", "contract"),
    [
        (
            "derivations/sampled_loop.py",
            "from wspd_design.certificates import records",
            "Derivations run without what they generate",
        ),
        (
            "derivations/slip_equation.py",
            "from wspd_design.model.generated import motion as m",
            "Derivations run without what they generate",
        ),
        ("derivations/claim.py", "from derivations import equation_map", "Derivations: mathematics below"),
        ("derivations/motion.py", "from derivations import slip_equation", "Derivations: no import circle"),
        ("wspd_design/model/slip.py", "from derivations import notation", "The package runs without"),
    ],
)
def test_planted_import_breaks_its_contract(copy, file, planted, contract):
    path = copy / file
    path.write_text(path.read_text() + f"\n{planted}\n")
    found = lint(copy)
    assert found.returncode == 1
    shown = " ".join(found.stdout.split())
    start = shown.index(contract)
    assert "BROKEN" in shown[start : shown.index("KEPT", start) if "KEPT" in shown[start:] else None]
