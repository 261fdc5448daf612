"""A quantity over speed and one further coordinate of the domain, the worst of all others: the map of a margin."""

from collections.abc import Callable, Mapping
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Map
from wspd_design.certificates.setting.domain import INERTIA, KMH, MASS, MU0, SLIP, SPEED
from wspd_design.certificates.setting.plant import UNITS

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

SPEEDS, ROWS = 51, 51
LABELS = {SLIP: "slip [-]", MU0: "friction coefficient mu0 [-]"}


def margin_map(
    name: str,
    value_label: str,
    quantity: "Callable[[Array], Array]",
    box: "tuple[Array, Array]",
    *,
    over: int,
    limit: float,
    worst: Mapping[str, float],
    largest: bool,
) -> tuple[Map, ...]:
    """Evaluate a quantity on a grid, at each point the worst of the corners of the other coordinates.

    The tightest point that the prover found lies on the grid, and its own parameters are tried beside the corners:
    the value there is the one of the proof.

    Parameters
    ----------
    name, value_label : str
        Of the quantity, the label with its unit.
    quantity : callable
        From points of the domain, columns as in :mod:`domain`, to one value each.
    box : tuple of ndarray
        Corners of the domain, from :func:`domain.box` or :func:`domain.slip_held`.
    over : int
        Column of the vertical axis, ``SLIP`` or ``MU0``.
    limit : float
        Value at which the claim begins to fail.
    worst : mapping
        Tightest point by names, SI units, as the prover found it.
    largest : bool
        Whether the worst is the largest or the smallest value.

    Returns
    -------
    tuple of Map
        One map, or none for a domain of a single speed or row.
    """
    import numpy as np

    low, high = box
    if low[SPEED] == high[SPEED] or low[over] == high[over]:
        return ()
    tightest = np.array([worst[each] for each in UNITS])
    speeds = np.union1d(np.geomspace(low[SPEED], high[SPEED], SPEEDS), tightest[SPEED])
    rows = np.union1d(np.linspace(low[over], high[over], ROWS), tightest[over])
    others = [column for column in (SLIP, MASS, INERTIA, MU0) if column != over]
    corners = product(*(np.unique([low[column], high[column]]) for column in others))
    parameters = np.array([*corners, tightest[others]])
    points = np.empty((len(parameters), len(rows), len(speeds), len(low)))
    points[..., SPEED], points[..., over] = speeds, rows[:, np.newaxis]
    points[..., others] = parameters[:, np.newaxis, np.newaxis]
    found = quantity(points.reshape(-1, len(low))).reshape(points.shape[:-1])
    extreme = found.max(axis=0) if largest else found.min(axis=0)
    return (
        Map(
            name=name,
            x_label="speed [km/h]",
            y_label=LABELS[over],
            value_label=value_label,
            x=tuple((speeds * KMH).tolist()),
            y=tuple(rows.tolist()),
            values=tuple(tuple(row) for row in extreme.tolist()),
            limit=limit,
            worst=(float(tightest[SPEED]) * KMH, float(tightest[over])),
        ),
    )
