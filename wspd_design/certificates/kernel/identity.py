"""Whether two SymPy expressions are the same function, decided in a prime field.

An expression that is written for people overestimates its range on intervals, since a variable that stands in it
twice counts twice. A claim may therefore bring an arranged form; here the checker makes sure that it is the same
function. Both are evaluated at a pseudo-random point of the field of 2^255 - 19 elements. What is not rational
(``exp``, ``atan``, a broken power) becomes a pseudo-random element that depends on the value of its argument. Two
different expressions agree with a probability of about their degree in 2^255, below 1e-60.
"""

from fractions import Fraction
from hashlib import sha256
from math import floor
from typing import Any

from wspd_design.certificates.kernel.claim import constant
from wspd_design.certificates.kernel.enclosures import Refused

PRIME = 2**255 - 19


def same(one: Any, other: Any) -> bool:
    """Whether two expressions are the same function wherever both are defined."""
    return _value(one) == _value(other)


def _value(expression: Any) -> int:
    found: dict[Any, int] = {}

    def visit(node: Any) -> int:
        if node not in found:
            found[node] = _apply(node, [visit(argument) for argument in node.args])
        return found[node]

    return visit(expression)


def _apply(node: Any, x: list[int]) -> int:
    if node.is_Symbol:
        return _element("Symbol", node.name)
    if not node.args:
        return _residue(constant(node))
    if node.is_Add:
        return sum(x) % PRIME
    if node.is_Mul:
        product = 1
        for factor in x:
            product = product * factor % PRIME
        return product
    if node.is_Pow:
        return _power(x[0], constant(node.args[1]))
    name = type(node).__name__
    # The magnitude does not know the sign of its argument.
    return _element(name, *(y * y % PRIME if name == "Abs" else y for y in x))


def _power(base: int, exponent: Fraction) -> int:
    """Integer powers by themselves; a broken exponent leaves an element for its part between 0 and 1."""
    whole = floor(exponent)
    if base == 0:
        raise Refused("the identity cannot be decided: a base vanishes")
    rest = exponent - whole
    return pow(base, whole, PRIME) * (_element("Pow", base, rest) if rest else 1) % PRIME


def _element(*content: object) -> int:
    return int.from_bytes(sha256(repr(content).encode()).digest() * 2, "big") % PRIME


def _residue(number: Fraction) -> int:
    return number.numerator * pow(number.denominator, -1, PRIME) % PRIME
