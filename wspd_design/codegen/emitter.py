"""From a CasADi SX function to C: one loop over lanes, in which every operation is one line.

A lane is a wheelset or a stop. Every element of an input or output is an array over lanes, so that the compiler
turns the loop into vector instructions.
"""

import math
from typing import Any

from wspd_design.codegen.graph import operation_names
from wspd_design.parameters.errors import WspdError

_BINARY = {"OP_ADD": "+", "OP_SUB": "-", "OP_MUL": "*", "OP_DIV": "/"}
_COMPARISONS = {"OP_LT": "<", "OP_LE": "<=", "OP_EQ": "==", "OP_NE": "!=", "OP_AND": "&&", "OP_OR": "||"}
_CALLS = {
    "OP_EXP": "wspd_exp({0})",
    "OP_LOG": "wspd_log({0})",
    "OP_ATAN": "wspd_atan2({0}, 1.0)",
    "OP_ATAN2": "wspd_atan2({0}, {1})",
    "OP_SIN": "wspd_sin({0})",
    "OP_COS": "wspd_cos({0})",
    "OP_TAN": "(wspd_sin({0}) / wspd_sin({0} + 0x1.921fb54442d18p0))",
    "OP_POW": "wspd_exp({1} * wspd_log({0}))",
    "OP_CONSTPOW": "wspd_exp({1} * wspd_log({0}))",
    "OP_SQRT": "sqrt({0})",
    "OP_FABS": "fabs({0})",
    "OP_FMIN": "({0} < {1} ? {0} : {1})",
    "OP_FMAX": "({0} > {1} ? {0} : {1})",
    "OP_IF_ELSE_ZERO": "({0} != 0.0 ? {1} : 0.0)",
    "OP_NOT": "({0} == 0.0 ? 1.0 : 0.0)",
    "OP_SIGN": "({0} > 0.0 ? 1.0 : ({0} < 0.0 ? -1.0 : 0.0))",
    "OP_NEG": "-{0}",
    "OP_SQ": "{0} * {0}",
    "OP_TWICE": "{0} + {0}",
    "OP_INV": "1.0 / {0}",
    "OP_ASSIGN": "{0}",
}


class UntraceableError(WspdError, ValueError):
    """An operation that the emitter has no C for."""


def emit(function: Any, lanes: str, *, shared: int | None = None) -> str:
    """Return the C text of a CasADi SX function.

    Parameters
    ----------
    function : casadi.Function
        Of dense vectors of SX.
    lanes : str
        C expression of the number of lanes.
    shared : int, optional
        The input that is the same for all lanes: element ``k`` stands at ``k``.

    Returns
    -------
    str
        A static function with one pointer per input and output; element ``k`` of lane ``l`` stands at
        ``k * lanes + l``.

    Raises
    ------
    UntraceableError
        If the function contains an operation without a translation.
    """
    names = operation_names()
    lines = []
    for k in range(function.n_instructions()):
        operation = names[function.instruction_id(k)]
        inputs, outputs = function.instruction_input(k), function.instruction_output(k)
        if operation == "OP_OUTPUT":
            lines.append(f"o{outputs[0]}[{outputs[1]} * {lanes} + l] = w{inputs[0]};")
            continue
        lines.append(f"w{outputs[0]} = {_right_side(function, k, operation, inputs, lanes, shared)};")
    arguments = [f"const double *restrict i{k}" for k in range(function.n_in())]
    arguments += [f"double *restrict o{k}" for k in range(function.n_out())]
    work = ", ".join(f"w{k}" for k in range(function.sz_w()))
    body = "\n        ".join((f"double {work};", *lines)) if work else "\n        ".join(lines)
    return (
        f"static void {function.name()}({', '.join(arguments)})\n{{\n"
        f"    #pragma omp simd\n    for (int l = 0; l < {lanes}; l++) {{\n        {body}\n    }}\n}}\n"
    )


def _right_side(
    function: Any, k: int, operation: str, inputs: list[int], lanes: str, shared: int | None
) -> str:
    if operation == "OP_INPUT":
        if inputs[0] == shared:
            return f"i{shared}[{inputs[1]}]"
        return f"i{inputs[0]}[{inputs[1]} * {lanes} + l]"
    if operation == "OP_CONST":
        return _constant(function.instruction_constant(k))
    operands = [f"w{i}" for i in inputs]
    if operation in _BINARY:
        return f"{operands[0]} {_BINARY[operation]} {operands[1]}"
    if operation in _COMPARISONS:
        return f"({operands[0]} {_COMPARISONS[operation]} {operands[1]} ? 1.0 : 0.0)"
    if operation in _CALLS:
        return _CALLS[operation].format(*operands)
    raise UntraceableError(f"{function.name()} uses the operation {operation}, which has no translation to C")


def _constant(value: float) -> str:
    """C literal of a double, exact."""
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0.0 else "-INFINITY"
    return float(value).hex()
