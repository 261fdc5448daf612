"""The same stop on larger models of the vehicle, and where the model of this report suffices."""

from functools import partial

from wspd_design.reporting.blocks import Block, Figure, Heading, Paragraph
from wspd_design.reporting.figures.drawing import picture
from wspd_design.reporting.figures.ladder import rungs, rungs_alt
from wspd_design.reporting.ladder import agreements_table, axles_table, sensitivity, stops_table, sufficiency
from wspd_design.reporting.text import escape, rich
from wspd_design.studies.dossier import Dossier


def ladder(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section with the ladder of models; none where it was not asked for."""
    found = dossier.ladder
    if found is None:
        return ()
    top = escape(found.rungs[-1].title)
    inferred = f" {found.remark}" if found.remark else ""
    return (
        Heading(text="Ladder of models", anchor="ladder"),
        Paragraph(
            text=rich(
                "The stop of this report on every model of the vehicle, with the same law: [](#ladder-stops) and "
                "[](#ladder-axles) have the figures, [](#ladder-rungs) shows slips and loads, [](#ladder-agreement) "
                f"how far each rung is from the last one, {top}. Within the tolerances there, what suffices for this "
                f"stop is: {escape(sufficiency(found))}. Checks, drawn stops and requirements of this report do not "
                f"rest on the largest model.{sensitivity(found)}{inferred}"
            )
        ),
        stops_table(
            found,
            caption="The stop on each model. Largest slip, lock, spread and vibration are those of the worst wheelset. "
            f"Spread: of the distance over starts that nobody can tell "
            f"apart, where the loop is sensitive. Half steps: what they change in the distance.{inferred}",
            anchor="ladder-stops",
        ),
        axles_table(
            found,
            caption="Every wheelset. Slip and least load above 10 km/h; load of one wheel, its mean and its standard "
            "deviation about a moving mean over 1 s while the brake is built up; vibration: rim speed from 8 to 18 Hz, "
            f"rms in the half second with most of it, where its spectrum is highest, and the speed then.{inferred}",
            anchor="ladder-axles",
        ),
        Figure(
            svg=picture(partial(rungs, found=found), height=3.6),
            caption=f"Slip and load of a wheel above 10 km/h on each model, on the same axes.{inferred}",
            alt=rungs_alt(found),
            anchor="ladder-rungs",
        ),
        agreements_table(
            found,
            caption=f"Deviations from {found.rungs[-1].title}, of the worst wheelset, in the unit of the tolerance, "
            f"and the smallest model from which on all are within it.{inferred}",
            anchor="ladder-agreement",
        ),
    )
