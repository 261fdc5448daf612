"""A sampled law with torque feedback keeps slip and torque in a set that its one-sample map does not leave."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.checks.frame import OutsideModel, certified, model_hash
from wspd_design.certificates.checks.region.outlines import outlines
from wspd_design.certificates.records import Certificate, Point, Problem, Proof, Range, Series, Status
from wspd_design.certificates.search.invariant_sets import document, escape
from wspd_design.certificates.search.invariant_sets.search import Found, holding_share, search, windows
from wspd_design.certificates.search.prover import budget
from wspd_design.certificates.search.settle import engine
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.theorems.invariant_sets import checker
from wspd_design.controllers.protocol import Measurement

if TYPE_CHECKING:
    from wspd_design.certificates.search.invariant_sets.one_sample import Window

NAME, TITLE = "sampled_invariance", "Invariant set of the sampled loop"
CLAIM = "In one sample the closed loop maps a set of slip and torque at every speed into itself."
SEARCH_SHARE = 0.6  # of the time for a claim, for each of two searches; the check comes on top
STEPS_PER_SECOND = 250_000  # steps of cells, in which the time is counted; a processor takes about as many
ASSUMPTIONS = (
    "full supply pressure behind the valves",
    "speeds and torque measured exactly, without dead time",
    "no pad vibration and no load transfer",
    "mass, inertia and mu0 anywhere in their ranges, even changing with time; all other numbers exactly known",
    "says nothing about the way from rolling into the set, nor below the lowest speed",
)


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Search invariant sets for the whole range of speed and let the checker decide about them."""
    memory = problem.controller.start(Measurement(problem.speeds[1], problem.speeds[1], 0.0))
    if memory != ():
        reason = (
            f"remembers {len(memory)} numbers from sample to sample, so that slip and torque alone do not tell its "
            "next command"
        )
        return laws.not_applicable(problem, NAME, CLAIM, reason)
    domain.box(problem)  # refuses what is not positive
    try:
        found = search(problem, most_work=_most_work())
    except TypeError as error:
        raise OutsideModel(
            f"the law {problem.controller.name} cannot be evaluated on intervals: {error}"
        ) from error
    covered = _covered(problem, found)
    if covered is None:
        return _undecided(problem, found)
    text = document.write(problem, covered)
    verdict = checker.check(problem, text)
    slips = verdict.slips if verdict.accepted else _extent(covered)
    proof = Proof(
        claim=NAME,
        statement=f"the slip stays within {slips[0]:.4f} and {slips[1]:.4f}",
        claim_hash=model_hash(problem),
        certificate=text,
        leaves=verdict.leaves,
        seconds=verdict.seconds,
    )
    widest = max(covered, key=lambda each: _extent([each])[1])
    return _certificate(
        found,
        claim=f"{_claim(problem)} The slip then stays within {slips[0]:.3f} and {slips[1]:.3f}, also between samples.",
        status=Status.PROVED if verdict.accepted else Status.EVIDENCE,
        explanation=f"One set for each of {len(covered)} windows of speed; each also maps into that of the next "
        "slower window, so that the whole stop is covered. The wheel does not lock. "
        + (
            "The checker accepts the sets."
            if verdict.accepted
            else f"But the checker does not accept the sets: {verdict.reason}."
        ),
        margin=Range(low=1.0 - slips[1], high=1.0 - problem.slip, unit="-"),
        worst_point=(
            Point(name="slip", value=_extent([widest])[1], unit="-"),
            Point(name="speed", value=widest.cells.window.high * KMH, unit="km/h"),
        ),
        proofs=(proof,) if verdict.accepted else (),
        outlined=outlines(problem, covered, "set" if verdict.accepted else "unproved set"),
    )


def _most_work() -> float:
    """Return the work after which a search gives up [steps of cells]."""
    return SEARCH_SHARE * budget().seconds * STEPS_PER_SECOND


def _claim(problem: Problem) -> str:
    return (
        f"Over {domain.described(problem)}, sampled every {problem.sample_time:g} s with the valve lag, its limits and "
        f"its pulses, {problem.controller.name} keeps slip and torque in a set around slip {problem.slip:g} once they "
        "are in it."
    )


def _covered(problem: Problem, found: Sequence[Found | None]) -> list[Found] | None:
    """Return the sets if every window has one that maps into the next slower one."""
    sets = [each for each in found if each is not None]
    complete = len(sets) == len(windows(problem)) and all(each.glued for each in sets[1:])
    return sets if complete else None


def _undecided(problem: Problem, found: Sequence[Found | None]) -> Certificate:
    """Say which windows fail, and whether the nominal parameters would do."""
    spans = windows(problem)
    missing = [span for span, each in zip(spans, found, strict=False) if each is None]
    apart = [
        span
        for span, (slower, each) in zip(spans[1:], pairwise(found), strict=False)
        if slower is not None and each is not None and not each.glued
    ]
    unreached = spans[len(found) :]
    parts = []
    if missing:
        parts.append(f"No set is found at {_ranges(missing, spans)}")
        parts.append(_simulated(problem, missing))
    if apart:
        parts.append(f"The sets at {_ranges(apart, spans)} do not map into that of the next slower window")
    if unreached:
        parts.append(
            f"The search time, counted in steps of cells, ran out before {_ranges(unreached, spans)}"
        )
    open_width = sum(span.high - span.low for span in (*missing, *apart, *unreached))
    nominal, alone = _nominal(problem), [each for each in found if each is not None]
    if nominal.accepted:
        shown = outlines(problem, nominal.sets, "nominal set")
    elif alone:
        shown = outlines(problem, alone, "unproved set")
    else:
        shown = outlines(problem, nominal.sets, "unproved nominal set")
    return _certificate(
        found,
        claim=_claim(problem),
        status=Status.UNDECIDED,
        explanation=". ".join((*parts, _authority(problem), nominal.words)),
        undecided=min(1.0, open_width / (problem.speeds[1] - problem.speeds[0])),
        outlined=shown,
    )


