"""From options to records."""

from dataclasses import replace
from functools import cache

import pytest

from wspd_design.cli.app import run
from wspd_design.cli.arguments import chosen, initial_speed
from wspd_design.controllers.family import designed_family
from wspd_design.design.case import CaseOptions, load_case, load_cases, specification
from wspd_design.design.file import write_design
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import (
    load_knorr_bremse,
    load_mitsubishi,
    load_rail,
    load_trenitalia,
    load_vehicle,
)

SPECIFICATION = Specification(slip=0.2, slips=(0.02, 0.6), sample_time=0.05)


@cache
def designed(vehicle, rail):
    return design_controller(load_vehicle(vehicle), load_rail(rail), SPECIFICATION, law="smc")


def written(folder, name="made.toml", vehicle="er24pc", rail="polach-dry"):
    path = folder / name
    write_design(designed(vehicle, rail), path)
    return str(path)


def test_a_design_finds_the_files_that_it_was_made_with(tmp_path, monkeypatch):
    """Also where the file is named like a shipped vehicle, and from another working folder."""
    (tmp_path / "designs").mkdir()
    own = tmp_path / "er24pc.toml"
    own.write_text('base = "er24pc"\n[wheelset_inertia]\nvalue = 700\nunit = "kg m^2"\n')
    monkeypatch.chdir(tmp_path / "designs")
    assert run(["design", "--vehicle", "../er24pc.toml", "--law", "smc", "-o", "made.toml"]) == 0
    monkeypatch.chdir("/")
    path = tmp_path / "designs" / "made.toml"
    assert load_case(str(path), CaseOptions()).vehicle.wheelset_inertia == 700.0
    assert load_cases([str(path)], CaseOptions())[0].vehicle.wheelset_inertia == 700.0
    own.write_text(own.read_text().replace("700", "701"))
    with pytest.raises(UserError, match="have changed since design"):
        load_case(str(path), CaseOptions())
    own.unlink()
    with pytest.raises(UserError, match="which is not there; give its file with --vehicle"):
        load_case(str(path), CaseOptions())


def test_a_stop_begins_at_the_top_of_the_range():
    assert initial_speed(None, replace(SPECIFICATION, speeds=(2.0, 20.0))) == 20.0
    assert initial_speed("90 km/h", SPECIFICATION) == 25.0


def test_nothing_written_is_the_papers_case():
    assert specification(CaseOptions()) == Specification()
    case = load_case("trenitalia", CaseOptions())
    assert (case.vehicle.name, case.rail.name) == ("er24pc", "polach-wet")
    assert case.design is None


@pytest.mark.parametrize("slip", ["0.001", "1 %", "0.14", "0.6", "0.75", "0.97", "0.999"])
def test_ranges_give_way_to_any_slip_reference_in_the_open_interval(slip):
    made = specification(CaseOptions(slip=slip))
    assert made.slips[0] < made.slip < made.slips[1] <= 1.0
    assert made.slip + made.slip_tolerance < 1.0


def test_an_explicit_tolerance_does_not_give_way():
    with pytest.raises(UserError, match="tolerance"):
        specification(CaseOptions(slip="0.97", tolerance="0.05"))


def test_chosen():
    assert chosen(None, None) == "afsmc"
    assert chosen("smc", None) == chosen(None, "smc") == chosen("smc", "smc") == "smc"
    with pytest.raises(UserError, match="leave one out"):
        chosen("smc", "none")


def test_law_that_can_be_designed():
    assert designed_family("smc").name == "smc"
    with pytest.raises(UserError, match="afsmc or smc"):
        designed_family("pid")


def test_design_file_brings_its_own_case(tmp_path):
    case = load_case(written(tmp_path), CaseOptions())
    assert case.rail.name == "polach-dry"
    assert case.specification == SPECIFICATION
    assert case.controller.sample_time == 0.05


def test_design_file_on_another_rail_keeps_its_friction_model(tmp_path):
    case = load_case(written(tmp_path), CaseOptions(rail="polach-wet"))
    assert case.rail.name == "polach-wet"
    assert case.controller.rail.name == "polach-dry"


