"""The uncertainty in the report: numbers with the digits that they have, and each mark where it belongs."""

import csv
import io
import math
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from tests.unit.reporting.sample_dossier import certificate, sample_dossier, uncertainty
from wspd_design.certificates.records import Status
from wspd_design.reporting import numbers
from wspd_design.reporting.attachments import sets_text
from wspd_design.reporting.blocks import Code, Figure, Paragraph, Table
from wspd_design.reporting.record import report_record
from wspd_design.reporting.sections.sources import sources
from wspd_design.reporting.sections.stop import stop
from wspd_design.reporting.sections.uncertainty import uncertainty as section
from wspd_design.reporting.text import plain

pytestmark = pytest.mark.usefixtures("blank_figures")

DATE = datetime(2026, 1, 2, tzinfo=UTC)
PLAIN = sample_dossier()
DRAWN = replace(PLAIN, uncertainty=uncertainty())


def _table(blocks, anchor):
    (table,) = (each for each in blocks if isinstance(each, Table) and each.anchor == anchor)
    return {plain(row[0]): [plain(cell) for cell in row[1:]] for row in table.rows}


def _said(blocks):
    return " ".join(plain(each.text) for each in blocks if isinstance(each, Paragraph))


def test_exact_numbers_have_no_such_section():
    assert section(PLAIN) == ()


@pytest.mark.parametrize(
    ("value", "width", "said"),
    [
        (314.095, 115.0, "314"),
        (17.062, 6.03, "17.1"),
        (0.1114, 0.093, "0.111"),
        (2254.9, 900.0, "2255"),
        (0.21185, 0.0, "0.212"),
        (314.095, math.inf, "314"),
        (math.nan, 1.0, numbers.NONE),
    ],
)
def test_digits_follow_the_width(value, width, said):
    assert numbers.resolved(value, width) == said


@pytest.mark.parametrize(
    ("spread", "said"), [(0.0, "315.9"), (0.1, "315.9"), (0.3, "316"), (4.0, "316"), (math.nan, "315.9")]
)
def test_a_digit_that_rounding_moves_is_not_printed(spread, said):
    assert numbers.settled(315.94, spread, 1) == said


def test_key_figures_with_the_digits_of_their_spread():
    rows = _table(section(DRAWN), "uncertainty-table")
    assert rows["Stopping distance [m]"] == ["188", "176", "176", "241", "no standstill", "3"]
    assert rows["Efficiency [%]"] == ["93", "0", "0", "91", "95", "3"]
    assert rows["Slip rms, the build-up included"] == ["0.071", "0.060", "0.060", "0.090", "0.104", "2"]


def test_it_says_what_is_drawn_and_what_is_held():
    said = _said(section(DRAWN))
    for words in (
        "4 times, seed 7: each time all 2 numbers with bounds",
        "In 1 set the train does not come to a standstill",
        "Held at their value, though they have bounds: wheel radius.",
        "bound nothing",
        "change the distance by at most 0.02 %",
        "spread its distance by 0.4 m",
    ):
        assert words in said
    calm = replace(PLAIN, uncertainty=uncertainty(numerical=0.0, unstopped=0, held=()))
    said = _said(section(calm))
    assert "The nominal loop is not sensitive" in said
    assert "Held" not in said
    assert "standstill" not in said


def test_the_strongest_effect_stands_first():
    blocks = section(DRAWN)
    rows = _table(blocks, "uncertainty-effects")
    assert list(rows) == ["mu0", "mass"]
    assert rows["mu0"] == ["0.24 to 0.36", "230 / 170", "90 / 94", "0.090 / 0.060"]
    assert rows["mass"][:2] == ["61473 to 92209 kg", "185 / 190"]
    (tornado,) = (
        each for each in blocks if isinstance(each, Figure) and each.anchor == "uncertainty-tornado"
    )
    assert "mu0 0.24 to 0.36: 230 to 170; mass" in tornado.alt
    assert "gray: its numerical spread" in tornado.caption


def test_a_condition_that_changes_no_digit_is_told_in_a_sentence():
    blocks = section(DRAWN)
    rows = _table(blocks, "uncertainty-variants")
    assert list(rows) == ["nominal stop", "rail, low-adhesion", "accelerometer bias 0.05 m/s²"]
    assert rows["rail, low-adhesion"][0] == "no standstill"
    assert f"No digit of these figures changes with: torque error {numbers.MINUS}10 %." in _said(blocks)


def test_the_worst_sets_have_numbers_and_commands():
    blocks = section(DRAWN)
    rows = _table(blocks, "uncertainty-worst")
    assert rows["mass"] == ["kg", "76841", "80000", "80000"]  # no set has a worse lock than another
    (code,) = (each for each in blocks if isinstance(each, Code))
    assert code.text.splitlines() == [f"wspd simulate mine.toml --only-run {number}" for number in (3, 2)]


def test_the_distribution_leaves_out_what_has_no_end():
    (shown,) = (
        each
        for each in section(DRAWN)
        if isinstance(each, Figure) and each.anchor == "uncertainty-distribution"
    )
    assert "stopping distance [m]: 3 sets from 176 to 241, nominal 188" in shown.alt


def test_the_stop_has_no_digit_that_the_bounds_do_not_leave_it():
    assert "after 188 m and" in _said(stop(DRAWN))
    assert "after 187.7 m and" in _said(stop(PLAIN))


def test_each_bound_says_who_varies_it_and_who_holds_it():
    made = (
        certificate("one", Status.PROVED, varied=("mass", "mu0"), held=("fill time",)),
        certificate("two", Status.PROVED, varied=("mass",), held=("mu0",)),
    )
    blocks = sources(replace(DRAWN, certificates=made))
    vehicle, rail = _table(blocks, "sources-vehicle-er24pc"), _table(blocks, "sources-rail-polach-wet")
    assert vehicle["mass"][3] == "varied by the drawn sets and 2 checks"
    assert (
        vehicle["brake: fill time"][3] == "held by 1 check"
    )  # the drawn sets of this dossier do not know it
    assert vehicle["wheel radius"][3] == "held by the drawn sets"
    assert vehicle["body height"][3].endswith("enters through the range of the axle load share")
    assert vehicle["wheelbase"][3] == ""  # has no bounds
    assert rail["mu0"][3] == "varied by the drawn sets and 1 check; held by 1 check"


def test_the_sets_travel_as_rows():
    rows = list(csv.DictReader(io.StringIO(sets_text(DRAWN.uncertainty))))
    assert [row["set"] for row in rows] == ["0", "1", "2", "3"]
    assert rows[2]["rail.mu0"] == "0.26"
    assert float(rows[2]["distance"]) == 240.9
    assert math.isinf(float(rows[3]["distance"]))


def test_the_record_has_null_where_there_is_no_number():
    record = report_record(DRAWN, DATE)["uncertainty"]
    distance = record["spreads"][0]
    assert (distance["p95"], distance["high"], distance["worst"]["value"]) == (240.9, None, None)
    assert record["variants"][0]["figures"] == {"efficiency": 0.0}
    assert record["effects"][1]["at_low"]["distance"] == 230.0
    assert report_record(PLAIN, DATE)["uncertainty"] is None
