"""Notices, such as a missing compiler or letters that a font lacks, as plain sentences for the user."""

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO


@contextmanager
def plain_notices() -> Iterator[None]:
    """Print each notice of the program once, as one line on standard error without file and code."""
    said: set[str] = set()
    usual = warnings.showwarning

    def show(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        if category is not UserWarning and category.__module__ != "wspd_design.parameters.versions":
            usual(message, category, filename, lineno, file, line)
            return
        sentence = " ".join(str(message).split()).rstrip(".") + "."
        if sentence not in said:
            said.add(sentence)
            print(f"wspd: {sentence}", file=sys.stderr)

    with warnings.catch_warnings():
        warnings.filterwarnings(
            "always", category=UserWarning, module=r"wspd_design\.(simulation|reporting)\."
        )
        warnings.showwarning = show
        yield
