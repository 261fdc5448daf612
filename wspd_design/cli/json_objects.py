"""The objects that ``--json`` prints, in the forms of :mod:`wspd_design.exchange.vocabulary`."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.records import Certificate, Problem
from wspd_design.cli.from_witness import WitnessStart
from wspd_design.cli.summary import Summary
from wspd_design.design.case import Case
from wspd_design.exchange.campaign_forms import CAMPAIGN, CAMPAIGNS
from wspd_design.exchange.check_forms import VERIFICATION
from wspd_design.exchange.ladder_forms import LADDER
from wspd_design.exchange.objects import linearization_point_object, scenario_object, timed_check_object
from wspd_design.exchange.stop_forms import COMPARISON
from wspd_design.exchange.study_forms import LINEARIZATION
from wspd_design.exchange.version import program_version
from wspd_design.reporting.ladder_record import rungs_object
from wspd_design.simulation.records import Scenario

if TYPE_CHECKING:
    from wspd_design.analysis.linearization import Linearization
    from wspd_design.studies.ladder import Ladder


def witness_object(start: WitnessStart, left_after: float | None = None) -> dict[str, Any]:
    """Return the witness that a stop starts at, the numbers of the plant there and when the slip has left it."""
    return {
        "check": start.witness.check,
        "status": start.witness.status.name,
        "same_problem": start.same_problem,
        "mass_kg": start.vehicle.mass,
        "wheelset_inertia_kg_m2": start.vehicle.wheelset_inertia,
        "mu0": start.rail.mu0,
        "holding_torque_Nm": start.holding_torque,
        "left_after_s": left_after,
    }


def campaign_object(
    summary: Summary, case: Case, scenario: Scenario, start: WitnessStart | None = None
) -> dict[str, Any]:
    """Return what many stops have in common and how they spread."""
    campaign = summary.campaign
    return {
        "schema": CAMPAIGN.schema,
        "controller": campaign.controller,
        "vehicle": case.vehicle.name,
        "rail": case.rail.name,
        "plant": campaign.plant,
        "sample_time_s": case.controller.sample_time,
        "initial_speed_m_s": scenario.initial_speed,
        "scenario": scenario_object(
            scenario,
            dead_time=scenario.sensing.dead_time_of(case.vehicle.brake),
            shortest_pulse=scenario.sensing.shortest_pulse_of(case.vehicle.brake),
        ),
        "witness": None if start is None else witness_object(start),
        "runs": len(campaign.table),
        "runs_wanted": summary.wanted,
        "complete": campaign.complete,
        "not_stopped_share": summary.not_stopped_share,
        "sampled": campaign.sampled,
        **{name: asdict(spread) for name, spread in summary.spreads.items()},
        "check_every": campaign.check_every,
        "step_checks": asdict(summary.checks),
        "seed": scenario.seed,
        "version": program_version(),
    }


def campaigns_object(campaigns: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return campaigns of several laws and rails in the order of their file."""
    return {"schema": CAMPAIGNS.schema, "campaigns": list(campaigns), "version": program_version()}


def comparison_object(stops: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return several stops in the order of the command line."""
    return {"schema": COMPARISON.schema, "stops": list(stops), "version": program_version()}


def ladder_object(found: "Ladder", scenario: Scenario) -> dict[str, Any]:
    """Return the same stop on several models."""
    first = found.rungs[0].run
    return {
        "schema": LADDER.schema,
        "controller": found.controller,
        "vehicle": found.vehicle,
        "rail": found.rail,
        "initial_speed_m_s": found.initial_speed,
        "scenario": scenario_object(scenario, dead_time=first.dead_time, shortest_pulse=first.shortest_pulse),
        **rungs_object(found),
        "version": program_version(),
    }


def verification_object(
    problem: Problem, certificates: Sequence[Certificate], *, plant: str, verdict: str
) -> dict[str, Any]:
    """Return the certificates of a closed loop; what is for plots is left out."""
    return {
        "schema": VERIFICATION.schema,
        "controller": problem.controller.name,
        "vehicle": problem.vehicle.name,
        "rail": problem.rail.name,
        "plant": plant,
        "sample_time_s": problem.sample_time,
        "slip_reference": problem.slip,
        "slips": problem.slips,
        "speeds_m_s": problem.speeds,
        "verdict": verdict,
        "checks": [timed_check_object(certificate) for certificate in certificates],
        "seed": problem.seed,
        "version": program_version(),
    }


def linearization_object(points: "Sequence[Linearization]", *, plant: str) -> dict[str, Any]:
    """Return linearizations over speed."""
    first = points[0]
    return {
        "schema": LINEARIZATION.schema,
        "vehicle": first.vehicle,
        "rail": first.rail,
        "plant": plant,
        "slip_reference": first.slip,
        "valve_time_constant_s": first.time_constant,
        "points": [linearization_point_object(point) for point in points],
        "version": program_version(),
    }
