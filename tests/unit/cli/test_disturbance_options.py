"""One set of disturbance options: simulate, compare and report take the same ones, and hand over what was written."""

import inspect
from dataclasses import fields

import pytest
import typer

from wspd_design.cli import disturbances
from wspd_design.cli.commands.compare import compare
from wspd_design.cli.commands.report import report
from wspd_design.cli.commands.simulate import simulate
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.option_records import takes_records

NAMES = [each.name for each in fields(StopOptions)]


def options_of(command):
    return {
        name: (parameter.default, parameter.annotation)
        for name, parameter in inspect.signature(command).parameters.items()
        if name in NAMES
    }


@pytest.mark.parametrize("command", [simulate, compare, report])
def test_commands_take_all_of_them_and_the_same(command):
    assert list(options_of(command)) == NAMES
    assert options_of(command) == options_of(simulate)
    assert "disturbances" not in inspect.signature(command).parameters


def test_the_record_gets_what_was_written_and_defaults_for_the_rest():
    seen = []

    @takes_records
    def command(*, before: int = 1, disturbances: StopOptions, after: bool = False) -> None:
        seen.append((before, disturbances, after))

    app = typer.Typer()
    app.command()(command)
    app(["--before", "2", "--patch", "5 m a", "--patch", "9 m b", "--pulses", "80"], standalone_mode=False)
    app([], standalone_mode=False)
    assert seen == [(2, StopOptions(patch=["5 m a", "9 m b"], pulses=80), False), (1, StopOptions(), False)]
    assert list(inspect.signature(command).parameters) == ["before", *NAMES, "after"]


def test_every_option_has_its_help_in_one_panel():
    for _, annotation in options_of(simulate).values():
        (option,) = annotation.__metadata__
        assert option.help
        assert option.rich_help_panel == disturbances.PANEL
