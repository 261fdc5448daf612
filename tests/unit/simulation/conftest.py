"""Most of the time of these tests goes into compiling plants of which each is run for a moment."""

import pytest

from wspd_design.codegen import compiler


@pytest.fixture(scope="module", autouse=True)
def _compiled_quickly():
    """Compile in half the time; that this does not change a bit is seen in the tests of stops side by side."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compiler, "FLAGS", tuple("-O1" if flag == "-O3" else flag for flag in compiler.FLAGS))
        yield
