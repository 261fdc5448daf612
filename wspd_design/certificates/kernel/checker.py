#!/usr/bin/env python3
"""Decide about proofs, with python-flint and the standard library alone.

A proof is a JSON object: a *statement*, which says everything that is claimed, and what it takes to see that it is
true. This file needs nothing else of the package. As a script it reads certificate files and decides about every
proof in them::

    python checker.py er24pc.certificates/*.json

What it cannot tell is whether a statement is about your design: ``wspd check`` makes every statement again from the
design and compares.

An *inequality* states a formula, the exact ranges of its variables, a relation and a bound. A formula is a list of
steps, each made of earlier ones: ``["x", name]``, ``["n", number]``, ``["add", i, j, ...]``, ``["mul", i, j, ...]``,
``["pow", i, exponent]``, ``["abs", i]``, ``["exp", i]``, ``["atan", i]``; the last step is the result. ``model`` is the
formula as the program computes it. ``form``, if it is there, is the same function arranged so that its variables stand
in it as few times as possible; that it is the same is decided in the prime field of 2^255 - 19 elements, where two
different functions agree with a probability below 1e-60. The proof is a tree in preorder, one character per step:

* ``a``, ``b``, ...: the box is halved along the first, second, ... variable with a range; the lower half comes first;
* ``A``, ``B``, ...: the formula is monotone in this variable on the box, which is reduced to its worst face;
* ``.``: interval arithmetic shows the inequality on the box;
* ``~``: the mean value form shows it.

An *identity* states that two formulas are the same function wherever both are defined; a *sign* states that a number
is positive. Both are decided without further proof.

A decimal stands for the double that Python reads from it, exactly; ``p/q`` for the fraction.
"""

import json
import re
import sys
from collections.abc import Mapping, Sequence
from fractions import Fraction
from hashlib import sha256
from math import floor, isfinite
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import flint
from flint import arb, fmpq

FORMAT = "wspd-proof/2"
PRECISION = 80  # bits
PRIME = 2**255 - 19
MOST_BYTES = 20_000_000  # of a file
MOST_STEPS = 20_000  # of a formula
MOST_HALVINGS = 400  # of one box
MOST_DIGITS = 2_000  # of a fraction
MOST_EXPONENT = 64  # of a power
MOST_WORK = 25_000_000  # operations on intervals, about 40 s
DECIMAL = re.compile(r"-?[0-9]{1,40}(\.[0-9]{1,40})?(e[-+]?[0-9]{1,3})?")
RATIO = re.compile(rf"-?[0-9]{{1,{MOST_DIGITS}}}/[0-9]{{1,{MOST_DIGITS}}}")
WORDS = re.compile(r"[ -~]{1,300}")  # printable ASCII: no byte of a file steers a terminal

Ends: TypeAlias = tuple[Any, Any]
"""Balls around the lower and the upper end of an interval: a ball alone would fail on 1 + x^2."""
Slopes: TypeAlias = dict[int, Ends]
"""Enclosures of the derivatives, by the number of the variable; one that is not there is zero."""
Box: TypeAlias = list[tuple[Any, Any]]
"""Exact ends of every variable (``fmpq``)."""


class Refused(ValueError):
    """The proof does not show what it states."""


class Work:
    """What may still be spent on a file: operations are counted, time is not looked at."""

    def __init__(self, most: int = MOST_WORK) -> None:
        self.left = most

    def spend(self, operations: int) -> None:
        """Take operations from the budget, or refuse."""
        self.left -= operations
        if self.left < 0:
            raise Refused("the proof asks for more work than the checker may do")


class Shown(NamedTuple):
    """What a proof shows."""

    statement: str  # in words
    leaves: int  # boxes that were decided


def decide(proof: object, work: Work) -> Shown:
    """Decide about one proof.

    Parameters
    ----------
    proof : object
        From JSON; it may be anything.
    work : Work
        Shared by all proofs of a file.

    Raises
    ------
    Refused
        If it is not a proof of its statement.
    """
    content = _typed(proof, dict, "proof")
    if content.get("format") != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    statement = _typed(content.get("statement"), dict, "statement")
    match statement.get("kind"):
        case "inequality":
            return _inequality(statement, content.get("tree"), work)
        case "identity":
            one, other = (_formula(statement.get(key)) for key in ("left", "right"))
            work.spend(len(one) + len(other))
            if not same(one, other):
                raise Refused("the two formulas are not the same function")
            return Shown(statement=_words(statement.get("name"), "the name"), leaves=1)
        case "sign":
            name, unit = (_words(statement.get(key), key) for key in ("name", "unit"))
            found = number(statement.get("value"))
            if not found > 0:
                raise Refused(f"{name} = {float(found):.6g} is not positive")
            return Shown(statement=f"{name} = {float(found):.6g} {unit} > 0".replace(" - ", " "), leaves=1)
        case _:
            raise Refused("the statement is of no known kind")


