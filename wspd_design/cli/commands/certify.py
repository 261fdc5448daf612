"""``wspd certify``: the checks of a design, with proofs and witnesses kept as files that can be checked again."""

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from wspd_design.certificates.kernel.file import certificate_text, file_name
from wspd_design.certificates.records import Certificate, Status
from wspd_design.cli import options
from wspd_design.cli.case import Wishes, resolve
from wspd_design.cli.console import console, spaced, table
from wspd_design.cli.output import check_folder, write_text
from wspd_design.cli.own_controller import is_own_controller
from wspd_design.cli.verification import (
    exit_code,
    margin_text,
    problem_of,
    run_checks,
    show_claims,
    show_counts,
    status_text,
)
from wspd_design.design.catalog import is_design_file
from wspd_design.parameters.errors import UserError

FOLDER = ".certificates"
"""Ending of the folder beside a design."""


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
    search_time: options.SearchTimeOption = None,
    force: options.ForceOption = False,
) -> None:
    """Prove what can be proved about a design and keep the proofs.

    Each check with proofs becomes one JSON file, which wspd check decides about without the program that found it.
    So does each check that is refuted, with its witness: wspd simulate DESIGN --from-witness FILE starts there.
    Exit code 1 when a claim is refuted, else 3 when one is undecided, else 0.
    """
    case = resolve(design, Wishes(vehicle=vehicle, rail=rail))
    folder = output if output is not None else _beside(design)
    check_folder(folder, force=force)
    problem = problem_of(case)
    certificates = run_checks(problem, only, search_time)
    sizes = _write(certificates, folder, force=force)
    show_claims(problem, certificates)
    _show(certificates, sizes)
    show_counts(certificates)
    if sizes:
        console().print(
            Text(
                f"\nWritten: {folder}/NAME.json for each of the {len(sizes)} checks with a proof or a witness"
            )
        )
        console().print(
            Text(f"Check them: wspd check {folder}/*.json{_as_given(design, folder, vehicle, rail)}")
        )
    else:
        console().print("\nNo check has a proof or a witness to keep.")
    raise typer.Exit(exit_code(certificates))


def _beside(design: str) -> Path:
    """Return the folder for what is kept about a design, beside its file if it has one."""
    return Path(design.rpartition(":")[0] if is_own_controller(design) else design).with_suffix(FOLDER)


def _as_given(design: str, folder: Path, vehicle: str | None, rail: str | None) -> str:
    """Return the options that the checker needs to find the same design."""
    found = is_design_file(design) and Path(design) == folder.with_suffix(".toml")
    given = (("--design", None if found else design), ("--vehicle", vehicle), ("--rail", rail))
    return "".join(f" {option} {shlex.quote(value)}" for option, value in given if value is not None)


def _write(certificates: Sequence[Certificate], folder: Path, *, force: bool) -> dict[str, int]:
    """Write what can be checked or simulated again; return the size of each file [byte] by the name of the check."""
    kept = [each for each in certificates if each.proofs or each.status is Status.REFUTED]
    if kept:
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise UserError(
                f"folder {folder} cannot be made ({error.strerror}); choose another one with -o"
            ) from None
    sizes = {}
    for certificate in kept:
        text = certificate_text(certificate)
        write_text(folder / file_name(certificate), text, force=force)
        sizes[certificate.name] = len(text.encode())
    return sizes


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
