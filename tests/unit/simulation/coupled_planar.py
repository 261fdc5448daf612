"""The planar plant written as a coupled one: the same equations, behind the other form of the loop."""

import math
from dataclasses import dataclass, replace
from typing import ClassVar

from wspd_design.model.number import where
from wspd_design.plants.axle import BrakedWheelsets
from wspd_design.plants.planar import Planar
from wspd_design.plants.protocol import AxleCondition, CoupledMotion


@dataclass(frozen=True, slots=True)
class CoupledPlanar(BrakedWheelsets):
    """Planar motion as one function; the load that the track adds, in place of an irregularity, is a further trace."""

    vehicle: object
    track_gain: float = 0.0  # relative load of a wheel over the height of the rail [1/m]
    name: ClassVar[str] = "coupled planar"
    alike: ClassVar[bool] = False
    model: ClassVar[None] = None
    side_by_side: ClassVar[bool] = True
    number_names: ClassVar[tuple[str, ...]] = ("track_gain",)
    further_traces: ClassVar[dict[str, str]] = {"doubled_load": "N"}

    @property
    def planar(self):
        return Planar(self.vehicle)

    @property
    def numbers(self):
        return (self.track_gain,)

    @property
    def offsets(self):
        return self.planar.offsets

    @property
    def rest_states(self):
        return 2 * self.planar.transfers

    @property
    def longest_step(self):
        return math.inf

    def on(self, vehicle):
        return replace(self, vehicle=vehicle)

    own_bounds: ClassVar[dict] = {"track_gain": (0.0, 10.0)}

    def with_own(self, numbers):
        return replace(self, **numbers)

    def as_filed(self):
        return replace(self, track_gain=0.0)

    def rest_at(self, speed, wheel_speeds):  # noqa: ARG002
        return (0.0,) * self.rest_states

    def loads_at_rest(self):
        return self.planar.loads_at_rest()

    def creep_rate(self, rail, speed):
        return self.planar.creep_rate(rail, speed)

    def creep_growth(self, rail):  # noqa: ARG002
        return 1.0

    def motion(
        self,
        rails,
        *,
        numbers,
        speed,
        wheel_speeds,
        rest,
        torques,
        locked,
        damping,
        track,
        resistance,  # noqa: ARG002 - the planar plant works it out itself
        grade_force,
    ):
        planar, (gain,) = self.planar, numbers
        radius = self.vehicle.wheel_radius
        loads = [
            load * (1.0 + gain * height)
            for load, height in zip(planar.wheel_loads(rest), track[0], strict=True)
        ]
        plain = planar.on(replace(self.vehicle, pads=None, dynamic=None))  # the torques are given
        axles = [
            plain.axle_motion(
                rails[k],
                speed=speed,
                states=(wheel_speeds[k],),
                wheel_load=loads[k],
                torque=torques[k],
                condition=AxleCondition(
                    stiffness=planar.axle_condition(time=0.0, wheel_load=loads[k]).stiffness,
                    damping=damping[k],
                ),
            )
            for k in range(self.axles)
        ]
        forces = tuple(axle.creep_force for axle in axles)
        train = planar.train_motion(speed=speed, creep_forces=forces, transfers=rest, grade_force=grade_force)
        return CoupledMotion(
            acceleration=train.acceleration,
            wheel_rates=tuple(
                where(lock != 0.0, 0.0, axle.rates[0]) for lock, axle in zip(locked, axles, strict=True)
            ),
            rest_rates=train.transfer_rates,
            creep_forces=forces,
            slips=tuple(axle.slip for axle in axles),
            wheel_loads=tuple(loads),
            transmitted=tuple(
                where(lock != 0.0, 2.0 * radius * force, torque)
                for lock, force, torque in zip(locked, forces, torques, strict=True)
            ),
            further=(tuple(2.0 * load for load in loads),),
        )
