#!/usr/bin/env python3
"""Decide about proofs, with python-flint and the standard library alone.

A proof is a JSON object: a *statement*, which says all that is claimed, and what it takes to see that it is true.
As a script, ``python checker.py NAME.certificates/*.json``, this file decides about every proof and needs nothing else
of the package; ``wspd check`` also makes every statement again from the design and compares.

An *inequality* states a formula, exact ranges of its variables, a relation and a bound. A formula is a list of steps,
each made of earlier ones: ``["x", name]``, ``["n", number]``, ``["add", i, j, ...]``, ``["mul", i, j, ...]``,
``["pow", i, exponent]``, ``["abs", i]``, ``["exp", i]``, ``["atan", i]``; the last step is the result. ``model`` is the
formula as the program computes it; ``form``, if it is there, the same function arranged so that its variables stand
in it as few times as possible (a number: see ``formulas``). The proof is a tree in preorder, one character per step:

* ``a``, ``b``, ...: the box is halved along the first, second, ... variable with a range; the lower half comes first;
* ``A``, ``B``, ...: the formula is monotone in this variable on the box, which is reduced to its worst face;
* ``.``: interval arithmetic shows the inequality on the box; ``~``: the mean value form does.

An *identity* states that two formulas are the same function, a *sign* that a number is positive; both are decided
without further proof. A decimal stands for the double that Python reads from it, exactly; ``p/q`` for the fraction.
"""

import json
import re
import sys
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import reduce
from hashlib import sha256
from math import ceil, isfinite
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from flint import arb, ctx, fmpq

FORMAT, FORMULAS = "wspd-proof/2", ("model", "form")
PRECISION, PRIME = 80, 2**255 - 19  # bits of a ball; of the field of identities
MOST_BYTES, MOST_DIGITS = 20_000_000, 2_000  # of a file, of a fraction
MOST_FREE, MOST_HALVINGS = 26, 400  # variables with a range, one letter each; of one box
MOST_STEPS, MOST_DEGREE, MOST_EXPONENT = 20_000, 10**9, 64  # of a formula, of a power in it
MOST_WORK = 25_000_000  # operations on intervals, of 1 to 2 us each
COSTS = {"n": 5, "abs": 2, "exp": 5, "atan": 5, "pow": 10}  # operations; of other steps one for each operand
DECIMAL = re.compile(r"-?[0-9]{1,40}(\.[0-9]{1,40})?(e[-+]?[0-9]{1,3})?")
RATIO = re.compile(rf"-?[0-9]{{1,{MOST_DIGITS}}}/[0-9]{{1,{MOST_DIGITS}}}")
WORDS = re.compile(r"[ -~]{1,300}")  # printable ASCII: no byte of a file steers a terminal

Ends: TypeAlias = tuple[Any, Any]  # balls around both ends of an interval: a ball alone would fail on 1 + x^2
Slopes: TypeAlias = dict[int, Ends]  # derivatives by the number of the variable, unless they are zero
Box: TypeAlias = list[tuple[Any, Any]]  # exact ends of every variable (fmpq)
Formula: TypeAlias = Sequence[Sequence[Any]]
ZERO, ONE, MINUS = ((arb(n), arb(n)) for n in (0, 1, -1))
RISING = {"exp": arb.exp, "log": arb.log, "atan": arb.atan}


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
    """What a proof shows, in words, and how many boxes were decided."""

    statement: str
    leaves: int


def decide(proof: object, work: Work) -> Shown:
    """Decide about one proof from JSON, which may be anything; refuse it if it does not show its statement."""
    content = _typed(proof, dict, "proof")
    if content.get("format") != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    statement = _typed(content.get("statement"), dict, "statement")
    match statement.get("kind"):
        case "inequality":
            given, tree = _Inequality(statement), _typed(content.get("tree"), str, "tree")
            with ctx.workprec(PRECISION):
                return Shown(given.words(), _replay(given, tree, work))
        case "identity":
            one, other = (_formula(statement.get(key)) for key in ("left", "right"))
            if not same(one, other, work):
                raise Refused("the two formulas are not the same function")
            return Shown(_words(statement.get("name"), "name"), 1)
        case "sign":
            name, unit = (_words(statement.get(key), key) for key in ("name", "unit"))
            if not (found := number(statement.get("value"))) > 0:
                raise Refused(f"{name} = {float(found):.6g} is not positive")
            return Shown(f"{name} = {float(found):.6g} {unit} > 0".replace(" - ", " "), 1)
        case _:
            raise Refused("the statement is of no known kind")


