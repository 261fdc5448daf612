"""What a controller is built from."""

from dataclasses import dataclass
from typing import Any

from wspd_design.controllers.observers.sensors import TOLD, Sensors
from wspd_design.controllers.references import ReferenceKind
from wspd_design.parameters.records import Rail, Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """What a controller is built from."""

    name: str
    sample_time: float  # s
    vehicle: Vehicle
    rail: Rail  # design rail
    numbers: Any  # record of the gains, or the table of a law of the industry
    sensors: Sensors = TOLD  # of a law of a vehicle
    reference: ReferenceKind = "constant"  # likewise
