"""All theorems, in the order in which an argument would use them."""

from collections.abc import Mapping

from wspd_design.certificates.theorems import (
    afsmc_energy,
    authority,
    band,
    barbalat,
    equations,
    feedback,
    foundations,
    holding,
    limit,
    linear,
    lyapunov_adaptive,
    lyapunov_surface,
    overshoot,
    recovery,
    region,
    signs,
    simulated_stop,
    sliding,
    surface,
    traced_loop,
    valve,
)
from wspd_design.certificates.theorems.fuzzy_sector.theorem import FUZZY_SECTOR
from wspd_design.certificates.theorems.shortest_stop.stop_bound import STOP_BOUND
from wspd_design.certificates.theorems.theorem import Theorem

THEOREMS: Mapping[str, Theorem] = {
    each.name: each
    for each in (
        equations.DERIVATION,
        feedback.FEEDBACK,
        surface.SURFACE_HURWITZ,
        foundations.GAIN_POSITIVE,
        signs.WELL_POSED,
        holding.HOLDING_TORQUE,
        authority.SLIDING_EXISTS,
        sliding.REACHING,
        sliding.BOUNDARY_LAYER,
        lyapunov_surface.LYAPUNOV_SURFACE,
        lyapunov_adaptive.LYAPUNOV_PRINTED,
        lyapunov_adaptive.LYAPUNOV_REPAIRED,
        afsmc_energy.AFSMC_ENERGY,
        barbalat.BARBALAT,
        valve.OPEN_LOOP_POLE,
        valve.NO_GO,
        recovery.HARD_LIMITS,
        valve.SAMPLING,
        linear.ROUTH_LAG,
        linear.MARGINS_THEOREM,
        traced_loop.TRACED_LOOP,
        region.LPV_LYAPUNOV,
        region.SAMPLED_INVARIANCE,
        band.SLIP_BAND,
        limit.SLIP_LIMIT,
        FUZZY_SECTOR,
        simulated_stop.TRACKING,
        overshoot.OVERSHOOT,
        simulated_stop.CONSERVATION,
        STOP_BOUND,
    )
}
"""By name; a check without a row here does not exist."""
