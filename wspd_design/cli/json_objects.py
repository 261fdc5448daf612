"""The objects that ``--json`` prints, documented in ``docs/json.md``. Keys end in their unit."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from wspd_design.analysis.linearization import Linearization
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.cli.console import program_version
from wspd_design.cli.from_witness import LEFT, Origin
from wspd_design.cli.summary import Summary
from wspd_design.design.case import Case
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.start import leaving_time


def stop_object(
    trial: Trial, scenario: Scenario, *, slip_reference: float, origin: Origin | None = None
) -> dict[str, Any]:
    """Return the figures of one stop, ``wspd-stop/1``; the origin is there if it starts at a witness."""
    run, figures, check = trial.run, trial.metrics, trial.check
    return {
        "schema": "wspd-stop/1",
        "controller": run.controller,
        "vehicle": run.vehicle,
        "rail": run.rail,
        "plant": run.plant,
        "sample_time_s": run.sample_time,
        "initial_speed_m_s": run.initial_speed,
        "scenario": scenario_object(scenario),
        "witness": None if origin is None else witness_object(origin, leaving_time(run, LEFT)),
        "slip_reference": slip_reference,
        "ending": run.ending.name.lower(),
        "distance_m": figures.distance,
        "stopping_time_s": figures.stopping_time,
        "torque_integral_kNms": figures.torque_integral / 1e3,
        "bound_m": figures.bound,
        "efficiency": figures.efficiency,
        "adhesion_utilization": figures.adhesion_utilization,
        "lag_s": figures.lag,
        "plateau_m_s2": figures.plateau,
        "slip_rms": figures.slip_rms,
        "slip_mean": figures.slip_mean,
        "slip_max": figures.slip_max,
        "lock_time_s": figures.lock_time,
        "valve_switches": figures.valve_switches,
        "vented_air": figures.vented_air,
        "saturated_share": figures.saturated_share,
        "momentum_residual": figures.momentum_residual,
        "energy_residual": figures.energy_residual,
        "step_check": {
            "distance": check.distance,
            "slip": check.slip,
            "refinement": check.refinement,
            "chaotic": check.chaotic,
            "spread_m": check.spread,
        },
        "engine": run.engine,
        "seed": scenario.seed,
        "version": program_version(),
    }


def scenario_object(scenario: Scenario) -> dict[str, Any]:
    """Return where a stop starts and what disturbs it."""
    rails, sensing, start = scenario.axle_rails, scenario.sensing, scenario.start
    return {
        "start": {
            "slip": start.slip,
            "torque_Nm": start.torque,
            "braking_time_s": start.braking_time,
        },
        "axle_rails": None if rails is None else [rail.name for rail in rails],
        "patches": [{"start_m": patch.start, "rail": patch.rail.name} for patch in scenario.patches],
        "grade": scenario.grade,
        "pad_vibration": scenario.pad_vibration,
        "speed_noise_m_s": sensing.speed_noise,
        "pulses_per_turn": sensing.pulses_per_turn,
        "reference_error": sensing.reference_error,
        "dead_time_s": sensing.dead_time,
    }


def witness_object(origin: Origin, left_after: float | None = None) -> dict[str, Any]:
    """Return the witness that a stop starts at, the numbers of the plant there and when the slip has left it."""
    return {
        "check": origin.witness.check,
        "status": origin.witness.status.name,
        "same_problem": origin.same_problem,
        "mass_kg": origin.vehicle.mass,
        "wheelset_inertia_kg_m2": origin.vehicle.wheelset_inertia,
        "mu0": origin.rail.mu0,
        "holding_torque_Nm": origin.holding_torque,
        "left_after_s": left_after,
    }


def campaign_object(
    summary: Summary, case: Case, scenario: Scenario, origin: Origin | None = None
) -> dict[str, Any]:
    """Return what many stops have in common and how they spread, ``wspd-campaign/1``."""
    campaign = summary.campaign
    return {
        "schema": "wspd-campaign/1",
        "controller": campaign.controller,
        "vehicle": case.vehicle.name,
        "rail": case.rail.name,
        "plant": campaign.plant,
        "sample_time_s": case.controller.sample_time,
        "initial_speed_m_s": scenario.initial_speed,
        "scenario": scenario_object(scenario),
        "witness": None if origin is None else witness_object(origin),
        "runs": len(campaign.table),
        "runs_wanted": summary.wanted,
        "complete": campaign.complete,
        "not_stopped_share": summary.not_stopped_share,
        "sampled": campaign.sampled,
        **{name: asdict(spread) for name, spread in summary.spreads.items()},
        "seed": scenario.seed,
        "version": program_version(),
    }


def comparison_object(stops: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return several stops in the order of the command line, ``wspd-comparison/1``."""
    return {"schema": "wspd-comparison/1", "stops": list(stops), "version": program_version()}


def verification_object(
    problem: Problem, certificates: Sequence[Certificate], *, plant: str, verdict: str
) -> dict[str, Any]:
    """Return the certificates of a closed loop, ``wspd-verify/1``; what is for plots is left out."""
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
    del fields["series"], fields["maps"]
    fields["status"] = certificate.status.name
    fields["hypotheses"] = [
        {"text": hypothesis.text, "status": hypothesis.status.name} for hypothesis in certificate.hypotheses
    ]
    return fields
