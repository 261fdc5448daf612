"""``wspd simulate``: one stop and its figures, or many and their spread."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant, chosen, initial_speed
from wspd_design.cli.campaign import Extent, simulate_runs
from wspd_design.cli.console import console, print_json, progress
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.drawn_run import drawn_run, show_drawn
from wspd_design.cli.from_witness import LEFT, check_words, read, show_leaving, show_start, witness_start
from wspd_design.cli.json_objects import witness_object
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.stop_figures import show_stop
from wspd_design.cli.stop_options import along_the_track, scenario
from wspd_design.cli.tables import check_table, write_table
from wspd_design.design.case import Case, CaseOptions, load_case
from wspd_design.exchange.objects import stop_object
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.fingerprint import fingerprint
from wspd_design.parameters.units import parse_quantity
from wspd_design.simulation.campaign import CHECK_EVERY
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.start import leaving_time
from wspd_design.simulation.traces import check_interval, traces_of

_MANY = "Many stops"


@takes_records
def simulate(
    *,
    name: options.ControllerArgument = None,
    controller: options.ControllerOption = None,
    vehicle: options.VehicleOption = None,
    plant: options.StopPlantOption = None,
    rail: options.RailOption = None,
    speed: options.StopSpeedOption = None,
    from_witness: options.FromWitnessOption = None,
    slip: options.SlipOption = None,
    sample_time: options.SampleTimeOption = None,
    sensors: SensorOptions,
    seed: options.SeedOption = 0,
    disturbances: StopOptions,
    runs: Annotated[
        int | None,
        typer.Option(
            "--runs",
            min=1,
            metavar="NUMBER",
            help="Simulate so many stops with other seeds and with parameters drawn from their bounds.",
            show_default=False,
            rich_help_panel=_MANY,
        ),
    ] = None,
    only_run: Annotated[
        int | None,
        typer.Option(
            "--only-run",
            min=0,
            metavar="NUMBER",
            help="Simulate this one of the stops that --runs simulates, alone: the run of its table, from 0 on.",
            show_default=False,
            rich_help_panel=_MANY,
        ),
    ] = None,
    nominal: Annotated[
        bool,
        typer.Option(
            "--nominal",
            help="Draw seeds only; vehicle and rail stay.",
            show_default=False,
            rich_help_panel=_MANY,
        ),
    ] = False,
    store: Annotated[
        Path | None,
        typer.Option(
            "--store",
            metavar="FOLDER",
            help="With --runs: keep finished chunks, so that the same command goes on after an interrupt.",
            show_default=False,
            rich_help_panel=_MANY,
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help="Write the traces, or one row a stop, to .csv, .parquet or .mat.",
            show_default=False,
        ),
    ] = None,
    every: Annotated[
        str | None,
        typer.Option(
            "--every",
            metavar="TIME",
            help='With --output: a row of the traces at each multiple of this time, such as "10 ms"; default all rows.',
            show_default=False,
        ),
    ] = None,
    force: options.ForceOption = False,
    as_json: options.JsonOption = False,
) -> None:
    """Simulate one stop and show its figures, or many with --runs and show their spread.

    A train that does not stop is not an error: the ending says so, and the exit code is 0.
    """
    if plant is None:
        plant = options.PLANT if from_witness is None else options.QUARTER
    check_plant(plant)
    if output is not None:
        check_table(output, force=force)
    if nominal and runs is None:
        raise UserError("--nominal is about many stops; add --runs, for example --runs 1000")
    if store is not None and runs is None:
        raise UserError("--store keeps many stops; add --runs, for example --runs 1000")
    if only_run is not None and (runs is not None or from_witness is not None):
        other = "--runs" if runs is not None else "--from-witness"
        raise UserError(f"--only-run is one stop with drawn numbers; leave {other} out")
    interval = _interval(every, traces_wanted=output is not None and runs is None)
    witness = None
    if from_witness is not None:
        draws = runs is not None and not nominal
        check_words(
            named=bool(name or controller), speed=speed, axle_rails=disturbances.axle_rails, draws=draws
        )
        witness = read(from_witness)
    rail, disturbances = along_the_track(rail, disturbances)
    case = load_case(
        chosen(name, controller),
        CaseOptions(vehicle=vehicle, rail=rail, slip=slip, sample_time=sample_time, sensors=sensors.words),
    )
    stop = scenario(
        case.rail,
        disturbances,
        initial_speed=initial_speed(speed, case.specification),
        seed=seed,
        vehicle=case.vehicle,
    )
    start = None
    if witness is not None:
        start = witness_start(case, stop, witness)
        case = replace(case, vehicle=start.vehicle, rail=start.rail, controller=start.controller)
        stop = start.scenario
        if not as_json:
            show_start(start)
    if runs is not None:
        simulate_runs(
            case,
            stop,
            Extent(plant=plant, first=0, count=runs, check_every=CHECK_EVERY, store=store),
            nominal=nominal,
            output=output,
            force=force,
            as_json=as_json,
            start=start,
        )
        return
    drawn: dict[str, float] | None = None
    if only_run is not None:
        case, stop, drawn = drawn_run(case, stop, only_run, plant=plant)
        if not as_json:
            show_drawn(case, drawn, only_run)
    reference = case.specification.slip
    with progress() as tell:
        tell(f"stop with {case.controller.name}")
        made = trial(case.vehicle, case.controller, stop, slip_reference=reference, plant=plant)
    if output is not None:
        taken = traces_of(made.run, every=interval)
        write_table(output, [taken.table], force=force, about=_about(taken.about, case))
    if as_json:
        named = None if start is None else witness_object(start, leaving_time(made.run, LEFT))
        print_json(stop_object(made, stop, slip_reference=reference, witness=named, drawn=drawn))
        return
    show_stop(made, stop, reference)
    if start is not None:
        show_leaving(made.run)
    if output is not None:
        console().print(f"Traces: {output}", markup=False, soft_wrap=True)


def _interval(every: str | None, *, traces_wanted: bool) -> float | None:
    """Read the interval of the traces [s]; None for the recorded times."""
    if every is None:
        return None
    if not traces_wanted:
        raise UserError(
            "--every is about the traces of one stop in a file; add -o FILE.csv and leave out --runs"
        )
    interval = parse_quantity(every, "time", what="--every")
    check_interval(interval)
    return interval


def _about(traces: dict[str, str], case: Case) -> dict[str, str]:
    """Say what was simulated, with the design if there is one."""
    design = case.design
    if design is None:
        return traces
    return {**traces, "design": design.name, "design_hash": fingerprint(design)}
