"""The register of assumptions: each with its id, where reality breaks it, and what rests on it."""

from wspd_design.certificates.theorems.register import REGISTER, Registered, stated_in
from wspd_design.plants.quarter import Quarter
from wspd_design.reporting.blocks import Block, Heading, Paragraph, Status
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.sections.checks import ASSUMPTIONS, status_of
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.dossier import Dossier


def assumptions(dossier: Dossier) -> tuple[Block, ...]:
    """Return the register, as far as this report rests on it."""
    return (
        Heading(text="Register of assumptions", anchor=ASSUMPTIONS),
        Paragraph(
            text=rich(
                "[](#assumption-register) lists what the statements of this report take for granted. The ids are the "
                "same in every report. A check falls with each of its assumptions; a simulated stop drops some of them."
            )
        ),
        build(
            _used(dossier),
            (
                ColumnOf(title="", read=lambda each: each.id),
                ColumnOf(title="Assumption", read=lambda each: with_formulas(each.title)),
                ColumnOf(title="Broken in reality by", read=lambda each: with_formulas(each.broken)),
                ColumnOf(title="Rests on it", read=lambda each: _resting(dossier, each)),
                ColumnOf(title="Stops without it", read=lambda each: each.dropped or "none"),
                ColumnOf(title="To be shown on the vehicle by", read=lambda each: each.shown_by),
            ),
            caption="Assumptions, where they fail, and what rests on them. No owner is named, and none of them was "
            "validated on a vehicle.",
            anchor="assumption-register",
        ),
    )


def decisive(dossier: Dossier) -> tuple[Registered, ...]:
    """Return the assumptions under the evidence that decides requirements, and that its stops do not drop."""
    checks = {name for row in dossier.judgment.limited for name in row.checks}
    stated = stated_in(
        clause for each in dossier.certificates if each.name in checks for clause in each.assumptions
    )
    return tuple(
        each for each in REGISTER if not each.dropped or (each.id in stated and _held(dossier, each))
    )


def _used(dossier: Dossier) -> list[Registered]:
    stated = stated_in(clause for each in dossier.certificates for clause in each.assumptions)
    return [each for each in REGISTER if not each.dropped or each.id in stated]


def _resting(dossier: Dossier, assumption: Registered) -> str:
    names = [
        each.name
        for each in dossier.certificates
        if status_of(each) is not Status.NOT_APPLICABLE and assumption.id in stated_in(each.assumptions)
    ]
    return ", ".join(names) or "everything"


def _held(dossier: Dossier, assumption: Registered) -> bool:
    """Tell whether the stops of this report keep an assumption that others could drop."""
    disturbed = dossier.scenario.sensing
    has = dossier.vehicle.entries
    drops: dict[str, bool] = {
        "A4": bool(
            disturbed.dead_time
            or disturbed.shortest_pulse
            or "brake.dead_time" in has
            or "brake.shortest_pulse" in has
        ),
        "A6": dossier.uncertainty is not None,
        "A7": dossier.trials[0].run.plant != Quarter.name,
        "A8": bool(disturbed.speed_noise or disturbed.pulses_per_turn or disturbed.reference_error),
        "A10": "brake.reservoir_volume" in has,
        "A12": dossier.scenario.grade != 0.0,
    }
    return not drops.get(assumption.id, True)


def deciding_words(dossier: Dossier) -> str:
    """Name the assumptions that decide, for page one."""
    told = ["the law is told the train speed"] if dossier.law.told_speed else []
    return "; ".join([*(f"{each.id} {each.short}" for each in decisive(dossier)), *told])
