"""Formulas in plain sentences: ``eta/g <= u* <= T_max`` in the words of a check becomes typeset mathematics.

Checks, reasons of gains and theorems write their formulas in ASCII, so that a terminal and a file can show them.
A small grammar finds them: sums, products, relations, calls and signs of single letters, Greek names and the
subscripts of both. What does not parse stays as it stands, so that a sentence is never worse for it.
"""

import re
from dataclasses import dataclass
from functools import lru_cache

from wspd_design.reporting.formula_symbols import accented, symbol_of
from wspd_design.reporting.numbers import scientific
from wspd_design.reporting.text import Inline, Math, Text, spoken

FUNCTIONS = {
    **{
        name: name
        for name in ("exp", "ln", "sin", "cos", "tan", "tanh", "coth", "det", "sup", "inf", "abs", "sqrt")
    },
    **{name: f'op("{name}")' for name in ("sat", "sgn", "atan", "trace", "min", "max")},
}
RELATIONS = {"<=": "<=", ">=": ">=", "!=": "!=", "->": "->", "=": "=", "<": "<", ">": ">"}
WORDS_OF_ONE_LETTER = ("a", "A", "I")
LABEL = re.compile(r"\((?:\d+|\d* ?[a-d])\)")  # of an equation or a table
UNITS = re.compile(
    r"(?:1/)?(?:\(?(?:kN|MN|N|kg|MPa|Pa|bar|rad|km/h|km|mm|m|ms|s|Hz|J|dB|deg|t)(?:\^?[23²³])?\)?(?:[ /]?(?=\S))?)+"
    r"(?: per (?:MN m|kN m))?(?=[\s,;:.)\]]|$)"
)
LONG = 34  # characters of a formula that has to fit into a line of a phone; a longer one breaks before its relations

_TOKEN = re.compile(
    r"(?P<number>\d+(?:\.\d+)?(?:e[+-]?\d+)?)"
    r"|(?P<name>[A-Za-z\u0370-\u03ff\u016b]+\d*(?:_[A-Za-z0-9]+)*)"
    r"|(?P<sign><=|>=|!=|->|[-+*/^()|,'~<>=])"
    r"|(?P<space> )"
)
_START = re.compile(r"(?<![\w.'^~*/)\]-])(?=[A-Za-z\u0370-\u03ff\u016b(|]|-\S|\d)")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Token:
    kind: str
    text: str
    start: int
    end: int


def with_formulas(sentence: str) -> Text:
    """Return a plain sentence with its formulas as mathematics, and its numbers and units as people write them.

    Parameters
    ----------
    sentence : str
        Words with formulas in ASCII, such as those of a certificate.

    Returns
    -------
    Text
        The same words; a formula is read aloud as it stood.
    """
    return _parted(sentence)


@lru_cache(maxsize=4096)
def _parted(sentence: str) -> tuple[Inline, ...]:
    spans: list[Inline] = []
    shown = position = 0
    while (found := _START.search(sentence, position)) is not None:
        start = found.start()
        formula = _Parser(sentence, start).formula()
        if formula is None:
            position = _past(sentence, start)
            continue
        source, end = formula
        if start > shown:
            spans.append(readable(sentence[shown:start]))
        spans += _broken(source, sentence[start:end])
        shown = position = end
        unit = UNITS.match(sentence, end + 1) if re.match(r"\d ", sentence[end - 1 :]) else None
        position = unit.end() if unit else end
    if shown < len(sentence):
        spans.append(readable(sentence[shown:]))
    return tuple(spans)


def _past(sentence: str, start: int) -> int:
    """Return where to look on: behind a number with its unit, or behind the word that begins here."""
    label = LABEL.match(sentence, start)
    if label:
        return label.end()
    number = re.compile(r"[-+]?\d[\d.]*(?:e[+-]?\d+)?(?: to -?\d[\d.]*(?:e[+-]?\d+)?)?").match(
        sentence, start
    )
    if number and number.end() > start:
        unit = (
            UNITS.match(sentence, number.end() + 1)
            if sentence[number.end() : number.end() + 1] == " "
            else None
        )
        return unit.end() if unit else number.end()
    word = re.compile(r"[A-Za-z\u0370-\u03ff\u016b0-9_]+").match(sentence, start)
    return word.end() if word else start + 1


def _broken(source: str, written: str) -> list[Inline]:
    """Return one formula, or several if it is too long for a line: each further one begins with its relation."""
    sides = re.split(r" (?=(?:<=|>=|!=|->|[<>=]) )", source)
    if len(source) <= LONG or len(sides) == 1:
        return [Math(source=source, spoken=spoken(written))]
    words = re.split(r" (?=(?:<=|>=|!=|->|[<>=]) )", written)
    if len(words) != len(sides):
        return [Math(source=source, spoken=spoken(written))]
    found: list[Inline] = []
    for side, word in zip(sides, words, strict=True):
        found += [" "] if found else []
        found.append(Math(source=side, spoken=spoken(word)))
    return found


