"""Sliding-mode control of the slip ratio, eqs. (21)-(26) in their corrected form."""

from dataclasses import dataclass

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
    surface_rate: float  # c = K_I / K_P, 1/s
    switching_gain: float  # W0 = W v, m/s2
    boundary_layer: float  # Phi / K_P, in slip


@dataclass(frozen=True, slots=True, kw_only=True)
class SlidingMode:
    """The sampled controller of one wheelset with its design model; its state is (integral of e,)."""

    name: str
    sample_time: float  # s
    vehicle: Vehicle  # design model
    rail: Rail  # design model
    gains: SlidingModeGains

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
