"""What a drift of the reference brings along: all that one and the same change of its acceleration moves.

Over a sample w_r' changes by the integral of w_r''. With t the drift of the reference, h times that change,

    the torque that holds the reference drifts by -t/g beside what the friction does,
    in the mean by -t m/g, m the share that a steady drift counts in its mean,
    w_r by t/2 more than h w_r', and
    the lag of the filtered acceleration by (1 - (1 - kept)/2) t.

The first is so for any course of w_r''. The others weigh w_r'' within the sample, and are so if it does not change
there. Let h^2 w_r'' stay within +-r of something that is constant over the sample. A weight W differs from its mean by
some |W - mean W| in the mean, and what is weighed by at most r times that: 1/4 for W from 1 to 0 at a steady rate,
(1 - kept)/4 for one from 1 to kept, and 1/2 for any that falls from 1 to 0, at most 2 M (1 - M) with the mean M. So one
disturbance stands for all of these, and what numbers of a cell differ from their middle by is left beside it.
"""

from typing import NamedTuple

from wspd_design.certificates.kernel.arb import Ball, ball, ends_of, point
from wspd_design.certificates.setting.slip_loop import DISTURBANCES


class Brought(NamedTuple):
    """What is left of other disturbances beside what comes with the drift of the reference [rad/s], and that."""

    torque: Ball  # of the torque drift
    mean_torque: Ball  # of the mean torque drift
    mean_reference: Ball  # of the mean reference drift
    lag: Ball  # of the lag drift
    shares: tuple[Ball, ...]  # -, what a reference drift of 1 brings along of each disturbance


def brought_along(
    turning: Ball, beside: Ball, idle: Ball, seen: tuple[Ball, Ball], filtered: Ball
) -> Brought:
    """Return what comes with the drift of the reference, and what is left.

    Parameters
    ----------
    turning : ball
        Drift of the reference [rad/s].
    beside : ball
        The same, less something that is constant over a sample [rad/s].
    idle : ball
        Assumed over true effect of the torque, 1/g [-].
    seen : tuple of ball
        Share that a steady drift counts in its mean, and the number that stands for it [-].
    filtered : ball
        Part of its error that the filter of the acceleration corrects in a sample, 1 - kept [-].
    """
    (half_way, counted), middle = seen, point(idle.mid())
    low, high = ends_of(beside)
    aside = (high - low) / 2 * ball(-1, 1)
    shares = {
        "torque drift": -middle,
        "mean torque drift": -middle * counted,
        "mean reference drift": point(1) / 2,
        "lag drift": 1 - filtered / 2,
    }
    return Brought(
        torque=(middle - idle) * turning,
        mean_torque=(middle * counted - idle * half_way) * turning + idle * aside / 2,
        mean_reference=aside / 4,
        lag=filtered * aside / 4,
        shares=tuple(shares.get(name, point(0)) for name in DISTURBANCES),
    )
