"""The Mitsubishi fuzzy controller: every rule of Table 5, max-product inference, and the sign of its rows."""

from dataclasses import replace

import pytest

from wspd_design.controllers.baselines.mitsubishi import triangles
from wspd_design.controllers.protocol import Measurement
from wspd_design.parameters.loading import load_mitsubishi, load_rail
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

RADIUS, PERIOD = 0.55, 0.1

# Table 5 as printed. Rows from BNB to BPB, columns SZO, SPS, SPM, SPB.
TABLE_5 = (
    "IB IB IS IS",
    "IM IM IS IS",
    "IS IS IS IS",
    "ZO ZO ZO IS",
    "DS ZO DS DM",
    "DS DS DM DM",
    "DM DM DM DB",
)
ROWS, COLUMNS = 7, 4
TEXTBOOK = {"DB": 0.0, "DM": 0.25, "DS": 0.5, "ZO": 0.8, "IS": 0.88, "IM": 0.95, "IB": 1.0}  # data book 7
CALIBRATED = {"DB": -1, "DM": -2 / 3, "DS": -1 / 3, "ZO": 0, "IS": 1 / 3, "IM": 2 / 3, "IB": 1}  # section 13


def decide(controller, slide, rate, speed=25.0):
    """Duty at a slide [m/s] and its rate [m/s2]."""
    before = Measurement(speed=speed, wheel_speed=(speed - slide + rate * PERIOD) / RADIUS, torque=0.0)
    now = Measurement(speed=speed, wheel_speed=(speed - slide) / RADIUS, torque=0.0)
    command = controller.step(controller.start(before), now)[1]
    assert command.fill + command.vent == 1.0
    return command.fill


@pytest.mark.parametrize("preset", ["textbook", "calibrated"])
@pytest.mark.parametrize("row", range(ROWS))
@pytest.mark.parametrize("column", range(COLUMNS))
def test_every_rule_alone(make_controller, preset, row, column):
    # At the peak of one membership of each input no other rule fires.
    controller = make_controller("mitsubishi", preset=preset)
    table, word = controller.table, TABLE_5[row].split()[column]
    # Data book section 13: absolute duty = .841 + 1.831 y clipped to [0, 1].
    duty = TEXTBOOK[word] if preset == "textbook" else min(max(0.841 + 1.831 * CALIBRATED[word], 0.0), 1.0)
    got = decide(controller, table.slide_centres[column], table.rate_centres[row])
    assert got == pytest.approx(duty, abs=1e-12)


def test_centres_are_those_of_the_data_book():
    textbook, calibrated = load_mitsubishi("textbook"), load_mitsubishi("calibrated")
    assert [3.6 * x for x in textbook.slide_centres] == pytest.approx([0, 5, 10, 20])
    assert textbook.rate_centres == pytest.approx((-3, -2, -1, 0, 1, 2, 3))
    assert [3.6 * x for x in calibrated.slide_centres] == pytest.approx([0.48, 1.94, 3.63, 6.05])
    assert calibrated.rate_centres == pytest.approx((-6.21, -3.45, -1.38, 0, 1.38, 3.45, 6.21))


def test_between_the_peaks_the_strongest_rule_of_each_level_counts(make_controller):
    # Slide 6 km/h: SPS 0.8, SPM 0.2. Rate 1.25 m/s2: BPS 0.75, BPM 0.25. Products: ZO .6 (BPS, SPS),
    # DS .15 (BPS, SPM) and .2 (BPM, SPS), of which .2 counts, DM .05. Center average by hand.
    duty = decide(make_controller("mitsubishi", preset="textbook"), 6.0 / 3.6, 1.25)
    by_hand = (0.6 * 0.80 + 0.2 * 0.50 + 0.05 * 0.25) / (0.6 + 0.2 + 0.05)
    by_sum = (0.6 * 0.80 + 0.35 * 0.50 + 0.05 * 0.25) / 1.0
    assert duty == pytest.approx(by_hand, rel=1e-12)
    assert abs(by_hand - by_sum) > 0.01  # the test tells max-product from sum-product


def test_beyond_the_outer_peaks_the_memberships_stay_one(make_controller):
    controller = make_controller("mitsubishi", preset="textbook")
    assert decide(controller, 20.0, 50.0) == pytest.approx(0.0)
    assert decide(controller, -0.5, -50.0) == pytest.approx(1.0)


@pytest.mark.parametrize("value", [-9.0, 0.0, 0.7, 1.0, 2.5, 3.999, 4.0, 11.0])
def test_memberships_are_a_partition_of_unity(value):
    memberships = triangles((0.0, 1.0, 4.0), value)
    assert sum(memberships) == pytest.approx(1.0)
    assert all(0.0 <= m <= 1.0 for m in memberships)


def test_memberships_cross_at_one_half():
    assert triangles((0.0, 1.0, 4.0), 2.5) == (0.0, 0.5, 0.5)


@pytest.mark.parametrize("rail", ["table10-dry", "table10-wet", "polach-dry"])
def test_printed_sign_of_the_rows_makes_the_wheels_slide(er24pc, make_controller, stop, rail):
    # Table 5 prints -d sigma/dt. Read so, its rules fill while the slide grows.
    good = make_controller("mitsubishi")
    printed = replace(good, table=replace(good.table, rules=tuple(reversed(good.table.rules))))
    scenario = Scenario(rail=load_rail(rail), initial_speed=120.0 / 3.6)
    wrong, right = (
        simulate(er24pc, printed, scenario, plant="quarter").totals,
        stop("mitsubishi", rail).totals,
    )
    assert wrong.lock_time > right.lock_time + 0.4
    assert wrong.slip / wrong.judged_time > 2.0 * right.slip / right.judged_time
