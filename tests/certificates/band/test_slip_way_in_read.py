"""A proof of the way in as it is read and counted: no gap, no number beyond its range, and the worst of all strips."""

import json
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.conftest import problem_of
from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Status
from wspd_design.certificates.theorems import band
from wspd_design.certificates.theorems.slip_band import approach, arrival, computed_law, way_in
from wspd_design.certificates.theorems.slip_band.way_in import (
    FRICTION,
    LARGEST_SHARE,
    MOST_SAMPLES,
    NEAR,
    SUPPLY,
    TILTING,
    Courses,
    Piece,
    Row,
    Strip,
    around,
    checker,
    courses,
    followed,
    read,
    write,
)
from wspd_design.certificates.theorems.way_in import SLIP_WAY_IN, STRIPS
from wspd_design.parameters.bounds import Bounds

PLENTY = 10**9
FRICTIONS, SUPPLIES = (0.06, 0.1), (0.7, 0.8)
TIDY = (0.0,) * len(TILTING)


@pytest.fixture(scope="module")
def problem():
    whole = problem_of(1.0, rail=wd.load_rail("low-adhesion"))
    ends = {name: whole.span(name) for name in NEAR} | {FRICTION: FRICTIONS, SUPPLY: SUPPLIES}
    return replace(whole, bounds=Bounds.of(ends))


def piece_of(friction=FRICTIONS, borders=(0.7, 0.75, 0.8), samples=(5, 9), slopes=TIDY):
    return Piece(friction=friction, slopes=slopes, borders=borders, samples=samples)


ROWS = [Row(supply=SUPPLIES, pieces=(piece_of(),))]


@pytest.fixture
def written():
    return json.loads(json.dumps(write(ROWS, Fraction(1, 50))))


def why(written):
    with pytest.raises(Refused) as reason:
        read(written)
    return str(reason.value)


def test_what_is_read_is_what_was_written():
    other = Row(
        supply=(0.8, 0.9),
        pieces=(piece_of((0.06, 0.07)), piece_of((0.07, 0.1), slopes=(0.5,) * len(TILTING))),
    )
    assert read(json.loads(json.dumps(write([*ROWS, other], Fraction(1, 50))))) == (
        Fraction(1, 50),
        (*ROWS, other),
    )


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("format", "wspd-way-in/3", "format"),
        ("share", "501/1000", f"not between 0 and {LARGEST_SHARE}"),
        ("share", "-1/1000", f"not between 0 and {LARGEST_SHARE}"),
        ("rows", [], "no rows"),
        ("rows", {}, "no rows"),
    ],
)
def test_proof_that_is_none_is_refused(written, name, value, reason):
    written[name] = value
    assert reason in why(written)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        *(("supply", ends, "do not rise") for ends in (["4/5", "7/10"], ["7/10", "7/10"])),
        ("supply", ["7/10"], "two ends of the supply rate"),
        ("pieces", [], "two ends of the supply rate, and pieces"),
    ],
)
def test_row_that_is_none_is_refused(written, name, value, reason):
    written["rows"][0][name] = value
    assert reason in why(written)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("friction", ["1/10", "3/50"], "do not rise"),
        ("friction", ["1/10"], "two ends of the friction"),
        *(("borders", ends, "do not rise") for ends in (["7/10", "7/10", "4/5"], ["7/10", "9/10", "4/5"])),
        ("borders", ["7/10", "4/5"], "one border more than strips"),
        ("samples", [5], "one border more than strips"),
        *(("samples", [5, each], "is followed for 1 to") for each in (0, -1, True, 2.0, MOST_SAMPLES + 1)),
        ("slopes", ["0"] * (len(TILTING) - 1), f"needs {len(TILTING)} slopes"),
        ("slopes", "0", "must be lists"),
    ],
)
def test_piece_that_is_none_is_refused(written, name, value, reason):
    written["rows"][0]["pieces"][0][name] = value
    assert reason in why(written)


