"""The console and Python blocks of README and docs are run, and what they show must be what comes out.

Searches and reports, which would take minutes, are not run here; like all others they must be commands that there are.
"""

import doctest
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import typer

from wspd_design.cli.app import app
from wspd_design.cli.lazy import COMMANDS

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
PAGES = (
    "README.md",
    "docs/tutorial.md",
    "docs/certificates.md",
    "docs/campaigns.md",
    "docs/modes.md",
    "docs/vehicle-files.md",
    "docs/wizard.md",
)
WITHOUT_COMMANDS = ("docs/python.md",)  # its commands stand in the text
WITH_FILES = "docs/how-to.md"  # all its Python blocks are files that its commands use
BLOCK = re.compile(r"^```(console|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SHELL_ALONE = re.compile(r"[|<>&;*$]")  # what no program sees
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


def shown(command, folder, wspd):
    """Output of a command and its errors: of the shell, or of the program in this process, which starts at once."""
    if command.startswith("wspd ") and not SHELL_ALONE.search(command):
        outcome = wspd(*shlex.split(command)[1:])
        return outcome.out, outcome.err
    done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout, done.stderr


@pytest.mark.parametrize("page", [*PAGES, WITH_FILES])
def test_console_blocks_show_what_the_program_prints(page, wspd, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{os.environ['PATH']}")
    monkeypatch.setenv("NO_COLOR", "1")
    write_files(page, tmp_path)
    run = 0
    for block in blocks(page, "console"):
        for command, expected in commands(block):
            if command.startswith("make "):  # CI calls these; here they would call themselves
                continue
            out, errors = shown(command, tmp_path, wspd)
            assert matches(expected, out), f"{page}: $ {command}\n{out}{errors}"
            run += 1
    assert run > 0


@pytest.mark.parametrize("page", [page for page in (*PAGES, *WITHOUT_COMMANDS) if blocks(page, "python")])
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


FENCE = re.compile(r"^```(?:|sh|console|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CALL = re.compile(r"^(?:\$ )?wspd (?P<words>[^|\n]+)", re.MULTILINE)
SHELL = re.compile(r"\$[A-Z_]+")  # a variable of a job array, which stands for a number here


def calls():
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    found = {}
    for page in pages:
        for block in FENCE.findall(page.read_text()):
            found |= {call["words"]: page.name for call in CALL.finditer(block)}
    return [(page, words) for words, page in found.items()]


def parsed(words):
    """Read a command line as the program does, and call nothing."""
    name, *rest = shlex.split(SHELL.sub("1", words), comments=True)
    if name.startswith("-"):  # an option of the program itself, which acts as soon as it is read
        assert any(name in option.opts for option in typer.main.get_command(app).params), name
        return
    COMMANDS[name].load(name).make_context(name, rest)


def test_every_command_line_of_a_page_is_one():
    found = calls()
    assert len(found) > 40
    for page, words in found:
        try:
            parsed(words)
        except Exception as error:
            pytest.fail(f"{page}: wspd {words}: {error}")


def test_an_option_that_there_is_not_is_seen():
    with pytest.raises(Exception, match="No such option"):
        parsed("simulate afsmc --rial polach-dry")


def test_a_wrong_figure_in_a_block_is_seen():
    assert matches("distance 184.9 m\n...\n", "distance   184.9 m\nmore\n")
    assert not matches("distance 184.8 m\n...\n", "distance   184.9 m\nmore\n")
