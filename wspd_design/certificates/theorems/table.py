"""All theorems, in the order in which an argument would use them."""

from collections.abc import Mapping

from wspd_design.certificates.theorems import authority, foundations, linear, recovery, region, sliding, valve
from wspd_design.certificates.theorems.theorem import Theorem

THEOREMS: Mapping[str, Theorem] = {
    each.name: each
    for each in (
        foundations.GAIN_POSITIVE,
        authority.SLIDING_EXISTS,
        sliding.REACHING,
        sliding.BOUNDARY_LAYER,
        valve.OPEN_LOOP_POLE,
        valve.NO_GO,
        recovery.HARD_LIMITS,
        valve.SAMPLING,
        linear.ROUTH_LAG,
        linear.MARGINS_THEOREM,
        region.LPV_LYAPUNOV,
    )
}
"""By name; a check without a row here does not exist."""
