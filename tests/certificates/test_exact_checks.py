"""Statements that are decided in exact arithmetic: the only ones that may say PROVED."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.checks.foundations import gain_positive, surface_hurwitz
from wspd_design.certificates.kernel import exact
from wspd_design.certificates.kernel.exact import Positive
from wspd_design.certificates.records import Status
from wspd_design.model.generated.slip import slip_gain


def _with_gains(law, **changes):
    return replace(law, gains=replace(law.gains, **changes))


def test_printed_surface_is_proved_with_an_enclosure_of_its_rate(make_problem, make_controller):
    verdict = surface_hurwitz.check(make_problem(make_controller("afsmc")))
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
        (1800.0, float("nan"), Status.REFUTED),
        (-1800.0, -550.0, Status.PROVED),
        (1e308, 5e-324, Status.PROVED),  # the quotient underflows in floating point
    ],
)
def test_sign_of_the_surface_rate_decides(make_problem, make_controller, proportional, integral, status):
    law = _with_gains(make_controller("afsmc"), proportional_gain=proportional, integral_gain=integral)
    verdict = surface_hurwitz.check(make_problem(law))
    assert verdict.status is status
    assert bool(verdict.witness) is (status is Status.REFUTED)


def test_negative_surface_rate_of_a_sliding_mode_is_refuted(make_problem, make_controller):
    law = make_controller("smc")
    assert surface_hurwitz.check(make_problem(law)).status is Status.PROVED
    planted = make_problem(_with_gains(law, surface_rate=-0.4))
    assert surface_hurwitz.check(planted).status is Status.REFUTED


def test_rule_tables_have_no_surface(make_problem, make_controller):
    verdict = surface_hurwitz.check(make_problem(make_controller("trenitalia")))
    assert verdict.status is Status.NOT_APPLICABLE
    assert "surface" in verdict.explanation


def test_gain_is_proved_positive_and_its_minimum_enclosed(make_problem, make_controller):
    problem = make_problem(make_controller("none"))
    verdict = gain_positive.check(problem)
    assert verdict.status is Status.PROVED
    speeds = np.linspace(*problem.speeds, 200)
    inertias = np.linspace(*problem.inertia_bounds, 100)[:, None]
    sampled = slip_gain(speeds, inertias / 2.0, problem.vehicle.wheel_radius).min()
    assert verdict.margin.low <= sampled * (1.0 + 1e-15)
    assert verdict.margin.high == pytest.approx(sampled, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "blamed"),
    [
        ({"inertia_bounds": (-10.0, 860.0)}, "wheelset inertia"),
        ({"inertia_bounds": (0.0, 860.0)}, "wheelset inertia"),
        ({"speeds": (0.0, 30.0)}, "speed"),
    ],
)
def test_box_through_zero_is_refuted_with_its_factor(make_problem, make_controller, changes, blamed):
    verdict = gain_positive.check(make_problem(make_controller("none"), **changes))
    assert verdict.status is Status.REFUTED
    assert [point.name for point in verdict.witness] == [blamed]


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "7", "{}", '{"format": "wspd-exact/1"}', " " * 20_000, "[" * 9_000]
)
def test_what_is_no_certificate_proves_nothing(text):
    assert not exact.check(Positive(quantity="c", value=Fraction(1), unit="1/s"), text).accepted


@pytest.mark.parametrize("value", [Fraction(0), Fraction(-1, 10**400)])
def test_what_is_not_positive_has_no_proof(value):
    planted = Positive(quantity="c", value=value, unit="1/s")
    right = exact.prove(Positive(quantity="c", value=Fraction(1), unit="1/s"))
    assert exact.prove(planted) is None
    assert "another claim" in exact.check(planted, right.certificate).reason
    forged = json.dumps(json.loads(right.certificate) | {"claim_sha256": exact.digest(planted)})
    assert "it is false that" in exact.check(planted, forged).reason