# --- what is covered --------------------------------------------------------------------------------------------------
@pytest.fixture
def nothing_is_followed(monkeypatch):
    """The problems that strips are followed in, the law is compared in, and a band is proved in."""
    seen = SimpleNamespace(followed=[], compared=[], bands=[], rises=[])
    numbers = {"supply": 0.5, "speed": 29.0}
    monkeypatch.setattr(
        way_in, "followed", lambda near, _law, _strips, asked: seen.followed.append((near, asked)) or numbers
    )
    monkeypatch.setattr(computed_law, "unlike", lambda near, _law: seen.compared.append(near) or "")

    def of_band(near, _law):
        seen.bands.append(near)
        return lambda *_: {"band 0 above": 0.1}

    monkeypatch.setattr(way_in, "checker_of_band", of_band)
    monkeypatch.setattr(way_in, "asked_of", lambda near, proof: (near, "asked", len(proof)))
    monkeypatch.setattr(way_in, "supply_rises", lambda *given: seen.rises.append(given))
    return seen


def told(problem, rows, share="1/50", band=None):
    return checker(problem, problem.controller)(write(rows, Fraction(share), band), Work(PLENTY))


@pytest.mark.usefixtures("nothing_is_followed")
def test_friction_that_is_covered_in_each_row_is_told(problem):
    low = Row(supply=(0.7, 0.75), pieces=(piece_of((0.06, 0.09), (0.69, 0.76), (5,)),))
    high = Row(
        supply=(0.75, 0.8),
        pieces=(piece_of((0.07, 0.08), (0.74, 0.81), (5,)), piece_of((0.08, 0.1), (0.7, 0.9), (5,))),
    )
    found = told(problem, [low, high])
    assert (found["friction low"], found["friction high"], found["share"]) == (0.07, 0.09, 0.02)


@pytest.mark.usefixtures("nothing_is_followed")
def test_gap_anywhere_is_refused(problem):
    def reason(*rows):
        with pytest.raises(Refused) as found:
            told(problem, rows)
        return str(found.value)

    def row(supply=SUPPLIES, *pieces):
        return Row(supply=supply, pieces=pieces or (piece_of(),))

    outward = 1e-9
    assert "rows do not cover" in reason(row((0.7 + outward, 0.8), piece_of()))
    assert "rows do not cover" in reason(row((0.7, 0.8 - outward), piece_of()))
    assert "do not follow each other" in reason(row((0.7, 0.75)), row((0.75 + outward, 0.8)))
    parts = (piece_of((0.06, 0.08)), piece_of((0.08 + outward, 0.1)))
    assert "pieces of the friction do not follow" in reason(row(SUPPLIES, *parts))
    for borders in ((0.7 + outward, 0.75, 0.8), (0.7, 0.75, 0.8 - outward)):
        assert "strips of a piece do not cover" in reason(row(SUPPLIES, piece_of(borders=borders)))
    # Of each number that the supply rate of a strip goes with, whichever way.
    near = around(problem, Fraction(1, 50))
    halves = [
        0.5 * (FRICTIONS[1] - FRICTIONS[0]),
        *(0.5 * float(np.diff(near.span(name))[0]) for name in NEAR),
    ]
    for k, half in enumerate(halves):
        for sign in (-1.0, 1.0):
            slopes = tuple(sign * 0.01 / half * (n == k) for n in range(len(TILTING)))
            for borders in ((0.6901, 0.75, 0.82), (0.68, 0.75, 0.8099)):
                assert "do not cover" in reason(row(SUPPLIES, piece_of(borders=borders, slopes=slopes)))
            assert told(problem, [row(SUPPLIES, piece_of(borders=(0.6899, 0.75, 0.8101), slopes=slopes))])
    assert "supply rate that is not positive" in reason(row((-0.1, 0.8), piece_of(borders=(-0.1, 0.75, 0.8))))
    tilted = piece_of(borders=(0.005, 0.75, 0.82), slopes=slopes)
    assert "supply rate that is not positive" in reason(row((0.69, 0.8), tilted))
    assert "friction that is not positive" in reason(row(SUPPLIES, piece_of((0.0, 0.1))))


def test_everything_is_about_the_numbers_within_the_share(problem, nothing_is_followed):
    """Of the law, of the band and of what is followed; the supply goes on from the end of that."""
    seen, near = nothing_is_followed, around(problem, Fraction(1, 50))
    proof = {"of": "a band"}
    found = told(problem, ROWS, band=proof)
    assert seen.followed == [(near, (near, "asked", 1))]
    assert seen.compared == seen.bands == [near]
    assert seen.rises == [(near, proof, 0.5, 29.0)]
    assert found["band 0 above"] == 0.1
    told(problem, ROWS)
    assert seen.followed[-1] == (near, None)
    assert len(seen.bands) == len(seen.rises) == 1


