"""Differences of two records: found wherever they are, verdicts first, and told by names in place of numbers."""

import copy
import json
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from tests.unit.reporting.sample_dossier import drawn, faults, sample_dossier, trial
from wspd_design.certificates.records import Status
from wspd_design.reporting.blocks import Paragraph, Table
from wspd_design.reporting.differences import Kind, differences
from wspd_design.reporting.record import report_record
from wspd_design.reporting.sections.changes import changes, shown, since_previous
from wspd_design.reporting.text import plain
from wspd_design.studies.previous import previous

DATE = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)


def record(dossier):
    return json.loads(json.dumps(report_record(dossier, DATE)))


def leaves(entry, path=()):
    if isinstance(entry, dict | list):
        for key in entry if isinstance(entry, dict) else range(len(entry)):
            yield from leaves(entry[key], (*path, key))
    else:
        yield path


def test_every_single_change_is_found():
    made = record(drawn(replace(sample_dossier(), robustness=faults())))
    assert differences(made, copy.deepcopy(made)) == ()
    everything = list(leaves(made))
    assert len(everything) > 500
    for path in everything[::7]:
        other = copy.deepcopy(made)
        at = other
        for key in path[:-1]:
            at = at[key]
        value = at[path[-1]]
        at[path[-1]] = "planted" if value is None or isinstance(value, str | bool) else value + 1e-9
        assert differences(made, other), path


def test_verdicts_come_first_and_are_named():
    made = record(sample_dossier())
    other = copy.deepcopy(made)
    other["brake"]["grade"] = 0.01
    other["checks"][2]["status"] = "PLANTED"
    first, second = differences(made, other)
    name = made["checks"][2]["name"]
    assert (first.kind, first.place, first.after) == (Kind.VERDICT, f"checks: {name}: status", "PLANTED")
    assert (second.kind, second.place, second.before, second.after) == (
        Kind.NUMBER,
        "brake: grade",
        "0.0",
        "0.01",
    )


@pytest.mark.parametrize(
    ("before", "after", "kind"),
    [
        ({"a": 1}, {"a": 1.0}, Kind.NUMBER),
        ({"a": None}, {"a": 2.0}, Kind.NUMBER),
        ({"a": True}, {"a": 1}, Kind.WORDS),
        ({"a": {}}, {"a": []}, Kind.WORDS),
        ({}, {"a": None}, Kind.WORDS),
        ({"met": None}, {"met": True}, Kind.VERDICT),
        ([1, 2], [1, 2, 3], Kind.NUMBER),
        ([{"name": "a", "x": 1}], [{"name": "b", "x": 1}], Kind.WORDS),
    ],
)
def test_what_is_of_another_kind_or_missing_is_different(before, after, kind):
    assert {each.kind for each in differences(before, after)} == {kind}


def test_a_judged_entry_that_appears_or_goes_is_a_verdict():
    (new,) = differences([], [{"name": "a", "status": "PROVED", "claim": "all"}])
    assert (new.kind, new.place, new.before, new.after) == (Kind.VERDICT, "a: status", "none", "PROVED")
    (gone,) = differences([{"name": "a", "status": "PROVED"}], [])
    assert (gone.kind, gone.after) == (Kind.VERDICT, "none")


def test_long_words_are_shown_where_they_differ():
    long = "the same words " * 20
    (found,) = differences({"claim": f"{long}as before"}, {"claim": f"{long}as it is now"})
    before, after = shown(found)
    assert before.endswith("words as before")
    assert after.endswith("words as it is now")
    assert max(map(len, (before, after))) < 80


def test_order_of_named_items_is_no_difference_and_repeated_names_are_told_apart():
    items = [{"name": "a", "x": 1}, {"name": "b", "x": 2}]
    assert differences(items, items[::-1]) == ()
    twice = [{"name": "a", "x": 1}, {"name": "a", "x": 2}]
    assert differences(twice, twice[::-1])


def against(old, new):
    return replace(new, previous=previous(json.dumps(record(old)), "old.json"))


def test_the_change_record_has_verdicts_and_numbers():
    old = sample_dossier()
    changed = replace(
        sample_dossier(trials=(trial("mine", distance=190.25), trial("trenitalia"), trial("none"))),
        certificates=(replace(old.certificates[0], status=Status.UNDECIDED), *old.certificates[1:]),
    )
    made = against(old, changed)
    tables = {each.anchor: each for each in changes(made) if isinstance(each, Table)}
    (row,) = tables["changed-verdicts"].rows
    assert [plain(cell) for cell in row] == ["checks: lyapunov one: status", "PROVED", "UNDECIDED"]
    rows = [[plain(cell) for cell in row] for row in tables["changed-numbers"].rows]
    assert ["stops: mine: distance m", "187.65", "190.25"] in rows


def test_the_same_report_has_no_changes_whenever_it_was_made():
    made = against(sample_dossier(), sample_dossier())
    assert since_previous(made) == ()
    said = [plain(each.text) for each in changes(made) if isinstance(each, Paragraph)]
    assert said[0].endswith(": nothing differs.")


def test_another_program_is_a_change():
    made = sample_dossier()
    other = replace(made, provenance=replace(made.provenance, package_sha256="0" * 64))
    tables = {each.anchor for each in changes(against(made, other)) if isinstance(each, Table)}
    assert tables == {"changed-program"}


def test_without_an_older_report_the_record_says_so():
    (text,) = (plain(each.text) for each in changes(sample_dossier()) if isinstance(each, Paragraph))
    assert text.startswith("No older report was given")


def test_close_numbers_are_told_apart():
    old = sample_dossier()
    own, *others = old.trials
    own = replace(own, metrics=replace(own.metrics, distance=own.metrics.distance + 1e-9))
    new = sample_dossier(trials=(own, *others))
    (table,) = (each for each in changes(against(old, new)) if isinstance(each, Table))
    assert all(plain(row[1]) != plain(row[2]) for row in table.rows)
