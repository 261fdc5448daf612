"""The numbers of a report for programs: the attached ``report.json``, described in ``docs/json.md``."""

import math
from dataclasses import asdict
from datetime import datetime
from typing import Any

from wspd_design.exchange.objects import (
    brake_object,
    check_object,
    design_object,
    fault_object,
    linearization_point_object,
    parameters_object,
    specification_object,
    stop_object,
)
from wspd_design.exchange.plain import finite
from wspd_design.exchange.study_forms import REPORT
from wspd_design.exchange.version import program_version
from wspd_design.reporting.ladder_record import rungs_object
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.faults import FaultedStop, Robustness
from wspd_design.studies.judgment import Requirement
from wspd_design.studies.key_figures import Outcome
from wspd_design.studies.next_step import Alternative
from wspd_design.studies.provenance import Provenance
from wspd_design.studies.uncertainty import Uncertainty


def report_record(dossier: Dossier, made_at: datetime) -> dict[str, Any]:
    """Return everything that a report states as plain data; traces and curves are left out.

    Parameters
    ----------
    dossier : Dossier
        What the report is about.
    made_at : datetime
        Of the report.

    Returns
    -------
    dict
        Ready for :func:`json.dumps`; numbers that do not exist are None.
    """
    reference = dossier.specification.slip
    sets = (dossier.vehicle, dossier.rail, *dossier.other_parameters)
    record: dict[str, Any] = finite(
        {
            "schema": REPORT.schema,
            "provenance": _provenance(dossier.provenance, made_at),
            "law": {
                key: getattr(dossier.law, key)
                for key in ("name", "title", "origin", "acts_on", "fingerprint")
            },
            "design": None if dossier.design is None else design_object(dossier.design),
            "specification": specification_object(dossier.specification),
            "compared_designs": [design_object(each) for each in dossier.compared_designs],
            "brake": brake_object(dossier.brake),
            "linearizations": [linearization_point_object(point) for point in dossier.linearizations],
            "checks": [check_object(each) for each in dossier.certificates],
            "requirements": [_requirement(each) for each in dossier.judgment.rows],
            "verdict": dossier.judgment.verdict,
            "alternatives": []
            if dossier.next_step is None
            else [_alternative(each) for each in dossier.next_step.tried],
            "stops": [
                stop_object(trial, dossier.scenario, slip_reference=reference) for trial in dossier.trials
            ],
            "faulted_stops": []
            if dossier.robustness is None
            else [_faulted_stop(each, dossier.robustness) for each in dossier.robustness.stops],
            "uncertainty": None if dossier.uncertainty is None else _uncertainty(dossier.uncertainty),
            "ladder": None if dossier.ladder is None else rungs_object(dossier.ladder),
            "parameters": [parameters_object(each) for each in sets],
            "version": program_version(),
        }
    )
    return record


def _requirement(row: Requirement) -> dict[str, Any]:
    return {
        "id": row.id,
        "requirement": row.name,
        "title": row.title,
        "limit": row.limit,
        "reached": row.reached,
        "perfect": row.perfect,
        "margin": row.margin,
        "outcome": row.outcome.name.lower(),
        "evidence": row.evidence,
        "checks": list(row.checks),
        "source": row.source,
        "verified": row.verified,
        "remark": row.remark,
    }


def _alternative(tried: Alternative) -> dict[str, Any]:
    return {
        "law": tried.law,
        "sample_time_s": tried.sample_time,
        "missed": list(tried.missed),
        "distance_m": tried.distance,
    }


def _provenance(made: Provenance, made_at: datetime) -> dict[str, Any]:
    return {
        **asdict(made),
        "made_at": made_at.isoformat(),
        "inputs": [{"name": each.name, "sha256": each.sha256} for each in made.inputs],
        "input_hash": made.input_hash,
        "versions": dict(made.versions),
    }


def _uncertainty(found: Uncertainty) -> dict[str, Any]:
    return {
        "sets": found.sets,
        "seed": found.seed,
        "drawn": list(found.drawn),
        "held": list(found.held),
        "unstopped": found.unstopped,
        "checked": found.checked,
        "step_change": found.step_change,
        "numerical_m": found.numerical,
        "spreads": [
            {
                "name": each.name,
                "nominal": each.nominal,
                "low": each.low,
                "high": each.high,
                "p05": each.p05,
                "p95": each.p95,
                "worst": {**asdict(each.worst), "parameters": dict(each.worst.parameters)},
            }
            for each in found.spreads
        ],
        "effects": [
            {
                "name": each.name,
                "bounds_si": [each.low, each.high],
                "at_low": _known(each.at_low),
                "at_high": _known(each.at_high),
            }
            for each in found.effects
        ],
        "variants": [
            {"subject": each.subject, "words": each.words, "figures": _known(each.outcome)}
            for each in found.variants
        ],
    }


def _known(outcome: Outcome) -> dict[str, float]:
    return {name: value for name, value in outcome if math.isfinite(value)}


def _faulted_stop(stop: FaultedStop, found: Robustness) -> dict[str, Any]:
    return {
        "fault": None if stop.fault is None else fault_object(stop.fault),
        "stopped": stop.stopped,
        "distance_m": stop.distance,
        "longest_locks_s": list(stop.locks),
        "holds": found.holds(stop),
    }
