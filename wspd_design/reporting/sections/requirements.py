"""What the design must reach, what it reaches on stops that no search has seen, and the effort behind it."""

from wspd_design.design.criteria import CRITERIA
from wspd_design.design.requirements import Judged
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Cell, Heading, Paragraph, Status
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import escape, rich
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.judgment import Judgment

REQUIREMENTS = "requirements"
"""Anchor of the section."""

_UNITS = {
    "efficiency_mean": "%",
    "efficiency_p05": "%",
    "efficiency_worst": "%",
    "stopping_distance": "m",
    "longest_lock": "s",
    "valve_switches": "1/s",
    "speed_error_p95": "%",
    "speed_error": "%",
}
"""In which criteria are told; all others are ratios and counts."""


def requirements(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the requirements; nothing for a design that was made without."""
    judgment = dossier.judgment
    if judgment is None:
        return ()
    return (
        Heading(text="Requirements", anchor=REQUIREMENTS),
        Paragraph(text=rich(_stops(judgment))),
        build(
            judgment.judged,
            (
                ColumnOf(title="Requirement", read=lambda each: each.title),
                ColumnOf(title="Limit", flush_right=True, read=_limit),
                ColumnOf(title="Reached", flush_right=True, read=lambda each: quantity(each, each.reached)),
                ColumnOf(title="Finding", read=_finding),
            ),
            caption=f"What this design must reach, and what it reaches on {stops_of(judgment)}. Without a limit: told, "
            "not required.",
            anchor="requirements-table",
        ),
    )


def stops_of(judgment: Judgment) -> str:
    """Name the stops that a design is judged by."""
    held_out = judgment.requirements.held_out
    return f"{numbers.count(held_out.sets, 'stop')} that no search has seen, seed {held_out.seed}"


def quantity(judged: Judged, value: float | None) -> str:
    """Write a number of a criterion in the unit in which people tell it."""
    if value is None:
        return numbers.NONE
    unit = _UNITS.get(judged.requirement, "-")
    return numbers.quantity(100.0 * value if unit == "%" else value, unit, 3)


def _limit(judged: Judged) -> str:
    rule = CRITERIA.get(judged.requirement)
    if judged.limit is None:
        return "proved" if rule is None else numbers.NONE  # a certificate has no number
    if rule is None:
        return f"< {quantity(judged, judged.limit)}"
    return f"{'≥' if rule.at_least else '≤'} {quantity(judged, judged.limit)}"


def _finding(judged: Judged) -> Cell | str:
    if judged.met is None:
        return ""
    return Cell(status=Status.MET if judged.met else Status.MISSED)


def _stops(judgment: Judgment) -> str:
    wanted = judgment.requirements
    drawn = [draw.name.partition(".")[2].replace(".", " ").replace("_", " ") for draw in wanted.draws]
    spread = [
        *(f"all numbers with bounds of the {kind}" for kind in wanted.within_bounds),
        *(escape(name) for name in drawn),
    ]
    differ = f"They differ in {numbers.listing(spread)}. " if spread else ""
    return (
        f"The design is judged on {stops_of(judgment)}: vehicle, rail and disturbances are drawn anew for each stop, "
        f"on {escape(numbers.listing(wanted.rails))} in turn. {differ}Efficiency is the ideal stop of the same draw "
        "over the distance. How the gains were found stands beside each of them in [](#design)."
    )
