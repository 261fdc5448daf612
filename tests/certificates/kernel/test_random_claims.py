"""Random functions under random trees: whatever the checker accepts is true at every sample.

The functions have kinks, poles and fractional powers inside their boxes, where the mean value form and monotony are
easily used too boldly. The samples are evaluated on 200-bit balls, apart from the checker's program.
"""

from fractions import Fraction

import flint
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from wspd_design.certificates.kernel.checker import Refused, Work, decide
from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.certificates.kernel.obligation import proof_of
from wspd_design.certificates.search.budget import Budget, within
from wspd_design.certificates.search.prover import prove
from wspd_design.model.number import atan, exp

BOX = {"x": (-1.0, 1.5), "y": (0.25, 2.0)}
SAMPLES = 16  # along each edge of the box; a power of two, so that the points are exact


def _unary(inner):
    return st.one_of(
        st.tuples(st.just("abs"), inner),
        st.tuples(st.just("exp"), inner),
        st.tuples(st.just("atan"), inner),
        st.tuples(st.just("power"), inner, st.sampled_from([-2, -1, 2, 3, 4, 2.0 / 3.0, 0.5, -0.5])),
    )


def _binary(inner):
    return st.tuples(st.sampled_from(["add", "sub", "mul", "div"]), inner, inner)


leaves = st.one_of(st.sampled_from(["x", "y"]), st.sampled_from([0.5, -0.5, 0.75, 1.0, 2.0]))
functions = st.recursive(leaves, lambda inner: st.one_of(_unary(inner), _binary(inner)), max_leaves=6)
trees = st.one_of(
    st.sampled_from(
        [".", "~", "A.", "A~", "B.", "AB.", "BA~", "a..", "a~~", "aA.A.", "aA~A~", "b~~", "abB~B~b~~"]
    ),
    st.text(alphabet="abAB.~", min_size=1, max_size=9),
)


def evaluate(tree, at):
    """Value of a function in whatever numbers."""
    if isinstance(tree, float):
        return at["one"] * tree
    if isinstance(tree, str):
        return at[tree]
    name, first, *rest = tree
    inner = evaluate(first, at)
    if name in ("abs", "exp", "atan"):
        return {"abs": abs, "exp": exp, "atan": atan}[name](inner)
    if name == "power":
        return _power(inner, rest[0])
    other = evaluate(rest[0], at)
    if name == "div":
        return inner / other
    return inner + other if name == "add" else inner - other if name == "sub" else inner * other


def _power(base, exponent):
    """Arb makes no number of a ball around zero to the power of two, so that its powers are written out."""
    if not isinstance(base, flint.arb) or not isinstance(exponent, int):
        return base**exponent
    product = flint.arb(1)
    for _ in range(abs(exponent)):
        product *= base
    return product if exponent > 0 else 1 / product


def samples(function):
    """Values on a grid that has the kinks at simple numbers in it; none where the function is not defined."""
    found = []
    with flint.ctx.workprec(200):
        for i in range(SAMPLES + 1):
            for j in range(SAMPLES + 1):
                shares = {"x": flint.fmpq(i, SAMPLES), "y": flint.fmpq(j, SAMPLES)}
                point = {
                    name: flint.arb(flint.fmpq(*low.as_integer_ratio()))
                    + flint.arb(shares[name]) * flint.arb(high - low)
                    for name, (low, high) in BOX.items()
                }
                value = evaluate(function, point | {"one": flint.arb(1)})
                if not value.is_finite():
                    return []
                found.append(value)
    return found


def claim_of(function, bound):
    return Claim(
        name="random",
        variables=tuple(variable(name, ends, "-") for name, ends in (BOX | {"one": 1.0}).items()),
        expression=lambda at: evaluate(function, at),
        relation="<=",
        bound=bound,
        unit="-",
    )


def rational(ball):
    mantissa, exponent = ball.lower().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


@given(function=functions, tree=trees, shrink=st.sampled_from([1e-12, 1e-6, 1e-2]))
@example(function=("abs", "x"), tree="~", shrink=1e-6)
@example(function=("sub", 1.0, ("abs", ("sub", "x", 0.75))), tree="A~", shrink=1e-6)
@example(function=("power", "x", 2), tree="A.", shrink=1e-6)
@example(function=("power", "x", -2), tree="~", shrink=1e-6)
@example(function=("power", "x", 2.0 / 3.0), tree=".", shrink=1e-6)
@example(function=("div", 1.0, "x"), tree="A.", shrink=1e-6)
@example(function=("atan", ("div", 1.0, "x")), tree=".", shrink=1e-6)
@example(function=("exp", ("power", ("abs", "x"), -1)), tree="~", shrink=1e-6)
@settings(max_examples=250, deadline=None)
def test_no_tree_shows_a_bound_that_a_sample_exceeds(function, tree, shrink):
    values = samples(function)
    if values:
        largest = max(rational(value) for value in values)
        bound = Fraction(largest - Fraction(shrink) * (1 + abs(largest)))
    else:
        bound = Fraction(10**30)  # not defined everywhere: no bound is a bound
    assume(abs(bound) < 10**40)
    claim = claim_of(function, bound)
    assert not _accepted(claim, tree)


@given(function=functions)
@settings(max_examples=40, deadline=None)
def test_what_the_prover_shows_no_sample_denies(function):
    """An honest tree for a bound between the samples and the interval over the whole box."""
    values = samples(function)
    assume(values)
    largest = max(rational(value) for value in values)
    assume(abs(largest) < 10**6)
    claim = claim_of(function, Fraction(float(largest + Fraction(1, 100) * (1 + abs(largest)))))
    with within(Budget(effort=300 / 60_000)):
        outcome = prove(claim)
    if outcome.tree and _accepted(claim, outcome.tree):
        for value in values:
            assert rational(value) <= claim.bound


def _accepted(claim, tree):
    try:
        decide(proof_of(claim, tree), Work())
    except Refused:
        return False
    return True


def test_true_random_claims_are_accepted():
    """The comparison above would be worth nothing if nothing were ever accepted."""
    function = ("sub", ("abs", ("sub", "x", 0.75)), "y")  # at most 1.75 - 0.25
    claim = claim_of(function, Fraction(3, 2))
    for tree in (".", "B.", "a..", "bB.B."):
        assert _accepted(claim, tree), tree
    assert not _accepted(claim_of(function, Fraction(149, 100)), ".")


@pytest.mark.parametrize("tree", ["~", "A.", "A~", "BA.", "a~~"])
def test_a_kink_inside_the_box_is_no_slope(tree):
    """-abs(x - 0.75) has its top inside; a slope of one side would put it at an end of the box."""
    claim = claim_of(("mul", -1.0, ("abs", ("sub", "x", 0.75))), Fraction(-1, 10))
    assert not _accepted(claim, tree)
