"""What the wizard says about an answer: the numbers are those of the package, and idle brakes get no advice."""

import math

import pytest

from wspd_design.analysis.linearization import linearize
from wspd_design.analysis.slip_pole import largest_slip_pole, valve_rate
from wspd_design.certificates.theorems.valve import integrals_of_slip
from wspd_design.cli.path_completion import common_start, last_part, paths
from wspd_design.cli.wizard import advice
from wspd_design.cli.wizard.asked_design import is_of_whole_vehicle
from wspd_design.cli.wizard.design_steps import design_steps
from wspd_design.cli.wizard.flow import complete
from wspd_design.cli.wizard.rail_steps import rail_steps
from wspd_design.cli.wizard.session import again, reviewing
from wspd_design.cli.wizard.steps import noted
from wspd_design.cli.wizard.vehicle_steps import vehicle_steps
from wspd_design.controllers.family import designed
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.design.certification import problem_of_case
from wspd_design.design.slip_choice import best_constant_slip, held_distance
from wspd_design.parameters.loading import available, load_rail, load_vehicle
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import Scenario

ALL = design_steps()
STEPS = {step.key: step for step in ALL}
SPEEDS = (10.0 / 3.6, 120.0 / 3.6)


def note(key, text, **answers):
    return noted(STEPS[key], text, complete(ALL, answers))


@pytest.mark.parametrize("law", [family.name for family in designed()])
def test_the_laws_that_the_valve_binds_are_those_of_the_theorem(law):
    if (
        law == "torque-feedback"
    ):  # whose gains are worked out for seconds: its step says that it reads the torque
        assert law not in advice.READS_SLIP_ALONE
        return
    if is_of_whole_vehicle({"law": law}):
        assert law not in advice.READS_SLIP_ALONE
        return
    bound = integrals_of_slip(problem_of_case(load_case(law, CaseOptions()))) == ""
    assert bound == (law in advice.READS_SLIP_ALONE)


def test_the_largest_pole_is_that_of_the_linearization():
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-dry")
    found = largest_slip_pole(vehicle, rail, slip=0.14, speeds=SPEEDS)
    assert linearize(vehicle, rail, slip=0.14, speed=found.speed).slip_pole == pytest.approx(found.pole)
    others = [linearize(vehicle, rail, slip=0.14, speed=kmh / 3.6).slip_pole for kmh in range(10, 121, 10)]
    assert found.pole >= max(others) - 1e-9
    assert valve_rate(vehicle) == pytest.approx(1 / 0.6)


def test_the_best_slip_stops_shorter_than_its_neighbors():
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-dry")
    best = best_constant_slip(vehicle, rail, SPEEDS[1])
    near = [held_distance(vehicle, rail, SPEEDS[1], best.slip + step) for step in (-0.01, 0.0, 0.01)]
    assert min(near) == near[1] == best.distance
    peak = ideal_stop(vehicle, Scenario(rail=rail, initial_speed=SPEEDS[1])).distance
    assert best.at_the_peak == peak < best.distance


def test_a_law_that_reads_the_slip_alone_is_told_what_the_valve_leaves():
    assert "slower than the valve" in note("law", "smc", rail="polach-wet")
    assert "no equilibrium is stable there" in note("law", "smc", rail="eurosprinter127")
    assert "cylinder pressure" in note("law", "torque-feedback")
    assert "judged by stops" in note("law", "observer-smc")


def test_the_slip_is_suggested_by_the_rail_and_its_cost_told():
    assert STEPS["slip"].suggestion(complete(ALL, {}) | {"x": ""}) == "0.14"
    dry = {"vehicle": "er24pc", "rail": "polach-dry", "law": "smc"}
    assert STEPS["slip"].suggestion(dry) == "0.03"
    said = note("slip", "0.14", rail="polach-dry")
    assert "slip 0.14 from 120 km/h stops in 214.3 m" in said
    assert "0.03, the best constant slip up to 0.3, takes 183.4 m" in said
    assert "no constant slip up to 0.3 stops shorter" in note("slip", "3 %", rail="polach-dry")
    assert STEPS["slip"].suggestion({**dry, "rail": "table10-dry"}) == "0.14"  # friction that does not fall
    assert STEPS["tolerance"].suggestion({**dry, "slip": "0.03"}) == "0.015"
    assert "counts only where it is constant" in note("slip", "0.14", law="observer-smc")


