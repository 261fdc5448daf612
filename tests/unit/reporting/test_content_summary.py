"""Page one: the decision is that of the requirements, its first reason the first cause, its numbers of records."""

import math
import re
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.unit.reporting.sample_dossier import (
    SOUND,
    WANTED,
    certificate,
    drawn,
    faults,
    judged,
    sample_dossier,
    trial,
    uncertainty,
)
from wspd_design.certificates.records import Status
from wspd_design.design.requirements import Limit
from wspd_design.design.stop_requirements import paper_requirements
from wspd_design.reporting.blocks import Cell, Definitions, KeyNumbers, Table
from wspd_design.reporting.blocks import Status as Shown
from wspd_design.reporting.sections.summary import summary, verdict
from wspd_design.reporting.text import Link, plain
from wspd_design.simulation.records import Sensing
from wspd_design.simulation.runs import Ending
from wspd_design.studies.judgment import Outcome
from wspd_design.studies.loop_growth import Growth
from wspd_design.studies.next_step import Alternative, NextStep

STATUSES = st.lists(st.sampled_from(Status), min_size=1, max_size=9).map(tuple)
GROWING = Growth(factor=1.7, speed=20.0, unstable=25, speeds=25)


def _table(blocks, anchor):
    return next(each for each in blocks if isinstance(each, Table) and each.anchor == anchor)


def _rows(dossier):
    """Rows of the decision by their terms."""
    found = {}
    for block in summary(dossier):
        if isinstance(block, Definitions):
            found |= {plain(row.term): row.text for row in block.rows}
    return found


@settings(deadline=None, max_examples=40)
@given(STATUSES)
def test_only_a_check_that_decides_a_requirement_decides(statuses):
    dossier = sample_dossier(statuses)  # the first check decides R1
    said = verdict(dossier)
    first = statuses[0]
    if first is Status.REFUTED:
        assert said.status is Shown.REJECTED
        assert plain(said.sentence).startswith(
            "Rejected: it misses R1 of 4 requirements (sample); first R1, "
        )
    elif first is Status.UNDECIDED:
        assert said.status is Shown.UNDECIDED
        assert plain(said.sentence).startswith("Not decided: R1 of 4 requirements (sample) is open")
    else:
        assert said.status is Shown.ACCEPTED
        assert "not measured" in plain(said.sentence)


@settings(deadline=None, max_examples=40)
@given(STATUSES)
def test_what_is_refuted_and_decides_nothing_is_told(statuses):
    dossier = sample_dossier(statuses)
    told = _rows(dossier).get("Refuted, not counted", ())
    bad = (Status.REFUTED, Status.LIMITATION)
    others = [each.name for each in dossier.certificates[1:] if each.status in bad]
    named = [part.anchor for part in told if isinstance(part, Link)]
    assert sorted(named) == sorted(f"check-{name.replace('_', '-')}" for name in others)


@settings(deadline=None, max_examples=40)
@given(st.floats(0.0, 2.0), st.floats(0.01, 2.0))
def test_no_limit_that_is_missed_is_green(lock, allowed):
    wanted = replace(WANTED, limits=(Limit(criterion="longest_lock", value=allowed),))
    dossier = judged(sample_dossier((Status.PROVED,), trials=(trial("mine", judged_lock=lock),)), wanted)
    row = next(each for each in dossier.judgment.rows if each.name == "longest_lock")
    assert row.margin == pytest.approx((allowed - lock) / allowed)
    shown = next(each for each in _table(summary(dossier), "requirements-table").rows if each[0] == row.id)
    cell = shown[-1]
    assert isinstance(cell, Cell)
    assert (cell.status.tone == "good") == (lock <= allowed) == (verdict(dossier).status.tone == "good")


def test_causes_come_before_their_effects():
    wanted = paper_requirements(sample_dossier().specification)
    sound = replace(sample_dossier(()), certificates=(*SOUND, certificate("margins", Status.REFUTED)))
    dossier = judged(sound, wanted, GROWING)
    assert [each.name for each in dossier.judgment.missed] == ["loop", "slip_rms", "slip_overshoot"]
    said = plain(verdict(dossier).sentence)
    assert "it misses R2, R3 and R4 of 6 requirements (paper); first R2, growth of a deviation" in said
    assert "1.7, allowed < 1" in said
    weakest = plain(_rows(dossier)["Weakest link"])
    for words in (
        "sampled every 100 ms behind a valve of 0.6 s",
        "25 of 25 speeds",
        "1.7 per sample at 72 km/h",
    ):
        assert words in weakest


