"""The signs that every proof takes for granted."""

from dataclasses import replace

import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed
from wspd_design.certificates.checks.foundations import well_posed
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems import signs
from wspd_design.parameters.bounds import EXACT


@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet", "table10-dry"])
def test_signs_hold_on_level_track(make_problem, make_controller, rail):
    kept = keep(well_posed.CHECK, make_problem(make_controller("none"), rail=rail))
    assert kept.certificate.status is Status.PROVED
    assert {name.split(",")[0] for name in kept.content["findings"]} == {
        "deceleration",
        "adhesion",
        "gain",
        "rate",
    }
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)


def test_train_that_is_pushed_is_outside_the_model(make_problem, make_controller, er24pc):
    """A resistance that pushes has no meaning in the table of quantities: nothing is said about such a train."""
    pushed = replace(er24pc, resistance_constant=-700e3, bounds=EXACT)
    verdict = well_posed.CHECK.run(make_problem(make_controller("none"), vehicle=pushed))
    assert verdict.status is Status.UNDECIDED
    assert "negative" in verdict.explanation


def test_a_wrong_sign_in_the_model_is_refuted(make_problem, make_controller, monkeypatch):
    """The planted fault: a deceleration with the wrong sign, in kernel and arranged form alike."""
    problem = make_problem(make_controller("none"))
    right = signs.SIGNS[0]
    wrong = right._replace(
        kernel=lambda plant, x: -right.kernel(plant, x), form=lambda arranged, x: -right.form(arranged, x)
    )
    monkeypatch.setattr(signs, "SIGNS", (wrong, *signs.SIGNS[1:]))
    kept = keep(well_posed.CHECK, problem)
    assert kept.certificate.status is Status.REFUTED
    assert [h.status for h in kept.certificate.hypotheses] == [Status.REFUTED, *[Status.PROVED] * 3]
    assert {point.name: point.value for point in kept.certificate.witness}["deceleration a"] < 0.0
