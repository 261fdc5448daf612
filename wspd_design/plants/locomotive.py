"""A multibody vehicle as a plant: all degrees of freedom of its data file on eight wheels, or as many as it has.

The file is named by ``multibody`` of the vehicle. What both hold is the vehicle's: mass, of which the car body is what
the other bodies leave; wheel radius, wheelbase and spacing of bogies, and the effective moment of inertia of a
wheelset, of which the rotors are what the other parts leave. Brakes, contact and running resistance are the vehicle's,
all else is the file's.

A locked wheelset is held by its pads, with the frame that carries them, whatever its driveline asks for: wheels that
would turn backwards are not followed.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from types import MappingProxyType
from typing import Any, ClassVar, Final, Self

from wspd_design.model import adhesion
from wspd_design.model import slip as slip_model
from wspd_design.model.number import Number
from wspd_design.model.wheel_rail import WheelRail, wheel_rail
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import steel
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.axle import BrakedWheelsets
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.motion import rest_names, rolling, vehicle_motion
from wspd_design.plants.multibody.preloads import balanced, rest_function
from wspd_design.plants.multibody.records import Multibody, effective_inertia, gears_of
from wspd_design.plants.multibody.wheels import Irregularity
from wspd_design.plants.planar import Planar
from wspd_design.plants.protocol import CoupledMotion

_SHARED: Final = ("mass", "wheel_radius", "wheelbase", "bogie_spacing")
"""Numbers of the file that are those of the vehicle."""
_CONTACT: Final = ("normal_stiffness", "kalker_c22", "kalker_c23", "lateral_slope")
_WHEELS: Final = 2  # of one axle
_SAME_PLACE: Final = 1e-3  # of the distance


@dataclass(frozen=True, slots=True)
class Locomotive(BrakedWheelsets):
    """The multibody vehicle with finite rotations."""

    vehicle: Vehicle
    changed: tuple[tuple[str, float], ...] = field(default=(), compare=False)
    """Numbers of the file that are others here, by their names.

    All are inputs of the motion: plants that differ in these alone are one to what is traced or compiled from them.
    """
    name: ClassVar[str] = "locomotive"
    alike: ClassVar[bool] = False
    linear: ClassVar[bool] = False
    side_by_side: ClassVar[bool] = False
    longest: ClassVar[float] = 5e-4  # s
    further_traces: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "wheel_load_left": "N",
            "wheel_load_right": "N",
            "lateral_position": "m",
            "driveline_torque": "N m",
        }
    )

    def __post_init__(self) -> None:
        """Refuse a vehicle without a multibody file, or with one of another vehicle."""
        vehicle = self.vehicle
        if not vehicle.multibody:
            raise UserError(
                f'vehicle {vehicle.name} names no multibody file, which plant "{self.name}" needs; add '
                '"multibody" to its file, or take the plant "planar"'
            )
        if self.model.wheelsets != vehicle.wheelsets:
            raise UserError(
                f"vehicle {vehicle.name} has {vehicle.wheelsets} wheelsets and its multibody file "
                f"{vehicle.multibody} {self.model.wheelsets}; let both have as many"
            )
        with_brake = {brake.wheelset for brake in self.model.brakes}
        pairs = zip(self.model.wheelset_names, vehicle.braked, strict=True)
        bare = next((name for name, braked in pairs if braked and name not in with_brake), "")
        if bare:
            raise UserError(
                f"vehicle {vehicle.name} brakes {bare}, on which its multibody file {vehicle.multibody} has no brake; "
                "add one to [brakes] there, or give the axle the share 0"
            )

    @property
    def model(self) -> Multibody:
        """Topology, and the numbers of the file."""
        return _of_file(self.vehicle.multibody, self.changed)

    @property
    def own_bounds(self) -> dict[str, Ends]:
        """Bounds of the numbers of the file that are not those of the vehicle [SI units]."""
        model = self.model
        gears = [gear for name in model.wheelset_names for gear in gears_of(model, name)]
        rests = [model.body(gear.rotor) for gear in gears] or [model.body(model.wheelset_names[0])]
        shared = {*_SHARED, *(f"{body.kind}.inertia_axial" for body in rests)}
        return {name: ends for name, ends in dict(model.bounds).items() if name not in shared}

    def with_number(self, name: str, value: float) -> Self:
        """Return the same plant with another value of one number of the file."""
        return replace(self, changed=(*self.changed, (name, value)))

    def with_own(self, numbers: Mapping[str, float]) -> Self:
        """Return the same plant with other numbers of its file."""
        return replace(self, changed=(*self.changed, *numbers.items()))

    def as_filed(self) -> Self:
        """Return the same plant with the numbers of its file."""
        return replace(self, changed=())

    @property
    def offsets(self) -> tuple[Number, ...]:
        """Distance of each axle behind the first one [m]."""
        model = _with_totals(self.model, self.vehicle)
        first, *others = (model.length(model.body(name).at[0]) for name in model.wheelset_names)
        return (0.0, *(first - place for place in others))

    @property
    def rest_states(self) -> int:
        """Number of coordinates and rates beyond train speed and wheel speeds."""
        return len(rest_names(self.model))

    @property
    def longest_step(self) -> float:
        """Longest step that bounce of wheels on rails and driveline allow [s]."""
        return self.longest

    @property
    def number_names(self) -> tuple[str, ...]:
        """Numbers of the file, preloads, and what the contact adds to that of the vehicle."""
        model = self.model
        return (*model.number_names, *(f"preload.{name}" for name in model.preload_names), *_CONTACT)

    @property
    def numbers(self) -> tuple[float, ...]:
        """These numbers for the vehicle."""
        return _numbers(self.vehicle, self.changed)

    def on(self, vehicle: Vehicle) -> Self:
        """Return the same plant with the numbers of another vehicle."""
        return replace(self, vehicle=vehicle)

    def rest_at(self, speed: float, wheel_speeds: tuple[float, ...]) -> tuple[float, ...]:
        """Return the vehicle at rest in its springs, with rotors that turn with their wheels."""
        return rolling(self.model, speed, wheel_speeds)

    def loads_at_rest(self) -> tuple[Number, ...]:
        """Vertical load of one wheel of each axle at rest, mean of both [N]."""
        at_rest = dict(zip(self.number_names, self.numbers, strict=True))
        return tuple(
            0.5 * (at_rest[f"preload.{name}.left"] + at_rest[f"preload.{name}.right"])
            for name in self.model.wheelset_names
        )

    def motion(
        self,
        rails: tuple[Rail, ...],
        *,
        numbers: tuple[Number, ...],
        speed: Number,
        wheel_speeds: tuple[Number, ...],
        rest: tuple[Number, ...],
        torques: tuple[Number, ...],
        locked: tuple[Number, ...],
        damping: tuple[Number, ...],
        track: tuple[tuple[Number, ...], ...],
        resistance: Number,
        grade_force: Number,  # noqa: ARG002 - it pulls at the center of the car body, as the resistance does
    ) -> CoupledMotion:
        """Rates of all states, and the further traces."""
        import casadi as ca

        topology = self.model
        given, preloads = len(topology.number_names), len(topology.preload_names)
        model = topology.with_numbers(dict(zip(topology.number_names, numbers, strict=False)))
        model = model.with_preloads(
            dict(zip(topology.preload_names, numbers[given : given + preloads], strict=True))
        )
        contact = dict(zip(_CONTACT, numbers[given + preloads :], strict=True))
        found = vehicle_motion(
            model,
            WheelRail(contact=self.vehicle.contact, **contact),
            speed=speed,
            wheel_speeds=wheel_speeds,
            rest=ca.vertcat(*rest),
            torques=torques,
            locked=locked,
            rails=rails,
            irregularities=tuple(Irregularity(*under) for under in zip(*track, strict=True)),
            resistance=resistance,
            damping=damping[0],
            linear=self.linear,
        )
        return CoupledMotion(
            acceleration=found.acceleration,
            wheel_rates=found.wheel_rates,
            rest_rates=tuple(ca.vertsplit(found.rest_rates)),
            creep_forces=found.creep_forces,
            slips=found.slips,
            wheel_loads=found.wheel_loads,
            transmitted=found.transmitted,
            further=(found.wheel_loads_left, found.wheel_loads_right, found.lateral, found.torsion),
        )

    def creep_rate(self, rail: Rail, speed: Number) -> Number:
        """Fastest rate of creep under the static load, along the rail or across it [1/s].

        A wheelset spins against the torsion of its driveline, without the rotor.
        """
        vehicle, numbers = self.vehicle, dict(zip(self.number_names, self.numbers, strict=True))
        body = self.model.body(self.model.wheelset_names[0])
        mass, spin = numbers[f"{body.kind}.mass"], numbers[f"{body.kind}.inertia_axial"]
        along = 0.5 * (rail.adhesion_reduction + rail.slip_reduction)
        across = numbers["lateral_slope"] * numbers["kalker_c22"] / vehicle.contact.kalker_c11
        per_slip = max(along * (vehicle.wheel_radius**2 / spin + 1.0 / mass), across / mass)
        return self._kalker_slope * per_slip / speed

    def creep_growth(self, rail: Rail) -> float:
        """Return this rate over that of a rigid wheelset with all that turns with it, in its place."""
        along = 0.5 * (rail.adhesion_reduction + rail.slip_reduction)
        rigid = self._kalker_slope * along * self.vehicle.wheel_radius**2 / self.vehicle.wheelset_inertia
        return float(self.creep_rate(rail, 1.0) / rigid)

    @property
    def _kalker_slope(self) -> Number:
        """Initial slope of the force of an axle over its creepage by Kalker's theory, under the static load [N]."""
        load = slip_model.static_wheel_load(self.vehicle)
        return _WHEELS * 4.0 / math.pi * adhesion.contact_stiffness(self.vehicle.contact, load)