def readable(words: str) -> str:
    """Write the numbers and units of plain words as people do: minus signs, powers of ten, superscripts."""
    for written, sign in (("+-", "±"), ("<=", "≤"), (">=", "≥"), ("!=", "≠"), ("->", "→")):
        words = words.replace(written, sign)
    words = re.sub(
        r"(?<![\w.])([-+]?\d+(?:\.\d+)?)e([+-]?\d+)\b",
        lambda found: scientific(found[1], int(found[2])),
        words,
    )
    words = re.sub(r"(?<![\w.)])-(?=\d)|(?<=\s)-(?=\s)", "\N{MINUS SIGN}", words)
    words = re.sub(r"\b(m|s|rad|N)\^?([2346])\b", lambda found: found[1] + "  ²³⁴ ⁶"[int(found[2])], words)
    return re.sub(r"\boo\b", "∞", words)


class _Stop(Exception):
    """What follows is no part of a formula."""


class _Parser:
    """Recursive descent over one sentence from one place on; it remembers where the last whole formula ended."""

    def __init__(self, sentence: str, start: int) -> None:
        self.sentence, self.start, self.at = sentence, start, start
        self.depth = 0
        self.operators = self.marked = self.symbols = 0

    def formula(self) -> tuple[str, int] | None:
        """Return the Typst source of the formula that begins here and its end, or nothing."""
        best: tuple[str, int] | None = None
        source = ""
        try:
            while True:
                source += self._sum()
                if self._whole():
                    best = source, self.at
                relation = self._relation()
                if not relation:
                    break
                self.operators += 1
                source += f" {relation} "
        except _Stop:
            pass
        return best

    def _whole(self) -> bool:
        """Whether what was read is mathematics and not a word, a number or the beginning of a name."""
        written = self.sentence[self.start : self.at]
        after = self.sentence[self.at : self.at + 2]
        if re.match(r"[\w~]|\.\w|-[A-Za-z]", after) or not self.symbols:
            return False
        unit = UNITS.match(written)
        if unit and unit.end() == len(written) and len(written) > 1:
            return False
        if self.operators or self.marked:
            return True
        before = self.sentence[: self.start]
        return written not in (*WORDS_OF_ONE_LETTER, "m") and not re.search(r"(?:\d|[kMm]N|per|kg) $", before)

    def _next(self) -> _Token | None:
        found = _TOKEN.match(self.sentence, self.at)
        if found is None or found.lastgroup is None:
            return None
        return _Token(kind=found.lastgroup, text=found[0], start=found.start(), end=found.end())

    def _peek(self) -> _Token | None:
        """Return the next token behind at most one space, without taking it."""
        found = self._next()
        if found is not None and found.kind == "space":
            match = _TOKEN.match(self.sentence, found.end)
            if match is None or match.lastgroup in (None, "space"):
                return None
            return _Token(kind=str(match.lastgroup), text=match[0], start=match.start(), end=match.end())
        return found

    def _take(self, *signs: str) -> str:
        found = self._peek()
        if found is None or found.kind != "sign" or found.text not in signs:
            return ""
        self.at = found.end
        return found.text

    def _relation(self) -> str:
        before = self.at
        sign = self._take(*RELATIONS)
        if sign and self._peek() is None:
            self.at = before
            return ""
        return RELATIONS.get(sign, "")

    def _sum(self) -> str:
        source = "-" if (sign := self._take("-", "+")) == "-" else "+" if sign else ""
        source += self._product()
        while True:
            following = self._peek()
            if following is None or following.text not in ("+", "-") or not self._spaced(following):
                return source
            state = self._state()
            sign = self._take("+", "-")
            try:
                self.operators += 1
                source += f" {sign} {self._product()}"
            except _Stop:
                self._back(state)
                return source

    def _spaced(self, sign: _Token) -> bool:
        """Whether a sign between two terms has space on both sides or on none; a hyphen of words has not."""
        left = self.sentence[sign.start - 1 : sign.start] == " "
        right = self.sentence[sign.end : sign.end + 1] == " "
        return left == right

    def _product(self) -> str:
        source = self._power()
        while True:
            state = self._state()
            try:
                if self._next_is("/"):
                    self._take("/")
                    self.operators += 1
                    source += rf"\/{self._power(divisor=True)}"
                elif self._next_is("*"):
                    self._take("*")
                    self.operators += 1
                    source += f" {self._power()}"
                elif self._juxtaposed():
                    self.operators += 1
                    source += f" {self._power()}"
                else:
                    return source
            except _Stop:
                self._back(state)
                return source

    def _state(self) -> tuple[int, int, int, int, int]:
        return self.at, self.depth, self.operators, self.marked, self.symbols

    def _back(self, state: tuple[int, int, int, int, int]) -> None:
        """Forget what was read since a state; within parentheses nothing is whole before they close."""
        self.at, self.depth, self.operators, self.marked, self.symbols = state
        if self.depth:
            raise _Stop

    def _next_is(self, sign: str) -> bool:
        found = self._next()
        return found is not None and found.text == sign

    def _juxtaposed(self) -> bool:
        """Whether a further factor follows behind a space or in parentheses."""
        found = self._peek()
        if found is None or (found.kind == "sign" and found.text not in ("(", "|")):
            return False
        if found.text == "(":
            return LABEL.match(self.sentence, found.start) is None
        if found.text == "|":
            return self.depth == 0 or self.sentence[self.at : self.at + 1] == " "
        if found.text in FUNCTIONS:
            return self.sentence[found.end : found.end + 1] == "(" or found.text in ("sup", "inf")
        if found.kind == "number" or symbol_of(found.text) is None:
            return False
        if self.depth == 0:
            unit = UNITS.match(self.sentence, found.start)
            if self.sentence[self.at - 1].isdigit() and unit and unit[0].strip():
                return False
            if found.text == "a":
                return re.match(r" ?[-+*/<>=^']", self.sentence[found.end : found.end + 2]) is not None
        return True

    def _power(self, *, divisor: bool = False) -> str:
        source = self._atom(divisor=divisor)
        if self._next_is("^"):
            self._take("^")
            source += f"^({self._exponent()})"
        return source

    def _exponent(self) -> str:
        if self._next_is("("):
            return self._parenthesis()[1:-1]
        sign = self._take("-")
        return sign + self._atom(divisor=False)

    def _parenthesis(self) -> str:
        self._take("(")
        self.depth += 1
        source = self._sum()
        while self._take(","):
            source += f", {self._sum()}"
        if not self._take(")"):
            raise _Stop
        self.depth -= 1
        return f"({source})"

    def _atom(self, *, divisor: bool) -> str:
        found = self._peek()
        if found is None:
            raise _Stop
        if found.text == "(":
            if LABEL.match(self.sentence, found.start):
                raise _Stop
            return self._parenthesis()
        if found.text == "|":
            return self._magnitude()
        if found.kind == "number":
            self.at = found.end
            mantissa, _, exponent = found.text.partition("e")
            return f"{mantissa} dot 10^({int(exponent)})" if exponent else mantissa
        if found.kind != "name":
            raise _Stop
        name = found.text
        if name in FUNCTIONS:
            return self._call(found)
        rate = name == "slip" and self.sentence[found.end : found.end + 1] == "'"
        symbol = symbol_of("lambda" if rate else name)
        if symbol is None:
            if divisor and self.depth == 0 and len(name) > 3 and name.isalpha():
                self.at = found.end
                return f'"{name}"'
            raise _Stop
        if (
            self.depth == 0
            and divisor
            and re.fullmatch(r"s[23]?|m[23]?", name)
            and self.sentence[self.at - 1] == "/"
        ):
            before = self.sentence[: self.at - 1]
            if re.search(r"(?:\d|\bkm|\bm|\bN|\brad|\bkN) ?\d?$", before) and not re.search(
                r"[A-Za-z_]\d$", before
            ):
                raise _Stop  # a unit, such as 1/s
        self.at = found.end
        self.symbols += 1
        self.marked += symbol.marked
        return self._marks(symbol.source)

    def _call(self, found: _Token) -> str:
        """Read a function with its argument in parentheses, or before a product as in ``sup abs(r)``."""
        if self.sentence[found.end : found.end + 1] != "(":
            if found.text not in ("sup", "inf") or not re.match(r" (?:\(|abs\()", self.sentence[found.end :]):
                raise _Stop
            self.at = found.end
            self.operators += 1
            return f"{FUNCTIONS[found.text]} {self._power()}"
        self.at = found.end
        self.marked += 1
        return f"{FUNCTIONS[found.text]}{self._parenthesis()}"

    def _magnitude(self) -> str:
        self._take("|")
        self.depth += 1
        source = self._sum()
        if not self._take("|"):
            raise _Stop
        self.depth -= 1
        self.marked += 1
        return f"abs({source})"

    def _marks(self, source: str) -> str:
        """Read what stands behind a symbol: ``~``, a star, a prime, the argument of a function."""
        if self._next_is("~"):
            self.at += 1
            self.marked += 1
            source = accented("tilde", source)
        if self.sentence[self.at : self.at + 1] == "^" and not re.match(
            r"\^[\w(*-]", self.sentence[self.at :]
        ):
            self.at += 1
            self.marked += 1
            source = accented("hat", source)
        star = re.match(r"\^?\*(?![\w(|])", self.sentence[self.at :])
        if star:
            self.at += star.end()
            self.marked += 1
        if self.sentence[self.at : self.at + 1] == "'":
            transposed = re.match(r"'[a-z]\b", self.sentence[self.at :])
            self.at += 1
            self.marked += 1
            if transposed:
                return f"{source}^({'* ' if star else ''}top) "  # of vectors, as in b*'w
            source = accented("dot", source)
        if star:
            source = f"{source}^*"
        if self.sentence[self.at : self.at + 1] == "(" and not source.startswith("dif"):
            return f"{source}{self._parenthesis()}"
        return source
