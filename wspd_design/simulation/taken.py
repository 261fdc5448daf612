"""What functions that simulate take: a vehicle, a law and a stop that fit together."""

from wspd_design.controllers.protocol import Law
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle
from wspd_design.parameters.taken import check_record, check_vehicle, described
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.records import Scenario

_LAW = ("sample_time", "start", "step")


def check_stop(vehicle: Vehicle, controller: Law, scenario: Scenario, plant: str, *, by: str) -> None:
    """Refuse what is not a vehicle, law or stop, and a vehicle whose numbers contradict each other.

    Parameters
    ----------
    vehicle, controller, scenario, plant
        What a function was given.
    by : str
        Name of the function, for the sentence.

    Raises
    ------
    UserError
        With what is wrong in one sentence.
    """
    check_vehicle(vehicle, by=by, whole=plant != Quarter.name)
    check_law(controller, by=by)
    check_record(
        scenario, Scenario, by=by, remedy="make one with Scenario.stop(from_kmh=120, rail=rail, seed=1)"
    )


def check_law(controller: object, *, by: str) -> None:
    """Refuse the name of a law, a design that was not built, a class in place of an instance, and all else."""
    if isinstance(controller, type):
        raise UserError(
            f"{by} takes a law, not the class {controller.__name__}; make one of it, {controller.__name__}(...)"
        )
    if all(hasattr(controller, each) for each in _LAW):
        return
    if isinstance(controller, str):
        remedy = f'make it with controller("{controller}", vehicle, rail, Specification())'
    elif hasattr(controller, "build"):
        remedy = "build it, design.build(vehicle, rail)"
    else:
        remedy = f"a law has {', '.join(_LAW)}"
    raise UserError(f"{by} takes a law, not {described(controller)}; {remedy}")


def check_several(controllers: object, *, by: str) -> None:
    """Refuse a single law, or its name, where several are compared, and none."""
    if isinstance(controllers, str) or hasattr(controllers, "step") or hasattr(controllers, "build"):
        raise UserError(f"{by} takes a list of laws, not {described(controllers)}; put it in brackets, [law]")
    if not controllers:
        raise UserError(f"{by} takes one law or more, not an empty list")
