"""``wspd docs``: the pages of documentation that came with the program, read where there is no network."""

import sys
from typing import Annotated

import typer

from wspd_design.cli.console import console, spaced, table
from wspd_design.cli.pages import page_text, pages, title


def docs(
    page: Annotated[
        str | None,
        typer.Argument(
            metavar="PAGE",
            help="For example own-controller, theory#band or docs/json.md, as sentences cite it.",
            autocompletion=lambda incomplete: [name for name in pages() if name.startswith(incomplete)],
        ),
    ] = None,
) -> None:
    """Show a page of the documentation that came with the program, or list all of them."""
    if page is None:
        _list()
        return
    text = page_text(page)
    if not sys.stdout.isatty():
        print(text, end="")
        return
    from rich.markdown import Markdown

    console().print(Markdown(text))


def _list() -> None:
    shown = table("Page", "Title")
    for name, path in pages().items():
        shown.add_row(name, title(path))
    console().print(spaced(shown))
    console().print("Read one: wspd docs tutorial", style="dim", markup=False)
