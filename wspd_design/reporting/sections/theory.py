"""The theorems behind the checks: what each says, what it needs and why it holds."""

import re
from collections.abc import Iterable

from wspd_design.certificates.records import Certificate, Status
from wspd_design.parameters.theory import TheoremText, load_theorems
from wspd_design.reporting.blocks import Block, Bullets, Heading, Paragraph
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.text import Emphasis, rich, spans
from wspd_design.studies.dossier import Dossier


def theory(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the theorems to which checks of this report refer; nothing if there are none."""
    shown = [
        each
        for each in load_theorems()
        if any(each in theorems_of(made) for made in _speaking(dossier.certificates))
    ]
    if not shown:
        return ()
    found: list[Block] = [
        Heading(text="Theorems behind the checks", anchor="theory"),
        Paragraph(
            text=rich(
                "What the checks rest on, in general; a check shows that the needs are met for the numbers of this "
                "design. What a theorem does not say stands with its checks in [](#stability-checks). A prime is a "
                "derivative with respect to time."
            )
        ),
    ]
    for each in shown:
        found += _theorem(each)
    return tuple(found)


def theorems_of(certificate: Certificate) -> tuple[TheoremText, ...]:
    """Return the theorems to which a check refers."""
    named = re.findall(r"docs/theory\.md#([a-z-]+)", certificate.reference)
    return tuple(each for each in load_theorems() if each.anchor in named)


def theorem_anchor(anchor: str) -> str:
    """Return the anchor of a theorem in a report."""
    return f"theory-{anchor}"


def _speaking(certificates: Iterable[Certificate]) -> Iterable[Certificate]:
    return (each for each in certificates if each.status is not Status.NOT_APPLICABLE)


def _theorem(each: TheoremText) -> tuple[Block, ...]:
    return (
        Heading(text=each.title, anchor=theorem_anchor(each.anchor), level=2),
        Paragraph(text=with_formulas(each.statement)),
        Paragraph(text="It needs:"),
        Bullets(items=tuple(map(with_formulas, each.needs))),
        Paragraph(text=(Emphasis(text="Why."), " ", *spans(with_formulas(each.why)))),
    )
