"""Writes a report to a file, whole or not at all."""

import os
from contextlib import suppress
from pathlib import Path

from wspd_design.parameters.errors import UserError
from wspd_design.reporting.blocks import Document


def write_document(document: Document, path: str | Path) -> None:
    """Render a document to the format that the ending of the file name asks for, ``.html`` or ``.pdf``.

    The file appears when it is complete; one of the same name is replaced. Until then nothing is visible.

    Raises
    ------
    UserError
        If the ending is unknown or the file cannot be written.
    """
    path = Path(path)
    match path.suffix.lower():
        case ".html":
            from wspd_design.reporting.html import render_html

            content = render_html(document).encode()
        case ".pdf":
            from wspd_design.reporting.pdf import render_pdf

            content = render_pdf(document)
        case _:
            raise UserError(f"report {path}: the name must end in .html or .pdf, which chooses the format")
    try:
        _write_whole(path, content)
    except OSError as error:
        raise UserError(
            f"report {path} cannot be written ({error.strerror}); choose a folder that exists and is writable"
        ) from error


def _write_whole(path: Path, content: bytes) -> None:
    """Write to a temporary file beside the target and rename it, which is one step for every reader."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(content)
        part.replace(path)
    except BaseException:
        with suppress(OSError):  # nothing to remove when the folder is missing
            part.unlink()
        raise
