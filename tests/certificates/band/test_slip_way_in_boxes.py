"""What is kept of boxes from sample to sample, where they begin and where they have arrived; and what is compared."""

from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band import sampled_runs
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.test_slip_band_read import an_ellipsoid, parts
from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.theorems.slip_band import (
    approach,
    arrival,
    computed_law,
    followed_law,
    followed_plant,
    way_in,
)
from wspd_design.certificates.theorems.slip_band.arrival import Asked, arrived
from wspd_design.certificates.theorems.slip_band.loop import Steady
from wspd_design.certificates.theorems.slip_band.proof import Proof, write
from wspd_design.certificates.theorems.slip_band.statement import windows_of
from wspd_design.certificates.theorems.slip_band.way_in import (
    FRICTION,
    NEAR,
    SUPPLY,
    TILTING,
    Piece,
    Strip,
    _boxes,
    around,
    asked_of,
)
from wspd_design.parameters.bounds import Bounds

STATES = len(followed_plant.State._fields)


@pytest.fixture(scope="module")
def problem():
    return problem_of(1.0, rail=wd.load_rail("low-adhesion"))


# --- from sample to sample --------------------------------------------------------------------------------------------
def test_what_is_kept_of_the_symbols_holds_all_that_they_were():
    """In every direction of the states, for each value of the symbols that are kept as they are."""
    random, boxes, size = np.random.default_rng(8), 3, approach.KEPT + 40
    sizes = random.uniform(0.1, 1.0, size) ** 6
    forms = [
        Affine(random.normal(size=boxes), random.normal(size=(boxes, size)) * sizes, random.random(boxes))
        for _ in range(STATES)
    ]
    kept = approach._fewer(followed_plant.State(*forms))
    assert kept.shape == (boxes, STATES, approach.KEPT)
    own = approach.PARAMETERS
    slopes, errors = (np.stack([getattr(x, name) for x in forms], axis=1) for name in ("slopes", "error"))
    np.testing.assert_array_equal(kept[:, :, :own], slopes[:, :, :own])
    for direction in (
        *np.eye(STATES),
        *random.normal(size=(60, STATES)),
        *random.choice([-1.0, 1.0], (60, STATES)),
    ):
        before = np.abs(np.einsum("k,bks->bs", direction, slopes[:, :, own:])).sum(axis=1)
        before += errors @ np.abs(direction)
        after = np.abs(np.einsum("k,bks->bs", direction, kept[:, :, own:])).sum(axis=1)
        assert np.all(after >= before * (1.0 - 1e-12))


def test_every_number_of_a_sample_has_a_symbol_of_its_own(problem):
    """No two errors of a sample are one: forms that only seem to be alike do not cancel."""
    law = problem.controller
    used = []
    original = Affine.named

    def named(form, symbol):
        used.append((symbol, bool(np.any(form.slopes[:, symbol]))))
        return original(form, symbol)

    centers = np.array([[problem.nominal(name) for name in followed_plant.NUMBERS]])
    spread = np.zeros((1, len(followed_plant.NUMBERS), len(followed_plant.NUMBERS)))
    spread[0, range(8), range(8)] = 1e-3 * centers[0]
    course = approach.follow(law, problem.vehicle, problem.rail, (centers, spread), 30.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Affine, "named", named)
        for _ in range(3):
            used.clear()
            next(course)
            symbols = [symbol for symbol, _ in used]
            assert len(set(symbols)) == len(symbols)
            assert not any(taken for _, taken in used)
            assert approach.KEPT not in symbols  # that of the time


