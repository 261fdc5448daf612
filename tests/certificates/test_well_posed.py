"""The signs that every proof takes for granted."""

from dataclasses import replace

import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed
from wspd_design.certificates.checks.foundations import well_posed
from wspd_design.certificates.records import Status
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


def test_train_that_is_pushed_is_refuted(make_problem, make_controller, er24pc):
    pushed = replace(er24pc, resistance_constant=-700e3, bounds=EXACT)
    kept = keep(well_posed.CHECK, make_problem(make_controller("none"), vehicle=pushed))
    assert kept.certificate.status is Status.REFUTED
    assert [(h.text.split()[0], h.status) for h in kept.certificate.hypotheses] == [
        ("deceleration", Status.REFUTED),
        ("adhesion", Status.PROVED),
        ("input", Status.PROVED),
        ("rate", Status.REFUTED),
    ]
    assert {point.name: point.value for point in kept.certificate.witness}["deceleration a"] < 0.0
