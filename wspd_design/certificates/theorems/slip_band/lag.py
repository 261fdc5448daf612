"""How the reference drifts where the slip is constant: partly as the torque does, and the filtered lag with it.

The friction that fades with the speed makes the train brake harder while it slows down, and it is the same friction
that moves the torque. While the train loses the speed y h in a sample, the held torque moves by the steady drift

    s = -h y (W g F - d),   F the change of the force over mu0 Q along the speeds w_r + E,

and the reference by the mean over the sample of h y j T (g (F + delta) + r). T is what it moves by for a change of
the deceleration, j how fast that changes over what it would with all wheels at the reference, where F is F + delta; r
comes from the running resistance. So for any k, it drifts by k s, and beside it by the mean of

    h y ((j T + k W) (g (F + delta) + r) - k W (g delta + r) - k d)

and by k times what s changes by until later in the sample. The proof states k over -T/W: 0 leaves all of it beside, 1
leaves what j differs from 1 by, and the numbers of the cell from their middle.
"""

from dataclasses import dataclass
from fractions import Fraction

from wspd_design.certificates.kernel.arb import Ball, ball, point
from wspd_design.certificates.theorems.slip_band.statement import JERK_FACTORS


@dataclass(frozen=True, slots=True, kw_only=True)
class Fading:
    """What fades while the train slows down."""

    pulled: Ball  # m/s2, deceleration by a friction of mu0 Q, g
    weight: Ball  # rad/m, torque of that friction over the inertia of the law, over that deceleration, W
    along: Ball  # s/m, change of the force over mu0 Q along the speeds w_r + E, F
    at_reference: Ball  # s/m, the same along the reference
    beside: Ball  # s/m, by how much that is more, delta
    damping: (
        Ball  # rad/(m s), what the wheel's damping takes off over the train speed and inertia of the law, d
    )
    resistance: Ball  # 1/s, change of the deceleration by the running resistance, r


def lag_of(fading: Fading, lag: Fraction, turned: Ball, loss: Ball, change: Ball) -> tuple[Ball, Ball]:
    """Return the share of the steady drift that the reference drifts by, and what it drifts by beside that [rad/s].

    Parameters
    ----------
    fading : Fading
        What fades.
    lag : Fraction
        Share of the reference's drift that is counted as one with the steady drift, about.
    turned : ball
        What the reference drifts by for a change of the train's deceleration, over h y, T [rad s/m].
    loss : ball
        Speed that the train loses in a sample, times the sample time, h y [m].
    change : ball
        What the steady drift changes by over a sample [rad/s].
    """
    share = -point(lag * Fraction(float((turned / fading.weight).mid())))
    jerk, kept = ball(*JERK_FACTORS) * turned, share * fading.weight
    rising = fading.pulled * fading.at_reference + fading.resistance
    # Both are the same number; the first is closer for a small share, the second where the drifts are nearly one.
    apart = jerk * rising + kept * fading.pulled * fading.along
    together = (jerk + kept) * rising - kept * (fading.pulled * fading.beside + fading.resistance)
    beside = apart.intersection(together) - share * fading.damping
    return share, loss * beside + share * change.union(point(0))