@pytest.mark.parametrize("seed", range(3))
def test_strips_hold_every_supply_rate_with_every_number(problem, seed):
    """Where strips cover a row, each supply rate lies in one, on the line that the numbers of the train move."""
    random = np.random.default_rng(seed)
    near = around(problem, Fraction(1, 20))
    middles = [0.08, *(0.5 * sum(near.span(name)) for name in NEAR)]
    slopes = tuple(0.02 * random.uniform(-1.0, 1.0) / middle for middle in middles)
    piece = Piece(friction=(0.078, 0.082), slopes=slopes, borders=(0.5, 0.52, 0.55, 0.6), samples=(1, 1, 1))
    shift = way_in.tilt(near, piece)
    centers, spread = _boxes(near, [Strip(piece, k) for k in range(3)])
    supply = followed_plant.NUMBERS.index(SUPPLY)
    places = [followed_plant.NUMBERS.index(name) for name in TILTING]
    ends = np.array([piece.friction, *(near.span(name) for name in NEAR)])
    for _ in range(300):
        z = random.choice([-1.0, 1.0, 0.3], len(TILTING))
        numbers = ends.mean(axis=1) + 0.5 * np.diff(ends, axis=1)[:, 0] * z
        rate = random.choice([0.5 + shift, 0.6 - shift, random.uniform(0.5 + shift, 0.6 - shift)])
        # Each border goes with the numbers, which are in the middle where it is told.
        moved = np.array(piece.borders) + np.array(slopes) @ (numbers - ends.mean(axis=1))
        (k,) = np.flatnonzero((moved[:-1] <= rate) & (rate < moved[1:]))
        own = (numbers - centers[k, places]) / spread[k, places, places]
        apart = rate - centers[k, supply] - spread[k, supply, places] @ own
        assert np.all(np.abs(own) <= 1.0)
        assert abs(apart) <= spread[k, supply, supply]
    for k in range(3):
        assert spread[k, supply, supply] < 0.51 * (piece.borders[k + 1] - piece.borders[k])


# --- arrival ----------------------------------------------------------------------------------------------------------
FORMS = 5


def asked_for(random, **changed):
    half = random.normal(size=(FORMS, FORMS))
    numbers = {
        "speeds": (20.0, 25.0),
        "settled": 0.0,
        "matrix": half @ half.T + 0.3 * np.eye(FORMS),
        "center": random.normal(size=FORMS),
        "moved": 0.03 * random.normal(size=FORMS),
        "supply": 0.5,
    }
    return Asked(**{**numbers, **changed})


def state_of(speed=(22.0, 0.1), supply=(0.7, 0.01)):
    def form(middle, half):
        return Affine(np.array([middle]), np.array([[half]]), np.zeros(1))

    return followed_plant.State(*(form(0.0, 0.0) for _ in range(STATES - 1)), form(*supply))._replace(
        speed=form(*speed)
    )


# What is wide, in the coordinates of the ellipsoid: the point, one symbol, errors, where the center is; or all of it.
WIDE = {
    "point": (0.9, 0.0, 0.0, 0.0),
    "symbol": (0.0, 1.0, 0.0, 0.0),
    "errors": (0.0, 0.0, 1.0, 0.0),
    "center": (0.0, 0.1, 0.0, 0.9),
    "all": (0.1, 0.3, 0.3, 0.2),
}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", WIDE)
def test_wheels_that_have_arrived_are_in_the_ellipsoid_wherever_its_center_is(monkeypatch, kind, seed):
    """The largest box about a point that counts as there: none of its corners, nor of its errors, is outside."""
    random, (far, wide, wrong, moves) = np.random.default_rng(seed), WIDE[kind]
    asked = asked_for(random)
    matrix, center = (np.array(each) for each in (asked.matrix, asked.center))
    inward = np.linalg.inv(np.linalg.cholesky(matrix)).T  # makes a vector of length 1 one of the boundary

    def direction():
        found = random.normal(size=FORMS)
        return inward @ (found / np.linalg.norm(found))

    moved, apart = moves * direction(), far * direction()
    asked = asked._replace(moved=moved)
    slopes = np.stack([direction() * (wide if k == 0 or kind == "all" else 0.0) for k in range(6)], axis=1)
    errors = wrong * random.random(FORMS) * np.abs(inward).sum(axis=1) / 4.0 + 1e-6

    def there(size):
        # A point that is far away is so by the same factor as all else.
        middle = center + (size * apart if kind == "point" else apart)
        forms = tuple(
            Affine(np.array([m]), size * s[None, :], np.array([size * e]))
            for m, s, e in zip(middle, slopes, errors, strict=True)
        )
        monkeypatch.setattr(arrival, "in_band", lambda *_: forms)
        return bool(arrived(None, None, state_of(), asked)[0])

    least, most = 0.0, 1e4
    for _ in range(60):
        size = 0.5 * (least + most)
        least, most = (size, most) if there(size) else (least, size)
    assert 0.0 < least < 1e4
    corners = np.array(list(product((-1.0, 1.0), repeat=6)))
    signs = np.array(list(product((-1.0, 1.0), repeat=FORMS)))
    points = (least * apart if kind == "point" else apart) + (least * corners @ slopes.T)[:, None, :]
    points = points + least * signs * errors
    sizes = [np.einsum("abi,ij,abj->ab", x, matrix, x).max() for x in (points - moved, points + moved)]
    assert max(sizes) <= 1.0
    if kind in ("point", "symbol"):
        assert max(sizes) > 0.9


