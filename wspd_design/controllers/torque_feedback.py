"""A static law that feeds back the braking torque beside the slip: the smallest one that the valve lag leaves free.

Feedback of the slip alone cannot move the sum of the poles p - 1/tau; feedback of the torque makes it
p - (1 + K)/tau.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.offers import Feedback, SlipModel
from wspd_design.controllers.protocol import Command, Measurement, State, pulse_width
from wspd_design.model.number import Number, clip, maximum
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class TorqueFeedbackGains:
    """Gains of the law; the error of the sliding speed v slip_reference - (v - R omega) is v times that of slip."""

    slip_reference: float  # -
    sliding_gain: Annotated[float, Quantity(dimension="1/speed")]  # duty per m/s of sliding speed
    torque_gain: Annotated[float, Quantity(dimension="ratio")]  # duty per T_max of torque, K


@dataclass(frozen=True, slots=True, kw_only=True)
class TorqueFeedback:
    """The sampled controller of one wheelset with its design model; it remembers nothing."""

    name: str
    sample_time: float  # s
    vehicle: Vehicle  # design model
    rail: Rail  # design model
    gains: TorqueFeedbackGains

    @property
    def slip_reference(self) -> float:
        """Slip that the law holds [-]."""
        return self.gains.slip_reference

    @property
    def wheel_radius(self) -> float:
        """Radius from which the law works out its slip [m]."""
        return self.vehicle.wheel_radius

    @property
    def max_torque(self) -> float:
        """Torque that a duty of one stands for [N m]."""
        return self.vehicle.brake.max_torque

    @property
    def memory(self) -> tuple[str, ...]:
        """Nothing."""
        return ()

    @property
    def linear_model(self) -> tuple[Vehicle, Rail] | None:
        """None: at a frozen speed the design model only gives the torque that is held."""
        return None

    def linear_numbers(self, zero: Number) -> Mapping[str, Number]:  # noqa: ARG002 - none but the gains
        """Return nothing: the gains are all numbers of the linear form."""
        return {}

    def linear_form(
        self,
        speed: Number,
        *,
        model: SlipModel | None = None,  # noqa: ARG002 - the form contains none
        numbers: Mapping[str, Number] | None = None,  # noqa: ARG002 - there are none
    ) -> Feedback:
        """Return the gains near the reference: kappa v T_max on the slip error and K on the torque."""
        return Feedback(
            proportional=speed * self.gains.sliding_gain * self.max_torque,
            integral=0.0,
            torque=self.gains.torque_gain,
        )

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
