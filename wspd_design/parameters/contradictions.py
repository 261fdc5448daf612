"""Numbers of a file that do not fit together, and numbers that nobody would expect."""

import warnings
from functools import cache

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import load_entries, uniform_rails
from wspd_design.parameters.provenance import ParameterSet
from wspd_design.parameters.records import Rail, Vehicle


def check_heights(vehicle: Vehicle) -> None:
    """Refuse a vehicle whose body hangs below its bogies."""
    if vehicle.body_height <= vehicle.bogie_height:
        raise UserError(
            f"body_height = {vehicle.body_height:g} m in vehicle {vehicle.name} must be above "
            f"bogie_height = {vehicle.bogie_height:g} m; correct one of them."
        )


def notice_of_vehicle(parameters: ParameterSet, gravity: float) -> str:
    """Say that a brake asks for more adhesion than any shipped rail gives; empty where it does not."""
    number = parameters.number
    load = number("mass") / number("wheelsets") * gravity
    demand = number("brake.max_torque") / number("wheel_radius") / load
    most, rail = _best_rail()
    if demand <= most:
        return ""
    entry = parameters.entries["brake.max_torque"]
    taken = f", taken over from {entry.inherited}," if entry.inherited else ""
    return (
        f"brake.max_torque = {number('brake.max_torque'):g} N m of vehicle {parameters.name}{taken} is a wheel demand "
        f"of {demand:.2f}, more than any rail gives ({rail} at most {most:g}): every wheel slides; check the torque"
    )


def notice_of_rail(rail: Rail) -> str:
    """Say that the slip reduction exceeds the adhesion reduction, against eq. (5); empty where it does not."""
    if rail.slip_reduction <= rail.adhesion_reduction:
        return ""
    return (
        f"slip_reduction = {rail.slip_reduction:g} of rail {rail.name} is above adhesion_reduction = "
        f"{rail.adhesion_reduction:g}, against kS <= kA of eq. (5); a fit to a measured curve may say so, and it is "
        "taken as it is"
    )


def tell(notice: str) -> None:
    """Warn, unless there is nothing to say."""
    if notice:
        warnings.warn(notice, stacklevel=4)


@cache
def _best_rail() -> tuple[float, str]:
    """Return the largest friction coefficient of the shipped rails, bounds included, and the rail."""
    found = (0.0, "")
    for name in uniform_rails():
        parameters = load_entries("rail", name)
        found = max(found, (parameters.bounds.around("mu0", parameters.number("mu0"))[1], name))
    return found
