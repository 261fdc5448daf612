"""``wspd modes``: modes and critical speeds in the terminal, as JSON and as a figure."""

import json

import pytest
from jsonschema import validate

from wspd_design.exchange.files import read_schema
from wspd_design.exchange.modes_forms import MODES
from wspd_design.parameters.files import data_file


def test_a_rolling_vehicle_has_its_modes_and_its_critical_speed(wspd):
    outcome = wspd("modes", "manchester-1", "--conicity", "0.4")
    assert (outcome.code, outcome.err) == (0, "")
    for word in ("car body bounce", "none grows", "Small deviations grow from 2", "estimates"):
        assert word in outcome.out


def test_json_has_its_form(wspd):
    found = json.loads(wspd("modes", "manchester-1", "--conicity", "0.1", "--conicity", "0.4", "--json").out)
    validate(found, read_schema(MODES.schema))
    assert [key.name for key in MODES.keys] == list(found)
    assert [each["conicity"] for each in found["critical_speeds"]] == [0.1, 0.4]
    assert found["critical_speeds"][0]["speed_m_s"] > found["critical_speeds"][1]["speed_m_s"] > 55.0
    bounce = next(mode for mode in found["modes"] if mode["name"] == "car body bounce")
    assert bounce["natural_frequency_Hz"] == pytest.approx(1.08, abs=0.01)
    assert bounce["shares"][0]["share"] > 0.9


def test_a_braked_vehicle_tells_what_grows_and_what_holds_it(wspd):
    outcome = wspd("modes", "er24pc-82", "--slip", "14 %", "--speed", "15 m/s", "--up-to", "1 Hz")
    assert outcome.code == 0
    for word in ("slip 1", "!", "The train slows down by", "70 % of the slope"):
        assert word in outcome.out
    assert "Small deviations" not in outcome.out


def test_reduced_lateral_creep_is_told(wspd):
    outcome = wspd("modes", "manchester-1", "--lateral-slope", "0.2", "--up-to", "1 Hz")
    assert "Lateral creep has 20 %" in " ".join(outcome.out.split())


def test_the_figure_is_the_same_each_time(wspd, tmp_path):
    files = [tmp_path / "a.svg", tmp_path / "b.svg"]
    for each in files:
        outcome = wspd("modes", "two-axle-wagon", "--plot", each)
        assert outcome.code == 0
        assert f"Written: {each}" in outcome.out
    first, second = (each.read_bytes() for each in files)
    assert first == second
    assert b"Poles over speed" in first


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["er24pc-83"], 'unknown vehicle "er24pc-83"'),
        (["metro"], "multibody"),
        (["manchester-1", "--slip", "1.5"], "slip"),
        (["manchester-1", "--conicity", "-1"], "conicity"),
        (["manchester-1", "--speed", "0 km/h"], "speed"),
        (["manchester-1", "--lateral-slope", "0"], "lateral slope"),
        (["manchester-1", "--plot", "modes.gif"], "must end in"),
    ],
)
def test_wrong_use_gets_one_sentence(wspd, words, sentence):
    outcome = wspd("modes", *words)
    assert outcome.code == 2
    assert sentence in outcome.err
    assert outcome.err.count("\n") == 1


def test_a_wheelset_without_a_brake_cannot_be_held_at_a_slip(wspd, tmp_path):
    text = data_file("multibody", "two-axle-wagon.toml").read_text()
    start = text.index("[brakes.")
    own = tmp_path / "wagon.toml"
    own.write_text(text[:start] + text[text.index("\n\n", start) :])
    assert wspd("modes", own).code == 0
    outcome = wspd("modes", own, "--slip", "0.14")
    assert outcome.code == 2
    assert "no brake" in outcome.err
