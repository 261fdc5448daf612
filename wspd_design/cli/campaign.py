"""Many stops: simulate, write the rows, show the spread."""

import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wspd_design.cli.console import console, interrupted, print_json, progress_bar, spaced
from wspd_design.cli.from_witness import WitnessStart
from wspd_design.cli.json_objects import campaign_object, campaigns_object
from wspd_design.cli.summary import Summary, summarize
from wspd_design.cli.tables import write_table
from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.design.case import Case
from wspd_design.parameters.files import load_entries
from wspd_design.plants.names import plant_of
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.simulation.campaign import Campaign, simulate_many
from wspd_design.simulation.description import disturbances_of, rails_of
from wspd_design.simulation.draws import Draw, within_bounds_of_stop
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.self_check import DISTANCE_TOLERANCE, SLIP_TOLERANCE

if TYPE_CHECKING:
    from numpy.typing import NDArray

_NAMES = {
    "distance_m": "distance [m]",
    "stopping_time_s": "time [s]",
    "efficiency": "efficiency",
    "slip_rms": "slip rms about the law's reference",
    "lock_time_s": "wheels locked [s]",
    "longest_lock_s": "longest lock above 10 km/h [s]",
    "valve_switches_per_s": "valve switches [1/s]",
    "vented_air": "cylinders vented",
}
GOES_ON = "; they are in {store}, and the same command goes on from there"
_BLOCK = 8192  # rows that are written at a time


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """Many stops of one law on one rail."""

    case: Case
    scenario: Scenario
    draws: tuple[Draw, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """Which stops of every series are to be simulated, and where they are kept."""

    plant: str
    first: int
    count: int
    check_every: int
    store: Path | None


def simulate_series(
    series: Sequence[Series], extent: Extent, opened: Callable[[], Any], *, what: str
) -> list[Summary]:
    """Simulate one series after the other; an interrupt ends the list with the one that it came in.

    Parameters
    ----------
    series : sequence of Series
        Laws and rails.
    extent : Extent
        Which stops.
    opened : callable
        Makes a context whose value is the executor, or None for the usual one.
    what : str
        Words beside the progress.
    """
    summaries: list[Summary] = []
    with opened() as executor, progress_bar(what, len(series) * extent.count) as tell:
        for each in series:
            campaign = _simulate(
                each, extent, executor, lambda done: tell(len(summaries) * extent.count + done)
            )
            for sentence in campaign.remade:
                print(f"wspd: {sentence}.", file=sys.stderr)
            summaries.append(summarize(campaign, wanted=extent.count))
            if not campaign.complete:
                break
    return summaries


def _simulate(
    series: Series, extent: Extent, executor: Executor | None, tell: Callable[[int], object]
) -> Campaign:
    return simulate_many(
        series.case.vehicle,
        series.case.controller,
        series.scenario,
        count=extent.count,
        first=extent.first,
        draws=series.draws,
        plant=extent.plant,
        check_every=extent.check_every,
        executor=executor,
        store=extent.store,
        progress=tell,
    )


def simulate_runs(
    case: Case,
    scenario: Scenario,
    extent: Extent,
    *,
    nominal: bool,
    output: Path | None,
    force: bool,
    as_json: bool,
    start: WitnessStart | None,
) -> None:
    """Simulate many stops and say how they spread; an interrupt keeps what is done.

    Where there is a store, it is that which keeps it: no rows are written then, which the same command would refuse to
    replace when it goes on.

    Parameters
    ----------
    case : Case
        Vehicle, rail and controller.
    scenario : Scenario
        The stop; its seed starts the sequence of seeds.
    extent : Extent
        Which stops.
    nominal : bool
        Draw seeds only.
    output : Path or None
        Where the rows go.
    force : bool
        Whether an existing file may be replaced.
    as_json : bool
        Print an object in place of the table.
    start : WitnessStart or None
        The witness that the stops start at.
    """
    draws = () if nominal else drawn_by_runs(case, scenario, extent.plant)
    series = [Series(case=case, scenario=scenario, draws=draws)]
    what = f"{extent.count} stops with {case.controller.name}"
    (summary,) = simulate_series(series, extent, _usual_executor, what=what)
    table, complete = summary.campaign.table, summary.campaign.complete
    written = output if complete or (len(table) and extent.store is None) else None
    if written is not None:
        write_table(written, [table], force=force, about=_about(series))
    if as_json:
        print_json(campaign_object(summary, case, scenario, start))
    elif len(table):
        show(summary, series[0])
        if written is not None:
            _say_rows(written)
    if complete:
        return
    kept = f"; they are in {written}" if written is not None else ""
    if extent.store is not None:
        kept = GOES_ON.format(store=extent.store)
    raise interrupted(f"{len(table)} of {extent.count} stops{kept}")


def tell_series(
    series: Sequence[Series], summaries: Sequence[Summary], *, output: Path | None, force: bool, as_json: bool
) -> None:
    """Write and show the results of several series, whole ones and one that was interrupted."""
    if output is not None:
        rows = labelled([each.campaign for each in summaries])
        write_table(output, rows, force=force, about=_about(series))
    pairs = list(zip(series, summaries, strict=False))
    if as_json:
        print_json(
            campaigns_object([campaign_object(summary, each.case, each.scenario) for each, summary in pairs])
        )
        return
    for each, summary in pairs:
        if len(summary.campaign.table):
            show(summary, each)
    if output is not None:
        _say_rows(output)


def _about(series: Sequence[Series]) -> dict[str, str]:
    """Say what was simulated, for the head of a file; laws and rails of several series stand in its columns."""
    first = series[0]
    names = {
        "controller": {each.case.controller.name for each in series},
        "vehicle": {each.case.vehicle.name for each in series},
        "rail": {rails_of(each.scenario) for each in series},
        "sample_time_s": {repr(each.case.controller.sample_time) for each in series},
        "initial_speed_m_s": {repr(each.scenario.initial_speed) for each in series},
    }
    return {key: ", ".join(sorted(found)) for key, found in names.items()} | {
        "seed": str(first.scenario.seed)
    }


def labelled(campaigns: Sequence[Campaign]) -> "Iterator[NDArray[Any]]":
    """Rows of several campaigns below each other, with law and rail in front, a block at a time.

    A number that one of them has not, such as the speed that only some laws estimate, is NaN in its rows.
    """
    import numpy as np

    columns: dict[str, np.dtype[Any]] = {}
    for campaign in campaigns:
        columns |= {name: campaign.table.dtype[name] for name in campaign.table.dtype.names or ()}
    labels = [("controller", f"U{max(len(each.controller) for each in campaigns)}")]
    labels.append(("rail", f"U{max(len(each.rail) for each in campaigns)}"))
    for campaign in campaigns:
        missing = columns.keys() - set(campaign.table.dtype.names or ())
        for start in range(0, max(len(campaign.table), 1), _BLOCK):
            rows = campaign.table[start : start + _BLOCK]
            block = np.zeros(len(rows), dtype=[*labels, *columns.items()])
            block["controller"], block["rail"] = campaign.controller, campaign.rail
            for name in rows.dtype.names or ():
                block[name] = rows[name]
            for name in missing:
                block[name] = np.nan
            yield block


@contextmanager
def _usual_executor() -> Iterator[None]:
    yield None


def _say_rows(path: Path) -> None:
    console().print(f"Rows: {path}", markup=False, soft_wrap=True)


def drawn_by_runs(case: Case, scenario: Scenario, plant: str) -> tuple[Draw, ...]:
    """Return what many stops of a case draw: all numbers with bounds of its files that count on the plant."""
    files = load_entries("vehicle", case.vehicle_name), load_entries("rail", case.rail_name)
    return within_bounds_of_stop(scenario, files, plant_of(plant, case.vehicle))


def show(summary: Summary, series: Series) -> None:
    """Show the spread of one series."""
    out, campaign = console(), summary.campaign
    case, scenario = series.case, series.scenario
    out.print(
        f"{len(campaign.table)} stops of {campaign.controller} on {rails_of(scenario)}, {case.vehicle.name} "
        f"({campaign.plant}), from {scenario.initial_speed * 3.6:g} km/h, "
        f"sample time {case.controller.sample_time * 1e3:g} ms",
        style="bold",
        markup=False,
    )
    disturbances = disturbances_of(scenario)
    if disturbances:
        out.print(f"With {disturbances}.", markup=False)
    shown = build(
        summary.spreads.items(),
        (
            ColumnOf(title="Figure", read=lambda row: _NAMES[row[0]]),
            ColumnOf(title="min", decimals=2, read=lambda row: row[1].min),
            ColumnOf(title="5 %", decimals=2, read=lambda row: row[1].p05),
            ColumnOf(title="median", decimals=2, read=lambda row: row[1].median),
            ColumnOf(title="95 %", decimals=2, read=lambda row: row[1].p95),
            ColumnOf(title="max", decimals=2, read=lambda row: row[1].max),
        ),
        caption="",
    )
    out.print(spaced(terminal_table(shown)))
    share = summary.not_stopped_share
    out.print(
        f"Not stopped within the time limit: {100.0 * share:.3g} %"
        + (", which the figures leave out." if share else "."),
        style="yellow" if share else "",
    )
    out.print(_checks_sentence(summary), style="yellow" if summary.checks.failed else "", markup=False)
    drawn = series.draws
    out.print(
        f"Each stop draws: {', '.join(draw.name for draw in drawn)}." if drawn else "Drawn: seeds only.",
        style="dim",
        markup=False,
    )
    distance = summary.spreads["distance_m"]
    if not drawn and distance.min == distance.max and len(campaign.table) > 1:
        out.print(
            "All stops are the same: what is random, --speed-noise, --reference-noise or --pulses, is off or "
            "changes nothing.",
            style="yellow",
        )


def _checks_sentence(summary: Summary) -> str:
    checks, every = summary.checks, summary.campaign.check_every
    if checks.rows == 0:
        return "No row was checked with half the integration steps."
    return (
        f"Half the integration steps, runs 0, {every}, {2 * every}, ...: {checks.rows - checks.failed} of "
        f"{checks.rows} within {DISTANCE_TOLERANCE:g} of the distance and {SLIP_TOLERANCE:g} of slip; largest change "
        f"{checks.distance_change:.1e} and {checks.slip_change:.1e}."
    )
