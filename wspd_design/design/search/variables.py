"""The numbers of a design that a search varies, and the design that belongs to a point of the search."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from wspd_design.controllers.gains import SLIP_REFERENCE
from wspd_design.design.ranges import USUAL, SearchRange
from wspd_design.design.records import Design, GainValue
from wspd_design.parameters.errors import UserError


@dataclass(frozen=True, slots=True, kw_only=True)
class Variable:
    """A number that is varied: a gain, a factor on a gain, or the slip reference."""

    name: str
    unit: str
    low: float
    high: float
    start: float
    log: bool
    factor: bool  # on the value of the design that the search starts from
    why: str

    def value(self, share: float) -> float:
        """Return the number at a share of its range in [0, 1]."""
        if self.log:
            return math.exp(math.log(self.low) + share * (math.log(self.high) - math.log(self.low)))
        return self.low + share * (self.high - self.low)

    def share(self, value: float) -> float:
        """Return the share of the range at which a number lies, at most at its ends."""
        if self.log:
            share = (math.log(value) - math.log(self.low)) / (math.log(self.high) - math.log(self.low))
        else:
            share = (value - self.low) / (self.high - self.low)
        return min(max(share, 0.0), 1.0)


def variables_of(design: Design, ranges: Mapping[str, SearchRange]) -> tuple[Variable, ...]:
    """Return what a search may vary of a design.

    Parameters
    ----------
    design : Design
        Where the search starts.
    ranges : mapping
        Stated ranges by the name of the gain, or of the slip reference. If there are none, every gain that is a
        number above 0 gets the usual one.

    Raises
    ------
    UserError
        If nothing is left to vary.
    """
    found = []
    if not ranges:
        ranges = {
            gain.name: USUAL
            for gain in design.gains
            if isinstance(gain.value, float) and not isinstance(gain.value, bool) and gain.value > 0.0
        }
    for name, stated in ranges.items():
        value: GainValue = design.specification.slip if name == SLIP_REFERENCE else design.gain(name)
        unit = "-" if name == SLIP_REFERENCE or stated.relative else _unit(design, name)
        start = 1.0 if stated.relative else value
        assert isinstance(start, float), "a list of numbers has a relative range"
        found.append(
            Variable(
                name=name,
                unit=unit,
                low=stated.low,
                high=stated.high,
                start=start,
                log=stated.log,
                factor=stated.relative,
                why=stated.why,
            )
        )
    if not found:
        raise UserError(
            f"design {design.name} has no number that a search could vary; state a range for a gain"
        )
    return tuple(found)


def design_at(base: Design, variables: Sequence[Variable], values: Sequence[float]) -> Design:
    """Return the design with other values of its variables; the reasons stay those of the base."""
    changed = base
    for variable, value in zip(variables, values, strict=True):
        if variable.name == SLIP_REFERENCE:
            slip = value * base.specification.slip if variable.factor else value
            changed = replace(changed, specification=replace(changed.specification, slip=slip))
            continue
        old = base.gain(variable.name)
        new: GainValue = value
        if variable.factor:
            new = tuple(value * each for each in old) if isinstance(old, tuple) else value * float(old)
        gains = tuple(
            replace(each, value=new) if each.name == variable.name else each for each in changed.gains
        )
        changed = replace(changed, gains=gains)
    return changed


def _unit(design: Design, name: str) -> str:
    return next(gain.unit for gain in design.gains if gain.name == name)
