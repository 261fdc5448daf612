"""Laws of one's own that theorems about feedback of the slip must not bind, or must."""

from dataclasses import dataclass
from typing import Any

from wspd_design.controllers.protocol import pulse_width
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.number import clip, exp, maximum
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import load_rail, load_vehicle

SAMPLE, LAG = 0.02, 0.6  # s
VEHICLE, RAIL = load_vehicle("er24pc"), load_rail("polach-dry")


def held_share(speed: Any) -> Any:
    """Share of T_max that holds slip 0.14 on dry rail."""
    plant = slip_dynamics(VEHICLE, RAIL, 0.14, maximum(speed, 0.1))
    return -plant.drift / plant.gain / VEHICLE.brake.max_torque


def sliding(m: Any) -> Any:
    """Error of the sliding speed [m/s]."""
    return 0.14 * m.speed - (m.speed - VEHICLE.wheel_radius * m.wheel_speed)


@dataclass(frozen=True)
class OwnLaw:
    """A law by its step, with so many elements of memory that start at zero."""

    rule: Any
    elements: int
    name: str = "own"
    sample_time: float = SAMPLE

    def start(self, _: Any) -> tuple[float, ...]:
        return (0.0,) * self.elements

    def step(self, state: Any, m: Any) -> Any:
        following, duty = self.rule(state, m)
        return following, pulse_width(clip(duty, 0.0, 1.0))


def slip_only(state: Any, m: Any) -> Any:
    """An internal copy of the valve and the supply, driven by its own commands (cases/truth/lead.py)."""
    copy, time = state
    held = held_share(m.speed)
    duty = clip(held + 14.0 * sliding(m) - 29.0 * (copy - held), 0.0, 1.0)
    supply = 1.0 - exp(-0.75 * time)
    filled = supply - (supply - copy) * exp(-duty * SAMPLE / LAG)
    return (filled * exp(-(1.0 - duty) * SAMPLE / LAG), time + SAMPLE), duty


def lead(state: Any, m: Any) -> Any:
    (filtered,) = state
    return (filtered + SAMPLE * 20.0 * (sliding(m) - filtered),), 0.3 + 10.0 * (sliding(m) - filtered)


def previous_speed(state: Any, m: Any) -> Any:
    (before,) = state
    return (m.wheel_speed,), m.wheel_speed - before


def with_torque(state: Any, m: Any) -> Any:
    (total,) = state
    return (total + SAMPLE * sliding(m),), 0.3 + 2.0 * sliding(m) + total - 1e-5 * m.torque


def torque_remembered(state: Any, m: Any) -> Any:
    """The torque reaches the command one sample later, through an integral alone."""
    (total,) = state
    return (total + SAMPLE * 1e-5 * m.torque,), 0.3 + 2.0 * sliding(m) - total


def proportional(state: Any, m: Any) -> Any:
    return state, 0.3 + 2.0 * sliding(m)


def proportional_integral(state: Any, m: Any) -> Any:
    (total,) = state
    return (total + SAMPLE * sliding(m),), 0.3 + 2.0 * sliding(m) + total


class EvilSliding(SlidingMode):
    """A subclass of the sliding mode that measures the torque."""

    def step(self, state: Any, m: Any) -> Any:
        following, command = super().step(state, m)
        return following, pulse_width(clip(command.fill - 1e-6 * m.torque, 0.0, 1.0))


BOUND = {
    "proportional": OwnLaw(rule=proportional, elements=0),
    "proportional and integral": OwnLaw(rule=proportional_integral, elements=1),
}
NOT_BOUND = {
    "copy of the valve": OwnLaw(rule=slip_only, elements=2),
    "lead filter": OwnLaw(rule=lead, elements=1),
    "previous wheel speed": OwnLaw(rule=previous_speed, elements=1),
    "integral with feedback of the torque": OwnLaw(rule=with_torque, elements=1),
    "integral of the torque": OwnLaw(rule=torque_remembered, elements=1),
}
