"""Balances of the simulated stop, and stops that do not balance."""

import math
from dataclasses import replace

import pytest

from wspd_design.certificates.checks.foundations import conservation
from wspd_design.certificates.records import Status
from wspd_design.simulation.stop import simulate


@pytest.mark.parametrize("name", ["afsmc", "none", "torque-feedback"])
def test_balances_close(make_problem, make_controller, name):
    verdict = conservation.check(make_problem(make_controller(name)))
    assert verdict.status is Status.EVIDENCE
    assert verdict.margin.high > 0.9
    assert {point.name.split(", ")[1] for point in verdict.worst_point} == {"four-axle", "quarter"}


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

    monkeypatch.setattr(conservation, "simulate", leaking)
    verdict = conservation.check(make_problem(make_controller("none")))
    assert verdict.status is Status.REFUTED
    assert verdict.witness
