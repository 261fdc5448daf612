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
    "slip_reference": NUMBER,
    "ending": str,
    "distance_m": NUMBER,
    "stopping_time_s": NUMBER,
    "torque_integral_kNms": NUMBER,
    "lag_s": NUMBER,
    "plateau_m_s2": NUMBER,
    "slip_rms": NUMBER,
    "slip_mean": NUMBER,
    "slip_max": NUMBER,
    "lock_time_s": NUMBER,
    "valve_switches": int,
    "saturated_share": NUMBER,
    "momentum_residual": NUMBER,
    "energy_residual": NUMBER,
    "seed": int,
    "version": str,
}
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
    figures = trial(vehicle, law, scenario, slip_reference=Specification().slip).metrics
    assert found["distance_m"] == figures.distance
    assert found["torque_integral_kNms"] == pytest.approx(figures.torque_integral / 1000.0, rel=1e-15)
    assert found["ending"] == "stopped"


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
    forms = (STOP, COMPARISON, VERIFICATION, CHECK, LINEARIZATION, POINT)
    assert documented == {key for form in forms for key in form}
