"""The numbers of a report for programs: the attached ``report.json``, described in ``reports/README.md``."""

import math
from dataclasses import asdict
from typing import Any

from wspd_design.certificates.kernel.file import file_name
from wspd_design.certificates.records import Certificate
from wspd_design.design.records import Design
from wspd_design.parameters.records import ParameterSet
from wspd_design.simulation.comparison import Trial
from wspd_design.studies.dossier import Dossier

SCHEMA = "wspd-report/1"


def report_record(dossier: Dossier) -> dict[str, Any]:
    """Return everything that a report states as plain data in SI units; traces and curves are left out.

    Parameters
    ----------
    dossier : Dossier
        What the report is about.

    Returns
    -------
    dict
        Ready for :func:`json.dumps`; numbers that do not exist are None.
    """
    record = {
        "schema": SCHEMA,
        "provenance": {**asdict(dossier.provenance), "versions": dict(dossier.provenance.versions)},
        "design": _design(dossier.design),
        "compared_designs": [_design(each) for each in dossier.compared_designs],
        "initial_speed": dossier.initial_speed,
        "linearizations": [
            {
                "speed": point.speed,
                "slip": point.slip,
                "slip_pole": point.slip_pole,
                "poles_with_lag": point.poles(),
                "gain": point.gain,
                "time_constant": point.time_constant,
                "equilibrium_torque": point.equilibrium_torque,
                "equilibrium_duty": point.equilibrium_duty,
            }
            for point in dossier.linearizations
        ],
        "checks": [_check(each) for each in dossier.certificates],
        "stops": [
            _stop(trial, lag) for trial, lag in zip(dossier.trials, dossier.lag_distances, strict=True)
        ],
        "parameters": [
            _parameters(each) for each in (dossier.vehicle, dossier.rail, *dossier.other_parameters)
        ],
    }
    finite: dict[str, Any] = _finite(record)
    return finite


def _design(design: Design) -> dict[str, Any]:
    return asdict(design)


def _check(certificate: Certificate) -> dict[str, Any]:
    # Times are no property of the design and would change the file with every run; the proofs have their own files.
    left_out = ("series", "maps", "seconds", "proofs")
    record = {key: value for key, value in asdict(certificate).items() if key not in left_out}
    hypotheses = [{"text": each.text, "status": each.status.name} for each in certificate.hypotheses]
    proofs = [
        {
            "claim": each.claim,
            "statement": each.statement,
            "claim_hash": each.claim_hash,
            "leaves": each.leaves,
            "file": file_name(certificate),
        }
        for each in certificate.proofs
    ]
    return record | {"status": certificate.status.name, "hypotheses": hypotheses, "proofs": proofs}


def _stop(trial: Trial, lag_distance: float) -> dict[str, Any]:
    run = trial.run
    return {
        "controller": run.controller,
        "vehicle": run.vehicle,
        "rail": run.rail,
        "plant": run.plant,
        "sample_time": run.sample_time,
        "initial_speed": run.initial_speed,
        "ending": run.ending.name,
        "lag_distance": lag_distance,
        **asdict(trial.metrics),
        "step_check": asdict(trial.check),
    }


def _parameters(parameters: ParameterSet) -> dict[str, Any]:
    record = asdict(parameters)
    return record | {"entries": list(record["entries"].values())}


def _finite(value: Any) -> Any:
    """JSON has no NaN and no infinity."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