def test_points_that_have_arrived_are_in_the_ellipsoid_in_exact_numbers(monkeypatch):
    """The farthest one, whose length is rounded."""
    random = np.random.default_rng(12)
    for _ in range(20):
        axes, _ = np.linalg.qr(random.normal(size=(FORMS, FORMS)))
        matrix = axes @ np.diag(10.0 ** np.linspace(-4.0, 4.0, FORMS)) @ axes.T
        asked = asked_for(random, matrix=0.5 * (matrix + matrix.T), moved=[0.0] * FORMS)
        direction = axes[:, 0]  # in which the ellipsoid is longest, and rounding counts most

        def forms(size, center=asked.center, direction=direction):
            still = np.zeros((1, 1))
            return tuple(
                Affine(np.array([c + size * d]), still, np.zeros(1))
                for c, d in zip(center, direction, strict=True)
            )

        least, most = 0.0, 1e3
        while most - least > 1e-16 * most and least < (middle := 0.5 * (least + most)) < most:
            monkeypatch.setattr(arrival, "in_band", lambda *_, size=middle: forms(size))
            there = bool(arrived(None, None, state_of(), asked)[0])
            least, most = (middle, most) if there else (least, middle)
        x = [
            Fraction(each.center[0]) - Fraction(float(c))
            for each, c in zip(forms(least), asked.center, strict=True)
        ]
        length = sum(Fraction(asked.matrix[i, j]) * x[i] * x[j] for i, j in product(range(FORMS), repeat=2))
        assert 1.0 - 1e-5 < length <= 1


def test_wheels_outside_of_the_speeds_or_with_less_supply_have_not_arrived(monkeypatch):
    asked = asked_for(np.random.default_rng(1))
    still = tuple(Affine(np.array([c]), np.zeros((1, 1)), np.zeros(1)) for c in asked.center)
    monkeypatch.setattr(arrival, "in_band", lambda *_: still)
    asked = asked._replace(moved=[0.0] * FORMS)
    for speed, supply, there in (
        ((22.0, 1.0), (0.7, 0.1), True),
        ((20.05, 0.1), (0.7, 0.1), False),
        ((24.95, 0.1), (0.7, 0.1), False),
        ((22.0, 1.0), (0.55, 0.1), False),
    ):
        assert bool(arrived(None, None, state_of(speed, supply), asked)[0]) is there


# Speed, sliding speed, innovation, observed friction, torque, acceleration, change of the speed, supply, half widths
SETTLING = np.array([30.0, 4.1, 0.003, 7600.0, 7500.0, -0.7, -0.0145, 0.9])
WIDTHS = np.array([0.5, 0.3, 0.01, 800.0, 800.0, 0.2, 0.004, 0.05])