def value(
    statement: Mapping[str, Any], point: Mapping[str, Fraction], work: Work
) -> tuple[Fraction, Fraction]:
    """Enclose the formula of an inequality, as the program computes it, at one point of its box.

    Where the program divides by zero, the arranged form stands for the limit.

    Raises
    ------
    Refused
        If the point does not lie in the box, or the formula is not defined there.
    """
    given = _Inequality(statement)
    box: Box = []
    for name, low, high in given.variables:
        at = point[name] if low < high else low
        if not low <= at <= high:
            raise Refused(f"{name} = {float(at):g} lies outside the box")
        box.append((_fmpq(at), _fmpq(at)))
    with flint.ctx.workprec(PRECISION):
        found, _ = Program(given.model, given.variables, work).run(_ends(box))
        if not finite(found) and given.model is not given.form and same(given.form, given.model):
            found, _ = Program(given.form, given.variables, work).run(_ends(box))
        if not finite(found):
            raise Refused("the formula is not defined at this point")
        return _rational(found[0].lower()), _rational(found[1].upper())


class _Inequality:
    """An inequality as it is stated, read with care."""

    def __init__(self, statement: Mapping[str, Any]) -> None:
        self.name, self.unit = (_words(statement.get(key), key) for key in ("name", "unit"))
        self.relation = statement.get("relation")
        if self.relation not in ("<=", ">="):
            raise Refused("the statement has no relation")
        self.bound = number(statement.get("bound"))
        self.variables = [
            _variable(each) for each in _typed(statement.get("variables"), list, "list of variables")
        ]
        names = {name for name, _, _ in self.variables}
        if len(names) < len(self.variables):
            raise Refused("two variables have the same name")
        self.model = _formula(statement.get("model"), names)
        self.form = _formula(statement["form"], names) if "form" in statement else self.model

    def words(self) -> str:
        """Return the inequality in words."""
        ranges = [f"{name} {float(a):g} to {float(b):g}" for name, a, b in self.variables if a < b]
        where = f" for all {', '.join(ranges)}" if ranges else ""
        return f"{self.name} {self.relation} {float(self.bound):.17g} {self.unit}".removesuffix(" -") + where


def _inequality(statement: Mapping[str, Any], tree: object, work: Work) -> Shown:
    given = _Inequality(statement)
    work.spend(len(given.model) + len(given.form))
    if given.form is not given.model and not same(given.form, given.model):
        raise Refused("the arranged form of the formula is not the model's")
    if not isinstance(tree, str):
        raise Refused("the proof has no tree")
    with flint.ctx.workprec(PRECISION):
        leaves = _replay(given, tree, work)
    return Shown(statement=given.words(), leaves=leaves)


def _replay(given: _Inequality, tree: str, work: Work) -> int:
    """Walk the tree and return the number of leaves, or refuse."""
    program = Program(given.form, given.variables, work)
    letters = {chr(ord("a") + i): k for i, k in enumerate(program.free)}
    root: Box = [(_fmpq(low), _fmpq(high)) for _, low, high in given.variables]
    waiting: list[tuple[Box, int, list[Ends] | None]] = [(root, 0, None)]
    leaves = 0
    for position, step in enumerate(tree):
        if not waiting:
            raise Refused(f"the tree goes on after its last leaf, at step {position}")
        work.spend(1)
        box, halvings, slopes = waiting.pop()
        if step in ".~":
            if not _holds(given, program, box, mean_value=step == "~"):
                raise Refused(f"leaf {leaves} does not satisfy the inequality")
            leaves += 1
        elif step in letters:
            if halvings >= MOST_HALVINGS:
                raise Refused(f"a box is halved more than {MOST_HALVINGS} times")
            low, high = box[letters[step]]
            middle = (low + high) / 2
            for half in ((middle, high), (low, middle)):
                waiting.append((_replaced(box, letters[step], half), halvings + 1, slopes))
        elif step.lower() in letters and step.isupper():
            face, slopes = _worst_face(given, program, box, letters[step.lower()], slopes)
            waiting.append((face, halvings, slopes))
        else:
            raise Refused(f"the tree has an unknown step at {position}")
    if waiting:
        raise Refused("the tree ends before all boxes are decided")
    return leaves


