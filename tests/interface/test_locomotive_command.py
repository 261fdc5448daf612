"""The plants with all degrees of freedom on the command line."""

import csv
import json

CASE = ("trenitalia", "--rail", "polach-wet", "--speed", "20 km/h", "--plant", "locomotive-linear")


def test_a_stop_on_irregular_track_with_its_traces(wspd):
    outcome = wspd("simulate", *CASE, "--irregularities", "low", "--json", "-o", "traces.csv")
    assert (outcome.code, outcome.err) == (0, "")
    found = json.loads(outcome.out)
    assert (found["plant"], found["scenario"]["irregularities"]) == ("locomotive-linear", "low")
    assert (found["ideal_stop_m"], found["efficiency"]) == (None, None)
    assert 8.0 < found["distance_m"] < 14.0
    with open("traces.csv", newline="") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    for name in ("wheel_load_left_N", "wheel_load_right_N", "lateral_position_m", "driveline_torque_Nm"):
        assert {f"{name}_{axle}" for axle in (1, 2, 3, 4)} <= set(rows[0])
    for row in rows[:: len(rows) // 5]:
        both = float(row["wheel_load_left_N_1"]) + float(row["wheel_load_right_N_1"])
        assert abs(0.5 * both / float(row["wheel_load_N_1"]) - 1.0) < 1e-6
    assert len({row["lateral_position_m_2"] for row in rows}) > 100


def test_what_a_plant_does_not_have_is_refused(wspd):
    for options, said in (
        (("--irregularities", "low"), 'take the plant "locomotive"'),
        (("--plant", "locomotive", "--load-spread", "4 %"), "irregularities of the track"),
        (("--plant", "locomotive", "--vehicle", "co-co"), "names no multibody file"),
        (("--plant", "locomotiv"), 'did you mean "locomotive"'),
        (("--plant", "locomotive", "--irregularities", "mid"), "it may be none, low, high"),
    ):
        outcome = wspd("simulate", "trenitalia", "--rail", "polach-wet", *options)
        assert outcome.code == 2, options
        assert said in " ".join(outcome.err.split()), options


def test_many_stops_tell_that_no_ideal_stop_is_known(wspd):
    # The wagon's model is compiled in a fifth of the time of the locomotive's.
    outcome = wspd(
        "simulate", *CASE, "--vehicle", "two-axle-wagon", "--speed", "10 km/h", "--runs", "2", "--json"
    )
    assert (outcome.code, outcome.err) == (0, "")
    found = json.loads(outcome.out)
    assert "vehicle.mass" in found["sampled"]
    assert "vehicle.body_height" not in found["sampled"]
