"""``wspd schema``: the JSON Schema of vehicle or rail files, with which editors help and check while one writes."""

from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.console import console, print_json
from wspd_design.cli.output import check_output, write_text
from wspd_design.exchange.parameter_schema import KINDS, file_schema
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.words import did_you_mean


def schema(
    kind: Annotated[str, typer.Argument(metavar="KIND", help=" or ".join(KINDS) + ".")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Write it to a file.", show_default=False),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Print the JSON Schema of vehicle or rail files, for editors."""
    found = next((each for each in KINDS if each == kind), None)
    if found is None:
        raise UserError(
            f'no files of "{kind}" have a schema{did_you_mean(kind, KINDS)}; there are {" and ".join(KINDS)}'
        )
    if output is None:
        print_json(file_schema(found))
        return
    import json

    check_output(output, force=force)
    write_text(output, json.dumps(file_schema(found), indent=2, ensure_ascii=False) + "\n", force=force)
    console().print(f"Written: {output}", style="bold", markup=False, soft_wrap=True)
    console().print(
        f'The first line of a {kind} file that names it is: "#:schema {output}".',
        markup=False,
        soft_wrap=True,
    )