def _holds(given: _Inequality, program: "Program", box: Box, *, mean_value: bool) -> bool:
    """Whether the inequality is certain on a box."""
    if mean_value:
        slopes = _slopes(program, box)
        middles = [(low + high) / 2 for low, high in box]
        found, _ = program.run(_ends([(middle, middle) for middle in middles]))
        for k in program.free:
            low, high = box[k]
            found = add(found, mul(slopes[k], *_ends([(low - middles[k], high - middles[k])])))
    else:
        found, _ = program.run(_ends(box))
    bound, _ = exactly(given.bound)
    return finite(found) and bool(found[1] <= bound if given.relation == "<=" else found[0] >= bound)


def _worst_face(
    given: _Inequality, program: "Program", box: Box, k: int, slopes: list[Ends] | None
) -> tuple[Box, list[Ends]]:
    """Reduce a box to the end of one variable where the inequality is tightest.

    Slopes that were enclosed on a larger box hold here as well; only if they leave the sign open they are enclosed
    anew.
    """
    if slopes is None or _sign(slopes[k]) == 0:
        slopes = _slopes(program, box)
    sign = _sign(slopes[k])
    if sign == 0:
        raise Refused(f"the formula is not monotone in {given.variables[k][0]} on a box")
    end = box[k][1] if (sign > 0) == (given.relation == "<=") else box[k][0]
    return _replaced(box, k, (end, end)), slopes


def _slopes(program: "Program", box: Box) -> list[Ends]:
    """Enclose the slopes on a box on which the formula is defined."""
    found, slopes = program.run(_ends(box), derivatives=True)
    if not finite(found):
        raise Refused("the formula is not defined on a box where its slope is used")
    return slopes


def _sign(x: Ends) -> int:
    """1 or -1 if an interval certainly has no number of the other sign, else 0."""
    return 1 if x[0] >= 0 else -1 if x[1] <= 0 else 0


class Program:
    """A formula on intervals, with forward derivatives; what no free variable enters is done beforehand."""

    def __init__(
        self,
        formula: Sequence[Sequence[Any]],
        variables: Sequence[tuple[str, Fraction, Fraction]],
        work: Work,
    ):
        self.free = [k for k, (_, low, high) in enumerate(variables) if low < high]
        self.known: dict[int, Ends] = {}
        self.steps: list[tuple[int, str, Sequence[int], Any]] = []
        self.result = len(formula) - 1
        self.work = work
        numbers = {name: k for k, (name, _, _) in enumerate(variables)}
        for place, (name, *operands) in enumerate(formula):
            extra: Any = None
            if name == "x":
                operands, extra = [], numbers[operands[0]]
                if extra not in self.free:
                    self.known[place] = exactly(variables[extra][1])
                    continue
            elif name == "n":
                self.known[place] = exactly(operands[0])
                continue
            elif name == "pow":
                operands, extra = operands[:1], operands[1]
            if operands and all(k in self.known for k in operands):
                self.known[place], _ = _apply(name, [(self.known[k], {}) for k in operands], extra)
            else:
                self.steps.append((place, name, operands, extra))

    def run(self, ends: list[Ends], *, derivatives: bool = False) -> tuple[Ends, list[Ends]]:
        """Enclose the value and, if asked, the slope along every variable."""
        self.work.spend(len(self.steps) * (1 + len(self.free) if derivatives else 1))
        done: dict[int, tuple[Ends, Slopes]] = {k: (found, {}) for k, found in self.known.items()}
        for place, name, operands, extra in self.steps:
            if name == "x":
                done[place] = ends[extra], {extra: ONE} if derivatives else {}
            else:
                done[place] = _apply(name, [done[k] for k in operands], extra)
        found, slope = done[self.result]
        return found, [slope.get(k, ZERO) for k in range(len(ends))]


def _apply(name: str, operands: list[tuple[Ends, Slopes]], exponent: Any) -> tuple[Ends, Slopes]:
    """Do one operation on intervals and their slopes."""
    x, dx = operands[0]
    if name == "add":
        for y, dy in operands[1:]:
            x, dx = add(x, y), _plus(dx, dy)
    elif name == "mul":
        for k, (y, dy) in enumerate(operands[1:]):
            dx = _plus(_times(dx, y), _times(dy, x))
            x = sqr(x) if k == 0 and operands[1] is operands[0] else mul(x, y)
    elif name == "pow":
        inner = mul(exactly(exponent), power(x, exponent - 1))
        x, dx = power(x, exponent), _times(dx, inner)
    elif name == "abs":
        # Where the sign is open the slope may be that of either side.
        sign = ONE if x[0] >= 0 else MINUS if x[1] <= 0 else (arb(-1), arb(1))
        x, dx = magnitude(x), _times(dx, sign)
    elif name == "exp":
        x = exp(x)
        dx = _times(dx, x)
    else:
        x, dx = (x[0].atan(), x[1].atan()), _times(dx, inverse(add(ONE, sqr(x))))
    return x, dx


