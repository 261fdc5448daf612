"""What ``design`` and ``tune`` share: a search with its progress, its files and what the terminal shows of it."""

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from wspd_design.cli.console import console, interrupted, print_written, progress_bar, spaced, table
from wspd_design.cli.output import check_output, write_text
from wspd_design.design.criteria import CRITERIA
from wspd_design.design.file import seen_from, write_design
from wspd_design.design.records import Design
from wspd_design.design.requirements import Judged
from wspd_design.design.search.run import Space
from wspd_design.design.specification_file import Task, shipped_specifications
from wspd_design.exchange.plain import finite
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.units import units_of

if TYPE_CHECKING:
    from wspd_design.design.finding import Found

SPECIFICATIONS = f"{', '.join(shipped_specifications())} or a .toml file (wspd docs design-to-requirements)"

_BY_RAIL = {
    "mean eff.": "efficiency_mean",
    "worst eff.": "efficiency_worst",
    "lock": "longest_lock",
    "switches": "valve_switches",
}


def search_design(task: Task, start: Design, name: str, output: Path, *, keep: bool, force: bool) -> bool:
    """Search a design and write it.

    Parameters
    ----------
    task : Task
        Requirements, stops and effort.
    start : Design
        Where the search starts.
    name : str
        Of the design that is found.
    output : Path
        Design file; record and journal stand beside it.
    keep : bool
        Whether the search has to keep the limits of the task, or the distance alone counts.
    force : bool
        Whether existing files may be replaced.

    Returns
    -------
    bool
        Whether all requirements are met on the held-out sets.
    """
    from wspd_design.design.finding import explained, space_of

    def write(found: "Found") -> None:
        write_design(to_the_files(explained(found, start, name), task, output), output)

    space = space_of(start, load_vehicle(task.vehicle), load_rail(task.design_rail))
    return search_and_write(task, space, name, output, write, keep=keep, force=force, controller=str(output))


def to_the_files(made: Design, task: Task, output: Path) -> Design:
    """Return a design with the requirements of its task, files as they are seen from the folder of the design."""
    wanted = task.requirements
    return replace(
        made,
        vehicle_file=seen_from(output, task.vehicle),
        rail_file=seen_from(output, task.design_rail),
        requirements=replace(
            wanted,
            rails=tuple(seen_from(output, rail) or rail for rail in wanted.rails),
            stable_within=tuple(
                (seen_from(output, rail) or rail, share) for rail, share in wanted.stable_within
            ),
        ),
    )


def search_and_write(
    task: Task,
    space: Space,
    name: str,
    output: Path,
    write: "Callable[[Found], object]",
    *,
    keep: bool,
    force: bool,
    controller: str,
) -> bool:
    """Search, write the record and what was found, and show what was reached.

    Parameters
    ----------
    task, name, output, keep, force
        As of :func:`search_design`.
    space : Space
        What is searched.
    write : callable
        Writes the output.
    controller : str
        What other commands take it by.

    Returns
    -------
    bool
        Whether all requirements are met on the held-out sets.
    """
    from wspd_design.design.finding import find
    from wspd_design.exchange.search_objects import search_object

    record, journal = output.with_suffix(".search.json"), output.with_suffix(".search.journal")
    check_output(record, force=force)
    done = 0

    def count(finished: int) -> None:
        nonlocal done
        done = finished
        tell(finished)

    total = task.effort.evaluations
    try:
        with progress_bar(
            f"{total} evaluations of {space.law} on {task.effort.sets.sets} sets", total
        ) as tell:
            found = find(task, space, keep=keep, journal=journal, progress=count, told=_say)
    except KeyboardInterrupt:
        raise interrupted(
            f"{done} of {total} evaluations; they are in {journal}, and the same command goes on from there"
        ) from None
    write_text(record, json.dumps(finite(search_object(found, name)), ensure_ascii=False) + "\n", force=True)
    write(found)
    journal.unlink(missing_ok=True)
    _show(found, name)
    print_written(
        output,
        ("Try it", ("simulate", controller)),
        ("Show it", ("report", controller, "-o", output.with_suffix(".html"))),
    )
    console().print(f"Record of the search: {record}", markup=False, soft_wrap=True)
    return not found.unproved and all(each.met is not False for each in found.judged)


def _show(found: "Found", name: str) -> None:
    out, wanted = console(), found.task.requirements
    out.print(name, style="bold", markup=False)
    out.print(f"Chosen: {found.reason}.", markup=False)
    out.print(
        f"On {wanted.held_out.sets} held-out sets of seed {wanted.held_out.seed}, looked at once "
        f"({', '.join(wanted.rails)}):",
        markup=False,
    )
    _show_judged(found.judged, found.held_out_start.reached)
    by_rail = table("Rail", *_BY_RAIL, numeric=tuple(_BY_RAIL))
    for rail, each in found.held_out_by_rail.items():
        by_rail.add_row(Text(rail), *(_told(name, each.reached[name]) for name in _BY_RAIL.values()))
    out.print(spaced(by_rail))
    for check in found.unproved:
        out.print(f"Not proved: {check}.", style="bold yellow", markup=False)


def _show_judged(judged: Sequence[Judged], before: Mapping[str, float]) -> None:
    shown = table("Criterion", "Limit", "Reached", "Start", "", numeric=("Limit", "Reached", "Start"))
    for each in judged:
        rule = CRITERIA.get(each.requirement)
        sign = "<" if rule is None else (">=" if rule.at_least else "<=")
        verdict = "" if each.met is None else ("met" if each.met else "missed")
        shown.add_row(
            Text(each.title),
            "" if each.limit is None else f"{sign} {_told(each.requirement, each.limit)}",
            _told(each.requirement, each.reached),
            _told(each.requirement, before.get(each.requirement)),
            Text(verdict, style="" if each.met is not False else "bold yellow"),
        )
    console().print(spaced(shown))


def _told(criterion: str, value: float | None) -> str:
    """Write a number of a criterion as people read it."""
    if value is None:
        return "-"
    if criterion not in CRITERIA:
        return f"{value:.4f}"
    dimension = CRITERIA[criterion].dimension
    if criterion in ("vented_air", "distance_error"):
        return f"{value:.2f}"
    if dimension == "ratio":
        return f"{100.0 * value:.1f} %"
    return f"{value:.3g} {units_of(dimension)[0]}"


def _say(sentence: str) -> None:
    print(f"wspd: {sentence}.", file=sys.stderr)
