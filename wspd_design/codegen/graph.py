"""The graph of a CasADi function: its operations by name, and its value in any arithmetic."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, TypeVar

T = TypeVar("T")


@lru_cache(maxsize=1)
def operation_names() -> dict[int, str]:
    """Names of CasADi's operations by their numbers."""
    import casadi as ca

    return {getattr(ca, name): name for name in dir(ca) if name.startswith("OP_")}


def evaluate(
    function: Any,
    inputs: Sequence[Sequence[T]],
    constant: Callable[[float], T],
    applied: Callable[[str, list[T]], T],
) -> list[list[T]]:
    """Evaluate a graph in the arithmetic of its inputs.

    Parameters
    ----------
    function : casadi.Function
        Of SX, with dense inputs and outputs.
    inputs : sequence of sequence
        Elements of each input of the function.
    constant : callable
        Returns the value of a constant of the graph.
    applied : callable
        Returns the value of an operation, given by its name, from those of its arguments.

    Returns
    -------
    list of list
        Elements of each output.
    """
    names, nothing = operation_names(), constant(0.0)
    work = [nothing] * function.sz_w()
    outputs = [[nothing] * function.nnz_out(k) for k in range(function.n_out())]
    for k in range(function.n_instructions()):
        name = names[function.instruction_id(k)]
        read, written = function.instruction_input(k), function.instruction_output(k)
        if name == "OP_OUTPUT":
            outputs[written[0]][written[1]] = work[read[0]]
        elif name == "OP_INPUT":
            work[written[0]] = inputs[read[0]][read[1]]
        elif name == "OP_CONST":
            work[written[0]] = constant(function.instruction_constant(k))
        else:
            work[written[0]] = applied(name, [work[i] for i in read])
    return outputs