ZERO, ONE, MINUS = ((arb(n), arb(n)) for n in (0, 1, -1))


def add(x: Ends, y: Ends) -> Ends:
    """Sum of two intervals."""
    return x[0] + y[0], x[1] + y[1]


def mul(x: Ends, y: Ends) -> Ends:
    """Product of two intervals; mostly their signs tell which ends count."""
    (a, b), (c, d) = x, y
    if a >= 0 and c >= 0:
        return a * c, b * d
    if b <= 0 and d <= 0:
        return b * d, a * c
    if a >= 0 and d <= 0:
        return b * c, a * d
    if b <= 0 and c >= 0:
        return a * d, b * c
    p, q, r, s = a * c, a * d, b * c, b * d
    return p.min(q).min(r).min(s), p.max(q).max(r).max(s)


def magnitude(x: Ends) -> Ends:
    """Magnitude of an interval."""
    return arb(0).max(x[0]).max(-x[1]), x[1].max(-x[0])


def sqr(x: Ends) -> Ends:
    """Square of an interval."""
    low, high = magnitude(x)
    return low * low, high * high


def inverse(x: Ends) -> Ends:
    """Reciprocal of an interval; not a number if it may contain zero."""
    return (1 / x[1], 1 / x[0]) if x[0] > 0 or x[1] < 0 else (arb.nan(), arb.nan())


def power(x: Ends, exponent: Fraction) -> Ends:
    """Power of an interval; not a number if a fractional exponent meets a base that may reach zero."""
    if exponent < 0:
        return inverse(power(x, -exponent))
    if exponent.denominator > 1:
        return exp(mul(exactly(exponent), log(x)))
    if exponent == 0:
        return add(ONE, mul(ZERO, x))
    if exponent % 2 == 0:
        return sqr(power(x, exponent / 2))
    return x[0] ** int(exponent), x[1] ** int(exponent)


def exp(x: Ends) -> Ends:
    """Exponential function of an interval."""
    return x[0].exp(), x[1].exp()


def log(x: Ends) -> Ends:
    """Natural logarithm of an interval; not a number if it may reach zero."""
    return (x[0].log(), x[1].log()) if x[0] > 0 else (arb.nan(), arb.nan())


def _plus(x: Slopes, y: Slopes) -> Slopes:
    return {**x, **y, **{k: add(x[k], y[k]) for k in x.keys() & y.keys()}}


def _times(slope: Slopes, factor: Ends) -> Slopes:
    return {k: mul(each, factor) for k, each in slope.items()}


def exactly(rational: Fraction) -> Ends:
    """Interval of one rational."""
    around = arb(_fmpq(rational))
    return around, around


def finite(x: Ends) -> bool:
    """Whether an interval has two finite ends."""
    return bool(x[0].is_finite() and x[1].is_finite())


def _ends(box: Box) -> list[Ends]:
    return [(arb(low), arb(high)) for low, high in box]


def _replaced(box: Box, k: int, ends: tuple[Any, Any]) -> Box:
    return [*box[:k], ends, *box[k + 1 :]]


def _fmpq(rational: Fraction) -> Any:
    return fmpq(rational.numerator, rational.denominator)


def _rational(end: Any) -> Fraction:
    mantissa, exponent = end.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def same(one: Sequence[Sequence[Any]], other: Sequence[Sequence[Any]]) -> bool:
    """Whether two formulas are the same function wherever both are defined.

    Both are evaluated at a pseudo-random point of a prime field. What is not rational (``exp``, ``atan``, a
    fractional power) becomes a pseudo-random element that depends on the value of its argument.
    """
    return _residue(one) == _residue(other)


def _residue(formula: Sequence[Sequence[Any]]) -> int:
    found: list[int] = []
    for name, *operands in formula:
        if name == "x":
            found.append(_element("x", operands[0]))
        elif name == "n":
            found.append(operands[0].numerator * pow(operands[0].denominator, -1, PRIME) % PRIME)
        elif name == "add":
            found.append(sum(found[k] for k in operands) % PRIME)
        elif name == "mul":
            product = 1
            for k in operands:
                product = product * found[k] % PRIME
            found.append(product)
        elif name == "pow":
            found.append(_residue_power(found[operands[0]], operands[1]))
        else:
            x = found[operands[0]]
            # The magnitude does not know the sign of its argument.
            found.append(_element(name, x * x % PRIME if name == "abs" else x))
    return found[-1]


