"""Page one: the decision, what it rests on, the table of requirements and the ladder of evidence."""

import math
from collections.abc import Sequence

from wspd_design.certificates.records import Certificate
from wspd_design.certificates.records import Status as Finding
from wspd_design.certificates.theorems.holds_for import HOLDS_FOR, HoldsFor
from wspd_design.certificates.theorems.shortest_stop.stop_bound import rounded_down
from wspd_design.design.requirements import Requirements
from wspd_design.parameters.units import format_quantity
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import (
    Block,
    Column,
    Definition,
    Definitions,
    KeyNumber,
    KeyNumbers,
    Status,
    Table,
    Verdict,
)
from wspd_design.reporting.decision_words import (
    WORST_OF,
    next_words,
    over_all_bounds,
    produced_by,
    rank,
    scope,
    weakest,
)
from wspd_design.reporting.figures.drawing import KMH
from wspd_design.reporting.requirement_words import (
    against_limit,
    figure,
    finding,
    limit,
    margin,
    reached,
    title,
)
from wspd_design.reporting.sections.assumptions import deciding_words
from wspd_design.reporting.sections.checks import ASSUMPTIONS, check_anchor, is_bad_news
from wspd_design.reporting.sections.requirements import REQUIREMENTS, decided_by, stops_of
from wspd_design.reporting.sections.robustness import ROBUSTNESS, what_fails
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Inline, Link, Text
from wspd_design.reporting.yardsticks import ideal_distance, proved_bound
from wspd_design.simulation.description import rails_of
from wspd_design.simulation.runs import Ending
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.judgment import Judgment, Requirement

_SPREADS = WORST_OF | {"vented_air": "vented_air"}
"""Figures that the spread over the bounds has under these names."""

_SLIP = "Slip: each wheelset once it has 90 % of its reference. "

_VERDICTS = {
    "accepted": Status.ACCEPTED,
    "rejected": Status.REJECTED,
    "undecided": Status.UNDECIDED,
}


def verdict(dossier: Dossier) -> Verdict:
    """Return the judgment of the whole report, which its requirements define, with the reason that comes first."""
    judgment = dossier.judgment
    count = len(judgment.limited)
    link = Link(anchor=REQUIREMENTS, text="requirements" if count != 1 else "requirement")
    row = judgment.weakest
    first = "" if row is None else f"{row.id}, {against_limit(row)}"
    match judgment.verdict:
        case "accepted":
            spoken: tuple[Inline, ...] = (
                f"Accepted: it meets all {count} ",
                link,
                f" ({judgment.name}) on {stops_of(judgment)}. That is shown by simulation, not measured. ",
            )
        case "rejected":
            spoken = (
                f"Rejected: it misses {_ids(judgment)} of {count} ",
                link,
                f" ({judgment.name}); first {first}. ",
            )
        case _:
            spoken = (
                f"Not decided: {_ids(judgment)} of {count} ",
                link,
                f" ({judgment.name}) {'is' if len(judgment.open) == 1 else 'are'} open; first {first}. ",
            )
    return Verdict(status=_VERDICTS[judgment.verdict], sentence=(*spoken, _stop(dossier)))


def _ids(judgment: Judgment) -> str:
    return numbers.listing([each.id for each in judgment.missed or judgment.open])


def _stop(dossier: Dossier) -> str:
    """Say how the design's own stop went."""
    own = dossier.trials[0]
    run, figures = own.run, own.metrics
    start = (
        f"The simulated stop of {run.train} from "
        f"{numbers.significant(run.initial_speed * KMH)} km/h on {rails_of(dossier.scenario)}"
    )
    if run.ending is not Ending.STOPPED:
        return f"{start} does not end: {run.ending.value}."
    known = figures.ideal_ending is Ending.STOPPED
    idle = " No wheel slides in it: nothing is shown about the law." if dossier.idle else ""
    return (
        f"{start} takes {numbers.decimals(figures.distance, 0)} m"
        f"{f', the ideal stop {ideal_distance(figures)}' if known else ''}.{idle}"
    )


def summary(dossier: Dossier) -> tuple[Block, ...]:
    """Return the key numbers, the decision row by row, the requirements and the ladder of evidence."""
    return (
        KeyNumbers(numbers=_key_numbers(dossier)),
        Definitions(rows=_decision(dossier)),
        _requirements(dossier),
        _ladder(dossier.certificates, dossier),
        Definitions(rows=_beside(dossier)),
    )