def test_law_that_is_another_one_is_refused(problem, nothing_is_followed, monkeypatch):
    monkeypatch.setattr(computed_law, "unlike", lambda *_: "it is another one")
    with pytest.raises(Refused, match="it is another one"):
        told(problem, ROWS)
    assert not nothing_is_followed.followed


# --- what is told of all strips ---------------------------------------------------------------------------------------
def test_worst_of_all_strips_counts(problem, monkeypatch):
    whole = {
        "lost": np.zeros(3, dtype=bool),
        "there": np.ones(3, dtype=bool),
        "samples": np.array([5, 9, 7]),
        "top": np.array([0.1, 0.15, 0.12]),
        "low": np.array([0.13, 0.12, 0.139]),
        "high": np.array([0.141, 0.142, 0.1405]),
        "supply": np.array([0.9, 0.8, 0.85]),
        "speed": np.array([30.0, 29.0, 31.0]),
    }
    monkeypatch.setattr(way_in, "courses", lambda *_: Courses(**whole))
    found = followed(problem, problem.controller, ())
    assert found == pytest.approx(
        {"largest slip": 0.15, "time": 9 * 0.02, "above": 0.002, "below": 0.02, "supply": 0.8, "speed": 29.0}
    )
    whole["lost"] = np.array([False, True, False])
    with pytest.raises(Refused, match="is lost"):
        followed(problem, problem.controller, ())
    whole |= {"lost": np.zeros(3, dtype=bool), "there": np.array([True, True, False])}
    with pytest.raises(Refused, match="not in the ellipsoid"):
        followed(problem, problem.controller, ())


def strips(*samples):
    return [Strip(piece_of(samples=(each,), borders=(0.7, 0.8)), 0) for each in samples]


class Planted:
    """A course of boxes with slips that are given, in place of what is followed."""

    def __init__(self, tops, slips):
        self.tops, self.slips = np.array(tops), np.array(slips)

    def __call__(self, _law, _vehicle, _rail, boxes, _speed):
        going = np.arange(len(boxes[0]))
        for k in range(self.tops.shape[1]):
            n = len(going)

            def form(middle, half, n=n):
                return Affine(middle, np.full((n, 1), half), np.zeros(n))

            state = SimpleNamespace(
                sliding=form(20.0 * self.slips[going, k], 0.02),
                speed=form(np.full(n, 20.0), 0.1),
                supply=form(np.full(n, 0.1 * k), 0.01),
            )
            kept = yield self.tops[going, k], state, None
            if kept is not None:
                going = going[kept]


def test_strips_are_followed_to_their_ends_and_no_top_is_forgotten(problem, monkeypatch):
    tops = [[0.1, 0.05, 0.3, 0.9], [0.1, 0.2, 0.15, 0.1], [0.1, np.inf, 0.1, 0.1], [0.1, np.nan, 0.1, 0.1]]
    slips = [[0.10, 0.11, 0.12, 0.13]] * 4
    monkeypatch.setattr(approach, "follow", Planted(tops, slips))
    found = courses(problem, problem.controller, strips(3, 4, 4, 4))
    assert found.lost.tolist() == [False, False, True, True]
    assert found.there.tolist() == [True, True, False, False]
    assert found.samples.tolist() == [3, 4, 2, 2]
    assert found.top[:2].tolist() == [0.3, 0.2]
    for k, slip in ((0, 0.12), (1, 0.13)):
        assert found.low[k] <= (20.0 * slip - 0.02) / 19.9
        assert found.high[k] >= (20.0 * slip + 0.02) / 20.1
        assert found.high[k] - found.low[k] < 0.01
        assert found.supply[k] == pytest.approx(0.1 * (found.samples[k] - 1) - 0.01)
        assert found.speed[k] == pytest.approx(19.9)


