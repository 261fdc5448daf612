"""What the inferred numbers of the multibody model do to a stop, one at a time."""

from functools import partial

from wspd_design.parameters.provenance import Entry
from wspd_design.plants.multibody.records import Multibody
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Figure, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import picture
from wspd_design.reporting.figures.uncertainty import Bar, tornado, tornado_alt
from wspd_design.reporting.paper.model import named, status_of
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.inferred import is_inferred, mark
from wspd_design.studies.tornado import Swing, Tornado

MOST_BARS = 12
BAR_HEIGHT = 0.33  # in
FIGURES = (
    ("distance", "stopping distance", "m", 1.0, 3),
    ("transfer", "load of the first wheelset by braking", "%", 100.0, 1),
    ("slip", "largest mean slip of a wheelset", "-", 1.0, 4),
)
"""Each effect: its field, in words, its unit, its size in that unit and its decimals."""


def inferred(model: Multibody, found: Tornado) -> tuple[Block, ...]:
    """Return the section about the inferred numbers."""
    return (
        Heading(text="What is inferred, and what it does", anchor="inferred"),
        Paragraph(
            text=rich(
                f"Each number of {model.name} with bounds, alone at both ends of them, all others nominal: "
                f"{found.stops} stops with {found.controller} on {found.rail}, on the plant {found.plant}. The loop of "
                "this law settles, so that its stop moves with the numbers; a limit cycle would move with anything. "
                f"{_strongest(found)} [](#inferred-distance), [](#inferred-transfer) and [](#inferred-slip) draw the "
                "strongest, [](#inferred-table) lists all. Two numbers together can do what neither does alone. "
                f"{mark(model)}"
            )
        ),
        *(_figure(model, found, *figure) for figure in FIGURES),
        _table(model, found),
    )


def _strongest(found: Tornado) -> str:
    said = []
    for field, words, unit, scale, places in FIGURES:
        first = found.strongest(field)[0]
        reach = numbers.decimals(scale * first.reach(field, found.nominal), places)
        said.append(f"{words}: {named(first.name)}, by up to {reach} {numbers.unit(unit)}".rstrip())
    return f"The strongest of them, {'; '.join(said)}."


def _figure(
    model: Multibody, found: Tornado, field: str, words: str, unit: str, scale: float, places: int
) -> Figure:
    strongest = found.strongest(field)
    bars = [_bar(model.entries[each.name], each, field, scale) for each in strongest[:MOST_BARS]]
    nominal = scale * float(getattr(found.nominal, field))
    label = f"{words} [{unit}]"
    rest = strongest[MOST_BARS:]
    left_out = (
        f" Left out: {len(rest)} numbers that move it by at most "
        f"{numbers.decimals(scale * rest[0].reach(field, found.nominal), places)} {numbers.unit(unit)}".rstrip()
        + "."
        if rest
        else ""
    )
    draw = partial(tornado, bars=bars, nominal=nominal, numerical=0.0, label=label)
    return Figure(
        svg=picture(draw, height=0.7 + BAR_HEIGHT * len(bars)),
        caption=f"What each number does alone to the {words}. Beside the bars: the bounds; an asterisk: inferred."
        f"{left_out} {mark(model)}",
        alt=tornado_alt(bars, nominal, label),
        anchor=f"inferred-{field}",
    )


def _bar(entry: Entry, swing: Swing, field: str, scale: float) -> Bar:
    low, high = (numbers.quantity_in(end, entry.unit) for end in (swing.low, swing.high))
    return Bar(
        name=named(entry.name) + "*" * is_inferred(entry),
        low=low,
        high=high,
        at_low=scale * float(getattr(swing.at_low, field)),
        at_high=scale * float(getattr(swing.at_high, field)),
    )


def _table(model: Multibody, found: Tornado) -> Table:
    def effect(field: str, words: str, unit: str, scale: float, places: int) -> ColumnOf[Swing]:
        def read(each: Swing) -> str:
            ends = (each.at_low, each.at_high)
            return " / ".join(numbers.decimals(scale * float(getattr(end, field)), places) for end in ends)

        return ColumnOf(title=words.capitalize(), unit=unit, flush_right=True, read=read)

    nominal = ", ".join(
        f"{words} {numbers.decimals(scale * float(getattr(found.nominal, field)), places)} {unit}"
        for field, words, unit, scale, places in FIGURES
    )
    return build(
        found.strongest("distance"),
        (
            ColumnOf(title="Number", read=lambda each: named(each.name)),
            ColumnOf(title="Bounds", read=lambda each: _bounds(model.entries[each.name], each)),
            ColumnOf(title="Status", read=lambda each: status_of(model.entries[each.name])),
            *(effect(*figure) for figure in FIGURES),
        ),
        caption=f"Effects at the lower / at the upper bound; nominal: {nominal}. {mark(model)}",
        anchor="inferred-table",
    )


def _bounds(entry: Entry, swing: Swing) -> str:
    low, high = (numbers.quantity_in(end, entry.unit) for end in (swing.low, swing.high))
    return f"{low.partition(' ')[0]} to {high}"
