"""All theorems, in the order in which an argument would use them."""

from collections.abc import Mapping

from wspd_design.certificates.theorems import authority, foundations, sliding, valve
from wspd_design.certificates.theorems.theorem import Theorem

THEOREMS: Mapping[str, Theorem] = {
    each.name: each
    for each in (
        foundations.GAIN_POSITIVE,
        authority.SLIDING_EXISTS,
        sliding.REACHING,
        sliding.BOUNDARY_LAYER,
        valve.NO_GO,
    )
}
"""By name; a check without a row here does not exist."""
