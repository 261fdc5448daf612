"""The sampled loop of the mended adaptive fuzzy law: identities, and the map against the law that runs."""

import math

import numpy as np
import pytest

from tests.lazily import residuals
from wspd_design.controllers.adaptive_fuzzy import firing_strengths
from wspd_design.model.generated import fuzzy_loop as generated


def test_every_identity_holds():
    assert residuals("fuzzy_loop")
    assert {name for name, left in residuals("fuzzy_loop").items() if left != 0} == set()


class Memberships:
    centres = (-2.0, -1.0, 0.0, 1.0, 2.0)
    widths = (0.6,) * 5


@pytest.mark.parametrize(("own", "other"), [(0.0, 1.0), (-1.0, 0.0), (-1.0, 2.0), (-2.0, -1.0)])
def test_bound_of_a_drive_holds_on_a_grid_and_is_near_where_the_other_rule_is_next(own, other):
    layer, leakage = 1.0, 0.4
    surfaces = np.linspace(layer, 6.0, 2001)
    place = Memberships.centres.index(own)
    drives = [
        (sigma - layer) * firing_strengths(Memberships, float(sigma))[place] / leakage for sigma in surfaces
    ]
    bound = generated.largest_drive(own, other, Memberships.widths[0], layer, leakage)
    assert max(drives) <= bound
    if (own, other) == (0.0, 1.0):
        assert bound < 1.5 * max(drives)


def test_surface_is_that_of_the_map():
    numbers = (0.3, 0.25, 0.7)
    new, rate, h = 0.4, 8.0, 0.02
    _, _, filtered, moved = generated.next_sample(*numbers, 0.0, 1.0, 0.0, 2.0, new, rate, h)
    surface = generated.surface(*numbers, new, rate, h)
    assert surface == pytest.approx(filtered + rate * numbers[0])
    assert moved == pytest.approx(2.0 * surface)
    assert filtered == pytest.approx(0.7 + new * (0.05 / h - 0.7))
    assert math.isclose(generated.next_sample(1.0, 0.0, 0.0, 0.0, 0.9, 0.1, 0.0, new, rate, h)[0], 0.9)
