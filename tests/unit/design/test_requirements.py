"""Requirements and specifications: read and written without loss, and every fault in one becomes one sentence."""

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.design.file import read_design, write_design
from wspd_design.design.requirements import DrawnSets, Limit, read_requirements, requirements_text
from wspd_design.design.selection import shipped_design
from wspd_design.design.specification_file import read_task, shipped_specifications
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.draws import About, Choice, Draw, Normal, Uniform

WHOLE = """schema = "wspd-specification/1"
name = "mine"
law = "torque-feedback"
vehicle = "er24pc"
design_rail = "polach-dry"
slip = "12 %"
tolerance = "0.04"
speeds = ["15 km/h", "100 km/h"]
sample_time = "50 ms"
reference = "constant"

[sensors]
speed = "fastest-axle"
pressures = false

[requirements]
rails = ["polach-dry", "polach-wet"]
within_bounds = ["vehicle", "rail"]
certificates = ["open_loop_pole"]
held_out = { sets = 30, seed = 9000 }

[requirements.limits]
efficiency_mean = "95 %"
longest_lock = "100 ms"
stopping_distance = "0.9 km"

[requirements.stable_within]

[requirements.stop]
initial_speed = "100 km/h"
sensing.pulses_per_turn = 100
sensing.period_timing = true
grade = "-5 permille"

[requirements.draw]
vehicle.mass = { uniform = ["60 t", "80 t"] }
"stop.sensing.speed_noise" = { normal = ["0.05 m/s", "0.02 m/s"], within = ["0 m/s", "0.1 m/s"] }
stop.sensing.dead_time = { choice = ["0 ms", "20 ms"] }
vehicle.brake.fill_time = { about = "50 %" }

[search]
method = "random"
evaluations = 40
sets = 25
seed = 7
"""


@pytest.fixture
def read(tmp_path):
    def reading(text):
        path = tmp_path / "spec.toml"
        path.write_text(text)
        return read_task(str(path))

    return reading


def test_everything_that_is_written_counts(read):
    task = read(WHOLE)
    assert (task.name, task.law, task.vehicle, task.design_rail) == (
        "mine",
        "torque-feedback",
        "er24pc",
        "polach-dry",
    )
    wanted = task.specification
    assert (wanted.slip, wanted.slip_tolerance, wanted.sample_time) == (0.12, 0.04, 0.05)
    assert wanted.reference == "constant"
    assert wanted.sensors == Sensors(speed="fastest-axle", pressures=False)
    assert wanted.speeds == pytest.approx((15 / 3.6, 100 / 3.6))
    asked = task.requirements
    assert asked.rails == ("polach-dry", "polach-wet")
    assert asked.certificates == ("open_loop_pole",)
    assert asked.limits == (
        Limit(criterion="efficiency_mean", value=0.95),
        Limit(criterion="longest_lock", value=0.1),
        Limit(criterion="stopping_distance", value=900.0),
    )
    assert dict(asked.stop) == {
        "stop.initial_speed": pytest.approx(100 / 3.6),
        "stop.sensing.pulses_per_turn": 100.0,
        "stop.sensing.period_timing": 1.0,
        "stop.grade": -0.005,
    }
    assert set(asked.draws) == {
        Draw(name="vehicle.mass", distribution=Uniform(low=60e3, high=80e3)),
        Draw(
            name="stop.sensing.speed_noise", distribution=Normal(mean=0.05, deviation=0.02, low=0.0, high=0.1)
        ),
        Draw(name="stop.sensing.dead_time", distribution=Choice(values=(0.0, 0.02))),
        Draw(name="vehicle.brake.fill_time", distribution=About(share=0.5)),
    }
    assert (task.effort.method, task.effort.evaluations) == ("random", 40)
    assert task.effort.sets == DrawnSets(sets=25, seed=7)


def test_requirements_survive_being_written(read):
    text = WHOLE.replace("torque-feedback", "observer-smc").replace(
        "stable_within]", 'stable_within]\n"polach-wet" = "60 %"'
    )
    asked = read(text).requirements
    assert asked.stable_within == (("polach-wet", 0.6),)
    assert read_requirements(tomllib.loads(requirements_text(asked))["requirements"], "x") == asked
    third = replace(asked, limits=(Limit(criterion="speed_error", value=1 / 30),), draws=())
    assert read_requirements(tomllib.loads(requirements_text(third))["requirements"], "x") == third


