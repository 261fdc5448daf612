"""SymPy expressions in Typst's math syntax.

Imports SymPy when it is itself imported: only who already holds an expression has a use for this module.
"""

from typing import Any

from sympy import Basic, Mul, Rational, Symbol, fraction
from sympy.core.function import AppliedUndef
from sympy.printing.conventions import split_super_sub
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.str import StrPrinter

_GREEK = {
    *("alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu"),
    *("nu", "xi", "omicron", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega"),
}
_ACCENTS = {
    "hat": "hat",
    "bar": "overline",
    "tilde": "tilde",
    "dot": "dot",
    "ddot": "dot.double",
    "star": "",
}
_FUNCTIONS = {"Abs": "abs", "atan": "arctan", "asin": "arcsin", "acos": "arccos", "log": "ln", "Max": "max"}
_FUNCTIONS |= {name: name for name in ("exp", "sin", "cos", "tan", "sinh", "cosh", "tanh", "sqrt")}
_FUNCTIONS |= {"Min": "min", "sign": 'op("sgn")'}


def typst_math(expression: Basic) -> str:
    """Return a SymPy expression, equation or matrix in Typst's math syntax.

    Names follow SymPy's conventions: ``T_brake`` has an upright subscript, ``mu0`` an italic one; accents are
    written ``omegadot`` or ``I_hat``, ``u_star`` gets an asterisk. Functions of time lose their argument.
    """
    return str(_TypstPrinter().doprint(expression))


def _name(word: str) -> str:
    """Print a word: Greek letters and single letters in italics, everything else upright."""
    word = "lambda" if word == "lamda" else word
    if word.lower() in _GREEK or len(word) == 1 or word.isdigit():
        return word
    return f'"{word}"'


def typst_symbol(name: str) -> str:
    """Return the name of a symbol in Typst's math syntax, such as ``T_"brake"`` for ``T_brake``."""
    base, above, below = split_super_sub(name)
    accents = [part for part in below if part in _ACCENTS]
    for accent in sorted(_ACCENTS, key=len, reverse=True):
        stem = base.removesuffix(accent)
        if stem != base and (len(stem) == 1 or stem.replace("lamda", "lambda").lower() in _GREEK):
            base, accents = stem, [accent, *accents]
            break
    below = [part for part in below if part not in _ACCENTS]
    above = above + ["*" for accent in accents if accent == "star"]
    symbol = _name(base)
    for accent in accents:
        symbol = f"{_ACCENTS[accent]}({symbol})" if _ACCENTS[accent] else symbol
    return symbol + _script("_", below) + _script("^", above)


def _script(mark: str, words: list[str]) -> str:
    if not words:
        return ""
    printed = ", ".join(_name(word) for word in words)
    return f"{mark}{printed}" if len(words) == 1 else f"{mark}({printed})"


class _TypstPrinter(StrPrinter):  # type: ignore[misc]  # SymPy has no type information
    """StrPrinter with Typst's notation; precedence and parentheses are SymPy's."""

    def _print_Symbol(self, expr: Symbol) -> str:
        return typst_symbol(expr.name)

    _print_Dummy = _print_Symbol

    def _print_Pi(self, _expr: Basic) -> str:
        return "pi"

    def _print_Infinity(self, _expr: Basic) -> str:
        return "infinity"

    def _print_NegativeInfinity(self, _expr: Basic) -> str:
        return "-infinity"

    def _print_Exp1(self, _expr: Basic) -> str:
        return "e"

    def _print_Rational(self, expr: Rational) -> str:
        sign = "-" if expr.p < 0 else ""
        return f"{sign}frac({abs(expr.p)}, {expr.q})"

    def _print_Float(self, expr: Basic) -> str:
        mantissa, _, exponent = f"{float(expr):.12g}".partition("e")
        return f"{mantissa} times 10^({int(exponent)})" if exponent else mantissa

    def _print_Add(self, expr: Basic, order: Any = None) -> str:
        printed = ""
        for term in self._as_ordered_terms(expr, order=order):
            text = self.parenthesize(term, PRECEDENCE["Add"], strict=True)
            if text.startswith("-"):
                printed += f" - {text[1:]}" if printed else text
            else:
                printed += f" + {text}" if printed else text
        return printed

    def _print_Mul(self, expr: Mul) -> str:
        if expr.could_extract_minus_sign():
            return "-" + self._positive(-expr)
        return self._positive(expr)

    def _positive(self, expr: Basic) -> str:
        numerator, denominator = fraction(expr)
        if denominator != 1:
            return f"frac({self.doprint(numerator)}, {self.doprint(denominator)})"
        factors = expr.as_ordered_factors() if isinstance(expr, Mul) else (expr,)
        printed = ""
        for factor in factors:
            text = self.parenthesize(factor, PRECEDENCE["Mul"])
            between = " times " if printed and text[0].isdigit() else " " if printed else ""
            printed += between + text
        return printed

    def _print_Pow(self, expr: Basic, _rational: bool = False) -> str:
        base, exponent = expr.as_base_exp()
        if exponent.is_Rational and exponent < 0:
            return f"frac(1, {self.doprint(base**-exponent)})"
        if exponent.is_Rational and exponent.q == 2:
            root = f"sqrt({self.doprint(base)})"
            return root if exponent.p == 1 else f"{root}^{exponent.p}"
        printed = self.parenthesize(base, PRECEDENCE["Pow"])
        if "^" in printed and not printed.startswith("("):
            printed = f"({printed})"
        power = self.doprint(exponent)
        return f"{printed}^{power}" if power.isalnum() else f"{printed}^({power})"

    def _print_Function(self, expr: Basic) -> str:
        name = type(expr).__name__
        if isinstance(expr, AppliedUndef):
            printed = _function_name(name)
            if len(expr.args) == 1 and isinstance(expr.args[0], Symbol) and expr.args[0].name == "t":
                return printed
        else:
            printed = _FUNCTIONS.get(name, f'op("{name}")')
        return f"{printed}({self.stringify(expr.args, ', ')})"

    _print_ExpBase = _print_Abs = _print_sign = _print_Max = _print_Min = _print_LatticeOp = _print_Function

    def _print_Derivative(self, expr: Basic) -> str:
        inner, (variable, order) = expr.expr, expr.variable_count[0]
        single = len(expr.variable_count) == 1
        printed = self.doprint(inner)
        is_state = isinstance(inner, AppliedUndef) and inner.args == (variable,) and variable.name == "t"
        if is_state and single and order in (1, 2):
            return f"{'dot' if order == 1 else 'dot.double'}({printed})"
        sign = "dif" if len(inner.free_symbols) == 1 else "partial"
        above = f"{sign}^{expr.derivative_count}" if expr.derivative_count > 1 else sign
        below = " ".join(
            f"{sign} {self.doprint(each)}" + (f"^{times}" if times > 1 else "")
            for each, times in expr.variable_count
        )
        if isinstance(inner, AppliedUndef | Symbol):
            return f"frac({above} {printed}, {below})"
        return f"frac({above}, {below}) ({printed})"

    def _print_Integral(self, expr: Basic) -> str:
        signs, ends = "", ""
        for variable, *bounds in expr.limits:
            scripts = zip("_^", bounds, strict=True) if len(bounds) == 2 else ()
            limits = "".join(f"{mark}({self.doprint(bound)})" for mark, bound in scripts)
            signs = f"integral{limits} {signs}"
            ends += f" dif {self.doprint(variable)}"
        return f"{signs}{self.parenthesize(expr.function, PRECEDENCE['Mul'])}{ends}"

    def _print_Piecewise(self, expr: Basic) -> str:
        branches = []
        for value, condition in expr.args:
            when = '"otherwise"' if condition == True else f'"if " {self.doprint(condition)}'  # noqa: E712
            branches.append(f"{self.doprint(value)} & quad {when}")
        return f"cases({', '.join(branches)})"

    def _print_Relational(self, expr: Basic) -> str:
        sign = "=" if expr.rel_op == "==" else expr.rel_op
        return f"{self.doprint(expr.lhs)} {sign} {self.doprint(expr.rhs)}"

    def _print_And(self, expr: Basic) -> str:
        return ' " and " '.join(self.doprint(each) for each in sorted(expr.args, key=str))

    def _print_MatrixBase(self, expr: Any) -> str:
        rows = "; ".join(", ".join(self.doprint(entry) for entry in row) for row in expr.tolist())
        return f'mat(delim: "[", {rows})'


def _function_name(word: str) -> str:
    """Print the name of an undefined function; longer names are upright operators."""
    printed = typst_symbol(word)
    return f"op({printed})" if printed.startswith('"') else printed
