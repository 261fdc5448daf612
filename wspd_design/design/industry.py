"""Which of its tables a law of the industry takes on a vehicle."""

from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from typing import Any

from wspd_design.parameters.loading import load_vehicle
from wspd_design.parameters.records import Vehicle
from wspd_design.parameters.schema import Preset

CALIBRATED_FOR = ("er24pc", "er24pc-service")
"""Vehicles that the calibrated tables belong to: they go with the fit to Table 10 of the paper."""

PRINTED, TUNED = "printed", "tuned"
_NOT_A_NUMBER = ("name", "bounds")


def usual_table(vehicle: Vehicle) -> Preset:
    """Return the preset that the bare name of a law of the industry means on a vehicle.

    Calibrated limits of acceleration, pulses and levels belong to the wheelsets, brakes and valves that they were
    fitted with. They hold for a vehicle with just these numbers, whatever its name or file; bounds do not count.
    Every other vehicle gets the tables of conventional practice.
    """
    own = _numbers(vehicle)
    return "calibrated" if any(own == _numbers(load_vehicle(name)) for name in CALIBRATED_FOR) else "textbook"


def named_with(law: str, numbers: str) -> str:
    """Return the name of a law that says which numbers it takes: a table, or the gains that the paper prints."""
    return f"{law} ({numbers})"


def table_note(controllers: Iterable[str]) -> str:
    """Say what the numbers in the names of controllers are; nothing where none is named."""
    meant = {
        "textbook": "textbook: tables of conventional practice",
        "calibrated": "calibrated: tables that go with the fit to Table 10 of the paper",
        PRINTED: "printed: gains that the paper prints",
    }
    told = list(controllers)
    said = [words for kind, words in meant.items() if any(name.endswith(f"({kind})") for name in told)]
    if said:
        said.append(f"what is calibrated or printed belongs to {' and '.join(CALIBRATED_FOR)}")
    if any(f"({TUNED}, " in name for name in told):
        said.append(
            "tuned: numbers of a search with this effort (wspd tune); all others are as shipped or designed"
        )
    return f"{'; '.join(said)}." if said else ""


def _numbers(record: Any) -> tuple[Any, ...]:
    values = (getattr(record, each.name) for each in fields(record) if each.name not in _NOT_A_NUMBER)
    return tuple(_numbers(value) if is_dataclass(value) else value for value in values)
