"""What ``design`` and ``tune`` share: a search with its progress, its files and what the terminal shows of it."""

import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from rich.text import Text

from wspd_design.cli.campaign import interrupted
from wspd_design.cli.console import console, print_written, progress_bar, spaced, table
from wspd_design.cli.output import check_output, write_text
from wspd_design.design.criteria import CRITERIA
from wspd_design.design.file import seen_from, write_design
from wspd_design.design.records import Design
from wspd_design.design.requirements import Judged, Limit
from wspd_design.design.specification_file import Task, shipped_specifications
from wspd_design.exchange.plain import finite
from wspd_design.parameters.units import units_of

SPECIFICATIONS = f"{', '.join(shipped_specifications())} or a .toml file (docs/design-to-requirements.md)"


def search_and_write(
    task: Task, start: Design, name: str, output: Path, *, limits: tuple[Limit, ...], force: bool
) -> bool:
    """Search a design, write it and the record of the search, and show what was reached.

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
    limits : tuple of Limit
        That the search has to keep.
    force : bool
        Whether existing files may be replaced.

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
            f"{total} evaluations of {start.law} on {task.effort.sets.sets} sets", total
        ) as tell:
            found = find(task, start, name, limits=limits, journal=journal, progress=count, told=_say)
    except KeyboardInterrupt:
        raise interrupted(
            f"{done} of {total} evaluations; they are in {journal}, and the same command goes on from there"
        ) from None
    made = replace(
        found.design,
        vehicle_file=seen_from(output, task.vehicle),
        rail_file=seen_from(output, task.design_rail),
        requirements=replace(
            task.requirements,
            rails=tuple(seen_from(output, rail) or rail for rail in task.requirements.rails),
        ),
    )
    write_text(record, json.dumps(finite(search_object(found)), ensure_ascii=False) + "\n", force=True)
    write_design(made, output)
    journal.unlink(missing_ok=True)
    out = console()
    out.print(made.name, style="bold", markup=False)
    out.print(f"Chosen: {found.reason}.", markup=False)
    held_out = task.requirements.held_out
    out.print(
        f"On {held_out.sets} held-out sets of seed {held_out.seed}, looked at once "
        f"({', '.join(task.requirements.rails)}):",
        markup=False,
    )
    _show_judged(found.judged, found.held_out_start.reached)
    for check in found.unproved:
        out.print(f"Not proved: {check}.", style="bold yellow", markup=False)
    print_written(
        output,
        ("Try it", ("simulate", output)),
        ("Show it", ("report", output, "-o", output.with_suffix(".html"))),
    )
    out.print(f"Record of the search: {record}", markup=False, soft_wrap=True)
    return not found.unproved and all(each.met is not False for each in found.judged)


def _show_judged(judged: Sequence[Judged], before: Mapping[str, float]) -> None:
    shown = table("Criterion", "Limit", "Reached", "Start", "", numeric=("Limit", "Reached", "Start"))
    for each in judged:
        rule = CRITERIA[each.requirement]
        verdict = "" if each.met is None else ("met" if each.met else "missed")
        shown.add_row(
            Text(each.title),
            ""
            if each.limit is None
            else f"{'>=' if rule.at_least else '<='} {_told(each.requirement, each.limit)}",
            _told(each.requirement, each.reached),
            _told(each.requirement, before.get(each.requirement)),
            Text(verdict, style="" if each.met is not False else "bold yellow"),
        )
    console().print(spaced(shown))


def _told(criterion: str, value: float | None) -> str:
    """Write a number of a criterion as people read it."""
    if value is None:
        return "-"
    dimension = CRITERIA[criterion].dimension
    if criterion == "vented_air":
        return f"{value:.2f}"
    if dimension == "ratio":
        return f"{100.0 * value:.1f} %" if criterion != "distance_error" else f"{value:.2f}"
    return f"{value:.3g} {units_of(dimension)[0]}"


def _say(sentence: str) -> None:
    print(f"wspd: {sentence}.", file=sys.stderr)
