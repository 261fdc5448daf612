"""The domains of the checks: what each varies over its range and what it holds, in one table."""

from functools import partial

from wspd_design.certificates.records import Domain, Interval
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Heading, Paragraph, Table
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.statements import DOMAINS, Statements
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.dossier import Dossier

VARIED, HELD = "●", "○"


def domains(statements: Statements, dossier: Dossier) -> tuple[Block, ...]:
    """Return the table of the domains; nothing where no claim varies a number."""
    if not statements.domains:
        return ()
    specification = dossier.specification
    return (
        Heading(text="Domains", anchor="domains-section", level=2),
        Paragraph(
            text=rich(
                f"A statement holds on its domain and nowhere else. [](#{DOMAINS}) names the domains: a statement on "
                "D1 is one for all values of what D1 varies, at once and in any combination, and for the one value of "
                "what it holds. Numbers without bounds are taken as exactly known. Where a claim speaks about the slip "
                f"near its reference, that is {specification.slip:g}."
            )
        ),
        _table(statements),
    )


def _table(statements: Statements) -> Table:
    def mark(domain: Domain, quantity: Interval) -> str:
        if quantity.name in {each.name for each in domain.varied}:
            return VARIED
        return HELD if quantity.name in {each.name for each in domain.held} else ""

    return build(
        statements.quantities(),
        (
            ColumnOf(title="Quantity", read=lambda each: with_formulas(each.name)),
            ColumnOf(title="Range", read=lambda each: each.numbers[0], flush_right=True),
            ColumnOf(title="Unit", read=lambda each: numbers.unit(each.numbers[1]) or "-"),
            *(
                ColumnOf(title=name, read=partial(mark, domain))
                for domain, name in statements.domains.items()
            ),
        ),
        caption=f"Domains of the checks. {VARIED}: varied over the range; {HELD}: held at its nominal value; empty: "
        "the statement does not depend on it, or it is exactly known.",
        anchor=DOMAINS,
    )
