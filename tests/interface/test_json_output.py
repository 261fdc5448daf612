"""``--json``: exactly one documented object on standard output, with the numbers of the package."""

import json
from dataclasses import replace

import pytest
from jsonschema import Draft202012Validator, ValidationError

from wspd_design.analysis.linearization import linearize
from wspd_design.cli.commands import simulate
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.exchange.campaign_forms import CAMPAIGN
from wspd_design.exchange.check_forms import VERIFICATION
from wspd_design.exchange.files import read_schema
from wspd_design.exchange.stop_forms import COMPARISON, STOP
from wspd_design.exchange.study_forms import LINEARIZATION
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending

SLOW = ("--speed", "20 km/h")


def assert_form(found, form):
    """The object has the form, and its schema in the package says so, with no key that the schema does not know."""
    assert found["schema"] == form.schema
    schema = read_schema(found["schema"])
    Draft202012Validator.check_schema(schema)
    Draft202012Validator(closed(schema)).validate(found)
    assert list(found) == [key.name for key in form.keys if key.always or key.name in found]


def closed(schema):
    """The same schema that refuses unknown keys: what we print is documented to the last key."""
    if isinstance(schema, list):
        return [closed(each) for each in schema]
    if not isinstance(schema, dict):
        return schema
    made = {key: closed(each) for key, each in schema.items()}
    return made | ({"additionalProperties": False} if schema.get("type") == "object" else {})


def refuse_constants(name):
    raise AssertionError(f"{name} is not JSON")


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
    assert (found["controller"], found["rail"], found["seed"]) == ("trenitalia", "polach-dry", 3)
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-dry")
    law = controller("trenitalia", vehicle, rail, Specification())
    scenario = Scenario.stop(from_kmh=20.0, rail=rail)
    made = trial(vehicle, law, scenario, slip_reference=Specification().slip)
    figures = made.metrics
    assert found["distance_m"] == figures.distance
    assert (found["ideal_stop_m"], found["efficiency"]) == (figures.ideal_stop, figures.efficiency)
    assert found["vented_air"] == figures.vented_air
    assert found["step_check"]["distance_change"] == made.check.distance
    assert found["witness"] is None
    assert found["plant"] == "planar"
    assert found["torque_integral_Nms"] == figures.torque_integral
    assert found["ending"] == "stopped"


def test_disturbances_are_recorded_and_change_the_stop(wspd):
    plain = only_object(wspd("simulate", "trenitalia", *SLOW, "--json"))
    options = (
        *("--axle-rails", "polach-wet,polach-wet,polach-dry,polach-dry", "--patch", "2 m low-adhesion"),
        *("--grade", "-5 permille", "--pad-vibration", "--speed-noise", "0.05 m/s", "--pulses", "80"),
        *("--reference-error", "2 %", "--reference-drift", "-0.05 m/s2", "--reference-noise", "0.1 m/s"),
        *("--torque-error", "-10 %", "--dead-time", "140 ms", "--shortest-pulse", "10 ms", "--period-timing"),
        *("--load-spread", "4 %", "--accelerometer-bias", "0.05 m/s2", "--accelerometer-noise", "0.1 m/s2"),
        *("--radius-errors", "0.5 %,0 %,0 %,-0.5 %", "--fault", "axle 2: valve-holds from 3 s"),
    )
    found = only_object(wspd("simulate", "trenitalia", *SLOW, *options, "--json"))
    assert found["scenario"].pop("load_spread") == pytest.approx(0.04, rel=0.1)
    assert found["scenario"] == {
        "start": {"slip": 0.0, "torque_Nm": 0.0, "braking_time_s": 0.0},
        "axle_rails": ["polach-wet", "polach-wet", "polach-dry", "polach-dry"],
        "patches": [{"from_m": 2.0, "rail": "low-adhesion"}],
        "grade": -0.005,
        "pad_vibration": True,
        "irregularities": "none",
        "speed_noise_m_s": 0.05,
        "pulses_per_turn": 80,
        "period_timing": True,
        "reference_error": 0.02,
        "reference_drift_m_s2": -0.05,
        "reference_noise_m_s": 0.1,
        "torque_error": -0.1,
        "accelerometer_bias_m_s2": 0.05,
        "accelerometer_noise_m_s2": 0.1,
        "radius_errors": [0.005, 0.0, 0.0, -0.005],
        "faults": [{"axle": 2, "kind": "valve-holds", "since_s": 3.0}],
        "dead_time_s": 0.14,
        "shortest_pulse_s": 0.01,
    }
    assert found["distance_m"] != pytest.approx(plain["distance_m"], rel=1e-3)
    assert found["ideal_stop_m"] is None  # not known for a change of rail
    assert found["efficiency"] is None


