"""Print SymPy expressions in the paper's symbols: plain text for the terminal, Typst math for the report."""

from dataclasses import dataclass

import sympy as sp
from sympy.printing.printer import Printer
from sympy.printing.str import StrPrinter

from derivations.notation import quantity


def _name(name: str, column: int) -> str:
    found = quantity(name)
    if found is None:
        return name
    return found.typst if column else found.plain


class PlainPrinter(StrPrinter):  # type: ignore[misc]
    """Plain text such as ``λ' = F + G*T``."""

    def _print_Symbol(self, expression: sp.Symbol) -> str:
        return _name(expression.name, 0)

    def _print_Function(self, expression: sp.Function) -> str:
        if isinstance(expression, sp.core.function.AppliedUndef):
            return _name(expression.func.__name__, 0)
        return f"{expression.func.__name__}({', '.join(map(self._print, expression.args))})"

    def _print_Derivative(self, expression: sp.Derivative) -> str:
        return f"{self._print(expression.expr)}'"

    def _print_Integral(self, expression: sp.Integral) -> str:
        return f"∫{self._print(expression.function)} dt"

    def _print_Abs(self, expression: sp.Abs) -> str:
        return f"|{self._print(expression.args[0])}|"

    def _print_Pow(self, expression: sp.Pow, rational: bool = False) -> str:
        return str(super()._print_Pow(expression, rational=rational)).replace("**", "^")


class TypstPrinter(Printer):  # type: ignore[misc]
    """Typst math; products and quotients as fractions."""

    def _print_Symbol(self, expression: sp.Symbol) -> str:
        return _name(expression.name, 1)

    def _print_Rational(self, expression: sp.Rational) -> str:
        return f"{expression.p}/{expression.q}" if expression.q != 1 else str(expression.p)

    _print_Integer = _print_Rational

    def _print_Pi(self, _: sp.Expr) -> str:
        return "pi"

    def _print_Add(self, expression: sp.Add) -> str:
        first, *rest = (self._print(term) for term in sp.Add.make_args(expression))
        # A positive term first reads better than a leading minus sign.
        terms = sorted([first, *rest], key=lambda term: term.startswith("-"))
        joined = "".join(f" - {t[1:].lstrip()}" if t.startswith("-") else f" + {t}" for t in terms)
        return joined[3:] if joined.startswith(" + ") else "-" + joined[3:]

    def _print_Mul(self, expression: sp.Mul) -> str:
        if expression.could_extract_minus_sign() and expression.args[0].is_number:
            return f"-{self._factor(-expression)}"
        above, below = [], []  # exponentials stay above the line, unlike with sympy.fraction
        for factor in sp.Mul.make_args(expression):
            if factor.is_Rational:
                above += [sp.Integer(factor.p)] if factor.p != 1 else []
                below += [sp.Integer(factor.q)] if factor.q != 1 else []
            elif factor.is_Pow and factor.exp.is_negative:
                below.append(1 / factor)
            else:
                above.append(factor)
        return f"({self._product(above)})/({self._product(below)})" if below else self._product(above)

    def _product(self, factors: list[sp.Expr]) -> str:
        if len(factors) == 1:
            return str(self._print(factors[0]))
        ordered = sorted(
            factors, key=lambda factor: (not factor.is_Number, factor.is_Add or factor.is_Function)
        )
        return " ".join(self._factor(factor) for factor in ordered) or "1"

    def _factor(self, expression: sp.Expr) -> str:
        text = self._print(expression)
        return f"({text})" if expression.is_Add else text

    def _print_Pow(self, expression: sp.Pow) -> str:
        if expression.exp.is_negative:
            return f"1/({self._print(1 / expression)})"
        base = self._print(expression.base)
        simple = expression.base.is_Symbol and "^" not in base
        return f"{base if simple else f'({base})'}^({self._print(expression.exp)})"

    def _print_exp(self, expression: sp.exp) -> str:
        return f"exp({self._print(expression.args[0])})"

    def _print_atan(self, expression: sp.atan) -> str:
        return f"arctan({self._print(expression.args[0])})"

    def _print_Abs(self, expression: sp.Abs) -> str:
        return f"abs({self._print(expression.args[0])})"

    def _print_sign(self, expression: sp.sign) -> str:
        return f'op("sgn")({self._print(expression.args[0])})'

    def _print_sin(self, expression: sp.sin) -> str:
        return f"sin({self._print(expression.args[0])})"

    def _print_tanh(self, expression: sp.tanh) -> str:
        return f"tanh({self._print(expression.args[0])})"

    def _print_Integral(self, expression: sp.Integral) -> str:
        variable, low, high = expression.limits[0]
        limits = f"_({self._print(low)})^({self._print(high)})"
        return f"integral{limits} {self._factor(expression.function)} dif {self._print(variable)}"

    def _print_Derivative(self, expression: sp.Derivative) -> str:
        return f"dot({self._print(expression.expr)})"

    def _print_Function(self, expression: sp.Function) -> str:
        return _name(expression.func.__name__, 1)

    def emptyPrinter(self, expression: object) -> str:
        """Refuse what has no rule, so that nothing is printed wrongly."""
        raise TypeError(f"no Typst form for {type(expression).__name__}")


def plain(expression: sp.Expr) -> str:
    """Print an expression in the paper's symbols as plain text."""
    return str(PlainPrinter().doprint(expression))


def typst(expression: sp.Expr) -> str:
    """Print an expression in the paper's symbols as Typst math."""
    return str(TypstPrinter().doprint(expression))


@dataclass(frozen=True, slots=True)
class Form:
    """An equation or inequality as it is shown: plain text and Typst math.

    ``sides`` are the expressions that must have the same unit.
    """

    plain: str
    typst: str = ""
    sides: tuple[sp.Expr, ...] = ()


def form(left: str | sp.Expr, right: sp.Expr, relation: str = "=") -> Form:
    """Show ``left relation right``; a left side in words is the name of a symbol."""
    left = sp.Symbol(left) if isinstance(left, str) else left
    sign = {"<=": "≤", ">=": "≥"}.get(relation, relation)
    return Form(
        f"{plain(left)} {sign} {plain(right)}", f"{typst(left)} {relation} {typst(right)}", (left, right)
    )
