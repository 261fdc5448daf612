"""What page one says about the decision: scope, weakest link, next step, rank and origin, each from a record."""

import math
from collections.abc import Sequence

from wspd_design.design.requirements import Requirements
from wspd_design.parameters.units import format_quantity
from wspd_design.reporting import numbers
from wspd_design.reporting.brakes import lag_times
from wspd_design.reporting.figures.drawing import KMH
from wspd_design.reporting.formula_text import readable
from wspd_design.reporting.requirement_words import against_limit, figure, margin
from wspd_design.reporting.spreads import words_of
from wspd_design.reporting.yardsticks import ideal_distance
from wspd_design.simulation.description import disturbances_of, rails_of
from wspd_design.simulation.runs import Ending
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.judgment import Requirement
from wspd_design.studies.next_step import Alternative, NextStep

WORST_OF = {
    "stopping_distance": "distance",
    "efficiency_worst": "efficiency",
    "longest_lock": "longest_lock",
    "speed_error": "speed_error",
}
"""Criteria about the worst stop that the spread over the bounds tells, too, and its names for them."""


def scope(dossier: Dossier) -> str:
    """Say for what the decision is made."""
    low, high = (numbers.significant(speed * KMH) for speed in dossier.specification.speeds)
    span = format_quantity(dossier.specification.sample_time, "ms")
    grade = dossier.scenario.grade
    track = "straight level track" if grade == 0.0 else f"straight track, grade {1e3 * grade:g} permille"
    wanted = dossier.judgment.wanted
    rails = numbers.listing(wanted.rails) if isinstance(wanted, Requirements) else rails_of(dossier.scenario)
    disturbed = readable(disturbances_of(dossier.scenario))
    return (
        f"{dossier.vehicle.name} on {rails}, {low} to {high} km/h, {track}, sample time {span}"
        f"{f', {disturbed}' if disturbed else ''}. Simulation and proofs only: no data of a vehicle"
    )


def weakest(dossier: Dossier) -> str:
    """Say which requirement decides, with cause, number and limit."""
    row = dossier.judgment.weakest
    if row is None:
        return "no requirement has a margin"
    if row.name == "loop" and dossier.growth is not None:
        return _loop(dossier, row)
    reserve = f": the smallest reserve, {margin(row)}" if dossier.judgment.accepted else ""
    cause = f". {dossier.adhesion_use}" if dossier.idle else ""
    return f"{row.id}, {against_limit(row)}{reserve}{cause}"


def _loop(dossier: Dossier, row: Requirement) -> str:
    growth = dossier.growth
    assert growth is not None, "asked for by the caller"
    span = format_quantity(dossier.specification.sample_time, "ms")
    poles = [
        each.slip_pole
        for each in dossier.linearizations
        if dossier.specification.speeds[0] <= each.speed <= dossier.specification.speeds[1]
    ]
    times = lag_times(dossier.vehicle)
    lag = "" if times is None else f" of {numbers.significant(min(times))} s"
    counted = f"it is unstable at {growth.unstable} of {growth.speeds} speeds; " if growth.speeds else ""
    said = (
        f"{row.id}, the loop near its reference: sampled every {span} behind a valve{lag} "
        f"{counted}a deviation of the slip is multiplied by "
        f"{numbers.significant(growth.factor, 3)} per sample at {numbers.significant(growth.speed * KMH, 3)} km/h, "
        "allowed below 1"
    )
    return f"{said}. The slip pole reaches {numbers.significant(max(poles), 2)} 1/s (nominal)"


def over_all_bounds(dossier: Dossier) -> str:
    """Set the limits of drawn stops against one stop over all bounds, where those stops hold some numbers."""
    wanted, found = dossier.judgment.wanted, dossier.uncertainty
    if not isinstance(wanted, Requirements) or found is None:
        return ""
    drawn = {draw.name for draw in wanted.draws}
    kept_fixed = [
        each
        for each in found.drawn
        if each not in drawn and each.partition(".")[0] not in wanted.within_bounds
    ]
    if not kept_fixed:
        return ""
    missed: list[str] = []
    kept: list[str] = []
    for row in dossier.judgment.limited:
        spread = found.spread_of(WORST_OF[row.name]) if row.name in WORST_OF else None
        if spread is None or row.limit is None:
            continue
        worst = spread.low if row.at_least else spread.high
        inside = worst >= row.limit if row.at_least else worst <= row.limit
        reached = figure(row, worst) if math.isfinite(worst) else "no standstill"
        (kept if inside else missed).append(f"{row.id} ({reached})")
    said = [
        *([f"misses {numbers.listing(missed)}"] if missed else []),
        *([f"keeps {numbers.listing(kept)}"] if kept else []),
    ]
    if not said:
        return ""
    fixed = numbers.listing([words_of(each) for each in kept_fixed])
    return (
        f"the worst of {found.sets} stops on {rails_of(dossier.scenario)} that draw all numbers {' and '.join(said)}; "
        f"the stops of the requirements hold {fixed} at their values"
    )


