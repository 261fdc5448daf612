"""What a source of the train speed is: a sampled difference equation (state, what is seen) -> (state, estimate).

Like a controller it is written with the functions of :mod:`wspd_design.model.number`, so that it can be traced.
"""

from typing import NamedTuple, Protocol

from wspd_design.controllers.protocol import State, VehicleMeasurement
from wspd_design.model.number import Number

TRAIN_ACCELERATION = "train_acceleration"
"""Name in ``memory`` of the acceleration that belongs to the train speed [m/s2]."""


class SpeedEstimate(NamedTuple):
    """What a source says at a sampling instant; a tuple has one element for each wheelset, front first."""

    speed: Number  # m/s, of the train
    acceleration: Number  # m/s2, negative while it brakes
    release: tuple[
        Number, ...
    ]  # 1 for a wheelset whose brake has to be vented, so that it rolls and shows the speed
    hold: tuple[Number, ...]  # 1 for a wheelset whose valve has to hold, because it shows the speed now


class SpeedSource(Protocol):
    """Where a wheel slide protection has its train speed from."""

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of its state."""

    def start(self, seen: VehicleMeasurement) -> State:
        """Return the state before the first sample."""

    def step(
        self,
        state: State,
        seen: VehicleMeasurement,
        friction_torques: tuple[Number, ...],
        slip_references: tuple[Number, ...],
    ) -> tuple[State, SpeedEstimate]:
        """Return the state after this sample and the train speed.

        Parameters
        ----------
        state : tuple of number
            That after the last sample.
        seen : VehicleMeasurement
            What the sensors show now.
        friction_torques : tuple of number
            Torque with which the rail turned each wheelset, as the law had it at the last sample [N m].
        slip_references : tuple of number
            Slip that the law then held each wheelset at [-].
        """
