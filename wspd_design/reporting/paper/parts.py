"""What in the paper's law does the work: the law with its parts taken out."""

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Heading, Paragraph
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.paper.evidence import Ablation
from wspd_design.studies.paper.reproduction import Reproduction

LAWS = (
    ("printed, u in kN m", "printed"),
    ("printed, u as share of the maximum", "as_share"),
    ("the same without adaptation", "unadapted"),
    ("a relay: fill where s > 0, else vent", "relay"),
    ("u in kN m without adaptation", "unadapted_printed"),
)
"""Each law in words, and the field of its distance."""

OUTCOMES = (
    ("largest weight, in maximum torques", "largest_weight", 0),
    ("bound, in its initial values", "bound_growth", 0),
    ("late ripple of the slip", "ripple", 3),
    ("late ripple, near-ideal actuator", "ideal_ripple", 3),
)
"""Each outcome in words, its field and its decimals."""


def parts(made: Reproduction) -> tuple[Block, ...]:
    """Return the section about the parts of the adaptive fuzzy law."""
    evidence = made.small.evidence
    ablations = evidence.ablations
    return (
        Heading(text="The adaptive fuzzy law, part by part", anchor="parts"),
        Paragraph(
            text=rich(
                "The paper gives the command no unit. In kN m the printed weights of ±1 are nothing beside a brake "
                "of 60 kN m, and the adaptation has to make them large; as a share of the maximum torque they "
                "suffice from the start. Both readings end as the same relay on the sign of $s$: "
                "[](#parts-distances) has the distance with each part taken out, [](#parts-adaptation) what the "
                "adaptation arrives at."
            )
        ),
        build(
            LAWS,
            (
                ColumnOf(title="Law", read=lambda law: law[0]),
                *(_distance(each) for each in ablations),
            ),
            caption="Distances of the law and of its parts.",
            anchor="parts-distances",
        ),
        build(
            OUTCOMES,
            (
                ColumnOf(title="At the end of the stop", read=lambda outcome: outcome[0]),
                *(_outcome(each) for each in ablations),
            ),
            caption="What the adaptation arrives at, and the ripple of the slip in the second half of the time above "
            f"10 km/h: with the valve of {evidence.fill_time:g} s at 100 ms, and with one of "
            f"{evidence.ideal_fill_time * 1e3:g} ms sampled every {evidence.ideal_sample_time * 1e3:g} ms.",
            anchor="parts-adaptation",
        ),
    )


def _distance(ablation: Ablation) -> ColumnOf[tuple[str, str]]:
    return ColumnOf(
        title=ablation.rail, unit="m", decimals=1, read=lambda law: float(getattr(ablation, law[1]))
    )


def _outcome(ablation: Ablation) -> ColumnOf[tuple[str, str, int]]:
    return ColumnOf(
        title=ablation.rail,
        flush_right=True,
        read=lambda outcome: numbers.decimals(getattr(ablation, outcome[1]), outcome[2]),
    )
