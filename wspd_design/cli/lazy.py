"""The commands of ``wspd``: one table, from which each is loaded when it is called.

Help that lists the commands needs their names and summaries alone, and none of what they compute with.
"""

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

DESIGNING, JUDGING, KNOWING = "Design", "Prove and validate", "Look up"


@dataclass(frozen=True, slots=True)
class Entry:
    """A command: ``commands/NAME.py`` has a function of its name, and commands below it in ``COMMANDS``."""

    panel: str
    summary: str  # first line of the function's docstring
    example: str

    def load(self, name: str) -> TyperCommand:
        """Import the module of the command and build it."""
        built = typer.Typer(name=name, add_completion=False, rich_markup_mode="rich")
        module = import_module(f"wspd_design.cli.commands.{name}")
        function, below = getattr(module, name), getattr(module, "COMMANDS", {})
        if below:
            built.callback(invoke_without_command=True, epilog=self.example)(function)
            for inner, made in below.items():
                built.command(inner)(made)
        else:
            built.command(name, rich_help_panel=self.panel, epilog=self.example)(function)
        command: Any = typer.main.get_command(built)
        return command  # type: ignore[no-any-return]


COMMANDS = {
    "new": Entry(
        DESIGNING,
        "Answer some questions and get a design file, or that of a vehicle or a rail; every default is explained.",
        "Examples: wspd new -o design.toml; wspd new vehicle coach7.toml; wspd new rail leaves.toml",
    ),
    "design": Entry(
        DESIGNING,
        "Choose the gains of a slip controller by rules, or by search for a specification, and write a design file.",
        'Examples: wspd design --law smc --slip "14 %" -o design.toml; wspd design er24pc-20ms -o design.toml',
    ),
    "tune": Entry(
        DESIGNING,
        "Tune the numbers of any law with the stops and the effort of a specification, for fair comparisons.",
        "Example: wspd tune knorr-bremse er24pc-20ms -o knorr.toml",
    ),
    "verify": Entry(
        JUDGING,
        "Check the stability of a closed loop, claim by claim.",
        "Example: wspd verify design.toml",
    ),
    "certify": Entry(
        JUDGING,
        "Prove what can be proved about a design and keep the proofs.",
        "Example: wspd certify design.toml",
    ),
    "check": Entry(
        JUDGING,
        "Decide about certificates again, without the program that found them.",
        "Example: wspd check design.certificates/*.json",
    ),
    "simulate": Entry(
        JUDGING,
        "Simulate one stop and show its figures, or many with --runs and show their spread.",
        'Examples: wspd simulate afsmc --rail polach-dry --speed "100 km/h"; wspd simulate --runs 1000 '
        '--speed-noise "0.05 m/s" -o stops.csv',
    ),
    "compare": Entry(
        JUDGING,
        "Simulate the same stop with several controllers, side by side.",
        "Example: wspd compare design.toml afsmc none",
    ),
    "ladder": Entry(
        JUDGING,
        "Simulate the same stop on every model of the vehicle, and tell which model suffices for what.",
        "Example: wspd ladder design.toml",
    ),
    "campaign": Entry(
        JUDGING,
        "Simulate many stops as FILE says; what is finished stays, and the same command goes on from there.",
        "Example: wspd campaign campaign.toml --workers 8 -o stops.parquet",
    ),
    "report": Entry(
        JUDGING,
        "Write a report on a design or any other law: gains, poles, certificates, stops and sources.",
        "Example: wspd report design.toml -o report.html --pdf",
    ),
    "reproduce": Entry(
        JUDGING,
        "Compute the tables and figures of the paper and say which of its conclusions hold.",
        "Example: wspd reproduce -o reproduction",
    ),
    "linearize": Entry(
        KNOWING,
        "Show open-loop poles, input gain and equilibrium torque of the slip over speed.",
        "Example: wspd linearize --rail polach-dry",
    ),
    "modes": Entry(
        KNOWING,
        "Show the modes of a multibody vehicle at one speed, and the speed from which it hunts.",
        'Examples: wspd modes er24pc-82 --conicity 0.025 --conicity 0.2; wspd modes --slip "14 %" --speed "20 km/h"',
    ),
    "brake": Entry(
        KNOWING,
        "Show what the brake does while no wheel slides: stops by mean values, braked weight, adhesion asked for.",
        "Example: wspd brake --vehicle er24pc-service",
    ),
    "equations": Entry(
        KNOWING,
        "Show every equation of the paper with its verdict, or all about one of them.",
        "Example: wspd equations 19",
    ),
    "sources": Entry(
        KNOWING,
        "Show every number of a parameter set with unit, bounds, status, source and place.",
        "Example: wspd sources er24pc",
    ),
    "schema": Entry(
        KNOWING,
        "Print the JSON Schema of vehicle or rail files, for editors.",
        "Example: wspd schema vehicle -o wspd-vehicle.json",
    ),
    "docs": Entry(
        KNOWING,
        "Show a page of the documentation that came with the program, or list all of them.",
        "Examples: wspd docs own-controller; wspd docs theory#band | less",
    ),
    "doctor": Entry(
        KNOWING,
        "Look whether all that is needed is there: packages, fonts, folders, compiler, terminal.",
        "Example: wspd doctor; for a bug report: wspd doctor --report",
    ),
}
"""In the order of the help."""


class LazyGroup(TyperGroup):
    """A group that knows its commands from the table."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.commands = {
            name: TyperCommand(name, help=entry.summary, rich_help_panel=entry.panel, rich_markup_mode="rich")
            for name, entry in COMMANDS.items()
        }

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command of a command line, and load it."""
        name, found, rest = super().resolve_command(ctx, args)
        return name, found if name is None else COMMANDS[name].load(name), rest
