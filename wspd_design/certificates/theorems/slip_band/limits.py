"""What keeps the state where the law is the written one, pulses end in their sample, and torque and room are left."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from wspd_design.certificates.kernel.arb import Ball, ends_of, point
from wspd_design.certificates.setting.declared_law import LEAST
from wspd_design.certificates.theorems.slip_band.proof import Choice
from wspd_design.certificates.theorems.slip_band.pulses import Pulses
from wspd_design.certificates.theorems.slip_band.statement import BandLaw
from wspd_design.certificates.theorems.slip_band.wants import Curve, Row, Wants


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """A linear function of the state and what it must not exceed."""

    what: str
    row: Row
    bound: Ball


def within_pulses(
    pulses: Sequence[Pulses], lengths: Sequence[Ball], wants: Sequence[Wants], times: Ball
) -> tuple[Limit, ...]:
    """Keep all that is wanted within some times what pulses of each kind do, of a length over the sample time."""
    return tuple(
        _in_time(each, longest, one, times)
        for each, longest in zip(pulses, lengths, strict=True)
        for one in wants
    )


def _in_time(pulses: Pulses, longest: Ball, wants: Wants, times: Ball) -> Limit:
    asked, beside, part = *wants, times * pulses.part(longest)
    ways = tuple(each + (part - 1) * (k == 3) for k, each in enumerate(asked))
    if pulses.rises < 0:
        return Limit(
            what="what filling adds in its longest pulse", row=ways, bound=part * pulses.height[0] - beside[1]
        )
    return Limit(
        what="what venting takes off in its longest pulse",
        row=tuple(-each for each in ways),
        bound=part * pulses.height[0] + beside[0],
    )


def below_curve(law: BandLaw, curve: Curve | None) -> tuple[Limit, ...]:
    """Keep the predicted error within some times that at which the braking curve begins."""
    if curve is None:
        return ()
    return (
        Limit(
            what="the beginning of the braking curve" if curve.times == 1 else "errors on the braking curve",
            row=curve.predicted(law),
            bound=curve.times * curve.error - curve.beside[1],
        ),
    )


def room_left(
    law: BandLaw,
    choice: Choice,
    supply: Fraction,
    held: Ball,
    falling: Ball,
) -> tuple[Limit, ...]:
    """Keep observed friction and torque above 0, and room for what the brake may add.

    Parameters
    ----------
    law : BandLaw
        Its numbers.
    choice : Choice
        Longest pulse, and the error that errors are counted from.
    supply : Fraction
        Least share of the full pressure.
    held : ball
        Torque that holds the reference, over the inertia of the law [rad/s2].
    falling : ball
        Deceleration of the reference [rad/s2].
    """
    h = point(law.sample_time)
    least_held, most_held = ends_of(h * held)
    full = h * point(law.full_torque) / point(law.inertia)
    least, room = point(LEAST) * full, point(supply) * full - most_held
    venting, filling = (-h * point(choice.pulse) / point(each) for each in (law.vent_time, law.fill_time))
    zero = point(0)
    return (
        Limit(
            what="the observed friction above 0",
            row=(zero, zero, point(-1), zero, zero),
            bound=least_held - ends_of(h * falling)[1],
        ),
        Limit(
            what="the torque that is left",
            row=(zero, zero, zero, point(-1), zero),
            bound=least_held - least / venting.exp(),
        ),
        Limit(
            what="the torque that the brake can add",
            row=(zero, zero, zero, point(1), zero),
            bound=room - least / filling.exp(),
        ),
        Limit(
            what="the room that a rising supply asks for",
            row=(zero, zero, zero, point(1), zero),
            bound=room - point(choice.room) * (1 - point(supply)) * full,
        ),
    )
