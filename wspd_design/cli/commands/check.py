"""``wspd check``: the checker alone. It takes every claim from the design and only the proof from the file."""

from pathlib import Path
from typing import Annotated

import typer
from rich.padding import Padding
from rich.text import Text

from wspd_design.certificates.replay import Replayed, replay
from wspd_design.cli import options
from wspd_design.cli.case import Wishes, resolve
from wspd_design.cli.commands.certify import FOLDER
from wspd_design.cli.console import console, progress
from wspd_design.cli.exit_codes import GOOD, REFUTED
from wspd_design.cli.verification import problem_of
from wspd_design.parameters.errors import UserError


def check(
    certificates: Annotated[
        list[Path], typer.Argument(metavar="CERTIFICATE...", help="Files that wspd certify wrote.")
    ],
    design: Annotated[
        str | None,
        typer.Option(
            "--design",
            metavar="DESIGN",
            help=f"What wspd certify was given. Default: NAME.toml beside the folder NAME{FOLDER} of the certificate.",
            show_default=False,
        ),
    ] = None,
    vehicle: options.VehicleOption = None,
    rail: options.RailOption = None,
) -> None:
    """Check proofs again, without the program that found them.

    Exit code 0 when every proof is accepted, 1 when one is refused.
    """
    cases = [(path, _text(path), design or _design_of(path)) for path in certificates]
    refused = False
    wishes = Wishes(vehicle=vehicle, rail=rail)
    problems = {made: problem_of(resolve(made, wishes)) for _, _, made in cases}
    for path, text, made in cases:
        with progress() as tell:
            tell(f"Checking {path.name}")
            found = replay(problems[made], text)
        _show(path, made, found)
        refused = refused or not found.accepted
    raise typer.Exit(REFUTED if refused else GOOD)


def _text(path: Path) -> str:
    """Read a file; bytes that are no text are left to the checker to refuse."""
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise UserError(
            f"{path} cannot be read ({error.strerror}); name a file that wspd certify wrote"
        ) from None


def _design_of(path: Path) -> str:
    """Find the design beside the folder of a certificate."""
    folder = path.resolve().parent
    design = folder.with_suffix(".toml")
    if folder.suffix != FOLDER or not design.is_file():
        where = (
            f"{design.name} is not beside it" if folder.suffix == FOLDER else f"its folder is no *{FOLDER}"
        )
        raise UserError(f"the design of {path} is not found, {where}; name it with --design")
    return str(design)


def _show(path: Path, design: str, found: Replayed) -> None:
    out = console()
    sign, style = ("✓ accepted", "green") if found.accepted else ("✗ refused", "bold red")
    took = f"{found.leaves} boxes, {found.seconds:.2f} s"
    out.print(Text(sign, style=style) + Text(f"  {path.name} for {Path(design).name} ({took})", style="bold"))
    lines = list(found.shown)
    if not found.accepted:
        lines = [found.reason]
    elif found.missing:
        lines.append(f"That does not prove {found.check}, which needs {'; '.join(found.missing)}.")
    else:
        lines.append(f"These proofs are all that {found.check} needs.")
    for line in lines:
        out.print(Padding(Text(line), (0, 0, 0, 2)))
