"""``wspd check REPORT``: decides about every certificate that a report attaches, for the case that it attaches."""

from collections.abc import Callable
from pathlib import Path

from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import Replayed
from wspd_design.cli.received import Received, damaged, laid_out, receive
from wspd_design.design.case import load_case
from wspd_design.design.certification import check, problem_of_case
from wspd_design.parameters.errors import UserError
from wspd_design.reporting.attachments import RECORD, SUMS


def check_report(path: Path, *, law: str | None, progress: Callable[[str], None]) -> dict[str, Replayed]:
    """Decide about all certificates of a report, by the names of their files.

    A file that is not the one of ``SHA256SUMS``, that is missing, or whose verdict is not the one that the report
    states, is refused.

    Parameters
    ----------
    path : Path
        The report; it may come from a stranger.
    law : str or None
        ``FILE.py:NAME`` that the user allows to run, for a report on a law of one's own.
    progress : callable
        Told each file before it is decided about.

    Raises
    ------
    UserError
        If it is no report, or refers to what is not attached.
    """
    received = receive(path)
    stated = _stated(received)
    if wrong := damaged(received):
        return {wrong: _refused("", f"it is not the file of {SUMS}")}
    found = {}
    with laid_out(received, law):
        case = load_case(received.call.law, received.call.case_options)
        problem = problem_of_case(case, seed=received.call.seed)
        for name, status in stated.items():
            file = f"{name}.json"
            progress(f"Checking {file!a}")
            text = received.files.get(file)
            made = _refused(name, "it is not attached") if text is None else check(_braced(text), problem)
            if made.certificate is not None and (made.check, made.certificate.status.name) != (name, status):
                made = _refused(
                    name, f"{RECORD} says {status} of {name}, the file {made.certificate.status.name}"
                )
            found[file] = made
    return found


def _stated(received: Received) -> dict[str, str]:
    """Return the verdict of each check that speaks about the law."""
    checks = received.record.get("checks")
    rows = checks if isinstance(checks, list) and all(isinstance(each, dict) for each in checks) else []
    found = {str(each.get("name")): str(each.get("status")) for each in rows}
    if not found or len(found) < len(rows) or not all(name.isidentifier() for name in found):
        raise UserError(f"{RECORD} of {received.path} states no checks as reports do; take the original file")
    return {name: status for name, status in found.items() if status != Status.NOT_APPLICABLE.name}


def _braced(text: str) -> str:
    """Return the text of a certificate so that it is never taken for the name of a file; the checker refuses others."""
    return text if text.lstrip().startswith("{") else "{"


def _refused(name: str, reason: str) -> Replayed:
    return Replayed(check=name, accepted=False, reason=reason, certificate=None)
