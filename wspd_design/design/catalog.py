"""Controllers by name: the paper's, the designed ones, the baselines, and design files."""

from pathlib import Path

from wspd_design.controllers.family import FAMILIES, preset_of, with_presets
from wspd_design.controllers.given import Given
from wspd_design.controllers.protocol import Law
from wspd_design.design.file import read_design
from wspd_design.design.industry import named_with, usual_table
from wspd_design.design.records import Design, Specification, seen_by
from wspd_design.design.selection import named_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.taken import check_kinds, check_record
from wspd_design.parameters.words import did_you_mean


def controller(name_or_path: str, vehicle: Vehicle, rail: Rail, specification: Specification) -> Law:
    """Build a controller from its name or from a design file.

    Parameters
    ----------
    name_or_path : str
        A family of laws, such as ``smc`` or ``trenitalia``, or the path of a design file ending in ``.toml``. The
        three laws of the industry take a preset after a colon, ``trenitalia:textbook``; without one the preset that
        belongs to the vehicle. Their names say which, ``trenitalia (textbook)``, except the calibrated one of a
        vehicle that it belongs to.
    vehicle : Vehicle
        The vehicle it shall brake.
    rail : Rail
        Design rail of ``smc`` and ``torque-feedback``. A design file keeps the one that it was made on.
    specification : Specification
        Slip reference, ranges and sample time. A design file brings its own.

    Raises
    ------
    UserError
        If there is no such controller, or the design file does not fit the vehicle.
    """
    check_kinds(vehicle, rail, by="controller")
    check_record(specification, Specification, by="controller", remedy="make one, Specification(slip=0.14)")
    if is_design_file(name_or_path):
        return controller_of(read_design(name_or_path), vehicle, rail)
    base, colon, preset = name_or_path.partition(":")
    family = FAMILIES.get(base)
    if family is None or (colon and family.tables is None):
        raise UserError(_unknown(name_or_path))
    if family.gains is not None:
        return named_design(base, vehicle, rail, specification).build(vehicle, rail)
    table, name = None, base
    if family.tables is not None:
        chosen = preset_of(family, preset) if colon else usual_table(vehicle)
        table = family.tables(chosen)
        name = named_with(base, chosen) if colon or chosen != "calibrated" else base
    specification.reference_of(family)  # refuses one that it cannot hold
    law = family.build(
        Given(
            name=name,
            sample_time=specification.sample_time,
            vehicle=vehicle,
            rail=rail,
            numbers=table,
        )
    )
    return seen_by(specification.sensors, law, vehicle)


def baselines(vehicle: Vehicle, rail: Rail, specification: Specification | None = None) -> tuple[Law, ...]:
    """Return the laws of the industry, each with the table that belongs to the vehicle, to compare others with.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    rail : Rail
        Of the stop.
    specification : Specification, optional
        Its sample time and sensors count; those of the paper's case by default.
    """
    asked = specification or Specification()
    return tuple(controller(family.name, vehicle, rail, asked) for family in with_presets())


def controller_of(made: Design, vehicle: Vehicle, rail: Rail) -> Law:
    """Build the controller of a design for a vehicle and a stop on a rail.

    The controller keeps the rail of its design. ``rail`` is taken for it only if it is the same one, by name and
    numbers.

    Raises
    ------
    UserError
        If the vehicle is another one, or the design rail is neither ``rail`` nor among the shipped ones.
    """
    return made.build(vehicle, design_rail(made, rail))


def design_rail(made: Design, rail: Rail) -> Rail:
    """Return the rail that a design was made on: the rail of the stop if it is the same one, else the shipped one."""
    if made.made_on(rail):
        return rail
    if made.rail in available("rail"):
        shipped = load_rail(made.rail)
        if made.made_on(shipped):
            return shipped
    raise UserError(
        f"the rail {made.rail} that design {made.name} was made on is neither the rail {rail.name} of the stop nor a "
        "shipped one with the same numbers; give its file with --rail, or re-run wspd design"
    )


def is_design_file(name_or_path: str) -> bool:
    """Tell whether a controller is given by a design file."""
    return Path(name_or_path).suffix == ".toml"


def _unknown(name: str) -> str:
    return (
        f'unknown controller "{name}"{did_you_mean(name, FAMILIES)}; available: {", ".join(FAMILIES)}, '
        "or the path of a design file ending in .toml"
    )
