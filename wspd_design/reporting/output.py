"""Writes a report to a file, whole or not at all."""

from pathlib import Path

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.writing import write_whole
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
    content = rendered(document, path)
    write_whole(path, lambda part: part.write_bytes(content))


def rendered(document: Document, path: Path) -> bytes:
    """Return a document as the bytes of a file of this name, of which only the ending matters.

    Raises
    ------
    UserError
        If the ending is unknown.
    """
    match path.suffix.lower():
        case ".html":
            from wspd_design.reporting.html import render_html

            return render_html(document).encode()
        case ".pdf":
            from wspd_design.reporting.pdf import render_pdf

            return render_pdf(document)
    raise UserError(f"report {path}: the name must end in .html or .pdf, which chooses the format")
