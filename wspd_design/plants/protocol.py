"""What a plant is: the longitudinal motion of a vehicle whose wheelsets are braked one by one.

The state of a plant is the train speed, the states of every wheelset (the first is its wheel speed) and the load
transfers with their rates of change. The closed loop takes all numbers of axles and states from here, runs the
functions on CasADi symbols and compiles what comes out; ``vehicle`` then carries symbols in place of numbers.
"""

import math
from typing import NamedTuple, Protocol

from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle


class AxleCondition(NamedTuple):
    """What follows from time and load alone."""

    stiffness: Number  # N, initial slope of the creep force
    damping: Number  # N m s per wheel


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
    def transfers(self) -> int:
        """Number of load transfers; each is a state, and so is its rate."""

    @property
    def alike(self) -> bool:
        """Tell whether all wheelsets move alike, so that one stands for all."""

    @property
    def offsets(self) -> tuple[Number, ...]:
        """Distance of each axle behind the first one [m]."""

    def on(self, vehicle: Vehicle) -> "Plant":
        """Return the same plant with the numbers of another vehicle of as many wheelsets."""

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

    def creep_rate(self, rail: Rail, speed: Number) -> Number:
        """Fastest rate of the slip on the adhering side, which limits an explicit step [1/s]."""
