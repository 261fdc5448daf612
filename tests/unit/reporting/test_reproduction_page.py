"""The page about the paper: its verdict is that of the conclusions, and its numbers are those of the records."""

import re
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from tests.unit.reporting.sample_reproduction import sample_evidence, sample_reproduction
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.reporting.blocks import Cell, Figure, Heading, KeyNumbers, Paragraph, Status, Table
from wspd_design.reporting.blocks import Verdict as Judgment
from wspd_design.reporting.figure_style import figure_style, new_figure
from wspd_design.reporting.figures import paper
from wspd_design.reporting.numbering import number, unreferenced
from wspd_design.reporting.paper.verdicts import summary, verdict
from wspd_design.reporting.reproduction import reproduction_document
from wspd_design.reporting.text import plain
from wspd_design.studies.inferred import mark
from wspd_design.studies.paper.conclusions import conclusions
from wspd_design.studies.paper.published import load_table10

pytestmark = pytest.mark.usefixtures("blank_figures")

DATE = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)


@pytest.fixture(scope="module")
def document():
    return reproduction_document(sample_reproduction(), DATE)


def _table(document, anchor):
    return next(each for each in document.blocks if isinstance(each, Table) and each.anchor == anchor)


def _judged(made, found):
    return replace(made, small=replace(made.small, conclusions=found))


def test_links_and_anchors_are_good_and_everything_is_referred_to(document):
    number(document)
    assert unreferenced(document) == ()


def test_every_figure_of_the_paper_is_there_and_spoken(document):
    figures = {each.anchor: each for each in document.blocks if isinstance(each, Figure)}
    for of_paper in (3, *range(9, 22)):
        figure = figures[f"paper-figure-{of_paper}"]
        assert plain(figure.caption).startswith(f"Figure {of_paper} of the paper")
        assert any(c.isdigit() for c in figure.alt)
        assert "nan" not in figure.alt


def test_the_numbering_of_the_wheelsets_is_told(document):
    text = " ".join(plain(each.text) for each in document.blocks if hasattr(each, "text"))
    assert "wheelsets 3 and 4 are in front" in text


def test_all_24_numbers_stand_beside_ours(document):
    rows = _table(document, "table10-numbers").rows
    shown = [[plain(cell) for cell in row] for row in rows]
    for row, published in zip(shown, load_table10().stops, strict=True):
        assert row[0] == published.controller
        assert [row[2], row[5], row[8]] == [
            f"{published.distance_m:.2f}",
            f"{published.stopping_time_s:.1f}",
            f"{published.torque_integral_kNms:.2f}",
        ]
        # The invented stop of the sample.
        assert [row[3], row[6], row[9]] == ["187.65", "10.00", "1567.8"]
        off = 100.0 * (187.65 / published.distance_m - 1.0)
        assert float(row[4].replace("\N{MINUS SIGN}", "-")) == pytest.approx(off, abs=0.006)


def test_the_worst_conclusion_decides():
    good = sample_reproduction()
    assert verdict(good).status is Status.HOLDS
    assert "14 hold in our stops" in plain(verdict(good).sentence)
    evidence = sample_evidence(published=load_table10())
    partly = _judged(good, conclusions(evidence))
    assert verdict(partly).status is Status.PARTLY
    assert "1 holds in part and 13 hold in" in plain(verdict(partly).sentence)
    planted = _judged(good, conclusions(replace(evidence, mean_loads=(188.2e3, 188.1e3, 188e3, 188e3))))
    assert verdict(planted).status is Status.FAILS
    assert "1 does not hold, 1 holds in part and 12 hold" in plain(verdict(planted).sentence)


def test_a_planted_number_reaches_the_reader():
    evidence = sample_evidence(mean_loads=(188.2e3, 188.1e3, 188e3, 188e3))
    document = reproduction_document(sample_reproduction(evidence), DATE)
    (judged,) = (
        each
        for each in document.blocks
        if isinstance(each, Judgment) and "shifts weight" in plain(each.sentence)
    )
    assert judged.status is Status.FAILS
    _, table = document.summary
    assert isinstance(table, Table)
    cell = table.rows[-2][1]
    assert isinstance(cell, Cell)
    assert cell.status is Status.FAILS


def test_key_numbers_are_those_of_the_evidence():
    tiles, _ = summary(sample_reproduction())
    assert isinstance(tiles, KeyNumbers)
    # Relay 240 m in place of 200 m; first on both of Polach's rails; late rms 0.02 everywhere.
    assert [each.value for each in tiles.numbers[1:]] == ["20.00", "1 and 1", "0.02"]


def test_every_conclusion_has_a_section(document):
    headings = {each.anchor for each in document.blocks if isinstance(each, Heading)}
    for each in sample_reproduction().small.conclusions:
        assert f"conclusion-{each.name}" in headings


