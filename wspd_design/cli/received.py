"""A report that somebody else may have written: its attachments, and the folder that they are laid out in."""

import hashlib
from collections.abc import Iterator, Mapping
from contextlib import chdir, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from wspd_design.cli.report_call import ReportCall, check_names, read_call
from wspd_design.design.own_controller import is_own_controller
from wspd_design.parameters.errors import UserError
from wspd_design.reporting.attached import attached_files, read_limited
from wspd_design.reporting.attachments import RECORD, SUMS
from wspd_design.studies.inputs import COMMAND, attached_name, file_of
from wspd_design.studies.previous import PREVIOUS, Previous, previous
from wspd_design.studies.provenance import InputFile


@dataclass(frozen=True, slots=True, kw_only=True)
class Received:
    """What a report brings with it."""

    path: Path
    files: Mapping[str, str]  # text of each attachment
    record: Mapping[str, Any]  # its report.json
    call: ReportCall


def receive(path: Path) -> Received:
    """Read a report and what it says about the command that made it; nothing of it is run.

    Raises
    ------
    UserError
        If it is no report, or no command makes it.
    """
    files = attached_files(path)
    for name in (RECORD, SUMS):
        if name not in files:
            raise UserError(f"{path} has no {name} attached; it is no report of this version of the program")
    record = previous(files[RECORD], f"{RECORD} of {path}").record
    if COMMAND not in files:
        raise UserError(
            f"{path} was made by a program in Python, and no command makes it again; run that program"
        )
    return Received(path=path, files=files, record=record, call=read_call(files[COMMAND]))


def older_report(path: Path) -> Previous:
    """Return the record of an older report, from the report or from its ``report.json``.

    Raises
    ------
    UserError
        If the file is neither.
    """
    if path.suffix.lower() != ".json":
        files = attached_files(path)
        if RECORD not in files:
            raise UserError(f"{path} has no {RECORD} attached; it is no report of a design")
        return previous(files[RECORD], f"{RECORD} of {path}")
    return previous(read_limited(path).decode("utf-8", errors="replace"), str(path))


def damaged(received: Received) -> str:
    """Name the first attachment that is not the one of ``SHA256SUMS``; nothing if all are."""
    stated = {}
    for line in received.files[SUMS].splitlines():
        digest, _, name = line.partition("  ")
        stated[name] = digest
    found = {
        name: hashlib.sha256(text.encode()).hexdigest()
        for name, text in received.files.items()
        if name != SUMS
    }
    wrong = [name for name in (*found, *stated) if found.get(name) != stated.get(name)]
    return wrong[0] if wrong else ""


@contextmanager
def laid_out(received: Received, law: str | None) -> Iterator[Path]:
    """Work in a temporary folder with the attachments that a report is made from.

    Parameters
    ----------
    received : Received
        The report.
    law : str or None
        ``FILE.py:NAME`` that the user has read and allows to run: it must be the attached one.

    Raises
    ------
    UserError
        If the report needs a file that is not attached, or code of its own that the user has not allowed.
    """
    inputs = [
        InputFile(name=name, text=text, meaning="")
        for name, text in received.files.items()
        if name.endswith((".toml", ".py")) or name == PREVIOUS
    ]
    _check_code(received, law)
    with TemporaryDirectory(prefix="wspd-") as name:
        folder = Path(name)
        for each in inputs:
            (folder / each.name).write_text(each.text, encoding="utf-8", newline="")
        with chdir(folder):
            check_names(received.call, inputs)
            yield folder


def _check_code(received: Received, law: str | None) -> None:
    """Refuse to run code that came with a report, unless the user names the same code in files of his own."""
    code = {name: text for name, text in received.files.items() if name.endswith(".py")}
    called = received.call.law
    if not is_own_controller(called) and not code:
        return
    if law is None:
        raise UserError(
            f"{received.path} is about the law {called}, whose Python code is attached; to let it run, save it, "
            f"read it, and name it: {called!a}"
        )
    file = file_of(law)
    if file is None or attached_name(law) != called:
        raise UserError(
            f"{received.path} is about the law {called!a}, not about {law}; name the file that you saved"
        )
    for name, text in code.items():
        own = file.parent / name
        if not own.is_file() or own.read_text(encoding="utf-8-sig") != text:
            raise UserError(
                f"{own} is not the file {name!a} that {received.path} has attached; save it and read it"
            )
