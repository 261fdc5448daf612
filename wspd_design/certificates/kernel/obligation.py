"""A statement that a check must establish, derived from the design alone.

An obligation decides about what is *stated* about it, by a search that has just ended or by a file, and returns a
finding. It refuses what is false or belongs to another statement; where nothing is stated, nothing is known.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from math import isfinite
from typing import Any, Protocol, TypeAlias

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import FORMAT, Refused, Work
from wspd_design.certificates.kernel.claim import Claim, steps_of
from wspd_design.certificates.kernel.finding import Finding, Place, Stated, above, below
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Interval, Status

Ends: TypeAlias = tuple[float, float]
Numbers: TypeAlias = Mapping[str, float]


class Obligation(Protocol):
    """What all kinds of obligations have in common."""

    @property
    def key(self) -> str:
        """Name in the theorem and in the file."""

    @property
    def text(self) -> str:
        """What is asked, in words."""

    def decide(self, stated: Stated, work: Work) -> Finding:
        """Decide about what is stated, or raise :class:`Refused`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inequality:
    """An inequality on a box.

    Every bound may be proved; one at least as tight as the claim's makes the finding PROVED, a place where the
    expression certainly lies beyond it makes it REFUTED.
    """

    key: str
    claim: Claim

    @property
    def text(self) -> str:
        """The inequality in words."""
        return self.claim.in_words()

    def decide(self, stated: Stated, work: Work) -> Finding:
        """Let the checker decide about the proof, and evaluate the place."""
        return _decide(self.claim, self.text, stated, work)


@dataclass(frozen=True, slots=True, kw_only=True)
class OnPart:
    """An inequality on a range of one quantity that the search chooses and the proof names.

    A smaller range proves less, never anything false; a range that is a single value proves nothing.
    """

    key: str
    claim: Callable[[Ends], Claim]  # of the range [SI units]
    quantity: str
    within: Ends

    @property
    def text(self) -> str:
        """The inequality in words."""
        return f"{self.claim(self.within).in_words()} on a range of {self.quantity}"

    def decide(self, stated: Stated, work: Work) -> Finding:
        """Read the range from the proof, or take the whole one, and decide about the claim there."""
        part = self.within if stated.proof is None else self._part(stated.proof)
        return replace(_decide(self.claim(part), self.text, stated, work), part=part)

    def _part(self, proof: Mapping[str, Any]) -> Ends:
        try:
            variables = {name: (low, high) for name, low, high, _ in proof["statement"]["variables"]}
            low, high = (checker.number(each) for each in variables[self.quantity])
        except (KeyError, TypeError, ValueError):
            raise Refused(f"the proof states no range of {self.quantity}") from None
        if not Fraction(self.within[0]) <= low < high <= Fraction(self.within[1]):
            raise Refused(f"the proof speaks about a range of {self.quantity} that is not part of the domain")
        return float(low), float(high)