def test_table_9_has_its_coefficients(document):
    rows = {plain(row[1]): [plain(cell) for cell in row] for row in _table(document, "table9").rows}
    assert rows["vertical-high"][:3] == ["Vertical", "vertical-high", "7.343623·10⁻⁷"]
    assert rows["cross-level-high"][3] == "1.305533·10⁻⁶"
    assert rows["vertical-high"][8:] == ["1.60 mm", "1.50 mm"]


@pytest.mark.parametrize(
    "draw",
    [
        lambda figure, made: paper.friction_curves(figure, made.friction),
        lambda figure, made: paper.slips(figure, made.small.trials, "afsmc", 0.14),
        lambda figure, made: paper.velocities(figure, made.small.trials, "afsmc", 0.55),
        lambda figure, made: paper.torques(
            figure, made.small.trials, ("trenitalia",), ("table10-dry", "polach-dry")
        ),
        lambda figure, made: paper.input_and_torque(
            figure, made.small.trials, "afsmc", ("table10-dry", "polach-dry")
        ),
        lambda figure, made: paper.vertical_forces(
            figure, made.small.trials, "afsmc", ("table10-wet", "polach-wet")
        ),
    ],
)
def test_axes_of_the_paper_have_units(draw):
    with figure_style():
        figure = draw(new_figure(height=3.0), sample_reproduction())
        figure.draw_without_rendering()
    labels = [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]
    assert all(re.match(r".+ \[(-|s|km/h|kN|kN m)\]$", label) for label in labels if label)
    assert any(labels)
    for axes in figure.axes:
        labeled = [line for line in axes.get_lines() if not line.get_label().startswith("_")]
        assert len({line.get_linestyle() for line in labeled} | {"train"}) >= min(len(labeled), 4)


def test_the_papers_wheelset_1_is_the_last_one():
    made = sample_reproduction()
    run = made.small.trials["trenitalia", "table10-dry"].run
    with figure_style():
        figure = paper.torques(
            new_figure(height=3.0), made.small.trials, ("trenitalia",), ("table10-dry", "polach-dry")
        )
    (line,) = figure.axes[0].get_lines()
    drawn = dict(zip(line.get_xdata(), line.get_ydata(), strict=True))
    for time, torque in drawn.items():
        assert torque == run.torque[run.time.tolist().index(time), 3] / 1e3


def test_everything_on_the_multibody_model_says_what_is_inferred(document):
    shown = [
        each
        for each in document.blocks
        if isinstance(each, Figure | Table)
        and each.anchor.startswith(("locomotive-", "irregular-", "inferred-"))
    ]
    # Seven tables, Figures 9 to 21 and one of them again, three figures of single numbers.
    assert len(shown) == 24
    model = load_multibody("er24pc-82")
    for each in shown:
        assert plain(each.caption).endswith(mark(model))


def test_lost_tables_are_filled_with_what_is_marked(document):
    rows = {plain(row[0]): [plain(cell) for cell in row] for row in _table(document, "table8").rows}
    assert rows["car body"][2] == "48841"
    assert all(row[-1].startswith("inferred") for row in rows.values())
    degrees = [int(plain(row[-1])) for row in _table(document, "table7").rows]
    assert sum(degrees) == 82
    of_paper = {plain(row[0]): [plain(cell) for cell in row] for row in _table(document, "table6").rows}
    assert of_paper["mass of locomotive"][1:] == [
        "76841 kg",
        "mass",
        "the multibody model",
        "76841 kg",
        "printed",
    ]
    assert of_paper["track gauge"][-1] == "inferred: assumed"
    assert len(of_paper) == 11


def test_a_conclusion_that_changes_is_told_with_its_numbers(document):
    """In the sample no weight shifts on irregular track."""
    text = " ".join(plain(each.text) for each in document.blocks if isinstance(each, Paragraph))
    assert "all 14 conclusions are judged as on the small model" in text
    assert "weight (does not hold)" in text
    cells = {plain(row[0]): row for row in _table(document, "locomotive-conclusions").rows}
    row = cells["Braking shifts weight to the front wheelsets."]
    assert [cell.status for cell in row[1:]] == [Status.HOLDS, Status.HOLDS, Status.FAILS]


def test_the_strongest_number_is_named_with_what_it_does(document):
    text = " ".join(plain(each.text) for each in document.blocks if isinstance(each, Paragraph))
    assert "5 stops with afsmc on table10-wet, on the plant locomotive" in text
    assert "load of the first wheelset by braking: traction rod: height, by up to 6.0 %" in text
    rows = {plain(row[0]): [plain(cell) for cell in row] for row in _table(document, "inferred-table").rows}
    assert rows["traction rod: height"][2:5] == ["inferred: assumed", "200.000 / 201.000", "5.0 / 16.0"]
    assert rows["conicity"][2:4] == ["printed", "200.000 / \N{EN DASH}"]


def test_a_page_without_the_multibody_model_has_none_of_it():
    small = reproduction_document(replace(sample_reproduction(), locomotive=None), DATE)
    number(small)
    assert unreferenced(small) == ()
    anchors = {getattr(each, "anchor", "") for each in small.blocks}
    assert "paper-figure-8" not in anchors
    assert "paper-figure-9" in anchors
