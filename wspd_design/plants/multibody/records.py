"""A vehicle of bodies, joints, springs, dampers, gears and brakes: its topology, and its numbers apart from it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias

from wspd_design.model.number import Number
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.words import did_you_mean

Joint: TypeAlias = Literal["free", "wheelset", "revolute", "rotor"]
"""How a body moves: free; free, in a frame that does not spin; turning on another body; spinning in another body."""

DIRECTIONS = ("x", "y", "z", "roll", "pitch", "yaw")
"""Coordinates of a body with six degrees of freedom: forward, left, up, and turns about these axes."""

SIDES = ("left", "right")
"""Wheels of a wheelset: at positive and at negative y."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A multiple of one number: ``-0.5 wheelbase``."""

    factor: float
    number: str


Length: TypeAlias = tuple[Term, ...]
"""Sum of terms, in m; empty: zero."""

Place: TypeAlias = tuple[Length, Length, Length]
"""Point of the vehicle at rest: forward of its middle, left of it, above the rail."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A rigid body. Its numbers are those whose names begin with ``kind`` and a point."""

    name: str
    kind: str
    joint: Joint
    at: Place  # center of gravity
    on: str = ""  # body that it turns on
    axis: Place | None = None  # of the turn, parallel to y; None: through the center of the other body

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of its coordinates."""
        if self.joint in ("free", "wheelset"):
            return tuple(f"{self.name}.{direction}" for direction in DIRECTIONS)
        return (f"{self.name}.turn",)


@dataclass(frozen=True, slots=True, kw_only=True)
class Spring:
    """Springs and dampers side by side at one point, by components in the axes of the first body."""

    name: str
    kind: str
    between: tuple[str, str]
    at: Place
    carries: bool  # part of the weight, by a vertical preload


@dataclass(frozen=True, slots=True, kw_only=True)
class Rod:
    """A rod with elastic ends: spring and damper along the line from a point of one body to one of another."""

    name: str
    kind: str
    between: tuple[str, str]
    ends: tuple[Place, Place]


@dataclass(frozen=True, slots=True, kw_only=True)
class BumpStop:
    """A spring along one axis of the first body whose force over travel is a table, the same to both sides."""

    name: str
    kind: str
    between: tuple[str, str]
    at: Place
    axis: Literal["x", "y", "z"]
    points: int  # of the table


@dataclass(frozen=True, slots=True, kw_only=True)
class Gear:
    """A motor that drives a wheelset: rotor, torsion spring, pinion in a housing that turns on the axle, wheel.

    The pinion turns by (1 + ratio) times the turn of the housing less ratio times that of the wheelset.
    """

    name: str
    kind: str
    housing: str  # turns on a wheelset
    rotor: str  # turns in a motor


@dataclass(frozen=True, slots=True, kw_only=True)
class CaliperBrake:
    """Friction forces on a wheelset, parallel to its vertical, and their reactions on the body with the calipers."""

    name: str
    kind: str
    frame: str
    wheelset: str
    levers: tuple[Length, ...]  # m, of the forces forward of the axle; they share the torque equally


@dataclass(frozen=True, slots=True, kw_only=True)
class Multibody:
    """A vehicle; the number of its bodies, elements and wheelsets is free.

    The first body is the one whose speed is that of the vehicle. Wheelsets stand in their order from the front.
    """

    name: str
    title: str
    bodies: tuple[Body, ...]
    springs: tuple[Spring, ...]
    rods: tuple[Rod, ...]
    stops: tuple[BumpStop, ...]
    gears: tuple[Gear, ...]
    brakes: tuple[CaliperBrake, ...]
    remainder: str  # the body whose mass is that of the vehicle less all others
    numbers: Mapping[str, Number]  # SI
    entries: Mapping[str, Entry]  # their history
    preloads: Mapping[str, Number] = field(default_factory=dict)  # N; empty until they are worked out

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of all coordinates, body by body."""
        return tuple(name for body in self.bodies for name in body.coordinates)

    @property
    def wheelset_names(self) -> tuple[str, ...]:
        """Names of the wheelsets, from the front."""
        return tuple(body.name for body in self.bodies if body.joint == "wheelset")

    @property
    def wheelsets(self) -> int:
        """Number of wheelsets."""
        return len(self.wheelset_names)

    @property
    def wheel_names(self) -> tuple[str, ...]:
        """Names of the wheels: of each wheelset left, then right."""
        return tuple(f"{name}.{side}" for name in self.wheelset_names for side in SIDES)

    @property
    def number_names(self) -> tuple[str, ...]:
        """Names of all numbers, in the order in which run-time parameters hold them."""
        return tuple(self.numbers)

    @property
    def preload_names(self) -> tuple[str, ...]:
        """What holds the vehicle at rest: springs by their names, wheels, and rails sideways under each wheelset."""
        return (
            *(spring.name for spring in self.springs if spring.carries),
            *self.wheel_names,
            *(f"{name}.sideways" for name in self.wheelset_names),
        )

    @property
    def bounds(self) -> Bounds:
        """Bounds of the uncertain numbers [SI units]."""
        return Bounds.of({name: e.bounds for name, e in self.entries.items() if e.bounds is not None})

    def body(self, name: str) -> Body:
        """Return a body by its name."""
        return next(body for body in self.bodies if body.name == name)

    def with_numbers(self, numbers: Mapping[str, Number]) -> "Multibody":
        """Return the same topology with some other numbers, or symbols; its preloads are to be worked out anew.

        Raises
        ------
        UserError
            If the vehicle has no number of a name.
        """
        for name in numbers:
            if name not in self.numbers:
                raise UserError(
                    f'multibody vehicle {self.name} has no number "{name}"{did_you_mean(name, self.numbers)}; '
                    "its number_names tell them all."
                )
        merged = {name: numbers.get(name, value) for name, value in self.numbers.items()}
        return replace(self, numbers=merged, preloads={})

    def with_preloads(self, preloads: Mapping[str, Number]) -> "Multibody":
        """Return the same vehicle with these preloads, by the names of :attr:`preload_names`."""
        return replace(self, preloads={name: preloads[name] for name in self.preload_names})

    @property
    def parameters(self) -> tuple[Number, ...]:
        """Run-time parameters: numbers, then preloads, in the order of their names."""
        return (*self.numbers.values(), *self.preloads.values())

    def with_parameters(self, values: Sequence[Number]) -> "Multibody":
        """Return the same topology with other run-time parameters, such as symbols."""
        count = len(self.numbers)
        numbers = dict(zip(self.number_names, values[:count], strict=True))
        return self.with_numbers(numbers).with_preloads(
            dict(zip(self.preload_names, values[count:], strict=True))
        )

    def length(self, terms: Length) -> Number:
        """Return a length [m]."""
        return sum((term.factor * self.numbers[term.number] for term in terms), 0.0)

    def place(self, place: Place) -> tuple[Number, Number, Number]:
        """Return the coordinates of a point at rest [m]."""
        x, y, z = (self.length(terms) for terms in place)
        return x, y, z

    def offset(self, to: Place, start: Place) -> tuple[Number, Number, Number]:
        """Return the vector from one place to another at rest [m]; what cancels out is exactly zero."""
        x, y, z = (self.length(_difference(a, b)) for a, b in zip(to, start, strict=True))
        return x, y, z

    def mass(self, body: Body) -> Number:
        """Return the mass of a body [kg]."""
        if body.name != self.remainder:
            return self.numbers[f"{body.kind}.mass"]
        return self.numbers["mass"] - sum(self.mass(other) for other in self.bodies if other is not body)

    def inertia(self, body: Body) -> tuple[Number, Number, Number]:
        """Return the moments of inertia of a body about its center of gravity and its axes [kg m2]."""
        numbers, kind = self.numbers, body.kind
        if f"{kind}.inertia_axial" in numbers:
            across = numbers[f"{kind}.inertia_transverse"]
            return across, numbers[f"{kind}.inertia_axial"], across
        if f"{kind}.gyration_x" in numbers:
            mass = self.mass(body)
            x, y, z = (mass * numbers[f"{kind}.gyration_{axis}"] ** 2 for axis in "xyz")
            return x, y, z
        x, y, z = (numbers[f"{kind}.inertia_{axis}"] for axis in "xyz")
        return x, y, z


def _difference(length: Length, other: Length) -> Length:
    factors = dict[str, float]()
    for sign, terms in ((1.0, length), (-1.0, other)):
        for term in terms:
            factors[term.number] = factors.get(term.number, 0.0) + sign * term.factor
    return tuple(Term(factor=factor, number=number) for number, factor in factors.items() if factor != 0.0)


def gears_of(model: Multibody, wheelset: str) -> Iterator[Gear]:
    """Yield the gears on a wheelset."""
    return (gear for gear in model.gears if model.body(gear.housing).on == wheelset)


def effective_inertia(model: Multibody, wheelset: str) -> Number:
    """Return the moment of inertia of all that turns with a rolling wheelset, referred to its speed [kg m2]."""
    total = model.inertia(model.body(wheelset))[1]
    for gear in gears_of(model, wheelset):
        ratio = model.numbers[f"{gear.kind}.ratio"]
        rotor = model.inertia(model.body(gear.rotor))[1]
        total += ratio**2 * (rotor + model.numbers[f"{gear.kind}.pinion_inertia"])
    return total