@dataclass(frozen=True, slots=True, kw_only=True)
class Identity:
    """Two SymPy expressions are the same function wherever both are defined."""

    key: str
    text: str
    left: Any
    right: Any

    def statement(self) -> dict[str, Any]:
        """Return what is claimed as the checker reads it."""
        sides = {"left": self.left, "right": self.right}
        written = {name: [list(step) for step in steps_of(side)] for name, side in sides.items()}
        return {"kind": "identity", "name": self.text, **written}

    def decide(self, stated: Stated, work: Work) -> Finding:
        """Decide in a prime field; a residual that does not vanish refutes the identity."""
        return _exact(self.text, self.statement(), stated, work)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sign:
    """A number is greater than zero."""

    key: str
    quantity: str
    value: Fraction
    unit: str

    @property
    def text(self) -> str:
        """What is asked, with the number."""
        return f"{self.quantity} = {float(self.value):.6g} {self.unit}".removesuffix(" -") + " > 0"

    def statement(self) -> dict[str, Any]:
        """Return what is claimed as the checker reads it."""
        return {"kind": "sign", "name": self.quantity, "value": text(self.value), "unit": self.unit}

    def decide(self, stated: Stated, work: Work) -> Finding:
        """Compare."""
        return _exact(self.text, self.statement(), stated, work)


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """A condition that the design alone decides."""

    key: str
    text: str
    holds: bool

    def decide(self, stated: Stated, work: Work) -> Finding:  # noqa: ARG002 - nothing is left to do
        """Return what the design says; a file has nothing to state about it."""
        if stated != Stated():
            raise Refused(f"the file states something about {self.key}, which the design alone decides")
        status = Status.PROVED if self.holds else Status.REFUTED
        return Finding(status=status, asked=self.text, shown=self.text if self.holds else "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Special:
    """A statement with a checker of its own.

    ``check`` takes the proof, returns the numbers that it shows, or refuses. ``evaluate`` takes a place, returns what
    is certainly true there and denies the statement, or refuses. Either may be missing.
    """

    key: str
    text: str
    check: Callable[[Mapping[str, Any], Work], Numbers] | None = None
    evaluate: Callable[[Place, Work], Numbers] | None = None
    within: Mapping[str, Ends] | None = None  # where a place may lie [SI units]

    def decide(self, stated: Stated, work: Work) -> Finding:
        """Let the checker of its own decide."""
        if stated.proof is not None:
            if self.check is None or stated.place:
                raise Refused(f"no proof can show {self.key}")
            found = _sound(partial(self.check, stated.proof, work), self.key)
            return Finding(
                status=Status.PROVED, asked=self.text, shown=self.text, numbers=found, leaves=1, stated=stated
            )
        if stated.place:
            if self.evaluate is None:
                raise Refused(f"no place can deny {self.key}")
            self._inside(stated.place)
            found = _sound(partial(self.evaluate, stated.place, work), self.key)
            return Finding(status=Status.REFUTED, asked=self.text, numbers=found, stated=stated)
        return Finding(status=Status.UNDECIDED, asked=self.text, stated=stated)

    def _inside(self, place: Place) -> None:
        within = self.within or {}
        if place.keys() != within.keys():
            raise Refused(f"the place of {self.key} must name {', '.join(within)} and nothing else")
        for name, (low, high) in within.items():
            if not low <= place[name] <= high:
                raise Refused(f"the place of {self.key} leaves the domain: {name} = {place[name]:g}")


def _sound(work_out: Callable[[], Numbers], key: str) -> Numbers:
    """Return what a checker computes; numbers of a file at which its arithmetic ends are refused."""
    try:
        return work_out()
    except ArithmeticError as error:
        raise Refused(f"what is stated about {key} cannot be computed: {type(error).__name__}") from None


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampled:
    """Something that samples or a simulation support: EVIDENCE, which no checker looks at again."""

    key: str
    text: str
    names: tuple[str, ...]  # of the numbers that it states
    holds: Callable[[Numbers], bool]

    def decide(self, stated: Stated, work: Work) -> Finding:  # noqa: ARG002 - there is nothing to check
        """Judge the numbers that are stated."""
        if stated.proof is not None or stated.place:
            raise Refused(f"nothing can prove or deny {self.key}")
        if not stated.numbers:
            return Finding(status=Status.UNDECIDED, asked=self.text, stated=stated)
        if stated.numbers.keys() != set(self.names) or not all(map(isfinite, stated.numbers.values())):
            raise Refused(f"the numbers of {self.key} must be {', '.join(self.names)}")
        status = Status.EVIDENCE if self.holds(stated.numbers) else Status.UNDECIDED
        return Finding(status=status, asked=self.text, numbers=stated.numbers, stated=stated)


def proof_of(claim: Claim | Identity | Sign, tree: str | None = None) -> dict[str, Any]:
    """Return the JSON object of a proof."""
    proof = {"format": FORMAT, "statement": claim.statement()}
    return proof if tree is None else proof | {"tree": tree}


def _exact(asked: str, statement: Mapping[str, Any], stated: Stated, work: Work) -> Finding:
    """Decide about what needs no search, whether or not the file holds the statement."""
    if stated.place or (
        stated.proof is not None and stated.proof != {"format": FORMAT, "statement": statement}
    ):
        raise Refused(f"the file states something else than: {asked}")
    try:
        shown = checker.decide({"format": FORMAT, "statement": statement}, work)
    except Refused:
        if stated.proof is not None:
            raise
        return Finding(status=Status.REFUTED, asked=asked, stated=stated)
    if stated.proof is None:
        return Finding(status=Status.UNDECIDED, asked=asked, stated=stated)
    return Finding(status=Status.PROVED, asked=asked, shown=shown.statement, leaves=1, stated=stated)


def _decide(claim: Claim, asked: str, stated: Stated, work: Work) -> Finding:
    """Decide about an inequality from its proof and the place of its tightest value."""
    low, high, shown, leaves = -float("inf"), float("inf"), "", 0
    ranges: tuple[Interval, ...] = ()
    enough = denied = False
    if stated.proof is not None:
        proved = _with_bound(claim, stated.proof)
        if stated.proof.get("statement") != proved.statement():
            raise Refused(f"the proof belongs to another statement than: {asked}")
        leaves = checker.decide(dict(stated.proof), work).leaves
        shown, ranges = proved.in_words(), proved.ranges()
        enough = proved.bound <= claim.bound if claim.relation == "<=" else proved.bound >= claim.bound
        if claim.relation == "<=":
            high = above(proved.bound)
        else:
            low = below(proved.bound)
    if stated.place:
        if stated.place.keys() != {v.name for v in claim.free}:
            raise Refused(f"the place must name {', '.join(v.name for v in claim.free)} and nothing else")
        exact = {name: Fraction(each) for name, each in stated.place.items() if isfinite(each)}
        if len(exact) < len(stated.place):
            raise Refused("the place has a coordinate that is not finite")
        least, most = checker.value(claim.statement(), exact, work)
        denied = least > claim.bound if claim.relation == "<=" else most < claim.bound
        if claim.relation == "<=":
            low = below(least)
        else:
            high = above(most)
    status = Status.PROVED if enough else Status.REFUTED if denied else Status.UNDECIDED
    return Finding(
        status=status,
        asked=asked,
        shown=shown,
        relation=claim.relation,
        limit=claim.bound,
        low=low,
        high=high,
        unit=claim.unit,
        values={v.name: stated.place.get(v.name, float(v.low)) for v in claim.variables}
        if stated.place
        else {},
        ranges=ranges,
        leaves=leaves,
        stated=stated,
    )


def _with_bound(claim: Claim, proof: Mapping[str, Any]) -> Claim:
    """Return the claim with the bound that a proof states."""
    statement = proof.get("statement")
    if not isinstance(statement, Mapping):
        raise Refused("the proof has no statement")
    return replace(claim, bound=checker.number(statement.get("bound")))
