"""``wspd reproduce``: the paper's tables and figures beside those of this program."""

from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.console import console, progress
from wspd_design.cli.output import check_folder


def reproduce(
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Folder to write to.")
    ] = Path("reproduction"),
    small: Annotated[
        bool, typer.Option("--small", help="Leave out the model with 82 degrees of freedom.")
    ] = False,
    force: options.ForceOption = False,
) -> None:
    """Compute the tables and figures of the paper and say which of its conclusions hold."""
    check_folder(output, force=force)
    from wspd_design.reporting.reproduction import write_reproduction

    with progress() as tell:
        written = write_reproduction(output, tell, locomotive=not small)
    for path in written:
        console().print(f"Written: {path}", style="bold", markup=False, soft_wrap=True)
