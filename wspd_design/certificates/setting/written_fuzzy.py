"""The mended adaptive fuzzy law of a wheelset, written out from its symbols, and whether a step is shown to be it.

It shares with the class of the law nothing but the numbers of its gains. What is around it, sensors that fail, low
speed and the source of the train speed, is that of a protection of the package, with which it is compared as a whole.
"""

from dataclasses import dataclass, fields

from wspd_design.certificates.setting.written_laws import memberships
from wspd_design.certificates.setting.written_protection import same_step
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.laws import law_constants
from wspd_design.controllers.fuzzy_surface import FuzzySurface, FuzzySurfaceGains
from wspd_design.controllers.observers.told import ToldSpeed
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import Command, State
from wspd_design.controllers.references import ConstantSlip
from wspd_design.controllers.wheel_law import WheelView
from wspd_design.model.number import Number, exp, maximum, minimum, where

FULL, FULL_AT_LEAST, EMPTY = 0.98, 1e-3, 0.01  # shares of what is available and of the full torque


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenFuzzySurface:
    """u = b'w(sigma) + psi sat(sigma/Phi), sigma = e' + k e; fills for u h of a sample, or vents for -u h."""

    sample_time: float  # s
    radius: float  # m
    gains: FuzzySurfaceGains
    memory: tuple[str, ...]

    def start(self, view: WheelView) -> State:
        """Begin with the first weights."""
        return (self._error(view), 0.0, self.gains.initial_bound, *self.gains.initial_weights)

    def step(self, state: State, view: WheelView) -> tuple[State, Command]:
        """One sample."""
        before, rate, psi, *weights = state
        gains, h, error = self.gains, self.sample_time, self._error(view)
        rate = rate + (1.0 - exp(-h / gains.rate_filter)) * ((error - before) / h - rate)
        sigma = rate + gains.surface_rate * error
        w = memberships(sigma, gains.centres, gains.widths)
        inside = minimum(maximum(sigma / gains.layer, -1.0), 1.0)
        u = sum(b * share for b, share in zip(weights, w, strict=True)) + psi * inside
        beyond = sigma - gains.layer * inside
        full = view.torque >= FULL * maximum(view.available, FULL_AT_LEAST * view.full_torque)
        stuck = where(
            beyond > 0.0,
            where(full, True, u > 1.0),
            where(view.torque <= EMPTY * view.full_torque, True, u < -1.0),
        )
        span = h * where(stuck, 0.0, 1.0)
        adapted = [
            minimum(maximum(b + span * (gains.weight_rate * (beyond * share - gains.leakage * b)), -1.0), 1.0)
            for b, share in zip(weights, w, strict=True)
        ]
        grown = psi + span * (gains.bound_rate * (abs(beyond) - gains.leakage * (psi - gains.initial_bound)))
        size = where(abs(u) * h >= gains.least_pulse, minimum(abs(u), 1.0), 0.0)
        command = Command(fill=where(u > 0.0, size, 0.0), vent=where(u < 0.0, size, 0.0))
        return (error, rate, minimum(maximum(grown, 0.0), 1.0), *adapted), command

    def _error(self, view: WheelView) -> Number:
        """Rim speed above the desired one."""
        return self.radius * (view.wheel_speed - view.desired_speed)


def not_fuzzy(law: object) -> str:
    """Say why the step of a law is not shown to be the mended adaptive fuzzy law; empty if it is."""
    kinds = isinstance(law, Protection) and isinstance(law.core, FuzzySurface)
    if not kinds:
        return "is not the mended adaptive fuzzy law"
    assert isinstance(law, Protection)
    assert isinstance(law.core, FuzzySurface)
    told = type(law.reference) is ConstantSlip and type(law.source) is ToldSpeed
    if not told or law.seeking is not None:
        return "does not go by a told train speed and a constant slip"
    core = WrittenFuzzySurface(
        sample_time=law.core.sample_time,
        radius=law.core.wheel_radius,
        gains=law.core.gains,
        memory=law.core.memory,
    )
    numbers = {each.name: getattr(law, each.name) for each in fields(Protection)}
    try:
        pair = law_constants(law), law_constants(Protection(**{**numbers, "core": core}))
    except UntraceableError as reason:
        return f"cannot be traced ({reason})"
    return "" if same_step(*pair) else "has a step that is not shown to be the mended adaptive fuzzy law"
