"""Proofs of the band that say too much, by one number each, and what the checker takes from one that holds."""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import arb, ctx

from tests.certificates.band.conftest import WET, refused, told_of
from tests.certificates.band.courses import doubles, falling_problem, laws, loop_in
from tests.certificates.band.forging import CHANGE, OFFSET, SHARES, STEADY, SUPPLY
from tests.certificates.band.test_declared_law import problem_with
from wspd_design.certificates.kernel.arb import above, below, point
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES
from wspd_design.certificates.theorems.band import contact_held
from wspd_design.certificates.theorems.slip_band import checker
from wspd_design.certificates.theorems.slip_band.checker import Set, holds_more, is_positive, steady_of
from wspd_design.certificates.theorems.slip_band.proof import read
from wspd_design.certificates.theorems.slip_band.pulses import loop_law
from wspd_design.certificates.theorems.slip_band.statement import box_of, law_of, windows_of

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("place", [OFFSET, *range(SHARES, SHARES + len(DISTURBANCES)), STEADY, CHANGE])
def test_every_share_counts_in_the_sum_and_none_is_below_0(half, proof, place):
    """One below 0, of what does not disturb, would leave more than there is for the others."""
    for share in ("1.0", "-0.1"):
        proof["ellipsoids"][0][place] = share
        assert "add up to more than 1" in refused(half, proof)


def test_share_of_the_change_of_the_steady_drift_is_needed(half, proof):
    each = proof["ellipsoids"][0]
    each[CHANGE] = repr(1e-6 * float(each[CHANGE]))
    assert "may lead out of an ellipsoid" in refused(half, proof)


@pytest.mark.parametrize("ends", [(-1.0, 0.001), (-0.001, 1.0)])
def test_errors_on_either_side_of_where_the_slope_is_bounded_are_refused(half, proof, monkeypatch, ends):
    monkeypatch.setattr(checker, "_within", lambda *_: (point(-0.001), point(0.001)))
    assert told_of(half, proof)
    monkeypatch.setattr(checker, "_within", lambda *_: tuple(map(point, ends)))
    assert "range in which the slope of the friction is bounded" in refused(half, proof)


def test_valves_that_begin_later_than_the_proof_allows_are_refused(half, proof):
    brake = replace(half.vehicle.brake, dead_time=0.002)
    slow = replace(half, vehicle=replace(half.vehicle, brake=brake))
    proof["delay"] = "0.0999"
    assert "begin later than the proof allows" in refused(slow, proof)


def test_noise_with_which_the_law_holds_its_valves_is_refused(half, proof):
    """The law holds them where the speed that it is told falls below its limit."""
    near = replace(half, controller=replace(half.controller, cut_out_speed=half.speeds[0] - 1e-4))
    proof["noise"] = "0.001"
    assert "may hold its valves" in refused(near, proof)


def test_noise_for_a_law_that_was_compared_without_is_refused(tmp_path, proof):
    proof["noise"] = "0.001"
    assert "for speeds without noise" in refused(problem_with(tmp_path), proof)


def test_nothing_is_left_out_where_the_brake_is_too_weak(half, proof):
    """Without a reserve there is no window about which nothing is claimed, whatever holding takes."""
    law, window = law_of(half.controller), windows_of(half)[0]
    friction = read(proof, len(windows_of(half))).friction[0]
    box = box_of(half, Fraction(1))
    weak = (*box[:4], (Fraction(1000), Fraction(1000)), *box[5:])
    with ctx.workprec(128):
        asked = [
            holds_more(contact_held(half), law, weak, window, friction, Fraction(r)) for r in ("1", "0.99")
        ]
    assert asked == [False, True]


def test_what_is_told_is_the_worst_of_all_cells(half, proof, monkeypatch):
    """Least supply and bands of two cells, in either order."""
    count = len(windows_of(half))
    less = [
        [*each[:SUPPLY], repr(0.5 * float(each[SUPPLY])), *each[SUPPLY + 1 :]] for each in proof["ellipsoids"]
    ]
    own = proof["cells"][0]
    supplies = [float(proof["ellipsoids"][k][SUPPLY]) for k in own]
    proof["ellipsoids"] += less
    proof["steps"] = "m.."
    monkeypatch.setattr(checker, "lies_in", lambda *_: True)
    for cells in ([own, [k + len(less) for k in own]], [[k + len(less) for k in own], own]):
        bands = iter([(point(-0.01), point(0.02))] * count + [(point(-0.03), point(0.01))] * count)
        monkeypatch.setattr(checker, "errors", lambda *_, bands=bands: next(bands))
        told = told_of(half, {**proof, "cells": cells})
        radius = half.span("wheel radius")[1]
        for k, (slowest, _) in enumerate(windows_of(half)):
            assert told[f"supply {k}"] == pytest.approx(supplies[k])
            assert told[f"band {k} above"] == pytest.approx(0.03 * radius / slowest)
            assert told[f"band {k} below"] == pytest.approx(0.02 * radius / slowest)


def test_band_reaches_as_far_as_the_center_moves(half, proof):
    """To either end of the steady drift, about the error that is settled."""
    windows, told = windows_of(half), told_of(half, proof)
    found = read(proof, len(windows))
    for k, each in enumerate(found.cells[0]):
        steady = steady_of(contact_held(half), found, (box_of(half, Fraction(1)), k), each)
        ends = [float(end.mid()) - float(each.drift) for end in (steady.low, steady.high)]
        slip, reach = half.span("wheel radius")[1] / windows[k][0], math.sqrt(each.matrix[0][0])
        middles = [float(each.settled + each.center[0]) + float(each.moves[0]) * end for end in ends]
        assert slip * (max(middles) + reach) <= told[f"band {k} below"]
        assert slip * (reach - min(middles)) <= told[f"band {k} above"]


