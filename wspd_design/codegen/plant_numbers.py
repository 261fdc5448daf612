"""The numbers of the plant in the compiled closed loop: which fields of which records make its parameter vector."""

from dataclasses import dataclass, fields

from wspd_design.codegen.further_numbers import FURTHER_PARAMETERS, PART_NAMES, further_values
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What a scenario adds to vehicle and rail, as numbers of one wheelset."""

    grade_force: float = 0.0  # N, positive uphill
    axle_offset: float = 0.0  # m, behind the first axle
    braking_time: float = 0.0  # s, from the application of the brake to the start of the stop
    reservoir_drain: float = 0.0  # -, by which a pressure filled into the cylinders lowers the reservoir
    creep_growth: float = 1.0  # -, fastest rate of the creep of a coupled plant over that of rigid wheelsets


RECORDS: tuple[tuple[str, type], ...] = (
    ("vehicle", Vehicle),
    ("brake", Brake),
    ("contact", Contact),
    ("rail", Rail),
    ("surroundings", Surroundings),
)
KINDS = ("build_up", "valve")
"""Words of a brake: another word is another kernel, and so is a reservoir that can run low."""
_NOT_NUMBERS = (
    "name",
    "wheelsets",
    "axles_per_bogie",
    "bodies",
    "brake",
    "contact",
    "axle_shares",
    *PART_NAMES,
    "bounds",
    *KINDS,
    "multibody",
    "dead_time",  # the numbers of a stop hold these, as its disturbances
    "shortest_pulse",
    "longest_release",
    "cylinder_volume",
    "reservoir_volume",
    "reservoir_pressure",
)

PARAMETERS: tuple[tuple[str, str], ...] = (
    *(
        (record, field.name)
        for record, kind in RECORDS
        for field in fields(kind)
        if field.name not in _NOT_NUMBERS
    ),
    *FURTHER_PARAMETERS,
)
"""Record and field of every element of the parameter vector."""

RAIL = tuple(field for record, field in PARAMETERS if record == "rail")
"""Numbers of a rail."""

_KNOWN = PARAMETERS[: -len(FURTHER_PARAMETERS)]


def parameter_values(vehicle: Vehicle, rail: Rail, surroundings: Surroundings) -> list[float]:
    """Parameter vector of one wheelset: the vehicle, the rail below it and what the scenario adds."""
    records = {
        "vehicle": vehicle,
        "brake": vehicle.brake,
        "contact": vehicle.contact,
        "rail": rail,
        "surroundings": surroundings,
    }
    return [*(getattr(records[record], field) for record, field in _KNOWN), *further_values(vehicle)]
