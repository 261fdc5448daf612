"""Page one: the verdict in one sentence, four key numbers and the table of checks."""

import math
from collections import Counter
from dataclasses import replace

from wspd_design.certificates.records import Certificate
from wspd_design.certificates.theorems.shortest_stop.stop_bound import rounded_down
from wspd_design.parameters.records import ParameterSet
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Cell, KeyNumber, KeyNumbers, Status, Table, Verdict
from wspd_design.reporting.brakes import lag_times
from wspd_design.reporting.figures.drawing import KMH
from wspd_design.reporting.sections.checks import check_anchor, finding_anchor, is_bad_news, status_of
from wspd_design.reporting.sections.requirements import REQUIREMENTS, stops_of
from wspd_design.reporting.sections.robustness import ROBUSTNESS, what_fails
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Inline, Link, Text
from wspd_design.reporting.yardsticks import ideal_distance, proved_bound
from wspd_design.simulation.description import held_slip, rails_of
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.records import Ending
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.faults import Robustness
from wspd_design.studies.judgment import Judgment

COUNTED = {
    Status.REFUTED: "refuted",
    Status.LIMITATION: "proved to be a limitation",
    Status.UNDECIDED: "undecided",
    Status.EVIDENCE: "sampled only",
    Status.PROVED: "proved",
    Status.VACUOUS: "vacuous",
    Status.NOT_APPLICABLE: "not applicable",
}
"""Each finding in words that follow a number."""


def verdict(dossier: Dossier) -> Verdict:
    """Return the judgment of the whole report; the worst finding decides.

    A design with requirements is accepted if it meets them all and nothing is refuted; one without is judged by the
    tolerance of its slip.
    """
    certificates, judgment = dossier.certificates, dossier.judgment
    counts = Counter(map(status_of, certificates))
    total = len(certificates)
    stop, stop_is_good = _stop(dossier)
    spoken: tuple[Inline, ...]
    if named := [each for each in certificates if is_bad_news(each)]:
        status = Status.REFUTED
        limits = " or proved to be a limitation" if counts[Status.LIMITATION] else ""
        spoken = (
            f"Not fit as it stands: {len(named)} of {total} checks refuted{limits} (",
            *_links(named),
            "). ",
            *(("It misses ", *_required(judgment), ". ") if judgment is not None and judgment.missed else ()),
        )
    elif judgment is not None and judgment.missed:
        status = Status.BAD
        spoken = ("Not fit as it stands: no check is refuted, but it misses ", *_required(judgment), ". ")
    elif not stop_is_good:
        status = Status.BAD
        spoken = ("Not fit as it stands: no check is refuted, but the simulated stop is not as specified. ",)
    elif judgment is not None:
        status = Status.ACCEPTED
        spoken = (
            "Accepted: it meets ",
            *_required(judgment),
            ", and no check that speaks about it is refuted. That is shown by simulated stops, not proved",
            *_not_shown(certificates),
            ". ",
            *_fails_with(dossier.robustness),
        )
    elif named := _of(certificates, Status.UNDECIDED):
        status = Status.UNDECIDED
        spoken = (
            f"Not decided: {len(named)} of {total} checks neither proved nor refuted (",
            *_links(named),
            "). ",
        )
    elif named := _of(certificates, Status.EVIDENCE):
        status = Status.EVIDENCE
        spoken = (
            f"Nothing speaks against it, but {len(named)} of {total} checks hold at samples "
            "only, which proves nothing between them. ",
        )
    elif counts[Status.PROVED]:
        status = Status.PROVED
        spoken = ("Every check that speaks about this controller is proved under its stated assumptions. ",)
    else:
        status = Status.VACUOUS
        spoken = ("No check says anything about this controller. ",)
    assumptions = {text for each in certificates for text in each.assumptions}
    tally = numbers.listing([f"{counts[each]} {COUNTED[each]}" for each in COUNTED if counts[each]])
    counted = f" Checks: {tally}; {numbers.count(len(assumptions), 'assumption')}."
    return Verdict(status=status, sentence=(*spoken, stop, counted if tally else ""))