def _of_file(name: str, changed: tuple[tuple[str, float], ...]) -> Multibody:
    model = load_multibody(name)
    return model.with_numbers(dict(changed)) if changed else model


@lru_cache(maxsize=256)
def _numbers(vehicle: Vehicle, changed: tuple[tuple[str, float], ...]) -> tuple[float, ...]:
    """Numbers of the multibody vehicle with the totals of a vehicle, in the order of ``number_names``."""
    _check_places(vehicle)
    model = balanced(_with_totals(_of_file(vehicle.multibody, changed), vehicle), _rest(vehicle.multibody))
    touching = wheel_rail(vehicle.contact, poisson=steel().poisson)
    contact = (getattr(touching, name) for name in _CONTACT)
    return tuple(map(float, (*model.numbers.values(), *model.preloads.values(), *contact)))


def _check_places(vehicle: Vehicle) -> None:
    """Refuse a multibody file whose axles stand elsewhere than those of the vehicle."""
    if vehicle.wheelsets == 1:
        return
    places = zip(Locomotive(vehicle).offsets, Planar(vehicle).offsets, strict=True)
    for axle, (place, wanted) in enumerate(places, 1):
        if abs(place - wanted) > _SAME_PLACE * wanted:
            raise UserError(
                f"axle {axle} of vehicle {vehicle.name} stands {wanted:g} m behind the first one, and in its multibody "
                f"file {vehicle.multibody} {place:g} m; let both agree (wheelbase, bogie_spacing)"
            )


