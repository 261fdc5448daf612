"""Errors of the adaptive law against ideal weights and bound, chosen after the run that they judge."""

from dataclasses import dataclass

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.theorems.ideal_loop import State
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains, firing_strengths, sliding_variable
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number, saturation
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

CHOICE = "b* and psi chosen after the run such that V starts as low as psi >= sup abs(u* - b*'w) + eta allows"


@dataclass(frozen=True, slots=True, kw_only=True)
class Ideal:
    """Constant ideal weights and a bound that holds along one run [units of u]."""

    weights: tuple[Number, ...]
    bound: Number

    def exact(self) -> "Ideal":
        """Return the same numbers as balls."""
        return Ideal(weights=tuple(map(point, self.weights)), bound=point(self.bound))


@dataclass(frozen=True, slots=True, kw_only=True)
class Signals:
    """What the candidates for V are made of, over time or at one state; torques in N m."""

    speed: Number  # m/s
    surface: Number  # s
    dead_zone: Number  # s_D, part of s / K_P outside the layer
    gain: Number  # 1/(N m s), G
    gain_rate: Number  # G' = G a / v
    deceleration: Number  # m/s2
    approximation_error: Number  # xi = u* - b*'w
    weight_error_squared: Number
    bound_error: Number
    bound: Number  # psi


def signals(vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains, states: State, target: Ideal) -> Signals:
    """Evaluate the errors of the law at states of the idealized loop: arrays over time, or balls at one instant."""
    unit = gains.torque_unit
    strengths, torque = ideal_torque(vehicle, rail, gains, states)
    speed, slip, integral = states[:3]
    plant = slip_dynamics(vehicle, rail, slip, speed)
    surface = sliding_variable(gains, sliding_surface.slip_error(gains.slip_reference, slip), integral)
    layer = gains.boundary_layer
    fuzzy = sum(b * w for b, w in zip(target.weights, strengths, strict=True))
    return Signals(
        speed=speed,
        surface=surface,
        dead_zone=(surface - layer * saturation(surface / layer)) / gains.proportional_gain,
        gain=plant.gain,
        gain_rate=plant.gain * plant.deceleration / speed,
        deceleration=plant.deceleration,
        approximation_error=(torque - fuzzy) * unit,
        weight_error_squared=sum(
            ((b - now) * unit) ** 2 for b, now in zip(target.weights, states[3:-1], strict=True)
        ),
        bound_error=(target.bound - states[-1]) * unit,
        bound=target.bound * unit,
    )


def ideal_torque(
    vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains, states: State
) -> tuple[tuple[Number, ...], Number]:
    """Rule strengths w and ideal torque u*, the latter in units of u."""
    speed, slip, integral = states[:3]
    error = sliding_surface.slip_error(gains.slip_reference, slip)
    plant = slip_dynamics(vehicle, rail, slip, speed)
    # K_I e/K_P in this order, since a quotient of two gains would be rounded.
    scaled = error / gains.proportional_gain
    torque = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, scaled, gains.integral_gain)
    return firing_strengths(gains, sliding_variable(gains, error, integral)), torque / gains.torque_unit
