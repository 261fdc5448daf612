"""The multibody model of Section 7: Figure 8 and Tables 6 to 8, with what is published and what is inferred."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from wspd_design.parameters.entry import STATUSES
from wspd_design.parameters.provenance import Entry, ParameterSet
from wspd_design.plants.multibody.records import Body, Multibody
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Figure, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import picture
from wspd_design.reporting.figures.multibody import multibody, multibody_alt
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.inferred import is_inferred, mark

JOINTS = {
    "free": "free",
    "wheelset": "free, turning about its axle",
    "revolute": "turns about an axle",
    "rotor": "turns in its motor",
}
"""How a body moves, in words."""

_MULTIBODY, _VEHICLE = "the multibody model", "the vehicle"

PRINTED = (
    ("mass of locomotive", "76841 kg", _MULTIBODY, "mass"),
    ("wheelbase", "2700 mm", _MULTIBODY, "wheelbase"),
    ("track gauge", "1435 mm", _MULTIBODY, "wheel_half_spacing"),
    ("wheel diameter", "1100 mm", _MULTIBODY, "wheel_radius"),
    ("track cant", "1:40", _MULTIBODY, "conicity"),
    ("Young's modulus", "210 GPa", _VEHICLE, "contact.shear_modulus"),
    ("Poisson's ratio", "0.25", _VEHICLE, "contact.shear_modulus"),
    ("P_c max", "6 bar", _VEHICLE, "brake.max_pressure"),
    ("T_F", "0.6 s", _VEHICLE, "brake.fill_time"),
    ("T_V", "0.6 s", _VEHICLE, "brake.vent_time"),
    ("T_brake max", "60 kN m", _VEHICLE, "brake.max_torque"),
)
"""Rows of Table 6: name and value as printed, and the number that holds it here."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Kind:
    """Bodies that are alike."""

    name: str
    bodies: tuple[Body, ...]

    @property
    def each(self) -> int:
        return len(self.bodies[0].coordinates)


def model(model: Multibody, vehicle: ParameterSet) -> tuple[Block, ...]:
    """Return the section about the multibody model; brake and contact are those of the vehicle."""
    kinds = _kinds(model)
    return (
        Heading(text="The locomotive with 82 degrees of freedom", anchor="multibody"),
        Paragraph(
            text=rich(
                "The paper simulates a multibody model of the ER24PC; its Figure 8 shows it, Tables 7 and 8 with its "
                "degrees of freedom, masses and inertias are lost, and stiffnesses were never printed. What stands "
                f"here is a reconstruction: [](#paper-figure-8) draws it from its data, [](#table6), [](#table7) and "
                f"[](#table8) stand for the paper's, [](#suspension) has what the paper does not list. {mark(model)} "
                "Everything on this page that was simulated on this model rests on them; what each of them does stands "
                "in [](#inferred)."
            )
        ),
        Figure(
            svg=picture(partial(multibody, model=model), height=6.2),
            caption=f"Figure 8 of the paper, drawn from the data of {model.name}. Boxes and disks are the homogeneous "
            f"ones with the mass and the moments of inertia of each body. {mark(model)}",
            alt=multibody_alt(model),
            anchor="paper-figure-8",
        ),
        _table6(model, vehicle),
        _table7(model, kinds),
        _table8(model, kinds),
        _suspension(model),
    )


def _kinds(model: Multibody) -> tuple[_Kind, ...]:
    names = dict.fromkeys(body.kind for body in model.bodies)
    return tuple(
        _Kind(name=name, bodies=tuple(body for body in model.bodies if body.kind == name)) for name in names
    )


def _table6(model: Multibody, vehicle: ParameterSet) -> Table:
    def entry(row: tuple[str, str, str, str]) -> Entry:
        return (model.entries if row[2] == _MULTIBODY else vehicle.entries)[row[3]]

    return build(
        PRINTED,
        (
            ColumnOf(title="Parameter", read=lambda row: row[0]),
            ColumnOf(title="Paper", flush_right=True, read=lambda row: row[1]),
            ColumnOf(title="Number here", read=lambda row: named(row[3])),
            ColumnOf(title="of", read=lambda row: row[2]),
            ColumnOf(title="Value", flush_right=True, read=lambda row: _quantity(entry(row))),
            ColumnOf(title="Status", read=lambda row: status_of(entry(row))),
        ),
        caption="Table 6 of the paper, and where its values stand here.",
        anchor="table6",
    )


