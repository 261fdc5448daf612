"""The checker refuses what is false or malformed, however the proof is dressed up."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import Refused, Work, decide, value
from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality, proof_of
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems.theorem import all_of


def test_true_claim_is_accepted(proved, proved_claim, refusal, tree):
    assert not refusal(proved_claim, tree)
    work = Work()
    shown = decide(proved.stated.proof, work)
    assert shown.leaves == proved.leaves > 100
    assert checker.MOST_WORK - work.left < checker.MOST_WORK / 50
    assert len(json.dumps(proved.stated.proof)) < 20_000
    assert shown.statement.startswith("(r + eta)/rho <= 25.1")
    assert "for all slip 0.02 to 0.6, speed 2 to 33.4" in shown.statement


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
    "another plant": lambda claim: _with(claim, "adhesion reduction", low=0.9, high=0.9),
    "another radius": lambda claim: _with(claim, "wheel radius", low=0.6, high=0.6),
    "another design model": lambda claim: _with(claim, "model mu0", low=0.3, high=0.3),
    "another expression": lambda claim: replace(
        claim,
        expression=lambda x: claim.expression(x) + x["mu0"],
        form=lambda x: claim.form(x) + x["mu0"],
    ),
}


def test_every_planted_name_is_a_variable(reference_claim):
    """A range of a name that does not exist would plant nothing."""
    for plant in PLANTED.values():
        assert plant(reference_claim) != reference_claim


@pytest.mark.parametrize("name", PLANTED)
def test_false_claim_is_refused(proved_claim, refusal, tree, name):
    reason = refusal(PLANTED[name](proved_claim), tree)
    assert "does not satisfy" in reason or "not monotone" in reason


@pytest.mark.parametrize("name", PLANTED)
def test_proof_of_another_claim_is_refused_or_shows_less(proved, proved_claim, name):
    """What the proof states is compared with what is asked; a bound that is not tight enough proves nothing."""
    asked = Inequality(key="planted", claim=PLANTED[name](proved_claim))
    stated = Stated(proof=proved.stated.proof)
    if name.startswith("bound"):
        assert asked.decide(stated, Work()).status is Status.UNDECIDED
    else:
        with pytest.raises(Refused, match="belongs to another statement"):
            asked.decide(stated, Work())


def test_statement_holds_everything_that_is_claimed(proved_claim):
    claims = [proved_claim, *(plant(proved_claim) for plant in PLANTED.values())]
    claims += [
        replace(proved_claim, name="x"),
        replace(proved_claim, unit="N"),
        replace(proved_claim, form=None),
    ]
    assert len({json.dumps(claim.statement()) for claim in claims}) == len(claims)


def test_wrong_arrangement_is_refused(proved_claim, refusal):
    """A form that is smaller than the expression would prove too much."""
    wrong = replace(proved_claim, form=lambda x: proved_claim.form(x) * 0.5)
    assert "arranged form" in refusal(wrong, ".")


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda tree: tree[:-1], "ends before"),
        (lambda tree: tree[: len(tree) // 2], "ends before"),
        (lambda tree: tree + ".", "goes on after"),
        (lambda tree: tree + tree, "goes on after"),
        (lambda tree: tree[1:], "e"),
        (lambda tree: tree[::-1], "e"),
        (lambda _: ".", "does not satisfy"),
        (lambda _: "~", "does not satisfy"),
        (lambda _: "ABCD.", "not monotone"),
        (lambda tree: "x" + tree, "unknown step"),
        (lambda tree: "0" + tree, "unknown step"),
        (lambda tree: "\u212a" + tree, "unknown step"),
        (lambda tree: "\u0130" + tree, "unknown step"),
        (lambda _: "a" * 1000, "halved more than"),
        (lambda _: "", "ends before"),
        (lambda _: None, "tree is missing"),
        (lambda _: ["."], "tree is missing"),
        (lambda _: 5, "tree is missing"),
    ],
)
def test_malformed_tree_is_refused(proved_claim, refusal, tree, change, reason):
    found = refusal(proved_claim, change(tree))
    assert found
    assert reason in found


@pytest.mark.parametrize("text", ["", "{", "[]", "null", "5", '"x"', "[" * 100_000, "\x00", "NaN", "{}{}"])
def test_what_is_not_an_object_is_refused(text):
    with pytest.raises(Refused):
        checker.read(text)


@pytest.mark.parametrize(
    "proof", [None, [], 5, "x", {}, {"format": "wspd-proof/1"}, {"format": checker.FORMAT}]
)
def test_what_is_not_a_proof_is_refused(proof):
    with pytest.raises(Refused):
        decide(proof, Work())


@pytest.mark.parametrize("name", ["format", "statement", "tree"])
def test_a_proof_needs_all_its_entries(proved, name):
    with pytest.raises(Refused):
        decide({key: each for key, each in proved.stated.proof.items() if key != name}, Work())


@pytest.mark.parametrize("name", ["kind", "name", "relation", "bound", "unit", "variables", "model"])
def test_a_statement_needs_all_its_entries(proved, name):
    statement = {key: each for key, each in proved.stated.proof["statement"].items() if key != name}
    with pytest.raises(Refused):
        decide(dict(proved.stated.proof) | {"statement": statement}, Work())


NOT_NUMBERS = (
    None, "nan", "inf", "-inf", "1/0", "x", "", [], {}, True, 25, 25.2, "1e999", "9e308", "１２", "1_0", " 1", "1\n",
    "0x1p3", f"1/{2**255 - 19}", "1/" + "1" * 5000,
)  # fmt: skip


@pytest.mark.parametrize("bound", NOT_NUMBERS)
def test_what_is_not_a_number_is_refused(proved_claim, refusal, tree, bound):
    assert "in place of a number" in refusal(proved_claim, tree, bound=bound)


@pytest.mark.parametrize(
    "row", [["x", "0", "1"], ["x", "1", "0", "-"], ["x", "0", "1", 3], [3, "0", "1", "-"], 7]
)
def test_malformed_variables_are_refused(proved_claim, refusal, tree, row):
    rows = [*proved_claim.statement()["variables"], row]
    assert refusal(proved_claim, tree, variables=rows)


def test_two_variables_of_one_name_are_refused(proved_claim, refusal, tree):
    """The wider range could hide behind the narrower one."""
    rows = proved_claim.statement()["variables"]
    assert "same name" in refusal(proved_claim, tree, variables=[*rows, rows[0]])


FORMULAS = (
    None, [], {}, "x", [["x"]], [["x", "y"]], [["x", 0]], [["n", 3]], [["n", "x"]], [["add"]], [["add", 0]],
    [["n", "1"], ["add", -1, 0]], [["n", "1"], ["add", 1]], [["n", "1"], ["add", True]], [["n", "1"], ["add", "0"]],
    [["n", "1"], ["exp", 0, 0]], [["n", "1"], ["log", 0]], [["n", "1"], ["pow", 0]], [["n", "1"], ["pow", 0, "65.0"]],
    [["n", "1"], ["pow", 0, 2]], [["n", "1"], []], [["n", "1"], [["add"], 0]], [["n", "1"]] * 20_001,
)  # fmt: skip


@pytest.mark.parametrize("formula", FORMULAS)
def test_malformed_formulas_are_refused(proved_claim, refusal, formula):
    assert refusal(proved_claim, ".", model=formula)
    assert refusal(proved_claim, ".", form=formula)


@pytest.mark.parametrize("name", ["name", "unit"])
@pytest.mark.parametrize("text", ["", "\x1b[2J", "a\nb", "m\u00b2", "x" * 301, 5, None])
def test_words_are_short_and_printable(proved_claim, refusal, tree, name, text):
    assert "not a short text" in refusal(proved_claim, tree, **{name: text})


def test_work_is_limited(proved):
    enough = Work()
    decide(proved.stated.proof, enough)
    needed = checker.MOST_WORK - enough.left
    decide(proved.stated.proof, Work(needed))
    for most in (0, 1, needed - 1):
        with pytest.raises(Refused, match="more work than the checker may do"):
            decide(proved.stated.proof, Work(most))


def test_theorem_needs_all_its_hypotheses(reference_claim, settled):
    """One inequality that holds proves nothing if another one fails."""
    found = settled(reference_claim, tolerance=0.1)
    false = settled(replace(reference_claim, bound=Fraction(1)), tolerance=0.1)
    assert found.status is Status.PROVED
    assert false.status is Status.REFUTED
    assert all_of(found, false) is Status.REFUTED


def test_vanishing_function_is_not_positive_definite(settled, refusal):
    """V = 0 is not a Lyapunov function: V >= 0.1 x^2 away from zero is refuted and cannot be forged."""

    def claim(scale):
        return Claim(
            name="V - 0.1 x^2",
            variables=(variable("x", (0.5, 2.0), "-"), variable("scale", scale, "-")),
            expression=lambda x: x["scale"] * x["x"] ** 2 - 0.1 * x["x"] ** 2,
            relation=">=",
            bound=Fraction(0),
            unit="-",
        )

    good = settled(claim(0.5), tolerance=1e-3)
    assert good.status is Status.PROVED
    assert settled(claim(0.0), tolerance=1e-3).status is Status.REFUTED
    for tree in (good.stated.proof["tree"], ".", "~", "A.", "aa...", "aA.A."):
        assert refusal(claim(0.0), tree)


@pytest.mark.parametrize(
    "expression",
    [
        lambda x: 1.0 / (x["x"] - 1.0),
        lambda x: (x["x"] - 1.0) ** (2.0 / 3.0),
        lambda x: -1.0 / (x["x"] - 1.0) ** 2,
    ],
)
def test_expression_that_is_not_defined_everywhere_is_not_proved(refusal, expression):
    claim = Claim(
        name="singular",
        variables=(variable("x", (0.5, 2.0), "-"),),
        expression=expression,
        relation="<=",
        bound=Fraction(10**6),
        unit="-",
    )
    for tree in (".", "~", "A.", "a..", "aA.A.", "a~~", "aa....", "aA~A~"):
        assert refusal(claim, tree)


def test_point_outside_the_box_is_no_witness(reference_claim):
    point = {v.name: v.low for v in reference_claim.free}
    low, high = value(reference_claim.statement(), point, Work())
    assert low <= high < reference_claim.bound
    with pytest.raises(Refused, match="outside the box"):
        value(reference_claim.statement(), {**point, "speed": Fraction(1)}, Work())
    outside = Stated(place={name: float(at) for name, at in point.items()} | {"speed": 1.0})
    with pytest.raises(Refused, match="outside the box"):
        Inequality(key="claim", claim=reference_claim).decide(outside, Work())


@pytest.mark.parametrize("at", [float("nan"), float("inf"), -float("inf")])
def test_a_place_is_finite_and_names_all_that_is_free(reference_claim, at):
    asked = Inequality(key="claim", claim=reference_claim)
    place = {v.name: float(v.low) for v in reference_claim.free}
    assert asked.decide(Stated(place=place), Work()).status is Status.UNDECIDED
    with pytest.raises(Refused, match="not finite"):
        asked.decide(Stated(place=place | {"speed": at}), Work())
    for wrong in ({"speed": 3.0}, place | {"wheel radius": 0.5}, place | {"x": 1.0}):
        with pytest.raises(Refused, match="and nothing else"):
            asked.decide(Stated(place=wrong), Work())


def test_limit_of_the_kernels_is_taken_from_the_arranged_form():
    """1/x times x^2 at zero; another form is not believed."""

    def statement(form):
        claim = Claim(
            name="limit",
            variables=(variable("x", (0.0, 2.0), "-"),),
            expression=lambda x: 1.0 / x["x"] * x["x"] ** 2 + 3.0,
            form=form,
            relation="<=",
            bound=Fraction(5),
            unit="-",
        )
        return claim.statement()

    at = {"x": Fraction(0)}
    assert value(statement(lambda x: x["x"] + 3.0), at, Work()) == (3, 3)
    for form in (lambda x: x["x"] + 2.0, None):
        with pytest.raises(Refused, match="not defined"):
            value(statement(form), at, Work())


def test_the_proof_of_an_identity_or_sign_cannot_stand_for_an_inequality(proved_claim):
    """A statement of another kind states something else."""
    sign = {"kind": "sign", "name": "x", "value": "1.0", "unit": "-"}
    with pytest.raises(Refused, match="belongs to another statement"):
        Inequality(key="claim", claim=proved_claim).decide(
            Stated(proof={"format": checker.FORMAT, "statement": sign | {"bound": "1.0"}}), Work()
        )
    with pytest.raises(Refused):
        decide(proof_of(proved_claim, "."), Work())