def _key_numbers(dossier: Dossier) -> tuple[KeyNumber, ...]:
    own = dossier.trials[0]
    run, figures = own.run, own.metrics
    stopped = run.ending is Ending.STOPPED
    start = f"from {numbers.significant(run.initial_speed * KMH)} km/h on {rails_of(dossier.scenario)}"
    judgment = dossier.judgment
    met = len(judgment.limited) - len(judgment.missed) - len(judgment.open)
    return (
        KeyNumber(
            label="Stopping distance" if stopped else "Distance, still moving",
            value=numbers.decimals(figures.distance, 0),
            unit="m",
            note=f"{start} ({run.plant}), in {numbers.decimals(figures.stopping_time, 1)} s{_build_up(dossier)}"
            f"{_spread(dossier)}",
        ),
        KeyNumber(
            label="Efficiency",
            value=numbers.decimals(100.0 * figures.efficiency, 1),
            unit="%" if math.isfinite(figures.efficiency) else "",
            note=_yardsticks(dossier),
        ),
        KeyNumber(
            label="Requirements met",
            value=f"{met} of {len(judgment.limited)}",
            note=(Link(anchor=REQUIREMENTS, text="on"), f" {stops_of(judgment)}"),
        ),
        _loop(dossier),
    )


def _build_up(dossier: Dossier) -> str:
    build_up = dossier.trials[0].metrics.build_up
    if not math.isfinite(build_up):
        return ""
    return f"; brake built up after {numbers.decimals(build_up, 1)} s"


def _spread(dossier: Dossier) -> str:
    """Say how far the distance spreads over the bounds."""
    found = dossier.uncertainty
    spread = None if found is None else found.spread_of("distance")
    if found is None or spread is None:
        return ""
    low, high = (
        f"{numbers.decimals(each, 0)} m" if math.isfinite(each) else "no stop"
        for each in (spread.low, spread.high)
    )
    return f". {low} to {high} over the bounds ({found.sets} sets)"


def _yardsticks(dossier: Dossier) -> Text:
    """Say what the efficiency is a share of, and what is proved, each under its own name."""
    ideal = f"ideal stop, simulated: {ideal_distance(dossier.trials[0].metrics)}"
    proved = proved_bound(dossier.certificates)
    if proved is None:
        return f"{ideal}; no bound is proved"
    start = numbers.significant(dossier.specification.speeds[1] * KMH)
    link = Link(anchor=check_anchor(proved.certificate), text="proved bound")
    return (
        f"{ideal}; ",
        link,
        f" of the nominal vehicle from {start} km/h: {rounded_down(proved.distance)} m",
    )


def _loop(dossier: Dossier) -> KeyNumber:
    """Show the growth of a deviation against its limit; for laws of which no check tells it, the pole of the slip."""
    growth = dossier.growth
    if growth is not None:
        return KeyNumber(
            label="Growth per sample",
            value=numbers.significant(growth.factor, 3),
            note=f"of a deviation near the reference, largest at {numbers.significant(growth.speed * KMH, 3)} km/h; "
            "nominal, with valve and sampling",
        )
    fastest = max(
        dossier.linearizations, key=lambda point: (_in_range(dossier, point.speed), point.slip_pole)
    )
    lag = numbers.decimals(1.0 / fastest.time_constant, 2)
    return KeyNumber(
        label="Slip pole, nominal",
        value=numbers.significant(fastest.slip_pole, 2),
        unit="1/s",
        note=f"near {numbers.significant(fastest.speed * KMH, 2)} km/h, the valve has {lag} 1/s; no check of the loop "
        "speaks about this law",
    )


def _in_range(dossier: Dossier, speed: float) -> bool:
    low, high = dossier.specification.speeds
    return low <= speed <= high


def _decision(dossier: Dossier) -> tuple[Definition, ...]:
    rows: tuple[tuple[str, Text], ...] = (
        ("Scope", scope(dossier)),
        ("Weakest link", weakest(dossier)),
        ("Over all bounds", over_all_bounds(dossier)),
        ("Next", next_words(dossier)),
        ("Against the others", rank(dossier)),
    )
    return tuple(Definition(term=term, text=text) for term, text in rows if text)


def _beside(dossier: Dossier) -> tuple[Definition, ...]:
    """Return what is to be known beside the requirements."""
    rows: tuple[tuple[str, Text], ...] = (
        ("Refuted, not counted", _told(dossier)),
        ("With a fault", _fails_with(dossier)),
        ("Assumptions that decide", _assumed(dossier)),
        ("Made by", produced_by(dossier)),
    )
    return tuple(Definition(term=term, text=text) for term, text in rows if text)


