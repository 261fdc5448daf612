"""``wspd simulate``: one stop and its figures."""

from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.case import Case, Wishes, check_plant, chosen, parse_speed, resolve
from wspd_design.cli.console import console, print_json, progress, spaced, table
from wspd_design.cli.json_objects import stop_object
from wspd_design.cli.output import check_output, write_text
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.records import Ending, Run, Scenario


def simulate(
    name: options.ControllerArgument = None,
    controller: options.ControllerOption = None,
    vehicle: options.VehicleOption = None,
    plant: options.PlantOption = options.PLANT,
    rail: options.RailOption = None,
    speed: options.SpeedOption = options.SPEED,
    slip: options.SlipOption = None,
    sample_time: options.SampleTimeOption = None,
    seed: options.SeedOption = 0,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Write the traces as CSV.")
    ] = None,
    force: options.ForceOption = False,
    as_json: options.JsonOption = False,
) -> None:
    """Simulate one stop and show its figures.

    A train that does not stop is no error: the ending says so, and the exit code is 0.
    """
    check_plant(plant)
    if output is not None:
        check_output(output, force=force)
    case = resolve(
        chosen(name, controller), Wishes(vehicle=vehicle, rail=rail, slip=slip, sample_time=sample_time)
    )
    scenario = Scenario(rail=case.rail, initial_speed=parse_speed(speed), seed=seed)
    reference = case.specification.slip
    with progress() as tell:
        tell(f"stop with {case.controller.name}")
        made = trial(case.vehicle, case.controller, scenario, slip_reference=reference, plant=plant)
    if output is not None:
        write_text(output, trace_csv(made.run), force=force)
    if as_json:
        print_json(stop_object(made, slip_reference=reference, seed=seed))
        return
    _show(case, made)
    if output is not None:
        console().print(f"Traces: {output}", markup=False)


def trace_csv(run: Run) -> str:
    """Return the traces of a stop as CSV, one line per record, columns named with their unit."""
    import io

    import numpy as np

    wheelsets = range(1, run.slip.shape[1] + 1)
    names = ["time_s", "speed_m_s", "distance_m"]
    names += [f"{n}_{i}" for n in ("wheel_speed_rad_s", "slip", "torque_N_m") for i in wheelsets]
    columns = np.column_stack((run.time, run.speed, run.distance, run.wheel_speed, run.slip, run.torque))
    text = io.StringIO()
    np.savetxt(text, columns, fmt="%.9g", delimiter=",", header=",".join(names), comments="")
    return text.getvalue()


def _show(case: Case, made: Trial) -> None:
    run, figures, reference = made.run, made.metrics, case.specification.slip
    stopped = run.ending is Ending.STOPPED
    out = console()
    out.print(
        f"{run.controller} on {run.rail}, {run.vehicle} ({run.plant}), "
        f"from {run.initial_speed * 3.6:g} km/h, sample time {run.sample_time * 1e3:g} ms",
        style="bold",
        markup=False,
    )
    out.print(f"Ending: {run.ending.value}.", style="" if stopped else "bold yellow")
    shown = table("Figure", "Value", "Unit", numeric=("Value",))
    shown.add_row("distance", f"{figures.distance:.1f}", "m")
    shown.add_row("time", f"{figures.stopping_time:.2f}", "s")
    if stopped:
        shown.add_row("lag of the brake build-up", f"{figures.lag:.2f}", "s")
        shown.add_row("deceleration after it", f"{figures.plateau:.3f}", "m/s^2")
    shown.add_row("torque integral, all wheelsets", f"{figures.torque_integral / 1e3:.1f}", "kN m s")
    shown.add_row(f"slip rms about {reference:g}", f"{figures.slip_rms:.3f}", "-")
    shown.add_row("slip mean", f"{figures.slip_mean:.3f}", "-")
    shown.add_row("slip maximum", f"{figures.slip_max:.3f}", "-")
    shown.add_row("wheels locked", f"{figures.lock_time:.2f}", "s")
    shown.add_row("valve switches", f"{figures.valve_switches}", "")
    shown.add_row("samples at a limit", f"{100.0 * figures.saturated_share:.0f}", "%")
    shown.add_row("momentum balance, relative", f"{figures.momentum_residual:.1e}", "-")
    shown.add_row("energy balance, relative", f"{figures.energy_residual:.1e}", "-")
    out.print(spaced(shown))
    out.print("Slip figures count above 10 km/h.", style="dim")
