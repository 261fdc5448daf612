"""Equation (19) and what became of the equations that the design rests on."""

from wspd_design.parameters.equations import Equation as PaperEquation
from wspd_design.parameters.equations import load_equations
from wspd_design.reporting.blocks import Block, Cell, Equation, Heading, Paragraph, Status
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Text, rich, spans
from wspd_design.studies.dossier import Dossier

PLANT = ("1", "2", "3", "5", "6", "7", "8", "9", "10", "13", "14", "15", "19", "B_W")
"""Numbers of the equations that every design rests on."""

TONES = {"misprint": Status.BAD, "gap": Status.UNDECIDED}  # of the first verdict


def slip_equation(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the equations."""
    equations = load_equations()
    slip = next(each for each in equations if each.number == "19")
    numbers = (*PLANT, *dossier.law.equations)
    used = [each for each in equations if each.number in numbers]
    faulty = [each for each in used if set(each.verdicts) & set(TONES)]
    return (
        Heading(text="The slip dynamics", anchor="slip-equation"),
        Paragraph(
            text=rich(
                "Everything below speaks about equation (19) of the paper, here with the drift $F$ and the "
                "gain $G$ apart: the slip $lambda$ of a wheelset at train speed $v$ under its braking torque "
                "$T$."
            )
        ),
        Equation(
            source=slip.typst_corrected or slip.typst_printed,
            description="The rate of the slip equals the drift F, a function of slip, speed and time, plus "
            "the gain G = R / (2 v I) times the braking torque T; in plain text: "
            f"{slip.corrected or slip.printed}.",
            number="19",
            anchor="eq19",
        ),
        Paragraph(
            text=rich(
                f"*Verdict: {slip.verdict}.* It is derived from equations (1) to (3) in `{slip.file}`, and shown by "
                f"the test `{slip.test.partition('::')[2]}`. "
            )
            + spans(with_formulas(slip.remark))
        ),
        Paragraph(
            text=rich(
                f"Of the {len(used)} equations of the paper that this report rests on, {len(faulty)} are "
                "misprinted or true only under an assumption that the paper does not state: [](#misprints) names them. "
                "The program uses the corrected forms."
            )
        ),
        build(
            faulty,
            (
                ColumnOf(title="Eq.", read=lambda each: each.number),
                ColumnOf(title="Subject", read=lambda each: each.title),
                ColumnOf(
                    title="Verdict",
                    read=lambda each: Cell(status=TONES[each.verdicts[0]], text=each.verdict),
                ),
                ColumnOf(
                    title="What is wrong, and what is assumed instead", read=lambda each: _explained(each)
                ),
            ),
            caption="Misprints and gaps that matter here; wspd equations prints all equations.",
            anchor="misprints",
        ),
    )


def _explained(equation: PaperEquation) -> Text:
    needs = f"Needs: {equation.assumption}" if equation.assumption else ""
    return with_formulas(" ".join(part for part in (equation.remark, needs) if part))