def test_stop_from_a_witness(wspd, witness_file):
    found = only_object(wspd("simulate", "smc", "--from-witness", witness_file, "--json"))
    assert_form(found, STOP)
    for key in ("ideal_stop_m", "ideal_ending", "efficiency", "lag_s", "lag_distance_m", "plateau_m_s2"):
        assert found[key] is None
    assert (found["witness"]["check"], found["witness"]["status"]) == ("open_loop_pole", "REFUTED")
    assert (found["plant"], found["scenario"]["start"]["slip"]) == ("quarter", 0.2)
    assert found["initial_speed_m_s"] == pytest.approx(10.0)
    assert found["witness"]["left_after_s"] > 0.0
    options = ("--from-witness", witness_file, "--runs", "2", "--nominal", "--json")
    many = only_object(wspd("simulate", "smc", *options))
    assert_form(many, CAMPAIGN)
    assert many["witness"] == {**found["witness"], "left_after_s": None}
    assert many["scenario"] == found["scenario"]
    coarse = 1e-3 if found["step_check"]["refinement"] > 1 else 1e-9  # many stops take the first steps
    assert many["distance_m"]["max"] == pytest.approx(found["distance_m"], rel=coarse)


def test_sensitive_and_unresolved_are_two_findings(wspd, monkeypatch):
    def sensitive(*arguments, **options):
        made = trial(*arguments, **options)
        return replace(made, check=replace(made.check, sensitive=True, spread=0.25))

    monkeypatch.setattr(simulate, "trial", sensitive)
    found = only_object(wspd("simulate", "none", *SLOW, "--json"))
    check = found["step_check"]
    assert (check["sensitive"], check["unresolved"], check["spread_m"]) == (True, False, 0.25)
    shown = wspd("simulate", "none", *SLOW).out
    assert "sensitive" in shown
    assert "unresolved" not in shown
    assert "0.25 m" in shown


def test_campaign(wspd):
    found = only_object(wspd("simulate", "none", *SLOW, "--runs", "20", "--seed", "5", "--json"))
    assert_form(found, CAMPAIGN)
    assert (found["runs"], found["runs_wanted"], found["complete"], found["seed"]) == (20, 20, True, 5)
    assert {"vehicle.mass", "rail.mu0"} <= set(found["sampled"])
    for name in ("distance_m", "stopping_time_s", "lock_time_s"):
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
    assert [stop["controller"] for stop in found["stops"]] == ["none", "knorr-bremse"]


def test_verification(wspd):
    outcome = wspd("verify", "smc", "--only", "gain_positive", "--only", "surface_hurwitz", "--json")
    found = only_object(outcome)
    assert_form(found, VERIFICATION)
    assert (outcome.code, found["verdict"]) == (0, "good")
    assert [check["name"] for check in found["checks"]] == ["surface_hurwitz", "gain_positive"]
    assert found["checks"][1]["proofs"][0]["certificate"].startswith("{")


def test_linearization(wspd):
    found = only_object(wspd("linearize", "--rail", "polach-dry", "--speed", "36 km/h", "--json"))
    assert_form(found, LINEARIZATION)
    (point,) = found["points"]
    expected = linearize(load_vehicle("er24pc"), load_rail("polach-dry"), slip=0.14, speed=10.0)
    assert point["slip_pole_per_s"] == pytest.approx(expected.slip_pole, rel=1e-12)
    assert point["pole_beyond_lag"] == (expected.slip_pole > 1.0 / expected.time_constant)


def test_linearization_takes_the_speeds_in_the_order_given(wspd):
    found = only_object(wspd("linearize", "--speed", "10 km/h", "--speed", "5 m/s", "--json"))
    assert [point["speed_m_s"] for point in found["points"]] == pytest.approx([10.0 / 3.6, 5.0])


def test_a_train_that_cannot_stop_has_no_ideal_stop(wspd):
    """Downhill with 8 % on a rail whose adhesion nowhere exceeds 0.08: words, and never a number."""
    case = (
        *("simulate", "none", "--plant", "quarter", "--rail", "low-adhesion", "--grade=-80 permille"),
        *("--speed", "60 km/h"),
    )
    found = only_object(wspd(*case, "--json"))
    assert_form(found, STOP)
    assert (found["ending"], found["ideal_ending"]) == ("runaway", "runaway")
    assert (found["ideal_stop_m"], found["efficiency"]) == (None, None)
    for shown in (wspd(*case).out, wspd("compare", *case[1:]).out):
        words = " ".join(shown.split())
        assert f"No ideal stop: {NO_IDEAL_STOP[Ending.RUNAWAY]}." in words
        assert "no controller stops shorter" not in words


def test_a_missing_or_unknown_key_is_caught(wspd):
    """The validation above can fail."""
    found = only_object(wspd("linearize", "--speed", "36 km/h", "--json"))
    point = found["points"][0]
    for spoiled in (
        {**found, "points": [{key: point[key] for key in point if key != "gain_per_Nms"}]},
        {**found, "points": [{**point, "gain": 1.0}]},
        {**found, "points": [{**point, "slip_pole_per_s": "fast"}]},
        {**found, "points": []},
    ):
        with pytest.raises(ValidationError):
            assert_form(spoiled, LINEARIZATION)
