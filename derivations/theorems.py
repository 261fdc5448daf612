"""The statements that can be made in place of the paper's, with the identity that carries each proof.

Claims: every identity has the residual zero. The theorems are those that the certificates of the package establish
for numbers; here stands why they are true for symbols. `make derive` writes them to docs/theory.md.
"""

from derivations import (
    band_theorems,
    brake_theorems,
    limit_theorems,
    rolling_theorems,
    stop_theorems,
    surface_theorems,
    valve_theorems,
    vehicle_law_theorems,
)

THEOREMS = (
    *valve_theorems.THEOREMS,
    *band_theorems.THEOREMS,
    *rolling_theorems.THEOREMS,
    *limit_theorems.THEOREMS,
    *surface_theorems.THEOREMS,
    *stop_theorems.THEOREMS,
    *brake_theorems.THEOREMS,
    *vehicle_law_theorems.THEOREMS,
)