def value(statement: Mapping[str, Any], at: Mapping[str, Fraction], work: Work) -> tuple[Fraction, Fraction]:
    """Enclose the model formula of an inequality at one point of its box; where it divides by zero, the form."""
    given = _Inequality(statement)
    box: Box = []
    for name, low, high in given.free:
        if not low <= at[name] <= high:
            raise Refused(f"{name} = {float(at[name]):g} lies outside the box")
        box.append((fmpq(*at[name].as_integer_ratio()),) * 2)
    with ctx.workprec(PRECISION):
        found, _ = Program(given.model, given.variables, work).run(_ends(box))
        if not finite(found) and given.model is not given.form and same(given.form, given.model, work):
            found, _ = Program(given.form, given.variables, work).run(_ends(box))
        if not finite(found):
            raise Refused("the formula is not defined at this point")
        ends = (found[0].lower().man_exp(), found[1].upper().man_exp())
        low, high = (Fraction(int(mantissa)) * Fraction(2) ** int(power) for mantissa, power in ends)
        return low, high


class _Inequality:
    """An inequality as it is stated, read with care."""

    def __init__(self, statement: Mapping[str, Any]) -> None:
        self.name, self.unit = (_words(statement.get(key), key) for key in ("name", "unit"))
        self.relation = statement.get("relation")
        if self.relation not in ("<=", ">="):
            raise Refused("the statement has no relation")
        self.bound = number(statement.get("bound"))
        rows = [_typed(row, list, "row") for row in _typed(statement.get("variables"), list, "variables")]
        if any(len(row) != 4 for row in rows):
            raise Refused("a variable is not [name, low, high, unit]")
        self.variables = [(_words(row[0], "name"), number(row[1]), number(row[2])) for row in rows]
        names = {_words(row[0], "name") for row in rows if _words(row[3], "unit")}
        if len(names) < len(rows) or any(low > high for _, low, high in self.variables):
            raise Refused("two variables have the same name, or a range is reversed")
        self.free = [(name, low, high) for name, low, high in self.variables if low < high]
        if len(self.free) > MOST_FREE:
            raise Refused(f"more than {MOST_FREE} variables have a range")
        self.model = _formula(statement.get("model"), names)
        self.form = _formula(statement["form"], names) if "form" in statement else self.model

    def words(self) -> str:
        """Return the inequality in words."""
        ranges = [f"{name} {float(a):g} to {float(b):g}" for name, a, b in self.free]
        where = f" for all {', '.join(ranges)}" if ranges else ""
        return f"{self.name} {self.relation} {float(self.bound):.17g} {self.unit}".removesuffix(" -") + where


def _replay(given: _Inequality, tree: str, work: Work) -> int:
    """Walk the tree and return the number of leaves, or refuse."""
    if given.form is not given.model and not same(given.form, given.model, work):
        raise Refused("the arranged form of the formula is not the model's")
    program = Program(given.form, given.variables, work)
    letters, leaves = {chr(ord("a") + k): k for k in range(len(given.free))}, 0
    root: Box = [(fmpq(*a.as_integer_ratio()), fmpq(*b.as_integer_ratio())) for _, a, b in given.free]
    waiting: list[tuple[Box, int, list[Ends] | None]] = [(root, 0, None)]
    for position, step in enumerate(tree):
        if not waiting:
            raise Refused(f"the tree goes on after its last leaf, at step {position}")
        work.spend(4 + 4 * len(root))
        box, halvings, slopes = waiting.pop()
        if step in ".~":
            if not _holds(given, program, box, mean_value=step == "~"):
                raise Refused(f"leaf {leaves} does not satisfy the inequality")
            leaves += 1
        elif step in letters:
            if halvings >= MOST_HALVINGS:
                raise Refused(f"a box is halved more than {MOST_HALVINGS} times")
            low, high = box[k := letters[step]]
            middle = (low + high) / 2
            for half in ((middle, high), (low, middle)):
                waiting.append(([*box[:k], half, *box[k + 1 :]], halvings + 1, slopes))
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
        _, slopes = program.run(_ends(box), derivatives=True)
        middles = [(low + high) / 2 for low, high in box]
        found, _ = program.run(_ends([(middle, middle) for middle in middles]))
        for k, (low, high) in enumerate(box):
            found = add(found, mul(slopes[k], *_ends([(low - middles[k], high - middles[k])])))
    else:
        found, _ = program.run(_ends(box))
    bound, _ = exactly(given.bound)
    return finite(found) and bool(found[1] <= bound if given.relation == "<=" else found[0] >= bound)


