"""The valve near an equilibrium: averaged, and as it fills and vents within a sample; T_F and T_V may differ.

A duty u fills for u h and vents for (1 - u) h. With the share T of T_max the average is bilinear,

    T' = u (1 - T)/T_F - (1 - u) T/T_V,

and a deviation t of T around a torque that a duty holds follows t' = -a t + b du with

    b = (1 - T)/T_F + T/T_V,   a = 1/(T_F T_V b),

both between the smaller and the larger of 1/T_F and 1/T_V.

Exactly, T runs in each sample from its foot to the crest c = (1 - A)/(1 - A B), A = exp(-u h/T_F),
B = exp(-(1 - u) h/T_V), and back. A duty that is larger by du moves the crest by h du: the torque is larger by
h J du from there on, J = (1 - c)/T_F + c/T_V. With w the change of the sliding speed per second that a deviation of the
torque makes, y' = q y - w, one sample makes of (y, w), with q constant within it,

    y <- E y - D w - j r dU,   w <- A B w + j dU,   j = h J B,

where dU is du times the change of the sliding speed per second that T_max makes, and

    E = exp(q h),   r = integral from 0 to (1 - u) h of exp((q + 1/T_V) s) ds,

    D = integral of exp(q (h - s)) times the decay of w up to s, so that D(q, 1/fastest) <= D <= D(q, 1/slowest) with
    D(q, z) = (exp(q h) - exp(-z h))/(q + z).
"""

from fractions import Fraction
from itertools import product
from typing import NamedTuple, TypeAlias

from wspd_design.certificates.kernel.arb import Ball, above, below, point

Interval: TypeAlias = tuple[Fraction, Fraction]

DUTIES: Interval = (Fraction(0), Fraction(1))


class Times(NamedTuple):
    """Ranges of the time constants [s]."""

    fill: Interval
    vent: Interval


class Sample(NamedTuple):
    """Ranges of the numbers of a sample, rounded outwards."""

    kept_slide: Interval  # -, E
    by_torque: Interval  # s, D
    kept_torque: Interval  # -, A B
    by_duty: Interval  # -, j
    delay: Interval  # s, r


def rates(times: Times) -> Interval:
    """Smallest and largest rate of the averaged valve [1/s]."""
    return 1 / max(times.fill[1], times.vent[1]), 1 / min(times.fill[0], times.vent[0])


def sample_of(times: Times, poles: Interval, span: Fraction, duties: Interval = DUTIES) -> Sample:
    """Enclose the numbers of a sample.

    Parameters
    ----------
    times : Times
        Of the valve [s].
    poles : tuple of Fraction
        Range of q [1/s].
    span : Fraction
        Sample time h [s].
    duties : tuple of Fraction
        Range of the duty u that holds the torque [-].
    """
    kept_torque, by_duty = _valve(times, span, duties)
    slow, fast = rates(times)
    low, high = poles
    h = point(span)
    return Sample(
        kept_slide=_hull([(point(q) * h).exp() for q in poles]),
        by_torque=_outward(_forced(low, fast, span), _forced(high, slow, span)),
        kept_torque=kept_torque,
        by_duty=by_duty,
        delay=_outward(
            _grown(low + 1 / times.vent[1], (1 - duties[1]) * span),
            _grown(high + 1 / times.vent[0], (1 - duties[0]) * span),
        ),
    )


def _valve(times: Times, span: Fraction, duties: Interval) -> tuple[Interval, Interval]:
    """Enclose A B and j, in which no pole stands."""
    h = point(span)
    fills, vents, shares = (
        dict.fromkeys(each) for each in (times.fill, times.vent, duties)
    )  # known ones once
    corners = [(point(f), point(v), point(u)) for f, v, u in product(fills, vents, shares)]
    # The exponent is affine in u, 1/T_F and 1/T_V; the crest rises with u and T_V and falls with T_F.
    kept = [(-u * h / f - (1 - u) * h / v).exp() for f, v, u in corners]
    crests = [_crest(f, v, u, h) for f, v, u in corners]
    venting = [(-(1 - point(u)) * h / point(v)).exp() for v, u in product(vents, shares)]
    low_crest, high_crest = _hull(crests)
    slopes = [
        (1 - point(c)) / point(f) + point(c) / point(v)
        for c, f, v in product((low_crest, high_crest), fills, vents)
    ]
    (least, most), (kept_least, kept_most) = _hull(slopes), _hull(venting)
    by_duty = _outward(h * point(least) * point(kept_least), h * point(most) * point(kept_most))
    return _hull(kept), by_duty


def may_hold(times: Times, span: Fraction, duties: Interval, share: Ball) -> bool:
    """Whether a share of T_max may lie between foot and crest for some duty of a range; the times are known."""
    fill, vent, h = point(times.fill[0]), point(times.vent[0]), point(span)
    low, high = (point(each) for each in duties)
    foot = _crest(fill, vent, low, h) * (-(1 - low) * h / vent).exp()
    return not (foot > share or _crest(fill, vent, high, h) < share)


def _crest(fill: Ball, vent: Ball, duty: Ball, h: Ball) -> Ball:
    """Largest share of T_max in a sample that repeats itself."""
    filling, venting = duty * h / fill, (1 - duty) * h / vent
    return (-filling).expm1() / (-filling - venting).expm1()


def _forced(q: Fraction, rate: Fraction, span: Fraction) -> Ball:
    """Return D(q, rate): what a torque that decays at a rate adds to the slide over a span."""
    return (-point(rate) * point(span)).exp() * _grown(q + rate, span)


def _grown(rate: Fraction, span: Fraction) -> Ball:
    """Integral of exp(rate s) from 0 to a span [s]."""
    return (point(rate) * point(span)).expm1() / point(rate) if rate else point(span)


def _hull(found: list[Ball]) -> Interval:
    return Fraction(min(map(below, found))), Fraction(max(map(above, found)))


def _outward(low: Ball, high: Ball) -> Interval:
    return Fraction(below(low)), Fraction(above(high))
