"""A sampled law with torque feedback keeps slip and torque in a set that its one-sample map does not leave."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Check, Figures
from wspd_design.certificates.checks.region.outlines import outlines
from wspd_design.certificates.kernel.finding import Effort, Stated
from wspd_design.certificates.memory import recall
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.search.invariant_sets import document, escape
from wspd_design.certificates.search.invariant_sets.search import Found, holding_share, windows
from wspd_design.certificates.search.invariant_sets.search import search as find
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.region import SAMPLED_INVARIANCE, SETS
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.search.invariant_sets.one_sample import Window

STEPS_OF_CELLS = 3_000_000  # that a search may map, with an effort of 1


def search(problem: Problem) -> Mapping[str, Stated]:
    """Search invariant sets for the whole range of speed; a law that intervals cannot evaluate has none."""
    found = _found(problem)
    covered = _covered(problem, found)
    if covered is not None:
        return {SETS: Stated(proof=document.write(problem, covered))}
    spans = windows(problem)
    missing = sum(each is None for each in found) + len(spans) - len(found)
    cut = len(found) < len(spans)
    return {SETS: Stated(effort=Effort(boxes=len(found), undecided=missing / len(spans), cut=cut))}


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Outlines of the sets, and why none was found."""
    found = _found(problem)
    alone = [each for each in found if each is not None]
    if certificate.status is Status.PROVED:
        return Figures(series=outlines(problem, alone, "set"))
    return Figures(series=outlines(problem, alone, "unproved set"), remark=_reasons(problem, found))


def _found(problem: Problem) -> list[Found | None]:
    most = STEPS_OF_CELLS * budget().effort

    def work_out() -> list[Found | None]:
        try:
            return find(problem, most_work=most)
        except TypeError:
            return []

    return recall(["invariant sets", model_hash(problem), most], work_out)


def _reasons(problem: Problem, found: Sequence[Found | None]) -> str:
    """Say which windows fail."""
    spans = windows(problem)
    missing = [span for span, each in zip(spans, found, strict=False) if each is None]
    apart = [
        span
        for span, (slower, each) in zip(spans[1:], pairwise(found), strict=False)
        if slower is not None and each is not None and not each.glued
    ]
    parts = []
    if missing:
        parts += [f"No set is found at {_ranges(missing, spans)}", _simulated(problem, missing)]
    if apart:
        parts.append(f"The sets at {_ranges(apart, spans)} do not map into that of the next slower window")
    if spans[len(found) :]:
        parts.append(f"The budget of the search ran out before {_ranges(spans[len(found) :], spans)}")
    return ". ".join((*parts, _authority(problem))) + "."


def _covered(problem: Problem, found: Sequence[Found | None]) -> list[Found] | None:
    """Return the sets if every window has one that maps into the next slower one."""
    sets = [each for each in found if each is not None]
    complete = len(sets) == len(windows(problem)) and all(each.glued for each in sets[1:])
    return sets if complete else None


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
    for mass, mu0 in zip(problem.span("mass"), problem.span("mu0"), strict=True):
        vehicle, rail = plant_with(problem, {"mass": mass, "mu0": mu0})
        shares.append(holding_share(replace(problem, vehicle=vehicle, rail=rail), span.low))
    return (
        f"At {span.low * KMH:.0f} km/h the torque that holds the reference is {100 * shares[0]:.0f} to "
        f"{100 * shares[1]:.0f} % of the full one over the box, while the law gives up {10 * span.tilt:.1f} % for "
        "every 0.1 of slip"
    )


CHECK = Check(theorem=SAMPLED_INVARIANCE, search=search, figures=figures)
