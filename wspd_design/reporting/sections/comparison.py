"""The same stop with every controller, and the paper's Table 10 where it applies."""

import math
from collections.abc import Mapping
from functools import partial

from wspd_design.design.industry import table_note
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import (
    Block,
    Cell,
    Figure,
    Heading,
    Paragraph,
    Status,
    Table,
)
from wspd_design.reporting.figures.comparison import distance_bars, distances_alt, slip_of_all, slips_alt
from wspd_design.reporting.figures.drawing import KILO, KMH, picture
from wspd_design.reporting.sections.checks import check_anchor
from wspd_design.reporting.statements import statements_of
from wspd_design.reporting.tables import ColumnOf, Uncertain, build
from wspd_design.reporting.text import CodeSpan, Inline, Link, Text, spans
from wspd_design.reporting.yardsticks import ideal_distance, ideal_sentence, proved_bound
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.released import released_sentence
from wspd_design.simulation.runs import Ending
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.paper.published import PublishedStop, load_table10

BAR_HEIGHT, ROW_HEIGHT = 0.33, 1.55  # in


def comparison(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section that compares the controllers."""
    trials, specification = dossier.trials, dossier.specification
    published = _published(dossier)
    draw_bars = partial(distance_bars, trials=trials, published=published)
    rows = -(-len(trials) // (3 if len(trials) > 4 else 2))
    marked = " Black marks: Table 10 of the paper." if published else ""
    found: list[Block] = [
        Heading(text="Comparison", anchor="comparison"),
        Paragraph(text=("The same stop with every controller: ", *_contents(published), ".")),
        Figure(
            svg=picture(draw_bars, height=0.6 + BAR_HEIGHT * len(trials)),
            caption=f"Stopping distances. {_parts(dossier)}Dashed: the ideal stop, "
            f"{ideal_distance(trials[0].metrics)}, a simulation of a brake that holds the best slip.{marked}",
            alt=distances_alt(trials),
            anchor="distances",
        ),
        Paragraph(text=_yardsticks(dossier)),
        Paragraph(text=_ranking(dossier)),
        *_notes(trials),
        _stops(trials),
        _efforts(trials),
        _accuracy(trials),
    ]
    if published:
        found.append(_table10(trials, published))
    found.append(
        Figure(
            svg=picture(
                partial(slip_of_all, trials=trials, specification=specification),
                height=0.4 + ROW_HEIGHT * rows,
            ),
            caption="Slip of the wheelsets with each controller, on the same axes. Bars at the upper edge mark "
            "locked wheels, the front wheelset on top.",
            alt=slips_alt(trials, specification),
            anchor="slips",
        )
    )
    return tuple(found)


def _contents(published: Mapping[str, PublishedStop]) -> tuple[Inline, ...]:
    """Refer to the figures and tables of the section."""
    shown = [
        (Link(anchor="distances"), " shows the distances, "),
        (Link(anchor="stops-table"), " lists them with time, slip and locks, "),
        (Link(anchor="efforts-table"), " what they take, "),
        (Link(anchor="accuracy-table"), " how far the simulation can be trusted, "),
        *([(Link(anchor="table10"), " sets the paper's numbers beside them, ")] if published else []),
        (Link(anchor="slips"), " shows the slip over time"),
    ]
    return tuple(part for each in shown for part in each)


def _notes(trials: tuple[Trial, ...]) -> tuple[Block, ...]:
    """Say which tables the laws of the industry take, where their names state it, and which laws let the brake go."""
    note = table_note(each.run.controller for each in trials)
    released = released_sentence((each.run.controller, each.metrics.released_below) for each in trials)
    return tuple(Paragraph(text=text) for text in (note[:1].upper() + note[1:], released) if text)


def _yardsticks(dossier: Dossier) -> Text:
    """Set the simulated yardstick and the proved one side by side, each under its own name."""
    ideal = ideal_sentence(dossier.trials[0].metrics)
    proved = proved_bound(dossier.certificates)
    if proved is None:
        return f"{ideal} No bound on the distance is proved."
    link = Link(anchor=check_anchor(proved.certificate), text=proved.certificate.name)
    claim = statements_of(dossier.certificates).claim(proved.certificate)
    return (f"{ideal} Proved, in the check ", link, ": ", *spans(claim))


def _published(dossier: Dossier) -> dict[str, PublishedStop]:
    """Return the paper's stops, if the rail is one that reproduces them, the stops start alike and undisturbed."""
    table10 = load_table10()
    same_start = abs(dossier.scenario.initial_speed * KMH - table10.initial_speed_kmh) < 1e-6
    made = dossier.scenario
    plain = made == Scenario(rail=made.rail, initial_speed=made.initial_speed, seed=made.seed)
    return table10.on(dossier.trials[0].run.rail) if same_start and plain else {}


def _parts(dossier: Dossier) -> str:
    """Say which part of a bar is which, if they have parts: not where the rail changes along the track."""
    if dossier.scenario.patches:
        return ""
    return "Orange: until the torque of the brake is built up, 90 % of what it then holds; blue: the rest. "


def _ranking(dossier: Dossier) -> Text:
    """Say what separates the shortest from the longest stop, and what the ranking is worth."""
    stopped = [each for each in dossier.trials if each.run.ending is Ending.STOPPED]
    decay, ratio = (dossier.rail.entries[name].value for name in ("friction_decay", "friction_ratio"))
    world = (
        "On this rail the friction falls with the sliding speed, so that adhesion is lost by sliding."
        if decay != 0.0 and ratio != 1.0
        else "On this rail the friction does not fall with the sliding speed: a locked wheel brakes at least "
        "as well as a controlled one, and the ranking says nothing about the control of slip. It needs a rail "
        "with a peak."
    )
    meaning = "The brake is built up where the torque of all wheelsets first reaches 90 % of its median above 10 km/h. "
    if dossier.scenario.patches:
        return "The rail changes along the track: no stop has parts of build-up and of constant deceleration."
    if len(stopped) < 2:
        return meaning + world
    best, worst = (pick(stopped, key=lambda each: each.metrics.distance) for pick in (min, max))
    first = worst.metrics.build_up_distance - best.metrics.build_up_distance
    gap = worst.metrics.distance - best.metrics.distance
    return (
        f"{meaning}The longest stop, ",
        CodeSpan(text=worst.run.controller),
        f" with {worst.metrics.distance:.1f} m, is {gap:.1f} m longer than the shortest, ",
        CodeSpan(text=best.run.controller),
        f" with {best.metrics.distance:.1f} m: {_longer(first)} until the brake is built up, {_longer(gap - first)} "
        f"after it. {world} The torque integral is a "
        "balance of momentum, nearly the same for all, and no measure of air consumption.",
    )


def _longer(distance: float) -> str:
    """Say by how much a stop, or a part of it, is longer than another."""
    return f"{abs(distance):.1f} m {'longer' if distance >= 0.0 else 'shorter'}"


def _stops(trials: tuple[Trial, ...]) -> Table:
    return build(
        trials,
        (
            ColumnOf(
                title="Controller",
                read=lambda each: (
                    each.run.controller + ("" if each.run.ending is Ending.STOPPED else ", still moving")
                ),
            ),
            ColumnOf(
                title="Distance",
                unit="m",
                flush_right=True,
                read=lambda each: numbers.settled(each.metrics.distance, each.check.spread, 1),
            ),
            ColumnOf(
                title="Efficiency", unit="%", decimals=1, read=lambda each: 100.0 * each.metrics.efficiency
            ),
            ColumnOf(title="Time", unit="s", decimals=2, read=lambda each: each.metrics.stopping_time),
            ColumnOf(title="Build-up", unit="s", decimals=2, read=lambda each: each.metrics.build_up),
            ColumnOf(title="Slip rms", unit="-", decimals=3, read=lambda each: each.metrics.held_slip_rms),
            ColumnOf(title="Over", unit="-", decimals=3, read=lambda each: each.metrics.slip_overshoot),
            ColumnOf(title="Under", unit="-", decimals=3, read=lambda each: each.metrics.slip_undershoot),
            ColumnOf(title="Mean", unit="-", decimals=3, read=lambda each: each.metrics.slip_mean),
            ColumnOf(title="Largest", unit="-", decimals=3, read=lambda each: each.metrics.slip_max),
            ColumnOf(title="Locked", unit="s", decimals=2, read=lambda each: each.metrics.lock_time),
        ),
        caption=f"Stops of {trials[0].run.train}; this design first. The ideal stop: "
        f"{ideal_distance(trials[0].metrics)}; efficiency is ideal stop over distance. Slip of all "
        "wheelsets above 10 km/h: rms, overshoot and undershoot about its reference, each wheelset once it has 90 % of "
        f"it{_perfect(trials)}; mean and largest of the whole stop. Locked: the wheelset that is locked longest.",
        anchor="stops-table",
    )


def _perfect(trials: tuple[Trial, ...]) -> str:
    """Say what a perfect law would have in the place of the rms of this design."""
    best = trials[0].metrics.perfect_slip_rms
    return "" if math.isnan(best) else f", where a perfect law has {numbers.decimals(best, 3)} rms"


def _efforts(trials: tuple[Trial, ...]) -> Table:
    return build(
        trials,
        (
            ColumnOf(title="Controller", read=lambda each: each.run.controller),
            ColumnOf(
                title="Adhesion used",
                unit="%",
                decimals=1,
                read=lambda each: 100.0 * each.metrics.adhesion_utilization,
            ),
            ColumnOf(
                title="Torque integral",
                unit="kN m s",
                decimals=1,
                read=lambda each: each.metrics.torque_integral / KILO,
            ),
            ColumnOf(
                title="Air vented", unit="cylinders", decimals=2, read=lambda each: each.metrics.vented_air
            ),
            ColumnOf(
                title="Saturated samples",
                unit="%",
                decimals=0,
                read=lambda each: 100.0 * each.metrics.saturated_share,
            ),
            ColumnOf(title="Valve switches", decimals=0, read=lambda each: each.metrics.valve_switches),
        ),
        caption="Effort of the same stops. Adhesion used: creep force over that of the adhesion peak, over the "
        "whole stop with its build-up. Air vented: full brake cylinders per wheelset. Torque integral: sum of "
        "the wheelsets, a balance of momentum and no measure of air.",
        anchor="efforts-table",
    )


def _accuracy(trials: tuple[Trial, ...]) -> Table:
    return build(
        trials,
        (
            ColumnOf(title="Controller", read=lambda each: each.run.controller),
            ColumnOf(
                title="Steps",
                read=lambda each: (
                    Cell(status=Status.UNDECIDED, text="unresolved")
                    if each.check.unresolved
                    else Cell(status=Status.GOOD, text=f"1/{each.check.refinement}")
                ),
            ),
            ColumnOf(
                title="Distance, half steps",
                unit="relative",
                significant=2,
                read=lambda each: each.check.distance,
            ),
            ColumnOf(title="Slip, half steps", unit="-", significant=2, read=lambda each: each.check.slip),
            ColumnOf(
                title="Spread",
                unit="m",
                significant=2,
                read=lambda each: each.check.spread if each.check.sensitive else math.nan,
            ),
            ColumnOf(
                title="Momentum residual",
                unit="-",
                significant=2,
                read=lambda each: each.metrics.momentum_residual,
            ),
            ColumnOf(
                title="Energy residual",
                unit="-",
                significant=2,
                read=lambda each: each.metrics.energy_residual,
            ),
        ),
        caption="How far the simulation can be trusted: what half as long steps change in the distance and at "
        "most in the slip at any sample above 0.3 m/s, after steps of the usual length divided as stated; a "
        "stop is unresolved if none of them is short enough. A sensitive closed loop amplifies: its spread is the "
        "range of the distance over initial speeds that differ by millionths. The residuals are what the "
        "balances of momentum and energy miss, relative to their initial values; with all degrees of freedom also "
        "what the other bodies, springs and dampers have.",
        anchor="accuracy-table",
    )


def _table10(trials: tuple[Trial, ...], published: dict[str, PublishedStop]) -> Table:
    pairs = [(each, published[each.run.controller]) for each in trials if each.run.controller in published]
    return build(
        pairs,
        (
            ColumnOf(title=f"Controller on {trials[0].run.rail}", read=lambda pair: pair[0].run.controller),
            ColumnOf(title="Distance, paper", unit="m", decimals=2, read=lambda pair: pair[1].distance_m),
            ColumnOf(
                title="here",
                unit="m",
                decimals=2,
                read=lambda pair: Uncertain(value=pair[0].metrics.distance, spread=pair[0].check.spread),
            ),
            ColumnOf(title="Time, paper", unit="s", decimals=1, read=lambda pair: pair[1].stopping_time_s),
            ColumnOf(title="here", unit="s", decimals=1, read=lambda pair: pair[0].metrics.stopping_time),
            ColumnOf(
                title="Torque integral, paper",
                unit="kN m s",
                decimals=2,
                read=lambda pair: pair[1].torque_integral_kNms,
            ),
            ColumnOf(
                title="here",
                unit="kN m s",
                decimals=2,
                read=lambda pair: pair[0].metrics.torque_integral / KILO,
            ),
        ),
        caption="Table 10 of the paper beside the same stops here. The friction of this rail and the "
        "baselines were fitted to that table, so that agreement confirms the fit and nothing else.",
        anchor="table10",
    )
