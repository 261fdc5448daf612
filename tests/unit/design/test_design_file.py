"""Design files: written and read without loss, and every fault in one becomes one sentence."""

import math
from dataclasses import replace

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from wspd_design.design.file import design_text, read_design, write_design
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller, paper_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail


@pytest.fixture(scope="module")
def designs(er24pc):
    rail = load_rail("polach-wet")
    return {
        "afsmc": design_controller(er24pc, rail, Specification(), law="afsmc"),
        "smc": design_controller(er24pc, rail, Specification(), law="smc"),
        "torque-feedback": design_controller(er24pc, rail, Specification(), law="torque-feedback"),
        "printed": paper_design(er24pc, rail, Specification()),
    }


@pytest.mark.parametrize("which", ["afsmc", "smc", "torque-feedback", "printed"])
def test_round_trip(designs, tmp_path, which):
    path = tmp_path / "design.toml"
    write_design(designs[which], path)
    assert read_design(path) == designs[which]
    assert design_text(read_design(path)) == path.read_text()
    assert [p.name for p in tmp_path.iterdir()] == ["design.toml"]


specifications = st.builds(
    lambda slip, low, factor, below, above, tolerance, period: Specification(
        slip=slip,
        speeds=(low, low * factor),
        slips=(slip * below, slip + (1.0 - slip) * above),
        slip_tolerance=tolerance * (1.0 - slip),
        sample_time=period,
    ),
    slip=st.floats(0.01, 0.9),
    low=st.floats(0.1, 10.0),
    factor=st.floats(1.01, 14.0),
    below=st.floats(0.01, 0.99),
    above=st.floats(0.01, 1.0),
    tolerance=st.floats(0.01, 0.99),
    period=st.floats(1e-3, 1.0),
)


@pytest.mark.filterwarnings("ignore:highest speed of the range")  # drawn up to what a wheel bears
@settings(max_examples=60, deadline=None)
@example(specification=Specification(), name='\x7f " \\ \n \u2028', which="smc", number=5e-324)
@given(
    specification=specifications,
    name=st.text(st.characters(codec="utf-8"), max_size=20),
    which=st.sampled_from(["smc", "torque-feedback", "printed"]),
    number=st.floats(0.0, exclude_min=True, allow_infinity=False),
)
def test_any_specification_name_and_number_comes_back(
    designs, tmp_path_factory, specification, name, which, number
):
    gains = tuple(
        replace(gain, value=number, why=name) if isinstance(gain.value, float) else gain
        for gain in designs[which].gains
    )
    made = replace(designs[which], name=name, specification=specification, gains=gains)
    path = tmp_path_factory.mktemp("round") / "design.toml"
    write_design(made, path)
    assert read_design(path) == made


