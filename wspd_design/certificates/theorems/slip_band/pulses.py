"""Pulses of the valve as the law inverts it: parts of a way that they go, their share in the mean, and their length."""

from dataclasses import dataclass
from fractions import Fraction

from wspd_design.certificates.kernel.arb import Ball, ends_of, hull_of, point
from wspd_design.certificates.setting.slip_loop import LoopLaw, Pair, parts_of
from wspd_design.certificates.theorems.slip_band.statement import BandLaw


@dataclass(frozen=True, slots=True, kw_only=True)
class Pulses:
    """Pulses of one kind; they go a part of a height: that of the supply above the torque, or of the torque above 0."""

    parts: Pair  # -, rho
    speedups: Pair  # -, assumed over true time of the valve
    time: Ball  # -, that the inversion assumes, over the sample time
    height: Pair  # rad/s, at the torque that holds the reference
    rises: int  # with Y: 1 or -1

    def part(self, length: Ball) -> Ball:
        """Part of the height that a pulse of a length over the sample time takes."""
        return -(-length / self.time).expm1()


def loop_law(law: BandLaw) -> LoopLaw:
    """Numbers of the law in balls."""
    h = point(law.sample_time)
    return LoopLaw(
        sample_time=h,
        gain=point(law.approach_rate) * h,
        ahead=point(law.ahead),
        pole=(-point(law.observer_rate) * h).exp(),
        kept=(-h / point(law.acceleration_time)).exp(),
    )


def pulses_of(
    law: BandLaw, times: tuple[Ball, Ball], pulse: Fraction, added: Ball, supplied: Ball, held: Ball
) -> tuple[Pulses, Pulses]:
    """Return pulses that fill and pulses that vent.

    Parameters
    ----------
    law : BandLaw
        Its numbers.
    times : tuple of ball
        Of filling and venting [s].
    pulse : Fraction
        Longest one over the sample time.
    added : ball
        What a rising supply adds to a way that fills, over the way.
    supplied, held : ball
        Torque of the supply, and the one that holds, over the inertia of the law [rad/s2].
    """
    h, assumed = point(law.sample_time), (law.fill_time, law.vent_time)
    longest = point(pulse * law.sample_time) / point(min(assumed))
    speedups = [ends_of(point(each) / true) for each, true in zip(assumed, times, strict=True)]
    filling, venting = (hull_of(parts_of(each, longest)) for each in speedups)
    fill, vent = (point(each) / h for each in assumed)
    return (
        Pulses(
            parts=ends_of(filling.union(filling * (1 + added))),
            speedups=speedups[0],
            time=fill,
            height=ends_of(h * (supplied - held)),
            rises=-1,
        ),
        Pulses(parts=ends_of(venting), speedups=speedups[1], time=vent, height=ends_of(h * held), rises=1),
    )


def seen_of(law: BandLaw, pulse: Fraction) -> Pair:
    """Return the part of the wanted way in the mean torque, which the law works out with the nominal times."""
    longest = point(pulse * law.sample_time) / point(min(law.fill_time, law.vent_time))
    share = point(law.time_share)
    low, high = parts_of((share, share), longest)
    return ends_of(hull_of((low * (1 - point(pulse) / 2), high)))  # the way is gone at least evenly