def _worst_face(
    given: _Inequality, program: "Program", box: Box, k: int, slopes: list[Ends] | None
) -> tuple[Box, list[Ends]]:
    """Reduce a box to the worst end of one variable; slopes that were enclosed on a larger box hold here as well."""
    if slopes is None or _sign(slopes[k]) == 0:
        _, slopes = program.run(_ends(box), derivatives=True)
    sign = _sign(slopes[k])
    if sign == 0:
        raise Refused(f"the formula is not monotone in {given.free[k][0]} on a box")
    end = box[k][1] if (sign > 0) == (given.relation == "<=") else box[k][0]
    return [*box[:k], (end, end), *box[k + 1 :]], slopes


def _sign(x: Ends) -> int:
    """1 or -1 if an interval certainly has no number of the other sign, else 0."""
    return 1 if x[0] >= 0 else -1 if x[1] <= 0 else 0


class Program:
    """A formula on intervals, with forward derivatives; what no free variable enters is done beforehand."""

    def __init__(self, formula: Formula, variables: Sequence[tuple[str, Fraction, Fraction]], work: Work):
        work.spend(cost(formula))
        self.known: dict[int, Ends] = {}
        self.steps: list[tuple[int, str, Sequence[int], Any]] = []
        self.result, self.work = len(formula) - 1, work
        fixed = {name: low for name, low, high in variables if low == high}
        free = {name: k for k, name in enumerate(name for name, low, high in variables if low < high)}
        for place, (name, *operands) in enumerate(formula):
            extra: Any = None
            if name == "n" or (name == "x" and operands[0] in fixed):
                self.known[place] = exactly(operands[0] if name == "n" else fixed[operands[0]])
                continue
            if name in ("x", "pow"):
                operands, extra = ([], free[operands[0]]) if name == "x" else (operands[:1], operands[1])
            if operands and all(k in self.known for k in operands):
                self.known[place], _ = _apply(name, [(self.known[k], {}) for k in operands], extra)
            else:
                self.steps.append((place, name, operands, extra))
        used = {self.result, *(k for _, _, operands, _ in self.steps for k in operands)}
        self.known = {k: ends for k, ends in self.known.items() if k in used}
        once = cost([[name, *operands] for _, name, operands, _ in self.steps]) + len(self.known) // 4
        self.costs = once, 2 * once + len(free) * sum(len(operands) for _, _, operands, _ in self.steps)

    def run(self, ends: list[Ends], *, derivatives: bool = False) -> tuple[Ends, list[Ends]]:
        """Enclose the value and, if asked, the slope along every variable."""
        self.work.spend(self.costs[derivatives])
        done: dict[int, tuple[Ends, Slopes]] = {k: (found, {}) for k, found in self.known.items()}
        for place, name, operands, extra in self.steps:
            if name == "x":
                done[place] = ends[extra], {extra: ONE} if derivatives else {}
            else:
                done[place] = _apply(name, [done[k] for k in operands], extra)
        found, slope = done[self.result]
        if derivatives and not finite(found):
            raise Refused("the formula is not defined on a box where its slope is used")
        return found, [slope.get(k, ZERO) for k in range(len(ends))]


