"""Places of the numbers in a written ellipsoid, and what is told of a certificate with other proofs."""

from wspd_design.certificates.checks.frame import accepted
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.setting.slip_loop import DISTURBANCES
from wspd_design.certificates.theorems.band import SLIP_BAND

SUPPLY, NEAR, SETTLES, SHORTEST, LONGEST, BACK, ROOM, BEYOND, CURVE = range(1, 10)
Q, CENTER, DRIFT, MOVES, ALPHA, OFFSET, SHARES, INSIDE = slice(10, 25), 25, 30, slice(31, 36), 36, 37, 38, -1
STEADY, CHANGE = -3, -2  # shares of the steady drift and of its change
# Shares of what disturbs without noise, with a constant slip and without dead band
DRIFTS = tuple(
    SHARES + k for k, name in enumerate(DISTURBANCES) if name.endswith("drift") and name != "slip drift"
)


def told_with(problem, certificate, proofs):
    """The certificate with other proofs of ellipsoids; what is known of the friction is not decided again."""
    wanted = [each for each in SLIP_BAND.obligations(problem) if each.key in proofs]
    decided = accepted(wanted, {key: Stated(proof=proof) for key, proof in proofs.items()})
    return SLIP_BAND.tell(problem, {**certificate.findings, **decided})
