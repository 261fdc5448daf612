"""Search for what else a band of slip bears: pulses that begin late, and noise of the measured speeds."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from wspd_design.certificates.search.slip_band.chain import Sought, Spent, begun, next_slower
from wspd_design.certificates.search.slip_band.search import alone
from wspd_design.certificates.theorems.slip_band.loop import Conditions
from wspd_design.certificates.theorems.slip_band.proof import Proof
from wspd_design.certificates.theorems.slip_band.statement import box_of

DELAYS = tuple(map(Fraction, ("1/16", "1/8", "1/4", "1/2", "3/4")))  # of the sample
NOISES = tuple(
    map(Fraction, ("0.00005", "0.0001", "0.0002", "0.0005", "0.001", "0.002", "0.005", "0.01", "0.02"))
)  # m/s
ALONE = Fraction(1, 4)  # of the box, where more than one cell was needed


def latest(sought: Sought, found: Proof) -> Proof | None:
    """Find ellipsoids for pulses that begin as late as some of :data:`DELAYS`."""
    exact = sought.conditions
    return _most(sought, found, [exact._replace(delay=each) for each in DELAYS if each > exact.delay])


def noisiest(sought: Sought, found: Proof) -> Proof | None:
    """Find ellipsoids for as much noise as some of :data:`NOISES`."""
    return _most(sought, found, [sought.conditions._replace(noise=each) for each in NOISES])


def _most(sought: Sought, found: Proof, harder: Sequence[Conditions]) -> Proof | None:
    """Find ellipsoids in one cell for the last conditions that have them; those before are easier."""
    share = found.share if len(found.cells) == 1 else min(ALONE, found.share)
    cell, windows = box_of(sought.problem, share), len(sought.windows)
    borne = 0
    for conditions in harder:
        harder_one = replace(sought, conditions=conditions)
        # At the lowest speed slips move fastest, at the highest there is least torque to vent.
        if any(
            next_slower(harder_one, cell, window, begun(harder_one, cell), Spent()) is None
            for window in (windows - 1, 0)
        ):
            break
        borne += 1
    for conditions in harder[:borne][::-1]:
        proof = alone(replace(sought, conditions=conditions), share)
        if proof is not None:
            return proof
    return None