def _simulated(problem: Problem, missing: Sequence["Window"]) -> str:
    """Ask simulation whether sets can exist in windows where none was found."""
    return escape.described(problem, [math.sqrt(span.low * span.high) for span in missing])


def _ranges(some: Sequence["Window"], every: Sequence["Window"]) -> str:
    """Ranges of speed of some windows, neighbors joined."""
    place = {span: index for index, span in enumerate(every)}
    runs = groupby(enumerate(some), key=lambda pair: place[pair[1]] - pair[0])
    texts = []
    for _, pairs in runs:
        run = [span for _, span in pairs]
        texts.append(f"{run[0].low * KMH:.1f} to {run[-1].high * KMH:.1f} km/h")
    return ", ".join(texts)


def _authority(problem: Problem) -> str:
    """Compare what the torque would have to do over the box with what the law does."""
    span = windows(problem)[0]
    shares = []
    for mass, mu0 in zip(problem.mass_bounds, problem.mu0_bounds, strict=True):
        vehicle, rail = domain.varied(problem, mass, problem.vehicle.wheelset_inertia, mu0)
        shares.append(holding_share(replace(problem, vehicle=vehicle, rail=rail), span.low))
    return (
        f"At {span.low * KMH:.0f} km/h the torque that holds the reference is {100 * shares[0]:.0f} to "
        f"{100 * shares[1]:.0f} % of the full one over the box, while the law gives up {10 * span.tilt:.1f} % for "
        "every 0.1 of slip"
    )


class _Nominal(NamedTuple):
    """What is found without uncertainty."""

    words: str
    sets: Sequence[Found] = ()
    accepted: bool = False  # by the checker, for the whole range of speed


def _nominal(problem: Problem) -> _Nominal:
    """Try the same with nominal parameters."""
    vehicle, rail = problem.vehicle, problem.rail
    nominal = replace(
        problem,
        mass_bounds=(vehicle.mass, vehicle.mass),
        inertia_bounds=(vehicle.wheelset_inertia, vehicle.wheelset_inertia),
        mu0_bounds=(rail.mu0, rail.mu0),
    )
    if nominal == problem:
        return _Nominal("These are nominal parameters already.")
    found = search(nominal, most_work=_most_work())
    covered = _covered(nominal, found)
    if covered is None:
        spans, sets = windows(nominal), [each for each in found if each is not None]
        missing = [span for span, each in zip(spans, found, strict=False) if each is None]
        words = f"With nominal parameters {len(sets)} of {len(spans)} windows have a set"
        if len(found) < len(spans):
            words += f"; the search time did not suffice for {len(spans) - len(found)}"
        return _Nominal(words + (f". {_simulated(nominal, missing)}." if missing else "."), sets)
    verdict = checker.check(nominal, document.write(nominal, covered))
    if not verdict.accepted:
        return _Nominal(
            "With nominal parameters every window has a set, which the checker does not accept.", covered
        )
    low, high = verdict.slips
    return _Nominal(
        "With nominal parameters the checker accepts sets for the whole range of speed, with slip "
        f"{low:.3f} to {high:.3f}.",
        covered,
        accepted=True,
    )


def _certificate(
    found: Sequence[Found | None],
    *,
    claim: str,
    status: Status,
    explanation: str,
    margin: Range | None = None,
    worst_point: tuple[Point, ...] = (),
    undecided: float = 0.0,
    proofs: tuple[Proof, ...] = (),
    outlined: tuple[Series, ...],
) -> Certificate:
    """Fill in what does not depend on the verdict."""
    sizes = sorted({each.cells.per_unit for each in found if each is not None})
    fineness = " and ".join(f"1/{size}" for size in sizes) or "none"
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=claim,
        status=status,
        explanation=explanation,
        margin=margin,
        worst_point=worst_point,
        assumptions=ASSUMPTIONS,
        method="interval enclosure of the one-sample map on cells of slip and torque; cells with images that leave are "
        "removed until none is left",
        resolution=f"{len(found)} windows of speed, edges of the cells {fineness}",
        reference="eqs. (9), (14), (19); docs/theory.md#invariance",
        engine=engine(),
        undecided=undecided,
        proofs=proofs,
        series=outlined,
    )


def _extent(found: Sequence[Found]) -> tuple[float, float]:
    """Smallest and largest slip at and between samples that the search found for its sets."""
    low, high = 1.0, 0.0
    for each in found:
        states = each.states.ravel()
        low = min(low, float(each.image.between_low[states].min()))
        high = max(high, float(each.image.between_high[states].max()))
    return low, high
