"""A conclusion of the paper and what the numbers say about it."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum


class Verdict(Enum):
    """What the numbers say about a conclusion."""

    HOLDS = "holds"
    PARTLY = "holds in part"
    FAILS = "does not hold"


class Topic(Enum):
    """What a conclusion is about."""

    RANKING = "The ranking of Table 10"
    SLIP = "The slip"
    LAW = "The adaptive fuzzy law"
    SETTING = "What was simulated and measured"


@dataclass(frozen=True, slots=True, kw_only=True)
class Conclusion:
    """A conclusion of the paper with what our stops say about it."""

    name: str
    topic: Topic
    claim: str  # in the paper's sense, and where it stands
    place: str
    verdict: Verdict
    rule: str  # when it would hold
    finding: str  # the numbers, and why


def verdict(parts: Sequence[bool]) -> Verdict:
    """Judge by parts: all of them hold, some or none."""
    if all(parts):
        return Verdict.HOLDS
    return Verdict.PARTLY if any(parts) else Verdict.FAILS


def extent(values: Sequence[float], places: int) -> str:
    """Write the range of values with fixed decimals, once where its ends agree."""
    low, high = f"{min(values):.{places}f}", f"{max(values):.{places}f}"
    return low if low == high else f"{low} to {high}"
