"""The files that travel inside a report: what it was made from, its numbers, its traces and its certificates."""

import hashlib
import json
from datetime import datetime
from pathlib import PurePath

from wspd_design.parameters.files import available, data_text
from wspd_design.parameters.provenance import ParameterSet
from wspd_design.parameters.schema import Kind
from wspd_design.reporting.blocks import Attachment
from wspd_design.reporting.record import report_record
from wspd_design.reporting.sections.checks import certificate_files
from wspd_design.reporting.sections.robustness import what_fails
from wspd_design.reporting.template import BLANK, Template, template_text
from wspd_design.simulation.runs import Run
from wspd_design.simulation.traces import on_a_grid, trace_name, traces
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.uncertainty import Uncertainty

RECORD, TEMPLATE, SUMS = "report.json", "template.toml", "SHA256SUMS"
OWN_INTERVAL, OTHER_INTERVAL = 0.02, 0.1  # s, between the rows of traces
_SHIPPED = "shipped-"


def attachments(dossier: Dossier, made_at: datetime, template: Template = BLANK) -> tuple[Attachment, ...]:
    """Return all attachments; the last one has the SHA-256 of each other."""
    record = json.dumps(report_record(dossier, made_at), indent=1, ensure_ascii=False, allow_nan=False)
    found = (
        *(
            Attachment(
                name=each.name, media_type=_media_type(each.name), content=each.text, description=each.meaning
            )
            for each in dossier.provenance.inputs
        ),
        *_shipped(dossier),
        Attachment(
            name=RECORD,
            media_type="application/json",
            content=f"{record}\n",
            description="all numbers of this report",
        ),
        *_traces(dossier),
        *_faulted_traces(dossier),
        *_sets(dossier),
        *certificate_files(dossier),
        *_template_file(template),
    )
    sums = "".join(f"{hashlib.sha256(each.content.encode()).hexdigest()}  {each.name}\n" for each in found)
    checked = Attachment(
        name=SUMS, media_type="text/plain", content=sums, description="SHA-256 of every other attachment"
    )
    return (*found, checked)


def _template_file(template: Template) -> tuple[Attachment, ...]:
    if template == BLANK:
        return ()
    return (
        Attachment(
            name=TEMPLATE,
            media_type="application/toml",
            content=template_text(template),
            description="logo, names and numbers of this report, for wspd report --template",
        ),
    )


def _media_type(name: str) -> str:
    endings = {".toml": "application/toml", ".py": "text/x-python", ".json": "application/json"}
    return endings.get(PurePath(name).suffix, "text/plain")


def _shipped(dossier: Dossier) -> tuple[Attachment, ...]:
    """Return the vehicle and the rail as the program has them, or what the user's own files start from."""
    return tuple(
        Attachment(
            name=f"{_SHIPPED}{name}.toml",
            media_type="application/toml",
            content=data_text(kind, name),
            description=f"{kind} {name} as it ships with the program",
        )
        for kind, used in _used(dossier)
        for name in _names(used)
        if name in available(kind)
    )


def _used(dossier: Dossier) -> tuple[tuple[Kind, ParameterSet], ...]:
    return ("vehicle", dossier.vehicle), ("rail", dossier.rail)


def _names(used: ParameterSet) -> list[str]:
    """Return the sets that the numbers of a set come from."""
    return sorted({entry.inherited for entry in used.entries.values() if entry.inherited}) or [used.name]


def _traces(dossier: Dossier) -> tuple[Attachment, ...]:
    """Return each stop as a table; that of the design has the finer grid."""
    return tuple(
        Attachment(
            name=trace_name(number, trial.run.controller),
            media_type="text/csv",
            content=trace_text(trial.run, OTHER_INTERVAL if number else OWN_INTERVAL),
            description=f"traces of the stop of {trial.run.controller}, a row every "
            f"{1e3 * (OTHER_INTERVAL if number else OWN_INTERVAL):g} ms"
            f"{'' if number else '; wspd simulate -o writes every step'}",
        )
        for number, trial in enumerate(dossier.trials)
    )


def _faulted_traces(dossier: Dossier) -> tuple[Attachment, ...]:
    """Return the stops of the design with a fault, or on patches, as tables."""
    found = () if dossier.robustness is None else dossier.robustness.stops
    return tuple(
        Attachment(
            name=f"{'patches' if each.fault is None else f'fault-{each.fault.kind}'}.csv",
            media_type="text/csv",
            content=trace_text(each.run, OTHER_INTERVAL),
            description=f"traces of the stop of the design, {what_fails(each)}, a row every "
            f"{1e3 * OTHER_INTERVAL:g} ms",
        )
        for each in found
        if each.run is not None
    )


def trace_text(run: Run, interval: float) -> str:
    """Return the traces of a stop as CSV with six digits, columns named with their unit."""
    table = on_a_grid(traces(run), interval)
    lines = [",".join(table.dtype.names or ())]
    lines += [",".join(f"{value:.6g}" for value in row) for row in table.tolist()]
    return "\n".join(lines) + "\n"


def _sets(dossier: Dossier) -> tuple[Attachment, ...]:
    if dossier.uncertainty is None:
        return ()
    return (
        Attachment(
            name="sets.csv",
            media_type="text/csv",
            content=sets_text(dossier.uncertainty),
            description="the drawn sets of the uncertainty: numbers and key figures, a row each, in SI units",
        ),
    )


def sets_text(found: Uncertainty) -> str:
    """Return the drawn sets as CSV with nine digits: the number of each, what it draws and its key figures."""
    lines = [",".join(("set", *found.drawn, *(each.name for each in found.spreads)))]
    for number, drawn in enumerate(found.numbers):
        row = (*drawn, *(each.values[number] for each in found.spreads))
        lines.append(",".join((str(number), *(f"{value:.9g}" for value in row))))
    return "\n".join(lines) + "\n"
