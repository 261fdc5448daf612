"""``wspd check``: the checker alone. It takes every claim from the design and only the proof from the file."""

from pathlib import Path
from typing import Annotated

import typer
from rich.padding import Padding
from rich.text import Text

from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import Replayed, replay
from wspd_design.cli import options
from wspd_design.cli.commands.certify import FOLDER
from wspd_design.cli.console import console, progress
from wspd_design.cli.exit_codes import GOOD, REFUTED, UNDECIDED
from wspd_design.cli.verification import problem_of
from wspd_design.design.case import CaseOptions, load_case
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
    """Check proofs again, without the program that found them; the witness of what is refuted as well.

    Exit code 1 when a file is refused, else 3 when one holds nothing that can be checked, else 0.
    """
    cases = [(path, _text(path), design or _design_of(path)) for path in certificates]
    found = []
    wanted = CaseOptions(vehicle=vehicle, rail=rail)
    problems = {made: problem_of(load_case(made, wanted)) for _, _, made in cases}
    for path, text, made in cases:
        with progress() as tell:
            tell(f"Checking {path.name}")
            found.append(replay(problems[made], text))
        _show(path, made, found[-1])
    if not all(each.accepted for each in found):
        raise typer.Exit(REFUTED)
    raise typer.Exit(UNDECIDED if any(each.empty for each in found) else GOOD)


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
    sign, style = _sign(found)
    took = f"{found.leaves} boxes, {found.seconds:.2f} s"
    if found.status is not None and found.status is not Status.PROVED:
        took = f"{found.status.name.replace('_', ' ')}, {took}"
    out.print(Text(sign, style=style) + Text(f"  {path.name} for {Path(design).name} ({took})", style="bold"))
    for line in _lines(found):
        out.print(Padding(Text(line), (0, 0, 0, 2)))


def _sign(found: Replayed) -> tuple[str, str]:
    """Return the verdict on a file and its color; only what is proved is green."""
    if not found.accepted:
        return "✗ refused", "bold red"
    if found.empty:
        return "? unchecked", "bold yellow"
    return ("✓ accepted", "green") if found.status is Status.PROVED else ("~ accepted", "yellow")


def _lines(found: Replayed) -> list[str]:
    """Say what was shown, and what that means for the check."""
    if not found.accepted:
        return [found.reason]
    if found.empty:
        return [f"The file has no proof to check; {found.check} was decided by wspd certify alone."]
    lines = list(found.shown) + [f"The witness denies {each}." for each in found.denied]
    if found.status is Status.PROVED:
        return [*lines, f"These proofs are all that {found.check} needs."]
    if found.status is Status.VACUOUS and not found.missing:
        return [*lines, f"These proofs show that {found.check} is vacuous: it says nothing about a stop."]
    if found.status is Status.REFUTED:
        return [
            *lines,
            f"So {found.check} is refuted." if found.denied else "The witness is not checked again.",
        ]
    needs = f", which needs {'; '.join(found.missing)}" if found.missing else ""
    return [*lines, f"That does not prove {found.check}{needs}."]
