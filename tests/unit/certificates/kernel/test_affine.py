"""Affine forms enclose what they stand for."""

import numpy as np
import pytest

from wspd_design.certificates.kernel.affine import Affine, constant

BOXES, SYMBOLS, DRAWS = 40, 3, 60


def forms(random, low, high):
    """Forms with ranges between two numbers."""
    span = high - low
    center = random.uniform(low + 0.3 * span, high - 0.3 * span, BOXES)
    slopes = random.uniform(-0.06, 0.06, (BOXES, SYMBOLS)) * span
    return Affine(center, slopes, random.uniform(0.0, 0.05, BOXES) * span)


def values(form, symbols, own):
    """Numbers that a form stands for."""
    return form.center + form.slopes @ symbols + own * form.error


OPERATIONS = {
    "sum": (lambda a, b: a + b, lambda x, y: x + y),
    "difference": (lambda a, b: a - b, lambda x, y: x - y),
    "product": (lambda a, b: a * b, lambda x, y: x * y),
    "quotient": (lambda a, b: a / b, lambda x, y: x / y),
    "square": (lambda a, _: a**2, lambda x, _: x**2),
    "exp": (lambda a, _: a.exp(), lambda x, _: np.exp(x)),
    "atan": (lambda a, _: (a - 2.0).atan(), lambda x, _: np.arctan(x - 2.0)),
    "power": (lambda a, _: a.power(-1.0 / 3.0), lambda x, _: x ** (-1.0 / 3.0)),
    "positive part": (lambda a, _: (a - 2.0).positive_part(), lambda x, _: np.maximum(x - 2.0, 0.0)),
    "smaller": (lambda a, b: a.at_most(b), np.minimum),
    "larger": (lambda a, b: a.at_least(b), np.maximum),
    "widened": (lambda a, _: a.widened(0.1, 0.3), lambda x, _: x + 0.3),
    "line": (lambda a, _: a.line(-2.0, 1.0, 0.0), lambda x, _: 1.0 - 2.0 * x),
}


@pytest.mark.parametrize("name", OPERATIONS)
def test_operation_encloses_its_values_with_their_symbols(name):
    of_forms, of_numbers = OPERATIONS[name]
    random = np.random.default_rng(3)
    one, other = forms(random, 0.5, 3.5), forms(random, 0.5, 3.5)
    found = of_forms(one, other)
    for _ in range(DRAWS):
        symbols = random.choice([-1.0, 1.0, 0.3], SYMBOLS)
        first, second = (values(each, symbols, random.choice([-1.0, 1.0, 0.0])) for each in (one, other))
        wanted = of_numbers(first, second)
        shared = found.center + found.slopes @ symbols  # what the symbols say; the rest is error
        assert np.all(np.abs(wanted - shared) <= found.error * (1.0 + 1e-12))
        assert np.all((found.low <= wanted) & (wanted <= found.high))


def test_what_two_forms_share_cancels():
    form = forms(np.random.default_rng(1), 1.0, 2.0).named(0)
    assert np.all((form - form).radius < 1e-11)
    assert np.all(form.at_most(0.5).radius < 1e-11)  # exactly the limit


def test_range_with_zero_has_no_reciprocal():
    form = constant(0.0, forms(np.random.default_rng(1), 1.0, 2.0)).widened(0.1, 0.1)
    with np.errstate(all="ignore"):
        assert np.all(np.isinf(form.inverse().error))


def test_secant_needs_its_error():
    """On a wide range the exponential is away from its secant."""
    form = constant(0.0, forms(np.random.default_rng(1), 1.0, 2.0)).widened(1.0, 1.0)
    found = form.exp()
    assert np.all(found.error > 0.2)
    assert np.all((found.low <= np.exp(-1.0)) & (np.exp(1.0) <= found.high))
