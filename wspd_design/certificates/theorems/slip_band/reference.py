"""The slip that a law holds in a window of speed, and how it and the wheel speed at it change with the train speed.

The wheel speed at the reference is w_r = (1 - slip) v/R. A slip c/sqrt(v^) goes by the speed v^ that the law has, which
is the true one times the nominal over the true radius. The law knows how that slip changes with the speed; beside that
the slip that is held may lie on either side of it and change at a bounded rate of which the law knows nothing, as it
does where the train speed that it is told is wrong.
"""

import math
from dataclasses import dataclass
from fractions import Fraction

from wspd_design.certificates.kernel.arb import Ball, above, ball, below, point
from wspd_design.certificates.theorems.slip_band.friction import Strip
from wspd_design.certificates.theorems.slip_band.statement import BandLaw, Interval
from wspd_design.parameters.bounds import Ends


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """What is held in a window, for some radii of the wheel."""

    slip: Ball  # -
    fall: Ball  # s/m, -d slip/dv, as far as the law knows it
    turning: Ball  # -, R dw_r/dv
    bend: Ball  # s/m, R d2w_r/dv2
    drift: Ball  # m/s2, slip' v of what the law does not know


def held_in(law: BandLaw, window: Ends, radius: Interval) -> Held:
    """Return what a law holds in a window of speed with wheels of a range of radii."""
    speed, aside = ball(*window), ball(-law.slip_error, law.slip_error)
    drift = ball(-law.slip_drift, law.slip_drift)
    if not law.falls:
        slip = point(law.slip) + aside
        return Held(slip=slip, fall=point(0), turning=1 - slip, bend=point(0), drift=drift)
    slowest, fastest = (
        point(law.slip) / (point(law.radius) / point(worn) * point(end)).sqrt()
        for end, worn in zip(window, radius[::-1], strict=True)
    )
    own = slowest.union(fastest)
    fall = own / speed / 2
    return Held(slip=own + aside, fall=fall, turning=1 - own / 2 - aside, bend=fall / 2, drift=drift)


def slips_held(law: BandLaw, window: Ends, radius: Interval) -> Ends:
    """Range of the slips that are held in a window [-]."""
    if not law.falls and not law.slip_error:
        return float(law.slip), float(law.slip)
    slip = held_in(law, window, radius).slip
    return below(slip), above(slip)


def slips_beside(law: BandLaw, window: Ends, radius: Interval, slowest: float, strip: Strip) -> Ends:
    """Range of the slips of errors in a strip, e R over the lowest speed, in a window.

    A wheel that turns faster than the train has the slope and the fading of one that slides as much the other way.
    """
    low, high = map(Fraction, slips_held(law, window, radius))
    beside = [end * Fraction(slowest) / Fraction(speed) for end in strip for speed in window]
    least, most = low - max(beside), high - min(beside)
    return max(below(point(max(least, -most))), 0.0), above(point(max(most, -least)))


def slip_at(law: BandLaw, speed: float, radius: float) -> float:
    """Slip that the law itself holds at a speed, with wheels of a radius [-]."""
    own = float(law.slip)
    return own / math.sqrt(speed * float(law.radius) / radius) if law.falls else own


def turning_at(law: BandLaw, speed: float, radius: float) -> float:
    """Part of a change of the train speed that the rims at the reference take part in [-]."""
    slip = slip_at(law, speed, radius)
    return 1.0 - (slip / 2.0 if law.falls else slip)


def reference_text(law: BandLaw) -> str:
    """Name the reference in words."""
    own = f"{float(law.slip):g}/sqrt(v), v in m/s" if law.falls else f"{float(law.slip):g}"
    if not law.slip_error:
        return own
    return (
        f"any reference slip that stays within {float(law.slip_error):g} of {own} and moves beside it no faster than "
        f"by {float(law.slip_drift):g} m/s2 over the train speed"
    )