def _apply(name: str, operands: list[tuple[Ends, Slopes]], exponent: Any) -> tuple[Ends, Slopes]:
    """Do one operation on intervals and their slopes."""
    x, dx = operands[0]
    if name == "add":
        for y, dy in operands[1:]:
            x, dx = add(x, y), _plus(dx, dy) if dx and dy else dx or dy
    elif name == "mul":
        for k, (y, dy) in enumerate(operands[1:]):
            dx = _plus(_times(dx, y), _times(dy, x)) if dx or dy else dx
            x = sqr(x) if k == 0 and operands[1] is operands[0] else mul(x, y)
    elif name == "pow":
        dx = _times(dx, mul(exactly(exponent), power(x, exponent - 1))) if dx else dx
        x = power(x, exponent)
    elif name == "abs":
        sign = ONE if x[0] >= 0 else MINUS if x[1] <= 0 else (arb(-1), arb(1))  # of either side
        x, dx = magnitude(x), _times(dx, sign)
    elif name == "exp":
        x = rising("exp", x)
        dx = _times(dx, x)
    else:
        x, dx = rising("atan", x), _times(dx, inverse(add(ONE, sqr(x))))
    return x, dx


def rising(name: str, x: Ends) -> Ends:
    """Return a rising function of an interval."""
    return RISING[name](x[0]), RISING[name](x[1])


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
    if exponent.denominator > 1:
        return rising("exp", mul(exactly(exponent), rising("log", x))) if x[0] > 0 else inverse(ZERO)
    whole = exponent.numerator
    if whole < 0:
        return inverse(power(x, -exponent))
    if whole == 0:
        return add(ONE, mul(ZERO, x))
    low, high = magnitude(x) if whole % 2 == 0 else x
    return low**whole, high**whole


def _plus(x: Slopes, y: Slopes) -> Slopes:
    return {**x, **y, **{k: add(x[k], y[k]) for k in x.keys() & y.keys()}}


def _times(slope: Slopes, factor: Ends) -> Slopes:
    return {k: mul(each, factor) for k, each in slope.items()}


def exactly(rational: Fraction) -> Ends:
    """Interval of one rational."""
    return (arb(fmpq(*rational.as_integer_ratio())),) * 2


def finite(x: Ends) -> bool:
    """Whether an interval has two finite ends."""
    return bool(x[0].is_finite() and x[1].is_finite())


def _ends(box: Box) -> list[Ends]:
    return [(arb(low), arb(high)) for low, high in box]


def cost(formula: Formula) -> int:
    """Count the operations of a formula."""
    return sum(COSTS.get(name, len(operands)) for name, *operands in formula)


def same(one: Formula, other: Formula, work: Work) -> bool:
    """Whether two formulas are the same function wherever both are defined: values at a point of a prime field.

    Different functions agree with a probability below 1e-60. What is not rational becomes an element by its argument.
    """
    work.spend(cost(one) + cost(other))
    return _residue(one) == _residue(other)


def _residue(formula: Formula) -> int:
    found: list[int] = []
    for name, *operands in formula:
        if name == "x":
            found.append(element("x", operands[0]))
        elif name == "n":
            found.append(operands[0].numerator * pow(operands[0].denominator, -1, PRIME) % PRIME)
        elif name == "add":
            found.append(sum(found[k] for k in operands) % PRIME)
        elif name == "mul":
            found.append(reduce(lambda product, k: product * found[k] % PRIME, operands, 1))
        elif name == "pow":
            found.append(_residue_power(found[operands[0]], operands[1]))
        else:  # the magnitude does not know the sign of its argument
            found.append(element(name, pow(found[operands[0]], 2 if name == "abs" else 1, PRIME)))
    return found[-1]


def _residue_power(base: int, exponent: Fraction) -> int:
    """Integer powers by themselves; a fractional exponent leaves an element for its part between 0 and 1."""
    if base == 0:
        raise Refused("the identity cannot be decided: a base vanishes")
    whole, rest = divmod(exponent, 1)
    return pow(base, whole, PRIME) * (element("pow", base, rest) if rest else 1) % PRIME


def element(*content: object) -> int:
    """Pseudo-random element of the field that stands for its content."""
    return int.from_bytes(sha256(repr(content).encode()).digest() * 2, "big") % PRIME


