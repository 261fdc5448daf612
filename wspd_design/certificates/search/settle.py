"""From a claim to a finding: the prover searches, the checker decides, a witness is evaluated exactly."""

import json
import time
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from math import floor, inf, isfinite, log10, nextafter

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.claim import Claim, text
from wspd_design.certificates.records import Proof, Range, Status
from wspd_design.certificates.search.prover import Outcome, extreme, prove

PACKAGES = ("crival", "casadi", "python-flint", "sympy")
GUARD = 1e-12  # relative; what the prover leaves to the rounding of the checker


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What is known about a claim.

    ``extreme`` encloses the supremum of the expression (for ``>=`` the infimum). Its end on the side of the bound
    is proved if the status is PROVED, otherwise the prover's word; the other end is attained at ``place``.
    """

    status: Status  # PROVED, REFUTED or UNDECIDED
    claim: Claim  # what was settled: if proved, with nearly the tightest bound
    asked: Fraction  # bound that was asked for
    extreme: Range
    place: dict[str, float]  # of the attained end: every variable by name, SI units
    undecided: float  # share of the box that the prover left open
    boxes: int
    seconds: float
    proof: Proof | None
    reason: str  # why it is undecided, else empty

    @property
    def ends(self) -> tuple[float, float]:
        """Both ends of the extreme; one is infinite if the expression is not bounded on the boxes seen so far."""
        assert self.extreme.low is not None
        assert self.extreme.high is not None
        return self.extreme.low, self.extreme.high

    @property
    def margin(self) -> Range:
        """Distance of the extreme from the bound that was asked for, positive where the claim holds.

        Its lower end is open if the search had to stop before it enclosed the extreme.
        """
        sign, (attained, far) = 1, self.ends
        if self.claim.relation == ">=":
            sign, attained, far = -1, far, attained
        return Range(
            low=_below(sign * (self.asked - Fraction(far))) if isfinite(far) else None,
            high=_above(sign * (self.asked - Fraction(attained))),
            unit=self.claim.unit,
        )


def settle(claim: Claim, *, tolerance: float) -> Finding:
    """Prove a claim with nearly the tightest bound that holds, or refute it, or say how far one got.

    Parameters
    ----------
    claim : Claim
        What is asked.
    tolerance : float
        Width of the enclosure of the extreme value, in the unit of the claim.

    Returns
    -------
    Finding
        PROVED only if the checker accepts; REFUTED only if exact evaluation at the witness denies the claim.
        If proved, the ``claim`` of the finding has the bound that was proved, at least as tight as what was
        asked.
    """
    started = time.perf_counter()
    found = extreme(claim, tolerance=tolerance)
    target = tightest(claim, found, tolerance)
    if not _denied(claim, found) and not _at_least(target, claim):
        # The bound lies within the tolerance of the extreme value, or the budget was used up.
        target, found = claim, prove(claim)
    attained = checker.value(claim, found.point)
    if _denied(claim, found) and (
        (attained[0] > claim.bound) if claim.relation == "<=" else (attained[1] < claim.bound)
    ):
        return _finding(claim, found, Status.REFUTED, attained, _far(claim, found), started, claim.bound)
    return _checked(target, found, attained, started, claim.bound)


def _denied(claim: Claim, found: Outcome) -> bool:
    """Whether the prover found a point at which a claim does not hold."""
    return found.low > claim.bound if claim.relation == "<=" else found.high < claim.bound


def _at_least(one: Claim, other: Claim) -> bool:
    """Whether the bound of one claim is at least as tight as that of the other."""
    return one.bound <= other.bound if one.relation == "<=" else one.bound >= other.bound


def _far(claim: Claim, found: Outcome) -> float:
    """The end of the enclosure that no point attains."""
    return found.high if claim.relation == "<=" else found.low


def enclose(claim: Claim, *, tolerance: float) -> Finding:
    """Prove nearly the tightest bound of a claim's expression; the bound of the claim itself does not matter.

    Parameters
    ----------
    claim : Claim
        Expression, box and direction.
    tolerance : float
        Width of the enclosure of the extreme value, in the unit of the claim.

    Returns
    -------
    Finding
        PROVED or UNDECIDED; its claim has the bound that was proved.
    """
    started = time.perf_counter()
    found = extreme(claim, tolerance=tolerance)
    attained = checker.value(claim, found.point)
    return _checked(tightest(claim, found, tolerance), found, attained, started, claim.bound)


def _checked(
    claim: Claim, found: Outcome, attained: tuple[Fraction, Fraction], started: float, asked: Fraction
) -> Finding:
    """Let the checker decide about what the prover found."""
    far = _far(claim, found)
    if not found.tree:
        share = (
            f"{found.undecided:.2g} of the box is undecided after {found.boxes} boxes and {found.seconds:.0f} s; "
            "more time may decide it"
        )
        return _finding(claim, found, Status.UNDECIDED, attained, far, started, asked, reason=share)
    certificate = certificate_text(claim, found)
    verdict = checker.check(claim, certificate)
    if not verdict.accepted:
        reason = f"the checker refuses the proof: {verdict.reason}"
        return _finding(claim, found, Status.UNDECIDED, attained, far, started, asked, reason=reason)
    proof = Proof(
        claim=claim.name,
        statement=verdict.statement,
        claim_hash=claim.digest(),
        certificate=certificate,
        leaves=verdict.leaves,
        seconds=verdict.seconds,
    )
    return _finding(claim, found, Status.PROVED, attained, float(claim.bound), started, asked, proof=proof)


def tightest(claim: Claim, found: Outcome, tolerance: float) -> Claim:
    """Return the claim with the bound that the prover reached, rounded outwards to a short decimal."""
    if not isfinite(_far(claim, found)):
        return claim  # nothing is known yet
    digits = 1 - floor(log10(tolerance))
    step = Fraction(1, 10) ** digits
    if claim.relation == "<=":
        reached = Fraction(found.high) * (1 + Fraction(GUARD) * (1 if found.high > 0.0 else -1))
        near = float(-(-reached // step) * step)
        bound = near if Fraction(near) >= reached else nextafter(near, inf)
    else:
        reached = Fraction(found.low) * (1 - Fraction(GUARD) * (1 if found.low > 0.0 else -1))
        near = float(reached // step * step)
        bound = near if Fraction(near) <= reached else nextafter(near, -inf)
    return replace(claim, bound=Fraction(bound))


def certificate_text(claim: Claim, found: Outcome) -> str:
    """Write the certificate; only format, hash and tree matter to the checker, the rest is for people.

    Times are left out, so that the same claim gives the same text.
    """
    content = {
        "format": checker.FORMAT,
        "claim": claim.name,
        "claim_sha256": claim.digest(),
        "relation": claim.relation,
        "bound": text(claim.bound),
        "unit": claim.unit,
        "variables": [v.name for v in claim.free],
        "tree": found.tree,
        "prover": {"boxes": found.boxes, "versions": versions()},
    }
    return json.dumps(content, indent=1)


@cache
def versions() -> dict[str, str]:
    """Versions of what searches and what checks."""
    found = {}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "missing"
    return found


def engine() -> str:
    """Name what searches and what checks, with versions."""
    return ", ".join(f"{package} {number}" for package, number in versions().items())


def _finding(
    claim: Claim,
    found: Outcome,
    status: Status,
    attained: tuple[Fraction, Fraction],
    far: float,
    started: float,
    asked: Fraction,
    *,
    proof: Proof | None = None,
    reason: str = "",
) -> Finding:
    ends = (_below(attained[0]), far) if claim.relation == "<=" else (far, _above(attained[1]))
    return Finding(
        status=status,
        claim=claim,
        asked=asked,
        extreme=Range(low=ends[0], high=ends[1], unit=claim.unit),
        place={v.name: float(found.point.get(v.name, v.low)) for v in claim.variables},
        undecided=found.undecided if status is Status.UNDECIDED else 0.0,
        boxes=found.boxes,
        seconds=time.perf_counter() - started,
        proof=proof,
        reason=reason,
    )


def _below(number: Fraction) -> float:
    near = float(number)
    return near if Fraction(near) <= number else nextafter(near, -inf)


def _above(number: Fraction) -> float:
    near = float(number)
    return near if Fraction(near) >= number else nextafter(near, inf)
