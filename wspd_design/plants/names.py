"""The plants by name: the one place that turns the name of an option into a plant."""

from collections.abc import Callable
from typing import Final

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.planar import Planar
from wspd_design.plants.protocol import Plant
from wspd_design.plants.quarter import Quarter


def _multibody(vehicle: Vehicle) -> Plant:
    from wspd_design.plants.locomotive import Locomotive  # what no stop on a small plant needs

    return Locomotive(vehicle)


def _linear_multibody(vehicle: Vehicle) -> Plant:
    from wspd_design.plants.locomotive import LinearLocomotive

    return LinearLocomotive(vehicle)


_PLANTS: Final[dict[str, Callable[[Vehicle], Plant]]] = {
    Planar.name: Planar,
    Quarter.name: Quarter,
    "locomotive": _multibody,
    "locomotive-linear": _linear_multibody,
}

PLANTS: Final = tuple(_PLANTS)
"""The first transfers load; the quarter model is its case without heights and with equal rails. The others have all
degrees of freedom of a multibody file."""

DEFAULT_PLANT: Final = Planar.name
"""The plant of a stop that names none."""


def plant_of(name: str, vehicle: Vehicle) -> Plant:
    """Return the plant of a name with the numbers of a vehicle.

    Raises
    ------
    UserError
        If there is no such plant, or the vehicle lacks what it needs.
    """
    if name not in _PLANTS:
        raise UserError(f'unknown plant "{name}"; available: {", ".join(PLANTS)}')
    return _PLANTS[name](vehicle)
