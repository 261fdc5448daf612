"""Certificates as JSON files: what is claimed, for people, and the proofs, for the checker.

Nothing in a file is believed. :mod:`wspd_design.certificates.replay` rebuilds the claims from the design and reads
nothing but the name of the check, its status, the proofs, and the witness of what is refuted.
"""

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.records import Certificate, Point, Status

SCHEMA = "wspd-certificate/1"
MOST_BYTES = 20_000_000
MOST_PROOFS = 100
MOST_POINTS = 100


class Stated(NamedTuple):
    """What a file states, nothing of it checked."""

    check: str
    status: Status
    proofs: tuple[str, ...]  # JSON, one per statement
    witness: tuple[Point, ...]  # in the units that people read


def file_name(certificate: Certificate) -> str:
    """Return the name under which a certificate is kept."""
    return f"{certificate.name}.json"


def certificate_text(certificate: Certificate) -> str:
    """Write a certificate with its proofs as JSON.

    Times are left out, so that the same design gives the same file. Floats are written without loss.
    """
    margin = certificate.margin
    content = {
        "schema": SCHEMA,
        "check": certificate.name,
        "status": certificate.status.name,
        "claim": certificate.claim,
        "explanation": certificate.explanation,
        "margin": None if margin is None else {"low": margin.low, "high": margin.high, "unit": margin.unit},
        "worst_point": _places(certificate.worst_point),
        "witness": _places(certificate.witness),
        "hypotheses": [{"text": each.text, "status": each.status.name} for each in certificate.hypotheses],
        "assumptions": list(certificate.assumptions),
        "undecided": certificate.undecided,
        "reference": certificate.reference,
        "engine": certificate.engine,
        "model_sha256": certificate.model_hash,
        "proofs": [json.loads(each.certificate) for each in certificate.proofs],
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def read_certificate(text: str) -> Stated:
    """Read what a file states.

    Parameters
    ----------
    text : str
        It may be anything.

    Raises
    ------
    Refused
        If the text is no certificate.
    """
    content = certificate_content(text)
    proofs = content.get("proofs")
    if not isinstance(proofs, list) or len(proofs) > MOST_PROOFS:
        raise Refused("the file holds no list of proofs, or too many")
    return Stated(
        check=content["check"],
        status=Status[content["status"]],
        proofs=tuple(json.dumps(each) for each in proofs),
        witness=_points(content.get("witness")),
    )


def certificate_content(text: str) -> Mapping[str, Any]:
    """Read what stands in a file of which at least ``check`` and ``status`` are names, or refuse it."""
    if len(text) > MOST_BYTES:
        raise Refused("the file is too long for a certificate")
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        raise Refused("the file is no complete JSON") from None
    if not isinstance(content, dict) or content.get("schema") != SCHEMA:
        raise Refused(f"the file is no certificate of this version, {SCHEMA}")
    check, status = content.get("check"), content.get("status")
    if not (isinstance(check, str) and check.isascii() and check.isidentifier()):
        raise Refused("the file names no check")
    if not isinstance(status, str) or status not in Status.__members__:
        raise Refused("the file states no status")
    return content


def _points(stated: Any) -> tuple[Point, ...]:
    """Read what :func:`_places` wrote."""
    try:
        given = [(each["name"], each["value"], each["unit"]) for each in stated[:MOST_POINTS]]
        return tuple(Point(name=str(name), value=float(value), unit=str(unit)) for name, value, unit in given)
    except (TypeError, KeyError, ValueError, OverflowError):
        raise Refused("the file states no witness, not even an empty one") from None


def _places(points: tuple[Point, ...]) -> list[dict[str, Any]]:
    return [{"name": each.name, "value": each.value, "unit": each.unit} for each in points]
