"""Vehicles and rails that were made in Python: what is known about their numbers, and what is refused."""

from dataclasses import replace

import pytest

from wspd_design.exchange.parameter_file import parameter_file
from wspd_design.parameters.bounds import EXACT
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.given import SOURCE, given_entries, given_in_python
from wspd_design.parameters.loading import available, load_entries, load_rail, load_vehicle


@pytest.mark.parametrize("name", available("vehicle"))
def test_a_shipped_vehicle_keeps_its_history(name):
    assert given_entries(load_vehicle(name)) == load_entries("vehicle", name)


@pytest.mark.parametrize("name", uniform_rails())
def test_a_shipped_rail_keeps_its_history(name):
    assert given_entries(load_rail(name)) == load_entries("rail", name)


def test_a_changed_number_loses_its_source_and_the_others_keep_theirs(er24pc):
    found = given_entries(replace(er24pc, wheel_radius=er24pc.wheel_radius * 0.999))
    shipped = load_entries("vehicle", "er24pc")
    assert {name for name, each in found.entries.items() if each != shipped.entries[name]} == {"wheel_radius"}
    assert found.entries["wheel_radius"].source == SOURCE
    assert found.title == f"{shipped.title}, changed in Python"
    assert given_in_python(found)
    assert not given_in_python(shipped)


@pytest.mark.parametrize("name", available("vehicle"))
def test_its_file_gives_the_same_record_to_the_last_bit(tmp_path, name):
    own = replace(
        load_vehicle(name), name="own", wheel_radius=load_vehicle(name).wheel_radius * 0.99912345678912
    )
    found = given_entries(own)
    path = tmp_path / "own.toml"
    path.write_text(parameter_file(found.title, (), found.entries.values()), encoding="utf-8")
    assert load_vehicle(path) == own


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"mass": -1.0, "bounds": EXACT},
            "mass = -1 kg of vehicle er24pc must be above 0; correct the record",
        ),
        ({"mass": 1e9}, "mass = 1e.09 kg of vehicle er24pc lies outside its bounds"),
    ],
)
def test_what_no_vehicle_has_is_refused(er24pc, change, said):
    with pytest.raises(UserError, match=said):
        given_entries(replace(er24pc, **change))
