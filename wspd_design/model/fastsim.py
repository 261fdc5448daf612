"""Kalker's simplified theory of rolling contact (FASTSIM): creep forces strip by strip, a check of Polach's method."""

import math
from typing import TYPE_CHECKING

from wspd_design.model.wheel_rail import WheelRail
from wspd_design.parameters.errors import UserError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def fastsim(
    longitudinal: float,
    lateral: float,
    spin: float,
    load: float,
    friction: float,
    contact: WheelRail,
    *,
    cells: int = 50,
) -> tuple[float, float]:
    """Creep forces of one wheel with Coulomb friction.

    The tangential stress grows from the leading edge of each strip, by the rigid slip over a flexibility of its own for
    each creepage, until it meets the bound of a parabolic pressure.

    Parameters
    ----------
    longitudinal, lateral : float
        Creepages, signs as in :mod:`wspd_design.model.wheel_rail` [-].
    spin : float
        Turning rate about the contact normal over the running speed [1/m].
    load : float
        Normal force [N].
    friction : float
        Friction coefficient [-].
    contact : WheelRail
        Ellipse and coefficients; the slope factor of the lateral force is not used.
    cells : int
        Number of strips and of cells in each; the error falls with its square while the contact adheres.

    Returns
    -------
    longitudinal, lateral : float
        Forces on the wheel, positive against their creepages [N].

    References
    ----------
    Kalker (1982), A fast algorithm for the simplified theory of rolling contact, Vehicle System Dynamics 11, 1-13.
    """
    import numpy as np

    if not (load > 0.0 and friction > 0.0 and cells >= 2):
        raise UserError(
            f"simplified theory with a load of {load:g} N, a friction of {friction:g} and {cells} cells: load and "
            "friction must be above 0 and there must be 2 cells or more"
        )
    ellipse = contact.contact
    growth = (load / ellipse.reference_load) ** (1.0 / 3.0)
    a, b = ellipse.semi_axis_rolling * growth, ellipse.semi_axis_lateral * growth
    modulus = ellipse.shear_modulus
    by_longitudinal = 8.0 * a / (3.0 * modulus * ellipse.kalker_c11)  # m/Pa
    by_lateral = 8.0 * a / (3.0 * modulus * contact.kalker_c22)
    by_spin = math.pi * a * math.sqrt(a / b) / (4.0 * modulus * contact.kalker_c23)

    strip = b * ((np.arange(cells) + 0.5) * 2.0 / cells - 1.0)
    edge = a * np.sqrt(1.0 - (strip / b) ** 2)
    length = 2.0 * edge / cells
    largest = 2.0 * load * friction / (math.pi * a * b)
    along, across = np.zeros(cells), np.zeros(cells)
    forces = [0.0, 0.0]
    for k in range(cells):
        place = edge - (k + 0.5) * length
        # Halfway through the first cell, from middle to middle through the others.
        step = length * (1.0 if k else 0.5)
        between = place + 0.5 * step
        along = along + step * (longitudinal / by_longitudinal - spin * strip / by_spin)
        across = across + step * (lateral / by_lateral + spin * between / by_spin)
        bound = largest * (1.0 - (place / a) ** 2 - (strip / b) ** 2)
        kept = bound / np.maximum(bound, np.hypot(along, across))
        along, across = along * kept, across * kept
        area = length * 2.0 * b / cells
        forces = [forces[0] + float(along @ area), forces[1] + float(across @ area)]
    return forces[0], forces[1]
