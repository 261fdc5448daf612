"""The objects that ``--json`` prints, documented in ``docs/json.md``. Keys end in their unit."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from wspd_design.analysis.linearization import Linearization
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.cli.console import program_version
from wspd_design.simulation.comparison import Trial


def stop_object(trial: Trial, *, slip_reference: float, seed: int) -> dict[str, Any]:
    """Return the figures of one stop, ``wspd-stop/1``."""
    run, figures = trial.run, trial.metrics
    return {
        "schema": "wspd-stop/1",
        "controller": run.controller,
        "vehicle": run.vehicle,
        "rail": run.rail,
        "plant": run.plant,
        "sample_time_s": run.sample_time,
        "initial_speed_m_s": run.initial_speed,
        "slip_reference": slip_reference,
        "ending": run.ending.name.lower(),
        "distance_m": figures.distance,
        "stopping_time_s": figures.stopping_time,
        "torque_integral_kNms": figures.torque_integral / 1e3,
        "lag_s": figures.lag,
        "plateau_m_s2": figures.plateau,
        "slip_rms": figures.slip_rms,
        "slip_mean": figures.slip_mean,
        "slip_max": figures.slip_max,
        "lock_time_s": figures.lock_time,
        "valve_switches": figures.valve_switches,
        "saturated_share": figures.saturated_share,
        "momentum_residual": figures.momentum_residual,
        "energy_residual": figures.energy_residual,
        "seed": seed,
        "version": program_version(),
    }


def comparison_object(stops: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return several stops in the order of the command line, ``wspd-comparison/1``."""
    return {"schema": "wspd-comparison/1", "stops": list(stops), "version": program_version()}


def verification_object(
    problem: Problem, certificates: Sequence[Certificate], *, plant: str, verdict: str
) -> dict[str, Any]:
    """Return the certificates of a closed loop, ``wspd-verify/1``; series for plots are left out."""
    return {
        "schema": "wspd-verify/1",
        "controller": problem.controller.name,
        "vehicle": problem.vehicle.name,
        "rail": problem.rail.name,
        "plant": plant,
        "sample_time_s": problem.sample_time,
        "slip_reference": problem.slip,
        "slips": problem.slips,
        "speeds_m_s": problem.speeds,
        "verdict": verdict,
        "checks": [_check(certificate) for certificate in certificates],
        "seed": problem.seed,
        "version": program_version(),
    }


def linearization_object(
    points: Sequence[Linearization], *, plant: str, beyond_lag: Sequence[bool]
) -> dict[str, Any]:
    """Return linearizations over speed, ``wspd-linearization/1``."""
    first = points[0]
    return {
        "schema": "wspd-linearization/1",
        "vehicle": first.vehicle,
        "rail": first.rail,
        "plant": plant,
        "slip_reference": first.slip,
        "valve_time_constant_s": first.time_constant,
        "points": [
            {
                "speed_m_s": point.speed,
                "slip_pole_per_s": point.slip_pole,
                "gain_per_Nms": point.gain,
                "poles_with_lag_per_s": point.poles(),
                "equilibrium_torque_Nm": point.equilibrium_torque,
                "equilibrium_duty": point.equilibrium_duty,
                "pole_beyond_lag": beyond,
            }
            for point, beyond in zip(points, beyond_lag, strict=True)
        ],
        "version": program_version(),
    }


def _check(certificate: Certificate) -> dict[str, Any]:
    fields = asdict(certificate)
    del fields["series"]
    fields["status"] = certificate.status.name
    fields["hypotheses"] = [
        {"text": hypothesis.text, "status": hypothesis.status.name} for hypothesis in certificate.hypotheses
    ]
    return fields
