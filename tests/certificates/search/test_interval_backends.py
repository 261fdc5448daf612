"""The prover's interval arithmetic: both backends against 300-bit references, and wrong ones against the same."""

import math
import sys

import flint
import ival
import numpy as np
import pytest

from wspd_design.certificates.search import intervals, outward, tight

BACKENDS = {"tight": tight, "outward": outward}
FUNCTIONS = {
    "exp": lambda x: x.exp(),
    "log": lambda x: x.log(),
    "atan": lambda x: x.atan(),
    "sqr": lambda x: x * x,
    "sqrt": lambda x: x.sqrt(),
}
ARITHMETIC = {
    "add": (lambda a, b: a + b),
    "sub": (lambda a, b: a - b),
    "mul": (lambda a, b: a * b),
    "div": (lambda a, b: a / b),
}


def encloses_thin(function, reference, points):
    """Whether results for intervals without width contain the exact ones."""
    found = function(points)
    with flint.ctx.workprec(300):
        return all(
            flint.arb(float(low)) <= reference(flint.arb(float(point))) <= flint.arb(float(high))
            for low, high, point in zip(found.lo, found.hi, points.lo, strict=True)
        )


def encloses_random(function, reference, low, high, seed=0):
    """Whether results for wide intervals contain those of random points inside."""
    rng = np.random.default_rng(seed)
    found = function(low, high)
    point = rng.uniform(low, high)
    value = np.array([float(reference(flint.arb(float(p)))) for p in point])
    return bool(np.all((found.lo <= value) & (value <= found.hi)))


def _points(count=300):
    return np.random.default_rng(1).uniform(0.01, 5.0, count)


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("backend", BACKENDS)
def test_functions_enclose(backend, name):
    module, reference = BACKENDS[backend], FUNCTIONS[name]
    points = _points()
    assert encloses_thin(getattr(module, name), reference, module.Interval(points, points))

    def wide(low, high):
        return getattr(module, name)(module.Interval(low, high))

    assert encloses_random(wide, reference, points, points + 1.0)
    thin = getattr(module, name)(module.Interval(points, points))
    assert np.all(thin.hi - thin.lo <= 40.0 * np.spacing(np.abs(thin.hi)) + 1e-300)


@pytest.mark.parametrize("name", ARITHMETIC)
@pytest.mark.parametrize("backend", BACKENDS)
def test_arithmetic_encloses(backend, name):
    module, operation = BACKENDS[backend], ARITHMETIC[name]
    rng = np.random.default_rng(2)
    ends = np.sort(rng.uniform(-3.0, 3.0, (2, 2, 400)), axis=1)
    x, y = (module.Interval(pair[0], pair[1]) for pair in ends)
    found = operation(x, y)
    p, q = (rng.uniform(pair[0], pair[1]) for pair in ends)
    value = operation(p, q)
    assert np.all((found.lo <= value) & (value <= found.hi))
    thin = operation(module.Interval(p, p), module.Interval(q, q))
    with flint.ctx.workprec(300):
        for low, high, a, b in zip(thin.lo, thin.hi, p, q, strict=True):
            exact = operation(flint.arb(float(a)), flint.arb(float(b)))
            assert flint.arb(float(low)) <= exact <= flint.arb(float(high))


@pytest.mark.parametrize("name", ["exp", "atan"])
def test_nearest_rounding_is_seen_by_thin_intervals_only(name):
    """The planted fault: ends that are rounded to nearest, hence inwards half of the time."""
    nearest = {"exp": np.exp, "atan": np.arctan}[name]
    points = _points()

    def mutant(x):
        return outward.Interval(nearest(x.lo), nearest(x.hi))

    def wide(low, high):
        return mutant(outward.Interval(low, high))

    assert encloses_random(wide, FUNCTIONS[name], points, points + 1.0)
    assert not encloses_thin(mutant, FUNCTIONS[name], outward.Interval(points, points))


def test_outward_arithmetic_survives_the_ends_of_the_number_line():
    huge = outward.Interval(np.array([-1e308, 1.0]), np.array([1e308, math.inf]))
    zero = outward.Interval(np.array([-1.0, 0.0]), np.array([1.0, 0.0]))
    for found in (
        huge * huge,
        huge / zero,
        zero * huge,
        outward.exp(huge),
        outward.log(zero),
        outward.sqrt(zero),
    ):
        assert not np.isnan(found.lo).any()
        assert not np.isnan(found.hi).any()
        assert np.all(found.lo <= found.hi)
    assert np.all((huge / zero).lo == -math.inf)


@pytest.mark.parametrize("name", [*ARITHMETIC, *FUNCTIONS])
def test_the_short_way_into_the_library_gives_the_bits_of_the_long_one(name):
    """With signs, zeros, infinities and shapes that NumPy broadcasts."""
    ends = np.sort(np.random.default_rng(3).normal(0.0, 2.0, (2, 2, 6, 40)), axis=1)
    ends[0, 0, 0, :5], ends[0, 1, 1, :5], ends[0, :, 2, :5] = -math.inf, math.inf, 0.0
    one, other = ([module.Interval(*ends[0]), module.Interval(*ends[1, :, 0])] for module in (tight, ival))
    if name in ARITHMETIC:
        pairs = [(ARITHMETIC[name](*each), ARITHMETIC[name](*each[::-1])) for each in (one, other)]
    else:
        pairs = [(getattr(module, name)(each[0]),) for module, each in ((tight, one), (ival, other))]
    for found, wanted in zip(*pairs, strict=True):
        assert found.ends.shape == (2, 6, 40)
        assert found.lo.tobytes() == wanted.lo.tobytes()
        assert found.hi.tobytes() == wanted.hi.tobytes()


def test_fallback_where_the_wheel_is_missing(monkeypatch):
    assert intervals.default_backend() is tight
    monkeypatch.setitem(sys.modules, "ival", None)
    monkeypatch.delitem(sys.modules, tight.__name__)
    assert intervals.default_backend() is outward
