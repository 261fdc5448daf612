"""Sliding-mode control of the slip ratio, eqs. (21)-(26) in their corrected form."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.offers import Feedback, SlipModel
from wspd_design.controllers.protocol import Command, Measurement, State, pulse_width
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number, clip, maximum, saturation
from wspd_design.model.slip import slip_dynamics, slip_ratio
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class SlidingModeGains:
    """Gains of the law on the surface sbar = s / K_P = e + c * integral of e."""

    slip_reference: float  # -
    surface_rate: Annotated[float, Quantity(dimension="rate")]  # c = K_I / K_P, 1/s
    switching_gain: Annotated[float, Quantity(dimension="acceleration")]  # W0 = W v, m/s2
    boundary_layer: Annotated[float, Quantity(dimension="ratio", divisor=True)]  # Phi / K_P, in slip


@dataclass(frozen=True, slots=True, kw_only=True)
class SlidingMode:
    """The sampled controller of one wheelset with its design model; its state is (integral of e,)."""

    name: str
    sample_time: float  # s
    vehicle: Vehicle  # design model
    rail: Rail  # design model
    gains: SlidingModeGains

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
    def surface_gains(self) -> tuple[float, float]:
        """K_I = c [1/s] and K_P = 1: the gains state the rate."""
        return self.gains.surface_rate, 1.0

    @property
    def surface_rate(self) -> float:
        """Rate c of the error on the surface [1/s]."""
        return self.gains.surface_rate

    @property
    def layer(self) -> float:
        """Width of the boundary layer, in slip [-]."""
        return self.gains.boundary_layer

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of the state."""
        return ("integral of the slip error",)

    @property
    def linear_model(self) -> tuple[Vehicle, Rail] | None:
        """The design model, whose drift and gain the law cancels."""
        return self.vehicle, self.rail

    def linear_numbers(self, zero: Number) -> Mapping[str, Number]:  # noqa: ARG002 - none but the gains
        """Return nothing: the gains are all numbers of the linear form."""
        return {}

    def linear_form(
        self,
        speed: Number,
        *,
        model: SlipModel | None = None,
        numbers: Mapping[str, Number] | None = None,  # noqa: ARG002 - there are none
    ) -> Feedback:
        """Return the gains near the reference: (p + c + k)/G on the error and k c/G on its integral."""
        gains = self.gains
        if model is None:
            at = slip_dynamics(self.vehicle, self.rail, gains.slip_reference, speed)
            model = SlipModel(pole=at.pole, gain=at.gain)
        layer_rate = 1.0 / speed * gains.switching_gain / gains.boundary_layer  # k
        return Feedback(
            proportional=(model.pole + gains.surface_rate + layer_rate) / model.gain,
            integral=layer_rate * gains.surface_rate / model.gain,
            torque=0.0,
        )

    def start(self, measurement: Measurement) -> State:  # noqa: ARG002 - nothing to remember yet
        """Start without integral."""
        return (0.0,)

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Sample the slip, command the equivalent plus the switching torque."""
        (integral,) = state
        speed = maximum(measurement.speed, constants().slip_regularization_speed)
        slip = slip_ratio(measurement.speed, measurement.wheel_speed, self.vehicle.wheel_radius)
        demand = sliding_torque(self, maximum(slip, 0.0), speed, integral)
        error = sliding_surface.slip_error(self.gains.slip_reference, slip)
        return (integral + self.sample_time * error,), pulse_width(
            clip(demand / self.vehicle.brake.max_torque, 0.0, 1.0)
        )


def sliding_torque(law: SlidingMode, slip: Number, speed: Number, integral: Number) -> Number:
    """Torque of eqs. (23), (26) in their corrected form, before the limits of the brake [N m]."""
    gains = law.gains
    error = sliding_surface.slip_error(gains.slip_reference, slip)
    surface = sliding_surface.sliding_variable(error, integral, 1.0, gains.surface_rate)
    model = slip_dynamics(law.vehicle, law.rail, slip, speed)
    equivalent = sliding_surface.equivalent_torque(model.drift, model.gain, 0.0, error, gains.surface_rate)
    return equivalent + gains.switching_gain / speed * saturation(surface / gains.boundary_layer) / model.gain
