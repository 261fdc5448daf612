"""Sensors and reference of a law: the same options for every command that makes one, and what they come to."""

import inspect
from dataclasses import fields, replace

import pytest

from wspd_design.cli import sensor_options
from wspd_design.cli.commands.compare import compare
from wspd_design.cli.commands.design import design
from wspd_design.cli.commands.report import report
from wspd_design.cli.commands.simulate import simulate
from wspd_design.cli.commands.verify import verify
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.protocol import acts_on_vehicle
from wspd_design.design.case import CaseOptions, SensorWords, load_case, load_cases, specification
from wspd_design.design.file import write_design
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle

NAMES = [each.name for each in fields(SensorOptions)]
WANTED = Specification(sample_time=0.02, sensors=Sensors(speed="fastest-axle"))


@pytest.fixture
def made(tmp_path):
    path = tmp_path / "made.toml"
    law = design_controller(load_vehicle("er24pc"), load_rail("polach-wet"), WANTED, law="observer-smc")
    write_design(law, path)
    return str(path)


def asked(**words):
    return CaseOptions(sensors=SensorWords(**words))


@pytest.mark.parametrize("command", [simulate, compare, report, verify, design])
def test_commands_take_all_of_them_and_the_same(command):
    parameters = inspect.signature(command).parameters
    found = {name: parameters[name] for name in NAMES}
    assert found == {name: inspect.signature(simulate).parameters[name] for name in NAMES}
    for each in found.values():
        (option,) = each.annotation.__metadata__
        assert option.help
        assert option.rich_help_panel == sensor_options.PANEL


def test_what_was_written_reaches_the_specification_and_the_rest_stays():
    options = SensorOptions(speed_source="fastest-axle", pressure_sensors=False, reference="falling")
    found = specification(CaseOptions(sensors=options.words))
    assert found.sensors == Sensors(speed="fastest-axle", pressures=False)
    assert found.reference == "falling"
    assert specification(CaseOptions(), WANTED).sensors == WANTED.sensors
    assert specification(asked(pressures=False), WANTED).sensors == replace(WANTED.sensors, pressures=False)


def test_every_option_is_told_by_its_name():
    options = SensorOptions(estimate_grade=False)
    assert {name for name, value in options.written.items() if value is not None} == {"--estimate-grade"}
    assert len(options.written) == len(NAMES)


@pytest.mark.parametrize("name", ["observer-smc", "trenitalia", "torque-feedback"])
def test_a_law_goes_by_the_speed_that_it_is_asked_to(name):
    plain, seeing = (
        load_case(name, options).controller for options in (CaseOptions(), asked(speed="fastest-axle"))
    )
    assert acts_on_vehicle(seeing)
    assert acts_on_vehicle(plain) == (name == "observer-smc")
    assert "train_speed" in seeing.memory
    assert seeing != plain


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"speed": "told"}, "--speed-source contradicts .*made.toml, which has fastest-axle"),
        ({"pressures": False}, "--pressure-sensors contradicts .*, which has it"),
        ({"grade": True}, "--estimate-grade|grade = true"),
        ({"reference": "constant"}, "--reference contradicts .*, which has falling"),
    ],
)
def test_a_design_keeps_its_own(words, said, made):
    with pytest.raises(UserError, match=said):
        load_case(made, asked(**words))


def test_what_a_design_has_may_be_said_again(made):
    same = asked(speed="fastest-axle", accelerometer=False, pressures=True, grade=False, reference="falling")
    assert load_case(made, same).specification == load_case(made, CaseOptions()).specification


def test_laws_beside_a_design_have_its_sensors_but_no_reference_of_their_own(made):
    _, other = load_cases([made, "trenitalia"], CaseOptions())
    assert other.specification.sensors == WANTED.sensors
    assert "train_speed" in other.controller.memory


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"speed": "radar"}, 'speed = "radar" must be one of'),
        ({"accelerometer": True}, 'goes with speed = "wheels"'),
        ({"reference": "fallen"}, 'reference = "fallen" must be one of'),
    ],
)
def test_what_does_not_exist_is_refused(words, said):
    with pytest.raises(UserError, match=said):
        load_case("observer-smc", asked(**words))


def test_a_constant_slip_is_no_falling_one():
    with pytest.raises(UserError, match="trenitalia holds a constant slip"):
        load_case("trenitalia", asked(reference="falling"))
