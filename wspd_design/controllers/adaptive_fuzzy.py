"""Adaptive fuzzy sliding-mode control of the slip ratio, eqs. (29)-(42), and its repair."""

from dataclasses import dataclass
from typing import NamedTuple

from wspd_design.controllers.protocol import Command, Measurement, State, pulse_width
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number, clip, exp, maximum, minimum, saturation, where
from wspd_design.model.slip import slip_ratio
from wspd_design.parameters.loading import constants


@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptiveFuzzyGains:
    """Gains of the law, with s in its own units and u in multiples of ``torque_unit``.

    The printed law adapts with s itself (``dead_zone`` false) and never stops adapting. The repaired law, for
    which V does not increase, adapts with the part of s outside the boundary layer and holds its weights while
    the command pushes further into the limit of the brake. With scheduled rates, alpha/v with v in m/s, it adapts
    in sigma = integral of dt/v, in which a stop has no end.
    """

    slip_reference: float  # -
    proportional_gain: float  # K_P
    integral_gain: float  # K_I
    boundary_layer: float  # Phi, in s
    weight_rate: float  # alpha_1
    bound_rate: float  # alpha_2
    initial_weights: tuple[float, ...]  # b_hat(0)
    initial_bound: float  # psi_hat(0)
    centres: tuple[float, ...]  # membership functions, in s
    widths: tuple[float, ...]
    torque_unit: float  # N m
    dead_zone: bool
    hold_when_saturated: bool
    scheduled_rates: bool


class Adaptation(NamedTuple):
    """Rates of change of what the law adapts."""

    weights: tuple[Number, ...]
    bound: Number


@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptiveFuzzy:
    """The sampled controller of one wheelset; its state is (integral of e, b_hat 1..n, psi_hat)."""

    name: str
    sample_time: float  # s
    wheel_radius: float  # m
    max_torque: float  # N m
    gains: AdaptiveFuzzyGains

    def start(self, measurement: Measurement) -> State:  # noqa: ARG002 - the law starts from its gains alone
        """Start without integral and with the initial weights and bound."""
        return (0.0, *self.gains.initial_weights, self.gains.initial_bound)

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Sample the slip, command the duty and adapt by one explicit Euler step."""
        integral, *weights, bound = state
        slip = slip_ratio(measurement.speed, measurement.wheel_speed, self.wheel_radius)
        error = sliding_surface.slip_error(self.gains.slip_reference, slip)
        surface = sliding_variable(self.gains, error, integral)
        demand = torque_demand(self.gains, surface, tuple(weights), bound) / self.max_torque
        rates = adaptation(self.gains, surface, measurement.speed)
        span = self.sample_time
        if self.gains.hold_when_saturated:
            pushing_up = where(demand > 1.0, surface > 0.0, False)
            pushing_down = where(demand < 0.0, surface < 0.0, False)
            span = where(pushing_up, 0.0, where(pushing_down, 0.0, span))
        adapted = tuple(b + span * rate for b, rate in zip(weights, rates.weights, strict=True))
        following = (integral + self.sample_time * error, *adapted, bound + span * rates.bound)
        return following, pulse_width(clip(demand, 0.0, 1.0))


def sliding_variable(gains: AdaptiveFuzzyGains, error: Number, integral: Number) -> Number:
    """Sliding variable s of eq. (22)."""
    return sliding_surface.sliding_variable(error, integral, gains.proportional_gain, gains.integral_gain)


def firing_strengths(gains: AdaptiveFuzzyGains, surface: Number) -> tuple[Number, ...]:
    """Normalized rule strengths w of eqs. (29), (31).

    All exponents are shifted by the largest one. The shift cancels in (31); without it every membership
    underflows to zero far away from the centres, and the quotient is 0/0.
    """
    distances = [
        ((surface - centre) / width) ** 2 for centre, width in zip(gains.centres, gains.widths, strict=True)
    ]
    nearest = distances[0]
    for distance in distances[1:]:
        nearest = minimum(nearest, distance)
    memberships = [exp(nearest - distance) for distance in distances]
    total = sum(memberships)
    return tuple(membership / total for membership in memberships)


def torque_demand(
    gains: AdaptiveFuzzyGains, surface: Number, weights: tuple[Number, ...], bound: Number
) -> Number:
    """Torque u = b_hat' w + psi_hat sat(s / Phi) of eqs. (35)-(37), before the limits of the brake [N m]."""
    strengths = firing_strengths(gains, surface)
    fuzzy = sum(b * w for b, w in zip(weights, strengths, strict=True))
    return gains.torque_unit * (fuzzy + bound * saturation(surface / gains.boundary_layer))


def adaptation(gains: AdaptiveFuzzyGains, surface: Number, speed: Number) -> Adaptation:
    """Adaptation laws (41), (42): rates of the weights and of the bound [units of u per second].

    Parameters
    ----------
    gains : AdaptiveFuzzyGains
        Law.
    surface : number
        Sliding variable s.
    speed : number
        Of the train, by which scheduled rates are divided [m/s].
    """
    driving = surface
    if gains.dead_zone:
        driving = surface - gains.boundary_layer * saturation(surface / gains.boundary_layer)
    if gains.scheduled_rates:
        driving = driving / maximum(speed, constants().slip_regularization_speed)
    strengths = firing_strengths(gains, surface)
    return Adaptation(
        weights=tuple(gains.weight_rate * driving * w for w in strengths),
        bound=gains.bound_rate * abs(driving),
    )
