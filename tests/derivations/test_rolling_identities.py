"""One sample of the way in, and its bounds: every identity holds, and with a wrong form it would not."""

import pytest

from tests.lazily import Lazily, residuals

rolling_sample = Lazily("rolling_sample")
MODULES = {"rolling_sample": 23, "rolling_bounds": 49, "rolling_instants": 8}
TWICE = 3  # identities that two theorems use


@pytest.mark.parametrize("module", MODULES)
def test_every_identity_holds(module):
    assert {name for name, left in residuals(module).items() if left != 0} == set()
    assert len(residuals(module)) == MODULES[module]


def test_every_identity_is_in_a_theorem():
    from derivations import rolling_theorems

    told = [each.text for theorem in rolling_theorems.THEOREMS for each in theorem.identities]
    assert len(told) == sum(MODULES.values()) + TWICE


@pytest.mark.parametrize("place", range(5))
def test_a_form_with_a_wrong_sign_leaves_something(place):
    """Of y, z, p, e and x of the next sample, with what the filter or the observer learns turned round."""
    from derivations.rolling_sample import _left as left_over
    from derivations.rolling_sample import _then as then

    right = [
        rolling_sample.fall_next,
        rolling_sample.observed_next,
        rolling_sample.error_next,
        rolling_sample.lag_next,
        rolling_sample.way_next,
    ][place]
    turned = [
        rolling_sample.drag_change,
        rolling_sample.apart,
        rolling_sample.z,
        rolling_sample.friction_change,
        rolling_sample.e,
    ][place]
    assert left_over(right, then[place]) == 0
    assert left_over(right.subs(turned, -turned), then[place]) != 0
