"""Which of the paper's conclusions hold: page one and the section with all of them."""

from collections import Counter

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import (
    Block,
    Cell,
    Definition,
    Definitions,
    Heading,
    KeyNumber,
    KeyNumbers,
    Paragraph,
    Status,
    Verdict,
)
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Link, rich
from wspd_design.studies.paper.conclusions.records import Conclusion
from wspd_design.studies.paper.conclusions.records import Verdict as Finding
from wspd_design.studies.paper.evidence import FALLING_RAILS
from wspd_design.studies.paper.reproduction import Reproduction
from wspd_design.studies.paper.table10 import largest, root_mean_square

COUNTED = {
    Finding.FAILS: ("does not hold", "do not hold"),
    Finding.PARTLY: ("holds in part", "hold in part"),
    Finding.HOLDS: ("holds", "hold"),
}
"""From the worst finding to the best, in words that follow the number of one or of several conclusions."""


def verdict(made: Reproduction) -> Verdict:
    """Return the judgment of the page; the worst finding decides."""
    found, rows = made.small.conclusions, made.small.table10
    counts = Counter(each.verdict for each in found)
    worst = next(each for each in COUNTED if counts[each])
    tally = numbers.listing(
        [f"{counts[each]} {words[counts[each] > 1]}" for each, words in COUNTED.items() if counts[each]]
    )
    return Verdict(
        status=Status[worst.name],
        sentence=f"Of {len(found)} conclusions of Section 7, {tally} in our stops. Table 10 itself "
        f"comes out again, on friction and rule tables fitted to it: its 24 numbers deviate by "
        f"{_percent(root_mean_square(rows), 2)} % rms and {_percent(largest(rows), 1)} % at most.",
    )


def summary(made: Reproduction) -> tuple[Block, ...]:
    """Return the key numbers and the table of conclusions."""
    evidence = made.small.evidence
    relay = max(abs(each.relay / each.printed - 1.0) for each in evidence.ablations)
    late = [evidence.stop("afsmc", each.rail).history.late_rms for each in evidence.ablations]
    places = []
    for rail in FALLING_RAILS:
        names = [each.controller for each in evidence.ranking(rail)]
        places.append(str(names.index("afsmc") + 1))
    key_numbers = KeyNumbers(
        numbers=(
            KeyNumber(
                label="Table 10, rms deviation",
                value=_percent(root_mean_square(made.small.table10), 2),
                unit="%",
                note=f"largest of 24 numbers {_percent(largest(made.small.table10), 2)} %",
            ),
            KeyNumber(
                label="A plain relay in its place",
                value=_percent(relay, 2),
                unit="%",
                note="largest change of the distance on four rails",
            ),
            KeyNumber(
                label="Place on Polach's rails",
                value=" and ".join(places),
                note=f"of {len(names)}, dry and wet, by distance",
            ),
            KeyNumber(
                label="Late slip rms of the law",
                value=numbers.decimals(max(late), 2),
                note=f"on the worst rail, {numbers.decimals(min(late), 2)} on the best, about "
                f"{evidence.slip_reference:g}",
            ),
        )
    )
    table = build(
        made.small.conclusions,
        (
            ColumnOf(
                title="Conclusion of the paper",
                read=lambda each: (Link(anchor=_anchor(each), text=each.claim),),
            ),
            ColumnOf(title="Finding", read=lambda each: Cell(status=Status[each.verdict.name])),
            ColumnOf(title="Where", read=lambda each: each.place),
        ),
        caption="What the paper concludes from its simulations, and whether our stops say so too.",
        anchor="conclusions-table",
    )
    return (key_numbers, table)


def conclusions(made: Reproduction) -> tuple[Block, ...]:
    """Return the section that judges each conclusion by its numbers."""
    found: list[Block] = [
        Heading(text="What holds and what does not", anchor="conclusions"),
        Paragraph(
            text=rich(
                "Each conclusion of [](#conclusions-table) is judged by a stated rule from the numbers of this page "
                "alone; the claims are the paper's in our words. The proof of Section 6 is judged elsewhere, by the "
                "checks of every design report."
            )
        ),
    ]
    for topic in dict.fromkeys(each.topic for each in made.small.conclusions):
        found.append(Heading(text=topic.value, anchor=f"topic-{topic.name.lower()}", level=2))
        for each in made.small.conclusions:
            if each.topic is topic:
                found += _conclusion(each)
    return tuple(found)


def _conclusion(conclusion: Conclusion) -> list[Block]:
    return [
        Heading(text=conclusion.name.capitalize(), anchor=_anchor(conclusion), level=3),
        Verdict(status=Status[conclusion.verdict.name], sentence=conclusion.claim),
        Definitions(
            rows=(
                Definition(term="In the paper", text=conclusion.place),
                Definition(term="It holds if", text=conclusion.rule),
                Definition(term="Here", text=conclusion.finding),
            )
        ),
    ]


def _anchor(conclusion: Conclusion) -> str:
    return f"conclusion-{conclusion.name}"


def _percent(share: float, places: int) -> str:
    return numbers.decimals(100.0 * share, places)
