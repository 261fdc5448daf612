"""The range of each uncertain number of a record, by its name."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from wspd_design.parameters.errors import UserError

Ends: TypeAlias = tuple[float, float]
"""Lower and upper end, in SI units."""


@dataclass(frozen=True, slots=True, eq=False)
class Bounds(Mapping[str, Ends]):
    """A frozen mapping from names to ranges; two with the same ranges are equal and have the same hash.

    Parameters
    ----------
    entries : tuple
        Pairs of name and ends; :meth:`of` takes a mapping.

    Raises
    ------
    UserError
        If an end is not finite, the ends are reversed, or a name stands twice.
    """

    entries: tuple[tuple[str, Ends], ...] = ()

    def __post_init__(self) -> None:
        """Refuse what is not a range, and keep one order of the names."""
        for name, (low, high) in self.entries:
            if not (math.isfinite(low) and math.isfinite(high)):
                raise UserError(f"bounds of {name} = ({low:g}, {high:g}) must be two finite numbers")
            if low > high:
                raise UserError(
                    f"bounds of {name} = ({low:g}, {high:g}) are reversed; write the smaller one first"
                )
        if len({name for name, _ in self.entries}) < len(self.entries):
            raise UserError(f"bounds name a quantity twice: {', '.join(name for name, _ in self.entries)}")
        object.__setattr__(self, "entries", tuple(sorted(self.entries)))

    @classmethod
    def of(cls, ranges: Mapping[str, Ends]) -> "Bounds":
        """Return the bounds that a mapping states."""
        return cls(tuple(ranges.items()))

    def __hash__(self) -> int:
        """Hash of the ranges; equality is that of mappings."""
        return hash(self.entries)

    def __getitem__(self, name: str) -> Ends:
        """Return the range of a number."""
        for known, ends in self.entries:
            if known == name:
                return ends
        raise KeyError(name)

    def __iter__(self) -> Iterator[str]:
        """Run over the names."""
        return (name for name, _ in self.entries)

    def __len__(self) -> int:
        """Count the numbers with a range."""
        return len(self.entries)

    def __or__(self, others: Mapping[str, Ends]) -> "Bounds":
        """Return these bounds with others in addition or in place of them."""
        return Bounds.of({**self, **others})

    def around(self, name: str, value: float) -> Ends:
        """Return the range of a number; one without bounds is taken as exactly known."""
        return self.get(name, (value, value))


EXACT = Bounds()
"""No number varies."""
