"""Boxes of states: nothing is lost as they are divided into slices and put together again."""

import numpy as np
import pytest

from wspd_design.certificates.kernel.interval import Interval
from wspd_design.certificates.theorems.from_rolling import boxes as module
from wspd_design.certificates.theorems.from_rolling.boxes import (
    LEAST,
    NEAR,
    SLICE,
    STATES,
    WAYS,
    Boxes,
    joined,
    sliced,
    together,
)


def made(seed, count=40):
    """Random boxes, some of them with ends at edges of slices, or far away."""
    random = np.random.default_rng(seed)
    states = {}
    for name in STATES:
        low = random.uniform(0.0, 0.1, count) if name == "y" else random.uniform(-0.05, 0.05, count)
        states[name] = Interval(low, low + random.exponential(0.02, count))
    states["way"].low[:3], states["way"].high[2:5] = -0.5, 0.5
    for name, k, low, high in (
        ("way", 6, 0.0, 0.03),
        ("y", 7, 0.01, 0.0301),
        ("y", 8, 0.055, 0.2),
        ("y", 9, 0.02, 0.02),
        ("way", 10, -np.inf, np.inf),
        ("way", 11, 0.1, 0.1),
    ):
        states[name].low[k], states[name].high[k] = low, high
    slow = random.uniform(25.0, 33.0, count)
    speed = Interval(slow, slow + random.exponential(0.1, count))
    return Boxes.of(random.integers(0, 3, count), states, speed, random.uniform(0.05, 0.9, count))


def draw(some, random):
    """A state in each of some boxes, many of them at an end, with its speed and supply."""

    def between(low, high):
        low, high = np.maximum(low, -1e3), np.minimum(high, 1e3)
        share = random.random(some.cell.size)
        share = np.where(random.random(share.size) < 0.3, np.round(share), share)
        return np.clip(low + share * (high - low), low, high)

    found = {name: between(each.low, each.high) for name, each in some.states.items()}
    return found | {"speed": between(some.speed.low, some.speed.high), "supply": some.supply}


def held_by(some, cell, state):
    """Tell in which of some boxes a state is."""
    inside = (some.cell == cell) & (some.speed.low <= state["speed"]) & (state["speed"] <= some.speed.high)
    inside &= some.supply <= state["supply"]
    for name, each in some.states.items():
        inside &= (each.low <= state[name]) & (state[name] <= each.high)
    return inside


def each_drawn(some, random, times):
    """Number and state of all boxes, some times."""
    for _ in range(times):
        drawn = draw(some, random)
        for k in range(some.cell.size):
            yield k, {name: each[k] for name, each in drawn.items()}


def covers(outer, inner):
    """Tell which of some boxes hold each of others whole: a row for each of the others."""
    within = (outer.values[None] >= inner.values[:, None]).all(axis=2)
    return within & (outer.cell[None] == inner.cell[:, None])


def test_boxes_have_the_ends_that_they_are_made_of():
    random = np.random.default_rng(8)
    low, width = random.normal(size=(2, len(STATES) + 1, 5))
    ends = [Interval(*each) for each in zip(low, low + np.abs(width), strict=True)]
    states, speed, supply = dict(zip(STATES, ends[:-1], strict=True)), ends[-1], random.random(5)
    some = Boxes.of(np.arange(5), states, speed, supply)
    assert list(some.states) == list(STATES)
    for found, each in [*((some.states[name], states[name]) for name in STATES), (some.speed, speed)]:
        np.testing.assert_array_equal(found.low, each.low)
        np.testing.assert_array_equal(found.high, each.high)
    np.testing.assert_array_equal(some.supply, supply)
    kept = some.kept(np.array([3, 1]))
    assert kept.cell.tolist() == [3, 1]
    np.testing.assert_array_equal(kept.supply, supply[[3, 1]])
    np.testing.assert_array_equal(some.kept(supply > 0.5).cell, np.flatnonzero(supply > 0.5))


def test_nothing_of_a_box_is_lost_as_it_is_divided():
    whole = made(1)
    parts, origin = sliced(whole)
    assert parts.cell.size > 2 * whole.cell.size
    for k, state in each_drawn(whole, np.random.default_rng(2), 30):
        # In a part that is said to come from it.
        assert (held_by(parts, whole.cell[k], state) & (origin == k)).any(), k
    np.testing.assert_array_equal(parts.cell, whole.cell[origin])
    np.testing.assert_array_equal(np.unique(origin), np.arange(whole.cell.size))


