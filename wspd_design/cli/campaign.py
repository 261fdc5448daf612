"""Many stops: simulate, write the rows, show the spread."""

import sys
from pathlib import Path

import typer

from wspd_design.cli.console import console, print_json, progress_bar, spaced
from wspd_design.cli.exit_codes import INTERRUPTED
from wspd_design.cli.from_witness import WitnessStart
from wspd_design.cli.json_objects import campaign_object
from wspd_design.cli.summary import Summary, summarize
from wspd_design.cli.tables import write_table
from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.design.case import Case
from wspd_design.parameters.files import load_entries
from wspd_design.parameters.records import ParameterSet
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.description import disturbances_of, rails_of
from wspd_design.simulation.records import Scenario

_NAMES = {"distance_m": "distance [m]", "stopping_time_s": "time [s]", "lock_time_s": "wheels locked [s]"}


def simulate_campaign(
    case: Case,
    scenario: Scenario,
    *,
    plant: str,
    runs: int,
    nominal: bool,
    output: Path | None,
    force: bool,
    as_json: bool,
    start: WitnessStart | None,
) -> None:
    """Simulate many stops and say how they spread; an interrupt keeps what is done.

    Parameters
    ----------
    case : Case
        Vehicle, rail and controller.
    scenario : Scenario
        The stop; its seed starts the sequence of seeds.
    plant : str
        With or without load transfer.
    runs : int
        Number of stops.
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
    bounds = () if nominal else _bounds(case, scenario)
    with progress_bar(f"{runs} stops with {case.controller.name}", runs) as tell:
        campaign = simulate_many(
            case.vehicle, case.controller, scenario, runs=runs, bounds=bounds, plant=plant, progress=tell
        )
    done = len(campaign.table)
    written = output if done else None
    if written is not None:
        write_table(written, campaign.table, force=force)
    summary = summarize(campaign, wanted=runs)
    if as_json:
        print_json(campaign_object(summary, case, scenario, start))
    elif done:
        _show(summary, case, scenario)
        if written is not None:
            console().print(f"Rows: {written}", markup=False, soft_wrap=True)
    if not campaign.complete:
        kept = f"; they are in {written}" if written is not None else ""
        print(f"wspd: interrupted after {done} of {runs} stops{kept}.", file=sys.stderr)
        raise typer.Exit(INTERRUPTED)


def _bounds(case: Case, scenario: Scenario) -> tuple[ParameterSet, ...]:
    """Parameter files to draw from; rails of single axles stay, or they would all become the same rail."""
    vehicle = load_entries("vehicle", case.vehicle_name)
    if scenario.axle_rails is not None:
        return (vehicle,)
    return vehicle, load_entries("rail", case.rail_name)


def _show(summary: Summary, case: Case, scenario: Scenario) -> None:
    out, campaign = console(), summary.campaign
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
    drawn = campaign.sampled
    out.print(
        f"Drawn evenly within their bounds: {', '.join(drawn)}." if drawn else "Drawn: seeds only.",
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
