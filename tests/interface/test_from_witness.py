"""``wspd simulate --from-witness``: from a refuted certificate to a stop that starts there."""

import csv
import json
import re

import pytest

from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import load_rail, load_vehicle


def words_of(outcome):
    assert (outcome.code, outcome.err) == (0, "")
    return " ".join(outcome.out.split())


def test_a_stop_says_where_it_starts_and_when_the_slip_has_left(wspd, witness_file):
    shown = words_of(wspd("simulate", "smc", "--from-witness", witness_file, "-o", "t.csv"))
    assert shown.startswith(
        "From the witness of open_loop_pole, REFUTED: slip 0.2, 36 km/h, mass 70000 kg, wheelset inertia 700 kg m2, "
        "mu0 0.3, full supply, and "
    )
    assert "which hold the slip there." in shown
    assert "about other numbers than this case" in shown  # the certificate in this test has no fingerprint
    assert "er24pc (quarter), from 36 km/h" in shown
    assert "build-up of the brake" not in shown
    (left, at) = re.search(
        r"0.05 away from where it began after ([\d.]+) s, at ([\d.]+) km/h", shown
    ).groups()
    with open("t.csv", newline="") as stream:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
    assert (rows[0]["time_s"], rows[0]["slip_1"], rows[0]["speed_m_s"]) == (0.0, 0.2, 10.0)
    first = next(row for row in rows if abs(row["slip_1"] - 0.2) > 0.05)
    assert float(left) == pytest.approx(first["time_s"], rel=5e-3)
    assert float(at) == pytest.approx(3.6 * first["speed_m_s"], rel=5e-3)


def test_the_whole_way_from_a_design(wspd, smc_file):
    assert wspd("certify", smc_file, "--rail", "polach-dry", "--only", "sampling").code == 1
    certificate = smc_file.parent / "smc.certificates" / "sampling.json"
    options = ("--rail", "polach-dry", "--from-witness", certificate)
    shown = words_of(wspd("simulate", smc_file, *options))
    assert "other numbers" not in shown
    found = json.loads(wspd("simulate", smc_file, *options, "--json").out)
    assert found["witness"]["same_problem"]
    stated = {point["name"]: point["value"] for point in json.loads(certificate.read_text())["witness"]}
    assert found["initial_speed_m_s"] == pytest.approx(stated["speed"] / 3.6)
    assert found["witness"]["mass_kg"] == stated["mass"]
    assert found["witness"]["mu0"] == stated["mu0"]
    assert found["scenario"]["start"]["slip"] == stated["slip"]
    assert "other numbers" in words_of(wspd("simulate", smc_file, "--from-witness", certificate))


def changed(path, **points):
    content = json.loads(path.read_text())
    units = {"torque": "N m"} | {point["name"]: point["unit"] for point in content["witness"]}
    kept = [point for point in content["witness"] if point["name"] not in points]
    added = [{"name": name, "value": value, "unit": units[name]} for name, value in points.items()]
    path.write_text(json.dumps(content | {"witness": kept + added}))


@pytest.mark.parametrize(
    ("points", "options", "words"),
    [
        ({"mu0": 1.0, "slip": 0.05}, (), "60 kN m per wheelset, all that the brake has; "),
        ({"torque": 5e3}, (), "5 kN m per wheelset, as the witness says; "),
        ({"slip": 0.0}, ("--grade", "-10 %"), "0 kN m per wheelset: even a released wheel"),
    ],
)
def test_why_the_stop_starts_with_its_torque(wspd, witness_file, points, options, words):
    changed(witness_file, **points)
    assert words in words_of(wspd("simulate", "smc", "--from-witness", witness_file, *options))


def test_the_slip_rests_at_first_on_either_plant(wspd, witness_file):
    options = ("--from-witness", witness_file, "-o", "t.csv", "--force")
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-wet")
    gain = slip_dynamics(vehicle, rail, 0.2, 10.0).gain
    for plant in ("quarter", "planar"):
        shown = words_of(wspd("simulate", "none", "--plant", plant, *options))
        assert f"er24pc ({plant})" in shown
        with open("t.csv", newline="") as stream:
            rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
        a, b = rows[:2]
        step = b["time_s"] - a["time_s"]
        # The brake fills from the first moment on: the rate of the slip is G times what it has added by then.
        added = gain * (b["torque_Nm_1"] - a["torque_Nm_1"])
        assert 0.0 < (b["slip_1"] - a["slip_1"]) / step < added


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--from-witness", "w.json"), ("name it", "wspd simulate mine.toml")),
        (("smc", "--from-witness", "w.json", "--speed", "100 km/h"), ("--speed", "leave one out")),
        (
            ("smc", "--from-witness", "w.json", "--axle-rails", ",".join(["polach-wet"] * 4)),
            ("--axle-rails", "mu0"),
        ),
        (("smc", "--from-witness", "w.json", "--runs", "9"), ("--runs", "--nominal")),
        (("smc", "--from-witness", "missing.json"), ("missing.json", "wspd certify")),
        (("smc", "--from-witness", "."), ("cannot be read", "wspd certify")),
        (("smc", "--from-witness", "smc.toml"), ("smc.toml", "not complete JSON")),
        (("smc", "--from-witness", "fast.json"), ("fast.json", "speed 600 km/h", "0.36 and 500 km/h")),
        (("smc", "--from-witness", "proved.json"), ("proved.json", "PROVED", "only REFUTED")),
        (("smc", "--from-witness", "w.json", "--plant", "half"), ("half", "quarter")),
    ],
    ids=lambda value: " ".join(value)[:40],
)
@pytest.mark.usefixtures("smc_file")
def test_wrong_use(wspd, witness_file, tmp_path, arguments, words):
    witness_file.rename(tmp_path / "w.json")
    text = (tmp_path / "w.json").read_text()
    (tmp_path / "fast.json").write_text(text)
    changed(tmp_path / "fast.json", speed=600.0)
    (tmp_path / "proved.json").write_text(json.dumps(json.loads(text) | {"status": "PROVED", "witness": []}))
    before = sorted(tmp_path.iterdir())
    outcome = wspd("simulate", *arguments)
    assert (outcome.code, outcome.out) == (2, "")
    assert outcome.err.startswith("wspd: ")
    assert outcome.err.count("\n") == 1
    for word in words:
        assert word in outcome.err
    assert sorted(tmp_path.iterdir()) == before