def test_parts_are_no_wider_than_slices_and_go_beyond_no_box():
    whole = made(1)
    parts, origin = sliced(whole)
    y, way = parts.states["y"], parts.states["way"]
    assert (y.high - y.low).max() <= SLICE * (1 + 1e-9)
    assert (np.floor(y.low / SLICE + 1e-9) >= np.ceil(y.high / SLICE - 1e-9) - 1).all()
    middle = np.searchsorted(WAYS, way.low, side="right") - 1
    assert (way.high <= WAYS[np.minimum(middle + 1, WAYS.size - 1)]).all()
    assert (parts.values <= whole.values[origin]).all()
    others = [k for k in range(whole.values.shape[1]) if k // 2 not in (module.Y, module.WAY)]
    np.testing.assert_array_equal(parts.values[:, others], whole.values[origin][:, others])


def test_a_box_within_a_slice_stays_as_it_is():
    whole = made(1)
    states = whole.states
    states["y"] = Interval(0.032 + 0.0 * whole.supply, 0.038 + 0.0 * whole.supply)
    states["way"] = Interval(0.001 + 0.0 * whole.supply, 0.004 + 0.0 * whole.supply)
    narrow = Boxes.of(whole.cell, states, whole.speed, whole.supply)
    parts, origin = sliced(narrow)
    np.testing.assert_array_equal(origin, np.arange(whole.cell.size))
    np.testing.assert_array_equal(parts.values, narrow.values)


def test_of_no_boxes_nothing_is_made():
    none = together([])
    assert none.cell.size == 0
    assert none.values.shape == made(1, 12).values[:0].shape
    parts, origin = sliced(none)
    assert parts.cell.size == origin.size == 0
    again, (nearest, farthest) = joined(none, none.cell, none.cell)
    assert again.cell.size == nearest.size == farthest.size == 0


def test_nothing_of_boxes_is_lost_as_they_are_put_together():
    chunks = [sliced(made(seed))[0] for seed in (5, 6, 7)]
    whole = together(chunks)
    assert whole.cell.size < sum(each.cell.size for each in chunks)
    for chunk in chunks:
        assert covers(whole, chunk).any(axis=1).all()
        for k, state in each_drawn(chunk, np.random.default_rng(4), 3):
            assert held_by(whole, chunk.cell[k], state).any()


def many(seed, count=300):
    """Parts of boxes, with the rows that each comes to."""
    random = np.random.default_rng(seed)
    parts, origin = sliced(made(seed, count))
    nearest = random.integers(0, 12, count)
    farthest = nearest + random.integers(0, 5, count)
    return parts, nearest[origin], farthest[origin]


@pytest.mark.parametrize("seed", [11, 12])
def test_each_piece_is_in_a_box_that_comes_to_its_rows(seed):
    parts, nearest, farthest = many(seed)
    found, (first, last) = joined(parts, nearest, farthest)
    assert found.cell.size < 0.7 * parts.cell.size
    rows = (first[None] <= nearest[:, None]) & (last[None] >= farthest[:, None])
    assert (covers(found, parts) & rows).any(axis=1).all()


@pytest.mark.parametrize("seed", [11, 12])
def test_boxes_that_are_put_together_are_no_larger_than_what_they_are_made_of(seed):
    """Each of their ends is one of a piece, and their first rows are near each other."""
    parts, nearest, farthest = many(seed)
    found, (first, last) = joined(parts, nearest, farthest)
    inside = covers(found, parts)
    for k in range(found.cell.size):
        some = inside[:, k] & (nearest // NEAR == first[k] // NEAR)
        np.testing.assert_array_equal(parts.values[some].max(axis=0), found.values[k])
        assert nearest[some].min() == first[k]
        assert (last[k] == farthest[some]).any()
    assert (found.states["y"].high - found.states["y"].low).max() <= SLICE * (1 + 1e-9)


@pytest.mark.parametrize("end", range(2 * len(STATES) + 3))
def test_a_piece_that_is_forgotten_or_cut_is_seen(end):
    """What looks for pieces would see an end that is too narrow, and a last row that is forgotten."""
    parts, nearest, farthest = many(11)
    found, (first, last) = joined(parts, nearest, farthest)
    cut = Boxes(found.cell, found.values.copy())
    finite = np.flatnonzero(np.isfinite(cut.values[:, end]))
    cut.values[finite[0], end] -= 1e-9
    assert not covers(cut, parts).any(axis=1).all()
    rows = (first[None] <= nearest[:, None]) & (last[None] - 1 >= farthest[:, None])
    assert not (covers(found, parts) & rows).any(axis=1).all()


def test_boxes_of_different_cells_slices_and_rows_stay_apart():
    """Put together are only those of one cell, and of one slice of y and of the way, that come to about one row."""
    one = np.array([0.0])

    def box(cell, y, way):
        states = {name: Interval(one, one) for name in STATES}
        states["y"], states["way"] = Interval(one + y, one + y), Interval(one + way, one + way)
        return Boxes.of(np.array([cell]), states, Interval(one + 30.0 + y, one + 31.0 + y), one + 0.25 + y)

    chunks = [
        box(0, 0.005, 0.001),
        box(0, 0.006, 0.002),
        box(0, 0.015, 0.001),
        box(0, 0.005, 0.007),
        box(1, 0.005, 0.001),
    ]
    found = together(chunks)
    assert found.cell.tolist() == [0, 0, 0, 1]
    assert found.speed.low.min() == 30.005
    assert found.speed.high[0] == 31.006
    assert found.supply.min() == 0.255
    alike = Boxes(*(np.concatenate(each) for each in zip(*[chunks[0]] * 4, strict=True)))
    near = np.array([NEAR, NEAR + 1, 2 * NEAR, 0])
    found, (nearest, farthest) = joined(alike, near, near + 2)
    assert sorted(zip(nearest.tolist(), farthest.tolist(), strict=True)) == [
        (0, 2),
        (NEAR, NEAR + 3),
        (2 * NEAR, 2 * NEAR + 2),
    ]


def test_slices_begin_where_y_may_not_be():
    """Wheels with a smaller y are lost before boxes are divided."""
    assert LEAST == 0.0
    assert (np.diff(WAYS) > 0.0).all()
    assert np.isneginf(WAYS[0])
    assert np.isposinf(WAYS[-1])