def number(written: object) -> Fraction:
    """Read an exact number."""
    if isinstance(written, str) and DECIMAL.fullmatch(written) and isfinite(float(written)):
        return Fraction(float(written))
    if isinstance(written, str) and RATIO.fullmatch(written):
        above, below = (int(each) for each in written.split("/"))
        if below % PRIME and abs(above) < below * 10**300:
            return Fraction(above, below)
    raise Refused("something stands in place of a number")


def _formula(stated: object, names: set[str] | None = None) -> list[list[Any]]:
    """Read a formula; without ``names`` every variable is allowed."""
    steps = _typed(stated, list, "formula")
    if not 0 < len(steps) <= MOST_STEPS:
        raise Refused("a formula is empty or too long")
    read = [_step(_typed(step, list, "step of a formula"), place, names) for place, step in enumerate(steps)]
    degrees: list[int] = []
    for name, *operands in read:
        below = [degrees[k] for k in operands if type(k) is int] or [1]
        factor = ceil(abs(operands[1])) if name == "pow" else 1
        degrees.append(max(1, factor) * (sum(below) if name == "mul" else max(below)))
    if max(degrees) > MOST_DEGREE:
        raise Refused(f"the degree of a formula is above {MOST_DEGREE}, so that its numbers become too long")
    return read


def _step(step: list[Any], place: int, names: set[str] | None) -> list[Any]:
    name, *operands = step or [None]
    earlier = all(type(k) is int and 0 <= k < place for k in operands[: 1 if name == "pow" else None])
    alone = len(operands) == 1
    if name == "x" and alone and (names is None or _words(operands[0], "variable") in names):
        return ["x", _words(operands[0], "variable")]
    if name == "n" and alone:
        return ["n", number(operands[0])]
    if name == "pow" and len(operands) == 2 and earlier and abs(number(operands[1])) <= MOST_EXPONENT:
        return ["pow", operands[0], number(operands[1])]
    if operands and earlier and (name in ("add", "mul") or (alone and name in ("abs", "exp", "atan"))):
        return step
    raise Refused(f"a formula has an unknown step at {place}")


def _words(stated: object, what: str) -> str:
    if not isinstance(stated, str) or not WORDS.fullmatch(stated):
        raise Refused(f"a {what} is not a short text")
    return stated


def _typed(stated: object, kind: type, what: str) -> Any:
    if not isinstance(stated, kind):
        raise Refused(f"the {what} is missing or of another kind")
    return stated


def read(text: str) -> Mapping[str, Any]:
    """Read one JSON object in which no name stands twice, with formulas in place of their numbers, or refuse."""
    found: list[dict[str, Any]] = []

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found.append(dict(pairs))
        if len(found[-1]) < len(pairs):
            raise Refused("a name stands twice in the file")
        return found[-1]

    try:
        if len(text) <= MOST_BYTES:
            content = _typed(json.loads(text, object_pairs_hook=once), dict, "JSON object")
            formulas = dict(enumerate(_typed(content.pop("formulas", []), list, "table of formulas")))
            for each, key in (
                (each, key) for each in found for key in FORMULAS if type(each.get(key)) is int
            ):
                each[key] = formulas.get(each[key])
            return dict(content)
    except (ValueError, RecursionError) as error:
        raise (error if isinstance(error, Refused) else Refused("the file is not complete JSON")) from None
    raise Refused("the file is too long")


def main(files: Sequence[str]) -> int:
    """Decide about the proofs of certificate files; 1 if a file is refused, else 3 if no proof is found, else 0."""
    shown: list[Shown | None] = []
    for file in files:
        try:
            work, text = Work(), Path(file).read_text(encoding="utf-8", errors="replace")
            for name, finding in _typed(read(text).get("findings"), dict, "table of findings").items():
                proof = finding.get("proof") if isinstance(finding, dict) else None
                if isinstance(proof, dict) and proof.get("format") == FORMAT:
                    shown.append(found := decide(proof, work))
                    print(f"{file!a} {name!a}: holds, {found.leaves} boxes: {found.statement}")
        except (Refused, OSError) as reason:
            shown.append(None)
            print(f"{file!a}: refused: {reason if isinstance(reason, Refused) else 'it cannot be read'}")
    return 1 if None in shown else 0 if shown else 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
