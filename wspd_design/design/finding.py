"""From a task to gains: search, final among the best points, sensitivities, and one look at the held-out sets."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path

from wspd_design.certificates.records import Status
from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import Law
from wspd_design.design.judging import held_out, judged_stability, threads
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Design
from wspd_design.design.requirements import DrawnSets, Judged, Limit, judged_by
from wspd_design.design.search.evaluation import evaluate
from wspd_design.design.search.journal import Journal
from wspd_design.design.search.run import Aim, Claim, Evaluation, Space, front, ranked, search
from wspd_design.design.search.score import Score, score, score_by_rail, violation
from wspd_design.design.search.sensitivity import Sensitivity, sensitivities
from wspd_design.design.search.sets import draw_sets
from wspd_design.design.search.variables import design_at, variables_of
from wspd_design.design.selection import search_ranges
from wspd_design.design.specification_file import Task
from wspd_design.design.stability import closes
from wspd_design.parameters.fingerprint import fingerprint
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.simulation.campaign_rows import program_fingerprint

_KEY_FORMAT = 1
FINALISTS = (
    8  # points of a search, the best first and the start beside them, that meet on the sets of its final
)
PROOF_TRIALS = 5  # points, the best first, of which certificates are asked for


@dataclass(frozen=True, slots=True, kw_only=True)
class Found:
    """A search with its result."""

    task: Task
    space: Space
    limits: tuple[Limit, ...]  # that the search had to keep
    tried: tuple[Evaluation, ...]  # the first is the start
    chosen: Evaluation
    reason: str  # of the choice
    finalists: tuple[
        Evaluation, ...
    ]  # as they are judged on the sets of the final, the best first; none without it
    front: tuple[Evaluation, ...]
    sensitivities: tuple[Sensitivity, ...]
    held_out_start: Score
    held_out: Score
    held_out_by_rail: Mapping[str, Score]
    judged: tuple[Judged, ...]  # on the held-out sets
    unproved: tuple[str, ...]  # certificates that must hold, and do not


def find(
    task: Task,
    space: Space,
    *,
    keep: bool,
    journal: Path,
    progress: Callable[[int], object] = abs,
    told: Callable[[str], object] = str,
) -> Found:
    """Search the numbers of a law.

    Parameters
    ----------
    task : Task
        Requirements, stops and effort.
    space : Space
        The law with the numbers that vary.
    keep : bool
        Whether points must keep the limits of the task, each with its reserve, and its claims before their distance
        counts; not of a law that is only tuned.
    journal : Path
        File for what is finished, from which the same search goes on.
    progress : callable
        Told the number of evaluations that are done.
    told : callable
        Told a sentence when an older journal has to give way.

    Returns
    -------
    Found
        The held-out sets are drawn once, after the search.
    """
    vehicle, rail = load_vehicle(task.vehicle), load_rail(task.design_rail)
    aim, effort = _aim(task, vehicle) if keep else Aim(limits=()), task.effort
    notes = Journal(journal, _key(task, space, vehicle, rail))
    if notes.replaced:
        told(f"{journal} belongs to another search or program and was begun anew")
    with threads() as pool:
        sets = draw_sets(task.requirements, vehicle, task.vehicle, effort.sets, pool)
        tried = search(
            space,
            aim,
            sets,
            method=effort.method,
            evaluations=effort.evaluations,
            seed=effort.sets.seed,
            journal=notes,
            pool=pool,
            progress=progress,
        )
        finalists = _final(tried, aim, space, task, vehicle, pool)
        ordered = finalists or ranked(tried, aim)
        preferred, unproved = _preferred(ordered, space, task, vehicle, rail)
        chosen = next(each for each in tried if each.point == preferred.point)
        steps = sensitivities(space, chosen.point, sets, pool)
        both = [space.law_at(point) for point in (space.start, chosen.point)]
        at_start, figures = held_out(both, task.requirements, vehicle, task.vehicle, pool)
        reached = score(figures)
    return Found(
        task=task,
        space=space,
        limits=aim.limits,
        tried=tuple(tried),
        chosen=chosen,
        reason=_reason(tried, preferred, aim, effort.final if finalists else None),
        finalists=tuple(finalists),
        front=tuple(front(tried)),
        sensitivities=steps,
        held_out_start=score(at_start),
        held_out=reached,
        held_out_by_rail=score_by_rail(figures, task.requirements.rails),
        judged=(
            *judged_by(task.requirements.limits, reached.reached),
            *judged_stability(both[1], task.requirements, vehicle, task.specification.speeds),
        ),
        unproved=unproved,
    )


def space_of(start: Design, vehicle: Vehicle, rail: Rail) -> Space:
    """Return what a search may vary of a design, in the ranges that are stated for its law."""
    variables = variables_of(start, search_ranges(start.law))
    return Space(
        law=start.law,
        variables=variables,
        build=lambda values: design_at(start, variables, values).build(vehicle, rail),
    )


def explained(found: Found, start: Design, name: str) -> Design:
    """Return the design that was found from another one, with the reasons of its numbers and its requirements.

    Parameters
    ----------
    found : Found
        Search in the space of the start.
    start : Design
        Where it started.
    name : str
        Of the new design.
    """
    variables, effort = found.space.variables, found.task.effort
    made = design_at(start, variables, found.chosen.values)
    searched = {variable.name: variable for variable in variables}
    gains = []
    for gain, before in zip(made.gains, start.gains, strict=True):
        variable = searched.get(gain.name)
        if variable is None:
            gains.append(gain)
            continue
        where = f"{'a factor of ' if variable.factor else ''}{variable.low:g} to {variable.high:g} {variable.unit}"
        why = (
            f"searched from {where.removesuffix(' -')}: {variable.why}; best of {effort.evaluations} evaluations on "
            f"{effort.sets.sets} sets of seed {effort.sets.seed} ({effort.method}); before: {_told(before.value)}, "
            f"{before.why}"
        )
        gains.append(replace(gain, why=why))
    return replace(made, name=name, gains=tuple(gains), requirements=found.task.requirements)


def _key(task: Task, space: Space, vehicle: Vehicle, rail: Rail) -> str:
    """Content key of the scores: all that they depend on beside the point."""
    stops = replace(
        task.requirements, limits=(), certificates=(), stable_within=(), held_out=task.effort.sets
    )
    rails = tuple(load_rail(each) for each in stops.rails)
    law = space.law_at(space.start)
    return fingerprint(_KEY_FORMAT, law, space.variables, stops, vehicle, rail, rails, program_fingerprint())


def _aim(task: Task, vehicle: Vehicle) -> Aim:
    """Return what points have to keep."""
    wanted, speeds = task.requirements, task.specification.speeds

    def closing(rail: Rail, share: float) -> Claim:
        """Quadratic functions are found on a share of the box; without them the claim fails by one scale."""
        return lambda law: float(closes(law, vehicle, rail, speeds=speeds, share=share) is None)

    return Aim(
        limits=tuple(limit.with_reserve() for limit in wanted.limits),
        claims=tuple(closing(load_rail(name), share) for name, share in wanted.stable_within),
    )


def _final(
    tried: Sequence[Evaluation], aim: Aim, space: Space, task: Task, vehicle: Vehicle, pool: Executor
) -> list[Evaluation]:
    """Judge the best points and the start again on further sets: the best of many points is partly lucky."""
    drawn = task.effort.final
    if drawn is None:
        return []
    first, *others = tried
    best = [each for each in ranked(others, aim) if each.point != first.point]
    finalists = [*best[:FINALISTS], first]
    sets = draw_sets(task.requirements, vehicle, task.vehicle, drawn, pool)
    figures = evaluate([space.law_at(each.point) for each in finalists], sets, pool)
    judged = [replace(each, score=score(found)) for each, found in zip(finalists, figures, strict=True)]
    return ranked(judged, aim)


def _preferred(
    ordered: Sequence[Evaluation], space: Space, task: Task, vehicle: Vehicle, rail: Rail
) -> tuple[Evaluation, tuple[str, ...]]:
    """Return the first point whose certificates hold; the first of all if none of some has them."""
    first = ordered[0]
    if not task.requirements.certificates:
        return first, ()
    for each in ordered[:PROOF_TRIALS]:
        if not _unproved(space.law_at(each.point), task, vehicle, rail):
            return each, ()
    return first, _unproved(space.law_at(first.point), task, vehicle, rail)


def _unproved(law: Law, task: Task, vehicle: Vehicle, rail: Rail) -> tuple[str, ...]:
    """Return the certificates that are not proved for a law."""
    from wspd_design.certificates.suite import verify

    asked = replace(task.specification, slip=slip_reference_of(law) or task.specification.slip)
    problem = stability_problem(vehicle, rail, law, asked)
    found = verify(problem, only=task.requirements.certificates, figures=False)
    return tuple(each.name for each in found if each.status is not Status.PROVED)


def _told(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else f"{value}"


def _reason(tried: Sequence[Evaluation], chosen: Evaluation, aim: Aim, final: DrawnSets | None) -> str:
    """Say why a point was chosen, with its figures on the sets of the final if there was one."""
    holding = sum(aim.holds(each) for each in tried)
    compared = f"objective {chosen.score.objective:.4f}"
    if final is None:
        compared += f" against {tried[0].score.objective:.4f} at the start"
        among = f"{len(tried)} points"
    else:
        compared += f" on {final.sets} further sets of seed {final.seed}"
        among = f"the start and the {min(FINALISTS, len(tried) - 1)} best of {len(tried)} points"
    if not aim.limits and not aim.claims:
        return f"smallest objective of {among}, without limits: {compared}"
    if aim.holds(chosen):
        if final is None:
            among = f"the {holding} points among {len(tried)} that keep all limits"
        return f"smallest objective of {among}{', within all limits' if final else ''}: {compared}"
    missed = violation(chosen.score, aim.limits) + chosen.unproved
    return (
        f"none of {among} keeps all limits and claims; this one misses them least, by {missed:.2f} in the "
        f"scales of the criteria: {compared}"
    )
