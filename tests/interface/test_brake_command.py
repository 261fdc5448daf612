"""``wspd brake``: the brake office's numbers of a vehicle, against the formulas by hand and a simulated stop."""

import json
from pathlib import Path

import jsonschema
import pytest

from wspd_design.exchange.files import read_schema

COACH = str(Path(__file__).parent / "vehicles" / "coach.toml")


def sheet(wspd, *options):
    outcome = wspd("brake", "--vehicle", COACH, *options, "--json")
    assert (outcome.code, outcome.err) == (0, "")
    found = json.loads(outcome.out)
    jsonschema.validate(found, read_schema("wspd-brake/1"))
    return found


def test_numbers_of_a_coach_by_hand(wspd):
    """EN 14531-1 written out with the coach's file: 4 x 6.6 kN m, R 0.46 m, 45 t, 4 x 130 kg m2."""
    found = sheet(wspd, "--speed", "120 km/h", "--speed", "75 km/h")
    force, rotating = 4 * 6600.0 / 0.46, 4 * 130.0 / 0.46**2
    assert found["rim_force_N"] == pytest.approx(force)
    assert found["rotating_mass_kg"] == pytest.approx(rotating)
    assert found["demanded_adhesion"] == pytest.approx(force / ((45e3 + rotating) * 9.81), rel=1e-3)
    for stop, speed in zip(found["stops"], (120.0 / 3.6, 75.0 / 3.6), strict=True):
        resistance = 600.0 + 8.0 * speed * 2.0 / 3.0 + 1.6 * speed**2 / 2.0
        late = force * (1.0 / 0.75 + 0.3) / (force + resistance)
        mean = (force + resistance) / (45e3 + rotating)
        assert stop["equivalent_time_s"] == pytest.approx(late)
        assert stop["deceleration_m_s2"] == pytest.approx(mean)
        assert stop["distance_m"] == pytest.approx(speed * late + speed**2 / (2.0 * mean))
    rated, other = found["stops"]
    assert rated["braked_weight_percentage"] == pytest.approx(83634.0 / rated["distance_m"] - 19.0)
    assert other["braked_weight_percentage"] is None


def test_the_distance_is_that_of_a_stop_without_slide(wspd):
    (stop,) = sheet(wspd, "--speed", "120 km/h")["stops"]
    simulated = wspd(
        "simulate", "none", "--vehicle", COACH, "--rail", "polach-dry", "--speed", "120 km/h", "--json"
    )
    assert stop["distance_m"] == pytest.approx(json.loads(simulated.out)["distance_m"], rel=0.01)


def test_grades_and_rails(wspd):
    steep = sheet(wspd, "--speed", "100 km/h", "--grade", "-1 in 60")
    (level,) = sheet(wspd, "--speed", "100 km/h")["stops"]
    assert steep["grade"] == pytest.approx(-1.0 / 60.0)
    assert steep["stops"][0]["distance_m"] > 1.1 * level["distance_m"]
    assert steep["stops"][0]["braked_weight_percentage"] is None
    said = " ".join(wspd("brake", "--vehicle", COACH, "--rail", "low-adhesion").out.split())
    assert "wheels slide without a protection" in said
    assert "EN 14531-1" in said
    assert "EN 16834" in said


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--grade=-10 %", "--vehicle", "weak.toml"), "does not stop"),
        (("--grade", "steep"), "grade"),
        (("--speed", "0 km/h"), "above 0"),
        (("--speed", "700 km/h"), "below"),
    ],
)
def test_what_is_refused(wspd, options, words):
    Path("weak.toml").write_text('base = "er24pc"\n[brake.max_torque]\nvalue = 5\nunit = "kN m"\n')
    outcome = wspd("brake", *options)
    assert (outcome.code, outcome.out) == (2, "")
    assert words in outcome.err
    assert len(outcome.err.splitlines()) == 1
