"""The filter on the wheels: its identities."""

import sympy as sp

from derivations.notation import numerator
from tests.lazily import residuals


def test_every_identity_holds():
    assert residuals("wheel_filter")
    assert {name for name, left in residuals("wheel_filter").items() if left != 0} == set()


def test_there_are_identities():
    assert len(residuals("wheel_filter")) == 6


def test_what_does_not_vanish_has_a_numerator():
    x, y = sp.symbols("x y", positive=True)
    assert numerator(1 / (x + y) - (x - y) / (x**2 - y**2)) == 0
    assert numerator(1 / (x + y) - (x - y) / (x**2 + y**2)) == 2 * y**2
