"""Search for the peak of the adhesion, shared by all wheelsets of a vehicle; experimental.

At each moment half of the wheelsets hold a little more slip than the reference and half a little less. Where those with
more slip find more friction, the reference grows for all. Both halves run on the same rail at the same speed, so that
what changes with them does not count, and they change places after each half period, so that their loads do not
either. Nothing is learned from wheelsets that do not hold their slip.
"""

from dataclasses import dataclass
from typing import NamedTuple

from wspd_design.controllers.protocol import State
from wspd_design.model.number import Number, clip, exp, maximum, where

_YES = 0.5
_LEAST = 0.3  # of the amplitude, that the slips of both halves must differ by


class Shown(NamedTuple):
    """What a wheelset shows."""

    friction_torque: Number  # N m
    slip: Number  # -, as it is
    holds: Number  # 1 where it holds its slip, and its sensor is well


class _Search(NamedTuple):
    """State of the search."""

    log_scale: Number  # of the reference
    time: Number  # s, in this half period
    side: Number  # 1 or -1: which half holds more slip
    gained: Number  # sum of the relative differences of the friction
    spread: Number  # sum of the relative differences of the slip
    counted: Number  # samples in them


@dataclass(frozen=True, slots=True, kw_only=True)
class PeakSeeking:
    """The search and its numbers."""

    sample_time: float  # s
    amplitude: float  # -, of the logarithm of the slip
    half_period: float  # s
    gain: float  # -, change of the logarithm per relative slope of the friction
    bias: float  # -, slope that is sought: above 0 the search stays on the side of small slips
    settling: float = 0.45  # of a half period, which does not count
    most: float = 0.7  # of the logarithm, in both directions
    largest_step: float = 0.2  # of the logarithm

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of the state."""
        return tuple(f"seeking_{name}" for name in _Search._fields)

    def start(self) -> State:
        """Start with the reference as it is."""
        return (0.0, 0.0, 1.0, 0.0, 0.0, 0.0)

    def step(self, state: State, shown: tuple[Shown, ...]) -> tuple[State, tuple[Number, ...]]:
        """Learn from what the wheelsets show, and return the scale of the reference of each."""
        search = _Search(*state)
        time = search.time + self.sample_time
        friction, slip, both = _differences(shown)
        counts = where(time > self.settling * self.half_period, both, 0.0)
        gained = search.gained + counts * search.side * friction
        spread = search.spread + counts * search.side * slip
        counted = search.counted + counts
        over = time >= self.half_period
        side = where(over, -search.side, search.side)
        # A whole period ends where the halves are about to hold their first sides again.
        whole = where(over, side > 0.0, False)
        # The slip follows its reference late. Friction is divided by the difference of the slips that there were, and
        # both are counted by the side of the references, which know no noise.
        least = _LEAST * self.amplitude * maximum(counted, 1.0)
        slope = gained / maximum(spread, least)
        step = clip(self.gain * (slope - self.bias), -self.largest_step, self.largest_step)
        moved = search.log_scale + where(spread > least, where(counted > 0.0, step, 0.0), 0.0)
        moved = clip(moved, -self.most, self.most)
        search = _Search(
            log_scale=where(whole, moved, search.log_scale),
            time=where(over, 0.0, time),
            side=side,
            gained=where(whole, 0.0, gained),
            spread=where(whole, 0.0, spread),
            counted=where(whole, 0.0, counted),
        )
        return tuple(search), tuple(
            exp(search.log_scale + _half(axle) * side * self.amplitude) for axle in range(len(shown))
        )


def _differences(shown: tuple[Shown, ...]) -> tuple[Number, Number, Number]:
    """Relative differences of the mean friction and the mean slip of both halves, and 1 if both are there."""
    sums = {half: [_total(shown, half, field) for field in range(3)] for half in (1.0, -1.0)}
    (friction, slip, number), (friction_2, slip_2, number_2) = sums[1.0], sums[-1.0]
    friction, slip = friction / maximum(number, 1.0), slip / maximum(number, 1.0)
    friction_2, slip_2 = friction_2 / maximum(number_2, 1.0), slip_2 / maximum(number_2, 1.0)
    both = where(number > _YES, where(number_2 > _YES, 1.0, 0.0), 0.0)
    return (
        (friction - friction_2) / maximum(friction + friction_2, 1.0),
        (slip - slip_2) / maximum(slip + slip_2, 1e-3),
        both,
    )


def _total(shown: tuple[Shown, ...], half: float, field: int) -> Number:
    """Sum of a field over the wheelsets of a half that hold their slip; of the last field, their number."""
    total: Number = 0.0
    for axle, wheel in enumerate(shown):
        if _half(axle) == half:
            total = total + wheel.holds * (1.0 if field == 2 else wheel[field])
    return total


def _half(axle: int) -> float:
    """Half of a wheelset: of four the outer two and the inner two, which load transfer leaves equal."""
    return 1.0 if axle % 4 in (0, 3) else -1.0
