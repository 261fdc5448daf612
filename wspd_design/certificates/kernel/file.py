"""Certificates as JSON files: what is claimed, for people, and what was found, for the checkers.

Nothing in a file is believed. :mod:`wspd_design.certificates.replay` makes the whole certificate again from the design
and the findings, and compares it with the file word for word.
"""

import json
from collections import Counter
from collections.abc import Mapping
from fractions import Fraction
from importlib.metadata import PackageNotFoundError, version
from math import isfinite
from typing import Any

from wspd_design.certificates.kernel.checker import FORMAT, FORMULAS, Refused, number, read
from wspd_design.certificates.kernel.finding import Effort, Stated
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Certificate, Point, Status

SCHEMA = "wspd-certificate/3"
OLDER = ("wspd-certificate/2",)
"""Versions that are read as well: theirs has no table of formulas."""
FOLDER = ".certificates"
"""Ending of the folder of certificates beside a design."""
PACKAGES = ("crival", "casadi", "cvxpy", "clarabel", "python-flint", "sympy")
HEARSAY = ("findings", "made_by")
"""Entries of a file that no sentence of a certificate is compared with: one is decided about, the other is idle."""
MOST_FINDINGS, MOST_NUMBERS = 2_000, 2_000
MOST_BOXES = 10**9


def file_name(certificate: Certificate) -> str:
    """Return the name under which a certificate is kept."""
    return f"{certificate.name}.json"


def certificate_text(certificate: Certificate) -> str:
    """Write a certificate with what was found as JSON, one entry a line.

    Times are left out, so that the same design gives the same file. Floats are written without loss. A formula that
    several statements have is written once.
    """
    found = {key: _stated(each.stated) for key, each in certificate.findings.items()}
    times = Counter(_json(each) for finding in found.values() for each in _formulas(finding).values())
    numbers = {formula: k for k, formula in enumerate(each for each in times if times[each] > 1)}
    content = sentences(certificate) | {
        "formulas": list(map(json.loads, numbers)),
        "findings": {key: _shortened(each, numbers) for key, each in found.items() if each},
        "made_by": versions(),
    }
    lines = [f"{_json(key)}: {_json(entry)}" for key, entry in content.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _formulas(finding: Mapping[str, Any]) -> dict[str, Any]:
    """Return the formulas of the statement that a finding proves, by their keys."""
    proof = finding.get("proof", {})
    statement = proof.get("statement", {}) if proof.get("format") == FORMAT else {}
    return {key: statement[key] for key in FORMULAS if key in statement}


def _shortened(finding: dict[str, Any], numbers: Mapping[str, int]) -> dict[str, Any]:
    """Put the numbers of formulas in place of those that the table has."""
    named = {key: numbers.get(_json(each), each) for key, each in _formulas(finding).items()}
    if not named:
        return finding
    proof = finding["proof"]
    return finding | {"proof": proof | {"statement": proof["statement"] | named}}


def _json(entry: object) -> str:
    return json.dumps(entry, ensure_ascii=False, separators=(",", ":"))


def sentences(certificate: Certificate) -> dict[str, Any]:
    """Return all that a certificate says, as JSON."""
    margin = certificate.margin
    return {
        "schema": SCHEMA,
        "check": certificate.name,
        "title": certificate.title,
        "status": certificate.status.name,
        "claim": certificate.claim,
        "explanation": certificate.explanation,
        "margin": None if margin is None else {"low": margin.low, "high": margin.high, "unit": margin.unit},
        "worst_point": _points(certificate.worst_point),
        "witness": _points(certificate.witness),
        "hypotheses": [{"text": each.text, "status": each.status.name} for each in certificate.hypotheses],
        "assumptions": list(certificate.assumptions),
        "varied": list(certificate.varied),
        "held": list(certificate.held),
        "method": certificate.method,
        "reference": certificate.reference,
        "model_sha256": certificate.model_hash,
    }


def read_certificate(written: str) -> tuple[str, Mapping[str, Any]]:
    """Return the name of the check that a file is about, and its content; or refuse it."""
    content = read(written)
    if content.get("schema") not in (SCHEMA, *OLDER):
        raise Refused(
            f"the file is not a certificate of this version, {SCHEMA}; make it again with wspd certify"
        )
    check, status = content.get("check"), content.get("status")
    if not (isinstance(check, str) and check.isascii() and check.isidentifier()):
        raise Refused("the file names no check")
    if not isinstance(status, str) or status not in Status.__members__:
        raise Refused("the file states no status")
    return check, {**content, "schema": SCHEMA}


def stated_findings(content: Mapping[str, Any]) -> dict[str, Stated]:
    """Read what a file states about obligations, or refuse it."""
    table = content.get("findings")
    if not isinstance(table, dict) or len(table) > MOST_FINDINGS:
        raise Refused("the file has no table of findings, or one that is too long")
    return {key: _read(each) for key, each in table.items()}


def _stated(stated: Stated) -> dict[str, Any]:
    """Write what is stated about an obligation; what is empty is left out."""
    effort = stated.effort
    content = {
        "proof": stated.proof,
        "place": {name: text(Fraction(at)) for name, at in stated.place.items()},
        "numbers": {name: text(Fraction(at)) for name, at in stated.numbers.items()},
        "effort": {"boxes": effort.boxes, "undecided": effort.undecided, "cut": effort.cut}
        | ({"ended": effort.ended} if effort.ended else {}),
    }
    if effort == Effort():
        del content["effort"]
    return {key: each for key, each in content.items() if each}


def _read(table: object) -> Stated:
    if not isinstance(table, dict) or not table.keys() <= {"proof", "place", "numbers", "effort"}:
        raise Refused("a finding has unknown entries")
    proof = table.get("proof")
    if proof is not None and not isinstance(proof, dict):
        raise Refused("a finding has a proof that is not an object")
    return Stated(
        proof=proof,
        place=_doubles(table.get("place", {})),
        numbers=_doubles(table.get("numbers", {})),
        effort=_effort(table.get("effort")),
    )


def _doubles(table: object) -> dict[str, float]:
    if not isinstance(table, dict) or len(table) > MOST_NUMBERS:
        raise Refused("a finding has a place or numbers that are not a table, or one that is too long")
    exact = {name: number(each) for name, each in table.items()}
    try:
        found = {name: float(each) for name, each in exact.items()}
    except OverflowError:
        raise Refused("a finding has a number that is too large") from None
    if any(Fraction(found[name]) != exact[name] for name in found):
        raise Refused("a finding has a number that is not a double")
    return found


def _effort(table: object) -> Effort:
    if table is None:
        return Effort()
    if not isinstance(table, dict) or table.keys() - {"ended"} != {"boxes", "undecided", "cut"}:
        raise Refused("a finding does not say how hard the search tried")
    boxes, undecided, cut = table["boxes"], table["undecided"], table["cut"]
    if not (type(boxes) is int and 0 <= boxes <= MOST_BOXES and type(cut) is bool):
        raise Refused("a finding does not say how hard the search tried")
    if not (type(undecided) in (int, float) and isfinite(undecided) and 0 <= undecided <= 1):
        raise Refused("a finding does not say which share of the box is undecided")
    ended = table.get("ended", {})
    if not isinstance(ended, dict):
        raise Refused("a finding does not say where the search ended")
    return Effort(boxes=boxes, undecided=float(undecided), cut=cut, ended=ended)


def versions() -> dict[str, str]:
    """Versions of what searches and what checks."""
    found = {}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "missing"
    return found


def _points(points: tuple[Point, ...]) -> list[dict[str, Any]]:
    return [{"name": each.name, "value": each.value, "unit": each.unit} for each in points]
