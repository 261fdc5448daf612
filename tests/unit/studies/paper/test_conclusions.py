"""Each conclusion of the paper holds on numbers that say so, and falls when other numbers are planted."""

from dataclasses import replace

import pytest

from tests.unit.reporting.sample_reproduction import sample_evidence
from wspd_design.studies.paper.conclusions import conclusions
from wspd_design.studies.paper.conclusions.records import Verdict
from wspd_design.studies.paper.evidence import CONSTANT_RAILS, FALLING_RAILS, RAILS
from wspd_design.studies.paper.published import load_table10

GOOD = sample_evidence()


def _judged(evidence, name):
    return next(each for each in conclusions(evidence) if each.name == name)


def _stops(controller, rails=RAILS, history=None, **metrics):
    """Plant other figures of one controller."""
    return replace(
        GOOD,
        stops=tuple(
            replace(
                each,
                metrics=replace(each.metrics, **metrics),
                history=replace(each.history, **(history or {})),
            )
            if each.controller == controller and each.rail in rails
            else each
            for each in GOOD.stops
        ),
    )


def _ablations(**changes):
    return replace(GOOD, ablations=tuple(replace(each, **changes) for each in GOOD.ablations))


PLANTED = {
    "shortest": (_stops("afsmc", distance=300.0), "place 4 of 4, 90.0 m behind trenitalia"),
    "build-up": (replace(GOOD, published=load_table10()), "of the printed 23.3 m"),
    "locked": (_stops("none", distance=199.0), "table10-dry: locked 199.0 m, adaptive fuzzy 200.0 m"),
    "robustness": (_stops("afsmc", efficiency=0.5), "afsmc 50.0 %"),
    "convergence": (_stops("afsmc", history={"late_rms": 0.2}), "rms table10-dry 0.200"),
    "standstill": (
        _stops("afsmc", history={"standstill_rms": 0.9}),
        "table10-dry 0.90 against 0.20 and 0.30",
    ),
    "mitsubishi": (_stops("mitsubishi", slip_max=0.31), "table10-dry 0.31"),
    "frequency": (_stops("trenitalia", history={"torque_frequency": 9.0}), "trenitalia 9.00"),
    "relay": (_stops("afsmc", saturated_share=0.99), "in 99.0 % of"),
    "adaptation": (_ablations(unadapted=201.5), "changes the distance by 0.25 %"),
    "air": (_stops("trenitalia", vented_air=1.0), "is 1.0 to 3.2 full cylinders"),
    "friction": (
        replace(GOOD, yardsticks=tuple(replace(each, ideal_stop=250.0) for each in GOOD.yardsticks)),
        "250.0 m",
    ),
    "weight": (replace(GOOD, mean_loads=(189e3, 188.5e3, 188.2e3, 188e3)), "188 to 189 kN"),
    "grouping": (
        replace(GOOD, mean_loads=(211e3, 178e3, 198e3, 166e3)),
        "1 with 211 kN, 3 with 198 kN, 2 with 178 kN, 4 with 166 kN",
    ),
}


def test_every_conclusion_is_planted_against():
    assert set(PLANTED) == {each.name for each in conclusions(GOOD)}


def test_all_hold_on_good_numbers():
    assert {each.name for each in conclusions(GOOD) if each.verdict is not Verdict.HOLDS} == set()


@pytest.mark.parametrize("name", PLANTED)
def test_a_conclusion_falls_on_bad_numbers(name):
    evidence, said = PLANTED[name]
    judged = _judged(evidence, name)
    # Trenitalia alone cannot spoil all of the pairs that "frequency" consists of.
    expected = {"frequency": Verdict.PARTLY, "build-up": Verdict.PARTLY}.get(name, Verdict.FAILS)
    assert judged.verdict is expected
    assert said in judged.finding


@pytest.mark.parametrize(
    ("name", "figures", "history"),
    [
        ("shortest", {"distance": 300.0}, {}),
        ("robustness", {"efficiency": 0.5}, {}),
        ("convergence", {}, {"late_rms": 0.2}),
        ("standstill", {}, {"standstill_rms": 0.9}),
        ("relay", {"saturated_share": 0.99}, {}),
    ],
)
@pytest.mark.parametrize("rails", [CONSTANT_RAILS, FALLING_RAILS])
def test_a_conclusion_that_holds_on_some_rails_holds_in_part(name, figures, history, rails):
    assert _judged(_stops("afsmc", rails, history, **figures), name).verdict is Verdict.PARTLY


def test_a_relay_that_stops_alike_refutes_the_law_as_well():
    assert _judged(_ablations(relay=201.0), "relay").verdict is Verdict.FAILS


def test_weights_beyond_the_brake_refute_the_adaptation():
    judged = _judged(_ablations(largest_weight=540.0), "adaptation")
    assert judged.verdict is Verdict.FAILS
    assert "540 times the maximum torque" in judged.finding


def test_lag_explains_the_printed_table():
    # Data book section 13: lag 1.94 s against 1.24 s dry, 1.70 s against 1.04 s wet.
    finding = _judged(replace(GOOD, published=load_table10()), "build-up").finding
    assert "23.3 m between afsmc and knorr-bremse 23.3 m are lag" in finding
    assert "26.1 m between afsmc and knorr-bremse 22.2 m are lag" in finding
