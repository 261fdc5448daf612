"""What a plant is: the longitudinal motion of a vehicle whose wheelsets are braked one by one.

The state of a plant is the train speed, the states of every wheelset (the first is its wheel speed) and the rest. A
plant may *split*: its motion is that of one wheelset at a time and of the train, and the rest are the load transfers
with their rates of change. Or it is *coupled*: its whole right-hand side is one function. The closed loop takes all
numbers of axles and states from here, runs the functions on CasADi symbols and compiles what comes out; ``vehicle``
then carries symbols in place of numbers.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple, Protocol, TypeGuard

from wspd_design.model.number import Number
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.records import Rail, Vehicle


class AxleCondition(NamedTuple):
    """What follows from time and load alone."""

    stiffness: Number  # N, initial slope of the creep force
    damping: Number  # N m s per wheel


class BrakeTorques(NamedTuple):
    """Brakes of one wheelset at one instant."""

    braking: Number  # N m, of all brakes
    dynamic: Number  # N m, of these that of the electrodynamic brake
    warming: tuple[Number, ...]  # K/s, of the pads where their temperature is a state


class AxleMotion(NamedTuple):
    """One wheelset at one instant; forces and torques of the damping are per wheel."""

    rates: tuple[Number, ...]  # of the states of the wheelset while it rolls; first the wheel, rad/s2
    creep_force: Number  # N
    slip: Number  # -
    damping_torque: Number  # N m
    brake_torque: Number  # N m per wheelset, of all brakes; a locked wheel passes on less
    dynamic_torque: Number  # N m per wheelset, the part of the electrodynamic brake


class TrainMotion(NamedTuple):
    """The train at one instant."""

    acceleration: Number  # m/s2
    resistance: Number  # N, running resistance and track brake
    transfer_rates: tuple[Number, ...]  # of the load transfers and of their rates


class CoupledMotion(NamedTuple):
    """A whole vehicle at one instant; forces and loads are per wheel, means of both wheels of an axle."""

    acceleration: Number  # m/s2, of the train
    wheel_rates: tuple[Number, ...]  # rad/s2
    rest_rates: tuple[Number, ...]  # of the rest, in its order
    creep_forces: tuple[Number, ...]  # N, positive where they brake
    slips: tuple[Number, ...]  # -
    wheel_loads: tuple[Number, ...]  # N
    transmitted: tuple[Number, ...]  # N m per wheelset; what a lock takes, as long as the brake gives more
    further: tuple[tuple[Number, ...], ...] = ()  # one row for each of the further traces, one number an axle


class Plant(Protocol):
    """A vehicle as the closed loop sees it; its wheelsets are numbered from the front."""

    @property
    def name(self) -> str:
        """Name in options, records and reports."""

    @property
    def vehicle(self) -> Vehicle:
        """Its numbers."""

    @property
    def axles(self) -> int:
        """Number of wheelsets, each with a brake and a controller of its own."""

    @property
    def axle_states(self) -> int:
        """Number of states of one wheelset."""

    @property
    def rest_states(self) -> int:
        """Number of states beyond the train speed and those of the wheelsets."""

    @property
    def longest_step(self) -> float:
        """Longest step that motions beside that of the slip allow [s]."""

    @property
    def alike(self) -> bool:
        """Tell whether all wheelsets move alike, so that one stands for all."""

    @property
    def offsets(self) -> tuple[Number, ...]:
        """Distance of each axle behind the first one [m]."""

    def on(self, vehicle: Vehicle) -> "Plant":
        """Return the same plant with the numbers of another vehicle of as many wheelsets."""

    def rest_at(self, speed: float, wheel_speeds: tuple[float, ...]) -> tuple[float, ...]:
        """Return the rest of the state where a stop begins, in equilibrium at a train speed and wheel speeds."""

    def wheel_damping(self, time: Number) -> Number:
        """Damping of a wheel some time [s] after the brake was applied [N m s]."""

    def brake_torques(
        self, states: tuple[Number, ...], torque: Number, dynamic_level: Number
    ) -> BrakeTorques:
        """Torques on one wheelset under the nominal one of its friction brake, and what warms its pads.

        The torque per wheelset [N m] is that of eq. (12); the level is the share to which the electrodynamic brake is
        built up.
        """

    def track_brake_force(self, speed: Number, time: Number) -> Number:
        """Force of the magnets on the train, some time [s] after the brake was applied [N]."""

    def loads_at_rest(self) -> tuple[Number, ...]:
        """Vertical load of one wheel of each axle before any load moves [N]."""

    def creep_rate(self, rail: Rail, speed: Number) -> Number:
        """Fastest rate of the slip on the adhering side, which limits an explicit step [1/s]."""


class SplitPlant(Plant, Protocol):
    """A plant whose wheelsets meet in the train and in the load transfers alone."""

    @property
    def transfers(self) -> int:
        """Number of load transfers; each is a state, and so is its rate."""

    def wheel_loads(self, transfers: tuple[Number, ...]) -> tuple[Number, ...]:
        """Vertical load of one wheel of each axle under the load transfers and their rates [N]."""

    def axle_condition(self, *, time: Number, wheel_load: Number) -> AxleCondition:
        """Return stiffness and damping of one wheelset; the time counts from the application of the brake."""

    def axle_motion(
        self,
        rail: Rail,
        *,
        speed: Number,
        states: tuple[Number, ...],
        wheel_load: Number,
        torque: Number,
        condition: AxleCondition,
        dynamic_level: Number = 0.0,
    ) -> AxleMotion:
        """Creep force and rates of one wheelset.

        The torque per wheelset [N m] is the nominal one of the friction brake, eq. (12); the level is the share to
        which the electrodynamic brake is built up.
        """

    def train_motion(
        self,
        *,
        speed: Number,
        creep_forces: tuple[Number, ...],
        transfers: tuple[Number, ...],
        time: Number = math.inf,
        grade_force: Number = 0.0,
    ) -> TrainMotion:
        """Acceleration of the train with one creep force per wheel of each axle, and the load transfers' rates.

        The time counts from the application of the brake, and the resistance is with that of a track brake.
        """


TRACK_CHANNELS = ("vertical", "lateral", "cross_level")
"""Irregularities of the track [m, m, rad] that a coupled plant sees under each wheelset."""


PLANAR_NUMBERS = (
    *("body_mass", "bogie_mass", "body_height", "bogie_height", "traction_rod_height"),
    *("body_pitch_frequency", "bogie_pitch_frequency", "pitch_damping_ratio"),
)
"""Numbers of a vehicle by which load moves on the planar plant; a coupled plant has others in their place."""


class CoupledPlant(Plant, Protocol):
    """A plant whose right-hand side is one function."""

    @property
    def model(self) -> object:
        """What the function is made from beyond the vehicle."""

    @property
    def side_by_side(self) -> bool:
        """Tell whether stops side by side take less time than one after the other; large code gains nothing."""

    @property
    def number_names(self) -> tuple[str, ...]:
        """Names of its numbers beyond those of the vehicle, in the order of ``numbers``."""

    @property
    def numbers(self) -> tuple[float, ...]:
        """Numbers beyond those of the vehicle, or that follow from them."""

    @property
    def further_traces(self) -> Mapping[str, str]:
        """Units of the traces that it adds, by their names; each has one number an axle."""

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
        grade_force: Number,
    ) -> CoupledMotion:
        """Rates of all states, and what else the loop follows.

        Parameters
        ----------
        rails : tuple of Rail
            Below each axle.
        numbers : tuple of number
            In the order of ``number_names``.
        speed, wheel_speeds, rest
            The state [m/s; rad/s].
        torques : tuple of number
            Of all brakes of each wheelset [N m].
        locked : tuple of number
            1 for a wheelset that does not turn, 0 for another.
        damping : tuple of number
            Of one wheel of each axle [N m s].
        track : tuple of tuple of number
            Irregularities below each axle, one row for each of ``TRACK_CHANNELS``.
        resistance : number
            Running resistance with that of a track brake and the pull of the grade [N].
        grade_force : number
            The last of these alone [N].
        """

    @property
    def own_bounds(self) -> Mapping[str, Ends]:
        """Bounds of the numbers of its file, by their names; those that are the vehicle's are left out."""

    def with_own(self, numbers: Mapping[str, float]) -> "CoupledPlant":
        """Return the same plant with other numbers of its file."""

    def as_filed(self) -> "CoupledPlant":
        """Return the same plant with the numbers of its file."""

    def creep_growth(self, rail: Rail) -> float:
        """Return the fastest rate of creep over that of rigid wheelsets with the inertia of the vehicle, at least 1."""


def is_coupled(plant: Plant) -> TypeGuard[CoupledPlant]:
    """Tell whether the right-hand side of a plant is one function."""
    return hasattr(plant, "motion")


def is_split(plant: Plant) -> TypeGuard[SplitPlant]:
    """Tell whether a plant has a function for each wheelset."""
    return hasattr(plant, "axle_motion")
