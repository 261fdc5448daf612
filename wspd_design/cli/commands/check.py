"""``wspd check``: the checkers alone. Every sentence is made again from the design; the file gives only the proofs."""

from pathlib import Path
from typing import Annotated, NoReturn

import typer
from rich.padding import Padding
from rich.text import Text

from wspd_design.certificates.kernel.file import FOLDER
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import Replayed
from wspd_design.cli import options
from wspd_design.cli.console import console, progress
from wspd_design.cli.exit_codes import GOOD, REFUTED, UNDECIDED
from wspd_design.cli.verification import claim_text
from wspd_design.design import certification
from wspd_design.parameters.errors import UserError

REPORTS = (".html", ".pdf")


def check(
    certificates: Annotated[
        list[Path],
        typer.Argument(
            metavar="CERTIFICATE...",
            help=f"Files that wspd certify wrote, folders NAME{FOLDER} of them, or a report with all that it attaches.",
        ),
    ],
    design: Annotated[
        str | None,
        typer.Option(
            "--design",
            metavar="DESIGN",
            help=f"What wspd certify was given. Default: NAME.toml beside the folder NAME{FOLDER} of the certificate. "
            "Of a report the attached design; its own law in Python is run only where this names the same file.",
            show_default=False,
        ),
    ] = None,
    vehicle: options.VehicleOption = None,
    rail: options.RailOption = None,
) -> None:
    """Decide about certificates again, without the program that found them.

    The whole certificate is made again from the design and printed; a file that says anything else is refused. Exit
    code 1 when a file is refused, else 3 when one decides nothing, else 0.
    """
    if any(path.suffix.lower() in REPORTS for path in certificates):
        if len(certificates) > 1 or vehicle or rail:
            raise UserError(f"a report has its own vehicle and rail: wspd check {certificates[0]} alone")
        _end(_of_report(certificates[0], law=design))
    cases = [(path, design or _design_of(path)) for path in _files(certificates)]
    found = []
    problems = {
        made: certification.problem_of(made, vehicle=vehicle, rail=rail)
        for made in dict.fromkeys(made for _, made in cases)
    }
    for path, made in cases:
        with progress() as tell:
            tell(f"Checking {path.name!a}")
            found.append(certification.check(path, problems[made]))
        _show(path.name, Path(made).name, found[-1])
    _end(found)


def _of_report(path: Path, *, law: str | None) -> list[Replayed]:
    """Decide about all that a report attaches."""
    from wspd_design.cli.checking import check_report

    with progress() as tell:
        found = check_report(path, law=law, progress=tell)
    for name, each in found.items():
        _show(name, path.name, each)
    return list(found.values())


def _end(found: list[Replayed]) -> NoReturn:
    """End with the exit code of what was found."""
    if not all(each.accepted for each in found):
        raise typer.Exit(REFUTED)
    raise typer.Exit(UNDECIDED if any(each.unchecked for each in found) else GOOD)


def _files(given: list[Path]) -> list[Path]:
    """Return the files, those of a folder in the order of their names."""
    found = [each for path in given for each in (sorted(path.glob("*.json")) if path.is_dir() else [path])]
    if not found:
        raise UserError(f"{given[0]} holds no certificate; name a folder that wspd certify wrote")
    return found


def _design_of(path: Path) -> str:
    """Find the design beside the folder of a certificate."""
    folder = path.resolve().parent
    design = folder.with_suffix(".toml")
    if folder.suffix != FOLDER or not design.is_file():
        where = (
            f"{design.name} is not beside it" if folder.suffix == FOLDER else f"its folder is not *{FOLDER}"
        )
        raise UserError(f"the design of {path} is not found, {where}; name it with --design")
    return str(design)


def _show(name: str, about: str, found: Replayed) -> None:
    out = console()
    sign, style = _sign(found)
    took = f" ({found.leaves} {'box' if found.leaves == 1 else 'boxes'})" if found.accepted else ""
    # The name of the file is the only text that does not come from the design.
    head = f"  {_printable(name)} for {_printable(about)}{took}"
    out.print(Text(sign, style=style) + Text(head, style="bold"))
    if found.certificate is None:
        out.print(Padding(Text(found.reason), (0, 0, 0, 2)))
    else:
        out.print(Padding(claim_text(found.certificate), (0, 0, 0, 2)))
        for proof in found.certificate.proofs:
            out.print(Padding(Text(f"proved: {proof.text}", style="dim"), (0, 0, 0, 4)))


def _printable(name: str) -> str:
    return name if name.isprintable() else ascii(name)


def _sign(found: Replayed) -> tuple[str, str]:
    """Return the verdict on a file and its color; only what is proved is green."""
    if found.certificate is None:
        return "✗ refused", "bold red"
    if found.unchecked:
        return "? unchecked", "bold yellow"
    good = found.certificate.status is Status.PROVED
    return ("✓ accepted", "green") if good else ("~ accepted", "yellow")