def test_function_reaches_as_far_as_on_an_ellipsoid_whose_center_moves():
    random = np.random.default_rng(5)
    half = random.normal(size=(3, 3))
    q, center, moved, row = half @ half.T, *random.normal(size=(3, 3))
    balls = [[point(float(x)) for x in each] for each in (*q, center, moved, row)]
    found = Set(balls[:3], balls[3], balls[4])
    ends = row @ center + np.array([-1.0, 1.0]) * abs(row @ moved)
    steps = random.normal(size=(2000, 3))
    around = (half @ (steps / np.linalg.norm(steps, axis=1)[:, None]).T).T @ row
    middle, reach = float(found.at(balls[5]).mid()), float(found.reach(balls[5]).mid())
    assert middle - reach <= ends[0] + min(around) <= middle - 0.98 * reach
    assert middle + 0.98 * reach <= ends[1] + max(around) <= middle + reach


@pytest.mark.parametrize(
    ("matrix", "positive"),
    [
        ([[1, 0.9], [0.9, 1]], True),
        ([[1, 1], [1, 1]], False),
        ([[1, 2], [2, 1]], False),
        ([[1, 0, 0.8], [0, 1, 0.8], [0.8, 0.8, 1]], False),
        ([[2, 1, 1], [1, 2, 1], [1, 1, 2]], True),
        ([[2, -1.9, 1.9], [-1.9, 2, 1], [1.9, 1, 2]], False),
        ([[0]], False),
        ([[arb(1, 1.5)]], False),  # it may be below 0
        ([[arb("nan")]], False),
    ],
)
def test_only_what_is_positive_whatever_its_numbers_are_is_taken_for_positive(matrix, positive):
    assert (
        is_positive(
            [[each if isinstance(each, arb) else point(float(each)) for each in row] for row in matrix]
        )
        is positive
    )


@pytest.mark.parametrize("steps", ["mm.", "..m", ".m.", "m.m", "mx.", "m.x"])
def test_steps_that_leave_a_half_out_are_refused(half, proof, monkeypatch, steps):
    """A range that is halved has two halves, each with its ellipsoids."""
    monkeypatch.setattr(checker, "errors", lambda *_: (point(-0.01), point(0.01)))
    cells = 2 * proof["cells"]
    assert told_of(half, {**proof, "steps": "m..", "cells": cells})["cells"] == 2.0
    assert refused(half, {**proof, "steps": steps, "cells": cells})


# --- between samples --------------------------------------------------------------------------------------------------
STEPS = 400


@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("settled", [0.0, 0.05])
def test_error_stays_in_its_band_at_every_instant(number, settled):
    """The farthest states of an ellipsoid, with pulses that are gone at once, later or not at all."""
    problem = falling_problem(WET, 0.0, slip=0.5, largest=0.5)
    law = laws(problem)[number]
    loop = loop_in(problem, law, settled)
    spread = np.diag([0.004, 0.01, 0.05, 0.05, 0.002])
    q, center = spread @ spread.T, np.array([0.002, 0.0, 0.01, -0.01, 0.001])
    with ctx.workprec(128):
        states = Set(
            *([[point(float(x)) for x in each] for each in q],),
            [point(float(x)) for x in center],
            [point(0)] * STATES,
        )
        low, high = checker._within(loop_law(law), loop, states)
    lowest, highest = below(low), above(high)
    (effect,) = set(doubles(loop.ranges.effects))
    farthest = max(float(end.mid()) for each in loop.pulses for end in each.parts)
    h, gain, ahead = float(law.sample_time), float(law.approach_rate * law.sample_time), float(law.ahead)
    ends = [doubles(each) for each in loop.disturbances]
    share = float(loop.steady.share.mid())
    steady = [share * float(each.mid()) for each in (loop.steady.low, loop.steady.high)]
    t = (np.arange(STEPS) + 0.5) / STEPS
    seen = []
    for secant, begin, known, command, mean, moved in product(
        doubles(loop.ranges.secants), (0.0, 0.5, 1.0), ends[0], ends[1], (0, 1), ends[6]
    ):
        gone = farthest * (t >= begin)
        # Columns: what each state adds to the error, and what disturbs.
        wanted = np.array([gain, 0.0, 1.0 + gain * ahead, -1.0 - gain * ahead, 1.0 + gain * ahead])
        asked = wanted[4] * known + command
        weight = np.exp(-secant * h * t)
        drift = (ends[3][mean] + steady[mean]) * t * np.sum(weight) / np.sum(weight * t)
        e = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        for k in range(STEPS):
            forced = (
                -effect
                / STEPS
                * np.append(
                    np.array([0.0, 0.0, 0.0, 1.0, 0.0]) + gone[k] * wanted, gone[k] * asked - drift[k]
                )
            )
            forced[5] += moved / STEPS
            e = e + forced + secant * h / STEPS * (e + forced / 2.0)
            if k % 20 == 19:
                middle, reach = e[:5] @ center + e[5], math.sqrt(e[:5] @ q @ e[:5])
                seen.append((middle - reach, middle + reach))
    lows, highs = zip(*seen, strict=True)
    assert lowest <= min(lows) <= 0.9 * lowest
    assert 0.9 * highest <= max(highs) <= highest
