"""``wspd new rail``: a rail file from the peak of its adhesion, or fitted to a measured creep curve."""

from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.console import console, print_written, spaced, table
from wspd_design.cli.output import write_text
from wspd_design.cli.wizard.draft import ENDING
from wspd_design.cli.wizard.rail_steps import NONE, rail_steps, wanted_rail
from wspd_design.cli.wizard.session import answer_option, answered_for_file, given_answers, print_answers
from wspd_design.exchange.parameter_file import parameter_file
from wspd_design.parameters.contradictions import notice_of_rail
from wspd_design.parameters.units import format_quantity

RAIL_FILE = "rail.toml"
_COMMENTS = (
    "Written by wspd new rail. Every number may be changed; wspd docs vehicle-files says what each one means.",
    "Bounds are 20 % about each number, an engineering estimate that proofs and campaigns go through.",
)


def rail(
    output: Annotated[
        Path | None,
        typer.Argument(metavar="FILE", help=f"Rail file to write. Default: {RAIL_FILE}.", show_default=False),
    ] = None,
    curve: Annotated[
        str | None, answer_option("--curve", "FILE", f"CSV file of slip and adhesion, or {NONE}.")
    ] = None,
    like: Annotated[str | None, answer_option("--like", "NAME", "Shipped rail that it is most like.")] = None,
    vehicle: Annotated[
        str | None, answer_option("--vehicle", "NAME", "Vehicle of the curve or of the peak.")
    ] = None,
    speed: Annotated[
        str | None, answer_option("--speed", "SPEED", "Speed of the curve or of the peak.")
    ] = None,
    friction_ratio: Annotated[str | None, answer_option("--friction-ratio", "SHARE", "A of eq. (7).")] = None,
    friction_decay: Annotated[str | None, answer_option("--friction-decay", "VALUE", "B of eq. (7).")] = None,
    adhesion_reduction: Annotated[
        str | None, answer_option("--adhesion-reduction", "SHARE", "kA of eq. (5).")
    ] = None,
    slip_reduction: Annotated[
        str | None, answer_option("--slip-reduction", "SHARE", "kS of eq. (5).")
    ] = None,
    peak: Annotated[str | None, answer_option("--peak", "SHARE", "Adhesion at the peak.")] = None,
    answers_file: options.AnswersOption = None,
    show_answers: options.PrintAnswersOption = False,
    yes: Annotated[bool, typer.Option("--yes", help="Ask nothing and take all suggestions.")] = False,
    resume: Annotated[
        Path | None,
        typer.Option("--resume", metavar="FILE", help=f"Go on with the answers of a {ENDING} file."),
    ] = None,
    force: options.ForceOption = False,
) -> None:
    """Answer some questions about a rail, or fit it to a measured creep curve, and get its file."""
    given = {
        "curve": curve,
        "like": like,
        "vehicle": vehicle,
        "speed": speed,
        "friction_ratio": friction_ratio,
        "friction_decay": friction_decay,
        "adhesion_reduction": adhesion_reduction,
        "slip_reduction": slip_reduction,
        "peak": peak,
    }
    if show_answers:
        said_before = {key: answer for key, answer in given.items() if answer is not None}
        print_answers(
            rail_steps(), {**given_answers(rail_steps(), answers_file, None), **said_before}, "wspd new rail"
        )
        return
    target, answers, _ = answered_for_file(
        "rail",
        rail_steps(),
        given,
        output=output,
        default=RAIL_FILE,
        resume=resume,
        file=answers_file,
        yes=yes,
        force=force,
        by_default="the suggestions answer",
    )
    made, entries, fit = wanted_rail(target.stem, answers)
    kind = f"like {answers['like']}" if fit is None else f"fit to {Path(answers['curve']).name}"
    write_text(target, parameter_file(f"Own rail, {kind}", _COMMENTS, entries), force=force)
    if resume is not None:
        resume.unlink()
    out = console()
    shown = table("Number", "Value", "Bounds", "Where from", numeric=("Value",))
    for entry in entries:
        assert isinstance(entry.value, float)
        assert entry.bounds is not None
        shown.add_row(
            entry.name,
            format_quantity(entry.value, entry.unit),
            "{:g} to {:g}".format(*entry.bounds),
            entry.at,
        )
    out.print(spaced(shown))
    if fit is not None:
        out.print(
            f"The fit leaves {fit.rms:.2g} of adhesion rms, {fit.largest:.2g} at most, over {fit.points} points.",
            markup=False,
        )
    notice = notice_of_rail(made)
    if notice:
        out.print(f"{notice}.", markup=False)
    print_written(
        target,
        ("See it", ("sources", target)),
        ("Stop on it", ("simulate", "trenitalia", "--vehicle", answers["vehicle"], "--rail", target)),
    )
