"""The train speed from the wheels: a filter on the law's own friction torques, with wheelsets released to look.

Wheels that a law holds at a slip are copies of the speed that it believes in and say nothing about the true one. Their
friction torques say how the train slows down, but for a scale; an accelerometer says it but for a bias. What is left
grows with time, until a wheelset is vented, spins up and shows the speed. One is released at a time, when the speed has
become too uncertain for the slip that is held, or when the brake has lost its friction.
"""

from dataclasses import dataclass
from typing import NamedTuple

from wspd_design.controllers.observers.kalman import Belief
from wspd_design.controllers.observers.looking_wheel import Around, Recognition, Wheel
from wspd_design.controllers.observers.protocol import TRAIN_ACCELERATION, SpeedEstimate
from wspd_design.controllers.observers.rolling import RELEASED_DEMAND, mean_rim_speed, total
from wspd_design.controllers.observers.train_motion import TrainMotion, within_limits
from wspd_design.controllers.observers.wheel_filter_numbers import WheelFilterNumbers
from wspd_design.controllers.protocol import State, VehicleMeasurement
from wspd_design.model import adhesion
from wspd_design.model.generated import wheel_filter as generated
from wspd_design.model.number import Number, clip, exp, maximum, minimum, sqrt, where
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.records import Vehicle

_YES = 0.5  # flags are above it
_LARGEST_CREEP = 0.03  # -, beyond it a wheel slides


