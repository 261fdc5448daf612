"""The report of a design: a dossier in, one HTML or PDF file out."""

import os
from datetime import UTC, datetime
from pathlib import Path

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.taken import check_record
from wspd_design.reporting import numbers
from wspd_design.reporting.attachments import attachments
from wspd_design.reporting.blocks import Document
from wspd_design.reporting.output import write_document
from wspd_design.reporting.sections.assumptions import assumptions
from wspd_design.reporting.sections.brake import brake
from wspd_design.reporting.sections.case import case
from wspd_design.reporting.sections.changes import changes
from wspd_design.reporting.sections.checks import checks
from wspd_design.reporting.sections.comparison import comparison
from wspd_design.reporting.sections.design import design
from wspd_design.reporting.sections.hazards import hazards
from wspd_design.reporting.sections.ladder import ladder
from wspd_design.reporting.sections.limits import limits
from wspd_design.reporting.sections.linearization import linearization
from wspd_design.reporting.sections.replay import provenance, replay
from wspd_design.reporting.sections.requirements import requirements
from wspd_design.reporting.sections.robustness import robustness
from wspd_design.reporting.sections.slip_equation import slip_equation
from wspd_design.reporting.sections.sources import sources
from wspd_design.reporting.sections.stop import stop
from wspd_design.reporting.sections.summary import summary, verdict
from wspd_design.reporting.sections.theory import theory
from wspd_design.reporting.sections.tool import tool
from wspd_design.reporting.sections.uncertainty import uncertainty
from wspd_design.reporting.sections.words import words
from wspd_design.reporting.template import BLANK, Template
from wspd_design.studies.dossier import Dossier

SECTIONS = (
    requirements,
    assumptions,
    hazards,
    limits,
    case,
    brake,
    slip_equation,
    design,
    linearization,
    checks,
    stop,
    ladder,
    uncertainty,
    robustness,
    comparison,
    sources,
    theory,
    replay,
    tool,
    changes,
)


def write_report(dossier: Dossier, *paths: str | Path, template: Template = BLANK) -> None:
    """Write the report of a design to files; the ending of a name, ``.html`` or ``.pdf``, chooses its format.

    The date in the report is now, or that of the environment variable ``SOURCE_DATE_EPOCH`` [s]; all else
    follows from the dossier.

    Parameters
    ----------
    dossier : Dossier
        What :func:`wspd_design.dossier` returned.
    *paths : str or Path
        One file for each format wanted.
    template : Template, optional
        Logo, names and numbers of a company, of ``wspd_design.reporting.template.read_template``.

    Raises
    ------
    UserError
        If an ending is unknown, a file cannot be written, or ``SOURCE_DATE_EPOCH`` is not a number of seconds.
    """
    remedy = "make one, dossier(design, vehicle=vehicle, rail=rail, scenario=stop)"
    check_record(dossier, Dossier, by="write_report", remedy=remedy)
    document = report_document(dossier, report_time(), template)
    for path in paths:
        write_document(document, path)


def report_document(dossier: Dossier, timestamp: datetime, template: Template = BLANK) -> Document:
    """Return the report of a design, not yet rendered."""
    law, origin = dossier.law, dossier.provenance
    speed = numbers.quantity_in(dossier.scenario.initial_speed, "km/h")
    blocks = tuple(block for section in SECTIONS for block in section(dossier))
    return Document(
        title=f"Wheel slide protection: {law.name}",
        subtitle=f"{law.heading}, for {dossier.vehicle.name} on {dossier.rail.name}, from {speed}",
        status_line=f"wspd {origin.program_version} · {timestamp:%Y-%m-%d %H:%M} UTC · seed {origin.seed} · "
        f"inputs {origin.input_hash[:12]}",
        verdict=verdict(dossier),
        summary=summary(dossier),
        blocks=(*blocks, *words(blocks)),
        provenance=provenance(dossier),
        attachments=attachments(dossier, timestamp, template),
        timestamp=timestamp,
        author=template.author or template.organization or f"wspd {origin.program_version}",
        keywords=("wheel slide protection", law.heading, dossier.vehicle.name, dossier.rail.name),
        template=template,
    )


def report_time() -> datetime:
    """Return the date of a report: now, or that of ``SOURCE_DATE_EPOCH``."""
    stated = os.environ.get("SOURCE_DATE_EPOCH")
    if stated is None:
        return datetime.now(UTC).replace(microsecond=0)
    try:
        return datetime.fromtimestamp(int(stated), UTC)
    except (ValueError, OverflowError, OSError):
        raise UserError(
            f'SOURCE_DATE_EPOCH = "{stated}" must be a whole number of seconds since 1970; unset it'
        ) from None
