"""Requirements on the stop of a report: templates, tables of one's own, and what is wrong with them in one sentence."""

import re
from pathlib import Path

import pytest

from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.design.criteria import CRITERIA
from wspd_design.design.records import Specification
from wspd_design.design.requirements import Limit, Requirements, read_requirements, requirements_text
from wspd_design.design.stop_requirements import LOOPS, MODEL, PAPER, TEMPLATES, named_requirements
from wspd_design.parameters.errors import UserError

SPECIFICATION = Specification(slip_tolerance=0.03)
DOCS = Path(__file__).parents[3] / "docs" / "requirements.md"
HELD_OUT = """
[requirements]
rails = ["polach-wet"]
held_out = { sets = 4, seed = 1 }
[requirements.stop]
initial_speed = "30 km/h"
[requirements.limits]
"""


def _read(tmp_path, text):
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return named_requirements(str(path), SPECIFICATION)


@pytest.mark.parametrize("name", TEMPLATES)
def test_every_limit_of_a_template_has_a_source_and_none_claims_to_be_verified(name):
    wanted = named_requirements(name, SPECIFICATION)
    assert wanted.limits
    for limit in wanted.limits:
        assert limit.source
        assert not limit.verified
    assert set(MODEL) <= set(wanted.not_refuted) <= set(THEOREMS)


def test_the_paper_asks_for_the_slip_of_the_specification():
    wanted = named_requirements(PAPER, SPECIFICATION)
    limits = {each.criterion: each.value for each in wanted.limits}
    assert (limits["slip_rms"], limits["slip_overshoot"]) == (0.03, 0.03)
    assert set(LOOPS) <= set(wanted.not_refuted)


def test_the_table_of_the_page_is_read_as_it_says(tmp_path):
    text = re.search(r"```toml\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)[1]
    wanted = _read(tmp_path, text)
    overshoot, lock, release = wanted.limits
    assert wanted.name == "line 7, leaf fall"
    assert overshoot == Limit(criterion="slip_overshoot", value=0.1)
    assert (lock.value, lock.source, lock.verified) == (0.4, "contract 12, section 3", True)
    assert not release.verified
    told = set(re.findall(r"`([a-z0-9_]+)`", DOCS.read_text(encoding="utf-8").partition("| limit |")[2]))
    assert told <= set(CRITERIA)
    assert {name for name, rule in CRITERIA.items() if rule.of_report} <= told


def test_a_table_with_held_out_sets_is_judged_on_them(tmp_path):
    wanted = _read(tmp_path, f'{HELD_OUT}longest_lock = {{ limit = "0.5 s", source = "contract" }}')
    assert isinstance(wanted, Requirements)
    assert wanted.limits == (Limit(criterion="longest_lock", value=0.5, source="contract"),)
    import tomllib

    again = read_requirements(tomllib.loads(requirements_text(wanted))["requirements"], "again")
    assert again.limits == wanted.limits


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            "[requirements.limits]\nlongest_lok = '1 s'",
            r"unknown key requirements\.limits\.longest_lok .* mean requirements\.limits\.longest_lock\?",
        ),
        (
            "[requirements]\nnot_refuted = ['margin']\n[requirements.limits]",
            'names "margin"; the checks are derivation',
        ),
        ("[requirements]\nnot_refuted = []", r"requirements\.limits is missing"),
        (
            "schema = 'wspd-requirements/9'\n[requirements.limits]",
            r'newer program, this one reads "wspd-requirements/1"',
        ),
        ("[requirements.limits]\nlongest_lock = { source = 'x' }", r"longest_lock\.limit is missing"),
        (
            "[requirements.limits]\nlongest_lock = { limit = '1 s', verified = true }",
            "what is verified has a source",
        ),
        (f"{HELD_OUT}slip_rms = '0.05'", "slip_rms .* is known of a single stop alone"),
        ("name = 3\n[requirements.limits]", "name = 3 .* must be a text in quotes"),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(tmp_path, text, sentence):
    with pytest.raises(UserError, match=sentence):
        _read(tmp_path, text)


def test_a_name_that_is_no_template_is_refused():
    with pytest.raises(UserError, match=r"neither a template .*paper, en-15595-like.* nor a .toml file"):
        named_requirements("en15595", SPECIFICATION)