def test_a_design_carries_its_requirements(read, tmp_path):
    task, path = read(WHOLE), tmp_path / "design.toml"
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-wet")
    made = shipped_design("knorr-bremse", vehicle, rail, task.specification)
    made = replace(made, requirements=task.requirements)
    write_design(made, path)
    assert read_design(path) == made


def test_files_are_seen_from_the_specification(read, tmp_path):
    (tmp_path / "leaves.toml").write_text('base = "low-adhesion"\n')
    (tmp_path / "train.toml").write_text('base = "er24pc"\n')
    text = WHOLE.replace('"polach-wet"]', '"leaves.toml"]').replace(
        'vehicle = "er24pc"', 'vehicle = "train.toml"'
    )
    task = read(text.replace('design_rail = "polach-dry"', 'design_rail = "leaves.toml"'))
    assert task.requirements.rails == ("polach-dry", str(tmp_path / "leaves.toml"))
    assert (task.vehicle, task.design_rail) == (str(tmp_path / "train.toml"), str(tmp_path / "leaves.toml"))


def test_the_specification_of_the_page_is_whole(read):
    page = (Path(__file__).parents[3] / "docs" / "design-to-requirements.md").read_text(encoding="utf-8")
    written, stable = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    task = read(written)
    assert (task.name, task.requirements.held_out.sets) == ("small", 200)
    asked = read(written.replace("torque-feedback", "observer-smc") + stable).requirements
    assert asked.stable_within == (("polach-wet", 1.0), ("polach-dry", 0.5))


