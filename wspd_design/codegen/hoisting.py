"""Hoist loop-invariant work out of kernels and avoid divisions.

A kernel is called four times per step for every wheelset, its parameters never change: sums and products of
parameters are computed once, and a division by one of them becomes a product with its reciprocal. A division
costs as much as ten products, and the creep force is a chain of them: fractions are carried on as numerator and
denominator until their value is needed.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple


def hoist(functions: Sequence[Any], fixed: int, name: str) -> tuple[Any, list[Any]]:
    """Split SX functions into what depends on their first inputs alone, and the rest.

    Parameters
    ----------
    functions : sequence of casadi.Function
        Of dense vectors of SX; all have the same first inputs. Where they take the inverse tangent of a
        fraction, its denominator must be positive.
    fixed : int
        Number of the first inputs that stay the same over many calls.
    name : str
        Name of the first function that is returned.

    Returns
    -------
    constants : casadi.Function
        (fixed inputs) -> vector of constants.
    kernels : list of casadi.Function
        (constants, further inputs) -> outputs, under their own names.
    """
    import casadi as ca

    shared = [ca.SX.sym(f"fixed{k}", functions[0].size1_in(k)) for k in range(fixed)]
    store: dict[int, tuple[Any, Any]] = {}  # by the expression of a constant: itself, its symbol
    split = []
    for function in functions:
        moving = [ca.SX.sym(f"x{k}", function.size1_in(k)) for k in range(fixed, function.n_in())]
        outputs = _Rebuilding(ca, store).outputs(function, shared + moving, fixed)
        split.append((function.name(), moving, outputs))
    constants = ca.vertcat(*(expression for expression, _ in store.values()))
    symbols = ca.vertcat(*(symbol for _, symbol in store.values()))
    kernels = [ca.Function(label, [symbols, *moving], outputs) for label, moving, outputs in split]
    return ca.Function(name, shared, [constants]), kernels


class _Term(NamedTuple):
    """An intermediate result."""

    value: Any
    fixed: bool
    fraction: "tuple[Any, Any] | None" = None  # numerator and denominator, where the value is their quotient
    root: Any = None  # square root of the denominator, where that is known


def _quotient(numerator: Any, denominator: Any, root: Any = None) -> _Term:
    return _Term(numerator / denominator, False, (numerator, denominator), root)


class _Rebuilding:
    """Walks the instructions of a function and builds the same outputs in another way."""

    def __init__(self, ca: Any, store: dict[int, tuple[Any, Any]]) -> None:
        self.ca, self.store = ca, store

    def outputs(self, function: Any, inputs: list[Any], fixed: int) -> list[Any]:
        ca = self.ca
        outputs = [ca.SX.zeros(function.size1_out(k)) for k in range(function.n_out())]
        work = [_Term(ca.SX(0), True)] * function.sz_w()
        for k in range(function.n_instructions()):
            operation = function.instruction_id(k)
            sources, targets = function.instruction_input(k), function.instruction_output(k)
            if operation == ca.OP_OUTPUT:
                outputs[targets[0]][targets[1]] = self._moving(work[sources[0]])
            elif operation == ca.OP_INPUT:
                work[targets[0]] = _Term(inputs[sources[0]][sources[1]], sources[0] < fixed)
            elif operation == ca.OP_CONST:
                work[targets[0]] = _Term(ca.SX(function.instruction_constant(k)), True)
            else:
                work[targets[0]] = self._applied(operation, [work[source] for source in sources])
        return outputs

    def _applied(self, operation: int, operands: list[_Term]) -> _Term:
        ca = self.ca
        if all(operand.fixed for operand in operands):
            return _Term(self._call(operation, [operand.value for operand in operands]), True)
        if operation == ca.OP_DIV and operands[1].fixed:
            operation, operands = ca.OP_MUL, [operands[0], _Term(1.0 / operands[1].value, True)]
        fraction = self._fraction(operation, operands)
        return fraction or _Term(
            self._call(operation, [self._moving(operand) for operand in operands]), False
        )

    def _fraction(self, operation: int, operands: list[_Term]) -> _Term | None:
        """The rules of fractions, for the operations that the creep force is made of."""
        ca = self.ca
        first, last = operands[0], operands[-1]
        if operation == ca.OP_DIV:
            n, d = first.fraction or (self._moving(first), 1.0)
            p, q = last.fraction or (self._moving(last), 1.0)
            if last.root is not None and last.root is d:  # (n / d) / (p / d^2)
                return _quotient(n * d, p)
            return _quotient(n * q, d * p)
        whole, other = (last, first) if first.fraction is None else (first, last)
        if whole.fraction is None:
            return None
        n, d = whole.fraction
        if operation == ca.OP_ATAN:
            return _Term(ca.atan2(n, d), False)
        if operation == ca.OP_SQ:
            return _quotient(n * n, d * d, root=d)
        if operation == ca.OP_MUL and other.fraction is None:
            return _quotient(n * self._moving(other), d, root=whole.root)
        if operation == ca.OP_ADD and other.fixed:
            return _quotient(n + self._moving(other) * d, d, root=whole.root)
        return None

    def _call(self, operation: int, operands: list[Any]) -> Any:
        sx = self.ca.SX
        return sx.unary(operation, *operands) if len(operands) == 1 else sx.binary(operation, *operands)

    def _moving(self, term: _Term) -> Any:
        """What stands for an operand in the part that is left."""
        if not term.fixed or term.value.is_constant():
            return term.value
        key = term.value.element_hash()
        if key not in self.store:
            self.store[key] = (term.value, self.ca.SX.sym(f"c{len(self.store)}"))
        return self.store[key][1]
