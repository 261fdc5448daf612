"""What a design starts from and what it is: a specification, a law and its gains with their reasons."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from wspd_design.controllers.family import Family, tunable_family
from wspd_design.controllers.gains import SLIP_REFERENCE, GainForm
from wspd_design.controllers.given import Given
from wspd_design.controllers.observers.sensors import TOLD, Sensors
from wspd_design.controllers.protected import protected
from wspd_design.controllers.protocol import Law, acts_on_vehicle
from wspd_design.controllers.references import REFERENCE_KINDS, ReferenceKind
from wspd_design.design.industry import usual_table
from wspd_design.design.requirements import Requirements
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.fingerprint import fingerprint
from wspd_design.parameters.later import later
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.taken import check_kinds, check_numbers, notice_of_fast_train
from wspd_design.parameters.units import KMH, dimension_of, factor, units_of

if TYPE_CHECKING:
    from wspd_design.parameters.table import Table

GainValue: TypeAlias = float | bool | tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Specification:
    """What the closed loop shall do; the defaults are the paper's case.

    Attributes
    ----------
    slip : float [-]
        Reference.
    speeds : tuple[float, float] [m/s]
        Range of operation.
    slips : tuple[float, float] [-]
        Range of slip in which the surface shall be reached.
    slip_tolerance : float [-]
        Width of the band around the reference.
    sample_time : float [s]
    reference : ReferenceKind or None
        Of a law of a vehicle; None: the one that its family prefers.
    sensors : Sensors
    """

    slip: float = 0.14
    speeds: tuple[float, float] = (10.0 / 3.6, 120.0 / 3.6)
    slips: tuple[float, float] = (0.02, 0.6)
    slip_tolerance: float = 0.05
    sample_time: float = 0.1
    reference: ReferenceKind | None = None
    sensors: Sensors = TOLD

    def __post_init__(self) -> None:
        """Refuse what no wheel can do, in one sentence each."""
        check_numbers(
            "Specification",
            {
                "slip": (self.slip, ""),
                "speeds": (self.speeds, "m/s"),
                "slips": (self.slips, ""),
                "slip_tolerance": (self.slip_tolerance, ""),
                "sample_time": (self.sample_time, "s"),
            },
        )
        low, high = self.speeds
        if not 0.0 < self.slip < 1.0:
            raise UserError(f"slip = {self.slip:g} must lie in (0, 1); for percent write for example 14 %")
        if not 0.0 < low < high < 150.0:
            raise UserError(
                f"speed range = {low * 3.6:g} to {high * 3.6:g} km/h must rise and lie above 0 and below 540 km/h"
            )
        notice_of_fast_train(
            high, "highest speed of the range", f"for km/h write speeds=({low:g} / 3.6, {high:g} / 3.6)"
        )
        if not 0.0 < self.slips[0] < self.slip < self.slips[1] <= 1.0:
            raise UserError(
                f"slip range = {self.slips[0]:g} to {self.slips[1]:g} must lie in (0, 1] "
                f"and contain the slip reference {self.slip:g}"
            )
        if not 0.0 < self.slip_tolerance < 1.0 - self.slip:
            raise UserError(
                f"slip tolerance = {self.slip_tolerance:g} must lie between 0 and {1.0 - self.slip:g}, "
                "the distance of the slip reference from a locked wheel"
            )
        if not 1e-3 <= self.sample_time <= 1.0:
            raise UserError(f"sample time = {self.sample_time:g} s must lie between 1 ms and 1 s")
        if self.reference not in (None, *REFERENCE_KINDS):
            allowed = ", ".join(f'"{kind}"' for kind in REFERENCE_KINDS)
            raise UserError(f'reference = "{self.reference}" must be one of {allowed}')

    def reference_of(self, family: Family) -> ReferenceKind:
        """Return the kind of reference of a law.

        Raises
        ------
        UserError
            If a law of one wheelset is asked for another one than the constant slip that it holds.
        """
        if family.reference is not None:
            return self.reference or family.reference
        if self.reference in (None, "constant"):
            return "constant"
        raise UserError(
            f'reference = "{self.reference}" goes with a law of a vehicle, such as observer-smc; {family.name} holds '
            "a constant slip: leave reference out"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Gain:
    """One number of a design with the rule that chose it.

    Attributes
    ----------
    name : str
    value : GainValue [its unit]
    unit : str
    why : str
    """

    name: str
    value: GainValue
    unit: str
    why: str


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Design:
    """A controller design: everything that is needed to rebuild the controller, and why it is so.

    Attributes
    ----------
    name : str
    law : str
        Family of laws.
    vehicle : str
    vehicle_hash : str
    rail : str
        Design rail.
    rail_hash : str
    specification : Specification
    gains : tuple[Gain, ...]
    vehicle_file : str
        Of a vehicle of one's own, as seen from the folder of the design file.
    rail_file : str
    requirements : Requirements or None
        That it was searched for; rails of one's own as seen from here.
    judged_by : str
        Other requirements of its reports: a template, or a file as seen from the folder of the design file.
    """

    name: str
    law: str
    vehicle: str
    vehicle_hash: str
    rail: str
    rail_hash: str
    specification: Specification
    gains: tuple[Gain, ...]
    vehicle_file: str = ""
    rail_file: str = ""
    requirements: Requirements | None = None
    judged_by: str = ""

    def __repr__(self) -> str:
        """Say in one line what this is."""
        asked = self.specification
        low, high = (KMH * speed for speed in asked.speeds)
        return (
            f"<Design {self.name}: {self.law} for slip {asked.slip:g} at {low:g} to {high:g} km/h, sampled every "
            f"{1e3 * asked.sample_time:g} ms, {len(self.gains)} gains>"
        )

    def _repr_html_(self) -> str:
        return str(later("notebook.designs", "design_card")(self))

    def table(self) -> "Table":
        """Return the gains with unit and the reason for each; print it or let a notebook show it."""
        table: Table = later("notebook.designs", "design_table")(self)
        return table

    def gain(self, name: str) -> GainValue:
        """Return the value of a gain by its name, in the unit of the gain."""
        return next(gain.value for gain in self.gains if gain.name == name)

    def made_on(self, rail: Rail) -> bool:
        """Whether a rail is the design rail: the same name and the same numbers."""
        return rail.name == self.rail and rail_hash(rail) == self.rail_hash

    def build(self, vehicle: Vehicle, rail: Rail) -> Law:
        """Build the controller, of one wheelset or of the vehicle.

        Parameters
        ----------
        vehicle : Vehicle
            The vehicle that the design was made for.
        rail : Rail
            The design rail; sliding mode and torque feedback use it as their friction model.

        Raises
        ------
        UserError
            If vehicle or rail is another one or its numbers have changed since, or a gain has a unit that does not
            fit.
        """
        check_kinds(vehicle, rail, by="Design.build")
        if vehicle.name != self.vehicle:
            raise UserError(
                f"design {self.name} was made for vehicle {self.vehicle}, not for {vehicle.name}; "
                f"use --vehicle {self.vehicle} or make a new design"
            )
        if vehicle_hash(vehicle) != self.vehicle_hash:
            raise UserError(
                f"the numbers of vehicle {vehicle.name} have changed since design {self.name} was made; "
                "re-run wspd design"
            )
        if rail.name != self.rail:
            raise UserError(f"design {self.name} was made on rail {self.rail}, not on {rail.name}")
        if not self.made_on(rail):
            raise UserError(
                f"design {self.name} was made on another rail {rail.name}: its numbers are not those of this one; "
                "give the rail file of the design with --rail, or re-run wspd design"
            )
        family = tunable_family(self.law)
        given = {gain.name: gain for gain in self.gains}
        unit = given.get("torque_unit")
        counted = float(unit.value) * factor(unit.unit) if unit and isinstance(unit.value, float) else 1.0
        numbers = {
            form.name: in_the_law(given[form.name], form, counted)
            for form in family.forms
            if form.name in given
        }
        law = family.build(
            Given(
                name=self.name,
                sample_time=self.specification.sample_time,
                vehicle=vehicle,
                rail=rail,
                numbers=self._record(family, numbers, vehicle),
                sensors=self.specification.sensors,
                reference=self.specification.reference_of(family),
            )
        )
        return seen_by(self.specification.sensors, law, vehicle)

    def _record(self, family: Family, numbers: dict[str, GainValue], vehicle: Vehicle) -> object:
        """Return the record of the gains, or the table of a law of the industry with its factors."""
        if family.gains is not None:
            return family.gains(**{SLIP_REFERENCE: self.specification.slip}, **numbers)
        assert family.tables is not None
        assert family.scales is not None
        assert family.scaled is not None
        return family.scaled(family.tables(usual_table(vehicle)), family.scales(**numbers))


def seen_by(sensors: Sensors, law: Law, vehicle: Vehicle) -> Law:
    """Give a law of one wheelset what the sensors show, by the protection of a vehicle around it.

    Without a word about sensors it is told the train speed and the torque as they are.
    """
    if acts_on_vehicle(law) or sensors == TOLD:
        return law
    return protected(law, vehicle, sensors)


def in_the_law(gain: Gain, form: GainForm, torque_unit: float) -> GainValue:
    """Convert a gain from its unit to the number that the law takes.

    Parameters
    ----------
    gain : Gain
        A gain of a design.
    form : GainForm
        The same gain as the law has it.
    torque_unit : float
        Torque that a gain counts in if it can be counted [N m].

    Raises
    ------
    UserError
        If the unit is unknown or of another dimension.
    """
    quantity, value = form.quantity, gain.value
    allowed = [*units_of(quantity.dimension), *(units_of(quantity.counted) if quantity.counted else ())]
    try:
        found = dimension_of(gain.unit)
    except UserError:
        found = None
    if found not in (quantity.dimension, quantity.counted) or found is None:
        choice = " or ".join(f'"{unit}"' for unit in allowed)
        raise UserError(f'unit = "{gain.unit}" of gain {gain.name} must be {choice}')
    scale = factor(gain.unit)
    if quantity.counted is not None and found == quantity.dimension:
        scale /= torque_unit
    if isinstance(value, bool):
        return value
    return tuple(each * scale for each in value) if isinstance(value, tuple) else value * scale


def vehicle_hash(vehicle: Vehicle) -> str:
    """Fingerprint of all numbers of a vehicle, with their bounds, and of the constants that belong to no vehicle."""
    return fingerprint(vehicle, constants())


def rail_hash(rail: Rail) -> str:
    """Fingerprint of all numbers of a rail, with their bounds, and of the constants that belong to no rail."""
    return fingerprint(rail, constants())
