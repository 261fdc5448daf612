"""The filter on the wheels: its identities."""

import pytest
import sympy as sp

from derivations import wheel_filter
from derivations.notation import numerator

RESIDUALS = [name for name in vars(wheel_filter) if name.endswith("_residual")]


@pytest.mark.parametrize("name", RESIDUALS)
def test_every_identity_holds(name):
    assert getattr(wheel_filter, name) == 0


def test_there_are_identities():
    assert len(RESIDUALS) == 6


def test_what_does_not_vanish_has_a_numerator():
    x, y = sp.symbols("x y", positive=True)
    assert numerator(1 / (x + y) - (x - y) / (x**2 - y**2)) == 0
    assert numerator(1 / (x + y) - (x - y) / (x**2 + y**2)) == 2 * y**2
