"""Page one: the verdict is that of the checks and of the stop, and each number is that of a record."""

import math
import re
from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.unit.reporting.sample_dossier import certificate, faults, judgment, sample_dossier, trial
from wspd_design.certificates.records import Status
from wspd_design.reporting.blocks import Cell, KeyNumbers, Table
from wspd_design.reporting.blocks import Status as Shown
from wspd_design.reporting.sections.summary import summary, verdict
from wspd_design.reporting.text import Link, plain
from wspd_design.simulation.records import Ending

STATUSES = st.lists(st.sampled_from(Status), max_size=9).map(tuple)
GOOD_STOP = {"slip_rms": 0.01}


def _good(*statuses):
    return sample_dossier(statuses, trials=(trial("mine", **GOOD_STOP),))


@settings(deadline=None)
@given(STATUSES)
def test_a_refuted_check_always_shows(statuses):
    for dossier in (_good(*statuses), sample_dossier(statuses)):
        said = verdict(dossier)
        bad = (Status.REFUTED, Status.LIMITATION)
        refuted = [each for each in dossier.certificates if each.status in bad]
        assert (said.status is Shown.REFUTED) == bool(refuted)
        if refuted:
            total = len(statuses)
            assert f"Not fit as it stands: {len(refuted)} of {total} checks refuted" in plain(said.sentence)
            for each in refuted:
                anchor = f"check-{each.name.replace('_', '-')}"
                assert anchor in [part.anchor for part in said.sentence if isinstance(part, Link)]
        else:
            assert not re.search(r"checks refuted|[1-9] refuted", plain(said.sentence))


@settings(deadline=None)
@given(STATUSES)
def test_every_check_is_counted(statuses):
    sentence = plain(verdict(_good(*statuses)).sentence)
    _, _, tally = sentence.partition("Checks: ")
    counted = re.findall(
        r"(\d+) (refuted|undecided|sampled only|proved to be a limitation|proved|vacuous|not applicable)",
        tally,
    )
    assert sum(int(number) for number, _ in counted) == len(statuses)
    proved = {word: int(number) for number, word in counted}.get("proved", 0)
    assert proved == statuses.count(Status.PROVED)


@settings(deadline=None)
@given(STATUSES)
def test_the_worst_finding_wins(statuses):
    order = (Status.REFUTED, Status.UNDECIDED, Status.EVIDENCE, Status.PROVED)
    shown = [Status.REFUTED if each is Status.LIMITATION else each for each in statuses]
    worst = next((status for status in order if status in shown), Status.VACUOUS)
    assert verdict(_good(*statuses)).status is Shown[worst.name]


def test_changing_one_status_changes_the_sentence():
    proved = _good(Status.PROVED, Status.PROVED)
    planted = replace(proved, certificates=(proved.certificates[0], certificate("two", Status.REFUTED)))
    assert verdict(proved).status is Shown.PROVED
    assert verdict(planted).status is Shown.REFUTED
    assert "1 of 2 checks refuted (check two)" in plain(verdict(planted).sentence)


def test_a_stop_outside_the_tolerance_spoils_a_proof():
    dossier = sample_dossier((Status.PROVED,), trials=(trial("mine", slip_rms=0.051),))
    assert verdict(dossier).status is Shown.BAD
    assert "0.051 rms, beyond the tolerance of 0.05" in plain(verdict(dossier).sentence)
    inside = sample_dossier((Status.PROVED,), trials=(trial("mine", slip_rms=0.049),))
    assert verdict(inside).status is Shown.PROVED
    assert "0.049 rms, within the tolerance" in plain(verdict(inside).sentence)


def test_a_train_that_does_not_stop_is_not_fit():
    endless = trial("mine", ending=Ending.TIME_LIMIT, lag=math.nan, plateau=math.nan, slip_rms=0.0)
    dossier = sample_dossier((Status.PROVED,), trials=(endless,))
    assert verdict(dossier).status is Shown.BAD
    assert "still moving" in plain(verdict(dossier).sentence)
    tiles = summary(dossier)[0]
    assert isinstance(tiles, KeyNumbers)
    assert tiles.numbers[0].label == "Distance, still moving"
    assert "nan" not in str(tiles)


@settings(deadline=None)
@given(STATUSES)
def test_what_meets_its_requirements_is_accepted_unless_a_check_is_refuted(statuses):
    dossier = replace(sample_dossier(statuses), judgment=judgment())  # with a slip rms beyond its tolerance
    said = verdict(dossier)
    refuted = {Status.REFUTED, Status.LIMITATION} & set(statuses)
    assert said.status is (Shown.REFUTED if refuted else Shown.ACCEPTED)
    sentence = plain(said.sentence)
    if not refuted:
        assert (
            "Accepted: it meets all 2 requirements on 200 stops that no search has seen, seed 77" in sentence
        )
        assert "shown by simulated stops, not proved" in sentence
        assert ("undecided:" in sentence) == (Status.UNDECIDED in statuses)
        assert ("sampled only:" in sentence) == (Status.EVIDENCE in statuses)


def test_an_accepted_design_names_the_faults_that_it_does_not_bear():
    accepted = replace(sample_dossier((Status.PROVED,)), judgment=judgment(), robustness=faults())
    assert "does not hold" not in plain(verdict(accepted).sentence)
    locked = replace(faults().faults[0], locks=(0.0, 0.6, 0.0, 0.0))
    planted = replace(accepted, robustness=faults(faults=(locked, *faults().faults[1:])))
    said = verdict(planted)
    assert said.status is Shown.ACCEPTED
    assert "It does not hold with a fault: speed sensor lost." in plain(said.sentence)


