"""``wspd compare``: the same stop with several controllers."""

import math

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant, initial_speed
from wspd_design.cli.console import console, print_json, progress, spaced
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.json_objects import comparison_object
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.stop_figures import SENSITIVE, UNRESOLVED
from wspd_design.cli.stop_options import along_the_track, scenario
from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.codegen.loop_numbers import DISTANCE_TOLERANCE
from wspd_design.controllers.family import FAMILIES
from wspd_design.design.case import CaseOptions, load_cases
from wspd_design.design.industry import table_note
from wspd_design.exchange.objects import stop_object
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.description import disturbances_of, held_slip, rails_of
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.released import released_sentence
from wspd_design.simulation.runs import Ending

_ALL_COLUMNS = 78
"""Columns of a terminal from which on the table shows everything."""

_COLUMNS: tuple[ColumnOf[Trial], ...] = (
    ColumnOf(title="d", unit="m", decimals=1, read=lambda made: made.metrics.distance),
    ColumnOf(title="t", unit="s", decimals=2, read=lambda made: made.metrics.stopping_time),
    ColumnOf(title="lag", unit="s", decimals=2, read=lambda made: made.metrics.lag),
    ColumnOf(title="eff", unit="%", decimals=0, read=lambda made: 100.0 * made.metrics.efficiency),
    ColumnOf(title="slip\nrms", decimals=3, read=lambda made: made.metrics.slip_rms),
    ColumnOf(title="slip\nmax", decimals=3, read=lambda made: made.metrics.slip_max),
    ColumnOf(title="lock", unit="s", decimals=1, read=lambda made: made.metrics.lock_time),
)
_MORE_COLUMNS: tuple[ColumnOf[Trial], ...] = (
    ColumnOf(title="valve", unit="-", decimals=0, read=lambda made: made.metrics.valve_switches),
    ColumnOf(title="air", unit="-", decimals=1, read=lambda made: made.metrics.vented_air),
    ColumnOf(title="adh", unit="%", decimals=0, read=lambda made: 100.0 * made.metrics.adhesion_utilization),
)


@takes_records
def compare(
    *,
    names: options.ControllersArgument = None,
    vehicle: options.VehicleOption = None,
    plant: options.PlantOption = options.PLANT,
    rail: options.RailOption = None,
    speed: options.SpeedOption = None,
    slip: options.SlipOption = None,
    sample_time: options.SampleTimeOption = None,
    sensors: SensorOptions,
    seed: options.SeedOption = 0,
    disturbances: StopOptions,
    as_json: options.JsonOption = False,
) -> None:
    """Simulate the same stop with several controllers, side by side.

    Where no option says otherwise, all take vehicle, rail, slip reference and sample time of the first design
    file among them.
    """
    check_plant(plant)
    rail, disturbances = along_the_track(rail, disturbances)
    wanted = CaseOptions(
        vehicle=vehicle, rail=rail, slip=slip, sample_time=sample_time, sensors=sensors.words
    )
    cases = load_cases(names or list(FAMILIES), wanted)
    stop = scenario(
        cases[0].rail,
        disturbances,
        initial_speed=initial_speed(speed, cases[0].specification),
        seed=seed,
        vehicle=cases[0].vehicle,
    )
    trials: list[tuple[Trial, float]] = []
    with progress() as tell:
        for case in cases:
            tell(f"stop {len(trials) + 1} of {len(cases)}: {case.controller.name}")
            reference = case.specification.slip
            made = trial(case.vehicle, case.controller, stop, slip_reference=reference, plant=plant)
            trials.append((made, reference))
    if as_json:
        print_json(comparison_object([stop_object(made, stop, slip_reference=ref) for made, ref in trials]))
        return
    _show([made for made, _ in trials], stop, [reference for _, reference in trials])


def _show(trials: list[Trial], scenario: Scenario, references: list[float]) -> None:
    out, first = console(), trials[0]
    out.print(
        f"{first.run.train} on {rails_of(scenario)}, from {first.run.initial_speed * 3.6:g} km/h",
        style="bold",
        markup=False,
    )
    disturbances = disturbances_of(scenario)
    if disturbances:
        out.print(f"With {disturbances}.", markup=False)
    complete = out.width >= _ALL_COLUMNS
    stopped = [made.metrics.distance for made in trials if made.run.ending is Ending.STOPPED]
    shown = build(
        trials,
        (ColumnOf(title="Controller", read=_marked), *_COLUMNS, *(_MORE_COLUMNS * complete)),
        caption="",
    )
    styles = ["bold" if stopped and _is_best(made, min(stopped)) else "" for made in trials]
    out.print(spaced(terminal_table(shown, styles=styles)))
    ideal = first.metrics.ideal_stop
    known = f" ({ideal:.1f} m, best slip held)" if ideal == ideal else ""
    more = (
        "; valve: changes of its state; air: brake cylinders vented; adh: adhesion used" if complete else ""
    )
    out.print(
        f"d distance, t time, lag 2 d/v0 - t, eff efficiency: ideal stop{known} over distance; slip above 10 km/h, "
        f"rms about {_references(trials, references)}; lock: how long the wheels were locked{more}.",
        style="dim",
    )
    for made in trials:
        if not math.isnan(made.metrics.speed_error):
            out.print(_told(made), style="dim", markup=False)
    note = table_note(made.run.controller for made in trials)
    if note:
        out.print(note, style="dim", markup=False)
    if first.metrics.ideal_ending in NO_IDEAL_STOP:
        out.print(f"No ideal stop: {NO_IDEAL_STOP[first.metrics.ideal_ending]}.", style="bold yellow")
    if len(stopped) < len(trials):
        (ending, *_) = {made.run.ending for made in trials if made.run.ending is not Ending.STOPPED}
        out.print(f"* {ending.value}.", style="yellow")
    released = released_sentence((made.run.controller, made.metrics.released_below) for made in trials)
    if released:
        out.print(released, style="yellow", markup=False)
    spreads = [f"{made.run.controller} {made.check.spread:.2g} m" for made in trials if made.check.sensitive]
    if spreads:
        out.print(
            f"~ {SENSITIVE}. Spread of the distance over slightly different initial speeds: "
            f"{', '.join(spreads)}.",
            style="yellow",
            markup=False,
        )
    if any(made.check.unresolved for made in trials):
        out.print(f"? {UNRESOLVED}.", style="yellow")


def _told(made: Trial) -> str:
    """Say how well a law knows the train speed."""
    base, share = DISTANCE_TOLERANCE
    return (
        f"{made.run.controller} estimates the train speed: wrong by at most {100.0 * made.metrics.speed_error:.1f} % "
        f"above 20 km/h, its distance by {made.metrics.distance_error:.2f} of {base:g} m + {100.0 * share:g} %."
    )


def _references(trials: list[Trial], references: list[float]) -> str:
    """Say about which slip the rms of each law is: one for all, or the law's own."""
    held = [held_slip(made.run, slip) for made, slip in zip(trials, references, strict=True)]
    if len(set(held)) == 1:
        return held[0]
    own = (f"{made.run.controller} {slip}" for made, slip in zip(trials, held, strict=True))
    return f"the slip that each law holds ({', '.join(own)})"


def _marked(made: Trial) -> str:
    """Return the name of a controller with the marks of a stop that did not end, is sensitive or unresolved."""
    marks = " *" * (made.run.ending is not Ending.STOPPED) + " ~" * made.check.sensitive
    return made.run.controller + marks + " ?" * made.check.unresolved


def _is_best(made: Trial, shortest: float) -> bool:
    return made.run.ending is Ending.STOPPED and made.metrics.distance == shortest
