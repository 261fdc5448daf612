"""Writes a report to a file, whole or not at all."""

import os
import tempfile
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
            f"report {path} cannot be written ({error.strerror}); choose an existing folder with write access"
        ) from error


def _write_whole(path: Path, content: bytes) -> None:
    """Write to a temporary file beside the target and rename it, which is one step for every reader."""
    if path.is_dir():
        raise IsADirectoryError(0, "it is a folder")
    descriptor, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
        umask = os.umask(0)
        os.umask(umask)
        Path(name).chmod(0o666 & ~umask)  # mkstemp keeps files private; a report is a file like any other
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
