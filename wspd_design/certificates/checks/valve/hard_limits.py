"""What no law can change: how far the slip may stray before even a brake that vents fully does not bring it back.

The controller does not matter but for its sample time: a deviation is seen up to one sample late.
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Effort, Stated
from wspd_design.certificates.memory import recall
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.prover import prove
from wspd_design.certificates.search.recovery_samples import Samples, sample
from wspd_design.certificates.search.settle import enclose, settle, stated_of
from wspd_design.certificates.setting.domain import BASIC
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.theorems.recovery import (
    DEVIATION,
    HARD_LIMITS,
    growth_claim,
    passes,
    place_of,
    reach,
    share_claim,
    torque_claim,
)
from wspd_design.parameters.units import KMH

TIGHT = 0.95  # share up to which a proof is tried: it costs the more the closer it comes to 1
GROWTH_TOLERANCE, TORQUE_TOLERANCE = 0.05, 100.0  # -, N m
TRIALS = 12  # of a counterexample
SPEEDS = 12  # at which the lowest one of a proof is sought


def search(problem: Problem) -> Mapping[str, Stated]:
    """Prove that full venting brings a deviation back, from as low a speed as possible; or find where it does not."""
    HARD_LIMITS.obligations(problem)
    stated = {
        "torque": settle(torque_claim(problem), tolerance=TORQUE_TOLERANCE),
        "growth": enclose(growth_claim(problem), tolerance=GROWTH_TOLERANCE),
    }
    escape = _escape(problem)
    if escape:
        stated["escape"] = Stated(place=escape)
    return {**stated, "share": _share(problem)}


def _share(problem: Problem) -> Stated:
    """Prove the condition from as low a speed on as seems possible; the lowest one is sought by halving."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)[:-1].tolist()
    boxes = 0

    def proved(from_speed: float) -> Stated | None:
        nonlocal boxes
        claim = share_claim(problem, DEVIATION, speed=(from_speed, problem.speeds[1]))
        claim = replace(claim, bound=Fraction(TIGHT))
        found = prove(claim)
        boxes += found.boxes
        return stated_of(claim, found) if found.tree else None

    everywhere = proved(problem.speeds[0])
    if everywhere:
        return everywhere
    best, low, high = None, 0, len(speeds)  # fails from the speed at low on, holds from that at high on
    while high - low > 1:
        middle = (low + high) // 2
        found = proved(speeds[middle])
        low, high, best = (low, middle, found) if found else (middle, high, best)
    return best or Stated(effort=Effort(boxes=boxes, undecided=1.0))


def _samples(problem: Problem) -> Samples:
    return recall(["samples of recovery", model_hash(problem)], lambda: sample(problem))


def _escape(problem: Problem) -> dict[str, float] | None:
    """Return the fastest sampled point at which the slip passes slip_max for certain."""
    import numpy as np

    samples, ranges = _samples(problem), place_of(problem)
    for k in np.flatnonzero(samples.worst < DEVIATION)[::-1][:TRIALS]:
        sampled = dict(zip(BASIC, map(float, samples.tightest[k]), strict=True))
        at = {
            name: min(max(sampled[name] if name in sampled else problem.nominal(name), low), high)
            for name, (low, high) in ranges.items()
        }
        try:
            passes(problem, {"vent time": problem.nominal("vent time"), **at}, DEVIATION, Work())
        except Refused:
            continue
        return at
    return None


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - samples alone are shown
    """Return the recoverable deviation over speed beside the one asked for, and the growth."""
    import numpy as np

    samples = _samples(problem)
    speeds = samples.speeds * KMH
    axes = ("speed [km/h]", "recoverable deviation of the slip [-]")
    return Figures(
        series=(
            series("nominal", *axes, speeds, samples.nominal),
            series("worst corner of mass, inertia and mu0", *axes, speeds, samples.worst),
            series("guaranteed there", *axes, speeds, np.minimum(samples.guaranteed, reach(problem))),
            level("asked for", *axes, speeds, DEVIATION),
            series(
                "worst corner",
                "speed [km/h]",
                "growth within a sample [-]",
                speeds,
                np.maximum(samples.growth, 1.0),
            ),
        ),
        remark=_least(samples),
    )


def _least(samples: Samples) -> str:
    least = int(samples.worst.argmin())
    return (
        "By integration, over the corners of mass, inertia and mu0, the recoverable deviation falls to "
        f"{samples.worst[least]:.3g}, at {samples.speeds[least] * KMH:.3g} km/h."
    )


CHECK = Check(theorem=HARD_LIMITS, search=search, figures=figures)
