"""The console and Python blocks of README and docs are run, and what they show must be what comes out."""

import doctest
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
PAGES = (
    "README.md",
    "docs/tutorial.md",
    "docs/certificates.md",
    "docs/campaigns.md",
    "docs/modes.md",
    "docs/vehicle-files.md",
)
WITH_FILES = "docs/how-to.md"  # all its Python blocks are files that its commands use
BLOCK = re.compile(r"^```(console|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"^`(\S+)`:\n\n```(?:toml|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def blocks(page, kind):
    return [text for found, text in BLOCK.findall((ROOT / page).read_text()) if found == kind]


def write_files(page, folder):
    """Write the files that a page shows, each below its name."""
    for name, text in FILE.findall((ROOT / page).read_text()):
        (folder / name).write_text(text)


def commands(block):
    """Split a console block into (command, expected output)."""
    parts = re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]
    return [(part.partition("\n")[0], part.partition("\n")[2]) for part in parts]


def matches(expected, got):
    return doctest.OutputChecker().check_output(expected, got, FLAGS)


@pytest.mark.parametrize("page", [*PAGES, WITH_FILES])
def test_console_blocks_show_what_the_program_prints(page, tmp_path):
    folder = str(Path(sys.executable).parent)
    environment = os.environ | {"PATH": f"{folder}:{os.environ['PATH']}", "COLUMNS": "80", "NO_COLOR": "1"}
    write_files(page, tmp_path)
    run = 0
    for block in blocks(page, "console"):
        for command, expected in commands(block):
            if command.startswith("make "):  # CI calls these; here they would call themselves
                continue
            done = subprocess.run(
                ["bash", "-c", command],
                cwd=tmp_path,
                env=environment,
                capture_output=True,
                text=True,
                check=False,
            )
            assert matches(expected, done.stdout), f"{page}: $ {command}\n{done.stdout}{done.stderr}"
            run += 1
    assert run > 0


@pytest.mark.parametrize("page", PAGES)
def test_python_blocks_run(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    space: dict[str, object] = {}
    for block in blocks(page, "python"):
        exec(compile(block, page, "exec"), space)
    for name, item in space.items():
        if name.startswith("test_") and callable(item):
            item()
    capsys.readouterr()
    assert space


def test_a_wrong_figure_in_a_block_is_seen():
    assert matches("distance 184.9 m\n...\n", "distance   184.9 m\nmore\n")
    assert not matches("distance 184.8 m\n...\n", "distance   184.9 m\nmore\n")
