"""The symbols and terms that a report uses, and no others."""

import re
from collections.abc import Sequence

from wspd_design.parameters.theory import SymbolText, Term, load_glossary, load_symbols
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Definition, Definitions, Heading, Paragraph
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.numbering import parts
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Link, Math, spoken

SYMBOLS, GLOSSARY = "symbols", "glossary"
"""Anchors of the sections."""

_TOKEN = re.compile(r'(?:(?:dot|hat|tilde|overline)\(\w+\)|[A-Za-z]+)(?:_(?:\w+|"[^"]+"))?(?:\^\*)?')


def words(blocks: Sequence[Block]) -> tuple[Block, ...]:
    """Return the sections about the symbols and terms that stand in some blocks."""
    return (*_symbols(blocks), *_glossary(blocks))


def symbols_in(blocks: Sequence[Block]) -> tuple[SymbolText, ...]:
    """Return the symbols of statements that formulas of some blocks use, in the order of the list."""
    used = {
        token
        for part in parts(tuple(blocks))
        if isinstance(part, Math)
        for token in _TOKEN.findall(re.sub(r"(?<=[A-Za-z0-9])\^\(\* top\)", "^*", part.source))
    }
    return tuple(each for each in load_symbols() if each.symbol in used)


def terms_in(blocks: Sequence[Block]) -> tuple[Term, ...]:
    """Return the terms that stand in some blocks, in the order of the alphabet."""
    text = " ".join(part for part in parts(tuple(blocks)) if isinstance(part, str)).lower()
    text += " ".join(part.text for part in parts(tuple(blocks)) if isinstance(part, Link)).lower()
    return tuple(
        each
        for each in load_glossary()
        if any(re.search(rf"\b{re.escape(form)}\b", text) for form in each.forms)
    )


def _symbols(blocks: Sequence[Block]) -> tuple[Block, ...]:
    found = symbols_in(blocks)
    return (
        Heading(text="Symbols", anchor=SYMBOLS),
        Paragraph(
            text=(
                "The symbols of the checks, ",
                Link(anchor="symbols-table"),
                ". Slip is positive when braking; torque is per wheelset, the creep force per wheel. What a rule for a "
                "gain or a theorem names in passing is explained there.",
            )
        ),
        build(
            found,
            (
                ColumnOf(
                    title="Symbol", read=lambda each: (Math(source=each.symbol, spoken=spoken(each.symbol)),)
                ),
                ColumnOf(title="Meaning", read=lambda each: with_formulas(each.meaning)),
                ColumnOf(
                    title="Unit",
                    read=lambda each: ", ".join(numbers.unit(unit) or "-" for unit in each.unit.split(", ")),
                ),
            ),
            caption="Symbols that stand in this report.",
            anchor="symbols-table",
        ),
    )


def _glossary(blocks: Sequence[Block]) -> tuple[Block, ...]:
    return (
        Heading(text="Glossary", anchor=GLOSSARY),
        Definitions(rows=tuple(Definition(term=each.term, text=each.meaning) for each in terms_in(blocks))),
    )
