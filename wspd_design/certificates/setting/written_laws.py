"""The laws that the theorems speak about, written out from their symbols.

Each is a controller of its own that shares with the class of the law nothing but the numbers of its gains and the
kernels of eq. (19). What the paper calls u is a torque per wheelset; the valve is commanded the duty u/T_max, limited
to 0 and 1. The slip is referred to at least the speed below which it is regularized.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.controllers.protocol import Command, Measurement, State
from wspd_design.controllers.sliding_mode import SlidingModeGains
from wspd_design.controllers.torque_feedback import TorqueFeedbackGains
from wspd_design.model.number import Number, exp, maximum, minimum, where
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle


def memberships(surface: Number, centres: Sequence[float], widths: Sequence[float]) -> list[Number]:
    """Shares of the rules at a surface: Gaussian functions over their sum, none of which underflows."""
    squares = [
        (surface - centre) / width * ((surface - centre) / width)
        for centre, width in zip(centres, widths, strict=True)
    ]
    least = squares[0]
    for square in squares[1:]:
        least = minimum(least, square)
    members = [exp(least - square) for square in squares]
    return [member / sum(members) for member in members]


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenLaw:
    """What all written laws have: a name, a sample time h [s], a wheel radius R [m] and T_max [N m]."""

    name: str
    sample_time: float
    radius: float
    max_torque: float
    gains: Any

    @classmethod
    def of(cls, law: Any, gains: Any) -> Self:
        """Write the law out with the numbers of a controller that has its own wheel radius and T_max."""
        return cls(
            name=law.name,
            sample_time=law.sample_time,
            radius=law.wheel_radius,
            max_torque=law.max_torque,
            gains=gains,
        )

    def start(self, measurement: Measurement) -> State:
        """Return the state before the first sample."""
        raise NotImplementedError

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Return the state after a sample and the command."""
        raise NotImplementedError

    def slip(self, m: Measurement) -> Number:
        """Eq. (3): lambda = (v - R omega)/v."""
        return (m.speed - self.radius * m.wheel_speed) / _speed(m)


@dataclass(frozen=True, slots=True, kw_only=True)
class _WithModel(WrittenLaw):
    """A law with a design model, whose wheel radius and T_max it takes."""

    vehicle: Vehicle
    rail: Rail

    @classmethod
    def of(cls, law: Any, gains: Any) -> Self:
        if not isinstance(law.vehicle, Vehicle) or not isinstance(law.rail, Rail):
            raise TypeError("the design model is not a vehicle on a rail")
        return cls(
            name=law.name,
            sample_time=law.sample_time,
            radius=law.vehicle.wheel_radius,
            max_torque=law.vehicle.brake.max_torque,
            gains=gains,
            vehicle=law.vehicle,
            rail=law.rail,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenSlidingMode(_WithModel):
    """Eqs. (21) to (26), corrected: u = (c e - F_hat + (W0/v) sat(sbar/Phi)) / G_hat, sbar = e + c E, E' = e.

    A negative slip is taken as 0 in u, not in E.
    """

    def start(self, measurement: Measurement) -> State:  # noqa: ARG002 - E = 0
        """E = 0."""
        return (0.0,)

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Sum E and command u."""
        (total,) = state
        gains: SlidingModeGains = self.gains
        speed, slip = _speed(measurement), self.slip(measurement)
        braking = maximum(slip, 0.0)
        error = gains.slip_reference - braking
        model = slip_dynamics(self.vehicle, self.rail, braking, speed)
        inside = _sat((error + gains.surface_rate * total) / gains.boundary_layer)
        closing = gains.surface_rate * error - model.drift
        torque = (closing + gains.switching_gain * inside / speed) / model.gain
        return (total + self.sample_time * (gains.slip_reference - slip),), _pulses(torque / self.max_torque)


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenTorqueFeedback(_WithModel):
    """u/T_max = d + kappa (v lambda* - sigma) - K (T/T_max - d), d T_max = -F_hat/G_hat at the reference."""

    def start(self, measurement: Measurement) -> State:  # noqa: ARG002 - no memory
        """No memory."""
        return ()

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Command u; nothing is remembered."""
        gains: TorqueFeedbackGains = self.gains
        model = slip_dynamics(self.vehicle, self.rail, gains.slip_reference, _speed(measurement))
        held = -model.drift / model.gain / self.max_torque
        excess = measurement.torque / self.max_torque - held
        slide = measurement.speed - self.radius * measurement.wheel_speed
        pull = gains.sliding_gain * (gains.slip_reference * measurement.speed - slide)
        return state, _pulses(held + pull - gains.torque_gain * excess)


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenAdaptiveFuzzy(WrittenLaw):
    """Eqs. (29) to (42): u = b_hat'w + psi_hat sat(s/Phi), b_hat' = alpha_1 s w, psi_hat' = alpha_2 abs(s).

    With a dead zone s is replaced by its part outside the layer where the law adapts, with scheduled rates alpha by
    alpha/v; adaptation that is held stands still while u pushes further into a limit of the brake. The membership
    functions are divided by the largest of them, which cancels in w. Products are written in an order in which CasADi
    multiplies no two constants, which would round.
    """

    def start(self, measurement: Measurement) -> State:  # noqa: ARG002 - from the gains alone
        """E = 0, b_hat(0) and psi_hat(0)."""
        gains: AdaptiveFuzzyGains = self.gains
        return (0.0, *gains.initial_weights, gains.initial_bound)

    def step(self, state: State, measurement: Measurement) -> tuple[State, Command]:
        """Sum E, adapt, and command u."""
        gains: AdaptiveFuzzyGains = self.gains
        total, *weights, bound = state
        error = gains.slip_reference - self.slip(measurement)
        surface = gains.proportional_gain * error + gains.integral_gain * total
        w = memberships(surface, gains.centres, gains.widths)
        inside = _sat(surface / gains.boundary_layer)
        fuzzy = sum(b * share for b, share in zip(weights, w, strict=True))
        torque = gains.torque_unit * (fuzzy + bound * inside)
        driving = surface - gains.boundary_layer * inside if gains.dead_zone else surface
        if gains.scheduled_rates:
            driving = driving / _speed(measurement)
        span: Number = self.sample_time
        if gains.hold_when_saturated:
            duty = torque / self.max_torque
            up, down = where(duty > 1.0, surface > 0.0, False), where(duty < 0.0, surface < 0.0, False)
            span = where(up, 0.0, where(down, 0.0, span))
        adapted = [
            b + span * (gains.weight_rate * driving * share) for b, share in zip(weights, w, strict=True)
        ]
        following = (
            total + self.sample_time * error,
            *adapted,
            bound + span * (gains.bound_rate * abs(driving)),
        )
        return following, _pulses(torque / self.max_torque)


def _speed(m: Measurement) -> Number:
    return maximum(m.speed, constants().slip_regularization_speed)


def _pulses(duty: Number) -> Command:
    """Eq. (13): fill for the duty, within 0 and 1, and vent for the rest."""
    limited = minimum(maximum(duty, 0.0), 1.0)
    return Command(fill=limited, vent=1.0 - limited)


def _sat(x: Number) -> Number:
    return minimum(maximum(x, -1.0), 1.0)


WRITTEN: dict[str, type[WrittenLaw]] = {
    "afsmc": WrittenAdaptiveFuzzy,
    "smc": WrittenSlidingMode,
    "torque-feedback": WrittenTorqueFeedback,
}
"""Written laws by the family of laws."""
