"""What the weights of the mended adaptive fuzzy law keep, whatever the surface does; from its gains alone.

See docs/theory.md#fuzzy-sector.
"""

from fractions import Fraction

from wspd_design.certificates.kernel.arb import Ball, above, point
from wspd_design.controllers.fuzzy_surface import FuzzySurface, FuzzySurfaceGains
from wspd_design.model.generated.fuzzy_loop import largest_drive


def adapts_within_a_sample(core: FuzzySurface) -> bool:
    """Whether no step of the adaptation overshoots what it moves to."""
    gains, h = core.gains, Fraction(core.sample_time)
    parts = [h * Fraction(rate) * Fraction(gains.leakage) for rate in (gains.weight_rate, gains.bound_rate)]
    return all(part <= 1 for part in parts)


def against_the_center(core: FuzzySurface) -> float | None:
    """Return by how much a weight can take the sign opposite to the center of its rule; None if nothing bounds that.

    A rule at center 0 has no side of its own: its weight is bounded on both.
    """
    gains = core.gains
    first = zip(gains.centres, gains.initial_weights, strict=True)
    if not adapts_within_a_sample(core) or not gains.leakage > 0.0 or len(set(gains.widths)) != 1:
        return None
    if any(weight * center < 0.0 for center, weight in first):
        return None
    found = [_driven(gains, own, side) for own in gains.centres for side in (1.0, -1.0) if own * side <= 0.0]
    if any(each is None for each in found):
        return None
    at_center = [
        abs(weight)
        for center, weight in zip(gains.centres, gains.initial_weights, strict=True)
        if center == 0.0
    ]
    return max([above(each) for each in found if each is not None] + at_center)


def _driven(gains: FuzzySurfaceGains, own: float, side: float) -> Ball | None:
    """Bound what a surface on one side drives the weight of a rule to that does not lie there; None without a bound."""
    others = [side * center for center in gains.centres if side * center > side * own]
    numbers = [point(each) for each in (gains.widths[0], gains.layer, gains.leakage)]
    bounds = [largest_drive(point(side * own), point(other), *numbers) for other in others]
    return min(bounds, key=above) if bounds else None


def fading_time(core: FuzzySurface) -> float:
    """Time constant with which the weights fade inside the layer [s]; infinite without leakage."""
    rate = core.gains.weight_rate * core.gains.leakage
    return 1.0 / rate if rate > 0.0 else float("inf")
