"""Every operation that the emitter claims, against CasADi's own evaluation."""

from importlib.resources import files

import casadi as ca
import numpy as np
import pytest

from wspd_design.codegen import emitter
from wspd_design.codegen.compiler import load_library
from wspd_design.codegen.emitter import UntraceableError, emit

HEADER = files("wspd_design").joinpath("codegen", "templates", "elementary.h").read_text()
LANES = 64
OPERATIONS = (*emitter._BINARY, *emitter._COMPARISONS, *(set(emitter._CALLS) - {"OP_ASSIGN", "OP_CONSTPOW"}))


def compiled(function, name):
    """Compile the function with one visible entry."""
    count = function.n_in() + function.n_out()
    arguments = ", ".join(f"double *a{k}" for k in range(count))
    entry = f"void entry({arguments}) {{ {function.name()}({', '.join(f'a{k}' for k in range(count))}); }}\n"
    source = f"/* {name} */\n#define STOPS 2\n{HEADER}{emit(function, str(LANES))}{entry}"
    return load_library(source).entry


def operands(operation):
    rng = np.random.default_rng(5)
    low = 0.01 if operation in ("OP_POW", "OP_LOG", "OP_SQRT") else -3.0
    x, y = rng.uniform(low, 3.0, LANES), rng.uniform(-2.0, 2.0, LANES)
    y[::8] = x[::8]
    x[:8] = (1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0) if low < 0.0 else 1.0  # truth values
    y[:8] = (0.5, 1.0, 0.0, 1.0, -1.0, 2.0, 0.25, 3.0)
    if operation == "OP_TAN":
        x = np.clip(x, -1.2, 1.2)  # near a pole the last digit of the argument is many of the result
    if operation == "OP_ATAN2":
        x[2:4] = 1.0  # not both zero
    return x, y


def expression(operation, x, y):
    code = getattr(ca, operation)
    return ca.SX.binary(code, x, y) if operation in BINARY else ca.SX.unary(code, x)


BINARY = {
    *emitter._BINARY,
    *emitter._COMPARISONS,
    *("OP_POW", "OP_ATAN2", "OP_FMIN", "OP_FMAX", "OP_IF_ELSE_ZERO"),
}


@pytest.mark.parametrize("operation", sorted(OPERATIONS))
def test_operation(call_lanes, operation):
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    function = ca.Function("f", [x, y], [expression(operation, x, y)])
    identifiers = {function.instruction_id(k) for k in range(function.n_instructions())}
    assert getattr(ca, operation) in identifiers  # CasADi has not replaced it by something else
    a, b = operands(operation)
    (got,) = call_lanes(compiled(function, operation), [a, b], [1])
    expected = np.array(function.map(LANES)(a[None, :], b[None, :])).ravel()
    np.testing.assert_allclose(got[0], expected, rtol=4e-15, atol=0.0)


def test_powers_with_a_constant_exponent(call_lanes):
    x = ca.SX.sym("x")
    function = ca.Function("f", [x], [ca.vertcat(x ** (2.0 / 3.0), x**3, x**-2, x**0.5)])
    a = np.linspace(0.1, 9.0, LANES)
    (got,) = call_lanes(compiled(function, "powers"), [a], [4])
    np.testing.assert_allclose(got, [a ** (2 / 3), a**3, a**-2, a**0.5], rtol=4e-15)


def test_vectors_stand_lane_by_lane(call_lanes):
    x, y = ca.SX.sym("x", 3), ca.SX.sym("y", 2)
    function = ca.Function("f", [x, y], [ca.vertcat(x[2] - y[0], 7.5), x[0] * y[1]])
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(3, LANES)), rng.normal(size=(2, LANES))
    first, second = call_lanes(compiled(function, "vectors"), [a, b], [2, 1])
    np.testing.assert_array_equal(first, [a[2] - b[0], np.full(LANES, 7.5)])
    np.testing.assert_array_equal(second[0], a[0] * b[1])


@pytest.mark.parametrize("value", [0.1, 5e-324, 1e308, np.inf, -np.inf, np.nan])
def test_constants_are_exact(call_lanes, value):
    x = ca.SX.sym("x")
    function = ca.Function("f", [x], [ca.vertcat(ca.SX(value), x)])
    (got,) = call_lanes(compiled(function, f"constant {value}"), [np.zeros(LANES)], [2])
    np.testing.assert_array_equal(got[0], np.full(LANES, value))


@pytest.mark.parametrize("unsupported", [ca.tanh, ca.erf, ca.floor, ca.acos])
def test_an_operation_without_a_translation_is_refused(unsupported):
    x = ca.SX.sym("x")
    function = ca.Function("step_kernel", [x], [unsupported(x)])
    operation = {ca.tanh: "OP_TANH", ca.erf: "OP_ERF", ca.floor: "OP_FLOOR", ca.acos: "OP_ACOS"}[unsupported]
    with pytest.raises(UntraceableError, match=f"step_kernel.* uses the operation {operation}, which has no"):
        emit(function, "4")


def test_a_wrong_translation_is_seen(call_lanes, monkeypatch):
    # The planted fault: the minimum in place of the maximum.
    monkeypatch.setitem(emitter._CALLS, "OP_FMAX", emitter._CALLS["OP_FMIN"])
    with pytest.raises(AssertionError):
        test_operation(call_lanes, "OP_FMAX")
