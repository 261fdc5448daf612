"""``make derive`` mends every generated file: the derivations run while the generated ones are missing or broken."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.lazily import Lazily

generate = Lazily("generate")


@pytest.fixture
def files():
    return [
        *sorted(path.relative_to(generate.ROOT) for path in (generate.ROOT / generate.PACKAGE).glob("*.py")),
        generate.EQUATIONS,
        generate.README,
        generate.NOMENCLATURE_PAGE,
        generate.THEORY_PAGE,
    ]


RUN = """
import sys
from derivations import generate
code = generate.main()
print(*sorted(name for name in sys.modules if name.startswith("wspd_design.")))
sys.exit(code)
"""


def test_missing_and_broken_files_are_written_again(files, tmp_path):
    for name in ("derivations", "wspd_design"):
        shutil.copytree(generate.ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(generate.ROOT / "pyproject.toml", tmp_path)
    for place, path in enumerate(files):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        if place % 2:
            (tmp_path / path).write_text("<<<<<<< this is neither Python nor TOML\n")
        else:
            (tmp_path / path).unlink(missing_ok=True)
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    made = subprocess.run(
        [sys.executable, "-c", RUN],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert made.returncode == 0, made.stderr
    written = {path: (tmp_path / path).read_bytes() for path in files}
    assert written == {path: (generate.ROOT / path).read_bytes() for path in files}
    assert made.stdout.split() == ["wspd_design.parameters", "wspd_design.parameters.equations"]
