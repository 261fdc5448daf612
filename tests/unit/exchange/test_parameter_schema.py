"""The format page and the JSON Schemas of vehicle and rail files say what the loader takes."""

import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from wspd_design.exchange.parameter_keys import KEYS
from wspd_design.exchange.parameter_schema import KINDS, file_schema, key_table, with_key_tables
from wspd_design.parameters.files import available, data_file
from wspd_design.parameters.schema import schema_of

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "vehicle-files.md").read_text(encoding="utf-8")
FOLDERS = {"vehicle": "vehicles", "rail": "rails"}


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_has_every_key_as_it_is(kind):
    assert f"<!-- {kind} keys -->\n{key_table(kind)}\n<!-- end -->" in PAGE
    assert with_key_tables(PAGE) == PAGE, "run python -m wspd_design.exchange.files"
    for name in schema_of(kind, ""):
        assert f"| `{name}`" in PAGE


def test_a_stale_table_is_seen():
    stale = PAGE.replace("| number of axles |", "| number of wheels |")
    assert stale != PAGE
    assert with_key_tables(stale) == PAGE


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_has_a_meaning_and_every_meaning_a_key(kind):
    assert set(KEYS[kind]) == set(schema_of(kind, ""))


def test_the_page_names_every_shipped_vehicle():
    for name in available("vehicle"):
        assert f"| `{name}` |" in PAGE


@pytest.mark.parametrize("kind", KINDS)
def test_shipped_files_are_valid(kind):
    schema = file_schema(kind)
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    for name in available(kind):
        text = data_file(FOLDERS[kind], f"{name}.toml").read_text(encoding="utf-8")
        validator.validate(tomllib.loads(text))


@pytest.mark.parametrize(
    ("text", "good"),
    [
        ('mass = "45 t"', True),
        ('mass = "−45,5t"', True),
        ("mass = 45", False),
        ('mass = "heavy"', False),
        ("wheelsets = 4", True),
        ('wheelsets = "4"', True),
        ('wheelsets = "four"', False),
        ("brake.axle_shares = [1, 1, 0, 1]", True),
        ('brake.axle_shares = "all"', False),
        ('[brake.max_torque]\nvalue = 6\nunit = "kN m"\nbounds = [5, 7]', True),
        ("[brake.max_torque]\nvalue = 6\nbounds = [5]", False),
        ('[brake.max_torque]\nunit = "kN m"', False),
        ('[brake.max_torque]\nvalue = "6"\nunit = "kN m"', False),
        ('[brake.max_torque]\nvalue = 6\nunit = "kN m"\nstatus = "guessed"', False),
        ('base = "coach"', True),
        ('base = "coch"', False),
        ('wheel_diameter = "920 mm"', False),
        ('brake.torque = "6 kN m"', False),
    ],
)
def test_what_an_editor_marks(text, good):
    assert Draft202012Validator(file_schema("vehicle")).is_valid(tomllib.loads(text)) == good


def test_a_profile_in_an_editor():
    schema = Draft202012Validator(file_schema("rail"))
    assert schema.is_valid(tomllib.loads('profile.starts = ["0 m"]\nprofile.rails = ["polach-wet"]'))
    assert not schema.is_valid(tomllib.loads('profile.starts = [0]\nprofile.rails = ["polach-wet"]'))
    assert not schema.is_valid(tomllib.loads('profile.rails = "polach-wet"'))