def test_a_loop_of_which_no_check_speaks_is_told_and_judged_by_the_stop():
    wanted = paper_requirements(sample_dossier().specification)
    silent = (*SOUND, certificate("margins", Status.NOT_APPLICABLE))
    good = trial("mine", held_slip_rms=0.01, slip_overshoot=0.02)
    dossier = judged(replace(sample_dossier((), trials=(good,)), certificates=silent), wanted)
    assert dossier.judgment.rows[1].outcome is Outcome.TOLD
    assert dossier.judgment.accepted
    proved = judged(replace(dossier, certificates=(*silent, certificate("slip_band", Status.PROVED))), wanted)
    assert (proved.judgment.rows[1].outcome, proved.judgment.rows[1].checks) == (Outcome.MET, ("slip_band",))


def test_no_evidence_counts_without_sound_equations():
    broken = tuple(replace(each, status=Status.REFUTED) for each in SOUND[:1])
    dossier = drawn(sample_dossier(()))
    assert verdict(dossier).status is Shown.ACCEPTED
    planted = replace(sample_dossier(()), certificates=broken)
    wanted = paper_requirements(planted.specification)
    assert judged(planted, wanted).judgment.missed[0].name == "sound"


def test_a_slip_that_never_reaches_its_reference_is_missed_where_a_perfect_law_reaches_it():
    def outcome(perfect):
        own = trial("mine", held_slip_rms=math.nan, slip_overshoot=math.nan, perfect_slip_rms=perfect)
        rows = judged(sample_dossier((Status.PROVED,), trials=(own,))).judgment.rows
        return next(each.outcome for each in rows if each.name == "slip_rms")

    assert outcome(0.001) is Outcome.MISSED
    assert outcome(math.nan) is Outcome.OPEN  # a brake that cannot slide


def test_a_train_that_does_not_stop_is_rejected():
    endless = trial("mine", ending=Ending.TIME_LIMIT, build_up=math.nan)
    dossier = sample_dossier((Status.PROVED,), trials=(endless,))
    assert verdict(dossier).status is Shown.REJECTED
    assert "does not end" in plain(verdict(dossier).sentence)
    tiles = summary(dossier)[0]
    assert isinstance(tiles, KeyNumbers)
    assert tiles.numbers[0].label == "Distance, still moving"
    assert "nan" not in str(tiles)
    assert verdict(drawn(dossier)).status is Shown.REJECTED


def test_drawn_stops_decide_a_design_that_was_made_for_them():
    met = drawn(sample_dossier(()))
    said = plain(verdict(met).sentence)
    assert "Accepted: it meets all 4 requirements (own) on 200 stops that no search has seen, seed 77" in said
    missed = drawn(sample_dossier(()), longest_lock=0.11)
    assert verdict(missed).status is Shown.REJECTED
    assert "it misses R3 of 4 requirements (own); first R3, longest lock above 10 km/h: 0.11 s" in plain(
        verdict(missed).sentence
    )
    assert verdict(drawn(sample_dossier(()), efficiency_mean=math.nan)).status is Shown.REJECTED
    assert summary(missed)[0].numbers[2].value == "3 of 4"


def test_the_weakest_link_of_an_accepted_design_is_its_smallest_reserve():
    # 98.12 % over 97.5 % against 0.04 s under 0.1 s.
    assert "R2, mean efficiency: 98.1 %, allowed ≥ 97.5 %: the smallest reserve, +0.64 %" in plain(
        _rows(drawn(sample_dossier(())))["Weakest link"]
    )
    other = drawn(sample_dossier(()), longest_lock=0.0999)
    assert "R3, longest lock above 10 km/h" in plain(_rows(other)["Weakest link"])


def test_the_scope_writes_units_as_every_table_does():
    dossier = sample_dossier(())
    disturbed = replace(dossier.scenario, sensing=Sensing(accelerometer_noise=0.05))
    said = plain(_rows(replace(dossier, scenario=disturbed))["Scope"])
    assert "accelerometer noise 0.05 m/s² rms" in said


def test_an_alternative_of_which_no_check_judges_a_requirement_does_not_meet_everything():
    wanted = paper_requirements(sample_dossier().specification)
    dossier = judged(sample_dossier(()), wanted)
    tried = (
        Alternative(law="super-twisting", sample_time=0.1, missed=(), distance=290.4, silent=("loop",)),
        Alternative(law="torque-feedback", sample_time=0.1, missed=(), distance=292.0),
    )
    said = plain(_rows(replace(dossier, next_step=NextStep(tried=tried, stops=1)))["Next"])
    assert (
        "these meet everything: sampled every 100 ms torque-feedback (292 m); these meet all but R2, which"
        in said
    )
    assert (
        "no check judges for their laws: sampled every 100 ms super-twisting (290 m) (2 alternatives" in said
    )