@cache
def _rest(name: str) -> Any:
    return rest_function(load_multibody(name))


def _with_totals(model: Multibody, vehicle: Vehicle) -> Multibody:
    """The multibody vehicle with the numbers that are those of the vehicle."""
    stated = {name: getattr(vehicle, name) for name in _SHARED if name in model.numbers}
    # A vehicle of single axles has no wheelbase.
    shared: dict[str, Number] = {name: value for name, value in stated.items() if value}
    for name in model.wheelset_names:
        shared |= _inertia_of_rest(model, vehicle, name)
    light = min(model.with_numbers(shared).mass(body) for body in model.bodies)
    if light <= 0.0:
        raise UserError(
            f"mass = {vehicle.mass:g} kg of vehicle {vehicle.name} leaves {model.remainder} of its multibody file "
            f"{vehicle.multibody} {light:g} kg; raise it, or lower the masses of the other bodies"
        )
    return model.with_numbers(shared)


def _inertia_of_rest(model: Multibody, vehicle: Vehicle, wheelset: str) -> dict[str, Number]:
    """Moment of inertia of what takes the rest of that of a wheelset: its rotor, or itself without a gear [kg m2]."""
    gears = list(gears_of(model, wheelset))
    body = model.body(gears[0].rotor if gears else wheelset)
    ratio = model.numbers[f"{gears[0].kind}.ratio"] if gears else 1.0
    key = f"{body.kind}.inertia_axial"
    rest = (vehicle.wheelset_inertia - effective_inertia(model.with_numbers({key: 0.0}), wheelset)) / (
        ratio**2 * max(len(gears), 1)
    )
    if rest <= 0.0:
        raise UserError(
            f"wheelset_inertia = {vehicle.wheelset_inertia:g} kg m2 of vehicle {vehicle.name} leaves {body.name} of "
            f"its multibody file {vehicle.multibody} nothing; raise it, or lower the other moments of inertia"
        )
    return {key: rest}


@dataclass(frozen=True, slots=True)
class LinearLocomotive(Locomotive):
    """The same with suspension and inertia expanded about rest; the contact stays as it is."""

    name: ClassVar[str] = "locomotive-linear"
    linear: ClassVar[bool] = True
    side_by_side: ClassVar[bool] = True
    longest: ClassVar[float] = 1e-3  # s
