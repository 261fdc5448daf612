"""A cache of compiled code of its own for every test that asks for it, and small C libraries."""

import ctypes

import numpy as np
import pytest

from wspd_design.codegen import compiler

DOUBLES = ctypes.POINTER(ctypes.c_double)


def pointer(array):
    return array.ctypes.data_as(DOUBLES)


@pytest.fixture
def cache(tmp_path, tmp_path_factory, monkeypatch):
    """An empty cache folder; what was found about the machine is forgotten before and after."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    # Where ziglang is the compiler, what it makes at its first use, some seconds long, stays.
    monkeypatch.setenv("ZIG_GLOBAL_CACHE_DIR", str(tmp_path_factory.getbasetemp() / "zig"))
    compiler.find_compiler.cache_clear()
    yield tmp_path / "cache" / "wspd_design"
    compiler.find_compiler.cache_clear()


@pytest.fixture(scope="session")
def call_lanes():
    """Call a C function of vectors over lanes: inputs (elements, lanes) -> outputs of the given lengths."""

    def call(function, inputs, output_sizes):
        arrays = [np.ascontiguousarray(x, dtype=np.float64) for x in inputs]
        lanes = arrays[0].shape[-1]
        outputs = [np.full((size, lanes), np.nan) for size in output_sizes]
        function(*(pointer(x) for x in (*arrays, *outputs)))
        return outputs

    return call
