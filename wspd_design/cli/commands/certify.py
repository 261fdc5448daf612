"""``wspd certify``: the checks of a design, with proofs and witnesses kept as files that can be checked again."""

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from wspd_design.certificates.kernel.file import FOLDER, file_name
from wspd_design.certificates.records import Certificate, Status
from wspd_design.cli import options
from wspd_design.cli.console import console, spaced, table
from wspd_design.cli.output import check_folder
from wspd_design.cli.verification import (
    exit_code,
    interrupted_checks,
    margin_text,
    run_checks,
    show_claims,
    show_counts,
    show_not_varied,
    status_text,
)
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.design.catalog import is_design_file
from wspd_design.design.certification import folder_beside, problem_of_case, stored_beside


def certify(
    design: Annotated[
        str,
        typer.Argument(
            metavar="DESIGN",
            help="A design file; also a controller's name or FILE.py:NAME, as wspd verify takes them.",
            show_default=False,
        ),
    ],
    vehicle: options.VehicleOption = None,
    rail: options.RailOption = None,
    only: options.OnlyOption = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FOLDER",
            help=f"Where the files go. Default: DESIGN{FOLDER} beside the design.",
            show_default=False,
        ),
    ] = None,
    effort: options.EffortOption = 1.0,
    force: options.ForceOption = False,
) -> None:
    """Prove what can be proved about a design and keep the proofs.

    Each check that speaks about the design becomes one JSON file, which wspd check decides about without the program
    that found it. A refuted one has its witness: wspd simulate DESIGN --from-witness FILE starts there.
    Exit code 1 when a claim is refuted or a limitation is proved, else 3 when one is undecided, else 0. With --only a
    check that is not proved counts as undecided.
    """
    case = load_case(design, CaseOptions(vehicle=vehicle, rail=rail))
    folder = output if output is not None else folder_beside(design)
    check_folder(folder, force=force)
    problem = problem_of_case(case)
    ran = run_checks(problem, only, effort, stored_beside(design), folder)
    certificates = ran.certificates
    sizes = {
        each.name: (folder / file_name(each)).stat().st_size
        for each in certificates
        if each.status is not Status.NOT_APPLICABLE
    }
    show_claims(problem, certificates)
    _show(certificates, sizes)
    show_counts(certificates)
    if not ran.complete:
        go_on = (
            "; the same command with --force goes on from there" if stored_beside(design) == folder else ""
        )
        raise interrupted_checks(ran, only, f"; their files are in {folder}{go_on}" if sizes else "")
    show_not_varied(problem, certificates)
    if sizes:
        console().print(Text(f"\nWritten: {folder}/NAME.json, {len(sizes)} file{'s' * (len(sizes) != 1)}"))
        given = _as_given(design, folder, vehicle, rail)
        console().print(
            f"Check them: wspd check {shlex.quote(str(folder))}{given}", markup=False, soft_wrap=True
        )
    raise typer.Exit(exit_code(certificates, asked=bool(only)))


def _as_given(design: str, folder: Path, vehicle: str | None, rail: str | None) -> str:
    """Return the options that the checker needs to find the same design."""
    found = is_design_file(design) and Path(design) == folder.with_suffix(".toml")
    given = (("--design", None if found else design), ("--vehicle", vehicle), ("--rail", rail))
    return "".join(f" {option} {shlex.quote(value)}" for option, value in given if value is not None)


def _show(certificates: Sequence[Certificate], sizes: Mapping[str, int]) -> None:
    shown = table("Status", "Check", "Margin", "File", "Seconds", numeric=("File", "Seconds"))
    for certificate in certificates:
        size = sizes.get(certificate.name)
        shown.add_row(
            status_text(certificate),
            certificate.name,
            Text(margin_text(certificate.margin)),
            "" if size is None else f"{size / 1e3:.1f} kB",
            f"{certificate.seconds:.1f}",
        )
    console().print(spaced(shown))
