"""No file keeps the checker busy for long: its work is counted, and what is counted costs about the same.

A file of 20 MB may hold any formula and any tree. The longest time that one counted operation takes decides how long a
file can last; here the work is counted, and formulas whose numbers would become long are refused.
"""

import json

import pytest

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import FORMAT, MOST_BYTES, MOST_WORK, Refused, Work, decide, read

UNIT = [["x", "0.0", "1.0", "-"]]
MANY = [[f"v{k}", "0.0", "1.0", "-"] for k in range(26)]


def proof(model, tree, variables=UNIT, bound="1e300", **form):
    statement = {"kind": "inequality", "name": "x", "relation": "<=", "bound": bound, "unit": "-"}
    return {
        "format": FORMAT,
        "statement": statement | {"variables": variables, "model": model} | form,
        "tree": tree,
    }


def spent(made):
    work = Work()
    decide(made, work)
    return MOST_WORK - work.left


def halved(times, leaf="."):
    return leaf if times == 0 else "a" + 2 * halved(times - 1, leaf)


def test_work_grows_with_the_tree():
    small, large = (spent(proof([["x", "x"]], halved(depth))) for depth in (5, 9))
    assert large > 15 * small


@pytest.mark.parametrize("leaf", [".", "~"])
def test_every_step_is_counted_with_what_it_costs(leaf):
    """One step of the tree touches all ranges; a slope is taken along every variable."""
    trees = (halved(4, leaf), halved(4, leaf))
    formula = [["x", "v0"]]
    few = spent(proof(formula, trees[0], variables=MANY[:1]))
    many = spent(proof(formula, trees[1], variables=MANY))
    assert many > 10 * few


EXPENSIVE = {
    "wide sum": [["x", "x"], ["add", *[0] * 1000]],
    "wide product": [["x", "x"], ["mul", *[0] * 900]],
    "functions": [["x", "x"], *([name, 0] for name in ("exp", "atan", "abs") for _ in range(100))],
    "powers": [["x", "x"], *(["pow", 0, "64.0"] for _ in range(100))],
}


@pytest.mark.parametrize("name", EXPENSIVE)
def test_expensive_steps_count_more(name):
    formula = EXPENSIVE[name]
    cheap = spent(proof([["x", "x"]], halved(5)))
    assert spent(proof(formula, halved(5))) > cheap + 32 * 2 * sum(len(step) - 1 for step in formula[1:]) // 2


GROWING = {
    "squares of squares": [["x", "x"], *(["mul", k, k] for k in range(200))],
    "powers of powers": [["x", "x"], *(["pow", k, "64.0"] for k in range(200))],
    "roots and powers": [["x", "x"], *(["pow", k, "1/64" if k % 2 else "64.0"] for k in range(200))],
}


@pytest.mark.parametrize("name", GROWING)
def test_a_formula_whose_numbers_become_long_is_refused(name):
    work = Work()
    with pytest.raises(Refused, match="degree of a formula is above"):
        decide(proof(GROWING[name], "."), work)
    assert work.left == MOST_WORK


def test_more_than_one_letter_each_is_refused():
    with pytest.raises(Refused, match="more than 26 variables have a range"):
        decide(proof([["x", "v0"]], ".", variables=[*MANY, ["w", "0.0", "1.0", "-"]]), Work())


def test_variables_that_do_not_vary_cost_nothing_in_the_tree():
    idle = [[f"k{k}", "1.0", "1.0", "-"] for k in range(2000)]
    formula = [["x", "x"]]
    assert spent(proof(formula, halved(6), variables=UNIT + idle)) == spent(proof(formula, halved(6)))


@pytest.mark.parametrize("leaf", [".", "~", "A."])
def test_a_tree_of_twenty_megabytes_ends_within_the_work(leaf):
    """A valid tree, cut at the size of a file: halving by halving down to the smallest boxes that may be."""
    ladder = "a" * 300
    text = ladder + ("." if leaf == "." else leaf) * 2
    tree = (text * (MOST_BYTES // len(text)))[: MOST_BYTES - 1000]
    work = Work(MOST_WORK // 100)  # a hundredth shows where it ends
    with pytest.raises(Refused, match=r"more work than the checker may do|goes on after|halved more than"):
        decide(proof([["x", "x"]], tree), work)
    assert work.left < MOST_WORK // 100


def test_a_valid_tree_that_is_too_long_is_refused_by_its_work():
    whole = halved(12)
    needed = spent(proof([["x", "x"]], whole))
    assert needed * MOST_BYTES / len(whole) > MOST_WORK  # such a file of 20 MB asks for more than there is
    with pytest.raises(Refused, match="more work"):
        decide(proof([["x", "x"]], whole), Work(needed - 1))


def test_the_work_is_that_of_the_file_not_of_a_proof():
    made, work = proof([["x", "x"]], halved(8)), Work()
    needed = spent(made)
    for k in range(1, 4):
        decide(made, work)
        assert work.left == MOST_WORK - k * needed


def test_identities_and_places_are_counted():
    long = [["n", "1/3"]] * 5000
    work = Work()
    decide(
        {"format": FORMAT, "statement": {"kind": "identity", "name": "n", "left": long, "right": long}}, work
    )
    assert MOST_WORK - work.left == 2 * 5000 * checker.COSTS["n"]
    work = Work()
    checker.value(proof(EXPENSIVE["powers"], ".")["statement"], {"x": checker.Fraction(1, 2)}, work)
    assert MOST_WORK - work.left >= 100 * checker.COSTS["pow"]


def test_a_file_that_is_too_long_is_not_even_read():
    with pytest.raises(Refused, match="too long"):
        read("[" * (MOST_BYTES + 1))
    assert read(json.dumps({"tree": "." * 1000})) == {"tree": "." * 1000}