def test_the_sample_time_is_held_against_the_slip_pole():
    said = note("sample_time", "100 ms", rail="polach-dry", slip="0.14")
    pole = largest_slip_pole(load_vehicle("er24pc"), load_rail("polach-dry"), slip=0.14, speeds=SPEEDS).pole
    assert f"grows by a factor of {math.exp(0.1 * pole):.3g} within one sample" in said
    assert "sampled slip stabilizes up to 1.54 1/s, which is not enough" in said
    slow = note("sample_time", "20 ms", rail="polach-dry", slip="0.14", law="torque-feedback")
    assert f"grows by a factor of {math.exp(0.02 * pole):.3g}" in slow
    assert "stabilizes" not in slow


def test_a_brake_that_does_not_slide_is_told_so_and_gets_no_other_advice():
    coach = {"vehicle": "coach", "rail": "polach-wet"}
    assert "no wheel slides there and the protection stays idle" in note(
        "rail", "polach-wet", vehicle="coach"
    )
    for key, text in (("law", "smc"), ("slip", "0.14"), ("sample_time", "100 ms")):
        assert note(key, text, **coach) == ""
    assert STEPS["slip"].suggestion(coach) == "0.14"


@pytest.mark.parametrize("vehicle", available("vehicle"))
def test_every_vehicle_gets_advice_without_a_fault(vehicle):
    for law in ("smc", "torque-feedback"):
        answers = complete(ALL, {"vehicle": vehicle, "rail": "low-adhesion", "law": law})
        assert all(STEPS[key].note(answers[key], answers) for key in ("rail", "law", "slip", "sample_time"))


@pytest.mark.parametrize(
    "questions", [design_steps(), vehicle_steps(), rail_steps()], ids=["design", "vehicle", "rail"]
)
def test_each_question_has_help_beyond_its_key(questions):
    for step in questions:
        said = step.more()
        assert said.endswith(f"Key of the answer: {step.key}.")
        assert said != f"Key of the answer: {step.key}.", step.key
    assert "Units: s, ms, min." in STEPS["sample_time"].more()


def test_nothing_is_said_about_what_is_not_accepted():
    assert note("slip", "1.4") == ""
    assert note("rail", "own file") == ""


def test_the_review_tells_what_matters_about_each_line():
    answers = complete(ALL, {"rail": "polach-dry", "law": "smc", "slip": "0.14"})
    review = reviewing(ALL, answers)
    assert [option.value for option in review.options] == ["save", *answers]
    assert noted(review, "sample_time", answers) == note("sample_time", "100 ms", **answers)
    assert noted(review, "save", answers) == ""


def test_the_command_that_answers_the_same():
    answers = complete(ALL, {"rail": "polach-dry", "slip": "12 %"})
    assert again(ALL, answers, ["wspd", "new"]) == "wspd new --yes --set rail=polach-dry --set 'slip=12 %'"
    assert again(ALL, complete(ALL, {}), ["wspd", "new"]) == "wspd new --yes"


def test_paths_are_completed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "vehicles").mkdir()
    for name in ("coach7.toml", "coach8.toml", "coach.csv", ".hidden.toml", "vehicles/metro.toml"):
        (tmp_path / name).write_text("")
    assert paths("co", ".toml") == ["coach7.toml", "coach8.toml"]
    assert common_start(paths("co", ".toml")) == "coach"
    assert paths("", ".toml") == ["coach7.toml", "coach8.toml", "vehicles/"]
    assert paths("vehicles/", ".toml") == ["vehicles/metro.toml"]
    assert paths(f"{tmp_path}/v", ".toml") == [f"{tmp_path}/vehicles/"]
    assert paths("nowhere/x", ".toml") == []
    assert paths(".h", ".toml") == [".hidden.toml"]
    assert [last_part(each) for each in ("a/b.toml", "a/vehicles/")] == ["b.toml", "vehicles/"]