def test_a_missed_requirement_is_bad_news_whatever_is_proved():
    dossier = replace(_good(Status.PROVED), judgment=judgment(longest_lock=0.11))
    said = verdict(dossier)
    assert said.status is Shown.BAD
    assert "it misses 1 of 2 requirements (longest lock above 10 km/h)" in plain(said.sentence)
    tiles, _ = summary(dossier)
    assert tiles.numbers[2].value == "1 of 2"
    refuted = replace(_good(Status.REFUTED), judgment=judgment(longest_lock=0.11))
    assert "It misses 1 of 2 requirements (longest lock" in plain(verdict(refuted).sentence)


def test_a_figure_that_the_law_does_not_have_is_missed():
    dossier = replace(_good(Status.PROVED), judgment=judgment(efficiency_mean=math.nan))
    assert verdict(dossier).status is Shown.BAD


def test_a_train_that_does_not_stop_is_not_accepted():
    endless = trial("mine", ending=Ending.TIME_LIMIT, lag=math.nan, plateau=math.nan)
    dossier = replace(sample_dossier((Status.PROVED,), trials=(endless,)), judgment=judgment())
    assert verdict(dossier).status is Shown.BAD


def test_key_numbers_are_those_of_the_records():
    dossier = sample_dossier()
    tiles, _ = summary(dossier)
    assert isinstance(tiles, KeyNumbers)
    figures = dossier.trials[0].metrics
    low, high = dossier.design.specification.speeds
    poles = [each.slip_pole for each in dossier.linearizations if low <= each.speed <= high]
    shown = [float(each.value.replace("\N{MINUS SIGN}", "-")) for each in tiles.numbers]
    wanted = (figures.distance, 100.0 * figures.efficiency, figures.slip_rms, max(poles))
    for value, record, places in zip(shown, wanted, (1, 1, 3, 2), strict=True):
        assert abs(value - record) <= 0.5 * 10.0**-places * 1.0000001
    assert [each.unit for each in tiles.numbers] == ["m", "%", "", "1/s"]
    assert "(planar), in 10.00 s" in plain(tiles.numbers[0].note)
    assert "174.2 m" in plain(tiles.numbers[1].note)
    assert plain(tiles.numbers[3].note).endswith("1/τ = 1.67 1/s")


def test_two_valve_times_are_both_said():
    dossier = sample_dossier()
    entries = dict(dossier.vehicle.entries)
    entries["brake.vent_time"] = replace(entries["brake.vent_time"], value=0.15)
    tiles, _ = summary(replace(dossier, vehicle=replace(dossier.vehicle, entries=entries)))
    assert isinstance(tiles, KeyNumbers)
    said = plain(tiles.numbers[3].note)
    assert "there, between 1.67 1/s of filling and 6.67 1/s of venting" in said


def test_a_sensitive_stop_keeps_only_the_digits_that_it_has():
    tiles, _ = summary(sample_dossier(trials=(trial("mine", spread=1.8),)))
    assert isinstance(tiles, KeyNumbers)
    assert tiles.numbers[0].value == "187.7 ± 0.9"
    tiles, _ = summary(sample_dossier(trials=(trial("mine", spread=24.0),)))
    assert isinstance(tiles, KeyNumbers)
    assert tiles.numbers[0].value == "188 ± 12"


def test_the_table_names_every_check_with_its_finding():
    dossier = sample_dossier()
    _, table = summary(dossier)
    assert isinstance(table, Table)
    spoken = [each for each in dossier.certificates if each.status is not Status.NOT_APPLICABLE]
    assert len(table.rows) == len(spoken) + 1 == len(dossier.certificates)
    for row, each in zip(table.rows, spoken, strict=False):
        finding = row[1]
        assert plain(row[0]) == each.name
        assert isinstance(finding, Cell)
        assert finding.status.name == each.status.name
        assert row[3] == "≤ −1.25 1/s"


def test_a_limitation_that_is_proved_is_no_good_news():
    def dossier(status):
        limit = certificate("limit", status)
        good = _good(Status.PROVED)
        return replace(good, certificates=(*good.certificates, limit))

    said = verdict(dossier(Status.LIMITATION))
    assert said.status is Shown.REFUTED
    assert "1 of 2 checks refuted or proved to be a limitation (" in plain(said.sentence)
    assert "1 proved to be a limitation and 1 proved" in plain(said.sentence)
    (table,) = (block for block in summary(dossier(Status.LIMITATION)) if isinstance(block, Table))
    shown = [cell.status for row in table.rows for cell in row if isinstance(cell, Cell)]
    assert shown == [Shown.PROVED, Shown.LIMITATION]
    assert verdict(dossier(Status.VACUOUS)).status is Shown.PROVED


def test_a_lag_that_is_not_one_stays_off_page_one():
    """Where the friction falls during the stop the two-part model breaks; a negative build-up is nonsense."""

    def note(lag):
        own = trial("mine", lag=lag)
        numbers = next(
            block for block in summary(sample_dossier(trials=(own,))) if isinstance(block, KeyNumbers)
        )
        return plain(numbers.numbers[0].note)

    assert "1.26 s of build-up, then 3.81 m/s²" in note(1.259)
    for lag in (-1.51, math.nan):
        assert "build-up" not in note(lag)
        assert note(lag).endswith("in 10.00 s")
