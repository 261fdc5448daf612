"""A design keeps the rail that it was made on: a rail of the same name with other numbers is another rail."""

from dataclasses import replace

import pytest

from wspd_design.design.case import CaseOptions, case_of, load_case
from wspd_design.design.catalog import controller_of
from wspd_design.design.file import write_design
from wspd_design.design.records import Specification, rail_hash, vehicle_hash
from wspd_design.design.selection import design_controller
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.testing import assert_refuted

OTHER = 'base = "polach-wet"\n[mu0]\nvalue = 0.42\nunit = "-"\nbounds = [0.41, 0.43]\n'


@pytest.fixture(scope="module")
def wet():
    return load_rail("polach-wet")


@pytest.fixture(scope="module")
def made(er24pc, wet):
    return design_controller(er24pc, wet, Specification(), law="smc")


def test_a_file_of_the_same_name_is_another_rail(made, wet, tmp_path):
    path = tmp_path / "a.toml"
    write_design(made, path)
    (tmp_path / "polach-wet.toml").write_text(OTHER)
    case = load_case(str(path), CaseOptions(rail=str(tmp_path / "polach-wet.toml")))
    assert case.rail.name == "polach-wet"
    assert case.rail.mu0 == 0.42
    assert case.controller.rail == wet


@pytest.mark.parametrize(
    "change",
    [
        {"mu0": 0.31},
        {"bounds": Bounds.of({"mu0": (0.2, 0.36)})},
        {"friction_decay": 0.21},
        {"slip_reduction": 0.11},
    ],
)
def test_every_number_of_the_rail_counts(made, er24pc, wet, change):
    other = replace(wet, **change)
    assert rail_hash(other) != made.rail_hash
    assert controller_of(made, er24pc, other).rail == wet
    with pytest.raises(UserError, match="was made on another rail polach-wet"):
        made.build(er24pc, other)


def test_constants_count(wet, er24pc, monkeypatch):
    from wspd_design.parameters.loading import constants

    before = rail_hash(wet), vehicle_hash(er24pc)
    heavier = replace(constants(), gravity=9.82)
    monkeypatch.setattr("wspd_design.design.records.constants", lambda: heavier)
    after = rail_hash(wet), vehicle_hash(er24pc)
    assert before[0] != after[0]
    assert before[1] != after[1]


def test_other_numbers_under_the_same_name_do_not_move_the_model(made, wet):
    """With mu0 of .42 the design needs more switching gain than it has; its own model stays at .3 (audit A4)."""
    other = replace(wet, mu0=0.42, bounds=Bounds.of({**wet.bounds, "mu0": (0.41, 0.43)}))
    assert_refuted(made, "reaching", rail=other)
    assert_refuted(made, "reaching", rail=replace(other, name="other"))


def test_a_design_rail_that_is_nowhere_is_told(made, er24pc, wet):
    lost = replace(made, rail_hash="0" * 64)
    with pytest.raises(UserError, match=r"neither the rail polach-wet of the stop nor a shipped one.*--rail"):
        controller_of(lost, er24pc, wet)
    with pytest.raises(UserError, match="give its file with --rail"):
        case_of(replace(made, rail="mine"), CaseOptions(), where="a.toml")
    with pytest.raises(UserError, match=r"neither the rail polach-wet.*--rail"):
        case_of(replace(made, rail="mine"), CaseOptions(rail="polach-wet"), where="a.toml")
