"""The report of a design: a dossier in, one HTML or PDF file out."""

import json
import os
from datetime import UTC, datetime
from pathlib import Path

from wspd_design.design.file import design_text
from wspd_design.parameters.errors import UserError
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Attachment, Document
from wspd_design.reporting.output import write_document
from wspd_design.reporting.record import report_record, sets_table
from wspd_design.reporting.sections.brake import brake
from wspd_design.reporting.sections.case import case
from wspd_design.reporting.sections.checks import certificate_files, checks
from wspd_design.reporting.sections.comparison import comparison
from wspd_design.reporting.sections.design import design
from wspd_design.reporting.sections.limits import limits, provenance
from wspd_design.reporting.sections.linearization import linearization
from wspd_design.reporting.sections.requirements import requirements
from wspd_design.reporting.sections.robustness import robustness
from wspd_design.reporting.sections.slip_equation import slip_equation
from wspd_design.reporting.sections.sources import sources
from wspd_design.reporting.sections.stop import stop
from wspd_design.reporting.sections.summary import summary, verdict
from wspd_design.reporting.sections.uncertainty import uncertainty
from wspd_design.reporting.template import BLANK, Template, template_text
from wspd_design.studies.dossier import Dossier

SECTIONS = (
    case,
    requirements,
    brake,
    slip_equation,
    design,
    linearization,
    checks,
    stop,
    uncertainty,
    robustness,
    comparison,
    sources,
    limits,
)


MEDIA_TYPES = {"controller": "text/x-python"}
"""Of the user's own files that are not TOML."""


def write_report(dossier: Dossier, *paths: str | Path, template: Template = BLANK) -> None:
    """Write the report of a design to files; the ending of a name, ``.html`` or ``.pdf``, chooses its format.

    The date in the report is now, or that of the environment variable ``SOURCE_DATE_EPOCH`` [s]; all else
    follows from the dossier.

    Parameters
    ----------
    dossier : Dossier
        What :func:`wspd_design.studies.dossier.dossier` returned.
    *paths : str or Path
        One file for each format wanted.
    template : Template, optional
        Logo, names and numbers of a company, of :func:`wspd_design.reporting.template.read_template`.

    Raises
    ------
    UserError
        If an ending is unknown, a file cannot be written, or ``SOURCE_DATE_EPOCH`` is not a number of seconds.
    """
    document = report_document(dossier, report_time(), template)
    for path in paths:
        write_document(document, path)


def report_document(dossier: Dossier, timestamp: datetime, template: Template = BLANK) -> Document:
    """Return the report of a design, not yet rendered."""
    law = dossier.law
    version = dict(dossier.provenance.versions)["wspd-design"]
    speed = numbers.quantity_in(dossier.scenario.initial_speed, "km/h")
    record = json.dumps(report_record(dossier), indent=1, ensure_ascii=False, allow_nan=False)
    return Document(
        title=f"Wheel slide protection: {law.name}",
        subtitle=f"{law.heading}, for {dossier.vehicle.name} on {dossier.rail.name}, from {speed}",
        status_line=f"wspd {version} · {timestamp:%Y-%m-%d %H:%M} UTC · seed {dossier.provenance.seed} · "
        f"inputs {dossier.provenance.input_hash[:12]}",
        verdict=verdict(dossier),
        summary=summary(dossier),
        blocks=tuple(block for section in SECTIONS for block in section(dossier)),
        provenance=provenance(dossier),
        attachments=(
            *_design(dossier),
            *(
                Attachment(
                    name=own.name,
                    media_type=MEDIA_TYPES.get(own.kind, "application/toml"),
                    content=own.text,
                    description=f"the {own.kind}, a file of its own",
                )
                for own in dossier.own_files
            ),
            Attachment(
                name="report.json",
                media_type="application/json",
                content=f"{record}\n",
                description="all numbers of this report",
            ),
            *_sets(dossier),
            *certificate_files(dossier),
            *_template_file(template),
        ),
        timestamp=timestamp,
        author=template.author or template.organization or f"wspd {version}",
        keywords=("wheel slide protection", law.heading, dossier.vehicle.name, dossier.rail.name),
        template=template,
    )


def _sets(dossier: Dossier) -> tuple[Attachment, ...]:
    if dossier.uncertainty is None:
        return ()
    return (
        Attachment(
            name="sets.csv",
            media_type="text/csv",
            content=sets_table(dossier.uncertainty),
            description="the drawn sets of the uncertainty, a row each",
        ),
    )


def _template_file(template: Template) -> tuple[Attachment, ...]:
    if template == BLANK:
        return ()
    return (
        Attachment(
            name="template.toml",
            media_type="application/toml",
            content=template_text(template),
            description="logo, names and numbers of this report, for wspd report --template",
        ),
    )


def _design(dossier: Dossier) -> tuple[Attachment, ...]:
    if dossier.design is None:
        return ()
    return (
        Attachment(
            name="design.toml",
            media_type="application/toml",
            content=design_text(dossier.design),
            description="the design, which every command takes in place of a controller's name",
        ),
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