@pytest.mark.parametrize("settled", [0.0, 0.04, -0.01])
@pytest.mark.parametrize("wide", [1e-6, 0.02, 0.3])
def test_state_in_the_coordinates_of_the_band_is_that_of_every_wheel_of_a_box(problem, wide, settled):
    """Wheels, pads and valves are not the nominal ones: the definitions of the band, on the plant of the attack."""
    random, law, names = np.random.default_rng(6), problem.controller, followed_plant.NUMBERS
    boxes, points, size, first = 8, 200, 40, 16
    z = random.choice([-1.0, 1.0, 0.3, -0.6], (boxes, size, points))
    nominal = np.array([problem.nominal(name) for name in names])
    middles = nominal * random.uniform(0.9, 1.1, (boxes, len(names)))
    halves = 0.01 * wide * middles

    def form(values, half, symbol):
        slopes = np.zeros((boxes, size))
        slopes[:, symbol] = half
        return Affine(np.array(values), slopes, np.zeros(boxes))

    numbers = {name: form(middles[:, k], halves[:, k], k) for k, name in enumerate(names)}
    full = law.valve.brake.max_torque
    plant = followed_plant.plant_of(problem.vehicle, problem.rail, full, numbers, len(names))
    state = followed_plant.State(
        *(form([SETTLING[k]] * boxes, wide * WIDTHS[k], first + k) for k in range(STATES))
    )
    found = arrival.in_band(law, plant, state, settled)

    drawn = dict(
        zip(names, np.moveaxis(middles[:, :, None] + halves[:, :, None] * z[:, :8], 1, 0), strict=True)
    )
    held = {name: problem.nominal(name) for name in sampled_runs.BESIDE} | {SUPPLY: drawn[SUPPLY]}
    wheels = sampled_runs.plant_of(problem, {name: drawn[name] for name in sampled_runs.BOX} | held)
    at = SETTLING[:, None] + wide * WIDTHS[:, None] * z[:, first : first + STATES]
    speed, sliding, innovation, friction, torque, acceleration, change, _ = np.moveaxis(at, 1, 0)
    radius, h, inertia = wheels.wheel_radius, law.sample_time, law.wheelset_inertia
    away, wheel = 0.86 * speed / radius + settled, (speed - sliding) / radius
    slowing, _ = sampled_runs.motion(wheels, speed, wheel, 0.0)
    _, released = sampled_runs.motion(wheels, speed, away, 0.0)
    rate = 0.86 * slowing / radius
    t0 = (released - rate) * wheels.wheelset_inertia / (wheels.max_torque / full) / inertia
    pole, r = np.exp(-law.observer_rate * h), innovation / radius
    learned = friction + inertia / h * (1.0 - pole) ** 2 * r
    new = -np.expm1(-h / law.source.acceleration_time)
    known = 0.86 / radius * (acceleration + new * (change / h - acceleration))
    wanted = (
        wheel - away,
        -(pole**2) * r,
        h * (learned / inertia - t0 - rate),
        h * (torque / inertia - t0),
        h * (rate - known),
    )
    symbols = [*range(len(names)), *range(first, first + STATES)]
    rest = [k for k in range(size) if k not in symbols]
    for x, values in zip(found, wanted, strict=True):
        said = x.center[:, None] + np.einsum("bs,bsp->bp", x.slopes[:, symbols], z[:, symbols])
        error = x.error + np.abs(x.slopes[:, rest]).sum(axis=1)
        assert np.all(np.abs(values - said) <= error[:, None] + 1e-9)
        assert np.all(error < 0.05 * wide + 1e-6)


