"""The checker refuses what is false or malformed, even if the certificate bears the hash of the claim."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.sliding import reaching
from wspd_design.certificates.kernel.checker import check, value
from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.settle import settle


@pytest.fixture
def tree(proved):
    return json.loads(proved.proof.certificate)["tree"]


def test_true_claim_is_accepted(proved, reference_claim, forge, tree):
    assert check(reference_claim, proved.proof.certificate).accepted
    verdict = check(proved.claim, forge(proved.claim, tree))
    assert verdict.accepted
    assert verdict.leaves == proved.proof.leaves > 100
    assert verdict.seconds < 10.0
    assert len(proved.proof.certificate) < 20_000


def _with(claim, name, low=None, high=None):
    """The claim with another range of one variable."""
    return replace(
        claim,
        variables=tuple(
            replace(
                v,
                low=v.low if low is None else Fraction(low),
                high=v.high if high is None else Fraction(high),
            )
            if v.name == name
            else v
            for v in claim.variables
        ),
    )


PLANTED = {
    "bound below the supremum": lambda claim: replace(claim, bound=Fraction(25.08)),
    "bound far below": lambda claim: replace(claim, bound=Fraction(5)),
    "lower speeds": lambda claim: _with(claim, "speed", low=1.9),
    "more friction": lambda claim: _with(claim, "mu0", high=0.62),
    "heavier": lambda claim: _with(claim, "mass", high=95_000),
    "other sign": lambda claim: replace(claim, relation=">="),
    "another plant": lambda claim: _with(claim, "adhesion_reduction", low=0.9, high=0.9),
    "another radius": lambda claim: _with(claim, "wheel radius", low=0.6, high=0.6),
    "another design model": lambda claim: _with(claim, "model mu0", low=0.3, high=0.3),
    "another expression": lambda claim: replace(
        claim,
        expression=lambda x: claim.expression(x) + x["mu0"],
        form=lambda x: claim.form(x) + x["mu0"],
    ),
}


@pytest.mark.parametrize("name", PLANTED)
def test_false_claim_is_refused(proved, forge, tree, name):
    false = PLANTED[name](proved.claim)
    verdict = check(false, forge(false, tree))
    assert not verdict.accepted
    assert "does not satisfy" in verdict.reason or "not monotone" in verdict.reason


@pytest.mark.parametrize("name", PLANTED)
def test_certificate_of_another_claim_is_refused(proved, name):
    verdict = check(PLANTED[name](proved.claim), proved.proof.certificate)
    assert not verdict.accepted
    assert "another claim" in verdict.reason or "less than is claimed" in verdict.reason


def test_hash_sees_everything_that_is_claimed(proved):
    claims = [proved.claim, *(plant(proved.claim) for plant in PLANTED.values())]
    claims += [
        replace(proved.claim, name="x"),
        replace(proved.claim, unit="N"),
        replace(proved.claim, form=None),
    ]
    assert len({claim.digest() for claim in claims}) == len(claims)


def test_wrong_arrangement_is_refused(proved, forge):
    """A form that is smaller than the expression would prove too much."""
    wrong = replace(proved.claim, form=lambda x: proved.claim.form(x) * 0.5)
    verdict = check(wrong, forge(wrong, "."))
    assert not verdict.accepted
    assert "arranged form" in verdict.reason


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda tree: tree[:-1], "ends before"),
        (lambda tree: tree[: len(tree) // 2], "ends before"),
        (lambda tree: tree + ".", "goes on after"),
        (lambda tree: tree + tree, "goes on after"),
        (lambda tree: tree[1:], ""),
        (lambda tree: tree[::-1], ""),
        (lambda _: ".", "does not satisfy"),
        (lambda _: "~", "does not satisfy"),
        (lambda _: "ABCD.", "not monotone"),
        (lambda tree: "x" + tree, "unknown step"),
        (lambda tree: "0" + tree, "unknown step"),
        (lambda tree: "\u212a" + tree, "unknown step"),
        (lambda _: "a" * 1000, "halved more than"),
        (lambda _: "." * 500_000, "too long"),
        (lambda _: "", "ends before"),
        (lambda _: None, "no tree"),
        (lambda _: ["."], "no tree"),
        (lambda _: 5, "no tree"),
    ],
)
def test_malformed_tree_is_refused(proved, forge, tree, change, reason):
    verdict = check(proved.claim, forge(proved.claim, change(tree)))
    assert not verdict.accepted
    assert reason in verdict.reason


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "null", "5", '"x"', "{}", '{"format": "wspd-proof/2"}', "[" * 100_000, "\x00", "NaN"],
)
def test_what_is_no_certificate_is_refused(reference_claim, text):
    verdict = check(reference_claim, text)
    assert not verdict.accepted
    assert verdict.reason


@pytest.mark.parametrize("bound", [None, "nan", "inf", "-inf", "1/0", "x", [], {}, True, "30.1", 25])
def test_bound_that_is_none_or_too_weak_is_refused(proved, forge, reference_claim, tree, bound):
    assert not check(reference_claim, forge(proved.claim, tree, bound=bound)).accepted


def test_time_is_limited(proved, forge, tree):
    verdict = check(proved.claim, forge(proved.claim, tree), seconds=0.0)
    assert not verdict.accepted
    assert "too long" in verdict.reason


def test_theorem_needs_all_its_hypotheses(make_reference_problem):
    """A gain that is large enough proves nothing if the train may slow faster than assumed."""
    problem = make_reference_problem(30.0)
    gain, slowing = reaching.claims(problem, problem.controller)
    found = settle(gain, tolerance=0.1)
    false = settle(replace(slowing, bound=Fraction(1)), tolerance=0.1)
    assert found.status is Status.PROVED
    assert false.status is Status.REFUTED
    assert verdict.status(found, false) is Status.REFUTED
    assert verdict.proofs(found, false) == (found.proof,)


def test_vanishing_function_is_not_positive_definite(forge):
    """V = 0 is no Lyapunov function: V >= 0.1 x^2 away from zero is refuted and cannot be forged."""

    def claim(scale):
        return Claim(
            name="V - 0.1 x^2",
            variables=(variable("x", (0.5, 2.0), "-"), variable("scale", scale, "-")),
            expression=lambda x: x["scale"] * x["x"] ** 2 - 0.1 * x["x"] ** 2,
            relation=">=",
            bound=Fraction(0),
            unit="-",
        )

    assert settle(claim(0.5), tolerance=1e-3).status is Status.PROVED
    assert settle(claim(0.0), tolerance=1e-3).status is Status.REFUTED
    true = json.loads(settle(claim(0.5), tolerance=1e-3).proof.certificate)["tree"]
    for tree in (true, ".", "~", "A.", "aa...", "aA.A."):
        assert not check(claim(0.0), forge(claim(0.0), tree)).accepted


@pytest.mark.parametrize(
    "expression",
    [
        lambda x: 1.0 / (x["x"] - 1.0),
        lambda x: (x["x"] - 1.0) ** (2.0 / 3.0),
        lambda x: -1.0 / (x["x"] - 1.0) ** 2,
    ],
)
def test_expression_that_is_not_defined_everywhere_is_not_proved(forge, expression):
    claim = Claim(
        name="singular",
        variables=(variable("x", (0.5, 2.0), "-"),),
        expression=expression,
        relation="<=",
        bound=Fraction(10**6),
        unit="-",
    )
    for tree in (".", "~", "A.", "a..", "aA.A.", "a~~", "aa....", "aA~A~"):
        assert not check(claim, forge(claim, tree)).accepted


def test_point_outside_the_box_is_no_witness(reference_claim):
    point = {v.name: v.low for v in reference_claim.free}
    low, high = value(reference_claim, point)
    assert low <= high < reference_claim.bound
    with pytest.raises(ValueError, match="outside the box"):
        value(reference_claim, {**point, "speed": Fraction(1)})


def test_limit_of_the_kernels_is_taken_from_the_arranged_form():
    """1/x times x^2 at zero; another form is not believed."""

    def claim(form):
        return Claim(
            name="limit",
            variables=(variable("x", (0.0, 2.0), "-"),),
            expression=lambda x: 1.0 / x["x"] * x["x"] ** 2 + 3.0,
            form=form,
            relation="<=",
            bound=Fraction(5),
            unit="-",
        )

    assert value(claim(lambda x: x["x"] + 3.0), {"x": Fraction(0)}) == (3, 3)
    for form in (lambda x: x["x"] + 2.0, None):
        with pytest.raises(ValueError, match="not defined"):
            value(claim(form), {"x": Fraction(0)})
