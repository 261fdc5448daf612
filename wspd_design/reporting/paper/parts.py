"""What in the paper's law does the work: the law with its parts taken out."""

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Column, Heading, Paragraph, Table
from wspd_design.reporting.text import rich
from wspd_design.studies.paper.reproduction import Reproduction


def parts(made: Reproduction) -> tuple[Block, ...]:
    """Return the section about the parts of the adaptive fuzzy law."""
    evidence = made.evidence
    ablations = evidence.ablations
    return (
        Heading(text="The adaptive fuzzy law, part by part", anchor="parts"),
        Paragraph(
            text=rich(
                "The paper gives the command no unit. In kN m the printed weights of ±1 are nothing beside a brake "
                "of 60 kN m, and the adaptation has to make them large; as a share of the maximum torque they "
                "suffice from the start. Both readings end as the same relay on the sign of $s$: the columns show "
                "the distance with each part taken out."
            )
        ),
        Table(
            columns=(
                Column(title="Law"),
                *(Column(title=each.rail, unit="m", align="right") for each in ablations),
            ),
            rows=(
                ("printed, u in kN m", *(_distance(each.printed) for each in ablations)),
                ("printed, u as share of the maximum", *(_distance(each.as_share) for each in ablations)),
                ("the same without adaptation", *(_distance(each.unadapted) for each in ablations)),
                ("a relay: fill where s > 0, else vent", *(_distance(each.relay) for each in ablations)),
                ("u in kN m without adaptation", *(_distance(each.unadapted_printed) for each in ablations)),
            ),
            caption="Distances of the law and of its parts.",
            anchor="parts-distances",
        ),
        Table(
            columns=(
                Column(title="At the end of the stop"),
                *(Column(title=each.rail, align="right") for each in ablations),
            ),
            rows=(
                (
                    "largest weight, in maximum torques",
                    *(numbers.decimals(each.largest_weight, 0) for each in ablations),
                ),
                (
                    "bound, in its initial values",
                    *(numbers.decimals(each.bound_growth, 0) for each in ablations),
                ),
                ("late ripple of the slip", *(numbers.decimals(each.ripple, 3) for each in ablations)),
                (
                    "late ripple, near-ideal actuator",
                    *(numbers.decimals(each.ideal_ripple, 3) for each in ablations),
                ),
            ),
            caption="What the adaptation arrives at, and the ripple of the slip in the second half of the time above "
            f"10 km/h: with the valve of {evidence.fill_time:g} s at 100 ms, and with one of "
            f"{evidence.ideal_fill_time * 1e3:g} ms sampled every {evidence.ideal_sample_time * 1e3:g} ms.",
            anchor="parts-adaptation",
        ),
    )


def _distance(value: float) -> str:
    return numbers.decimals(value, 1)
