"""The filter on the wheels: its identities."""

import pytest

from derivations import wheel_filter

RESIDUALS = [name for name in vars(wheel_filter) if name.endswith("_residual")]


@pytest.mark.parametrize("name", RESIDUALS)
def test_every_identity_holds(name):
    assert getattr(wheel_filter, name) == 0


def test_there_are_identities():
    assert len(RESIDUALS) == 6