def test_limits_that_fail_beyond_what_the_drawn_stops_vary_stand_on_page_one():
    dossier = replace(drawn(sample_dossier(())), uncertainty=uncertainty())
    assert dossier.judgment.accepted
    said = plain(_rows(dossier)["Over all bounds"])
    # The stops draw the rail within its bounds and hold the mass; no set of the spread locks a wheel.
    assert "the stops of the requirements hold mass at" in said
    assert "stops on polach-wet that draw all numbers keeps R3 (0 s)" in said
    locking = uncertainty()
    locking = replace(
        locking,
        spreads=tuple(
            replace(each, high=0.4) if each.name == "longest_lock" else each for each in locking.spreads
        ),
    )
    assert "misses R3 (0.4 s)" in plain(_rows(replace(dossier, uncertainty=locking))["Over all bounds"])
    assert "Over all bounds" not in _rows(drawn(sample_dossier(())))
    assert "Over all bounds" not in _rows(replace(judged(sample_dossier(())), uncertainty=uncertainty()))


def test_the_next_step_is_what_was_tried():
    dossier = drawn(sample_dossier(()), longest_lock=0.2)
    tried = (
        Alternative(law="super-twisting", sample_time=0.1, missed=(), distance=290.4),
        Alternative(law="torque-feedback", sample_time=0.02, missed=(), distance=292.0),
        Alternative(law="afsmc", sample_time=0.02, missed=("longest_lock",), distance=310.0),
    )
    said = plain(_rows(replace(dossier, next_step=NextStep(tried=tried, stops=1)))["Next"])
    assert "these meet everything: sampled every 100 ms super-twisting (290 m); sampled every 20 ms" in said
    assert "3 alternatives tried, gains by their rules, 1 stop each" in said
    assert "The same law sampled every 20 ms still misses R3." in said
    worse = replace(dossier, next_step=NextStep(tried=tried[2:], stops=200))
    assert (
        "nothing meets everything (1 alternative tried, gains by their rules, 200 stops each); closest is afsmc"
        in plain(_rows(worse)["Next"])
    )
    assert "nothing that is required is missed" in plain(_rows(drawn(sample_dossier(())))["Next"])


def test_a_brake_that_lets_no_wheel_slide_shows_nothing_about_a_law():
    idle = "No wheel slides in it: nothing is shown about the law."
    busy = sample_dossier()
    assert idle not in plain(verdict(busy).sentence)
    dossier = replace(busy, idle=True, adhesion_use="The brake asks for 58 %: wheels slide on very-low.")
    assert plain(verdict(dossier).sentence).endswith(idle)
    assert "wheels slide on very-low" in plain(_rows(dossier)["Weakest link"])
    assert "judge it where wheels slide; on polach-wet no law has anything to do" in plain(
        _rows(dossier)["Next"]
    )


def test_faults_that_a_design_does_not_bear_stand_on_page_one():
    assert "With a fault" not in _rows(replace(sample_dossier(), robustness=faults()))
    locked = replace(faults().faults[0], locks=(0.0, 0.6, 0.0, 0.0))
    planted = replace(sample_dossier(), robustness=faults(faults=(locked, *faults().faults[1:])))
    assert "speed sensor lost" in plain(_rows(planted)["With a fault"])


def test_the_rank_counts_the_stops():
    said = plain(
        _rows(
            sample_dossier(
                trials=(trial("mine"), trial("good", distance=180.0), trial("bad", distance=201.0))
            )
        )["Against the others"]
    )
    assert said.startswith("2 of 3 by distance on this stop: 188 m; good 180, bad 201; ideal stop 174.2 m")


@settings(deadline=None, max_examples=40)
@given(st.lists(st.sampled_from(Status), min_size=3, max_size=3))
def test_the_ladder_counts_every_check_once(statuses):
    names = ("reaching", "routh_lag", "tracking")
    dossier = replace(sample_dossier(()), certificates=tuple(map(certificate, names, statuses)))
    rows = {row[0]: row[1:] for row in _table(summary(dossier), "evidence-ladder").rows}
    counted = sum(int(cell) for row in rows.values() for cell in row if cell.isdigit())
    silent = (Status.VACUOUS, Status.NOT_APPLICABLE)
    assert counted == sum(each not in silent for each in statuses)
    assert set(rows["measured on a vehicle"]) == {"–"}


def test_key_numbers_are_those_of_the_records():
    dossier = sample_dossier()
    tiles = summary(dossier)[0]
    assert isinstance(tiles, KeyNumbers)
    figures = dossier.trials[0].metrics
    low, high = dossier.specification.speeds
    poles = [each.slip_pole for each in dossier.linearizations if low <= each.speed <= high]
    shown = [float(re.match(r"[−\d.]+", each.value)[0].replace("−", "-")) for each in tiles.numbers]
    wanted = (figures.distance, 100.0 * figures.efficiency, 4, max(poles))
    for value, record, places in zip(shown, wanted, (0, 1, 0, 1), strict=True):
        assert abs(value - record) <= 0.5 * 10.0**-places * 1.0000001
    assert [each.unit for each in tiles.numbers] == ["m", "%", "", "1/s"]
    assert "in 10.0 s; brake built up after 1.2 s" in plain(tiles.numbers[0].note)
    assert summary(replace(dossier, growth=GROWING))[0].numbers[3].value == "1.7"