def test_wheels_that_are_asked_for_something_are_followed_until_they_have_it_and_not_longer(
    problem, monkeypatch
):
    monkeypatch.setattr(approach, "follow", Planted([[0.1, 0.2, 0.9]] * 3, [[0.14] * 3] * 3))
    calls = []

    def arrived(*_):
        calls.append(None)
        return {1: np.array([False, True, False]), 2: np.array([False, True])}[len(calls)]

    monkeypatch.setattr(arrival, "arrived", arrived)
    found = courses(problem, problem.controller, strips(2, 3, 3), SimpleNamespace())
    assert found.there.tolist() == [False, True, True]
    assert found.samples.tolist() == [2, 1, 2]
    assert found.top.tolist() == [0.2, 0.1, 0.2]


# --- the verdict ------------------------------------------------------------------------------------------------------
NUMBERS = {
    "share": 0.02,
    "friction low": FRICTIONS[0],
    "friction high": FRICTIONS[1],
    "largest slip": 0.1405,
    "time": 3.0,
    "above": 0.0005,
    "below": 0.004,
    "supply": 0.9,
    "speed": 29.0,
}


def verdict(problem, **changed):
    finding = Finding(status=Status.PROVED, asked="strips", shown="strips", numbers=NUMBERS | changed)
    left = {each.key: each.decide(Stated(), Work()) for each in SLIP_WAY_IN.obligations(problem)}
    return SLIP_WAY_IN.tell(problem, left | {STRIPS: finding})


def test_only_all_of_the_friction_and_an_end_at_the_reference_prove_the_claim(problem):
    found = verdict(problem)
    assert found.status is Status.PROVED
    assert found.margin.low == pytest.approx(1.0 - 0.1405)
    assert found.worst_point[0].value == 0.1405
    assert "What comes after is not shown" in found.explanation
    assert "no farther from its nominal value than 2 % of" in found.claim
    for changed, words in (
        ({"friction low": FRICTIONS[0] + 1e-9}, "not over all of its range"),
        ({"friction high": FRICTIONS[1] - 1e-9}, "not over all of its range"),
        ({"above": 0.011}, "not come to its reference"),
        ({"below": 0.011}, "not come to its reference"),
    ):
        found = verdict(problem, **changed)
        assert found.status is Status.UNDECIDED
        assert words in found.explanation
        assert found.margin is None
    assert "2.0001 % of" in verdict(problem, share=0.0200019).claim
    assert "at their nominal values" in verdict(problem, share=0.0).claim


def test_band_counts_only_for_the_friction_that_is_proved(problem, monkeypatch):
    """Over numbers that may lie as far from the nominal ones as any share lets them."""
    asked = []

    def covered(near, _findings, name):
        asked.append((near, name))
        return Finding(status=Status.UNDECIDED, asked="strips")

    monkeypatch.setattr(band, "covered", covered)
    assert verdict(problem, **{"band 0 above": 0.01}).status is Status.UNDECIDED
    assert asked == [(around(problem), STRIPS)]
    claims = band.claims(around(problem))
    for one in SLIP_WAY_IN.obligations(problem)[:-1]:
        assert one.claim.variables == claims[one.key].variables


def test_what_the_way_in_does_not_speak_about(problem):
    law = problem.controller
    other = replace(problem.vehicle, wheel_radius=0.54)
    assert "another wheel radius" in SLIP_WAY_IN.speaks_about(replace(problem, vehicle=other))
    assert "holds slip" in SLIP_WAY_IN.speaks_about(replace(problem, slip=0.15))
    assert SLIP_WAY_IN.speaks_about(replace(problem, controller=law)) == ""
    with pytest.raises(OutsideModel, match="range"):
        SLIP_WAY_IN.obligations(replace(problem, bounds=problem.bounds | {SUPPLY: (-0.1, 0.8)}))


def test_all_numbers_with_bounds_that_count_are_told_as_held():
    whole = problem_of(1.0, rail=wd.load_rail("low-adhesion"))
    held = set(
        verdict(whole, **dict(zip(("friction low", "friction high"), whole.span(FRICTION), strict=True))).held
    )
    named = {name for name, _ in whole.bounds.items()}
    assert held == named - {FRICTION, SUPPLY}
    assert {"resistance linear", "mass", "semi axis rolling"} <= held
