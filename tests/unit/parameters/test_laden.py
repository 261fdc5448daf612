"""The laden vehicle: what its file states takes the place of the numbers of the empty one."""

import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_entries, load_vehicle

LADEN = """base = "er24pc"
title = "Wagon"
[laden.mass]
value = 90
unit = "t"
bounds = [85, 92]
[laden.body_height]
value = 2.2
unit = "m"
[laden.max_torque]
value = 80
unit = "kN m"
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "wagon.toml"
    path.write_text(LADEN)
    return path


def test_the_load_is_part_of_the_body_and_the_brake_follows_it(file, er24pc):
    empty, laden = load_vehicle(file), load_vehicle(f"{file}:laden")
    assert (empty.mass, empty.body_height, empty.brake) == (er24pc.mass, er24pc.body_height, er24pc.brake)
    assert (laden.name, laden.mass, laden.body_height) == ("wagon:laden", 90e3, 2.2)
    assert laden.body_mass == er24pc.body_mass + 90e3 - er24pc.mass
    assert laden.bogie_mass == er24pc.bogie_mass
    assert laden.brake.max_torque == 80e3
    assert laden.bounds["mass"] == (85e3, 92e3)
    assert "body_height" not in laden.bounds  # the bounds of the empty one are not those of another number
    assert laden.brake.bounds["fill_time"] == er24pc.brake.bounds["fill_time"]


def test_its_entries_tell_where_they_come_from(file):
    entries = load_entries("vehicle", f"{file}:laden").entries
    assert not [name for name in entries if name.startswith("laden")]
    assert (entries["mass"].at, entries["mass"].status) == ("wagon.toml", "assumed")
    assert entries["body_mass"].status == "derived"
    assert "laden.mass - mass" in entries["body_mass"].at
    assert list(load_entries("vehicle", file).entries)[-3:] == [
        "laden.mass",
        "laden.body_height",
        "laden.max_torque",
    ]


def test_what_is_not_stated_stays(tmp_path, er24pc):
    path = tmp_path / "wagon.toml"
    path.write_text(LADEN[: LADEN.index("[laden.body_height]")])
    laden = load_vehicle(f"{path}:laden")
    assert (laden.body_height, laden.brake) == (er24pc.body_height, er24pc.brake)
    assert laden.bounds["body_height"] == er24pc.bounds["body_height"]


def test_the_load_of_an_articulated_train_is_spread_over_its_bodies(tmp_path):
    path = tmp_path / "train.toml"
    parts = '[wheelsets]\nvalue = 6\nunit = "-"\n[bodies]\nvalue = 2\nunit = "-"\n'
    parts += '[body_mass]\nvalue = 15920.5\nunit = "kg"\n'
    path.write_text(LADEN + parts)
    with pytest.warns(UserWarning, match="wheel demand of 0.99"):  # this brake is that of a locomotive
        train = load_vehicle(f"{path}:laden")
    assert train.body_mass == pytest.approx(15920.5 + (90e3 - 76841.0) / 2.0)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('base = "er24pc"', r"vehicle wagon has no laden state; add \[laden.mass\]"),
        (LADEN.replace("value = 90", "value = 70").replace("[85, 92]", "[65, 75]"), "is not above its mass"),
    ],
)
def test_a_vehicle_without_a_load_is_refused(tmp_path, text, why):
    path = tmp_path / "wagon.toml"
    path.write_text(text)
    with pytest.raises(UserError, match=why):
        load_vehicle(f"{path}:laden")
    assert load_vehicle(path).name == "wagon"
