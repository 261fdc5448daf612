"""Commands are loaded when they are called: what help imports, and that its table says what the commands say."""

import inspect
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import wspd_design.cli.commands
from wspd_design.cli.lazy import COMMANDS

HEAVY = (
    "casadi",
    "control",
    "cvxpy",
    "flint",
    "ival",
    "jinja2",
    "matplotlib",
    "numpy",
    "scipy",
    "sympy",
    "typst",
)
OWN = {
    "wspd_design",
    *(f"wspd_design.{name}" for name in ("cli", "cli.app", "cli.exit_codes", "cli.lazy", "cli.notices")),
    *("wspd_design.parameters", "wspd_design.parameters.errors"),
}


def loaded_by(*arguments):
    """Return the modules that a command line leaves behind."""
    code = (
        "import sys\nfrom wspd_design.cli.app import run\n"
        f"code = run({list(arguments)!r})\nprint('MODULES', *sys.modules)\nsys.exit(code)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.rpartition("MODULES ")[2].split()


@pytest.mark.parametrize("arguments", [("--help",), ("-h",)])
def test_help_loads_nothing_that_computes(arguments):
    found = loaded_by(*arguments)
    assert not {name.partition(".")[0] for name in found} & set(HEAVY)
    assert {name for name in found if name.startswith("wspd_design")} == OWN


def test_a_command_loads_its_own_module_alone():
    found = loaded_by("equations", "--help")
    commands = {name for name in found if name.startswith("wspd_design.cli.commands.")}
    assert commands == {"wspd_design.cli.commands.equations"}


@pytest.mark.parametrize("name", COMMANDS)
def test_summary_is_the_first_line_of_the_command(name):
    function = getattr(import_module(f"wspd_design.cli.commands.{name}"), name)
    assert inspect.getdoc(function).splitlines()[0] == COMMANDS[name].summary


def test_every_command_is_in_the_table():
    (folder,) = wspd_design.cli.commands.__path__
    below = {f"new_{name}" for name in import_module("wspd_design.cli.commands.new").COMMANDS}
    assert below == {"new_vehicle", "new_rail"}
    assert {path.stem for path in Path(folder).glob("*.py")} - {"__init__"} == set(COMMANDS) | below