def _told(dossier: Dossier) -> Text:
    """Name the refuted checks that decide nothing, with what they hold for."""
    named = [
        each
        for each in dossier.certificates
        if is_bad_news(each) and not decided_by(dossier.judgment, each.name)
    ]
    said: list[Inline] = []
    for rung in (*HoldsFor, None):
        group = [each for each in named if HOLDS_FOR.get(each.name) is rung]
        if group:
            holds_for = "" if rung is None else f"{rung.value}: "
            said += [f"{'; ' if said else ''}{holds_for}", *_links(group)]
    return tuple(said)


def _links(certificates: Sequence[Certificate]) -> list[Inline]:
    links: list[Inline] = []
    for each in certificates:
        links += [", "] if links else []
        links.append(Link(anchor=check_anchor(each), text=_lowered(each.title)))
    return links


def _lowered(title: str) -> str:
    """Begin a title in lower case, unless it begins with a symbol or a name in capitals."""
    return title if title[1:2].isupper() or not title[1:2].isalpha() else title[0].lower() + title[1:]


def _assumed(dossier: Dossier) -> Text:
    return (f"{deciding_words(dossier)} ", Link(anchor=ASSUMPTIONS, text="(register)"))


def _fails_with(dossier: Dossier) -> Text:
    """Name the faults with which a design does not hold."""
    found = dossier.robustness
    failing = [] if found is None else [each for each in found.stops if not found.holds(each)]
    if not failing:
        return ""
    named = numbers.listing([what_fails(each) for each in failing])
    return ("it does not hold ", Link(anchor=ROBUSTNESS, text="with"), f": {named}")


def _over_the_bounds(dossier: Dossier) -> ColumnOf[Requirement] | None:
    """Return the column with the spread over the bounds of all numbers, where one stop is judged."""
    found = dossier.uncertainty
    if found is None or isinstance(dossier.judgment.wanted, Requirements):
        return None

    def read(row: Requirement) -> str:
        spread = found.spread_of(_SPREADS[row.name]) if row.name in _SPREADS else None
        if spread is None:
            return numbers.NONE
        low, high = (
            figure(row, each) if math.isfinite(each) else "no stop" for each in (spread.low, spread.high)
        )
        return f"{low.removesuffix(f' {row.unit}')} to {high}"

    return ColumnOf(title="Over the bounds", flush_right=True, read=read)


def _requirements(dossier: Dossier) -> Table:
    judgment = dossier.judgment
    unverified = sum(each.limit is not None and not each.verified for each in judgment.limited)
    return build(
        judgment.rows,
        (
            ColumnOf(title="", read=lambda each: each.id),
            ColumnOf(title="Requirement", read=title),
            ColumnOf(title="Limit", flush_right=True, read=limit),
            ColumnOf(title="Reached", flush_right=True, read=reached),
            ColumnOf(title="Margin", flush_right=True, read=margin),
            *([over] if (over := _over_the_bounds(dossier)) else []),
            ColumnOf(title="Evidence", read=lambda each: each.evidence),
            ColumnOf(title="Finding", read=finding),
        ),
        caption=f"What is asked for ({judgment.name}) and what is reached on {stops_of(judgment)}; margin over the "
        f"limit, positive where it is kept. {_SLIP if any(each.name == 'slip_rms' for each in judgment.rows) else ''}"
        f"{numbers.count(unverified, 'limit')} not verified against a source. Told: not required.",
        anchor="requirements-table",
    )


_COLUMNS = (
    ("Proved", (Finding.PROVED,)),
    ("Samples only", (Finding.EVIDENCE,)),
    ("Refuted, or a limit proved", (Finding.REFUTED, Finding.LIMITATION)),
    ("Undecided", (Finding.UNDECIDED,)),
)


def _ladder(certificates: Sequence[Certificate], dossier: Dossier) -> Table:
    """Count what is shown on each rung, from the equations to a measurement, of which there is none."""

    def counted(rung: HoldsFor, statuses: tuple[Finding, ...]) -> str:
        group = [
            each for each in certificates if HOLDS_FOR.get(each.name) is rung and each.status in statuses
        ]
        return str(len(group)) if group else numbers.NONE

    rows: list[tuple[Text, ...]] = [
        (rung.value, *(counted(rung, statuses) for _, statuses in _COLUMNS)) for rung in HoldsFor
    ]
    rows.append(("measured on a vehicle", *[numbers.NONE] * len(_COLUMNS)))
    span = format_quantity(dossier.specification.sample_time, "ms")
    return Table(
        columns=(
            Column(title="Holds for"),
            *(Column(title=title, align="right") for title, _ in _COLUMNS),
        ),
        rows=tuple(rows),
        caption=f"Ladder of evidence: checks that speak about this law, by what stands between it and the wheel "
        f"(sampled every {span}). The requirements count from the rung that each of them needs; nothing was measured.",
        anchor="evidence-ladder",
    )
