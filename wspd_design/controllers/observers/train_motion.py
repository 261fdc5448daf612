"""What a protection believes about the motion of its train: speed, scale of the torques, bias and grade."""

from dataclasses import dataclass
from typing import Final

from wspd_design.controllers.observers.kalman import Belief, corrected, independent, predicted
from wspd_design.controllers.observers.wheel_filter_numbers import WheelFilterNumbers
from wspd_design.controllers.protocol import TRAIN_SPEED
from wspd_design.model import slip as slip_model
from wspd_design.model.generated import wheel_filter as generated
from wspd_design.model.number import Number, clip, maximum, minimum, sqrt, where
from wspd_design.parameters.records import Vehicle

_SCALES: Final = (0.4, 2.2)
"""Least and largest torque scale: beyond them pads, mass and inertia are not those of the vehicle."""
_SURPRISE: Final = 2.0
"""Deviations beyond which an error of the speed was not one of the scale."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainMotion:
    """The filter of the train speed; its other unknowns depend on the sensors."""

    vehicle: Vehicle  # nominal
    sample_time: float  # s
    accelerometer: bool
    grade: bool
    numbers: WheelFilterNumbers

    @property
    def unknowns(self) -> tuple[str, ...]:
        """Names of what it estimates."""
        bias = ("accelerometer_bias",) if self.accelerometer else ()
        grade = ("grade_acceleration",) if self.grade else ()
        return (TRAIN_SPEED, "torque_scale", *bias, *grade)

    def start(self, speed: Number) -> Belief:
        """Begin with the speed that the wheels show and nominal values."""
        numbers, zero = self.numbers, 0.0 * speed
        bias = (numbers.bias_deviation,) if self.accelerometer else ()
        grade = (numbers.grade_deviation,) if self.grade else ()
        deviations = (numbers.rim_noise, numbers.scale_deviation, *bias, *grade)
        return independent((speed, 1.0 + zero, *(zero for _ in deviations[2:])), deviations)

    def slowing(self, belief: Belief, torques: Number) -> Number:
        """Deceleration by the sum of the friction torques [N m] and running resistance, without the grade [m/s2]."""
        resistance = slip_model.resistance(self.vehicle, belief.mean[0])
        vehicle = self.vehicle
        return generated.slowing(belief.mean[1], torques, vehicle.wheel_radius, vehicle.mass, resistance)

    def acceleration(self, belief: Belief, torques: Number) -> Number:
        """Acceleration of the train [m/s2]."""
        return -self.slowing(belief, torques) - (belief.mean[-1] if self.grade else 0.0)

    def after_sample(self, belief: Belief, torques: Number, shown: Number) -> Belief:
        """Go on by a sample under the friction torques, and compare with the accelerometer if there is one.

        Parameters
        ----------
        belief : Belief
            That of the last sample.
        torques : number
            Sum of the friction torques [N m].
        shown : number
            Mean acceleration over the sample that the accelerometer shows [m/s2].
        """
        numbers, h, vehicle = self.numbers, self.sample_time, self.vehicle
        per_scale = generated.slowing_per_scale(torques, vehicle.wheel_radius, vehicle.mass)
        unexplained = numbers.torque_noise * per_scale + numbers.force_noise
        density = unexplained * unexplained  # m2/s3
        further = len(self.unknowns) - 2
        slopes = [1.0, -h * per_scale, *[0.0] * further]
        if self.grade:
            slopes[-1] = -h
        walks = (numbers.scale_walk, *(numbers.bias_walk,) * further)
        noise = [h * density, *(h * walk * walk for walk in walks)]
        speed = maximum(belief.mean[0] + h * self.acceleration(belief, torques), 0.0)
        expected = -self.slowing(belief, torques)
        belief = predicted(belief, speed, slopes, noise)
        if self.accelerometer:
            slopes = [0.0, -per_scale, 1.0, *[0.0] * (further - 1)]
            innovation = shown - expected - belief.mean[2]
            variance = numbers.acceleration_noise * numbers.acceleration_noise + density / h
            belief = corrected(belief, slopes, innovation, variance, common=density)
        return within_limits(belief)

    def rim_seen(
        self, belief: Belief, rim: Number, slip: Number, variance: Number, *, use: Number, found: Number
    ) -> Belief:
        """Compare with the rim speed of a wheel that adheres.

        Parameters
        ----------
        belief : Belief
            Before.
        rim : number
            Rim speed [m/s].
        slip : number
            Its micro-slip [-].
        variance : number
            Of the rim speed [m2/s2].
        use : number
            1 for a wheel that adheres, otherwise 0.
        found : number
            Whether it was found to adhere apart from its speed: a surprise is then one about the train speed, and not
            a wrong scale of the torques.
        """
        slopes = [1.0 - slip, *[0.0] * (len(self.unknowns) - 1)]
        innovation = rim - slopes[0] * belief.mean[0]
        surprise = innovation * innovation - _SURPRISE * _SURPRISE * (belief.spread + variance)
        belief = belief.with_spread(where(found, use * maximum(surprise, 0.0), 0.0))
        return corrected(belief, slopes, innovation, variance, use=use)

    def not_slower(self, belief: Belief, least: Number) -> Belief:
        """Raise the train speed to one that a wheel shows: no wheel of a braking train is faster than the train.

        The scale follows as far as it can be what was wrong. The wheel may have a slip: the speed stays at least as
        uncertain as the error was large.
        """
        speed, *others = belief.mean
        raised = maximum(least - speed, 0.0)
        explained = minimum(raised, _SURPRISE * sqrt(belief.spread)) / belief.spread
        mean = [x + belief.between(0, k) * explained for k, x in enumerate(others, start=1)]
        return Belief((speed + raised, *mean), belief.covariance).with_spread(
            maximum(raised * raised - belief.spread, 0.0)
        )


def within_limits(belief: Belief) -> Belief:
    """Keep the speed positive and the scale where it can be."""
    speed, scale, *others = belief.mean
    return belief._replace(mean=(maximum(speed, 0.0), clip(scale, *_SCALES), *others))