class _Whole(NamedTuple):
    """What the filter remembers beside its belief and the wheelsets."""

    acceleration: Number  # m/s2, of the train
    clock: Number  # s, since the last release began, or ended if none is on
    turn: Number  # wheelset that is released next, from 0 at the front
    usual_torque: Number  # N m, friction torque of a wheelset
    shown: Number  # m/s2, of the accelerometer


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelFilter:
    """Source of the train speed for a vehicle that has only its braked wheels, and perhaps an accelerometer."""

    vehicle: Vehicle  # nominal
    sample_time: float  # s
    accelerometer: bool
    grade: bool
    numbers: WheelFilterNumbers

    @property
    def wheelsets(self) -> int:
        """Number of wheelsets."""
        return self.vehicle.wheelsets

    @property
    def motion(self) -> TrainMotion:
        """Filter of the motion of the train."""
        return TrainMotion(
            vehicle=self.vehicle,
            sample_time=self.sample_time,
            accelerometer=self.accelerometer,
            grade=self.grade,
            numbers=self.numbers,
        )

    @property
    def memory(self) -> tuple[str, ...]:
        """Unknowns, the upper triangle of their covariance, what is known of each wheelset, and of the whole."""
        unknowns = self.motion.unknowns
        places = range(1, len(unknowns) + 1)
        covariance = [f"covariance_{row}_{column}" for row in places for column in places if column >= row]
        wheels = [f"{name}_{number}" for name in Wheel._fields for number in range(1, self.wheelsets + 1)]
        whole = (TRAIN_ACCELERATION, "release_clock", "release_turn", "usual_torque", "shown_acceleration")
        return (*unknowns, *covariance, *wheels, *whole)

    def start(self, seen: VehicleMeasurement) -> State:
        """Begin with wheels that roll if the brake is released."""
        speed = mean_rim_speed(seen, self.vehicle.wheel_radius)
        zero = 0.0 * speed
        rolling = where(seen.demand <= RELEASED_DEMAND, 1.0, 0.0)
        wheels = [
            Wheel(healthy * rolling, self.vehicle.wheel_radius * wheel_speed, *(zero,) * 9)
            for healthy, wheel_speed in zip(seen.healthy, seen.wheel_speeds, strict=True)
        ]
        whole = _Whole(zero, zero, zero, zero, seen.acceleration)
        return self._state(self.motion.start(speed), wheels, whole)

    def step(
        self,
        state: State,
        seen: VehicleMeasurement,
        friction_torques: tuple[Number, ...],
        slip_references: tuple[Number, ...],
    ) -> tuple[State, SpeedEstimate]:
        """Predict the train speed, correct it by the wheels that adhere, and ask for a look where it is due."""
        belief, wheels, whole = self._parts(state)
        healthy = maximum(total(seen.healthy), 1.0)
        torque = total([h * t for h, t in zip(seen.healthy, friction_torques, strict=True)]) / healthy
        torques = self.wheelsets * torque
        shown = 0.5 * (seen.acceleration + whole.shown)
        belief = self.motion.after_sample(belief, torques, shown)
        around = self._around(belief, wheels, whole, torque, torques, seen, slip_references)
        judged = []
        for axle, wheel in enumerate(wheels):
            belief, after = self._look(belief, wheel, seen, axle, friction_torques[axle], around)
            judged.append(after)
        belief = within_limits(belief)
        wheels, whole = self._release(belief, wheels, judged, whole, around, torque, seen)
        estimate = SpeedEstimate(
            belief.mean[0],
            whole.acceleration,
            tuple(wheel.vented for wheel in wheels),
            tuple(where(wheel.held > 0.0, 1.0, 0.0) for wheel in wheels),
        )
        return self._state(belief, wheels, whole), estimate

    def _parts(self, state: State) -> tuple[Belief, list[Wheel], _Whole]:
        unknowns, count = len(self.motion.unknowns), self.wheelsets
        begin = unknowns + unknowns * (unknowns + 1) // 2
        end = begin + len(Wheel._fields) * count
        wheels = [Wheel(*state[begin + axle : end : count]) for axle in range(count)]
        return Belief(state[:unknowns], state[unknowns:begin]), wheels, _Whole(*state[end:])

    def _state(self, belief: Belief, wheels: list[Wheel], whole: _Whole) -> State:
        by_element = (element for elements in zip(*wheels, strict=True) for element in elements)
        return (*belief.mean, *belief.covariance, *by_element, *whole)

    def _around(
        self,
        belief: Belief,
        wheels: list[Wheel],
        whole: _Whole,
        torque: Number,
        torques: Number,
        seen: VehicleMeasurement,
        slip_references: tuple[Number, ...],
    ) -> Around:
        """Collect what counts for every wheelset; the speed is the predicted one."""
        vehicle = self.vehicle
        new = 1.0 - exp(-self.sample_time / self.numbers.usual_time)
        usual = whole.usual_torque + new * (torque - whole.usual_torque)
        rolling = total([wheel.rolls for wheel in wheels])
        return Around(
            acceleration=self.motion.acceleration(belief, torques),
            slip_speed=total(slip_references) / float(self.wheelsets) * belief.mean[0],
            spin_up=usual * vehicle.wheel_radius / vehicle.wheelset_inertia,
            usual_torque=usual,
            rolling=rolling,
            shown=where(total([wheel.held for wheel in wheels]) > 0.0, 1.0, 0.0),
            others_slide=where(rolling < total(seen.healthy) - _YES, 1.0, 0.0),
            clock=whole.clock,
        )

    def _look(
        self,
        belief: Belief,
        wheel: Wheel,
        seen: VehicleMeasurement,
        axle: int,
        friction_torque: Number,
        around: Around,
    ) -> tuple[Belief, Wheel]:
        """Judge whether a wheelset adheres, and correct the belief by what it shows."""
        numbers, h, vehicle = self.numbers, self.sample_time, self.vehicle
        healthy, rim = seen.healthy[axle], vehicle.wheel_radius * seen.wheel_speeds[axle]
        load = static_wheel_load(vehicle)
        creep = generated.micro_slip(
            friction_torque,
            vehicle.wheel_radius,
            adhesion.contact_stiffness(vehicle.contact, load),
            numbers.creep_factor,
        )
        creep = minimum(creep, _LARGEST_CREEP)
        creep_deviation = numbers.creep_deviation * creep * belief.mean[0]
        creep_variance = creep_deviation * creep_deviation
        idle_torque = 2.0 * numbers.idle_adhesion * load * vehicle.wheel_radius
        recognition = Recognition(sample_time=h, idle_torque=idle_torque, numbers=numbers)
        wheel = recognition.tracked(wheel, rim)
        wheel = recognition.timed(wheel, friction_torque, around)
        innovation = rim - (1.0 - creep) * belief.mean[0]
        found = recognition.found(wheel, innovation, belief.spread, around)
        rolls = healthy * recognition.adheres(
            wheel,
            found,
            innovation=innovation,
            spread=belief.spread,
            creep_variance=creep_variance,
            friction_torque=friction_torque,
            around=around,
        )
        # A wheel that no longer follows slides, or the train is slower than it is believed to be.
        doubt = where(
            wheel.rolls * healthy > rolls + _YES, numbers.doubt_share * innovation * innovation, 0.0
        )
        belief = belief.with_spread(doubt)
        belief = self.motion.not_slower(belief, healthy * (rim - numbers.bound_gate * numbers.rim_noise))
        # Near its limit a rail that is not known lets a wheel creep more; that is wrong alike on all wheels, and for
        # longer than a sample: as noise it is larger.
        braked = clip(friction_torque / idle_torque - 1.0, 0.0, 1.0)
        unknown = creep_deviation + numbers.unknown_creep * braked * belief.mean[0]
        rim_variance = numbers.rim_noise * numbers.rim_noise
        lasting = (1.0 + numbers.creep_time / h) * maximum(around.rolling, 1.0)
        variance = rim_variance + unknown * unknown * lasting
        belief = self.motion.rim_seen(belief, rim, creep, variance, use=rolls, found=found)
        return belief, recognition.after(wheel, rolls, around)

    def _release(
        self,
        belief: Belief,
        before: list[Wheel],
        wheels: list[Wheel],
        whole: _Whole,
        around: Around,
        torque: Number,
        seen: VehicleMeasurement,
    ) -> tuple[list[Wheel], _Whole]:
        """Release the next wheelset if the speed is too uncertain or the brake lost, and nobody shows the speed."""
        numbers = self.numbers
        looked = total([wheel.vented for wheel in before]) > _YES
        looking = total([wheel.vented for wheel in wheels]) > _YES
        clock = where(looked * (looking < _YES), 0.0, whole.clock + self.sample_time)
        uncertain = sqrt(belief.spread) > numbers.release_share * around.slip_speed
        lost = torque < numbers.lost_share * around.usual_torque
        nobody = total([wheel.rolls + wheel.vented + wheel.held for wheel in wheels]) <= 0.0
        due = (
            ((uncertain + lost) > 0)
            * nobody
            * (belief.mean[0] > numbers.least_speed)
            * (clock > numbers.pause)
        )
        released = [
            wheel._replace(
                vented=where(due * (abs(whole.turn - float(axle)) < _YES), seen.healthy[axle], wheel.vented)
            )
            for axle, wheel in enumerate(wheels)
        ]
        following = where(whole.turn > self.wheelsets - 1.5, 0.0, whole.turn + 1.0)
        whole = _Whole(
            acceleration=around.acceleration,
            clock=where(due, 0.0, clock),
            turn=where(due, following, whole.turn),
            usual_torque=around.usual_torque,
            shown=seen.acceleration,
        )
        return released, whole