def test_the_same_number_in_another_unit_is_no_contradiction(tmp_path):
    options = CaseOptions(slip="20 %", sample_time="50 ms", speeds=("10 km/h", "120 km/h"))
    assert load_case(written(tmp_path), options).specification == SPECIFICATION


@pytest.mark.parametrize(
    "options",
    [
        CaseOptions(slip="0.2001"),
        CaseOptions(sample_time="51 ms"),
        CaseOptions(speeds=("10 km/h", "121 km/h")),
    ],
)
def test_contradiction(options, tmp_path):
    with pytest.raises(UserError, match="contradicts"):
        load_case(written(tmp_path), options)


def test_design_for_an_own_vehicle_needs_its_file(tmp_path):
    own = tmp_path / "mine.toml"
    own.write_text('base = "er24pc"\n')
    path = written(tmp_path, vehicle=own)
    with pytest.raises(UserError, match="give its file with --vehicle"):
        load_case(path, CaseOptions())
    assert load_case(path, CaseOptions(vehicle=str(own))).vehicle.name == "mine"


def test_design_on_an_own_rail_can_be_rebuilt_with_its_file(tmp_path):
    own = tmp_path / "mine.toml"
    own.write_text('base = "polach-wet"\n')
    path = written(tmp_path, rail=own)
    with pytest.raises(UserError, match="give its file with --rail"):
        load_case(path, CaseOptions())
    assert load_case(path, CaseOptions(rail=str(own))).controller.rail.name == "mine"


def test_all_in_a_comparison_follow_the_first_design_file(tmp_path):
    cases = load_cases(["none", written(tmp_path), "trenitalia"], CaseOptions())
    assert {case.rail.name for case in cases} == {"polach-dry"}
    assert {case.controller.sample_time for case in cases} == {0.05}
    assert {case.specification.slip for case in cases} == {0.2}


def test_all_in_a_comparison_follow_the_options():
    cases = load_cases(["none", "trenitalia"], CaseOptions(rail="low-adhesion", sample_time="20 ms"))
    assert {case.rail.name for case in cases} == {"low-adhesion"}
    assert {case.controller.sample_time for case in cases} == {0.02}


@pytest.mark.parametrize(
    ("base", "load"),
    [
        ("trenitalia", load_trenitalia),
        ("knorr-bremse", load_knorr_bremse),
        ("mitsubishi", load_mitsubishi),
    ],
)
def test_presets_select_the_tables(base, load):
    assert load("textbook") != load("calibrated")
    textbook = load_case(f"{base}:textbook", CaseOptions()).controller
    assert (textbook.name, textbook.table) == (f"{base} (textbook)", load("textbook"))
    for name in (base, f"{base}:calibrated"):
        assert load_case(name, CaseOptions()).controller.table == load("calibrated")


@pytest.mark.parametrize("name", ["trenitalia:", "mitsubishi:text", "none:textbook", "afsmc:textbook"])
def test_what_is_no_preset(name):
    with pytest.raises(UserError, match=name.partition(":")[0]):
        load_case(name, CaseOptions())


BAND = """
from dataclasses import dataclass
from wspd_design.controllers.protocol import Command

@dataclass(frozen=True)
class Band:
    slip: float = 0.08
    sample_time: float = 0.02
    name: str = "band"
    def start(self, seen): return ()
    def step(self, state, seen): return state, Command(fill=0.5, vent=0.5)

fixed = Band()
"""


def test_a_law_of_a_user_is_judged_about_the_slip_that_it_holds(tmp_path):
    path = tmp_path / "band.py"
    path.write_text(BAND)
    own = load_case(f"{path}:Band", CaseOptions())
    assert (own.controller.slip, own.specification.slip, own.specification.sample_time) == (0.08, 0.08, 0.02)
    asked = load_case(f"{path}:Band", CaseOptions(slip="0.7"))
    assert asked.controller.slip == asked.specification.slip == 0.7
    assert asked.specification.slips[1] > 0.7
    with pytest.raises(UserError, match=r"--slip 0.1 contradicts .*, which holds 0.08"):
        load_case(f"{path}:fixed", CaseOptions(slip="0.1"))
