"""The ladder of models in a report: what suffices, what is inferred, and nothing where it was not asked for."""

from dataclasses import replace
from datetime import UTC, datetime

import pytest

from tests.unit.reporting.sample_dossier import sample_dossier, sample_ladder
from wspd_design.reporting.blocks import Figure, Paragraph, Table
from wspd_design.reporting.figure_style import figure_style, new_figure
from wspd_design.reporting.figures.ladder import rungs
from wspd_design.reporting.ladder import sensitivity
from wspd_design.reporting.numbering import number, unreferenced
from wspd_design.reporting.record import report_record
from wspd_design.reporting.report import report_document
from wspd_design.reporting.sections.ladder import ladder as section
from wspd_design.reporting.text import plain

pytestmark = pytest.mark.usefixtures("blank_figures")

DATE = datetime(2026, 1, 2, tzinfo=UTC)
PLAIN = sample_dossier()
ASKED = replace(PLAIN, ladder=sample_ladder())


def test_a_report_has_no_ladder_where_none_was_asked_for():
    assert section(PLAIN) == ()
    assert report_record(PLAIN, DATE)["ladder"] is None


def test_what_suffices_is_told_and_what_does_not_is_not():
    (text,) = (plain(each.text) for each in section(ASKED) if isinstance(each, Paragraph))
    quarter, planar = text.partition("planar: load transfer.")[:2]
    assert planar
    assert "quarter: distance, time" in quarter
    assert "load transfer" not in quarter.partition("quarter: ")[2]


def test_a_sensitive_loop_limits_what_differences_say():
    assert sensitivity(sample_ladder()) == ""
    low, top = sample_ladder().rungs
    shaky = replace(sample_ladder(), rungs=(low, replace(top, spread=0.31)))
    assert "spread its distance by up to 0.31 m" in sensitivity(shaky)


def test_every_table_and_figure_says_what_is_inferred():
    shown = [each for each in section(ASKED) if isinstance(each, Table | Figure)]
    assert len(shown) == 4
    for each in shown:
        assert plain(each.caption).endswith("Inferred: 3 of the 4 numbers of a model.")
    clean = replace(ASKED, ladder=replace(sample_ladder(), remark=""))
    assert not any("Inferred" in plain(each.caption) for each in section(clean) if isinstance(each, Table))


def test_its_links_are_good_and_everything_is_referred_to():
    document = report_document(ASKED, DATE)
    number(document)
    assert unreferenced(document) == ()


def test_the_record_has_every_wheelset_of_every_model():
    record = report_record(ASKED, DATE)["ladder"]
    assert [len(each["axles"]) for each in record["rungs"]] == [4, 4]
    assert record["agreements"][0]["measure"] == "distance"


def test_all_models_are_drawn_on_the_same_axes():
    found = sample_ladder()
    with figure_style():
        figure = rungs(new_figure(height=3.6), found)
    assert [axes.get_title(loc="left") for axes in figure.axes[:2]] == ["quarter", "planar"]
    assert len({axes.get_ylim() for axes in figure.axes[:2]}) == 1
    assert len(figure.axes[0].get_lines()) == 4
