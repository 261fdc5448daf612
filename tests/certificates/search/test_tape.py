"""The expression on boxes: it contains every sample, smaller boxes are never worse, and units do not matter."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wspd_design.certificates.kernel.checker import Work, value
from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.certificates.search import outward, tight
from wspd_design.certificates.search.tape import trace
from wspd_design.model.number import atan, exp
from wspd_design.parameters.loading import load_rail, load_vehicle


def _expression(x):
    """Every operation that the tape knows and the checker shares."""
    s, v = x["s"], x["v"]
    friction = 0.4 + 0.6 * exp(-0.6 * s * v)
    gradient = 50.0 * s / (friction * v)
    force = friction * (gradient / (1.0 + gradient**2) + atan(gradient))
    return abs(force - 0.3) - s**3 / v + (v / 3.0) ** (2.0 / 3.0) - 1.0 / (v + s + s)


CLAIM = Claim(
    name="sample",
    variables=(variable("s", (0.02, 0.6), "-"), variable("v", (2.0, 30.0), "m/s")),
    expression=_expression,
    relation="<=",
    bound=Fraction(10),
    unit="-",
)
STATEMENT = CLAIM.statement()
TAPES = {module.__name__: trace(CLAIM, module) for module in (tight, outward)}
unit = st.floats(0.0, 1.0)
boxes = st.tuples(st.tuples(unit, unit), st.tuples(unit, unit))


def _arrays(box):
    ends = np.array([sorted(pair) for pair in box])
    return ends[:, :1], ends[:, 1:]


def _exact(place):
    point = {
        v.name: v.low + (v.high - v.low) * Fraction(float(t)) for v, t in zip(CLAIM.free, place, strict=True)
    }
    return value(STATEMENT, point, Work())


@pytest.mark.parametrize("name", TAPES)
@given(box=boxes, shares=st.tuples(unit, unit))
@settings(max_examples=60, deadline=None)
def test_enclosure_contains_every_sample(name, box, shares):
    low, high = _arrays(box)
    found = TAPES[name].evaluate(low, high)
    place = np.clip(low[:, 0] + np.array(shares) * (high - low)[:, 0], low[:, 0], high[:, 0])
    exact = _exact(place)
    assert Fraction(float(found.value.lo[0])) <= exact[1]
    assert exact[0] <= Fraction(float(found.value.hi[0]))


@pytest.mark.parametrize("name", TAPES)
def test_samples_in_doubles_are_the_function(name):
    points = np.random.default_rng(0).uniform(0.0, 1.0, (2, 50))
    found, enclosed = TAPES[name].sample(points), TAPES[name].evaluate(points, points).value
    slack = 1e-12 * (1.0 + np.abs(found))
    assert np.all((enclosed.lo - slack <= found) & (found <= enclosed.hi + slack))
    assert np.all(enclosed.hi - enclosed.lo < 1e-11)


@pytest.mark.parametrize("name", TAPES)
@given(box=boxes, shares=st.tuples(unit, unit))
@settings(max_examples=30, deadline=None)
def test_slopes_contain_every_difference_quotient(name, box, shares):
    """By the mean value theorem, f(q) - f(p) along one variable is a slope of the box times the distance."""
    low, high = _arrays(box)
    found = TAPES[name].evaluate(low, high)
    place = np.clip(low[:, 0] + np.array(shares) * (high - low)[:, 0], low[:, 0], high[:, 0])
    for row in range(2):
        p, q = place.copy(), place.copy()
        p[row], q[row] = low[row, 0], high[row, 0]
        if q[row] - p[row] < 1e-3:
            continue
        quotient = float(_exact(q)[0] - _exact(p)[0]) / (q[row] - p[row])
        slack = 1e-9 * (1.0 + abs(quotient))
        assert found.gradient.lo[row, 0] - slack <= quotient <= found.gradient.hi[row, 0] + slack


@given(box=boxes, axis=st.integers(0, 1))
@settings(max_examples=60, deadline=None)
def test_halves_are_never_worse(box, axis):
    low, high = _arrays(box)
    whole = TAPES[tight.__name__].evaluate(low, high)
    middle = 0.5 * (low[axis] + high[axis])
    for side in (0, 1):
        part = [low.copy(), high.copy()]
        part[1 - side][axis] = middle
        half = TAPES[tight.__name__].evaluate(*part)
        assert half.value.lo[0] >= whole.value.lo[0]
        assert half.value.hi[0] <= whole.value.hi[0]
        assert np.all(half.gradient.lo >= whole.gradient.lo)
        assert np.all(half.gradient.hi <= whole.gradient.hi)


@given(power=st.integers(-12, 12), bound=st.sampled_from([3.0, 5.0, 5.5, 8.0]))
@settings(max_examples=8, deadline=None)
def test_scaling_of_a_variable_does_not_change_the_verdict(settled, power, bound):
    scale = 2.0**power
    (slip, speed), asked = CLAIM.variables, replace(CLAIM, bound=Fraction(bound))
    scaled = replace(
        asked,
        variables=(replace(slip, low=slip.low * Fraction(scale), high=slip.high * Fraction(scale)), speed),
        expression=lambda x: _expression({"s": x["s"] / scale, "v": x["v"]}),
    )
    one, other = (settled(claim, tolerance=1e-2) for claim in (asked, scaled))
    assert one.status is other.status
    assert one.low == pytest.approx(other.low, abs=2e-2)


@pytest.mark.parametrize(("offset", "slopes"), [(1.0, (1.0, 1.0)), (-1.0, (-1.0, -1.0)), (-0.3, (-1.0, 1.0))])
def test_magnitude_has_the_slopes_of_its_sign(offset, slopes):
    claim = replace(CLAIM, expression=lambda x: abs(x["s"] + offset))
    found = trace(claim, tight).evaluate(np.array([[0.0], [0.0]]), np.array([[1.0], [1.0]]))
    (slip,) = (v for v in claim.free if v.name == "s")
    width = float(slip.high - slip.low)
    assert found.gradient.lo[0, 0] == pytest.approx(slopes[0] * width)
    assert found.gradient.hi[0, 0] == pytest.approx(slopes[1] * width)
    ends = [abs(float(end) + offset) for end in (slip.low, slip.high)]
    assert found.value.hi[0] == pytest.approx(max(ends))
    assert found.value.lo[0] == pytest.approx(0.0 if slopes[0] != slopes[1] else min(ends))


def test_operation_without_interval_form_is_refused():
    from wspd_design.model.number import sin

    with pytest.raises(ValueError, match="OP_SIN has no interval form"):
        trace(replace(CLAIM, expression=lambda x: sin(x["s"])), tight)


def test_known_parts_are_done_once():
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-dry")
    known = (variable("m", vehicle.mass, "kg"), variable("mu0", rail.mu0, "-"))
    claim = replace(
        CLAIM,
        variables=CLAIM.variables + known,
        expression=lambda x: exp(-x["mu0"]) * x["m"] * x["s"] * x["v"],
    )
    operations = [instruction.operation for instruction in trace(claim, tight).instructions]
    assert "OP_EXP" not in operations
    assert operations.count("OP_MUL") == 2
