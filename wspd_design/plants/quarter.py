"""The quarter model: equal wheels under one train mass, eqs. (1)-(7).

All wheels carry the static load, so one wheelset stands for all of them. It is the planar vehicle without heights
and with equal rails, for any number of wheelsets.
"""

import math
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

from wspd_design.model import slip as slip_model
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.axle import RigidWheelsets
from wspd_design.plants.protocol import AxleCondition, TrainMotion


@dataclass(frozen=True, slots=True)
class Quarter(RigidWheelsets):
    """The plant without load transfer."""

    vehicle: Vehicle
    name: ClassVar[str] = "quarter"
    alike: ClassVar[bool] = True

    @property
    def transfers(self) -> int:
        """No load is transferred."""
        return 0

    @property
    def offsets(self) -> tuple[Number, ...]:
        """The vehicle is a point [m]."""
        return (0.0,) * self.axles

    def on(self, vehicle: Vehicle) -> "Quarter":
        """Return the same plant with the numbers of another vehicle."""
        return replace(self, vehicle=vehicle)

    def wheel_loads(self, transfers: tuple[Number, ...]) -> tuple[Number, ...]:  # noqa: ARG002 - there are none
        """Static load of one wheel of each axle [N]."""
        return (slip_model.static_wheel_load(self.vehicle),) * self.axles

    def train_motion(
        self,
        *,
        speed: Number,
        creep_forces: tuple[Number, ...],
        transfers: tuple[Number, ...] = (),  # noqa: ARG002 - there are none
        time: Number = math.inf,
        grade_force: Number = 0.0,
    ) -> TrainMotion:
        """Acceleration of the train, eq. (1)."""
        resistance = slip_model.resistance(self.vehicle, speed, grade_force)
        if self.vehicle.track_brake is not None:
            resistance += self.track_brake_force(speed, time)
        mean = sum(creep_forces) / self.axles
        return TrainMotion(
            acceleration=slip_model.train_acceleration(self.vehicle, mean, resistance),
            resistance=resistance,
            transfer_rates=(),
        )


class Motion(NamedTuple):
    """Accelerations and forces of the quarter model at one instant."""

    acceleration: Number  # m/s2, train
    wheel_acceleration: Number  # rad/s2
    slip: Number  # -
    creep_force: Number  # N per wheel
    resistance: Number  # N
    wheel_damping: Number  # N m s per wheel


@dataclass(frozen=True, slots=True, kw_only=True)
class QuarterOnRail:
    """The quarter model on one rail, with what does not change during a stop worked out once."""

    plant: Quarter
    rail: Rail
    wheel_load: Number  # N
    stiffness: Number  # N, initial slope of the creep force

    def motion(self, time: Number, speed: Number, wheel_speed: Number, torque: Number) -> Motion:
        """Accelerations while the wheel rolls, eqs. (1), (2).

        Parameters
        ----------
        time : number
            Since the start of braking [s].
        speed : number
            Train speed [m/s].
        wheel_speed : number
            Angular speed [rad/s].
        torque : number
            Nominal torque of the friction brake per wheelset [N m].
        """
        plant = self.plant
        damping = plant.axle_condition(time=time, wheel_load=self.wheel_load).damping
        axle = plant.axle_motion(
            self.rail,
            speed=speed,
            states=(wheel_speed,),
            wheel_load=self.wheel_load,
            torque=torque,
            condition=AxleCondition(stiffness=self.stiffness, damping=damping),
        )
        train = plant.train_motion(speed=speed, creep_forces=(axle.creep_force,) * plant.axles, time=time)
        return Motion(
            acceleration=train.acceleration,
            wheel_acceleration=axle.rates[0],
            slip=axle.slip,
            creep_force=axle.creep_force,
            resistance=train.resistance,
            wheel_damping=damping,
        )

    def creep_rate(self, speed: Number) -> Number:
        """Fastest rate of the slip on the adhering side, which limits an explicit step [1/s]."""
        return self.plant.creep_rate(self.rail, speed)


def quarter(vehicle: Vehicle, rail: Rail) -> QuarterOnRail:
    """Put a vehicle on a rail."""
    plant, load = Quarter(vehicle), slip_model.static_wheel_load(vehicle)
    stiffness = plant.axle_condition(time=0.0, wheel_load=load).stiffness
    return QuarterOnRail(plant=plant, rail=rail, wheel_load=load, stiffness=stiffness)
