"""Records of a stop, a check, a design and a set of parameters as plain data, in the forms of the vocabulary."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.kernel.file import file_name
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.records import Certificate
from wspd_design.design.records import Design, Specification
from wspd_design.exchange.stop_forms import STOP
from wspd_design.exchange.study_forms import BRAKE
from wspd_design.exchange.version import program_version
from wspd_design.parameters.provenance import ParameterSet
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.law_memory import reference_range
from wspd_design.simulation.records import Fault, Scenario

if TYPE_CHECKING:
    from wspd_design.analysis.brake_sheet import BrakeSheet
    from wspd_design.analysis.linearization import Linearization


def stop_object(
    trial: Trial,
    scenario: Scenario,
    *,
    slip_reference: float,
    witness: dict[str, Any] | None = None,
    drawn: Mapping[str, float] | None = None,
) -> dict[str, Any]:
    """Return the figures of one stop; the witness is there if it starts at one, and numbers if it draws some."""
    run, figures, check = trial.run, trial.metrics, trial.check
    held = reference_range(run)
    return {
        "schema": STOP.schema,
        "controller": run.controller,
        "vehicle": run.vehicle,
        "rail": run.rail,
        "plant": run.plant,
        "sample_time_s": run.sample_time,
        "initial_speed_m_s": run.initial_speed,
        "scenario": scenario_object(scenario, dead_time=run.dead_time, shortest_pulse=run.shortest_pulse),
        "witness": witness,
        "drawn": None if drawn is None else dict(drawn),
        "slip_reference": slip_reference,
        "ending": run.ending.name.lower(),
        "distance_m": figures.distance,
        "stopping_time_s": figures.stopping_time,
        "torque_integral_Nms": figures.torque_integral,
        "ideal_stop_m": figures.ideal_stop,
        "ideal_ending": None if figures.ideal_ending is None else figures.ideal_ending.name.lower(),
        "efficiency": figures.efficiency,
        "released_below_m_s": figures.released_below,
        "adhesion_utilization": figures.adhesion_utilization,
        "build_up_s": figures.build_up,
        "build_up_distance_m": figures.build_up_distance,
        "lag_s": figures.lag,
        "lag_distance_m": run.initial_speed * figures.lag,
        "plateau_m_s2": figures.plateau,
        "slip_rms": figures.slip_rms,
        "slip_reached_s": figures.slip_reached,
        "held_slip_rms": figures.held_slip_rms,
        "slip_overshoot": figures.slip_overshoot,
        "slip_undershoot": figures.slip_undershoot,
        "perfect_slip_rms": figures.perfect_slip_rms,
        "slips_held": None if held is None else list(held),
        "slip_band": figures.slip_band,
        "speed_error": figures.speed_error,
        "distance_error": figures.distance_error,
        "slip_mean": figures.slip_mean,
        "slip_max": figures.slip_max,
        "lock_time_s": figures.lock_time,
        "longest_lock_s": figures.judged_lock,
        "valve_switches": figures.valve_switches,
        "vented_air": figures.vented_air,
        "air_used_Nl": figures.air_used,
        "lowest_reservoir_Pa": figures.lowest_reservoir,
        "watchdog_fills": figures.watchdog_fills,
        "saturated_share": figures.saturated_share,
        "momentum_residual": figures.momentum_residual,
        "energy_residual": figures.energy_residual,
        "step_check": {
            "distance_change": check.distance,
            "slip_change": check.slip,
            "refinement": check.refinement,
            "sensitive": check.sensitive,
            "unresolved": check.unresolved,
            "spread_m": check.spread,
        },
        "engine": run.engine,
        "seed": scenario.seed,
        "version": program_version(),
    }


def scenario_object(scenario: Scenario, *, dead_time: float, shortest_pulse: float) -> dict[str, Any]:
    """Return where a stop starts and what disturbs it; the valves have these times by scenario or vehicle."""
    rails, sensing, start = scenario.axle_rails, scenario.sensing, scenario.start
    loads = scenario.load_irregularity
    return {
        "start": {
            "slip": start.slip,
            "torque_Nm": start.torque,
            "braking_time_s": start.braking_time,
        },
        "axle_rails": None if rails is None else [rail.name for rail in rails],
        "patches": [{"from_m": patch.start, "rail": patch.rail.name} for patch in scenario.patches],
        "grade": scenario.grade,
        "pad_vibration": scenario.pad_vibration,
        "load_spread": 0.0 if loads is None else loads.spread,
        "irregularities": scenario.irregularities,
        "speed_noise_m_s": sensing.speed_noise,
        "pulses_per_turn": sensing.pulses_per_turn,
        "period_timing": sensing.period_timing,
        "reference_error": sensing.reference_error,
        "reference_drift_m_s2": sensing.reference_drift,
        "reference_noise_m_s": sensing.reference_noise,
        "torque_error": sensing.torque_error,
        "accelerometer_bias_m_s2": sensing.accelerometer_bias,
        "accelerometer_noise_m_s2": sensing.accelerometer_noise,
        "radius_errors": list(sensing.radius_errors),
        "faults": [fault_object(each) for each in scenario.faults],
        "dead_time_s": dead_time,
        "shortest_pulse_s": shortest_pulse,
    }


def fault_object(fault: Fault) -> dict[str, Any]:
    """Return what fails at a wheelset."""
    return {"axle": fault.axle, "kind": fault.kind, "since_s": fault.since}


def check_object(certificate: Certificate) -> dict[str, Any]:
    """Return a certificate without what is for plots and without times, which change from run to run."""
    return {
        "name": certificate.name,
        "title": certificate.title,
        "claim": certificate.claim,
        "status": certificate.status.name,
        "explanation": certificate.explanation,
        "margin": None if certificate.margin is None else asdict(certificate.margin),
        "worst_point": [asdict(point) for point in certificate.worst_point],
        "witness": [asdict(point) for point in certificate.witness],
        "hypotheses": [
            {"text": hypothesis.text, "status": hypothesis.status.name}
            for hypothesis in certificate.hypotheses
        ],
        "assumptions": list(certificate.assumptions),
        "method": certificate.method,
        "reference": certificate.reference,
        "model_hash": certificate.model_hash,
        "undecided_share": certificate.undecided,
        "varied": list(certificate.varied),
        "held": list(certificate.held),
        "searched_boxes": certificate.boxes,
        "search_cut": certificate.cut,
        "proofs": [
            _proof(key, found) | {"file": file_name(certificate)} for key, found in certificate.proved.items()
        ],
    }


def timed_check_object(certificate: Certificate) -> dict[str, Any]:
    """Return a certificate with its computing times and, in place of files, the text of its proofs."""
    proofs = [
        _proof(key, found) | {"certificate": json.dumps(found.stated.proof)}
        for key, found in certificate.proved.items()
    ]
    return check_object(certificate) | {"proofs": proofs, "computing_time_s": certificate.seconds}


def _proof(key: str, found: Finding) -> dict[str, Any]:
    return {"obligation": key, "statement": found.shown, "leaves": found.leaves}


def linearization_point_object(point: "Linearization") -> dict[str, Any]:
    """Return the slip linearized at one speed."""
    return {
        "speed_m_s": point.speed,
        "slip_pole_per_s": point.slip_pole,
        "gain_per_Nms": point.gain,
        "poles_with_lag_per_s": list(point.poles()),
        "equilibrium_torque_Nm": point.equilibrium_torque,
        "equilibrium_duty": point.equilibrium_duty,
        "pole_beyond_lag": bool(point.slip_pole > 1.0 / point.time_constant),
    }


def brake_object(sheet: "BrakeSheet") -> dict[str, Any]:
    """Return the brake of a vehicle on full adhesion."""
    return {
        "schema": BRAKE.schema,
        "vehicle": sheet.vehicle,
        "grade": sheet.grade,
        "rim_force_N": sheet.rim_force,
        "by_steps": sheet.by_steps,
        "rotating_mass_kg": sheet.rotating_mass,
        "demanded_adhesion": sheet.demanded_adhesion,
        "stops": [
            {
                "speed_m_s": each.speed,
                "equivalent_time_s": each.mean.equivalent_time,
                "deceleration_m_s2": each.mean.deceleration,
                "distance_m": each.mean.distance,
                "time_s": each.mean.time,
                "braked_weight_percentage": each.percentage,
            }
            for each in sheet.stops
        ],
        "version": program_version(),
    }


def design_object(design: Design) -> dict[str, Any]:
    """Return a design with its specification and the reasons of its gains."""
    return {
        "name": design.name,
        "law": design.law,
        "vehicle": design.vehicle,
        "vehicle_hash": design.vehicle_hash,
        "rail": design.rail,
        "specification": specification_object(design.specification),
        "gains": [asdict(gain) for gain in design.gains],
    }


def specification_object(wanted: Specification) -> dict[str, Any]:
    """Return what is asked of a law."""
    return {
        "slip_reference": wanted.slip,
        "slip_tolerance": wanted.slip_tolerance,
        "slips": list(wanted.slips),
        "speeds_m_s": list(wanted.speeds),
        "sample_time_s": wanted.sample_time,
    }


def parameters_object(parameters: ParameterSet) -> dict[str, Any]:
    """Return a set of parameters with the source of each number."""
    return {
        "kind": parameters.kind,
        "name": parameters.name,
        "title": parameters.title,
        "entries": [
            {
                "name": entry.name,
                "value_si": entry.value,
                "bounds_si": entry.bounds,
                "unit_of_file": entry.unit,
                "source": entry.source,
                "at": entry.at,
                "status": entry.status,
                "note": entry.note,
            }
            for entry in parameters.entries.values()
        ],
    }
