"""Takes the attachments out of a report, HTML or PDF, that may come from a stranger.

Nothing of the file is run, followed or written: it gives names and contents, and every limit is checked before they
are believed.
"""

import base64
import binascii
import re
from collections.abc import Iterable
from html import unescape
from pathlib import Path
from typing import NoReturn

from wspd_design.parameters.errors import UserError

MOST_BYTES, MOST_FILES, LONGEST_NAME = 64_000_000, 300, 200
_LINK = re.compile(
    rb'<a (?:id="[^"<>]{1,1200}" )?download="([^"<>]{1,1200})" href="data:[a-z/+.-]{1,60};base64,([A-Za-z0-9+/=]*)">'
)
_FORBIDDEN = re.compile(r'[\x00-\x1f\x7f/\\:*?"<>|]')
_ISOLATES = {
    ord("\N{FIRST STRONG ISOLATE}"): None,
    ord("\N{POP DIRECTIONAL ISOLATE}"): None,
}  # that printing adds
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\.|$)")  # names of devices, on Windows


def attached_files(path: Path) -> dict[str, str]:
    """Return the text of each attachment by its name.

    Parameters
    ----------
    path : Path
        A report that ``wspd report`` wrote.

    Raises
    ------
    UserError
        If the file is no such report, or anything in it is larger, longer or named otherwise than in one.
    """
    content = read_limited(path)
    match path.suffix.lower():
        case ".html":
            found = _of_html(content, path)
        case ".pdf":
            found = _of_pdf(content, path)
        case _:
            raise UserError(f"{path} must be a report, whose name ends in .html or .pdf")
    return _checked(found, path)


def read_limited(path: Path) -> bytes:
    """Read a file that is not too large.

    Raises
    ------
    UserError
        If it cannot be read, or is larger than any report.
    """
    try:
        if not path.is_file():
            raise UserError(f"{path} is not a file; name a report that wspd report wrote")
        with path.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise UserError(f"{path} cannot be read ({error.strerror}); check the path") from None
    if len(content) > MOST_BYTES:
        raise UserError(f"{path} has more than {MOST_BYTES / 1e6:g} MB; no report is that large")
    return content


def _refuse(path: Path, why: str) -> NoReturn:
    raise UserError(f"{path} is not a report as wspd report writes it: {why}; take the original file")


def _of_html(content: bytes, path: Path) -> list[tuple[str, bytes]]:
    """Find the links as the template writes them; no other text of the page matters."""
    found: list[tuple[str, bytes]] = []
    for match in _LINK.finditer(content):
        if len(found) == MOST_FILES:
            _refuse(path, f"it has more than {MOST_FILES} attachments")
        try:
            name = unescape(match[1].decode("utf-8"))
            found.append((name, base64.b64decode(match[2], validate=True)))
        except (UnicodeDecodeError, binascii.Error) as error:
            _refuse(path, f"an attachment is damaged ({error})")
    return found


def _of_pdf(content: bytes, path: Path) -> list[tuple[str, bytes]]:
    """Read the embedded files by a library, which limits what a stream may unpack to."""
    import io
    import logging

    import pypdf

    logging.getLogger("pypdf").setLevel(logging.CRITICAL)  # what is wrong is told here, in one sentence
    found: list[tuple[str, bytes]] = []
    try:
        for each in pypdf.PdfReader(io.BytesIO(content)).attachment_list:
            if len(found) == MOST_FILES or sum(len(made) for _, made in found) > MOST_BYTES:
                break
            found.append((each.alternative_name or each.name, each.content))
    except Exception as error:  # a damaged file makes the library fail in any way
        _refuse(path, f"its attachments cannot be read ({type(error).__name__})")
    return found


def _checked(found: Iterable[tuple[str, bytes]], path: Path) -> dict[str, str]:
    """Refuse names that are no plain names of files, and contents that are no text."""
    files: dict[str, str] = {}
    taken: set[str] = set()
    total = 0
    for written, content in found:
        name = written.translate(_ISOLATES)
        total += len(content)
        if total > MOST_BYTES:
            _refuse(path, f"its attachments have more than {MOST_BYTES / 1e6:g} MB")
        if not is_plain(name):
            _refuse(path, f"{name[:80]!a} is not the name of an attachment")
        if name.casefold() in taken:
            _refuse(path, f"two attachments are called {name!a}")
        taken.add(name.casefold())
        try:
            files[name] = content.decode("utf-8")
        except UnicodeDecodeError:
            _refuse(path, f"the attachment {name!a} is not text")
    if not files:
        _refuse(path, "nothing is attached")
    return files


def is_plain(name: str) -> bool:
    """Tell whether a name is that of a file in whatever folder it is put into, on every system."""
    return not (
        not name
        or len(name.encode("utf-8", errors="replace")) > LONGEST_NAME
        or name.startswith((".", "-", " "))
        or name.endswith((".", " "))
        or _FORBIDDEN.search(name)
        or _RESERVED.match(name)
    )
