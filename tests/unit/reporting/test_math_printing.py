"""SymPy -> Typst: our kinds of expressions, compared with hand-written Typst and compiled by Typst itself."""

import pytest
import sympy as sp

from wspd_design.reporting.blocks import Equation
from wspd_design.reporting.equations import typeset
from wspd_design.reporting.math import typst_math, typst_symbol

R, inertia, v, m, t, f, f_d, lam, x = sp.symbols("R I v m t f f_d lambda x", positive=True)
slip, speed = sp.Function("lambda")(t), sp.Function("v")(t)
drift, gain = sp.Function("F")(lam, v), sp.Function("G")(v)

CASES = [
    (sp.Symbol("T_brake") * sp.Symbol("mu0"), 'T_"brake" mu_0'),
    (R / (2 * inertia * v), "frac(R, 2 I v)"),
    (-R / (2 * inertia), "-frac(R, 2 I)"),
    (-(1 - lam) * f, "f (lambda - 1)"),
    ((f_d + 8 * f) / m, "frac(8 f + f_d, m)"),
    (x**2, "x^2"),
    (x**-1, "frac(1, x)"),
    (x**-3, "frac(1, x^3)"),
    (sp.sqrt(v), "sqrt(v)"),
    ((x + 1) ** 2, "(x + 1)^2"),
    (x**lam, "x^lambda"),
    (sp.exp(-t / sp.Symbol("tau")), "exp(-frac(t, tau))"),
    (sp.atan(x), "arctan(x)"),
    (sp.log(x), "ln(x)"),
    (sp.Abs(sp.Symbol("s")), "abs(s)"),
    (sp.sign(sp.Symbol("s")), 'op("sgn")(s)'),
    (sp.Max(x, 1, evaluate=False), "max(1, x)"),
    (sp.Function("sat")(x), 'op("sat")(x)'),
    (drift + gain * sp.Symbol("T"), "T G(v) + F(lambda, v)"),
    (sp.Derivative(slip, t), "dot(lambda)"),
    (sp.Derivative(slip, t, 2), "dot.double(lambda)"),
    (sp.Derivative(slip, t) ** 2, "dot(lambda)^2"),
    (sp.Derivative(drift, lam), "frac(partial F(lambda, v), partial lambda)"),
    (sp.Derivative(drift, lam, v), "frac(partial^2 F(lambda, v), partial lambda partial v)"),
    (sp.Derivative(gain, v), "frac(dif G(v), dif v)"),
    (sp.Eq(speed.diff(t), -f_d / m), "dot(v) = -frac(f_d, m)"),
    (sp.Le(x, 1), "x <= 1"),
    (sp.Integral(x**2, (x, 0, sp.oo)), "integral_(0)^(infinity) x^2 dif x"),
    (sp.Piecewise((x, x < 1), (1, True)), 'cases(x & quad "if " x < 1, 1 & quad "otherwise")'),
    (sp.Matrix([[x, 0], [1, -lam]]), 'mat(delim: "[", x, 0; 1, -lambda)'),
    (sp.Rational(-1, 2) * x, "-frac(x, 2)"),
    (sp.Float(2.5e-7) * x, "2.5 times 10^(-7) x"),
    (sp.Float(9.81), "9.81"),
    (-2 * sp.Symbol("Phi") / sp.Symbol("K_P"), "-frac(2 Phi, K_P)"),
    (sp.Symbol("u_star") ** 2, "(u^*)^2"),
    (sp.pi * x, "pi x"),
]


@pytest.mark.parametrize(("expression", "expected"), CASES, ids=[expected for _, expected in CASES])
def test_prints_as_written_by_hand(expression: sp.Basic, expected: str) -> None:
    assert typst_math(expression) == expected


def test_typst_accepts_everything_printed() -> None:
    equations = [Equation(source=typst_math(expression), description="a case") for expression, _ in CASES]
    formulas = typeset(equations)
    assert all("<use " in formulas.image(equation).svg for equation in equations)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("lambda_d", "lambda_d"),
        ("lamda", "lambda"),
        ("omegadot", "dot(omega)"),
        ("I_hat", "hat(I)"),
        ("lambda_d_dot", "dot(lambda)_d"),
        ("T_brake_max", 'T_("brake", "max")'),
        ("b_tilde", "tilde(b)"),
        ("W0", "W_0"),
        ("rho_bar", "overline(rho)"),
        ("mass", '"mass"'),
        ("x^n_i", "x_i^n"),
        ("pivot", '"pivot"'),
    ],
)
def test_symbol_names(name: str, expected: str) -> None:
    assert typst_symbol(name) == expected


def test_a_product_of_sums_keeps_its_parentheses() -> None:
    assert typst_math(sp.Mul(x + 1, v - 1, evaluate=False)) in ("(x + 1) (v - 1)", "(v - 1) (x + 1)")


def test_the_value_survives_the_print() -> None:
    """A typeset -a + b and a typeset b - a must not be the same thing as a + b."""
    printed = {typst_math(each) for each in (x + v, x - v, v - x, -x - v)}
    assert len(printed) == 4