def _residue_power(base: int, exponent: Fraction) -> int:
    """Integer powers by themselves; a fractional exponent leaves an element for its part between 0 and 1."""
    if base == 0:
        raise Refused("the identity cannot be decided: a base vanishes")
    whole = floor(exponent)
    rest = exponent - whole
    return pow(base, whole, PRIME) * (_element("pow", base, rest) if rest else 1) % PRIME


def _element(*content: object) -> int:
    return int.from_bytes(sha256(repr(content).encode()).digest() * 2, "big") % PRIME


def number(written: object) -> Fraction:
    """Read an exact number."""
    if isinstance(written, str) and DECIMAL.fullmatch(written) and isfinite(float(written)):
        return Fraction(float(written))
    if isinstance(written, str) and RATIO.fullmatch(written):
        above, below = (int(each) for each in written.split("/"))
        if below % PRIME:
            return Fraction(above, below)
    raise Refused("something stands in place of a number")


def _formula(stated: object, names: set[str] | None = None) -> list[list[Any]]:
    """Read a formula; without ``names`` every variable is allowed."""
    steps = _typed(stated, list, "formula")
    if not 0 < len(steps) <= MOST_STEPS:
        raise Refused("a formula is empty or too long")
    return [_step(_typed(step, list, "step of a formula"), place, names) for place, step in enumerate(steps)]


def _step(step: list[Any], place: int, names: set[str] | None) -> list[Any]:
    name, operands = (step[0], step[1:]) if step else (None, [])
    if name == "x" and len(operands) == 1 and isinstance(operands[0], str):
        if names is None or operands[0] in names:
            return step
    elif name == "n" and len(operands) == 1:
        return ["n", number(operands[0])]
    elif name == "pow" and len(operands) == 2 and _earlier(operands[:1], place):
        exponent = number(operands[1])
        if abs(exponent) <= MOST_EXPONENT:
            return ["pow", operands[0], exponent]
    elif operands and _earlier(operands, place):
        if name in ("add", "mul") or (name in ("abs", "exp", "atan") and len(operands) == 1):
            return step
    raise Refused(f"a formula has an unknown step at {place}")


def _earlier(operands: Sequence[object], place: int) -> bool:
    return all(type(k) is int and 0 <= k < place for k in operands)


def _variable(stated: object) -> tuple[str, Fraction, Fraction]:
    each = _typed(stated, list, "variable")
    if len(each) != 4:
        raise Refused("a variable is not [name, low, high, unit]")
    low, high = number(each[1]), number(each[2])
    _words(each[3], "the unit of a variable")
    if low > high:
        raise Refused("a variable has a range that is reversed")
    return _words(each[0], "the name of a variable"), low, high


def _words(stated: object, what: str) -> str:
    if not isinstance(stated, str) or not WORDS.fullmatch(stated):
        raise Refused(f"{what} is not a short text")
    return stated


def _typed(stated: object, kind: type, what: str) -> Any:
    if not isinstance(stated, kind):
        raise Refused(f"the {what} is missing or of another kind")
    return stated


def read(text: str) -> Mapping[str, Any]:
    """Read one JSON object in which no name stands twice, or refuse."""
    if len(text) > MOST_BYTES:
        raise Refused("the file is too long")
    try:
        return _typed(json.loads(text, object_pairs_hook=_once), dict, "JSON object")
    except (ValueError, RecursionError) as error:
        raise (error if isinstance(error, Refused) else Refused("the file is not complete JSON")) from None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    if len({name for name, _ in pairs}) < len(pairs):
        raise Refused("a name stands twice in the file")
    return dict(pairs)


def main(files: Sequence[str]) -> int:
    """Decide about all proofs in certificate files; 0 if every one holds, 1 if one does not, 3 if there is none."""
    found, good = 0, True
    for file in files:
        try:
            text = Path(file).read_text(encoding="utf-8", errors="replace")
            work = Work()
            for name, finding in _typed(read(text).get("findings"), dict, "table of findings").items():
                proof = finding.get("proof") if isinstance(finding, dict) else None
                if isinstance(proof, dict) and proof.get("format") == FORMAT:
                    shown = decide(proof, work)
                    found += 1
                    print(f"{file!a} {name!a}: holds, {shown.leaves} boxes: {shown.statement}")
                elif proof is not None:
                    print(f"{file!a} {name!a}: a proof of another kind, see wspd check")
        except (Refused, OSError) as reason:
            good = False
            print(f"{file!a}: refused: {reason if isinstance(reason, Refused) else 'it cannot be read'}")
    return 1 if not good else 0 if found else 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
