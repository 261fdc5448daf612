"""``wspd ladder``: the same stop on every model of a vehicle."""

import math
from typing import TYPE_CHECKING

from wspd_design.cli import options
from wspd_design.cli.arguments import chosen, initial_speed
from wspd_design.cli.console import console, print_json, progress, spaced
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.stop_options import along_the_track, scenario
from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.reporting.tables import ColumnOf, build

if TYPE_CHECKING:
    from wspd_design.studies.ladder import Ladder
    from wspd_design.studies.rung import AxleFigures, Rung

_STOPS: "tuple[ColumnOf[Rung], ...]" = (
    ColumnOf(title="Model", read=lambda rung: rung.title),
    ColumnOf(title="d", unit="m", decimals=2, read=lambda rung: rung.metrics.distance),
    ColumnOf(title="t", unit="s", decimals=2, read=lambda rung: rung.metrics.stopping_time),
    ColumnOf(title="slip\nmean", decimals=3, read=lambda rung: rung.metrics.slip_mean),
    ColumnOf(title="slip\nmax", decimals=3, read=lambda rung: max(each.slip_max for each in rung.axles)),
    ColumnOf(title="lock", unit="s", decimals=2, read=lambda rung: rung.lock),
    ColumnOf(title="spread", unit="m", significant=2, read=lambda rung: rung.spread or math.nan),
    ColumnOf(title="steps", significant=1, read=lambda rung: rung.step_change),
)
_AXLES: "tuple[ColumnOf[tuple[Rung, int, AxleFigures]], ...]" = (
    ColumnOf(title="Model", read=lambda row: row[0].title if row[1] == 1 else ""),
    ColumnOf(title="axle", decimals=0, read=lambda row: float(row[1])),
    ColumnOf(title="slip\nmean", decimals=3, read=lambda row: row[2].slip_mean),
    ColumnOf(title="slip\nmax", decimals=3, read=lambda row: row[2].slip_max),
    ColumnOf(title="load", unit="kN", decimals=1, read=lambda row: row[2].braking_load / 1e3),
    ColumnOf(title="transfer", unit="%", decimals=1, read=lambda row: 100.0 * row[2].transfer),
    ColumnOf(title="spread", unit="%", decimals=1, read=lambda row: 100.0 * row[2].relative_spread),
    ColumnOf(title="vibration", unit="m/s", decimals=3, read=lambda row: row[2].vibration),
    ColumnOf(title="at", unit="Hz", decimals=1, read=lambda row: row[2].vibration_frequency),
)


@takes_records
def ladder(
    *,
    name: options.ControllerArgument = None,
    controller: options.ControllerOption = None,
    vehicle: options.VehicleOption = None,
    rail: options.RailOption = None,
    speed: options.SpeedOption = None,
    slip: options.SlipOption = None,
    sample_time: options.SampleTimeOption = None,
    sensors: SensorOptions,
    seed: options.SeedOption = 0,
    disturbances: StopOptions,
    as_json: options.JsonOption = False,
) -> None:
    """Simulate the same stop on every model of the vehicle, and tell which model suffices for what.

    The largest model is the yardstick. What is said holds for this stop; docs/models.md has more of them.
    """
    from wspd_design.cli.json_objects import ladder_object
    from wspd_design.studies.ladder import ladder as climb
    from wspd_design.studies.ladder import models_of

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
    with progress() as tell:
        found = climb(
            case.vehicle,
            case.controller,
            stop,
            slip_reference=case.specification.slip,
            models=models_of(case.vehicle),
            progress=tell,
        )
    if as_json:
        print_json(ladder_object(found, stop))
        return
    _show(found)


def _show(found: "Ladder") -> None:
    from wspd_design.reporting.ladder import agreements_table, sensitivity, sufficiency

    out = console()
    speed = f"{found.initial_speed * 3.6:g} km/h"
    out.print(
        f"{found.controller}: {found.vehicle} on {found.rail}, from {speed}", style="bold", markup=False
    )
    out.print(spaced(terminal_table(build(found.rungs, _STOPS, caption=""))))
    rows = [(rung, number, axle) for rung in found.rungs for number, axle in enumerate(rung.axles, start=1)]
    out.print(spaced(terminal_table(build(rows, _AXLES, caption=""))))
    out.print(
        "Slip and vibration above 10 km/h, loads of one wheel while the brake is built up: spread about a moving "
        "mean over 1 s; vibration: rim speed from 8 to 18 Hz, rms in the half second with most of it, and where its "
        "spectrum is highest; spread: of d, over starts that nobody can tell apart; steps: change of d with half the "
        "steps.",
        style="dim",
    )
    out.print(spaced(terminal_table(agreements_table(found))))
    out.print(
        f"What suffices here, beside {found.rungs[-1].title}: {sufficiency(found)}.{sensitivity(found)}",
        markup=False,
    )
    if found.remark:
        out.print(found.remark, style="yellow", markup=False)
