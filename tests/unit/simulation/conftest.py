"""Most of the time of these tests goes into compiling plants of which each is run for a moment."""

import pytest


@pytest.fixture(scope="module", autouse=True)
def _quickly(compiled_quickly):
    pass
