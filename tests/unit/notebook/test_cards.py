"""Records show themselves: in one line, as a table with units, as a card of HTML that brings all that it needs."""

import re
from dataclasses import fields, replace
from html.parser import HTMLParser

import pytest

import wspd_design as wd
from wspd_design.notebook import html
from wspd_design.notebook.proofs import proofs_card, replayed_card
from wspd_design.parameters.table import Column, table_of

NAMES = (
    *(
        "vehicle",
        "rail",
        "design",
        "linearization",
        "trials",
        "trial",
        "run",
        "metrics",
        "proofs",
        "certificate",
    ),
    *("campaign", "traces"),
)
TABLES = ("vehicle", "rail", "design", "linearization", "trials", "trial", "metrics", "proofs")
EMPTY = {"meta", "br", "hr", "img", "input", "use", "path"}


class Structure(HTMLParser):
    """Elements that are open, and all text outside the style."""

    def __init__(self):
        super().__init__()
        self.open, self.text, self.tags = [], "", set()

    def handle_starttag(self, tag, _attributes):
        self.tags.add(tag)
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, _attributes):
        self.tags.add(tag)

    def handle_endtag(self, tag):
        if tag not in EMPTY:
            assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] != ["style"]:
            self.text += data


def structure(card):
    found = Structure()
    found.feed(card)
    assert found.open == []
    return found


@pytest.mark.parametrize("name", NAMES)
def test_a_record_is_one_line_of_text(shown, name):
    text = repr(getattr(shown, name))
    assert re.fullmatch(r"<[A-Z]\w+.*>", text)
    assert len(text) < 200
    assert "array(" not in text


@pytest.mark.parametrize("name", NAMES)
def test_a_card_is_whole_and_asks_no_other_host(shown, name):
    card = getattr(shown, name)._repr_html_()
    found = structure(card)
    assert {"div", "style"} <= found.tags
    assert not {"script", "link", "img", "iframe", "object"} & found.tags
    places = set(re.findall(r"(?:https?:)?//[\w.]+", card)) - {"http://www.w3.org"}
    assert places == set()
    assert not re.search(r"\son\w+=|url\((?!#)|@import", card)


@pytest.mark.parametrize("name", ["rail", "trial", "campaign"])
def test_a_card_is_the_same_each_time(shown, name):
    assert getattr(shown, name)._repr_html_() == getattr(shown, name)._repr_html_()


def test_dark_pages_of_each_host_get_other_colors(shown):
    card = shown.rail._repr_html_()
    for host in (
        '[data-jp-theme-light="false"]',
        '[data-theme="dark"]',
        ".vscode-dark",
        "prefers-color-scheme:dark",
    ):
        assert host in card


def test_names_are_escaped(shown):
    planted = "<script>alert(1)</script>"
    for record in (replace(shown.vehicle, name=planted), replace(shown.rail, name=planted)):
        card = record._repr_html_()
        assert "<script" not in card
        assert planted in structure(card).text
    run = replace(shown.run, controller=planted, rail=planted)
    trial = replace(shown.trial, run=run)
    for record in (run, trial, wd.Comparison([trial])):
        assert "<script" not in record._repr_html_()


@pytest.mark.parametrize("name", TABLES)
def test_a_table_shows_itself_as_text_and_html(shown, name):
    table = getattr(shown, name).table()
    lines = str(table).splitlines()
    assert lines[0] == table.caption
    assert any(set(line) == {"-"} for line in lines)
    text = structure(table._repr_html_()).text
    for row in table.texts:
        assert all(cell in text for cell in row)


def test_units_stand_below_titles_and_in_columns_of_frames(shown):
    pytest.importorskip("pandas")
    table = shown.trials.table()
    frame = table.to_pandas()
    assert frame["distance [m]"].tolist() == [trial.metrics.distance for trial in shown.trials]
    assert "[m]" in str(table).splitlines()[3]
    assert f"{shown.trials[0].metrics.distance:.1f}" in str(table)


def test_values_of_a_vehicle_are_those_of_its_record(shown):
    rows = {row[0]: row for row in shown.vehicle.table().rows}
    assert rows["mass"][1:4] == (76.841, "t", "61.47 to 92.21")
    assert rows["brake.max_torque"][1:3] == (60.0, "kN m")
    assert rows["contact.shear_modulus"][1:3] == (84.0, "GPa")
    assert rows["brake.max_pressure"][1:3] == (6.0, "bar")
    assert rows["wheelset_inertia"][2] == "kg m²"
    assert "brake.hold_leak" not in rows  # as a file that leaves it out
    assert all(row[4] for row in rows.values())


def test_gains_have_reasons(shown):
    table = shown.design.table()
    assert [row[0] for row in table.rows] == [gain.name for gain in shown.design.gains]
    assert all(row[3] for row in table.rows)


def test_a_refuted_check_is_never_green(shown):
    assert {each.status.name for each in shown.proofs} == {"PROVED", "REFUTED"}
    card = shown.proofs._repr_html_()
    verdict = re.search(r'<p class="verdict (\w+)">([^<]*)', card)
    assert verdict[1] == "bad"
    assert verdict[2] == "2 checks of this closed loop: 1 refuted, 1 proved"
    assert '<span class="verdict bad">✗ refuted' in card