@pytest.mark.parametrize("name", shipped_specifications())
def test_shipped_specifications_are_whole(name):
    task = read_task(name)
    assert task.name == name
    assert task.effort.sets.sets >= 100
    assert task.requirements.held_out.sets >= 200
    assert not {"table10-dry", "table10-wet"} & set(task.requirements.rails)  # locked wheels are best on them
    vehicle = load_vehicle(task.vehicle)
    nominal = {
        "vehicle.mass": vehicle.mass,
        "vehicle.wheelset_inertia": vehicle.wheelset_inertia,
        **{
            f"vehicle.brake.{name}": getattr(vehicle.brake, name)
            for name in ("max_torque", "fill_time", "vent_time", "supply_rate")
        },
    }
    drawn = {draw.name: draw.distribution for draw in task.requirements.draws}
    for number, value in nominal.items():
        spread = drawn[number].of(value, number)
        assert 0.19 * value < spread.high - value == pytest.approx(value - spread.low)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('schema = "wspd-specification/1"', 'schema = "1"', 'schema = "1" must be "wspd-specification/1"'),
        ('name = "mine"\n', "", "name is missing in"),
        (
            'law = "torque-feedback"',
            'law = "torque-feedbck"',
            r'law "torque-feedbck" cannot be tuned \(did you mean "torque-feedback"\?\)',
        ),
        ('slip = "12 %"', "slip = 0.12", "slip = 0.12 in .* must be text in quotes"),
        ('slip = "12 %"', 'slip = "12 m"', "slip .* has a unit of length, not of ratio"),
        ('slip = "12 %"', 'slpi = "12 %"', "unknown key slpi in .*; did you mean slip?"),
        ('speeds = ["15 km/h", "100 km/h"]', 'speeds = ["15 km/h"]', "must be two speeds with units"),
        (
            'reference = "constant"',
            'reference = "best"',
            'reference = "best" must be one of "constant", "falling"',
        ),
        ('reference = "constant"', "reference = 1", "reference in .* = 1 must be text"),
        ('speed = "fastest-axle"', 'speed = "gps"', 'sensors: speed = "gps" must be one of "told"'),
        ("pressures = false", "pressures = 0", r"sensors\.pressures = 0 in .* must be true or false"),
        ("pressures = false", "pressure = false", r"unknown key sensors\.pressure in"),
        ('rails = ["polach-dry", "polach-wet"]', "rails = []", "must be a list of texts, each once"),
        (
            '["polach-dry", "polach-wet"]',
            '["polach-dry", "polach-dry"]',
            "must be a list of texts, each once",
        ),
        (
            'within_bounds = ["vehicle", "rail"]',
            'within_bounds = ["rial"]',
            'names "rial"; it may name vehicle and',
        ),
        ("held_out = { sets = 30, seed = 9000 }", "", r"requirements\.held_out is missing"),
        ("sets = 30", "sets = 0", r"requirements\.held_out\.sets = 0 in .* must be a whole number from 1 to"),
        ("sets = 30", "sets = true", r"requirements\.held_out\.sets = True in .* must be a whole number"),
        ("seed = 9000", "seed = -1", r"held_out\.seed = -1 in .* must be a whole number from 0 to"),
        (
            "seed = 9000",
            "seed = 20",
            r"search\.seed = 7 and requirements\.held_out\.seed = 20 in .* share stops",
        ),
        (
            'efficiency_mean = "95 %"',
            'efficency_mean = "95 %"',
            r"did you mean requirements\.limits\.efficiency_mean\?",
        ),
        ('efficiency_mean = "95 %"', 'efficiency_mean = "95"', r"must lie in \(0, 1\), such as 0.95 or 95 %"),
        ('efficiency_mean = "95 %"', "efficiency_mean = nan", r"must lie in \(0, 1\), such as 0.95 or 95 %"),
        ('longest_lock = "100 ms"', 'longest_lock = "-1 s"', "must be finite and not negative"),
        ('longest_lock = "100 ms"', 'longest_lock = "100 m"', "unit of length, not of time"),
        ('longest_lock = "100 ms"', "longest_lock = 0.1", "must be text with its unit"),
        ('initial_speed = "100 km/h"\n', "", "lacks initial_speed"),
        (
            "sensing.pulses_per_turn",
            "sensing.pulses",
            r"requirements\.stop\.sensing\.pulses in .* is not a number of a",
        ),
        ("pulses_per_turn = 100", "pulses_per_turn = inf", "must be a finite number"),
        (
            'mass = { uniform = ["60 t", "80 t"] }',
            'mass = "60 t"',
            r"vehicle\.mass of \[draw\] in .* must be one of",
        ),
        ('about = "50 %"', 'about = "50 m"', "unit of length, not of ratio"),
        ('about = "50 %"', 'about = "150 %"', r"by 1\.5 of it must lie in \(0, 1\], such as 25 %"),
        ('about = "50 %"', 'about = "50 %", choice = ["1 s"]', "must be one of"),
        ('["60 t", "80 t"]', '["80 t", "60 t"]', "the first below the second"),
        (
            'stop.sensing.dead_time = { choice = ["0 ms", "20 ms"] }',
            "stop.sensing.period_timing = { choice = [0, 1] }",
            r"stop\.sensing\.period_timing stands in requirements\.stop and in",
        ),
        (
            "stable_within]",
            "stable_within]\npolach-wet = 1.0",
            "is known for observer-smc, not for torque-feedback",
        ),
        (
            "stable_within]",
            'stable_within]\npolach-wet = "120 %"',
            r"stable_within\.polach-wet in .* must lie in \(0, 1\]",
        ),
        ('method = "random"', 'method = "tpe"', "search.method = 'tpe' in .* must be one of cma, random"),
        (
            "evaluations = 40",
            "evaluations = 0",
            r"search\.evaluations = 0 in .* must be a whole number from 1",
        ),
        (
            "evaluations = 40",
            "evaluation = 40",
            r"unknown key search\.evaluation in .*; did you mean search\.evaluations",
        ),
        ("[search]", "[serach]", "unknown key serach in .*; did you mean search?"),
    ],
)
def test_a_fault_is_one_sentence(read, old, new, sentence):
    assert WHOLE.count(old) >= 1
    with pytest.raises(UserError, match=sentence) as raised:
        read(WHOLE.replace(old, new))
    assert "\n" not in str(raised.value)
    assert "spec.toml" in str(raised.value)


def test_an_unknown_name_offers_the_nearest():
    with pytest.raises(UserError, match=r'unknown specification "er24pc-20m".*er24pc-20ms'):
        read_task("er24pc-20m")
