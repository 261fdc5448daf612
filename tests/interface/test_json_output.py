"""``--json``: exactly one documented object on standard output, with the numbers of the package."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from wspd_design.analysis.linearization import linearize
from wspd_design.cli.commands import simulate
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.records import Ending, Scenario

NUMBER = (int, float)
STOP = {
    "schema": str,
    "controller": str,
    "vehicle": str,
    "rail": str,
    "plant": str,
    "sample_time_s": NUMBER,
    "initial_speed_m_s": NUMBER,
    "scenario": dict,
    "witness": (dict, type(None)),
    "slip_reference": NUMBER,
    "ending": str,
    "distance_m": NUMBER,
    "stopping_time_s": NUMBER,
    "torque_integral_kNms": NUMBER,
    "bound_m": NUMBER,
    "efficiency": NUMBER,
    "adhesion_utilization": NUMBER,
    "lag_s": NUMBER,
    "plateau_m_s2": NUMBER,
    "slip_rms": NUMBER,
    "slip_mean": NUMBER,
    "slip_max": NUMBER,
    "lock_time_s": NUMBER,
    "valve_switches": int,
    "vented_air": NUMBER,
    "saturated_share": NUMBER,
    "momentum_residual": NUMBER,
    "energy_residual": NUMBER,
    "step_check": dict,
    "engine": str,
    "seed": int,
    "version": str,
}
SCENARIO = {
    "start": dict,
    "axle_rails": (list, type(None)),
    "patches": list,
    "grade": NUMBER,
    "pad_vibration": bool,
    "speed_noise_m_s": NUMBER,
    "pulses_per_turn": int,
    "reference_error": NUMBER,
    "dead_time_s": NUMBER,
}
START = {"slip": NUMBER, "torque_Nm": NUMBER, "braking_time_s": NUMBER}
WITNESS = {
    "check": str,
    "status": str,
    "same_problem": bool,
    "mass_kg": NUMBER,
    "wheelset_inertia_kg_m2": NUMBER,
    "mu0": NUMBER,
    "holding_torque_Nm": NUMBER,
    "left_after_s": (*NUMBER, type(None)),
}
STEP_CHECK = {
    "distance": NUMBER,
    "slip": NUMBER,
    "refinement": int,
    "chaotic": bool,
    "spread_m": NUMBER,
}
CAMPAIGN = {
    "schema": str,
    "controller": str,
    "vehicle": str,
    "rail": str,
    "plant": str,
    "sample_time_s": NUMBER,
    "initial_speed_m_s": NUMBER,
    "scenario": dict,
    "witness": (dict, type(None)),
    "runs": int,
    "runs_wanted": int,
    "complete": bool,
    "not_stopped_share": NUMBER,
    "sampled": list,
    "distance_m": dict,
    "stopping_time_s": dict,
    "lock_time_s": dict,
    "seed": int,
    "version": str,
}
SPREAD = {"min": NUMBER, "p05": NUMBER, "median": NUMBER, "p95": NUMBER, "max": NUMBER}
COMPARISON = {"schema": str, "stops": list, "version": str}
VERIFICATION = {
    "schema": str,
    "controller": str,
    "vehicle": str,
    "rail": str,
    "plant": str,
    "sample_time_s": NUMBER,
    "slip_reference": NUMBER,
    "slips": list,
    "speeds_m_s": list,
    "verdict": str,
    "checks": list,
    "seed": int,
    "version": str,
}
CHECK = {
    "name": str,
    "title": str,
    "claim": str,
    "status": str,
    "explanation": str,
    "limitation": bool,
    "margin": (dict, type(None)),
    "worst_point": list,
    "witness": list,
    "hypotheses": list,
    "assumptions": list,
    "method": str,
    "resolution": str,
    "reference": str,
    "model_hash": str,
    "seconds": NUMBER,
    "undecided": NUMBER,
    "engine": str,
    "proofs": list,
}
PROOF = {
    "claim": str,
    "statement": str,
    "claim_hash": str,
    "certificate": str,
    "leaves": int,
    "seconds": NUMBER,
}
LINEARIZATION = {
    "schema": str,
    "vehicle": str,
    "rail": str,
    "plant": str,
    "slip_reference": NUMBER,
    "valve_time_constant_s": NUMBER,
    "points": list,
    "version": str,
}
POINT = {
    "speed_m_s": NUMBER,
    "slip_pole_per_s": NUMBER,
    "gain_per_Nms": NUMBER,
    "poles_with_lag_per_s": list,
    "equilibrium_torque_Nm": NUMBER,
    "equilibrium_duty": NUMBER,
    "pole_beyond_lag": bool,
}
SLOW = ("--speed", "20 km/h")


def assert_form(found, form):
    assert list(found) == list(form)
    for key, kind in form.items():
        assert isinstance(found[key], kind), key


def refuse_constants(name):
    raise AssertionError(f"{name} is no JSON")


def only_object(outcome):
    """The one object of standard output; anything beside it, or NaN in it, is an error."""
    assert outcome.err == ""
    found = json.loads(outcome.out, parse_constant=refuse_constants)
    assert isinstance(found, dict)
    return found


def test_stop(wspd):
    found = only_object(
        wspd("simulate", "trenitalia", "--rail", "polach-dry", *SLOW, "--seed", "3", "--json")
    )
    assert_form(found, STOP)
    assert found["schema"] == "wspd-stop/1"
    assert (found["controller"], found["rail"], found["seed"]) == ("trenitalia", "polach-dry", 3)
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-dry")
    law = controller("trenitalia", vehicle, rail, Specification())
    scenario = Scenario.stop(from_kmh=20.0, rail=rail)
    made = trial(vehicle, law, scenario, slip_reference=Specification().slip)
    figures = made.metrics
    assert found["distance_m"] == figures.distance
    assert (found["bound_m"], found["efficiency"]) == (figures.bound, figures.efficiency)
    assert found["vented_air"] == figures.vented_air
    assert_form(found["step_check"], STEP_CHECK)
    assert found["step_check"]["distance"] == made.check.distance
    assert_form(found["scenario"], SCENARIO)
    assert_form(found["scenario"]["start"], START)
    assert found["witness"] is None
    assert found["plant"] == "four-axle"
    assert found["torque_integral_kNms"] == pytest.approx(figures.torque_integral / 1000.0, rel=1e-15)
    assert found["ending"] == "stopped"


def test_disturbances_are_recorded_and_change_the_stop(wspd):
    plain = only_object(wspd("simulate", "trenitalia", *SLOW, "--json"))
    options = (
        *("--axle-rails", "polach-wet,polach-wet,polach-dry,polach-dry", "--patch", "2 m low-adhesion"),
        *("--grade", "-5 permille", "--pad-vibration", "--speed-noise", "0.05 m/s", "--pulses", "80"),
        *("--reference-error", "2 %", "--dead-time", "40 ms"),
    )
    found = only_object(wspd("simulate", "trenitalia", *SLOW, *options, "--json"))
    assert_form(found["scenario"], SCENARIO)
    assert found["scenario"] == {
        "start": {"slip": 0.0, "torque_Nm": 0.0, "braking_time_s": 0.0},
        "axle_rails": ["polach-wet", "polach-wet", "polach-dry", "polach-dry"],
        "patches": [{"start_m": 2.0, "rail": "low-adhesion"}],
        "grade": -0.005,
        "pad_vibration": True,
        "speed_noise_m_s": 0.05,
        "pulses_per_turn": 80,
        "reference_error": 0.02,
        "dead_time_s": 0.04,
    }
    assert found["distance_m"] != pytest.approx(plain["distance_m"], rel=1e-3)
    assert found["bound_m"] is None  # not known for a change of rail
    assert found["efficiency"] is None


def test_stop_from_a_witness(wspd, witness_file):
    found = only_object(wspd("simulate", "smc", "--from-witness", witness_file, "--json"))
    unknown = ("bound_m", "efficiency", "lag_s", "plateau_m_s2")
    assert_form(found, STOP | dict.fromkeys(unknown, type(None)))
    assert_form(found["witness"], WITNESS)
    assert (found["witness"]["check"], found["witness"]["status"]) == ("open_loop_pole", "REFUTED")
    assert (found["plant"], found["scenario"]["start"]["slip"]) == ("quarter", 0.2)
    assert found["initial_speed_m_s"] == pytest.approx(10.0)
    assert found["witness"]["left_after_s"] > 0.0
    options = ("--from-witness", witness_file, "--runs", "2", "--nominal", "--json")
    many = only_object(wspd("simulate", "smc", *options))
    assert_form(many, CAMPAIGN)
    assert many["witness"] == {**found["witness"], "left_after_s": None}
    assert many["scenario"] == found["scenario"]
    assert many["distance_m"]["max"] == pytest.approx(found["distance_m"], rel=1e-9)


def test_a_chaotic_stop_gives_its_spread(wspd, monkeypatch):
    def chaotic(*arguments, **options):
        made = trial(*arguments, **options)
        return replace(made, check=replace(made.check, chaotic=True, spread=0.25, refinement=8))

    monkeypatch.setattr(simulate, "trial", chaotic)
    found = only_object(wspd("simulate", "none", *SLOW, "--json"))
    assert (found["step_check"]["chaotic"], found["step_check"]["spread_m"]) == (True, 0.25)
    shown = wspd("simulate", "none", *SLOW).out
    assert "chaotic" in shown
    assert "0.25 m" in shown


def test_campaign(wspd):
    found = only_object(wspd("simulate", "none", *SLOW, "--runs", "20", "--seed", "5", "--json"))
    assert_form(found, CAMPAIGN)
    assert found["schema"] == "wspd-campaign/1"
    assert (found["runs"], found["runs_wanted"], found["complete"], found["seed"]) == (20, 20, True, 5)
    assert {"vehicle.mass", "rail.mu0"} <= set(found["sampled"])
    assert_form(found["scenario"], SCENARIO)
    for name in ("distance_m", "stopping_time_s", "lock_time_s"):
        assert_form(found[name], SPREAD)
        assert sorted(found[name].values()) == list(found[name].values())
    assert found["distance_m"]["min"] < found["distance_m"]["max"]


def test_stop_of_a_design_file_takes_its_case(wspd, smc_file):
    found = only_object(wspd("simulate", smc_file.name, *SLOW, "--json"))
    assert (found["controller"], found["vehicle"], found["rail"]) == (
        "smc-er24pc-polach-wet",
        "er24pc",
        "polach-wet",
    )


def test_train_that_does_not_stop(wspd, monkeypatch):
    """Numbers that do not exist are null, the ending says why, and that is no error."""

    def endless(*arguments, **options):
        made = trial(*arguments, **options)
        figures = replace(made.metrics, lag=float("nan"), plateau=float("nan"))
        return replace(made, run=replace(made.run, ending=Ending.TIME_LIMIT), metrics=figures)

    monkeypatch.setattr(simulate, "trial", endless)
    outcome = wspd("simulate", "none", *SLOW, "--json")
    found = only_object(outcome)
    assert outcome.code == 0
    assert (found["ending"], found["lag_s"], found["plateau_m_s2"]) == ("time_limit", None, None)
    shown = wspd("simulate", "none", *SLOW)
    assert shown.code == 0
    assert "still moving at the time limit" in shown.out


def test_comparison(wspd):
    found = only_object(wspd("compare", "none", "knorr-bremse", *SLOW, "--json"))
    assert_form(found, COMPARISON)
    assert found["schema"] == "wspd-comparison/1"
    assert [stop["controller"] for stop in found["stops"]] == ["none", "knorr-bremse"]
    for stop in found["stops"]:
        assert_form(stop, STOP)


def test_verification(wspd):
    outcome = wspd("verify", "smc", "--only", "gain_positive", "--only", "surface_hurwitz", "--json")
    found = only_object(outcome)
    assert_form(found, VERIFICATION)
    assert found["schema"] == "wspd-verify/1"
    assert (outcome.code, found["verdict"]) == (0, "good")
    assert [check["name"] for check in found["checks"]] == ["surface_hurwitz", "gain_positive"]
    for check in found["checks"]:
        assert_form(check, CHECK)
        for proof in check["proofs"]:
            assert_form(proof, PROOF)
    assert set(found["checks"][1]["margin"]) == {"low", "high", "unit"}


def test_linearization(wspd):
    found = only_object(wspd("linearize", "--rail", "polach-dry", "--speed", "36 km/h", "--json"))
    assert_form(found, LINEARIZATION)
    assert found["schema"] == "wspd-linearization/1"
    (point,) = found["points"]
    assert_form(point, POINT)
    expected = linearize(load_vehicle("er24pc"), load_rail("polach-dry"), slip=0.14, speed=10.0)
    assert point["slip_pole_per_s"] == pytest.approx(expected.slip_pole, rel=1e-12)
    assert point["pole_beyond_lag"] == (expected.slip_pole > 1.0 / expected.time_constant)


def test_linearization_takes_the_speeds_in_the_order_given(wspd):
    found = only_object(wspd("linearize", "--speed", "10 km/h", "--speed", "5 m/s", "--json"))
    assert [point["speed_m_s"] for point in found["points"]] == pytest.approx([10.0 / 3.6, 5.0])


def test_all_keys_are_documented():
    document = (Path(__file__).parents[2] / "docs" / "json.md").read_text()
    tables = re.findall(r"^\| (`[^|]*`) \|", document, flags=re.MULTILINE)
    documented = {key for cell in tables for key in re.findall(r"`([^`]+)`", cell)}
    forms = (
        STOP,
        SCENARIO,
        START,
        WITNESS,
        STEP_CHECK,
        CAMPAIGN,
        SPREAD,
        COMPARISON,
        VERIFICATION,
        CHECK,
        PROOF,
        LINEARIZATION,
        POINT,
    )
    assert documented == {key for form in forms for key in form}
