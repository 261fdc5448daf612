"""What is known about an obligation, and what a search or a file states about it.

A :class:`Finding` holds only what the checkers made of a :class:`Stated`; the same code makes it when a search has
just ended and when a file is read years later.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import inf, isfinite, nextafter
from typing import Any

from wspd_design.certificates.records import Interval, Range, Status

Place = Mapping[str, float]
"""Value of each free quantity by its name [SI units]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How hard a search tried: hearsay, on which no verdict rests."""

    boxes: int = 0
    undecided: float = 0.0  # share of the box that was left open
    cut: bool = False  # whether its budget ended it
    ended: Mapping[str, Any] = field(default_factory=dict)  # JSON, where it ended, as its check writes it


@dataclass(frozen=True, slots=True, kw_only=True)
class Stated:
    """What a search, or a file, states about an obligation; nothing of it is believed."""

    proof: Mapping[str, Any] | None = None  # JSON
    place: Place = field(default_factory=dict)  # where the tightest value, or a counterexample, lies
    numbers: Mapping[str, float] = field(default_factory=dict)  # of samples that nothing can check again
    effort: Effort = field(default_factory=Effort)


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What is known about an obligation.

    For an inequality ``low`` and ``high`` enclose the extreme of its expression: the end on the side of the bound is
    proved (infinite if nothing is), the other one is attained at ``place``.
    """

    status: Status  # PROVED, REFUTED, UNDECIDED or EVIDENCE
    asked: str  # in words
    shown: str = ""  # what the checker saw proved, in words
    relation: str = ""
    limit: Fraction = Fraction(0)  # bound that was asked for
    low: float = -inf
    high: float = inf
    unit: str = ""
    values: Place = field(default_factory=dict)  # of every variable at the place, known numbers among them
    part: tuple[float, float] | None = None  # range of the quantity on which it is proved [SI units]
    numbers: Mapping[str, float] = field(
        default_factory=dict
    )  # that a checker computed, or that samples gave
    ranges: tuple[Interval, ...] = ()  # of all that the statement which was shown uses
    leaves: int = 0  # boxes that the checker decided
    stated: Stated = field(default_factory=Stated)

    @property
    def place(self) -> Place:
        """Where the attained end lies [SI units]."""
        return self.stated.place

    @property
    def effort(self) -> Effort:
        """What the search says of itself."""
        return self.stated.effort

    @property
    def proved(self) -> bool:
        """Whether a proof was accepted, of whatever bound."""
        return bool(self.shown)

    @property
    def margin(self) -> Range:
        """Distance of the extreme from the bound that was asked for, positive where the claim holds."""
        low, high = (self.low, self.high) if self.relation == "<=" else (-self.high, -self.low)
        limit = self.limit if self.relation == "<=" else -self.limit
        return Range(
            low=below(limit - Fraction(high)) if isfinite(high) else None,
            high=above(limit - Fraction(low)) if isfinite(low) else None,
            unit=self.unit,
        )


def below(rational: Fraction) -> float:
    """Return the nearest double that does not exceed a rational."""
    near = float(rational)
    return near if Fraction(near) <= rational else nextafter(near, -inf)


def above(rational: Fraction) -> float:
    """Return the nearest double that a rational does not exceed."""
    near = float(rational)
    return near if Fraction(near) >= rational else nextafter(near, inf)
