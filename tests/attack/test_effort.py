"""What a file may ask for: every step that takes time is counted, so that no file keeps the checker busy."""

import json

import pytest

from wspd_design.certificates.kernel.checker import FORMAT, Refused, Work, decide, read
from wspd_design.certificates.kernel.file import MOST_NUMBERS, stated_findings
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Special
from wspd_design.certificates.theorems import quadratic


def proof(model, tree):
    """A proof that a formula of one variable exceeds -1."""
    rows = [["v0", "0.0", "1.0", "-"]]
    statement = {"kind": "inequality", "name": "x", "relation": ">=", "bound": "-1.0", "unit": "-"}
    return {
        "format": FORMAT,
        "statement": {**statement, "variables": rows, "model": model},
        "tree": tree,
    }


def halved(times):
    """A tree that halves the first variable again and again."""
    return "." if times == 0 else "a" + halved(times - 1) * 2


def spent(forged):
    work = Work()
    decide(forged, work)
    return Work().left - work.left


def test_an_operation_on_many_numbers_counts_as_many():
    few, many = (spent(proof([["x", "v0"], ["mul", *[0] * count]], halved(5))) for count in (2, 1002))
    assert many - few >= 1000 * 32


def test_each_step_of_a_tree_counts():
    assert spent(proof([["n", "0"]], halved(9))) >= 2 * 1023
    assert spent(proof([["x", "v0"]], "A" * 5000 + ".")) >= 2 * 5000


def test_what_asks_for_too_much_is_refused():
    for forged in (
        proof([["x", "v0"], ["mul", *[0] * 2000]], halved(6)),
        proof([["x", "v0"]], "A" * 50_000 + "."),
    ):
        with pytest.raises(Refused, match="more work"):
            decide(forged, Work(100_000))


def test_long_fractions_of_a_quadratic_function_are_refused():
    long = f"{10**40}/{10**40 + 1}"
    forged = {"format": quadratic.FORMAT, "poles": ["-1.0", "1.0"], "steps": ".", "pieces": [[long] * 8]}
    with pytest.raises(Refused, match="letters"):
        quadratic.read(forged)
    assert quadratic.read({**forged, "pieces": [["1/3"] * 8]}).steps == "."


@pytest.mark.parametrize("entry", ["check", "evaluate"])
def test_arithmetic_that_ends_at_numbers_of_a_file_is_refused(entry):
    def overflow(_stated, _work):
        raise OverflowError("cannot convert Infinity to integer ratio")

    obligation = Special(key="sets", text="s", **{entry: overflow}, within={"speed": (0.0, 1.0)})
    stated = Stated(proof={"a": 1}) if entry == "check" else Stated(place={"speed": 0.5})
    with pytest.raises(Refused, match="sets cannot be computed: OverflowError"):
        obligation.decide(stated, Work())


def test_a_place_has_no_more_coordinates_than_a_plant():
    for count in (MOST_NUMBERS, MOST_NUMBERS + 1):
        text = json.dumps({"findings": {"a": {"place": {f"k{k}": "0.5" for k in range(count)}}}})
        if count == MOST_NUMBERS:
            assert len(stated_findings(read(text))["a"].place) == count
        else:
            with pytest.raises(Refused, match="too long"):
                stated_findings(read(text))
