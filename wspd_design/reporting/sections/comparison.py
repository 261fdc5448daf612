"""The same stop with every controller, and the paper's Table 10 where it applies."""

from functools import partial

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import (
    Block,
    Cell,
    Column,
    Figure,
    Heading,
    Paragraph,
    Status,
    Table,
)
from wspd_design.reporting.figures.comparison import distance_bars, distances_alt, slip_of_all, slips_alt
from wspd_design.reporting.figures.drawing import KILO, KMH, picture
from wspd_design.reporting.text import CodeSpan, Text
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.records import Ending
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.paper.published import PublishedStop, load_table10

BAR_HEIGHT, ROW_HEIGHT = 0.33, 1.55  # in


def comparison(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section that compares the controllers."""
    trials, specification = dossier.trials, dossier.design.specification
    published = _published(dossier)
    draw_bars = partial(
        distance_bars, trials=trials, lag_distances=dossier.lag_distances, published=published
    )
    rows = -(-len(trials) // (3 if len(trials) > 4 else 2))
    marked = " Black marks: Table 10 of the paper." if published else ""
    found: list[Block] = [
        Heading(text="Comparison", anchor="comparison"),
        Figure(
            svg=picture(draw_bars, height=0.6 + BAR_HEIGHT * len(trials)),
            caption="Stopping distances. Dark: initial speed times lag, what the brake build-up costs; "
            f"light: the rest, at the plateau deceleration. Dashed: the bound of "
            f"{numbers.decimals(trials[0].metrics.bound, 1)} m, which no controller can beat.{marked}",
            alt=distances_alt(trials, dossier.lag_distances),
            anchor="distances",
        ),
        Paragraph(text=_ranking(dossier)),
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


def _published(dossier: Dossier) -> dict[str, PublishedStop]:
    """Return the paper's stops, if the rail is one that reproduces them and the stops start alike."""
    table10 = load_table10()
    same_start = abs(dossier.initial_speed * KMH - table10.initial_speed_kmh) < 1e-6
    return table10.on(dossier.trials[0].run.rail) if same_start else {}


def _ranking(dossier: Dossier) -> Text:
    """Say what separates the shortest from the longest stop, and what the ranking is worth."""
    stopped = [
        (trial, lag)
        for trial, lag in zip(dossier.trials, dossier.lag_distances, strict=True)
        if trial.run.ending is Ending.STOPPED
    ]
    decay, ratio = (dossier.rail.entries[name].value for name in ("friction_decay", "friction_ratio"))
    world = (
        "On this rail the friction falls with the sliding speed, so that adhesion is lost by sliding."
        if decay != 0.0 and ratio != 1.0
        else "On this rail the friction does not fall with the sliding speed: a locked wheel brakes at least "
        "as well as a controlled one, and the ranking says nothing about the control of slip. It needs a rail "
        "with a peak."
    )
    meaning = (
        "Lag and plateau are the dead time and the constant deceleration that together give the same "
        "distance and time. They part the build-up of the brake from the use of adhesion as long as the "
        "deceleration stays about the same; where it falls during the stop, as with wheels locked on "
        "falling friction, the lag comes out too small and the plateau too low. "
    )
    if len(stopped) < 2:
        return meaning + world
    (best, best_lag), (worst, worst_lag) = (
        pick(stopped, key=lambda each: each[0].metrics.distance) for pick in (min, max)
    )
    gap = worst.metrics.distance - best.metrics.distance
    return (
        f"{meaning}Between the shortest stop, ",
        CodeSpan(text=best.run.controller),
        f" with {best.metrics.distance:.1f} m, and the longest, ",
        CodeSpan(text=worst.run.controller),
        f" with {worst.metrics.distance:.1f} m, lie {gap:.1f} m: "
        f"{numbers.decimals(worst_lag - best_lag, 1)} m of lag and "
        f"{numbers.decimals(gap - worst_lag + best_lag, 1)} m of plateau. {world} The torque integral is a "
        "balance of momentum, nearly the same for all, and no measure of air consumption.",
    )


def _stops(trials: tuple[Trial, ...]) -> Table:
    return Table(
        columns=(
            Column(title="Controller"),
            Column(title="Distance", unit="m", align="right"),
            Column(title="Efficiency", unit="%", align="right"),
            Column(title="Time", unit="s", align="right"),
            Column(title="Lag", unit="s", align="right"),
            Column(title="Plateau", unit="m/s²", align="right"),
            Column(title="Slip rms", unit="-", align="right"),
            Column(title="Mean", unit="-", align="right"),
            Column(title="Largest", unit="-", align="right"),
            Column(title="Locked", unit="s", align="right"),
        ),
        rows=tuple(
            (
                each.run.controller + ("" if each.run.ending is Ending.STOPPED else ", still moving"),
                numbers.uncertain(each.metrics.distance, each.check.spread, 1),
                numbers.decimals(100.0 * each.metrics.efficiency, 1),
                numbers.decimals(each.metrics.stopping_time, 2),
                numbers.decimals(each.metrics.lag, 2),
                numbers.decimals(each.metrics.plateau, 2),
                numbers.decimals(each.metrics.slip_rms, 3),
                numbers.decimals(each.metrics.slip_mean, 3),
                numbers.decimals(each.metrics.slip_max, 3),
                numbers.decimals(each.metrics.lock_time, 2),
            )
            for each in trials
        ),
        caption=f"Stops of the {trials[0].run.plant} locomotive; this design first. The bound is "
        f"{numbers.decimals(trials[0].metrics.bound, 1)} m, efficiency is bound over distance. Slip of all "
        "wheelsets about its reference above 10 km/h; locked: the wheelset that is locked longest. Lag "
        "2 d/v0 − t and plateau v0/(2 (t − d/v0)) follow from distance d, time t and initial speed v0.",
        anchor="stops-table",
    )


def _efforts(trials: tuple[Trial, ...]) -> Table:
    return Table(
        columns=(
            Column(title="Controller"),
            Column(title="Adhesion used", unit="%", align="right"),
            Column(title="Torque integral", unit="kN m s", align="right"),
            Column(title="Air vented", unit="cylinders", align="right"),
            Column(title="Saturated samples", unit="%", align="right"),
            Column(title="Valve switches", align="right"),
        ),
        rows=tuple(
            (
                each.run.controller,
                numbers.decimals(100.0 * each.metrics.adhesion_utilization, 1),
                numbers.decimals(each.metrics.torque_integral / KILO, 1),
                numbers.decimals(each.metrics.vented_air, 2),
                numbers.decimals(100.0 * each.metrics.saturated_share, 0),
                str(each.metrics.valve_switches),
            )
            for each in trials
        ),
        caption="Effort of the same stops. Adhesion used: creep force over that of the adhesion peak, over the "
        "whole stop with its build-up. Air vented: full brake cylinders per wheelset. Torque integral: sum of "
        "the wheelsets, a balance of momentum and no measure of air.",
        anchor="efforts-table",
    )


def _accuracy(trials: tuple[Trial, ...]) -> Table:
    return Table(
        columns=(
            Column(title="Controller"),
            Column(title="Steps"),
            Column(title="Distance, half steps", unit="relative", align="right"),
            Column(title="Slip, half steps", unit="-", align="right"),
            Column(title="Spread", unit="m", align="right"),
            Column(title="Momentum residual", unit="-", align="right"),
            Column(title="Energy residual", unit="-", align="right"),
        ),
        rows=tuple(
            (
                each.run.controller,
                Cell(status=Status.UNDECIDED, text="chaotic")
                if each.check.chaotic
                else Cell(status=Status.GOOD, text=f"1/{each.check.refinement}"),
                numbers.significant(each.check.distance, 2),
                numbers.significant(each.check.slip, 2),
                numbers.significant(each.check.spread, 2) if each.check.chaotic else numbers.NONE,
                numbers.significant(each.metrics.momentum_residual, 2),
                numbers.significant(each.metrics.energy_residual, 2),
            )
            for each in trials
        ),
        caption="How far the simulation can be trusted: what half as long steps change in the distance and at "
        "most in the slip at any sample above 0.3 m/s, after steps of the usual length divided as stated. A "
        "chaotic closed loop amplifies the last digits, so that no step makes it accurate: its spread is the "
        "range of the distance over initial speeds that differ by millionths. The residuals are what the "
        "balances of momentum and energy miss, relative to their initial values.",
        anchor="accuracy-table",
    )


def _table10(trials: tuple[Trial, ...], published: dict[str, PublishedStop]) -> Table:
    rows = []
    for each in trials:
        theirs = published.get(each.run.controller)
        if theirs is not None:
            rows.append(
                (
                    each.run.controller,
                    numbers.decimals(theirs.distance_m, 2),
                    numbers.uncertain(each.metrics.distance, each.check.spread, 2),
                    numbers.decimals(theirs.stopping_time_s, 1),
                    numbers.decimals(each.metrics.stopping_time, 1),
                    numbers.decimals(theirs.torque_integral_kNms, 2),
                    numbers.decimals(each.metrics.torque_integral / KILO, 2),
                )
            )
    return Table(
        columns=(
            Column(title=f"Controller on {trials[0].run.rail}"),
            Column(title="Distance, paper", unit="m", align="right"),
            Column(title="here", unit="m", align="right"),
            Column(title="Time, paper", unit="s", align="right"),
            Column(title="here", unit="s", align="right"),
            Column(title="Torque integral, paper", unit="kN m s", align="right"),
            Column(title="here", unit="kN m s", align="right"),
        ),
        rows=tuple(rows),
        caption="Table 10 of the paper beside the same stops here. The friction of this rail and the "
        "baselines were fitted to that table, so that agreement confirms the fit and nothing else.",
        anchor="table10",
    )
