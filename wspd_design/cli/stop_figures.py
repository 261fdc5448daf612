"""The table of the figures of one stop."""

import math

from rich.text import Text

from wspd_design.cli.console import console, spaced, table
from wspd_design.design.industry import table_note
from wspd_design.reporting.stop_rows import stop_rows
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.description import disturbances_of, held_slip, rails_of
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.released import released_sentence
from wspd_design.simulation.runs import Ending
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
    for row in stop_rows(figures, about=held_slip(run, reference), check=made.check):
        shown.add_row(row.label, row.text, row.unit)
    out.print(spaced(shown))
    if figures.ideal_ending in NO_IDEAL_STOP:
        out.print(f"No ideal stop: {NO_IDEAL_STOP[figures.ideal_ending]}.", style="bold yellow")
    released = released_sentence([(run.controller, figures.released_below)])
    if released:
        out.print(released, style="yellow", markup=False)
    out.print(_trust(made.check))
    known = "" if math.isnan(figures.speed_error) else " The speed of the law is judged above 20 km/h."
    out.print(f"Slip figures count above 10 km/h.{known}", style="dim")


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
