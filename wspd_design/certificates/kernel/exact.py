"""Claims that are decided without a search: a number is positive, two formulas are the same function.

Their certificate is only the fingerprint of what was claimed. The checker makes the claim again from the design and
the installed functions and decides it anew.
"""

import hashlib
import json
import time
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from wspd_design.certificates.kernel.checker import Verdict
from wspd_design.certificates.kernel.claim import model_text, text
from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.kernel.identity import same
from wspd_design.certificates.records import Hypothesis, Proof, Status

FORMAT = "wspd-exact/1"
MOST_BYTES = 10_000


class ExactClaim(Protocol):
    """What can be decided by exact arithmetic alone."""

    @property
    def name(self) -> str:
        """What is claimed, in words that do not change with the numbers."""

    def statement(self) -> str:
        """Return what is claimed, with its numbers."""

    def content(self) -> list[str]:
        """Return all that the claim depends on."""

    def holds(self) -> bool:
        """Decide."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Positive:
    """A number is greater than zero."""

    quantity: str
    value: Fraction
    unit: str

    @property
    def name(self) -> str:
        """What is claimed."""
        return f"{self.quantity} > 0"

    def statement(self) -> str:
        """Return the claim with the number."""
        return f"{self.quantity} = {float(self.value):.6g} {self.unit} > 0".replace(" - ", " ")

    def content(self) -> list[str]:
        """Return name, exact number and unit."""
        return [self.name, text(self.value), self.unit]

    def holds(self) -> bool:
        """Compare."""
        return self.value > 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Identity:
    """Two SymPy expressions are the same function wherever both are defined."""

    name: str
    left: Any
    right: Any

    def statement(self) -> str:
        """Return the claim, which has no numbers."""
        return self.name

    def content(self) -> list[str]:
        """Return name and text of both sides."""
        return [self.name, model_text(self.left), model_text(self.right)]

    def holds(self) -> bool:
        """Compare both sides in a prime field."""
        return same(self.left, self.right)


def digest(claim: ExactClaim) -> str:
    """SHA-256 of everything that is claimed."""
    return hashlib.sha256(json.dumps([FORMAT, *claim.content()]).encode()).hexdigest()


def prove(claim: ExactClaim) -> Proof | None:
    """Return the proof of a claim that the checker accepts, else None."""
    fingerprint = digest(claim)
    certificate = json.dumps({"format": FORMAT, "claim": claim.name, "claim_sha256": fingerprint}, indent=1)
    verdict = check(claim, certificate)
    if not verdict.accepted:
        return None
    return Proof(
        claim=claim.name,
        statement=verdict.statement,
        claim_hash=fingerprint,
        certificate=certificate,
        leaves=verdict.leaves,
        seconds=verdict.seconds,
    )


def hypothesis(claim: ExactClaim, proof: Proof | None) -> Hypothesis:
    """State a claim with the verdict on it."""
    status = Status.REFUTED if proof is None else Status.PROVED
    return Hypothesis(text=claim.statement(), status=status)


def check(claim: ExactClaim, certificate: str) -> Verdict:
    """Decide whether a claim holds and a certificate belongs to it.

    Parameters
    ----------
    claim : ExactClaim
        From the design and the installed functions.
    certificate : str
        JSON text; it may be anything.
    """
    started = time.perf_counter()
    reason, accepted = "exact arithmetic shows it", False
    try:
        _read(claim, certificate)
        if not claim.holds():
            raise Refused(f"it is false that {claim.statement()}")
        accepted = True
    except Refused as refusal:
        reason = str(refusal)
    return Verdict(
        accepted=accepted,
        statement=claim.statement() if accepted else "",
        reason=reason,
        leaves=int(accepted),
        seconds=time.perf_counter() - started,
    )


def _read(claim: ExactClaim, certificate: str) -> None:
    """Refuse a certificate that is none, or belongs to another claim."""
    if len(certificate) > MOST_BYTES:
        raise Refused("the certificate is too long")
    try:
        content = json.loads(certificate)
    except (ValueError, RecursionError):
        raise Refused("the certificate is no JSON") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise Refused(f"the certificate does not have the format {FORMAT}")
    if content.get("claim_sha256") != digest(claim):
        raise Refused("the certificate belongs to another claim")
