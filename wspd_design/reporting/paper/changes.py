"""Which of the paper's conclusions change on the multibody model."""

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import (
    Block,
    Cell,
    Definition,
    Definitions,
    Heading,
    Paragraph,
    Status,
    Table,
)
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Link
from wspd_design.studies.inferred import mark
from wspd_design.studies.paper.conclusions.records import Conclusion
from wspd_design.studies.paper.locomotive import OnLocomotive
from wspd_design.studies.paper.section7 import Section7

SMALL, SMOOTH, IRREGULAR = "four axles", "82 DOF", "irregular"
"""Models and track, above columns."""


def changes(small: Section7, made: OnLocomotive) -> tuple[Block, ...]:
    """Return the section about the conclusions on both models."""
    return (
        Heading(text="Which conclusions change", anchor="locomotive-changes", level=2),
        Paragraph(text=_changes(small, made)),
        _conclusions(small, made),
        *_findings(small, made),
    )


def _changes(small: Section7, made: OnLocomotive) -> str:
    """Say which conclusions are judged otherwise on the multibody model."""
    changed = [
        f"{ours.name} ({theirs.verdict.value} on four axles, {ours.verdict.value} here)"
        for theirs, ours in zip(small.conclusions, made.smooth.conclusions, strict=True)
        if theirs.verdict is not ours.verdict
    ]
    rough = [
        f"{ours.name} ({ours.verdict.value})"
        for theirs, ours in zip(made.smooth.conclusions, made.irregular.conclusions, strict=True)
        if theirs.verdict is not ours.verdict
    ]
    first = (
        f"On smooth track {numbers.count(len(changed), 'conclusion')} of {len(small.conclusions)} "
        f"{'is' if len(changed) == 1 else 'are'} judged otherwise "
        f"than on the small model: {numbers.listing(changed)}."
        if changed
        else f"On smooth track all {len(small.conclusions)} conclusions are judged as on the small model."
    )
    second = (
        f" On irregular track, of these otherwise again: {numbers.listing(rough)}."
        if rough
        else " Irregular track changes no verdict."
    )
    return first + second


def _conclusions(small: Section7, made: OnLocomotive) -> Table:
    rows = list(zip(small.conclusions, made.smooth.conclusions, made.irregular.conclusions, strict=True))

    def verdict(title: str, index: int) -> ColumnOf[tuple[Conclusion, ...]]:
        return ColumnOf(title=title, read=lambda row: Cell(status=Status[row[index].verdict.name]))

    return build(
        rows,
        (
            ColumnOf(
                title="Conclusion of the paper",
                read=lambda row: (Link(anchor=f"conclusion-{row[0].name}", text=row[0].claim),),
            ),
            verdict(SMALL, 0),
            verdict(SMOOTH, 1),
            verdict(IRREGULAR, 2),
        ),
        caption="The paper's conclusions on both models, by the same rules. The ideal stops beside them are "
        f"those of the small model; the parts of the law run on smooth track. {mark(made.model)}",
        anchor="locomotive-conclusions",
    )


def _findings(small: Section7, made: OnLocomotive) -> tuple[Block, ...]:
    """Tell the numbers behind each verdict that changes."""
    triples = zip(small.conclusions, made.smooth.conclusions, made.irregular.conclusions, strict=True)
    rows = tuple(
        Definition(
            term=ours.claim, text=f"On smooth track: {ours.finding} On irregular track: {rough.finding}"
        )
        for theirs, ours, rough in triples
        if len({theirs.verdict, ours.verdict, rough.verdict}) > 1
    )
    return (Definitions(rows=rows),) if rows else ()