def test_a_table_of_proofs_has_the_first_sentence_and_says_where_the_rest_is(shown):
    table = shown.proofs.table()
    for row, certificate in zip(table.rows, shown.proofs, strict=True):
        assert certificate.explanation.startswith(row[-1])
        assert row[-1].endswith(".")
        assert certificate.explanation in structure(certificate._repr_html_()).text
    assert any(".named(NAME)" in note for note in table.notes)
    assert "claim" not in [
        column.title for column in table.columns
    ]  # it stands with its domain, on the one card


@pytest.mark.parametrize(
    ("statuses", "tone"),
    [
        (("PROVED",), "good"),
        (("PROVED", "NOT_APPLICABLE"), "good"),
        (("NOT_APPLICABLE",), "open"),
        (("PROVED", "UNDECIDED"), "open"),
        (("PROVED", "EVIDENCE"), "open"),
        (("PROVED", "VACUOUS"), "open"),
        (("PROVED", "LIMITATION"), "bad"),
        (("PROVED", "REFUTED"), "bad"),
    ],
)
def test_only_what_is_proved_is_green(shown, statuses, tone):
    made = [replace(shown.certificate, status=wd.Status[each]) for each in statuses]
    assert f'<p class="verdict {tone}">' in proofs_card(made)


def test_a_train_that_does_not_stop_is_told(shown):
    run = replace(shown.run, ending=wd.Ending.TIME_LIMIT)
    trial = replace(shown.trial, run=run)
    assert '<p class="verdict bad">The train was still moving at the time limit' in trial._repr_html_()
    both = wd.Comparison([shown.trials[1], trial])
    assert "1 of 2 laws did not stop the train" in both._repr_html_()
    assert [row[-1] for row in both.table().rows][1].startswith("did not stop")


def test_a_sensitive_stop_is_told(shown):
    check = replace(shown.trial.check, sensitive=True, spread=0.5)
    table = wd.Comparison([replace(shown.trial, check=check)]).table()
    assert table.rows[0][-1].startswith("sensitive, ± 0.25 m")
    assert any("nobody can measure" in note for note in table.notes)


def test_trains_that_did_not_stop_are_left_out_and_told(shown):
    table = shown.campaign.table.copy()
    table["stopped"][3] = False
    table["distance_m"][3] = 1e6
    campaign = replace(shown.campaign, table=table)
    rows = {row[0]: row[2:] for row in campaign.spread().rows}
    assert max(rows["distance_m"]) < 1e6
    assert "1 of 20 did not stop" in campaign._repr_html_()


def test_the_pole_says_what_it_means(shown):
    point = shown.linearization
    assert "doubles in" in point._repr_html_()
    assert "halves in" in replace(point, slip_pole=-2.0)._repr_html_()
    assert "does not decide" in replace(point, slip_pole=0.0)._repr_html_()


def test_a_long_table_says_what_it_leaves_out():
    table = table_of(range(html.MOST_ROWS + 5), [Column(title="n", read=lambda n: n)])
    text = structure(table._repr_html_()).text
    assert "5 more rows are not shown" in text
    assert str(html.MOST_ROWS + 4) in str(table)


def test_a_checked_file_says_whether_it_is_accepted(shown, tmp_path):
    wd.certify(shown.design, only=["gain_positive"], folder=tmp_path)
    accepted = wd.check(tmp_path / "gain_positive.json", shown.design)
    assert repr(accepted) == "<Replayed gain_positive: accepted, PROVED>"
    assert 'class="verdict good"' in replayed_card(accepted)
    text = (tmp_path / "gain_positive.json").read_text(encoding="utf-8").replace("More torque", "Less torque")
    refused = wd.check(text, shown.design)
    assert "refused: " in repr(refused)
    assert 'class="verdict bad">Refused: ' in replayed_card(refused)


def test_collections_are_tuples(shown):
    assert isinstance(shown.trials, tuple)
    assert isinstance(shown.proofs, tuple)
    assert shown.trials == tuple(shown.trials)
    assert shown.proofs.named("sampling").status is wd.Status.REFUTED
    with pytest.raises(wd.UserError, match=r'no certificate of the check "sampling2" here; there are'):
        shown.proofs.named("sampling2")


def test_frames_have_all_numbers(shown):
    pytest.importorskip("pandas")
    frame = shown.trials.to_pandas()
    assert frame.loc["none", "distance"] == shown.trials[1].metrics.distance
    assert {field.name for field in fields(wd.Metrics)} <= set(frame.columns)
    assert shown.proofs.to_pandas().loc["sampling", "status"] == "REFUTED"
    rows = shown.campaign.to_pandas()
    assert "rail.mu0" in rows
    assert "rail.friction_decay_s_m" in rows
    assert rows["distance_m"].tolist() == shown.campaign.table["distance_m"].tolist()
    assert rows.attrs["units"]["rail.friction_decay_s_m"] == "s/m"


def test_without_pandas_the_extra_is_named(shown, monkeypatch):
    from wspd_design.notebook import frames

    monkeypatch.setattr(frames, "find_spec", lambda _name: None)
    with pytest.raises(
        wd.UserError, match=r'needs pandas, which is not installed: pip install "wspd-design\[frames\]"'
    ):
        shown.trials.to_pandas()