def _table7(model: Multibody, kinds: Sequence[_Kind]) -> Table:
    total = len(model.coordinates)
    return build(
        kinds,
        (
            ColumnOf(title="Component", read=lambda kind: kind.name.replace("_", " ")),
            ColumnOf(title="Motion", read=lambda kind: JOINTS[kind.bodies[0].joint]),
            ColumnOf(title="Number", decimals=0, read=lambda kind: float(len(kind.bodies))),
            ColumnOf(title="Degrees of freedom of each", decimals=0, read=lambda kind: float(kind.each)),
            ColumnOf(title="Sum", decimals=0, read=lambda kind: float(kind.each * len(kind.bodies))),
        ),
        caption=f"In place of Table 7 of the paper, which is lost: {total} degrees of freedom of {len(model.bodies)} "
        "bodies. That the sum is the paper's is a choice of the reconstruction; other divisions give the same sum. "
        "Inferred.",
        anchor="table7",
    )


def _table8(model: Multibody, kinds: Sequence[_Kind]) -> Table:
    def inertia(axis: int, name: str) -> ColumnOf[_Kind]:
        return ColumnOf(
            title=name,
            unit="kg m²",
            significant=4,
            read=lambda kind: float(model.inertia(kind.bodies[0])[axis]),
        )

    total = sum(float(model.mass(body)) for body in model.bodies)
    return build(
        kinds,
        (
            ColumnOf(title="Component", read=lambda kind: kind.name.replace("_", " ")),
            ColumnOf(title="Number", decimals=0, read=lambda kind: float(len(kind.bodies))),
            ColumnOf(
                title="Mass", unit="kg", decimals=0, read=lambda kind: float(model.mass(kind.bodies[0]))
            ),
            inertia(0, "Roll"),
            inertia(1, "Pitch"),
            inertia(2, "Yaw"),
            ColumnOf(
                title="Height",
                unit="m",
                decimals=2,
                read=lambda kind: float(model.place(kind.bodies[0].at)[2]),
            ),
            ColumnOf(title="Status", read=lambda kind: _status_of_kind(model, kind)),
        ),
        caption=f"In place of Table 8 of the paper, which is lost: masses, moments of inertia about the center of "
        f"gravity, and its height. All bodies together have {numbers.decimals(total, 0)} kg.",
        anchor="table8",
    )


def _suspension(model: Multibody) -> Table:
    bodies = {body.kind for body in model.bodies}
    entries = [
        entry for name, entry in model.entries.items() if "." in name and name.partition(".")[0] not in bodies
    ]
    return build(
        entries,
        (
            ColumnOf(title="Number", read=lambda entry: named(entry.name)),
            ColumnOf(title="Value", flush_right=True, read=_quantity),
            ColumnOf(title="Bounds", flush_right=True, read=_bounds),
            ColumnOf(title="Status", read=status_of),
            ColumnOf(title="Source", read=lambda entry: entry.source),
            ColumnOf(title="Remark", read=lambda entry: entry.note),
        ),
        caption="Springs, dampers, rods, drive and brake, of which the paper prints none.",
        anchor="suspension",
    )


def _status_of_kind(model: Multibody, kind: _Kind) -> str:
    """Return the status of what makes a body: the weakest of its numbers; the remainder is inferred with the others."""
    own = [entry for name, entry in model.entries.items() if name.startswith(f"{kind.name}.")]
    weak = [entry for entry in own if is_inferred(entry)]
    if any(body.name == model.remainder for body in kind.bodies):
        return "inferred: mass is what all others leave"
    return status_of(max(weak or own, key=lambda entry: STATUSES.index(entry.status)))


def named(name: str) -> str:
    """Write the name of a number in words."""
    return name.replace(".", ": ").replace("_", " ")


def status_of(entry: Entry) -> str:
    """Write the status of a number with the mark of what no source states."""
    return f"inferred: {entry.status}" if is_inferred(entry) else entry.status


def _quantity(entry: Entry) -> str:
    assert isinstance(entry.value, float)
    return numbers.quantity_in(entry.value, entry.unit)


def _bounds(entry: Entry) -> str:
    if entry.bounds is None:
        return ""
    low, high = (numbers.quantity_in(float(each), entry.unit).partition(" ")[0] for each in entry.bounds)
    return f"{low} to {high}"
