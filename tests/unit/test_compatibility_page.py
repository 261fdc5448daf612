"""docs/compatibility.md names every schema with its present version, and everything that is outdated."""

import re
from pathlib import Path

import pytest

from wspd_design.exchange.forms import Form
from wspd_design.exchange.vocabulary import WITH_SCHEMA
from wspd_design.parameters.versions import OUTDATED

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "compatibility.md").read_text(encoding="utf-8")
STATED = re.compile(r"^_?[A-Z_]*(?:SCHEMA|FORMAT) = \"(wspd-[a-z-]+/\d+)\"", re.MULTILINE)
PROOFS = ROOT / "wspd_design" / "certificates" / "theorems"
"""Forms of proofs stand here that only occur within a certificate, whose version speaks for them."""


def schemas(folder=ROOT / "wspd_design"):
    texts = (path.read_text("utf-8") for path in folder.rglob("*.py") if not path.is_relative_to(PROOFS))
    return {form.schema for form in WITH_SCHEMA} | {name for text in texts for name in STATED.findall(text)}


@pytest.mark.parametrize("name", sorted(schemas()))
def test_every_schema_stands_on_the_page_with_its_present_version(name):
    assert f"`{name}`" in PAGE


def test_what_is_looked_for_is_found():
    assert {"wspd-design/2", "wspd-certificate/3", "wspd-draft/1", "wspd-stop/2"} <= schemas()


@pytest.mark.parametrize("outdated", OUTDATED, ids=lambda each: each.what)
def test_everything_outdated_stands_on_the_page(outdated):
    rows = [
        line for line in PAGE.splitlines() if line.startswith("| ") and line.endswith(f"| {outdated.until} |")
    ]
    said = [row for row in rows if outdated.instead.partition(" with")[0] in row]
    assert said


def paths(form, prefix=""):
    """Return the keys of a form and of the forms in it, as the page writes them."""
    for key in form.keys:
        yield prefix + key.name
        if isinstance(key.kind, Form):
            yield from paths(key.kind, f"{prefix}{key.name}{'[]' if key.many else ''}.")


def test_keys_of_the_first_form_of_a_stop_are_led_to_those_of_the_present_one():
    (stop,) = (form for form in WITH_SCHEMA if form.schema == "wspd-stop/2")
    present = set(paths(stop))
    _, _, table = PAGE.partition("| key of `wspd-stop/1` | in `wspd-stop/2` |")
    rows = [line.split(" | ") for line in table.partition("\n\n")[0].splitlines() if line.startswith("| `")]
    assert len(rows) == 5
    for old, new in rows:
        assert not present & set(re.findall(r"`([^`]+)`", old)), old
        assert re.findall(r"`([^`]+)`", new)[0] in present, new
