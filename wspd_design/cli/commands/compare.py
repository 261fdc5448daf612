"""``wspd compare``: the same stop with several controllers."""

from wspd_design.cli import options
from wspd_design.cli.case import Wishes, check_plant, parse_speed, resolve_all
from wspd_design.cli.console import console, print_json, progress, spaced, table
from wspd_design.cli.json_objects import comparison_object, stop_object
from wspd_design.design.catalog import CONTROLLERS
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.records import Ending, Scenario


def compare(
    names: options.ControllersArgument = None,
    vehicle: options.VehicleOption = None,
    plant: options.PlantOption = options.PLANT,
    rail: options.RailOption = None,
    speed: options.SpeedOption = options.SPEED,
    slip: options.SlipOption = None,
    sample_time: options.SampleTimeOption = None,
    seed: options.SeedOption = 0,
    as_json: options.JsonOption = False,
) -> None:
    """Simulate the same stop with several controllers, side by side.

    Where no option says otherwise, all take vehicle, rail, slip reference and sample time of the first design
    file among them.
    """
    check_plant(plant)
    wishes = Wishes(vehicle=vehicle, rail=rail, slip=slip, sample_time=sample_time)
    cases = resolve_all(names or list(CONTROLLERS), wishes)
    scenario = Scenario(rail=cases[0].rail, initial_speed=parse_speed(speed), seed=seed)
    trials: list[tuple[Trial, float]] = []
    with progress() as tell:
        for case in cases:
            tell(f"stop {len(trials) + 1} of {len(cases)}: {case.controller.name}")
            reference = case.specification.slip
            made = trial(case.vehicle, case.controller, scenario, slip_reference=reference, plant=plant)
            trials.append((made, reference))
    if as_json:
        print_json(
            comparison_object([stop_object(made, slip_reference=ref, seed=seed) for made, ref in trials])
        )
        return
    _show([made for made, _ in trials])


def _show(trials: list[Trial]) -> None:
    out, first = console(), trials[0].run
    out.print(
        f"{first.vehicle} ({first.plant}) on {first.rail}, from {first.initial_speed * 3.6:g} km/h",
        style="bold",
        markup=False,
    )
    headers = (
        "Controller",
        "d\n[m]",
        "t\n[s]",
        "lag\n[s]",
        "slip\nrms",
        "slip\nmax",
        "lock\n[s]",
        "valve\n[-]",
    )
    shown = table(*headers, numeric=headers[1:])
    stopped = [made.metrics.distance for made in trials if made.run.ending is Ending.STOPPED]
    for made in trials:
        figures, still_moving = made.metrics, made.run.ending is not Ending.STOPPED
        shown.add_row(
            made.run.controller + (" *" if still_moving else ""),
            f"{figures.distance:.1f}",
            f"{figures.stopping_time:.2f}",
            "-" if still_moving else f"{figures.lag:.2f}",
            f"{figures.slip_rms:.3f}",
            f"{figures.slip_max:.3f}",
            f"{figures.lock_time:.1f}",
            f"{figures.valve_switches}",
            style="bold" if stopped and not still_moving and figures.distance == min(stopped) else "",
        )
    out.print(spaced(shown))
    out.print(
        "d distance, t time, lag 2 d/v0 - t; slip above 10 km/h, rms about the reference; lock: how long the "
        "wheels were locked; valve: changes of its state.",
        style="dim",
    )
    if len(stopped) < len(trials):
        out.print(f"* {Ending.TIME_LIMIT.value}.", style="yellow")
