"""Search for what else a band of slip bears: pulses that begin late, and noise of the measured speeds."""

from collections.abc import Sequence
from fractions import Fraction

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.slip_band.search import all_windows, exactly, one_window, proof_of
from wspd_design.certificates.theorems.slip_band.loop import Conditions, Friction
from wspd_design.certificates.theorems.slip_band.proof import Proof
from wspd_design.certificates.theorems.slip_band.statement import BandLaw, box_of, windows_of

DELAYS = tuple(map(Fraction, ("1/16", "1/8", "1/4", "1/2", "3/4")))  # of the sample
NOISES = tuple(
    map(Fraction, ("0.00005", "0.0001", "0.0002", "0.0005", "0.001", "0.002", "0.005", "0.01", "0.02"))
)  # m/s
ALONE = Fraction(1, 4)  # of the box, where more than one cell was needed


def latest(problem: Problem, law: BandLaw, found: Proof) -> Proof | None:
    """Find ellipsoids for pulses that begin as late as some of :data:`DELAYS`."""
    exact = exactly(problem, law)
    return _most(problem, law, found, [exact._replace(delay=each) for each in DELAYS if each > exact.delay])


def noisiest(problem: Problem, law: BandLaw, found: Proof) -> Proof | None:
    """Find ellipsoids for as much noise as some of :data:`NOISES`."""
    exact = exactly(problem, law)
    return _most(problem, law, found, [exact._replace(noise=each) for each in NOISES])


def _most(problem: Problem, law: BandLaw, found: Proof, harder: Sequence[Conditions]) -> Proof | None:
    """Find ellipsoids in one cell for the last conditions that have them; those before are easier."""
    share = found.share if len(found.cells) == 1 else min(ALONE, found.share)
    cell, windows = box_of(problem, share), windows_of(problem)
    borne = 0
    for conditions in harder:
        # At the lowest speed slips move fastest, at the highest there is least torque to vent.
        if any(
            one_window(problem, law, cell, windows[k], found.friction[k], conditions, None, ()) is None
            for k in (-1, 0)
        ):
            break
        borne += 1
    for conditions in harder[:borne][::-1]:
        proof = alone(problem, law, found.friction, share, conditions)
        if proof is not None:
            return proof
    return None


def alone(
    problem: Problem, law: BandLaw, friction: Sequence[Friction], share: Fraction, conditions: Conditions
) -> Proof | None:
    """Find ellipsoids for a share of the box as one cell."""
    ellipsoids = all_windows(problem, law, box_of(problem, share), friction, conditions)
    return None if isinstance(ellipsoids, int) else proof_of(share, conditions, friction, ".", (ellipsoids,))