def test_what_a_band_asks_for_is_that_of_its_fastest_window(problem, monkeypatch):
    """Wherever the center is for a steady drift of either end."""
    near = replace(around(problem), speeds=(20.0, 30.0))
    count = len(windows_of(near))
    assert count > 1
    ellipsoids = [
        replace(an_ellipsoid(k), near=0, matrix=positive(k), supply=Fraction(1, 2 + k)) for k in range(count)
    ]

    def proof(**changed):
        numbers = {
            "share": Fraction(1),
            "delay": Fraction(0),
            "noise": Fraction(0),
            "reserve": Fraction(1),
            "friction": tuple(parts(k) for k in range(count)),
            "steps": ".",
            "cells": (tuple(ellipsoids),),
        }
        return write(Proof(**{**numbers, **changed}))

    fastest, where = ellipsoids[-1], []
    none = point(0)

    def steady_of(_problem, _found, at, each):
        where.append((at[1], each))
        ends = (point(each.drift - Fraction(3, 10)), point(each.drift + Fraction(1, 10)))
        return Steady(*ends, (none, none), none, none)

    monkeypatch.setattr(way_in, "steady_of", steady_of)
    asked = asked_of(near, proof())
    assert where == [(count - 1, fastest)]
    assert asked.speeds == windows_of(near)[-1]
    assert (asked.settled, asked.supply) == (float(fastest.settled), float(fastest.supply))
    np.testing.assert_allclose(asked.center, [float(each) for each in fastest.center])
    np.testing.assert_allclose(np.abs(asked.moved), [0.3 * abs(float(each)) for each in fastest.moves])
    whole = np.array(fastest.matrix, dtype=float)
    np.testing.assert_allclose(np.array(asked.matrix) @ whole, np.eye(FORMS), atol=1e-9)
    two = {"steps": "m..", "cells": (tuple(ellipsoids),) * 2}
    for changed in ({"share": Fraction(99, 100)}, two):
        with pytest.raises(Refused, match="the whole box"):
            asked_of(near, proof(**changed))


def positive(k):
    return tuple(tuple(Fraction(1 + k + (5 + k) * (i == j)) for j in range(FORMS)) for i in range(FORMS))


def test_box_around_the_nominal_numbers_reaches_as_far_as_the_share(problem):
    near = around(problem, Fraction(1, 25))
    assert {name for name, _ in near.bounds.items()} == {FRICTION, SUPPLY, *NEAR}
    for name in (FRICTION, SUPPLY):
        assert near.span(name) == problem.span(name)
    for name in NEAR:
        nominal = problem.nominal(name)
        for end, whole in zip(near.span(name), problem.span(name), strict=True):
            assert end - nominal == pytest.approx(0.04 * (whole - nominal))


# --- the law that is compared with the one that runs ------------------------------------------------------------------
COMPARED = {
    "fill": "share that fills",
    "vent": "share that vents",
    "friction": "observed friction",
    "acceleration": "acceleration",
    "innovation": "innovation",
}


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("name", COMPARED)
def test_law_that_is_followed_wrongly_at_one_point_is_noticed(problem, monkeypatch, name, sign):
    """By a bit more than rounding, whichever number it is and to whichever side."""
    original = followed_law.decide

    def wrong(*given):
        found = original(*given)
        form = getattr(found, name)
        off = np.zeros(computed_law.POINTS)
        off[-1] = sign * 1e-6 * (1.0 + abs(form.center[-1])) + sign * form.radius[-1]
        return found._replace(**{name: form.line(1.0, off, 0.0)})

    monkeypatch.setattr(followed_law, "decide", wrong)
    assert f"another {COMPARED[name]} than" in computed_law.unlike(problem, problem.controller)


def test_points_that_are_compared_fill_and_vent_for_all_lengths(problem, monkeypatch):
    """With wheels of all radii, so that a law that goes wrong somewhere is seen there."""
    found, original, plants = [], followed_law.decide, []

    def decide(law, plant, state, fresh):
        plants.append(plant)
        found.append(original(law, plant, state, fresh))
        return found[-1]

    monkeypatch.setattr(followed_law, "decide", decide)
    worn = replace(problem, bounds=Bounds.of({"wheel radius": (0.51, 0.55)}))
    assert computed_law.unlike(worn, problem.controller) == ""
    for share in (found[0].fill.center, found[0].vent.center):
        assert np.count_nonzero(share > 0.999) >= 3
        assert np.count_nonzero((share > 1e-3) & (share < 0.999)) >= 8
        assert np.count_nonzero(share == 0.0) >= 8
    radii = plants[0].radius.center
    assert radii.min() < 0.52
    assert radii.max() > 0.54
