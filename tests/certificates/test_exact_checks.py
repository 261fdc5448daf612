"""Statements that are decided in exact arithmetic: the only ones that may say PROVED."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed
from wspd_design.certificates.checks.foundations import gain_positive, surface_hurwitz
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Sign, proof_of
from wspd_design.certificates.records import Status
from wspd_design.model.generated.slip import slip_gain


def _with_gains(law, **changes):
    return replace(law, gains=replace(law.gains, **changes))


def test_printed_surface_is_proved_with_an_enclosure_of_its_rate(make_problem, make_controller):
    verdict = surface_hurwitz.CHECK.run(make_problem(make_controller("afsmc")))
    assert verdict.status is Status.PROVED
    assert Fraction(verdict.margin.low) <= Fraction(550, 1800) <= Fraction(verdict.margin.high)
    assert verdict.margin.high - verdict.margin.low < 1e-15


@pytest.mark.parametrize(
    ("proportional", "integral", "status"),
    [
        (1800.0, -550.0, Status.REFUTED),
        (-1800.0, 550.0, Status.REFUTED),
        (1800.0, 0.0, Status.REFUTED),
        (0.0, 550.0, Status.REFUTED),
        (1800.0, float("nan"), Status.NOT_APPLICABLE),  # no law that could be shown to be the theorem's
        (-1800.0, -550.0, Status.PROVED),
        (1e308, 5e-324, Status.NOT_APPLICABLE),  # the law itself overflows
        (1e150, 1e-150, Status.PROVED),
    ],
)
def test_sign_of_the_surface_rate_decides(make_problem, make_controller, proportional, integral, status):
    law = _with_gains(make_controller("afsmc"), proportional_gain=proportional, integral_gain=integral)
    verdict = surface_hurwitz.CHECK.run(make_problem(law))
    assert verdict.status is status
    assert bool(verdict.witness) is (status is Status.REFUTED)


def test_negative_surface_rate_of_a_sliding_mode_is_refuted(make_problem, make_controller):
    law = make_controller("smc")
    assert surface_hurwitz.CHECK.run(make_problem(law)).status is Status.PROVED
    planted = make_problem(_with_gains(law, surface_rate=-0.4))
    assert surface_hurwitz.CHECK.run(planted).status is Status.REFUTED


def test_rule_tables_have_no_surface(make_problem, make_controller):
    verdict = surface_hurwitz.CHECK.run(make_problem(make_controller("trenitalia")))
    assert verdict.status is Status.NOT_APPLICABLE
    assert "surface" in verdict.explanation


def test_gain_is_proved_positive_and_its_minimum_enclosed(make_problem, make_controller):
    problem = make_problem(make_controller("none"))
    verdict = gain_positive.CHECK.run(problem)
    assert verdict.status is Status.PROVED
    speeds = np.linspace(*problem.speeds, 200)
    inertias = np.linspace(*problem.span("wheelset inertia"), 100)[:, None]
    sampled = slip_gain(speeds, inertias / 2.0, problem.span("wheel radius")[0]).min()
    assert verdict.margin.low <= sampled * (1.0 + 1e-15)
    assert verdict.margin.high == pytest.approx(sampled, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "blamed"),
    [
        ({"bounds": {"wheelset inertia": (-10.0, 860.0)}}, "wheelset inertia"),
        ({"bounds": {"wheelset inertia": (0.0, 860.0)}}, "wheelset inertia"),
        ({"speeds": (0.0, 30.0)}, "speed"),
    ],
)
def test_box_through_zero_is_refuted_with_its_factor(make_problem, make_controller, changes, blamed):
    verdict = gain_positive.CHECK.run(make_problem(make_controller("none"), **changes))
    assert verdict.status is Status.REFUTED
    assert [point.name for point in verdict.witness] == [blamed]


@pytest.mark.parametrize(("check", "name"), [(gain_positive, "none"), (surface_hurwitz, "smc")])
def test_words_and_proofs(make_problem, make_controller, check, name):
    kept = keep(check.CHECK, make_problem(make_controller(name)))
    assert kept.certificate.status is Status.PROVED
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)


@pytest.mark.parametrize("value", [Fraction(0), Fraction(-1, 10**400)])
def test_what_is_not_positive_has_no_proof(value):
    """The proof of another number, or a forged one, is refused."""
    planted = Sign(key="c", quantity="c", value=value, unit="1/s")
    right = Sign(key="c", quantity="c", value=Fraction(1), unit="1/s")
    assert right.decide(Stated(proof=proof_of(right)), Work()).status is Status.PROVED
    assert planted.decide(Stated(), Work()).status is Status.REFUTED
    with pytest.raises(Refused, match="states something else"):
        planted.decide(Stated(proof=proof_of(right)), Work())
    with pytest.raises(Refused, match="not positive"):
        planted.decide(Stated(proof=proof_of(planted)), Work())