def next_words(dossier: Dossier) -> str:
    """Say what was tried in place of a design that is not accepted; for one that is, which evidence it lacks."""
    found = dossier.next_step
    if found is None and dossier.idle:
        return (
            f"judge it where wheels slide; on {rails_of(dossier.scenario)} no law has anything to do, and no other one "
            "was tried"
        )
    if found is None:
        return "nothing that is required is missed; no rung of the ladder below is a measurement on a vehicle"
    tried = (
        f"{numbers.count(len(found.tried), 'alternative')} tried, gains by their rules, "
        f"{numbers.count(found.stops, 'stop')} each"
    )
    if not found.tried:
        return "no other law has gains by rules for this vehicle"
    if found.clears:
        sure = [each for each in found.clears if not each.silent]
        open_ones = [each for each in found.clears if each.silent]
        met = [
            *([f"these meet everything: {_named(sure)}"] if sure else []),
            *(
                [f"these meet all but {_silent(dossier, open_ones)}: {_named(open_ones)}"]
                if open_ones
                else []
            ),
        ]
        return f"{'; '.join(met)} ({tried}). {_same_law(dossier, found)}".rstrip()
    best = found.tried[0]
    return (
        f"nothing meets everything ({tried}); closest is {_alternative(best)} sampled every "
        f"{format_quantity(best.sample_time, 'ms')}, which misses {_missed(dossier, best)}. "
        f"{_same_law(dossier, found)}".rstrip()
    )


def _named(some: Sequence[Alternative]) -> str:
    """Name alternatives with their distances, those of one sample time together."""
    spans = dict.fromkeys(sorted((each.sample_time for each in some), reverse=True))
    return "; ".join(
        f"sampled every {format_quantity(span, 'ms')} "
        + numbers.listing([_alternative(each) for each in some if each.sample_time == span])
        for span in spans
    )


def _silent(dossier: Dossier, some: Sequence[Alternative]) -> str:
    """Say which requirements no check judges for some alternatives."""
    names = {name for each in some for name in each.silent}
    ids = [row.id for row in dossier.judgment.rows if row.name in names]
    return f"{numbers.listing(ids)}, which no check judges for their laws"


def _alternative(each: Alternative) -> str:
    distance = "" if each.distance is None else f" ({numbers.decimals(each.distance, 0)} m)"
    return f"{each.law}{distance}"


def _missed(dossier: Dossier, each: Alternative) -> str:
    """Name the requirements that an alternative misses by their ids."""
    ids = {row.name: row.id for row in dossier.judgment.rows}
    return numbers.listing([ids.get(name, name) for name in each.missed])


def _same_law(dossier: Dossier, found: NextStep) -> str:
    """Say whether the same law sampled faster would do."""
    own = None if dossier.design is None else dossier.design.law
    faster = next((each for each in found.tried if each.law == own), None)
    if faster is None:
        return ""
    span = format_quantity(faster.sample_time, "ms")
    if not faster.missed:
        return f"The same law sampled every {span} meets everything."
    return f"The same law sampled every {span} still misses {_missed(dossier, faster)}."


def rank(dossier: Dossier) -> str:
    """Set the distance of the stop among those of the other laws."""
    stopped = sorted(
        (each for each in dossier.trials if each.run.ending is Ending.STOPPED),
        key=lambda each: each.metrics.distance,
    )
    own = dossier.trials[0]
    if own not in stopped or len(stopped) < 2:
        return ""
    place = stopped.index(own) + 1
    named = [
        f"{each.run.controller} {numbers.decimals(each.metrics.distance, 0)}"
        for each in stopped
        if each is not own
    ]
    ideal = ideal_distance(own.metrics)
    return (
        f"{place} of {len(stopped)} by distance on this stop: {numbers.decimals(own.metrics.distance, 0)} m; "
        f"{', '.join(named)}; ideal stop {ideal}"
    )


def produced_by(dossier: Dossier) -> str:
    """Say what made the report; the rest stands under its provenance."""
    made = dossier.provenance
    tree = (
        f"{made.package_tree[:12]}{' and changes' if made.changed else ''}"
        if made.package_tree
        else "no clone"
    )
    return (
        f"wspd {made.program_version} ({tree}), package {made.package_sha256[:12]}, {made.compiler}, {made.platform}, "
        f"inputs {made.input_hash[:12]}, seed {made.seed}, searches that were cut: {len(made.searches_cut)}"
    )
