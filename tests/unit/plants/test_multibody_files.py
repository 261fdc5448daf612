"""Files of multibody vehicles: what a file says, and what is told about a wrong one."""

import re

import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import data_file
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.preloads import balanced
from wspd_design.plants.multibody.records import effective_inertia

WAGON = data_file("multibody", "two-axle-wagon.toml").read_text(encoding="utf-8")
MANCHESTER = data_file("multibody", "manchester-1.toml").read_text(encoding="utf-8")


def wrong(tmp_path, text, old, new):
    assert old in text
    file = tmp_path / "own.toml"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(UserError) as caught:
        balanced(load_multibody(str(file)))
    sentence = str(caught.value)
    assert "own" in sentence
    return sentence


MISTAKES = {
    "unknown body": (
        WAGON,
        'between = ["car_body", "wheelset_{axle}"]',
        'between = ["car_boddy", "wheelset_{axle}"]',
        'unknown body "car_boddy".*did you mean',
    ),
    "no joint": (WAGON, 'joint = "wheelset"\n', "", "lacks joint"),
    "unknown joint": (WAGON, 'joint = "wheelset"', 'joint = "weelset"', 'did you mean "?wheelset'),
    "two joints": (
        WAGON,
        "[bodies.wheelset]",
        '[bodies.car_body]\njoint = "free"\n[bodies.wheelset]',
        "not valid TOML",
    ),
    "no mass": (WAGON, "value = 1700", "value = 0", "above 0"),
    "mass below that of the parts": (
        WAGON,
        'value = 13000\nunit = "kg"\nbounds = [12610, 13390]',
        'value = 3000\nunit = "kg"',
        "leaves -400 kg for car_body",
    ),
    "unknown key": (WAGON, "carries = true", "caries = true", "did you mean"),
    "unknown number": (
        WAGON,
        "[numbers.suspension.stiffness_z]",
        "[numbers.suspension.stifness_z]",
        "did you mean",
    ),
    "missing number": (
        WAGON,
        "[numbers.car_body.height]",
        "[numbers.car_body.gyration_x2]",
        "not a number of this",
    ),
    "carries without stiffness": (
        WAGON,
        "[numbers.suspension.stiffness_z]\nvalue = 200\n",
        "[numbers.suspension.damping_roll]\nvalue = 200\n",
        "unit",
    ),
    "wrong unit": (WAGON, 'value = 1700\nunit = "kg"', 'value = 1700\nunit = "kN"', "is a unit of force"),
    "nothing carries": (WAGON, "carries = true\n", "", "nothing in multibody vehicle own holds"),
    "unknown table of instances": (WAGON, 'each = "box"', 'each = "boxes"', "no table of instances"),
    "unknown place": (
        WAGON,
        '"s suspension.half_spacing"',
        '"s suspension.half_spacing 3 m"',
        "name of one length",
    ),
    "unknown placeholder": (WAGON, '"wheelset_{axle}"', '"wheelset_{axel}"', "did you mean"),
    "number in a place": (WAGON, 'at = [0, 0, "car_body.height"]', "at = [0, 0, 1.3]", "length belongs"),
    "no wheelset": (WAGON, 'joint = "wheelset"', 'joint = "free"', "no wheelset"),
    "unknown remainder": (WAGON, 'remainder = "car_body"', 'remainder = "body"', "is no body"),
    "impossible inertia": (MANCHESTER, "value = 1.97e6", "value = 1.97e7", "which no body has"),
    "falling stop": (MANCHESTER, "[0, 600, 1760", "[0, 600, 100", "tables of equal length that rise"),
    "unequal stop": (MANCHESTER, "[0, 600, 1760", "[600, 1760", "tables of equal length that rise"),
    "same body twice": (
        MANCHESTER,
        'between = ["bogie_frame_{bogie}", "wheelset_{axle}"]',
        'between = ["wheelset_{axle}", "wheelset_{axle}"]',
        "twice",
    ),
    "lever of zero": (
        MANCHESTER,
        'levers = ["-a brake.lever"]',
        'levers = ["-a brake.lever", "0 brake.lever"]',
        "zero length",
    ),
    "brake on a frame": (
        MANCHESTER,
        'frame = "bogie_frame_{bogie}"\nwheelset = "wheelset_{axle}"',
        'frame = "bogie_frame_{bogie}"\nwheelset = "bogie_frame_{bogie}"',
        'whose joint is "free"',
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_wrong_file_is_told_in_one_sentence(tmp_path, name):
    text, old, new, told = MISTAKES[name]
    assert re.search(told, wrong(tmp_path, text, old, new))


def test_not_a_number_is_refused(tmp_path):
    assert "finite" in wrong(tmp_path, WAGON, "value = 1700", "value = nan")


def test_unknown_vehicle_is_told_with_the_nearest_name():
    with pytest.raises(UserError, match=r"did you mean.*er24pc-82"):
        load_multibody("er24pc82")


def test_instances_stand_where_the_tables_put_them():
    model = load_multibody("er24pc-82")
    assert len(model.bodies) == 27
    assert model.wheelset_names == ("wheelset_1", "wheelset_2", "wheelset_3", "wheelset_4")
    forward = [model.place(model.body(name).at)[0] for name in model.wheelset_names]
    assert forward == pytest.approx([6.531, 3.831, -3.831, -6.531])
    assert model.place(model.body("axle_box_3_right").at) == pytest.approx((-3.831, -1.05, 0.55))
    motors = [model.place(model.body(f"motor_{k}").at)[0] for k in (1, 2)]
    assert motors == pytest.approx([6.031, 4.331])  # both between the axles of the bogie


def test_effective_inertia_counts_what_the_gear_turns():
    model = load_multibody("er24pc-82")
    assert effective_inertia(model, "wheelset_1") == pytest.approx(300 + 4.95**2 * (14.0 + 0.8))
    assert effective_inertia(load_multibody("two-axle-wagon"), "wheelset_2") == 125


def test_remainder_follows_the_mass():
    model = load_multibody("er24pc-82").with_numbers({"mass": 80000.0, "wheelset.mass": 2150.0})
    assert model.mass(model.body("car_body")) == pytest.approx(80000.0 - 28000.0 - 400.0)
    assert sum(model.mass(body) for body in model.bodies) == pytest.approx(80000.0)


def test_unknown_numbers_are_told_with_the_nearest_name():
    with pytest.raises(UserError, match=r'no number "wheelset.mas" \(did you mean "wheelset.mass"'):
        load_multibody("er24pc-82").with_numbers({"wheelset.mas": 1.0})


def test_numbers_that_nobody_measured_are_marked():
    entries = load_multibody("er24pc-82").entries.values()
    marked = [entry for entry in entries if entry.status == "assumed"]
    assert len(marked) > 0.8 * len(entries)
    assert all("estimate" in entry.at or entry.source == "team-choice" for entry in marked)
    uncertain = [entry for entry in marked if entry.source == "team-reconstruction"]
    assert all(entry.bounds is not None for entry in uncertain)
