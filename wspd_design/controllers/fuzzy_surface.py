"""The paper's adaptive fuzzy law on a surface that the valve moves at once, sigma = e' + k e, without any model.

The paper's surface holds the slip and its integral; the valve moves it in its second derivative only, and the sign of
the surface says too late where the torque has to go. Here e is the rim speed above the desired one. The command u is a
share of the sample: above 0 it fills, below 0 it vents, and the valve holds for the rest.
"""

from dataclasses import dataclass
from typing import Annotated

from wspd_design.controllers.adaptive_fuzzy import firing_strengths
from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.protection import ProtectionGains
from wspd_design.controllers.protocol import Command, State
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.model.generated import fuzzy_surface as generated
from wspd_design.model.number import Number, clip, exp, maximum, minimum, saturation, where

_MOST = 1.0  # a weight or bound above the whole sample means nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class FuzzySurfaceGains(ProtectionGains):
    """Gains of the law."""

    surface_rate: Annotated[float, Quantity(dimension="rate", divisor=True)]  # k
    rate_filter: Annotated[float, Quantity(dimension="time", divisor=True)]  # time constant of e'
    layer: Annotated[float, Quantity(dimension="acceleration", divisor=True)]  # Phi
    weight_rate: Annotated[float, Quantity(dimension="1/speed")]  # alpha_1
    bound_rate: Annotated[float, Quantity(dimension="1/speed")]  # alpha_2
    leakage: Annotated[float, Quantity(dimension="acceleration")]
    initial_weights: Annotated[tuple[float, ...], Quantity(dimension="ratio", per_rule=True)]
    initial_bound: float  # -, psi_hat(0)
    centres: Annotated[tuple[float, ...], Quantity(dimension="acceleration", per_rule=True)]
    widths: Annotated[tuple[float, ...], Quantity(dimension="acceleration", divisor=True, per_rule=True)]


@dataclass(frozen=True, slots=True, kw_only=True)
class FuzzySurface:
    """The law of one wheelset; its state is (e, filtered e', psi_hat, b_hat 1..n)."""

    sample_time: float  # s
    wheel_radius: float  # m
    gains: FuzzySurfaceGains

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of the state."""
        rules = range(1, len(self.gains.initial_weights) + 1)
        return ("rim_error", "rim_error_rate", "bound", *(f"weight_of_rule_{rule}" for rule in rules))

    def start(self, view: WheelView) -> State:
        """Start with the initial weights and bound, and with an error that does not move."""
        return (self._error(view), 0.0, self.gains.initial_bound, *self.gains.initial_weights)

    def step(self, state: State, view: WheelView) -> tuple[State, Command]:
        """Sample the surface, command the share and adapt by one explicit Euler step."""
        before, rate, bound, *weights = state
        gains, error = self.gains, self._error(view)
        new = 1.0 - exp(-self.sample_time / gains.rate_filter)
        rate = rate + new * ((error - before) / self.sample_time - rate)
        surface = generated.surface(error, rate, gains.surface_rate)
        strengths = firing_strengths(gains, surface)
        layered = saturation(surface / gains.layer)
        share = sum(b * w for b, w in zip(weights, strengths, strict=True)) + bound * layered
        driving = surface - gains.layer * layered
        span = self.sample_time * _adapts(share, driving, view)
        adapted = [
            clip(
                b + span * generated.weight_rate(driving, w, b, gains.weight_rate, gains.leakage),
                -_MOST,
                _MOST,
            )
            for b, w in zip(weights, strengths, strict=True)
        ]
        grown = bound + span * generated.weight_rate(
            abs(driving), 1.0, bound - gains.initial_bound, gains.bound_rate, gains.leakage
        )
        return (error, rate, clip(grown, 0.0, _MOST), *adapted), self._pulse(share)

    def _error(self, view: WheelView) -> Number:
        """Rim speed above the desired one [m/s]."""
        return self.wheel_radius * (view.wheel_speed - view.desired_speed)

    def _pulse(self, share: Number) -> Command:
        """Fill or vent for a share of the sample, unless that is shorter than the shortest pulse."""
        moves = abs(share) * self.sample_time >= self.gains.least_pulse
        size = where(moves, minimum(abs(share), 1.0), 0.0)
        return Command(fill=where(share > 0.0, size, 0.0), vent=where(share < 0.0, size, 0.0))


def _adapts(share: Number, driving: Number, view: WheelView) -> Number:
    """Tell (1 or 0) whether the weights adapt: not where the command is saturated in the direction of the surface.

    It is saturated too where the brake is as strong as the demand allows, or empty.
    """
    full = view.torque >= 0.98 * maximum(view.available, 1e-3 * view.full_torque)
    more = where(full, True, share > 1.0)
    less = where(view.torque <= 0.01 * view.full_torque, True, share < -1.0)
    stuck = where(driving > 0.0, more, less)
    return where(stuck, 0.0, 1.0)
