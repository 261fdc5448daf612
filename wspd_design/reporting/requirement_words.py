"""Requirements in words: limits, figures and margins as people read them."""

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Cell, Status
from wspd_design.studies.judgment import Outcome, Requirement

_SHOWN = {
    Outcome.MET: Status.MET,
    Outcome.MISSED: Status.MISSED,
    Outcome.OPEN: Status.OPEN,
}


def figure(row: Requirement, value: float | None) -> str:
    """Write a number of a requirement in its unit; a dash where there is none."""
    if value is None:
        return numbers.NONE
    return numbers.quantity(100.0 * value if row.unit == "%" else value, row.unit, 3)


def limit(row: Requirement) -> str:
    """Write what is allowed."""
    if row.outcome is Outcome.TOLD:
        return numbers.NONE
    if row.limit is None:
        return "holds" if row.checks or row.name == "standstill" else numbers.NONE
    if row.name in ("loop", "stable_within"):
        return f"< {figure(row, row.limit)}"
    return f"{'≥' if row.at_least else '≤'} {figure(row, row.limit)}"


def reached(row: Requirement) -> str:
    """Write what was reached; where there is no number, what the outcome rests on."""
    return row.remark or numbers.NONE if row.reached is None else figure(row, row.reached)


def margin(row: Requirement) -> str:
    """Write the margin in percent of the limit, with its sign."""
    if row.margin is None:
        return numbers.NONE
    percent = numbers.significant(100.0 * row.margin, 2)
    return f"{'' if row.margin < 0.0 else '+'}{percent} %"


def finding(row: Requirement) -> Cell | str:
    """Return the outcome as a sign and a word; words for what is only told."""
    return Cell(status=_SHOWN[row.outcome]) if row.outcome in _SHOWN else "told"


def title(row: Requirement) -> str:
    """Write what is asked for, with the figure of a perfect law where that is known."""
    return (
        row.title
        if row.perfect is None
        else f"{row.title} (a perfect law: {numbers.decimals(row.perfect, 3)})"
    )


def against_limit(row: Requirement) -> str:
    """Say in a clause what was reached and what is allowed."""
    if row.reached is None:
        return f"{row.title}: {row.remark or row.outcome.value}"
    perfect = "" if row.perfect is None else f", a perfect law has {numbers.decimals(row.perfect, 3)}"
    return f"{row.title}: {figure(row, row.reached)}, allowed {limit(row)}{perfect}"