def _required(judgment: Judgment) -> tuple[Inline, ...]:
    """Say how many requirements are met or missed, and where they are judged."""
    limited, missed = judgment.limited, judgment.missed
    number = f"{len(missed)} of {len(limited)}" if missed else f"all {len(limited)}"
    named = f" ({numbers.listing([each.title for each in missed])})" if missed else ""
    return (
        f"{number} ",
        Link(anchor=REQUIREMENTS, text="requirements"),
        f"{named} on {stops_of(judgment)}",
    )


def _not_shown(certificates: tuple[Certificate, ...]) -> tuple[Inline, ...]:
    """Name what an accepted design leaves open."""
    undecided, sampled = (_of(certificates, each) for each in (Status.UNDECIDED, Status.EVIDENCE))
    said: list[Inline] = []
    if undecided:
        said += ["; undecided: ", *_links(undecided)]
    if sampled:
        said += ["; sampled only: ", *_links(sampled)]
    return tuple(said)


def _fails_with(robustness: Robustness | None) -> tuple[Inline, ...]:
    """Name the faults with which an accepted design does not hold."""
    failing = [] if robustness is None else [each for each in robustness.stops if not robustness.holds(each)]
    if not failing:
        return ()
    named = numbers.listing([what_fails(each) for each in failing])
    return ("It does not hold ", Link(anchor=ROBUSTNESS, text="with a fault"), f": {named}. ")


def _of(certificates: tuple[Certificate, ...], *found: Status) -> list[Certificate]:
    return [each for each in certificates if status_of(each) in found]


def _links(certificates: list[Certificate]) -> list[Inline]:
    links: list[Inline] = []
    for each in certificates:
        links += [", "] if links else []
        links.append(Link(anchor=check_anchor(each), text=_lowered(each.title)))
    return links


def _lowered(title: str) -> str:
    """Begin a title in lower case, unless it begins with a symbol or a name in capitals."""
    return title if title[1:2].isupper() or not title[1:2].isalpha() else title[0].lower() + title[1:]


def _stop(dossier: Dossier) -> tuple[str, bool]:
    """Say how the design's own stop went, and whether it kept to the tolerance if that is what it is judged by."""
    own, specification = dossier.trials[0], dossier.specification
    run, figures = own.run, own.metrics
    start = (
        f"The simulated stop of {run.train} from "
        f"{numbers.significant(run.initial_speed * KMH)} km/h on {rails_of(dossier.scenario)}"
    )
    if run.ending is not Ending.STOPPED:
        return f"{start} does not end: {run.ending.value}.", False
    takes = f"{start} takes {numbers.uncertain(figures.distance, own.check.spread, 1)} m"
    if dossier.judgment is not None:
        known = figures.ideal_ending is Ending.STOPPED
        return f"{takes}{f', the ideal stop {ideal_distance(figures)}' if known else ''}.", True
    inside = figures.slip_rms <= specification.slip_tolerance
    side = "within" if inside else "beyond"
    said = (
        f"{takes}; the slip is off its reference of "
        f"{held_slip(run, specification.slip)} by {numbers.decimals(figures.slip_rms, 3)} rms, {side} the tolerance of "
        f"{specification.slip_tolerance:g}."
    )
    return said, inside


def summary(dossier: Dossier) -> tuple[Block, ...]:
    """Return the key numbers and the table of checks."""
    return (KeyNumbers(numbers=_key_numbers(dossier)), _checks(dossier.certificates))


