"""Schema files and documentation follow from the forms, and one key means one thing in all of them."""

import json
import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator, ValidationError

import wspd_design as wd
from wspd_design.certificates.kernel.file import SCHEMA, certificate_text
from wspd_design.controllers.family import designed
from wspd_design.design.file import design_text
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.exchange.design_forms import DESIGN_FILE
from wspd_design.exchange.documentation import documented_tables, with_tables
from wspd_design.exchange.files import FOLDER, read_schema, schema_file, schema_text
from wspd_design.exchange.forms import UNITS, Form, inner_forms, unit
from wspd_design.exchange.vocabulary import STANDING_ALONE, WITH_SCHEMA
from wspd_design.parameters.loading import load_rail

ROOT = Path(__file__).parents[3]
FORMS = {each.name: each for form in STANDING_ALONE for each in (form, *inner_forms(form))}
MAKE = "run python -m wspd_design.exchange.files"


def test_files_are_those_of_the_forms():
    folder = ROOT / "wspd_design" / FOLDER
    assert {path.name for path in folder.iterdir()} == {schema_file(form) for form in WITH_SCHEMA}
    for form in WITH_SCHEMA:
        assert (folder / schema_file(form)).read_text(encoding="utf-8") == schema_text(form), MAKE
        Draft202012Validator.check_schema(read_schema(form.schema))


@pytest.mark.parametrize("law", [family.name for family in designed()])
def test_a_written_design_file_validates(er24pc, law):
    design = design_controller(er24pc, load_rail("polach-wet"), Specification(), law=law)
    document = tomllib.loads(design_text(design))
    schema = Draft202012Validator(read_schema(DESIGN_FILE.schema))
    schema.validate(document)
    gain = next(iter(document["gains"]))
    for broken in (
        {key: value for key, value in document.items() if key != "rail_hash"},
        document | {"schema": "wspd-design/1"},
        document | {"specification": document["specification"] | {"speeds": [1.0]}},
        document | {"gains": document["gains"] | {gain: {"value": 1.0, "why": "no unit"}}},
    ):
        assert not schema.is_valid(broken)


def test_the_page_has_every_form_as_it_is():
    page = (ROOT / "docs" / "json.md").read_text(encoding="utf-8")
    assert with_tables(page) == page, MAKE
    for name, table in documented_tables().items():
        assert page.count(f"<!-- {name} -->\n{table}\n<!-- end -->") == 1, name


@pytest.mark.parametrize("name", sorted(FORMS))
def test_no_key_stands_twice(name):
    keys = [key.name for key in FORMS[name].keys]
    assert len(set(keys)) == len(keys)


def test_one_quantity_has_one_spelling():
    """Without its unit no key is a key of another unit, ``distance`` beside ``distance_m``."""
    units = {}
    for form in FORMS.values():
        for key in form.keys:
            if key.kind == "number" or isinstance(key.kind, Form):
                end = next((end for end in UNITS if key.name.endswith(end)), "")
                units.setdefault(key.name.removesuffix(end), set()).add(end)
    assert {stem: found for stem, found in units.items() if len(found) > 1} == {}


@pytest.mark.parametrize(
    ("key", "expected"),
    [
        ("distance_m", "m"),
        ("initial_speed_m_s", "m/s"),
        ("plateau_m_s2", "m/s²"),
        ("wheelset_inertia_kg_m2", "kg m²"),
        ("torque_integral_Nms", "N m s"),
        ("gain_per_Nms", "1/(N m s)"),
        ("slip_rms", ""),
        ("runs", ""),
    ],
)
def test_the_unit_ends_the_key(key, expected):
    assert unit(key) == expected


@pytest.mark.parametrize("rail", ["polach-wet", "polach-dry"])
def test_certificate_files_have_the_form_and_no_key_besides(rail):
    """Proved, refuted with a witness, a limitation, evidence: every file that is written validates."""
    checks = ("surface_hurwitz", "gain_positive", "open_loop_pole", "no_go", "conservation")
    made = wd.certify("smc", rail=rail, only=checks)
    assert len({each.status for each in made}) >= 3
    schema = read_schema(SCHEMA)
    for each in made:
        content = json.loads(certificate_text(each))
        assert content.keys() == schema["properties"].keys()
        Draft202012Validator(schema).validate(content)
    with pytest.raises(ValidationError):
        Draft202012Validator(schema).validate(content | {"status": "GOOD"})
