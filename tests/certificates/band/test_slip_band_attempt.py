"""A search that ends: it is told with its cell and window, kept in the file, drawn again, and proves nothing."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from tests.certificates.band.conftest import SLOW, certificate_of, problem_of
from wspd_design.certificates.checks.region import slip_band
from wspd_design.certificates.checks.region.slip_band_figures import UNKNOWN_REMARK, figures
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.finding import Effort
from wspd_design.certificates.records import Role, Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.slip_band import search
from wspd_design.certificates.search.slip_band.chain import OutOfBudget, Sought, Spent, begun
from wspd_design.certificates.theorems.band import CELLS, SLIP_BAND, contact_held
from wspd_design.certificates.theorems.slip_band.attempt import attempt_of, cells_of, effort_of
from wspd_design.certificates.theorems.slip_band.statement import box_of, law_of

pytestmark = pytest.mark.slow
FAILING = Fraction(7, 8)  # share that has no ellipsoids in the planted search


@pytest.fixture(scope="module")
def problem():
    return problem_of(0.5, speeds=SLOW)


@pytest.fixture(scope="module")
def planted(problem):
    """Certificate of a search that finds no cell worth halving as soon as the share is as large as the planted one."""
    usual = search.left_of

    def failing(sought, chain):
        return 1 if failing.share >= FAILING else usual(sought, chain)

    def cover(sought, share, spent):
        failing.share = share
        return original(sought, share, spent)

    original = search.cover
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(search, "left_of", failing)
        patch.setattr(search, "cover", cover)
        patch.setattr(search, "_letter", lambda *_: None)
        patch.setattr(slip_band, "_reserved", lambda _: slip_band.Stated())
        patch.setattr(slip_band, "_departure", lambda _: slip_band.Stated())
        return certificate_of(problem)


@pytest.mark.parametrize(("closed", "most"), [(0.0, 10), (0.2, 10), (0.5, 20), (1.0, 40)])
def test_more_is_sought_the_more_of_the_box_has_closed(closed, most):
    spent = Spent(10)
    spent.closed = closed
    for _ in range(most):
        spent.one(0)
    with pytest.raises(OutOfBudget):
        spent.one(0)


def test_half_of_a_cell_counts_for_half_of_it(problem, monkeypatch):
    """A planted search that halves the box, then its first half, and finds ellipsoids in what is left."""
    spent, seen = Spent(), []
    left = iter((1, 1, -1, -1, -1))

    def chain(*_):
        seen.append(spent.closed)
        return begun(sought, cell)

    _, friction = slip_band.bounded_friction(problem, SLIP_BAND.obligations(problem))
    law, cell = law_of(problem.controller), box_of(problem, Fraction(1))
    sought = Sought(
        problem=contact_held(problem), law=law, friction=friction, conditions=search.exactly(problem, law)
    )
    monkeypatch.setattr(search, "_chain", chain)
    monkeypatch.setattr(search, "left_of", lambda *_: next(left))
    monkeypatch.setattr(search, "_middle_has", lambda *_: True)
    monkeypatch.setattr(search, "_letter", lambda *_: "m")
    found = search.cover(sought, Fraction(1), spent)
    assert found.steps == "mm..."
    assert seen == [0.0, 0.0, 0.0, 0.25, 0.5]
    assert spent.closed == 1.0


def failed(shown):
    return [each for each in shown.series if each.role is Role.FAILED]


def test_cell_that_failed_is_told_kept_and_drawn_again(problem, planted):
    assert planted.status is Status.UNDECIDED
    assert planted.explanation.startswith("Shown on 75 % of each range")
    low, high = problem.span("mass")
    middle = problem.nominal("mass")
    mass = " to ".join(f"{middle + 0.875 * (end - middle):.6g}" for end in (low, high))
    told = "On 87.5 % of each range the search closed 0 cells, and found no ellipsoid at 12 to 14 km/h, where mass "
    assert f"{told}{mass} kg, wheelset inertia " in planted.explanation
    assert planted.explanation.endswith("that proves nothing.")
    text = certificate_text(planted)
    again = replay(problem, text)
    assert again.accepted, again.reason
    (drawn,) = failed(figures(problem, planted))
    assert drawn.name == "failed at 12 to 14 km/h on 87.5 % of each range"
    assert failed(figures(problem, again.certificate)) == [drawn]


def without_an_end(effort):
    return {name: each for name, each in effort.items() if name != "ended"}


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (without_an_end, "explanation"),
        (lambda effort: effort | {"ended": effort["ended"] | {"window": 0}}, "explanation"),
        (lambda effort: effort | {"ended": effort["ended"] | {"window": 2}}, "window that is not there"),
        (lambda effort: effort | {"ended": effort["ended"] | {"share": "3/4"}}, "that the proof covers"),
        (lambda effort: effort | {"ended": effort["ended"] | {"share": "9/8"}}, "no share"),
        (lambda effort: effort | {"ended": effort["ended"] | {"steps": "."}}, "names no cell"),
        (lambda effort: effort | {"ended": effort["ended"] | {"steps": "x"}}, "lead to no cells"),
        (lambda effort: effort | {"ended": effort["ended"] | {"why": "because"}}, "does not say where"),
        (lambda effort: effort | {"ended": ["here"]}, "does not say where"),
    ],
)
def test_other_ends_are_refused(problem, planted, change, reason):
    document = json.loads(certificate_text(planted))
    found = document["findings"][CELLS]
    found["effort"] = change(found["effort"])
    again = replay(problem, json.dumps(document))
    assert not again.accepted
    assert reason in again.reason


def test_file_of_an_earlier_version_is_accepted_and_its_end_is_not_known(problem, planted):
    document = json.loads(certificate_text(planted))
    del document["findings"][CELLS]["effort"]
    document["explanation"] = document["explanation"].partition(" On 87.5 %")[0]
    again = replay(problem, json.dumps(document))
    assert again.accepted, again.reason
    shown = figures(problem, again.certificate)
    assert UNKNOWN_REMARK in shown.remark
    assert failed(shown) == []


def test_a_search_that_the_budget_ends_says_so(monkeypatch):
    """One ellipsoid, and two windows: the faster one is found, and the slower one is not looked at."""
    problem = problem_of(0.1, speeds=SLOW)
    monkeypatch.setattr(slip_band, "SOUGHT", 1)
    monkeypatch.setattr(slip_band, "_departure", lambda _: slip_band.Stated())
    found = certificate_of(problem, effort=1.0)
    assert found.status is Status.UNDECIDED
    assert (
        "On 12.5 % of each range the search closed 0 cells, and was cut by its budget at 10 to 12 km/h"
        in (found.explanation)
    )
    (drawn,) = failed(figures(problem, found))
    assert drawn.name == "not decided within the budget at 10 to 12 km/h on 12.5 % of each range"
    assert found.cut
    assert found.undecided == 1.0


def test_what_is_closed_and_what_is_left_fill_the_box(problem):
    box = box_of(problem, Fraction(1))
    closed, waiting = cells_of(box, "ut..m.")
    assert (len(closed), len(waiting)) == (3, 1)

    def size(cells):
        shares = []
        for cell in cells:
            share = Fraction(1)
            for (low, high), (least, most) in zip(cell, box, strict=True):
                share *= (high - low) / (most - least)
            shares.append(share)
        return sum(shares)

    assert size(closed) + size(waiting) == 1
    assert waiting[0][0] == ((box[0][0] + box[0][1]) / 2, box[0][1])


def test_end_that_is_not_stated_is_none(problem):
    assert attempt_of(problem, Effort(boxes=3)) is None
    attempt = search.Attempt(share=Fraction(3, 8), steps="u.", window=1, tried=3, cut=True)
    effort = effort_of(problem, attempt, proved=Fraction(0))
    assert attempt_of(problem, effort) == attempt
    with pytest.raises(Refused):
        attempt_of(problem, replace(effort, ended={**effort.ended, "share": 1}))
