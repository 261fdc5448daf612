"""Adaptive fuzzy sliding-mode control of the slip ratio, eqs. (29)-(42), and its repair."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, NamedTuple, Protocol

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.offers import Feedback, SlipModel
from wspd_design.controllers.protocol import Command, Measurement, State, pulse_width
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number, clip, exp, maximum, minimum, saturation, where
from wspd_design.model.slip import slip_ratio
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

SLOPE, ADAPTING = "du/ds", "rate of adaptation at s = 1"
"""Names of the numbers of the linear form: slope of the torque over s [N m], and its rate of change by adaptation."""

_TORQUE = Quantity(dimension="torque", counted="ratio")
_TORQUE_RATE = Quantity(dimension="torque rate", counted="rate")


@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptiveFuzzyGains:
    """Gains of the law, with s in its own units and u in multiples of ``torque_unit``.

    The printed law adapts with s itself (``dead_zone`` false) and never stops adapting. The repaired law, for
    which V does not increase, adapts with the part of s outside the boundary layer and holds its weights while
    the command pushes further into the limit of the brake. With scheduled rates, alpha/v with v in m/s, it adapts
    in sigma = integral of dt/v, in which a stop has no end.
    """

    slip_reference: float  # -
    proportional_gain: Annotated[float, Quantity(dimension="ratio", divisor=True)]  # K_P
    integral_gain: Annotated[float, Quantity(dimension="rate")]  # K_I
    boundary_layer: Annotated[float, Quantity(dimension="ratio", divisor=True)]  # Phi, in s
    weight_rate: Annotated[float, _TORQUE_RATE]  # alpha_1
    bound_rate: Annotated[float, _TORQUE_RATE]  # alpha_2
    initial_weights: Annotated[
        tuple[float, ...], Quantity(dimension="torque", counted="ratio", per_rule=True)
    ]  # b_hat(0)
    initial_bound: Annotated[float, _TORQUE]  # psi_hat(0)
    centres: Annotated[tuple[float, ...], Quantity(dimension="ratio", per_rule=True)]  # of memberships, in s
    widths: Annotated[tuple[float, ...], Quantity(dimension="ratio", divisor=True, per_rule=True)]
    torque_unit: Annotated[float, Quantity(dimension="torque", divisor=True)]  # N m
    dead_zone: bool
    hold_when_saturated: bool
    scheduled_rates: bool


class Memberships(Protocol):
    """Gains with membership functions."""

    @property
    def centres(self) -> tuple[float, ...]:
        """Centres, in the unit of the surface."""

    @property
    def widths(self) -> tuple[float, ...]:
        """Widths, likewise."""


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

    @property
    def slip_reference(self) -> float:
        """Slip that the law holds [-]."""
        return self.gains.slip_reference

    @property
    def surface_gains(self) -> tuple[float, float]:
        """K_I [1/s] and K_P [-]."""
        return self.gains.integral_gain, self.gains.proportional_gain

    @property
    def surface_rate(self) -> float:
        """Rate c = K_I / K_P of the error on the surface, not a number without a surface, K_P = 0 [1/s]."""
        return _over(self.gains.integral_gain, self.gains.proportional_gain)

    @property
    def layer(self) -> float:
        """Width Phi / K_P of the boundary layer, in slip [-]."""
        return _over(self.gains.boundary_layer, self.gains.proportional_gain)

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of the state."""
        weights = (f"weight b_hat {number}" for number in range(1, len(self.gains.initial_weights) + 1))
        return ("integral of the slip error", *weights, "bound psi_hat")

    @property
    def linear_model(self) -> tuple[Vehicle, Rail] | None:
        """None: the law has no design model."""
        return None

    def linear_numbers(self, zero: Number) -> Mapping[str, Number]:
        """Work out the slope of the torque over s at the initial bound, and what adaptation of the weights adds.

        Near s = 0 the weights change the torque by kappa s a second, kappa = alpha_1 w'w (over v if the rates are
        scheduled); inside its dead zone the law adapts nothing. The bound changes it by a product of small numbers.
        The slope is the same for all weights that differ from the initial ones by the same amount.
        """
        slope = {SLOPE: torque_per_surface(self.gains, zero)}
        if self.gains.dead_zone:
            return slope
        strengths = firing_strengths(self.gains, zero)
        rate = self.gains.torque_unit * self.gains.weight_rate * sum(w * w for w in strengths)
        return slope | {ADAPTING: rate}

    def linear_form(
        self,
        speed: Number,
        *,
        model: SlipModel | None = None,  # noqa: ARG002 - the law has none
        numbers: Mapping[str, Number] | None = None,
    ) -> Feedback:
        """Return the gains near the reference; weights that adapt add an integral and a double one."""
        known = numbers or self.linear_numbers(0.0)
        slope, adapting = known[SLOPE], known.get(ADAPTING, 0.0)
        if self.gains.scheduled_rates:
            adapting = adapting / speed
        own, summed = self.gains.proportional_gain, self.gains.integral_gain
        return Feedback(
            proportional=slope * own,
            integral=slope * summed + adapting * own,
            torque=0.0,
            twice=adapting * summed,
        )

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


def _over(numerator: float, denominator: float) -> float:
    return numerator / denominator if denominator else math.nan


def sliding_variable(gains: AdaptiveFuzzyGains, error: Number, integral: Number) -> Number:
    """Sliding variable s of eq. (22)."""
    return sliding_surface.sliding_variable(error, integral, gains.proportional_gain, gains.integral_gain)


def firing_strengths(gains: Memberships, surface: Number) -> tuple[Number, ...]:
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


def torque_per_surface(gains: AdaptiveFuzzyGains, zero: Number) -> Number:
    """Slope du/ds of the law on its surface, with what it adapts as at the start [N m].

    The rule strengths are memberships exp(-(s - center)^2/width^2) over their sum, so that each has the slope
    w (d - mean of d), d = 2 center/width^2, at s = 0. The type of ``zero`` is that of the arithmetic.
    """
    strengths = firing_strengths(gains, zero)
    pulls = [
        (zero + 2.0 * center) / width / width
        for center, width in zip(gains.centres, gains.widths, strict=True)
    ]
    mean = sum(w * pull for w, pull in zip(strengths, pulls, strict=True))
    moved = sum(
        b * w * (pull - mean) for b, w, pull in zip(gains.initial_weights, strengths, pulls, strict=True)
    )
    return gains.torque_unit * (moved + (zero + gains.initial_bound) / gains.boundary_layer)
