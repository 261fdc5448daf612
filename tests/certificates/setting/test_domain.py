"""The domain table: every number with bounds has a row or a reason, and the words say what varies and what is held."""

from dataclasses import fields, replace

import pytest

from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import AXLE, OUTSIDE_CLAIMS, QUANTITIES, STATE, TABLE
from wspd_design.certificates.setting import domain
from wspd_design.parameters.bounds import EXACT
from wspd_design.parameters.files import available, load_entries, uniform_rails
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle

RECORDS = {"vehicle": Vehicle, "brake": Brake, "contact": Contact, "rail": Rail}


def unexplained(kind, names):
    """Numbers of a file that have neither a row nor a reason."""
    rows = {(row.record, row.field) for row in TABLE} | set(OUTSIDE_CLAIMS)
    places = {name: tuple(name.split(".")) if "." in name else (kind, name) for name in names}
    return [name for name, place in places.items() if place not in rows]


@pytest.mark.parametrize("kind", ["vehicle", "rail", "track", "constants"])
def test_every_number_with_bounds_has_a_row_or_a_reason(kind):
    files = available(kind) if kind != "constants" else ["constants"]
    assert files
    for name in files:
        assert unexplained(kind, load_entries(kind, name).bounds) == []


@pytest.mark.parametrize("kind", ["vehicle", "rail"])
def test_every_number_of_vehicle_and_rail_has_a_row_or_a_reason_should_a_user_give_it_bounds(kind):
    for name in uniform_rails() if kind == "rail" else available(kind):
        assert unexplained(kind, load_entries(kind, name).entries) == []


def test_a_number_without_a_row_is_seen():
    assert unexplained("vehicle", ["mass", "headlight_power", "brake.pad_area"]) == [
        "headlight_power",
        "brake.pad_area",
    ]


def test_every_row_and_reason_names_a_field_of_its_record():
    for record, field in [(row.record, row.field) for row in TABLE] + list(OUTSIDE_CLAIMS):
        if record in RECORDS:
            assert field in {each.name for each in fields(RECORDS[record])}
    assert not {(row.record, row.field) for row in TABLE} & set(OUTSIDE_CLAIMS)


def test_a_problem_varies_all_that_the_files_bound(make_problem, make_controller, er24pc):
    problem = make_problem(make_controller("smc"))
    expected = {
        row.name
        for row in TABLE
        if row.record in ("vehicle", "brake", "contact", "rail")
        and row.field
        in {**er24pc.bounds, **er24pc.brake.bounds, **er24pc.contact.bounds, **problem.rail.bounds}
    }
    assert set(problem.bounds) == expected
    assert {"fill time", "vent time", "wheel radius", "friction ratio"} < expected
    assert set(domain.uncertain(problem)) == expected | set(AXLE)
    assert domain.not_varied(problem, domain.uncertain(problem)) == ()
    assert domain.not_varied(problem, [n for n in domain.uncertain(problem) if n != "vent time"]) == (
        "vent time",
    )


def test_a_number_without_bounds_is_known(make_problem, make_controller, er24pc):
    problem = replace(make_problem(make_controller("smc")), bounds=EXACT)
    assert domain.span(problem, "wheel radius") == (er24pc.wheel_radius, er24pc.wheel_radius)
    assert domain.uncertain(problem) == AXLE


def test_words_name_what_varies_and_what_is_held(make_problem, make_controller):
    problem = make_problem(make_controller("smc"), rail="polach-wet")
    assert domain.domain_of(
        problem, ("slip", "speed", "mu0", "vent time"), ("wheel radius", "friction ratio")
    ).text == (
        "slip 0.02 to 0.6, 10 to 120 km/h, mu0 0.24 to 0.36, vent time 0.3 to 0.9 s; "
        "held: wheel radius 0.55 m, friction ratio 0.4"
    )


@pytest.mark.parametrize("row", [row for row in TABLE if row.name not in STATE], ids=lambda row: row.name)
def test_values_without_meaning_are_refused(make_problem, make_controller, row):
    problem = make_problem(make_controller("smc"), bounds={row.name: (-1.0, 1.0)})
    with pytest.raises(OutsideModel, match=row.name):
        domain.box(problem, [row.name])
    touching = make_problem(make_controller("smc"), bounds={row.name: (0.0, 1.0)})
    if row.positive:
        with pytest.raises(OutsideModel, match="not positive"):
            domain.box(touching, [row.name])
    else:
        domain.box(touching, [row.name])


def test_points_are_read_in_the_units_of_people():
    import numpy as np

    found = domain.readable(np.array([10.0, 0.55]), ("speed", "wheel radius"))
    assert [(p.name, p.value, p.unit) for p in found] == [
        ("speed", 36.0, "km/h"),
        ("wheel radius", 0.55, "m"),
    ]
    assert all(quantity.name == name for name, quantity in QUANTITIES.items())
