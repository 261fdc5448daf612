"""How far the stop spreads over the bounds of all numbers, what each does alone, and other conditions."""

import math
from collections.abc import Sequence
from functools import partial

from wspd_design.parameters.provenance import Entry
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Code, Figure, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import picture
from wspd_design.reporting.figures.uncertainty import (
    Bar,
    Panel,
    distributions,
    distributions_alt,
    tornado,
    tornado_alt,
)
from wspd_design.reporting.sections.other_conditions import other_conditions
from wspd_design.reporting.spreads import capitalized, entries_of, scaled, shown, titled, unit_of, words_of
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import references
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.key_figures import KEY_FIGURES
from wspd_design.studies.uncertainty import Effect, Spread, Uncertainty, WorstSet

UNCERTAINTY = "uncertainty"
"""Anchor of the section."""

MOST_BARS = 12
BAR_HEIGHT = 0.36  # in


def uncertainty(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the uncertainty; nothing where no number has bounds."""
    found = dossier.uncertainty
    if found is None:
        return ()
    entries = entries_of(dossier)
    shown: tuple[Block, ...] = (
        _spreads(found),
        *_distribution(found),
        Paragraph(text=_numerical(found)),
        *_single_effects(found, entries),
        *other_conditions(found),
        *_worst_sets(found, entries),
    )
    anchors = [each.anchor for each in shown if isinstance(each, Figure | Table)]
    return (
        Heading(text="Uncertainty", anchor=UNCERTAINTY),
        Paragraph(text=(f"{_what_is_drawn(found)} See ", *references(anchors), ".")),
        *shown,
    )


def _what_is_drawn(found: Uncertainty) -> str:
    still = (
        f" In {numbers.count(found.unstopped, 'set')} the train does not come to a standstill; these count as the "
        "longest."
        if found.unstopped
        else ""
    )
    held = (
        f" Held at their value, though they have bounds: {numbers.listing([words_of(each) for each in found.held])}."
        if found.held
        else ""
    )
    return (
        f"The same stop with the same law, {found.sets} times, seed {found.seed}: each time all {len(found.drawn)} "
        "numbers with bounds of vehicle and rail are drawn anew, evenly and independently within their bounds, and the "
        "law does not know what was drawn. Lowest and highest are those of these sets and bound nothing: sets that "
        f"were not drawn can lie beyond.{still}{held} The bounds are estimates, so that the spread is one, too."
    )


def _spreads(found: Uncertainty) -> Table:
    def value(name: str) -> ColumnOf[Spread]:
        title = {"nominal": "Nominal", "low": "Lowest", "p05": "5 %", "p95": "95 %", "high": "Highest"}[name]
        return ColumnOf(
            title=title, flush_right=True, read=lambda each: shown(found, each.name, getattr(each, name))
        )

    return build(
        found.spreads,
        (
            ColumnOf(title="Figure", read=lambda each: titled(KEY_FIGURES[each.name])),
            *map(value, ("nominal", "low", "p05", "p95", "high")),
            ColumnOf(
                title="Worst set",
                flush_right=True,
                read=lambda each: numbers.NONE if each.low == each.high else str(each.worst.number),
            ),
        ),
        caption=f"Key figures of the nominal stop and of {found.sets} drawn sets, with the digits that their spread "
        "leaves them. 5 % and 95 %: a twentieth of the sets lie at or below the one, 19 of 20 at or below the other.",
        anchor="uncertainty-table",
    )


def _panel(spread: Spread) -> Panel:
    rule = KEY_FIGURES[spread.name]
    return Panel(
        label=titled(rule).lower() if unit_of(rule) == "-" else f"{rule.title} [{unit_of(rule)}]",
        values=tuple(scaled(rule, each) for each in spread.values if math.isfinite(each)),
        nominal=scaled(rule, spread.nominal),
        p05=scaled(rule, spread.p05),
        p95=scaled(rule, spread.p95),
    )


def _distribution(found: Uncertainty) -> tuple[Block, ...]:
    panels = [
        panel
        for name in ("distance", "efficiency")
        if (spread := found.spread_of(name)) is not None and (panel := _panel(spread)).values
    ]
    if not panels:
        return ()
    return (
        Figure(
            svg=picture(partial(distributions, panels=panels), height=2.3),
            caption="How often each value comes. Solid: the nominal stop; dashed: 5 % and 95 %; ticks: the single "
            "sets.",
            alt=distributions_alt(panels),
            anchor="uncertainty-distribution",
        ),
    )


def _numerical(found: Uncertainty) -> str:
    """Tell the uncertainty of the computation apart from that of the numbers."""
    check = (
        f"{numbers.count(found.checked, 'set')} of the drawn ones were simulated again with half the steps, which "
        f"change the distance by at most {numbers.significant(100.0 * found.step_change, 2)} %; the worst sets run "
        "with steps that are checked like those of every single stop. "
        if found.checked
        else ""
    )
    spread = (
        f"The nominal loop is sensitive: starts that nobody can tell apart spread its distance by "
        f"{numbers.significant(found.numerical, 2)} m, and effects below that say nothing."
        if found.numerical
        else "The nominal loop is not sensitive: starts that nobody can tell apart give the same distance."
    )
    return f"Numerical spread, apart from that of the numbers: {check}{spread}"


def _single_effects(found: Uncertainty, entries: dict[str, Entry]) -> tuple[Block, ...]:
    strongest, spread = found.strongest("distance"), found.spread_of("distance")
    if spread is None or not strongest or not math.isfinite(spread.nominal):
        return ()
    bars = [_bar(each, entries) for each in strongest[:MOST_BARS]]
    rest = strongest[MOST_BARS:]
    left_out = (
        f" Left out: {len(rest)} numbers that move it by at most "
        f"{numbers.significant(rest[0].reach('distance', spread.nominal), 2)} m."
        if rest
        else ""
    )
    label = "stopping distance [m]"
    draw = partial(tornado, bars=bars, nominal=spread.nominal, numerical=found.numerical, label=label)
    return (
        Figure(
            svg=picture(draw, height=0.7 + BAR_HEIGHT * len(bars)),
            caption="Each number alone at the ends of its bounds, all others nominal, strongest first. Beside the "
            f"bars: the bounds. Line: the nominal stop{'; gray: its numerical spread' if found.numerical else ''}."
            f"{left_out}",
            alt=tornado_alt(bars, spread.nominal, label),
            anchor="uncertainty-tornado",
        ),
        _effects(found, strongest, entries),
    )


def _bar(effect: Effect, entries: dict[str, Entry]) -> Bar:
    entry = entries[effect.name]
    low, high = (numbers.quantity_in(end, entry.unit) for end in (effect.low, effect.high))
    at_low, at_high = effect.ends("distance")
    return Bar(name=words_of(effect.name), low=low, high=high, at_low=at_low, at_high=at_high)


def _effects(found: Uncertainty, effects: Sequence[Effect], entries: dict[str, Entry]) -> Table:
    def value(figure: str) -> ColumnOf[Effect]:
        rule = KEY_FIGURES[figure]
        return ColumnOf(
            title=capitalized(rule.short),
            unit=unit_of(rule),
            flush_right=True,
            read=lambda each: " / ".join(shown(found, figure, end) for end in each.ends(figure)),
        )

    told = [
        name
        for name in ("distance", "time", "efficiency", "slip_rms", "slip_max")
        if found.spread_of(name) is not None
    ]
    return build(
        effects,
        (
            ColumnOf(title="Number", read=lambda each: words_of(each.name)),
            ColumnOf(
                title="Bounds",
                read=lambda each: (
                    f"{numbers.quantity_in(each.low, entries[each.name].unit).partition(' ')[0]} to "
                    f"{numbers.quantity_in(each.high, entries[each.name].unit)}"
                ),
            ),
            *map(value, told),
        ),
        caption="The same for all drawn numbers: figures at the lower / at the upper bound.",
        anchor="uncertainty-effects",
    )


def _worst_sets(found: Uncertainty, entries: dict[str, Entry]) -> tuple[Block, ...]:
    """Tell the numbers of the worst sets, and how to simulate them again."""
    sets: dict[int, WorstSet] = {}
    of: dict[int, list[str]] = {}
    for each in found.spreads:
        if each.low == each.high:  # no set is worse than another
            continue
        sets.setdefault(each.worst.number, each.worst)
        of.setdefault(each.worst.number, []).append(KEY_FIGURES[each.name].title)
    chosen = list(sets.values())

    def value(worst: WorstSet) -> ColumnOf[str]:
        drawn = dict(worst.parameters)
        return ColumnOf(
            title=f"Set {worst.number}",
            flush_right=True,
            read=lambda name: numbers.significant(_in_unit(drawn[name], entries[name]), 4),
        )

    table = build(
        found.drawn,
        (
            ColumnOf(title="Number", read=words_of),
            ColumnOf(title="Unit", read=lambda name: numbers.unit(entries[name].unit) or "-"),
            ColumnOf(
                title="Nominal",
                flush_right=True,
                read=lambda name: numbers.significant(_in_unit(entries[name].value, entries[name]), 4),
            ),
            *map(value, chosen),
        ),
        caption="What the worst sets draw. "
        + " ".join(f"Set {number}: worst {numbers.listing(names)}." for number, names in of.items()),
        anchor="uncertainty-worst",
    )
    commands = [each.command for each in chosen if each.command]
    if not commands:
        return (table,)
    return (
        table,
        Paragraph(
            text="Beside the attached files, these commands simulate the worst sets again, each alone, and give the "
            "numbers above."
        ),
        Code(text="\n".join(commands)),
    )


def _in_unit(value: object, entry: Entry) -> float:
    assert isinstance(value, float)
    return float(numbers.quantity_in(value, entry.unit).partition(" ")[0].replace(numbers.MINUS, "-"))
