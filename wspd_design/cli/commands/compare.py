"""``wspd compare``: the same stop with several controllers."""

from collections.abc import Callable

from rich.text import Text

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant
from wspd_design.cli.console import console, print_json, progress, spaced, table
from wspd_design.cli.json_objects import comparison_object, stop_object
from wspd_design.cli.stop_figures import CHAOTIC, number
from wspd_design.cli.stop_options import StopOptions, disturbances_of, rails_of, scenario
from wspd_design.controllers.family import FAMILIES
from wspd_design.design.case import CaseOptions, load_cases
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.records import Ending, Scenario

_ALL_COLUMNS = 78
"""Columns of a terminal from which on the table shows everything."""

_COLUMNS: tuple[tuple[str, Callable[[Metrics], str]], ...] = (
    ("d\n[m]", lambda figures: f"{figures.distance:.1f}"),
    ("t\n[s]", lambda figures: f"{figures.stopping_time:.2f}"),
    ("lag\n[s]", lambda figures: number(figures.lag, ".2f")),
    ("eff\n[%]", lambda figures: number(100.0 * figures.efficiency, ".0f")),
    ("slip\nrms", lambda figures: number(figures.slip_rms, ".3f")),
    ("slip\nmax", lambda figures: number(figures.slip_max, ".3f")),
    ("lock\n[s]", lambda figures: f"{figures.lock_time:.1f}"),
)
_MORE_COLUMNS: tuple[tuple[str, Callable[[Metrics], str]], ...] = (
    ("valve\n[-]", lambda figures: f"{figures.valve_switches}"),
    ("air\n[-]", lambda figures: f"{figures.vented_air:.1f}"),
    ("adh\n[%]", lambda figures: number(100.0 * figures.adhesion_utilization, ".0f")),
)


def compare(
    names: options.ControllersArgument = None,
    vehicle: options.VehicleOption = None,
    plant: options.PlantOption = options.PLANT,
    rail: options.RailOption = None,
    speed: options.SpeedOption = options.SPEED,
    slip: options.SlipOption = None,
    sample_time: options.SampleTimeOption = None,
    seed: options.SeedOption = 0,
    axle_rails: options.AxleRailsOption = None,
    patch: options.PatchOption = None,
    grade: options.GradeOption = None,
    pad_vibration: options.PadVibrationOption = False,
    speed_noise: options.SpeedNoiseOption = None,
    pulses: options.PulsesOption = None,
    reference_error: options.ReferenceErrorOption = None,
    dead_time: options.DeadTimeOption = None,
    as_json: options.JsonOption = False,
) -> None:
    """Simulate the same stop with several controllers, side by side.

    Where no option says otherwise, all take vehicle, rail, slip reference and sample time of the first design
    file among them.
    """
    check_plant(plant)
    wanted = CaseOptions(vehicle=vehicle, rail=rail, slip=slip, sample_time=sample_time)
    cases = load_cases(names or list(FAMILIES), wanted)
    stop = scenario(
        cases[0].rail,
        StopOptions(
            speed=speed,
            seed=seed,
            axle_rails=axle_rails,
            patches=patch,
            grade=grade,
            pad_vibration=pad_vibration,
            speed_noise=speed_noise,
            pulses=pulses,
            reference_error=reference_error,
            dead_time=dead_time,
        ),
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
        f"{first.run.vehicle} ({first.run.plant}) on {rails_of(scenario)}, "
        f"from {first.run.initial_speed * 3.6:g} km/h",
        style="bold",
        markup=False,
    )
    disturbances = disturbances_of(scenario)
    if disturbances:
        out.print(f"With {disturbances}.", markup=False)
    complete = out.width >= _ALL_COLUMNS
    columns = _COLUMNS + _MORE_COLUMNS * complete
    headers = [header for header, _ in columns]
    shown = table("Controller", *headers, numeric=tuple(headers))
    stopped = [made.metrics.distance for made in trials if made.run.ending is Ending.STOPPED]
    for made in trials:
        still_moving = made.run.ending is not Ending.STOPPED
        best = bool(stopped) and not still_moving and made.metrics.distance == min(stopped)
        shown.add_row(
            Text(made.run.controller + " *" * still_moving + " ~" * made.check.chaotic),
            *(cell(made.metrics) for _, cell in columns),
            style="bold" if best else "",
        )
    out.print(spaced(shown))
    bound = first.metrics.bound
    known = f" (bound {bound:.1f} m)" if bound == bound else ""
    more = (
        "; valve: changes of its state; air: brake cylinders vented; adh: adhesion used" if complete else ""
    )
    out.print(
        f"d distance, t time, lag 2 d/v0 - t, eff efficiency: bound over distance{known}; slip above 10 km/h, "
        f"rms about {_references(trials, references)}; lock: how long the wheels were locked{more}.",
        style="dim",
    )
    if len(stopped) < len(trials):
        out.print(f"* {Ending.TIME_LIMIT.value}.", style="yellow")
    spreads = [f"{made.run.controller} {made.check.spread:.2g} m" for made in trials if made.check.chaotic]
    if spreads:
        out.print(
            f"~ {CHAOTIC}. Spread of the distance over slightly different initial speeds: "
            f"{', '.join(spreads)}.",
            style="yellow",
            markup=False,
        )


def _references(trials: list[Trial], references: list[float]) -> str:
    """Say about which slip the rms of each law is: one for all, or the law's own."""
    if len(set(references)) == 1:
        return f"{references[0]:g}"
    own = (f"{made.run.controller} {slip:g}" for made, slip in zip(trials, references, strict=True))
    return f"the slip that each law holds ({', '.join(own)})"
