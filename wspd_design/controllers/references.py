"""The slip that a protection holds, over train speed.

The peak of the adhesion lies at a smaller slip the faster the train is, because friction falls with the sliding speed.
A slip that falls as 1/sqrt(v) follows it on all rails known here; a table follows that of one known rail.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple, Protocol, TypeAlias, get_args

from wspd_design.model.generated import slip_tracking
from wspd_design.model.number import Number, clip, maximum, minimum, sqrt, where
from wspd_design.parameters.loading import constants

ReferenceKind: TypeAlias = Literal["constant", "falling", "peak", "seeking"]
"""The same slip at all speeds; c/sqrt(v); the peak of the design rail; or a search for the peak."""

REFERENCE_KINDS: tuple[ReferenceKind, ...] = get_args(ReferenceKind)


class DesiredSlip(NamedTuple):
    """The desired slip at a train speed."""

    slip: Number  # -
    slope: Number  # s/m, its derivative in the train speed


class Reference(Protocol):
    """A desired slip over train speed."""

    def at(self, speed: Number, scale: Number) -> DesiredSlip:
        """Return the desired slip.

        Parameters
        ----------
        speed : number
            Of the train [m/s].
        scale : number
            What a search for the peak multiplies the slip by [-]; 1 without one.
        """


@dataclass(frozen=True, slots=True, kw_only=True)
class ConstantSlip:
    """The same slip at every speed."""

    slip: float  # -

    def at(self, speed: Number, scale: Number) -> DesiredSlip:  # noqa: ARG002 - at every speed
        """Return the slip."""
        return DesiredSlip(self.slip * scale, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class FallingSlip:
    """A slip that falls as 1/sqrt(v), with an upper limit for low speeds."""

    slip: float  # -, at 1 m/s if there were no limit
    largest: float  # -

    def at(self, speed: Number, scale: Number) -> DesiredSlip:
        """Return the slip and its slope, which is 0 where the limit holds."""
        speed = maximum(speed, constants().slip_regularization_speed)
        falling = self.slip * scale / sqrt(speed)
        slope = slip_tracking.falling_slope(speed, falling)
        return DesiredSlip(minimum(falling, self.largest), where(falling < self.largest, slope, 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class SlipTable:
    """Slips at rising speeds, straight lines between them; beyond the ends the last one stays."""

    speeds: tuple[float, ...]  # m/s
    slips: tuple[float, ...]  # -

    def at(self, speed: Number, scale: Number) -> DesiredSlip:
        """Interpolate."""
        slip: Number = self.slips[0]
        slope: Number = 0.0
        pairs = zip(pairwise(self.speeds), pairwise(self.slips), strict=True)
        for (low, high), (first, second) in pairs:
            rise = (second - first) / (high - low)
            slip = slip + rise * (clip(speed, low, high) - low)
            slope = where(speed > low, where(speed < high, rise, slope), slope)
        return DesiredSlip(slip * scale, slope * scale)
