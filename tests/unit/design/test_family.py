"""A family of laws is one row: a fourth one is designed, written, read, built, simulated and verified by its name."""

from dataclasses import dataclass, replace
from typing import Annotated

import pytest

from wspd_design.certificates.memory import remembering
from wspd_design.certificates.records import Status
from wspd_design.certificates.suite import verify
from wspd_design.controllers.family import FAMILIES, Family, Given
from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.protocol import pulse_width
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.design.file import read_design, write_design
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Gain, Specification, in_the_law
from wspd_design.design.selection import RULES, GainRules, design_controller
from wspd_design.model.number import clip
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate


@dataclass(frozen=True, slots=True, kw_only=True)
class ProportionalIntegralGains:
    slip_reference: float
    proportional: Annotated[float, Quantity(dimension="1/speed")]
    integral: Annotated[float, Quantity(dimension="ratio")]


@dataclass(frozen=True, slots=True, kw_only=True)
class ProportionalIntegral:
    name: str
    sample_time: float
    wheel_radius: float
    gains: ProportionalIntegralGains

    @property
    def slip_reference(self):
        return self.gains.slip_reference

    def start(self, _):
        return (0.0,)

    def step(self, state, seen):
        (total,) = state
        slide = seen.speed - self.wheel_radius * seen.wheel_speed
        error = self.gains.slip_reference * seen.speed - slide
        duty = self.gains.proportional * error + self.gains.integral * total
        return (total + self.sample_time * error,), pulse_width(clip(duty, 0.0, 1.0))


def build(given: Given):
    return ProportionalIntegral(
        name=given.name,
        sample_time=given.sample_time,
        wheel_radius=given.vehicle.wheel_radius,
        gains=given.numbers,
    )


def choose(vehicle, rail, specification):
    return (
        Gain(name="proportional", value=0.5, unit="s/m", why=f"by hand for {vehicle.name}"),
        Gain(
            name="integral", value=20.0, unit="%", why=f"by hand for {rail.name} and {specification.slip:g}"
        ),
    )


@pytest.fixture
def fourth(monkeypatch):
    row = Family(
        name="pi",
        title="proportional and integral feedback of the slide",
        origin="a test",
        law=ProportionalIntegral,
        gains=ProportionalIntegralGains,
        build=build,
    )
    monkeypatch.setitem(FAMILIES, "pi", row)
    monkeypatch.setitem(RULES, "pi", GainRules(choose=choose))


@pytest.mark.usefixtures("fourth")
def test_a_fourth_family_touches_one_file(er24pc, tmp_path):
    rail, specification = load_rail("polach-wet"), Specification(sample_time=0.02)
    made = design_controller(er24pc, rail, specification, law="pi")
    path = tmp_path / "pi.toml"
    write_design(made, path)
    assert read_design(path) == made
    case = load_case(str(path), CaseOptions())
    assert case.controller.gains == ProportionalIntegralGains(
        slip_reference=0.14, proportional=0.5, integral=0.2
    )
    assert load_case("pi", CaseOptions(sample_time="20 ms")).controller.gains == case.controller.gains
    run = simulate(er24pc, case.controller, Scenario(rail=rail, initial_speed=20.0), plant="quarter")
    assert run.ending is Ending.STOPPED
    problem = stability_problem(er24pc, rail, case.controller, specification)
    found = {each.name: each.status for each in verify(problem, only=("no_go", "reaching", "routh_lag"))}
    # It feeds back the slip alone, so that the no-go theorem speaks about it, and no theorem of another family does.
    assert found["no_go"] in (Status.PROVED, Status.VACUOUS)
    assert found["reaching"] is found["routh_lag"] is Status.NOT_APPLICABLE


@pytest.mark.usefixtures("fourth")
def test_gains_are_chosen_once_for_the_same_question(er24pc, monkeypatch):
    asked = []

    def counted(vehicle, rail, specification):
        asked.append((vehicle.mass, rail.name, specification.slip))
        return choose(vehicle, rail, specification)

    monkeypatch.setitem(RULES, "pi", GainRules(choose=counted))
    wet, heavier = load_rail("polach-wet"), replace(er24pc, mass=1.01 * er24pc.mass)
    others = [(er24pc, load_rail("polach-dry"), Specification()), (er24pc, wet, Specification(slip=0.1))]
    questions = [(er24pc, wet, Specification()), (heavier, wet, Specification()), *others]
    with remembering():
        made = [[design_controller(*each, law="pi") for each in questions] for _ in range(2)]
    assert made[0] == made[1]
    assert len(asked) == len(set(asked)) == len(questions)
    design_controller(*questions[0], law="pi")
    assert len(asked) == len(questions) + 1


@pytest.mark.usefixtures("fourth")
def test_a_family_without_a_rule_is_told(er24pc, monkeypatch):
    monkeypatch.delitem(RULES, "pi")
    with pytest.raises(UserError, match="no rule chooses the gains of pi"):
        design_controller(er24pc, load_rail("polach-wet"), Specification(), law="pi")


def test_every_row_has_what_tables_show():
    for name, family in FAMILIES.items():
        assert family.name == name
        assert family.title
        assert family.origin
        assert (family.gains is None) or family.tables is None
        assert family.heading[0].isupper()
    assert set(RULES) == {name for name, family in FAMILIES.items() if family.gains is not None}


FORMS = {form.name: form for form in FAMILIES["afsmc"].forms}


@pytest.mark.parametrize(
    ("name", "value", "unit", "torque_unit", "expected"),
    [
        ("weight_rate", 92307.69230769229, "N m/s", 1e3, 92.30769230769229),
        ("weight_rate", 92.30769230769229, "kN m/s", 1e3, 92.30769230769229),
        ("weight_rate", 10.0, "1/s", 1e3, 10.0),
        ("initial_weights", (1000.0, 2000.0), "N m", 1e3, (1.0, 2.0)),
        ("initial_weights", (1.0, 2.0), "kN m", 10.0, (100.0, 200.0)),
        ("initial_bound", 1.0, "-", 1e3, 1.0),
        ("torque_unit", 1.0, "kN m", 1e3, 1000.0),
        ("boundary_layer", 2.5, "%", 1e3, 0.025),
        ("dead_zone", True, "-", 1e3, True),
    ],
)
def test_units_convert(name, value, unit, torque_unit, expected):
    found = in_the_law(Gain(name=name, value=value, unit=unit, why=""), FORMS[name], torque_unit)
    assert found == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("name", "unit", "words"),
    [
        ("weight_rate", "kN m", '"N m/s" or "kN m/s" or "1/s"'),
        ("weight_rate", "furlong", '"N m/s" or "kN m/s" or "1/s"'),
        ("integral_gain", "-", '"1/s"'),
        ("proportional_gain", "kN m", '"-" or "%"'),
    ],
)
def test_a_unit_of_another_dimension_is_refused(name, unit, words):
    with pytest.raises(UserError, match=f'unit = "{unit}" of gain {name} must be {words}'):
        in_the_law(Gain(name=name, value=1.0, unit=unit, why=""), FORMS[name], 1e3)
