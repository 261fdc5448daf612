"""What the numbers of a brake must have to do with each other."""

from collections.abc import Mapping
from typing import Any

from wspd_design.parameters.errors import UserError

_SINGULAR = 1e-6  # distance of supply_rate * fill_time from 1, where the filling law is 0/0
_BELONGS: dict[str, tuple[str, str]] = {
    "supply_rate": ("build_up", "main-pipe"),
    "build_up_delay": ("build_up", "electro-pneumatic"),
    "build_up_ramp": ("build_up", "electro-pneumatic"),
    "critical_pressure_ratio": ("valve", "orifice"),
}
"""The word that an entry has to do with."""
_NEEDED = ("supply_rate", "build_up_ramp")
_USUAL = {"build_up": "main-pipe", "valve": "lag"}


def check_brake(values: Mapping[str, Any], vehicle: str) -> None:
    """Refuse a brake whose numbers contradict each other.

    Parameters
    ----------
    values : mapping
        Numbers and words of a vehicle by their names [SI units].
    vehicle : str
        Its name, for the sentence.

    Raises
    ------
    UserError
        If an entry is missing or has nothing to do with the kind of the brake, if the filling law is singular, or if
        the reservoir cannot be that of this brake.
    """
    brake = {
        name.removeprefix("brake."): value for name, value in values.items() if name.startswith("brake.")
    }
    kinds = {what: brake.get(what, usual) for what, usual in _USUAL.items()}
    for name in _NEEDED:
        what, word = _BELONGS[name]
        if kinds[what] == word and name not in brake:
            raise UserError(
                f'brake.{name} is missing in vehicle {vehicle}, whose brake.{what} is "{word}"; add it, '
                f"or choose another {what}."
            )
    for name, (what, word) in _BELONGS.items():
        if name in brake and kinds[what] != word and name != "supply_rate":
            raise UserError(
                f'brake.{name} in vehicle {vehicle} means nothing to a brake whose brake.{what} is "{kinds[what]}"; '
                f'remove it, or write brake.{what} = "{word}".'
            )
    if kinds == _USUAL:
        _check_filling(brake, vehicle)
    _check_air(brake, vehicle, int(values["wheelsets"]))


def _check_filling(brake: Mapping[str, Any], vehicle: str) -> None:
    together = brake["supply_rate"] * brake["fill_time"]
    if abs(together - 1.0) < _SINGULAR:
        raise UserError(
            f"supply_rate times fill_time = {together:g} of the brake in vehicle {vehicle} must differ from 1 "
            "by more than 1e-6: the closed form of the filling is singular there; change one of them a little."
        )


def _check_air(brake: Mapping[str, Any], vehicle: str, wheelsets: int) -> None:
    pressure, most = brake.get("reservoir_pressure", brake["max_pressure"]), brake["max_pressure"]
    if pressure < most:
        raise UserError(
            f"brake.reservoir_pressure = {pressure / 1e5:g} bar in vehicle {vehicle} must not be below the "
            f"brake.max_pressure of {most / 1e5:g} bar, which it is to give; correct one of them."
        )
    if "reservoir_volume" not in brake:
        return
    if "cylinder_volume" not in brake:
        raise UserError(
            f"brake.cylinder_volume is missing in vehicle {vehicle}, whose reservoir fills the cylinders; add it, or "
            "leave brake.reservoir_volume out."
        )
    cylinders = wheelsets * brake["cylinder_volume"]
    if brake["reservoir_volume"] < cylinders:
        raise UserError(
            f"brake.reservoir_volume = {1e3 * brake['reservoir_volume']:g} l in vehicle {vehicle} must not be below "
            f"the {1e3 * cylinders:g} l of its {wheelsets} x brake.cylinder_volume; correct one of them."
        )
