"""Corners of tables and characteristics of brakes, rounded so that integration keeps its order.

The rounded corner is the sharp one, max(x, 0), smeared by a bump of half the width w: its second derivative is the
bump.
"""

import sympy as sp

x = sp.Symbol("x", real=True)
w = sp.Symbol("w", positive=True)
s = sp.Symbol("s", real=True)

bump = sp.Rational(15, 16) * (1 - s**2) ** 2  # over [-1, 1], in units of 1/w
whole_residual = sp.integrate(bump, (s, -1, 1)) - 1
shape = sp.Rational(5, 32) + s * (
    sp.Rational(1, 2) + s * sp.Rational(15, 16) * (sp.Rational(1, 2) - s**2 / 6 + s**4 / 30)
)
rounded = w * shape.subs(s, x / w)
second_residual = sp.simplify(sp.diff(rounded, x, 2) - bump.subs(s, x / w) / w)


def _meets(order: int, side: int) -> sp.Expr:
    """Difference of a derivative from that of max(x, 0) at an end of the rounding."""
    sharp = x if side > 0 else sp.Integer(0)
    return sp.simplify((sp.diff(rounded, x, order) - sp.diff(sharp, x, order)).subs(x, side * w))


meeting_residual = sum(sp.Abs(_meets(order, side)) for order in range(4) for side in (-1, 1))
middle_residual = sp.simplify(rounded.subs(x, 0) - sp.Rational(5, 32) * w)
fourth = sp.simplify(sp.diff(rounded, x, 4).subs(x, w))  # what jumps
fourth_residual = sp.simplify(fourth - sp.Rational(15, 2) / w**3)
