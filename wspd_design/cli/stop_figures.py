"""The table of the figures of one stop."""

import math

from rich.text import Text

from wspd_design.cli.console import console, spaced, table
from wspd_design.codegen.loop_numbers import DISTANCE_TOLERANCE
from wspd_design.design.industry import table_note
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.description import disturbances_of, held_slip, rails_of
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.records import Ending, Scenario
from wspd_design.simulation.released import released_sentence
from wspd_design.simulation.self_check import StepCheck

SENSITIVE = "sensitive: a change of the initial speed that nobody can measure moves the result"
UNRESOLVED = "unresolved: half of the shortest steps still change the stop"


def show_stop(made: Trial, scenario: Scenario, reference: float) -> None:
    """Print what became of a stop, and how far the numbers can be trusted."""
    run, figures = made.run, made.metrics
    stopped = run.ending is Ending.STOPPED
    out = console()
    out.print(
        f"{run.controller} on {rails_of(scenario)}, {run.train}, "
        f"from {run.initial_speed * 3.6:g} km/h, sample time {run.sample_time * 1e3:g} ms",
        style="bold",
        markup=False,
    )
    disturbances = disturbances_of(scenario)
    if disturbances:
        out.print(f"With {disturbances}.", markup=False)
    note = table_note([run.controller])
    if note:
        out.print(note, markup=False)
    out.print(f"Ending: {run.ending.value}.", style="" if stopped else "bold yellow")
    shown = table("Figure", "Value", "Unit", numeric=("Value",))
    shown.add_row("distance", f"{figures.distance:.1f}", "m")
    shown.add_row("ideal stop, best slip held", *_ideal_stop(figures))
    shown.add_row("efficiency, ideal stop over distance", number(100.0 * figures.efficiency, ".1f"), "%")
    shown.add_row("time", f"{figures.stopping_time:.2f}", "s")
    if figures.build_up == figures.build_up:
        shown.add_row("build-up of the brake, 90 % of its torque", f"{figures.build_up:.2f}", "s")
    shown.add_row("torque integral, all wheelsets", f"{figures.torque_integral / 1e3:.1f}", "kN m s")
    shown.add_row("adhesion utilization", number(100.0 * figures.adhesion_utilization, ".1f"), "%")
    shown.add_row(f"slip rms about {held_slip(run, reference)}", number(figures.slip_rms, ".3f"), "-")
    shown.add_row("the same once it is reached", number(figures.held_slip_rms, ".3f"), "-")
    shown.add_row("the same of a perfect law", number(figures.perfect_slip_rms, ".3f"), "-")
    shown.add_row("slip overshoot, once reached", number(figures.slip_overshoot, ".3f"), "-")
    shown.add_row("slip undershoot, likewise", number(figures.slip_undershoot, ".3f"), "-")
    shown.add_row("slip mean", number(figures.slip_mean, ".3f"), "-")
    shown.add_row("slip maximum", number(figures.slip_max, ".3f"), "-")
    for row in _of_law(figures):
        shown.add_row(*row)
    shown.add_row("wheels locked", f"{figures.lock_time:.2f}", "s")
    shown.add_row("longest lock above 10 km/h", f"{figures.judged_lock:.2f}", "s")
    shown.add_row("vented air per wheelset", f"{figures.vented_air:.2f}", "cylinders")
    for row in _of_brake(figures):
        shown.add_row(*row)
    shown.add_row("valve switches per wheelset", f"{figures.valve_switches}", "")
    shown.add_row("samples at a limit", number(100.0 * figures.saturated_share, ".0f"), "%")
    shown.add_row("momentum balance, relative", f"{figures.momentum_residual:.1e}", "-")
    shown.add_row("energy balance, relative", f"{figures.energy_residual:.1e}", "-")
    shown.add_row("step check, distance, relative", f"{made.check.distance:.1e}", "-")
    shown.add_row("step check, slip", f"{made.check.slip:.1e}", "-")
    out.print(spaced(shown))
    if figures.ideal_ending in NO_IDEAL_STOP:
        out.print(f"No ideal stop: {NO_IDEAL_STOP[figures.ideal_ending]}.", style="bold yellow")
    released = released_sentence([(run.controller, figures.released_below)])
    if released:
        out.print(released, style="yellow", markup=False)
    out.print(_trust(made.check))
    known = "" if math.isnan(figures.speed_error) else " The speed of the law is judged above 20 km/h."
    out.print(f"Slip figures count above 10 km/h.{known}", style="dim")


def _of_brake(figures: Metrics) -> list[tuple[str, str, str]]:
    """Rows of what only some brakes have: volumes, and watchdogs."""
    rows = []
    if not math.isnan(figures.air_used):
        rows.append(("air from the reservoir, all wheelsets", f"{figures.air_used:.0f}", "normal litres"))
    if not math.isnan(figures.lowest_reservoir):
        rows.append(("lowest reservoir pressure", f"{figures.lowest_reservoir / 1e5:.2f}", "bar"))
    if figures.watchdog_fills is not None:
        rows.append(("fillings by a watchdog", f"{figures.watchdog_fills}", ""))
    return rows


def _of_law(figures: Metrics) -> list[tuple[str, str, str]]:
    """Rows of what only some laws tell: the slip that they hold, and the train speed that they go by."""
    rows = []
    if not math.isnan(figures.slip_band):
        rows.append(("slip off the law's own reference, once reached", f"{figures.slip_band:.3f}", "-"))
    if not math.isnan(figures.speed_error):
        base, share = DISTANCE_TOLERANCE
        rows.append(("speed of the law, largest error", f"{100.0 * figures.speed_error:.1f}", "%"))
        rows.append(
            (
                f"its distance, error over {base:g} m + {100.0 * share:g} %",
                f"{figures.distance_error:.2f}",
                "-",
            )
        )
    return rows


def _ideal_stop(figures: Metrics) -> tuple[str, str]:
    """Return the distance of the ideal stop and its unit; a word for a train that cannot stop."""
    if figures.ideal_ending in NO_IDEAL_STOP:
        return "none", ""
    return number(figures.ideal_stop, ".1f"), "m"


def number(value: float, form: str) -> str:
    """Format a number; one that does not exist is a dash."""
    return "-" if value != value else format(value, form)


def _trust(check: StepCheck) -> Text:
    """Say what the step check means."""
    said = Text()
    if check.sensitive:
        said.append(
            f"This stop is {SENSITIVE}. Over slightly different initial speeds the distance spreads by "
            f"{check.spread:.2g} m. ",
            style="yellow",
        )
    if check.unresolved:
        return said.append(f"This stop is {UNRESOLVED}.", style="yellow")
    divided = f", divided by {check.refinement}," if check.refinement > 1 else ""
    return said.append(f"The steps{divided} are short enough: half of them give the same stop.", style="dim")
