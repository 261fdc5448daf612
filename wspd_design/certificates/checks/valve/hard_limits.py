"""What no law can change: how far the slip may stray before even a brake that vents fully does not bring it back.

The controller does not matter but for its sample time: a deviation is seen up to one sample late. See ``recovery.py``.
"""

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.frame import OutsideModel, certified, level, series
from wspd_design.certificates.kernel.subdomain import with_part
from wspd_design.certificates.records import (
    Certificate,
    Hypothesis,
    Point,
    Problem,
    Proof,
    Range,
    Series,
    Status,
)
from wspd_design.certificates.search.recovery import (
    growth_claim,
    passes,
    reach,
    share_claim,
    torque_claim,
)
from wspd_design.certificates.search.recovery_samples import SPEEDS, Samples, sample
from wspd_design.certificates.search.settle import Finding, enclose, engine, settle
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import KMH, SLIP

NAME, TITLE = "hard_limits", "Limits of recovery"
DEVIATION = 0.05  # of the slip, to be brought back: as wide as the usual band around a reference
TIGHT = 0.95  # share up to which a proof is tried: it costs the more the closer it comes to 1
SPARED, LEAST_TOLERANCE = 0.75, 0.04  # of the enclosed share: part of its distance from 1, and least
GROWTH_TOLERANCE, TORQUE_TOLERANCE = 0.05, 100.0  # -, N m
TRIALS = 12  # of a witness


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Prove that full venting brings a deviation back, from as low a speed as possible; or find where it does not."""
    domain.box(problem)
    if not has_room(problem):
        raise OutsideModel(
            f"the slips {problem.slips[0]:g} to {problem.slips[1]:g} leave no room for a deviation of {DEVIATION:g} "
            f"from the reference {problem.slip:g}"
        )
    samples = sample(problem)
    torque = settle(torque_claim(problem), tolerance=TORQUE_TOLERANCE)
    growth = enclose(growth_claim(problem), tolerance=GROWTH_TOLERANCE)
    lowest = lowest_speed(problem, samples)
    part = None if lowest is None else _part(problem, samples, lowest)
    shown = part if part and torque.status is Status.PROVED and _holds(part) else None
    everywhere = shown is not None and lowest == problem.speeds[0]
    witness = _witness(problem, samples) if torque.status is Status.PROVED else ()
    status = Status.REFUTED if witness else Status.PROVED if everywhere else Status.UNDECIDED
    worst = int(samples.worst.argmin())
    least = float(samples.worst[worst])
    known = _guaranteed(shown) if shown and everywhere else 0.0
    found = [torque, growth, *([part] if part else [])]
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"A deviation of the slip of {DEVIATION:g} above the reference {problem.slip:g}, seen one sample of "
        f"{problem.sample_time * 1e3:g} ms late, is brought back by full venting without passing {problem.slips[1]:g}, "
        f"at any frozen speed on {domain.described(problem)}. Where it is not, no law can: venting is all that a brake "
        "can do.",
        status=status,
        explanation=_explanation(problem, samples, growth, shown, witness, known),
        margin=Range(low=known - DEVIATION, high=least - DEVIATION, unit="-"),
        worst_point=(
            *domain.readable(samples.tightest[worst])[1:],
            Point(name="recoverable deviation", value=least, unit="-"),
        ),
        witness=witness,
        hypotheses=(
            verdict.hypothesis("T* > 0: some torque holds the reference", torque),
            verdict.hypothesis(f"growth within a sample <= {growth.extreme.high:.4g}", growth),
            *(
                ()
                if part is None or lowest is None
                else (
                    Hypothesis(
                        text=f"the condition holds from {lowest * KMH:.3g} km/h on", status=part.status
                    ),
                )
            ),
        ),
        assumptions=(
            "frozen train speed: a train that slows down meanwhile is left out, which counts at the lowest speeds",
            "static wheel load",
            "the slip stood at its reference and the torque at T* before; the law holds it until its next sample",
            "exact measurement, no computing time, full supply pressure",
            "a deviation below the reference is benign: the wheel falls back to rolling and brakes less",
        ),
        method="interval branch and bound of a sufficient condition, replayed by the independent checker; "
        "counterexamples by integration, confirmed in exact balls",
        resolution=f"{sum(each.boxes for each in found)} boxes; {SPEEDS} speeds with all corners of the parameters "
        "and the points between them where T* = T_max",
        reference="eqs. (9), (19); docs/theory.md#hard-limits",
        undecided=0.0 if status is not Status.UNDECIDED else _open(problem, lowest if shown else None),
        engine=engine(),
        proofs=(*verdict.proofs(torque, growth), *(_proofs(problem, shown) if shown else ())),
        series=_plots(problem, samples),
    )


def has_room(problem: Problem) -> bool:
    """Whether the deviation lies within the range of slip."""
    return problem.slips[0] <= problem.slip < problem.slip + DEVIATION < problem.slips[1]


def lowest_speed(problem: Problem, samples: Samples) -> float | None:
    """Return the lowest sampled speed from which on the condition seems to hold with some reserve [m/s]."""
    import numpy as np

    fails = np.flatnonzero(samples.guaranteed * TIGHT < DEVIATION)
    if fails.size == 0:
        return problem.speeds[0]
    first = int(fails[-1]) + 1
    return float(samples.speeds[first]) if first < SPEEDS - 1 else None


def _part(problem: Problem, samples: Samples, lowest: float) -> Finding:
    """Enclose the share from a speed on, not much tighter than the claim needs."""
    most = float(DEVIATION / samples.guaranteed[samples.speeds >= lowest].min())
    tolerance = max(SPARED * (1.0 - most), LEAST_TOLERANCE)
    speeds = lowest, problem.speeds[1]
    return enclose(share_claim(problem, DEVIATION, speed=speeds), tolerance=tolerance)


def _holds(part: Finding) -> bool:
    """Whether the condition is proved on the part."""
    return part.status is Status.PROVED and part.claim.bound <= 1


def _guaranteed(part: Finding) -> float:
    """Return the deviation that the condition guarantees on the part [-]."""
    assert part.extreme.high is not None
    return DEVIATION / part.extreme.high


def _proofs(problem: Problem, part: Finding) -> tuple[Proof, ...]:
    """Return the proof, with the range of speed if that is not the whole."""
    (speed,) = (v for v in part.claim.variables if v.name == "speed")
    ends = float(speed.low), float(speed.high)
    found = verdict.proofs(part)
    return found if ends == problem.speeds else tuple(with_part(proof, "speed", ends) for proof in found)


def _witness(problem: Problem, samples: Samples) -> tuple[Point, ...]:
    """Return the fastest sampled point at which the slip passes slip_max for certain, as the law first sees it."""
    import numpy as np

    for k in np.flatnonzero(samples.worst < DEVIATION)[::-1][:TRIALS]:
        point = samples.tightest[k].copy()
        seen = passes(problem, point, DEVIATION)
        if seen is not None:
            point[SLIP] = seen.slip
            return (
                *domain.readable(point),
                Point(name="torque", value=seen.torque, unit="N m"),
                Point(name="recoverable deviation", value=float(samples.worst[k]), unit="-"),
            )
    return ()


def _open(problem: Problem, lowest: float | None) -> float:
    """Share of the speeds for which nothing was shown."""
    low, high = problem.speeds
    return 1.0 if lowest is None or high == low else (lowest - low) / (high - low)


def _explanation(
    problem: Problem,
    samples: Samples,
    growth: Finding,
    part: Finding | None,
    witness: tuple[Point, ...],
    known: float,
) -> str:
    """Say the recoverable deviation, the growth until it is seen, and the lowest controllable speed."""
    least = int(samples.worst.argmin())
    slowest = f"{problem.speeds[0] * KMH:.3g} km/h"
    grown = max(growth.extreme.high or 1.0, 1.0)
    deviation = (
        f"The recoverable deviation is smallest at {samples.speeds[least] * KMH:.3g} km/h: {samples.worst[least]:.3g} "
        f"by integration, at least {known:.3g} proved."
        if known
        else f"By integration the recoverable deviation falls to {samples.worst[least]:.3g}, at "
        f"{samples.speeds[least] * KMH:.3g} km/h."
    )
    growing = f"Until it is seen a deviation grows by a factor of at most {grown:.4g}."
    (fast,) = (each.value for each in witness if each.name == "speed") if witness else (None,)
    refuted = (
        "" if fast is None else f" At {fast:.3g} km/h, frozen, no law keeps it below {problem.slips[1]:g}."
    )
    if part is None:
        return f"{deviation} {growing}{refuted} The recovery is proved from no speed on."
    (speed,) = (v for v in part.claim.variables if v.name == "speed")
    lowest = float(speed.low) * KMH
    if known:
        return f"{deviation} {growing} The lowest controllable speed lies below the domain, under {slowest}."
    place = f"is at most {lowest:.3g}" if fast is None else f"lies between {fast:.3g} and {lowest:.3g}"
    return (
        f"{deviation} {growing}{refuted} The lowest controllable speed {place} km/h; from there on the recovery is "
        "proved."
    )


def _plots(problem: Problem, samples: Samples) -> tuple[Series, ...]:
    """Return the recoverable deviation over speed beside the one asked for, and the growth."""
    import numpy as np

    speeds = samples.speeds * KMH
    axes = ("speed [km/h]", "recoverable deviation of the slip [-]")
    return (
        series("nominal", *axes, speeds, samples.nominal),
        series("worst within the bounds", *axes, speeds, samples.worst),
        series("guaranteed", *axes, speeds, np.minimum(samples.guaranteed, reach(problem))),
        level("asked for", *axes, speeds, DEVIATION),
        series(
            "worst of the bounds",
            "speed [km/h]",
            "growth within a sample [-]",
            speeds,
            np.maximum(samples.growth, 1.0),
        ),
    )