def _key_numbers(dossier: Dossier) -> tuple[KeyNumber, ...]:
    own, specification = dossier.trials[0], dossier.specification
    run, figures = own.run, own.metrics
    stopped = run.ending is Ending.STOPPED
    start = f"from {numbers.significant(run.initial_speed * KMH)} km/h on {rails_of(dossier.scenario)}"
    in_range = [
        point
        for point in dossier.linearizations
        if specification.speeds[0] <= point.speed <= specification.speeds[1]
    ]
    worst = max(in_range, key=lambda point: point.slip_pole)
    return (
        KeyNumber(
            label="Stopping distance" if stopped else "Distance, still moving",
            value=numbers.uncertain(figures.distance, own.check.spread, 1),
            unit="m",
            note=f"{start} ({run.plant}), in {numbers.decimals(figures.stopping_time, 2)} s{_build_up(figures)}",
        ),
        KeyNumber(
            label="Efficiency",
            value=numbers.decimals(100.0 * figures.efficiency, 1),
            unit="%" if math.isfinite(figures.efficiency) else "",
            note=_yardsticks(dossier),
        ),
        _slip_or_requirements(dossier),
        KeyNumber(
            label="Largest nominal slip pole",
            value=numbers.decimals(worst.slip_pole, 2),
            unit="1/s",
            note=f"at {numbers.significant(worst.speed * KMH, 3)} km/h; 1/τ = "
            f"{numbers.decimals(1.0 / worst.time_constant, 2)} 1/s{_between_times(dossier.vehicle)}",
        ),
    )


def _slip_or_requirements(dossier: Dossier) -> KeyNumber:
    """Return what the design is judged by."""
    judgment, figures, specification = (
        dossier.judgment,
        dossier.trials[0].metrics,
        dossier.specification,
    )
    if judgment is not None:
        met = len(judgment.limited) - len(judgment.missed)
        return KeyNumber(
            label="Requirements met",
            value=f"{met} of {len(judgment.limited)}",
            note=(Link(anchor=REQUIREMENTS, text="on"), f" {stops_of(judgment)}"),
        )
    return KeyNumber(
        label=f"Slip rms above {numbers.quantity_in(JUDGING_SPEED, 'km/h')}",
        value=numbers.decimals(figures.slip_rms, 3),
        note=f"reference {held_slip(dossier.trials[0].run, specification.slip)}, tolerance "
        f"{specification.slip_tolerance:g}",
    )


def _between_times(vehicle: ParameterSet) -> str:
    """Say between which rates that of an averaged lag lies; nothing if it fills as fast as it vents."""
    times = lag_times(vehicle)
    if times is None or times[0] == times[1]:
        return ""
    fill, vent = (numbers.decimals(1.0 / time, 2) for time in times)
    return f" there, between {fill} 1/s of filling and {vent} 1/s of venting"


def _build_up(figures: Metrics) -> str:
    """Part a stop into build-up and plateau; where the deceleration falls so much that no lag is left, say nothing."""
    if not figures.lag > 0.0:
        return ""
    lag, plateau = (numbers.decimals(value, 2) for value in (figures.lag, figures.plateau))
    return f": {lag} s of build-up, then {plateau} m/s²"


def _yardsticks(dossier: Dossier) -> Text:
    """Say what the efficiency is a share of, and what is proved, each under its own name."""
    ideal = f"ideal stop, simulated: {ideal_distance(dossier.trials[0].metrics)}"
    proved = proved_bound(dossier.certificates)
    if proved is None:
        return f"{ideal}; no bound is proved"
    start = numbers.significant(dossier.specification.speeds[1] * KMH)
    link = Link(anchor=check_anchor(proved.certificate), text="proved bound")
    return (f"{ideal}; ", link, f" from {start} km/h: {rounded_down(proved.distance)} m")


def _checks(certificates: tuple[Certificate, ...]) -> Table:
    silent = _of(certificates, Status.NOT_APPLICABLE)
    table = build(
        [each for each in certificates if each not in silent],
        (
            ColumnOf(title="Check", read=lambda each: (Link(anchor=check_anchor(each), text=each.name),)),
            ColumnOf(title="Finding", read=lambda each: Cell(status=status_of(each))),
            ColumnOf(title="What is checked", read=lambda each: each.title),
            ColumnOf(title="Margin", flush_right=True, read=lambda each: numbers.margin(each.margin)),
        ),
        caption="All checks. A margin is positive where the claim holds; ≤: sampling bounds it from above "
        "only.",
        anchor="checks",
    )
    if not silent:
        return table
    link = Link(anchor=finding_anchor(Status.NOT_APPLICABLE), text=f"{len(silent)} more")
    names = ", ".join(each.name for each in silent)
    row = ((link,), Cell(status=Status.NOT_APPLICABLE), names, numbers.NONE)
    return replace(table, rows=(*table.rows, row))
