"""The signs that every proof takes for granted."""

from dataclasses import replace

import pytest

from wspd_design.certificates.checks.foundations import well_posed
from wspd_design.certificates.records import Status


@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet", "table10-dry"])
def test_signs_hold_on_level_track(make_problem, make_controller, rail):
    verdict = well_posed.check(make_problem(make_controller("none"), rail=rail))
    assert verdict.status is Status.PROVED
    assert len(verdict.proofs) == 4


def test_train_that_is_pushed_is_refuted(make_problem, make_controller, er24pc):
    pushed = replace(er24pc, resistance_constant=-700e3)
    verdict = well_posed.check(make_problem(make_controller("none"), vehicle=pushed))
    assert verdict.status is Status.REFUTED
    assert [(h.text.split()[0], h.status) for h in verdict.hypotheses] == [
        ("deceleration", Status.REFUTED),
        ("adhesion", Status.PROVED),
        ("input", Status.PROVED),
        ("rate", Status.REFUTED),
    ]
    assert {point.name: point.value for point in verdict.witness}["deceleration a"] < 0.0
