"""A proof of the band as it is read: every number in its place, and none that would mean something else."""

import json
from dataclasses import fields
from fractions import Fraction

import pytest

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES
from wspd_design.certificates.theorems.slip_band.friction import NAMES, PARTS, REACHES, Friction, Part
from wspd_design.certificates.theorems.slip_band.proof import MOST_CELLS, Ellipsoid, Proof, read, write

WINDOWS = 2
TENTH, ONE = Fraction(1, 10), Fraction(1)
ORDER = ["pulse", "supply", "near", "settled", "shortest", "longest", "back", "room", "beyond", "curve"]
"""Numbers of an ellipsoid before its matrix, as they are written."""


def an_ellipsoid(number):
    """An ellipsoid of which all numbers differ from each other."""
    each = iter(Fraction(number * 100 + k, 1009) for k in range(100))
    entries = {(i, j): next(each) for i in range(STATES) for j in range(i + 1)}
    return Ellipsoid(
        pulse=Fraction(1, 2),
        supply=Fraction(3, 4),
        near=number,
        settled=next(each),
        shortest=Fraction(1, 8),
        longest=Fraction(1, 4),
        back=Fraction(3, 8),
        room=next(each),
        beyond=1 + next(each),
        curve=1 + next(each),
        matrix=tuple(tuple(entries[max(i, j), min(i, j)] for j in range(STATES)) for i in range(STATES)),
        center=tuple(next(each) for _ in range(STATES)),
        drift=next(each),
        moves=tuple(next(each) for _ in range(STATES)),
        alpha=next(each),
        offset=next(each),
        shares=tuple(next(each) for _ in DISTURBANCES),
        lag=next(each),
        steady=next(each),
        change=next(each),
        inside=next(each),
    )


def parts(window):
    """Parts of the steepness with bounds of the friction, all numbers different."""
    first = [200.0 * window + 50.0 * part for part in range(PARTS)]
    return tuple(
        Part((k, k + 0.5), Friction.of(tuple((k + n, k + n + 0.5) for n in range(1, 1 + len(NAMES)))))
        for k in first
    )


@pytest.fixture
def proof():
    one, other = an_ellipsoid(1), an_ellipsoid(2)
    return Proof(
        share=Fraction(1, 2),
        delay=Fraction(1, 20),
        noise=Fraction(1, 1000),
        reserve=Fraction(9, 10),
        friction=tuple(parts(k) for k in range(WINDOWS)),
        steps="m..",
        cells=((one, other), (None, one)),
    )


@pytest.fixture
def written(proof):
    return json.loads(json.dumps(write(proof)))


def why(written):
    with pytest.raises(Refused) as reason:
        read(written, WINDOWS)
    return str(reason.value)


def test_what_is_read_is_what_was_written(proof, written):
    found = read(written, WINDOWS)
    for each in fields(Proof):
        assert getattr(found, each.name) == getattr(proof, each.name), each.name
    assert found.cells[1][0] is None


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        *(("share", value, "share of the box must be above 0") for value in ("0", "-1/2", "11/10")),
        *((name, "-1/1000", "below 0") for name in ("delay", "noise")),
        *(("reserve", value, "claimed about must be above 0") for value in ("0", "-1", "1001/1000")),
        ("format", "wspd-slip-band/9", "does not have the format"),
        *(("steps", value, "steps and cells do not match") for value in ("m.", "m...", ".")),
        ("steps", ["m", ".", "."], "no steps or no cells"),
        ("cells", [], "no steps or no cells"),
        ("cells", [[0, 1]] * (MOST_CELLS + 1), "no cells, or too many"),
        ("cells", [[0, 1], [0]], "one entry for each of 2 windows"),
        ("cells", [[0, 1], [0, 1, 1]], "one entry for each of 2 windows"),
        *(("cells", [[0, 1], [0, place]], "that is not there") for place in (-1, 2, True, 0.0, "0")),
        ("friction", [], "one entry for each of 2 windows"),
    ],
)
def test_proof_that_is_none_is_refused(written, name, value, reason):
    written[name] = value
    assert reason in why(written)


def test_proof_with_another_key_or_without_one_is_refused(written):
    assert "does not have the format" in why(written | {"more": "1"})
    del written["reserve"]
    assert "does not have the format" in why(written)


def test_more_ellipsoids_than_cells_and_windows_are_refused(written):
    written["ellipsoids"] *= 3
    assert "no ellipsoids, or too many" in why(written)


PULSES = "from 0 to the longest one"


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        *(("pulse", value, "the sample at most") for value in ("0", "-1/2", "1001/1000")),
        *(("supply", value, "from 0 to 1") for value in ("-1/100", "101/100")),
        *(("near", value, "a reach is not there") for value in ("-1", "1/2", str(len(REACHES)))),
        *(("shortest", value, PULSES) for value in ("-1/100", "26/100")),
        *(("longest", value, PULSES) for value in ("12/100", "51/100")),
        *(("back", value, PULSES) for value in ("0", "-1/100", "51/100")),
        *(("room", value, "above the cylinder must be above 0") for value in ("0", "-1")),
        *((name, "999/1000", "1 or more times its limit") for name in ("beyond", "curve")),
    ],
)
def test_number_of_an_ellipsoid_beyond_its_range_is_refused(written, name, value, reason):
    written["ellipsoids"][1][ORDER.index(name)] = value
    assert reason in why(written)


def test_ellipsoid_with_a_number_more_or_less_is_refused(written):
    for numbers in (written["ellipsoids"][0][:-1], [*written["ellipsoids"][0], "0"]):
        assert "lacks" in why(written | {"ellipsoids": [numbers, written["ellipsoids"][1]]})


def test_number_that_is_too_long_to_be_worked_with_is_refused(written):
    written["ellipsoids"][0][-1] = "1/" + "3" * 60
    assert "letters" in why(written)


def test_bounds_of_the_friction_that_cannot_be_are_refused(written):
    """A bound that is rounded where it is read would be another one than the checker tells."""
    ends = written["friction"][1]
    assert "not a double" in why(written | {"friction": [ends, ["1/3", *ends[1:]]]})
    for k in (0, 2, len(ends) - 2):
        exchanged = [*ends[:k], ends[k + 1], ends[k], *ends[k + 2 :]]
        assert "is none" in why(written | {"friction": [ends, exchanged]})
    for count in (2, len(ends) // PARTS):
        assert "lacks" in why(written | {"friction": [ends, ends[count:]]})
