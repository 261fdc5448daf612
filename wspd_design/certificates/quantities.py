"""The one table of the quantities that claims speak about: name, unit, and where the number lives.

Every number of a vehicle or rail file either has a row here or a reason in :data:`OUTSIDE_CLAIMS` why no claim
depends on it.
"""

from dataclasses import dataclass, fields
from typing import Literal, TypeAlias

from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake
from wspd_design.parameters.schema import Schema, schema_of

Record: TypeAlias = Literal[
    "state", "axle", "vehicle", "brake", "contact", "rail", "laden", "pads", "dynamic", "track_brake"
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """One row of the table."""

    name: str  # as people read it
    unit: str  # SI
    record: Record
    field: str  # of the record; of a state or an axle its own name

    @property
    def positive(self) -> bool:
        """Whether zero is not allowed either."""
        return self.record in ("state", "axle") or not _schema(self.record)[self.entry].low_is_allowed

    @property
    def entry(self) -> str:
        """Name of the entry in the parameter file."""
        return f"{self.record}.{self.field}" if self.record in ("brake", "contact") else self.field


def _schema(record: Record) -> Schema:
    return schema_of("rail", "") if record == "rail" else schema_of("vehicle", "")


def _rows(record: Record, *rows: tuple[str, str, str]) -> tuple[Quantity, ...]:
    return tuple(Quantity(name=name, unit=unit, record=record, field=field) for name, unit, field in rows)


TABLE: tuple[Quantity, ...] = (
    *_rows("state", ("slip", "-", "slip"), ("speed", "m/s", "speed")),
    *_rows(
        "vehicle",
        ("mass", "kg", "mass"),
        ("wheelset inertia", "kg m2", "wheelset_inertia"),
        ("wheel radius", "m", "wheel_radius"),
        ("wheel damping", "N m s", "wheel_damping"),
        ("resistance constant", "N", "resistance_constant"),
        ("resistance linear", "N s/m", "resistance_linear"),
        ("resistance quadratic", "N s2/m2", "resistance_quadratic"),
    ),
    *_rows(
        "contact",
        ("shear modulus", "Pa", "shear_modulus"),
        ("semi axis rolling", "m", "semi_axis_rolling"),
        ("semi axis lateral", "m", "semi_axis_lateral"),
        ("kalker c11", "-", "kalker_c11"),
        ("reference load", "N", "reference_load"),
    ),
    *_rows(
        "rail",
        ("mu0", "-", "mu0"),
        ("friction ratio", "-", "friction_ratio"),
        ("friction decay", "s/m", "friction_decay"),
        ("adhesion reduction", "-", "adhesion_reduction"),
        ("slip reduction", "-", "slip_reduction"),
    ),
    *_rows(
        "brake",
        ("max torque", "N m", "max_torque"),
        ("max pressure", "Pa", "max_pressure"),
        ("supply rate", "1/s", "supply_rate"),
        ("fill time", "s", "fill_time"),
        ("vent time", "s", "vent_time"),
    ),
    *_rows(
        "axle",
        ("axle load share", "-", "load_share"),
        ("train deceleration", "m/s2", "deceleration"),
    ),
)

QUANTITIES: dict[str, Quantity] = {quantity.name: quantity for quantity in TABLE}

STATE, CONTACT, RAIL, BRAKE, AXLE = (
    tuple(quantity.name for quantity in TABLE if quantity.record == record)
    for record in ("state", "contact", "rail", "brake", "axle")
)
VEHICLE = tuple(quantity.name for quantity in TABLE if quantity.record == "vehicle")
PLANT = (*STATE, *VEHICLE, *CONTACT, *RAIL)
"""What (19) depends on at an axle with the static load."""


def quantity_of(kind: str, entry: str) -> Quantity | None:
    """Return what claims call a number of a vehicle or rail file; None for one that stands in no claim."""
    return next(
        (
            each
            for each in TABLE
            if each.record not in ("state", "axle") and (each.record == "rail") == (kind == "rail")
            if each.entry == entry
        ),
        None,
    )


def outside_claims(kind: str, entry: str) -> str:
    """Return why a number of a vehicle or rail file stands in no claim; empty for one that does."""
    record, _, field = entry.rpartition(".")
    return next(
        (why for (of, name), why in OUTSIDE_CLAIMS.items() if (of, name) == (record or kind, field)), ""
    )


def is_working_name(name: str) -> bool:
    """Tell whether a variable of a claim is a means of its formula or a known number of a design model."""
    return name in ("nominal mass", "unit of speed") or name.startswith("model ")


_TRANSFER = "enters through the range of the axle load share"
_PADS = "the vibration of the pads at the onset of braking is part of no claim"
_OTHER_BRAKES: tuple[tuple[Record, type, str], ...] = (
    ("pads", Pads, "claims about brakes speak about pads whose friction is constant"),
    ("dynamic", DynamicBrake, "claims about brakes speak about vehicles without an electrodynamic brake"),
    ("track_brake", TrackBrake, "claims about brakes speak about vehicles without a track brake"),
)
OUTSIDE_CLAIMS: dict[tuple[Record, str], str] = {
    **{
        ("vehicle", count): "a count, not a measurement"
        for count in ("wheelsets", "axles_per_bogie", "bodies")
    },
    ("vehicle", "multibody"): "claims speak about the quarter or the planar plant",
    ("brake", "axle_shares"): "claims about brakes speak about vehicles whose brakes are alike",
    **{
        ("brake", field): "claims speak about a brake that is built up, or whose demand builds up as eq. (8)"
        for field in ("build_up", "build_up_delay", "build_up_ramp")
    },
    **{
        ("laden", field): "the laden vehicle is a vehicle of its own"
        for field in ("mass", "body_height", "max_torque")
    },
    **{
        (part, field.name): reason
        for part, record, reason in _OTHER_BRAKES
        for field in fields(record)
        if field.name != "bounds"
    },
    ("vehicle", "wheel_damping_decay"): "claims take the damping of the wheels as it is at the start",
    **{
        ("vehicle", field): _TRANSFER
        for field in (
            "body_mass",
            "bogie_mass",
            "body_height",
            "bogie_height",
            "traction_rod_height",
            "bogie_spacing",
            "wheelbase",
            "pitch_damping_ratio",
        )
    },
    (
        "vehicle",
        "body_pitch_frequency",
    ): "the bound on the load transfer holds for every frequency of the pitch",
    (
        "vehicle",
        "bogie_pitch_frequency",
    ): "the bound on the load transfer holds for every frequency of the pitch",
    ("brake", "disturbance_gain"): _PADS,
    ("brake", "disturbance_decay"): _PADS,
    ("brake", "disturbance_frequency"): _PADS,
}
"""Numbers of the files that stand in no claim, each with the reason."""
