"""Balances of the simulated stop, and stops that do not balance."""

import math
from dataclasses import replace

import pytest

from tests.certificates.round_trip import keep, no_word_can_be_changed, refused
from wspd_design.certificates.checks.foundations import conservation
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems import simulated_stop
from wspd_design.simulation.stop import simulate


@pytest.mark.parametrize("name", ["afsmc", "none", "torque-feedback"])
def test_balances_close(make_problem, make_controller, name):
    kept = keep(conservation.CHECK, make_problem(make_controller(name)))
    verdict = kept.certificate
    no_word_can_be_changed(kept)
    assert verdict.status is Status.EVIDENCE
    assert verdict.margin.high > 0.9
    assert {point.name.split(", ")[1] for point in verdict.worst_point} == {"planar", "quarter"}


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("torque", lambda x: x * (1.0 + 1e-5)),
        ("sliding_work", lambda x: x * (1.0 + 1e-4)),
        ("brake_work", lambda _: math.nan),
    ],
)
def test_planted_loss_is_refuted(make_problem, make_controller, monkeypatch, name, change):
    def leaking(*given, **settings):
        run = simulate(*given, **settings)
        return replace(run, totals=replace(run.totals, **{name: change(getattr(run.totals, name))}))

    monkeypatch.setattr(simulated_stop, "simulate", leaking)
    kept = keep(conservation.CHECK, make_problem(make_controller("none")))
    assert kept.certificate.status is Status.REFUTED
    assert kept.certificate.witness
    # Whoever reads the file runs the stop again: with the right model it denies nothing.
    monkeypatch.undo()
    assert refused(kept)
