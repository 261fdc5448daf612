"""A static law that feeds back the braking torque beside the slip: the smallest one that the valve lag leaves free.

Feedback of the slip alone cannot move the sum of the poles p - 1/tau; feedback of the torque makes it
p - (1 + K)/tau.
"""

from dataclasses import dataclass

from wspd_design.controllers.protocol import Command, Measurement, State, pulse_width
from wspd_design.model.number import Number, clip, maximum
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class TorqueFeedbackGains:
    """Gains of the law; the error of the sliding speed v slip_reference - (v - R omega) is v times that of slip."""

    slip_reference: float  # -
    sliding_gain: float  # duty per m/s of sliding speed
    torque_gain: float  # duty per T_max of torque, K


@dataclass(frozen=True, slots=True, kw_only=True)
class TorqueFeedback:
    """The sampled controller of one wheelset with its design model; it remembers nothing."""

    name: str
    sample_time: float  # s
    vehicle: Vehicle  # design model
    rail: Rail  # design model
    gains: TorqueFeedbackGains

    def start(self, measurement: Measurement) -> State:  # noqa: ARG002 - nothing to remember
        """Start without memory."""
        return ()

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Command the torque that holds the reference, corrected by the errors of sliding speed and torque."""
        gains = self.gains
        speed = maximum(measurement.speed, constants().slip_regularization_speed)
        duty = holding_torque(self, speed) / self.vehicle.brake.max_torque
        sliding = measurement.speed - self.vehicle.wheel_radius * measurement.wheel_speed
        error = gains.slip_reference * measurement.speed - sliding
        excess = measurement.torque / self.vehicle.brake.max_torque - duty
        demand = duty + gains.sliding_gain * error - gains.torque_gain * excess
        return state, pulse_width(clip(demand, 0.0, 1.0))


def holding_torque(law: TorqueFeedback, speed: Number) -> Number:
    """Torque per wheelset that holds the design model at the slip reference [N m]."""
    model = slip_dynamics(law.vehicle, law.rail, law.gains.slip_reference, speed)
    return -model.drift / model.gain
