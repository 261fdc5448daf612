"""Which tables the laws of the industry take: the calibrated ones belong to the paper's locomotive alone."""

from dataclasses import replace

import pytest

from wspd_design.controllers.family import with_presets
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.design.industry import CALIBRATED_FOR, TUNED, named_with, table_note, usual_table
from wspd_design.parameters.bounds import EXACT
from wspd_design.parameters.loading import load_vehicle

LAWS = [family.name for family in with_presets()]


@pytest.mark.parametrize("name", CALIBRATED_FOR)
def test_the_paper_s_locomotive_keeps_its_tables_under_any_name_and_bounds(name):
    own = load_vehicle(name)
    assert usual_table(own) == "calibrated"
    assert usual_table(replace(own, name="mine", bounds=EXACT)) == "calibrated"
    assert usual_table(replace(own, brake=replace(own.brake, bounds=EXACT))) == "calibrated"


@pytest.mark.parametrize(
    "changed",
    [
        lambda own: replace(own, mass=own.mass * (1.0 + 1e-12)),
        lambda own: replace(own, brake=replace(own.brake, vent_time=0.3)),
        lambda own: replace(own, contact=replace(own.contact, kalker_c11=4.0)),
    ],
)
def test_another_vehicle_of_the_same_name_gets_the_tables_of_practice(er24pc, changed):
    assert usual_table(changed(er24pc)) == "textbook"


@pytest.mark.parametrize("law", LAWS)
def test_names_say_which_table_is_meant(tmp_path, law):
    other = tmp_path / "er24pc.toml"
    other.write_text('base = "er24pc"\n[brake.vent_time]\nvalue = 0.3\nunit = "s"\n')
    copy = tmp_path / "copy.toml"
    copy.write_text('base = "er24pc"\n')

    def named(written, vehicle=None):
        return load_case(written, CaseOptions(vehicle=vehicle)).controller

    calibrated, textbook = named(f"{law}:calibrated"), named(f"{law}:textbook")
    assert calibrated.table != textbook.table
    assert (named(law).name, named(law).table) == (law, calibrated.table)
    assert (named(law, copy).name, named(law, copy).table) == (law, calibrated.table)
    assert (named(law, other).name, named(law, other).table) == (f"{law} (textbook)", textbook.table)
    asked = named(f"{law}:calibrated", other)
    assert (asked.name, asked.table) == (f"{law} (calibrated)", calibrated.table)


def test_printed_gains_say_so_on_another_vehicle(tmp_path):
    other = tmp_path / "heavy.toml"
    other.write_text('base = "er24pc"\n[brake.vent_time]\nvalue = 0.3\nunit = "s"\n')
    own, foreign = (load_case("afsmc", CaseOptions(vehicle=each)).controller for each in (None, other))
    assert (own.name, foreign.name) == ("afsmc", "afsmc (printed)")
    assert own.gains == foreign.gains
    assert "printed: gains that the paper prints; " in table_note([foreign.name])


def test_what_a_comparison_says_about_the_tables():
    assert table_note(["smc", "trenitalia"]) == ""
    said = table_note(["smc", "trenitalia (textbook)"])
    assert "conventional practice" in said
    assert "Table 10" not in said
    assert said.endswith("what is calibrated or printed belongs to er24pc and er24pc-service.")
    assert "Table 10" in table_note(["trenitalia (calibrated)"])


def test_a_comparison_says_what_was_tuned():
    tuned = named_with("knorr-bremse", f"{TUNED}, 128 evaluations")
    assert tuned == "knorr-bremse (tuned, 128 evaluations)"
    said = table_note([tuned, "trenitalia"])
    assert said == (
        "tuned: numbers of a search with this effort (wspd tune); all others are as shipped or designed."
    )
    assert table_note([tuned, "trenitalia (textbook)"]).count("; ") == 3