FAULTS = {
    "misspelled gain": ("[gains.surface_rate]", "[gains.surfase_rate]", "did you mean gains.surface_rate"),
    "misspelled head": ("vehicle_hash =", "vehicle_hsah =", "did you mean vehicle_hash"),
    "misspelled specification": ("sample_time =", "sampel_time =", "did you mean specification.sample_time"),
    "misspelled key of a gain": ("why =", "wy =", r"did you mean gains\.surface_rate\.why"),
    "unknown law": ('law = "smc"', 'law = "pid"', 'law = "pid" .* must be one of afsmc, smc'),
    "another version": ("wspd-design/2", "wspd-design/0", "not a design of this version"),
    "not a number": (
        "value = 0.025",
        "value = nan",
        r"gains\.boundary_layer\.value .* must be a finite number",
    ),
    "infinite": ("value = 0.025", "value = inf", "must be a finite number"),
    "text for a number": ("value = 0.025", 'value = "0.025"', "must be a finite number"),
    "list for a number": ("value = 0.025", "value = [0.025]", r"gains\.boundary_layer.* must be one number"),
    "truth for a number": ("value = 0.025", "value = true", r"gains\.boundary_layer.* must be one number"),
    "number for a text": ('law = "smc"', "law = 3", "must be text; put it in quotes"),
    "slip in percent": ("slip = 0.14", "slip = 14.0", r"slip = 14 must lie in \(0, 1\)"),
    "slip not a number": ("slip = 0.14", "slip = nan", "must be a finite number"),
    "one speed": ("speeds = [2.7777777777777777, 33.333333333333336]", "speeds = 3.0", "must be two numbers"),
    "two slips": ("slip = 0.14", "slip = [0.14, 0.2]", "must be one number"),
    "falling speeds": ("[2.7777777777777777, 33.333333333333336]", "[30.0, 3.0]", "must rise"),
    "no layer": ("value = 0.025", "value = 0.0", r"gains\.boundary_layer = 0 in .* must be above 0"),
    "a missing gain": ("[gains.boundary_layer]", "[gains.extra]", r"unknown key gains\.extra"),
    "specification no table": (
        "[specification]\n",
        "specification = 3\n[other]\n",
        "unknown key|must be a table",
    ),
    "not TOML": ('law = "smc"', "law smc", "is not valid TOML"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_told_in_one_sentence(designs, er24pc, tmp_path, fault):
    old, new, words = FAULTS[fault]
    text = design_text(designs["smc"])
    assert old in text
    path = tmp_path / "my-design.toml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(UserError, match=words) as caught:
        read_design(path).build(er24pc, load_rail("polach-wet"))
    assert "\n" not in str(caught.value)


LIST_FAULTS = {
    "one number for a list": (
        "value = [-1.0, -0.5, 0.0, 0.5, 1.0]",
        "value = 1.0",
        "must be a list of numbers",
    ),
    "lists of different length": ("[-1.0, -0.5, 0.0, 0.5, 1.0]", "[-1.0, 1.0]", "must have the same length"),
    "number for a truth": ("value = false", "value = 0.0", "must be true or false"),
    "a list in a list": ("[-1.0, -0.5, 0.0, 0.5, 1.0]", "[[1.0], 2.0]", "must be a list of numbers"),
    "width zero": ("value = [75.6707117535,", "value = [0.0,", "widths .* must be above 0"),
}


@pytest.mark.parametrize("fault", LIST_FAULTS)
def test_faults_of_the_adaptive_law(designs, er24pc, tmp_path, fault):
    old, new, words = LIST_FAULTS[fault]
    text = design_text(designs["printed"])
    assert old in text
    path = tmp_path / "my-design.toml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(UserError, match=words):
        read_design(path).build(er24pc, load_rail("polach-wet"))


def test_missing_file_is_told(tmp_path):
    with pytest.raises(UserError, match="does not exist"):
        read_design(tmp_path / "nowhere.toml")


def test_unwritable_places_leave_nothing_behind(designs, tmp_path):
    occupied = tmp_path / "file"
    occupied.write_text("mine")
    folder = tmp_path / "taken.toml"
    folder.mkdir()
    before = sorted(tmp_path.rglob("*"))
    for target in (tmp_path / "missing" / "design.toml", occupied / "design.toml", folder):
        with pytest.raises(
            UserError, match=r"cannot be written .*; choose a folder that exists and is writable"
        ):
            write_design(designs["smc"], target)
    assert sorted(tmp_path.rglob("*")) == before
    assert occupied.read_text() == "mine"


def test_a_full_disk_leaves_the_old_design_and_nothing_else(designs, tmp_path, monkeypatch):
    import errno

    path = tmp_path / "design.toml"
    write_design(designs["smc"], path)
    old = path.read_text()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises(UserError, match="No space left on device"):
        write_design(designs["printed"], path)
    assert path.read_text() == old
    assert [p.name for p in tmp_path.iterdir()] == ["design.toml"]


def test_infinity_would_not_survive(designs, tmp_path):
    gains = (replace(designs["smc"].gains[0], value=math.inf), *designs["smc"].gains[1:])
    path = tmp_path / "design.toml"
    write_design(replace(designs["smc"], gains=gains), path)
    with pytest.raises(UserError, match="finite"):
        read_design(path)
