"""Runs of many wheelsets at once: an exponential step for the stiff slip, exact pulses for the valve."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.attack.case import Case
from tests.attack.laws import (
    adaptation,
    dead_zone,
    fuzzy_torque,
    sampled_duty,
    sliding_torque,
    surface,
    surface_rate,
)
from tests.attack.plant import (
    STEP,
    Plant,
    adhesion_peak,
    filled,
    filling_from_empty,
    slip_rate,
    slowing,
    vented,
)

LOCKED = 1.0


def exponential_step(rate: Callable[[Any], Any], value: Any, time: Any) -> Any:
    """One step of x' = rate(x), exact for linear rates and stable for stiff ones; the rate takes complex numbers."""
    slope = np.imag(rate(value + STEP * 1j)) / STEP * time
    slope = np.where(np.abs(slope) < 1e-9, 1e-9, np.minimum(slope, 500.0))
    return value + time * np.real(rate(value)) * np.expm1(slope) / slope


@dataclass(slots=True)
class Wheels:
    """State of many runs: slip, speed [m/s], torque [N m], and the extremes of the slip so far."""

    slip: Any
    speed: Any
    torque: Any
    lowest: Any
    highest: Any

    def move(self, plant: Plant, mean_torque: Any, time: Any, *, frozen: bool) -> None:
        """Go on for a short time under a torque, at frozen speed or with a train that slows down."""
        speed = self.speed if frozen else self.speed - time / 2 * slowing(plant, self.slip, self.speed)

        def rate(slip: Any) -> Any:
            return slip_rate(plant, slip, speed, mean_torque)

        before = self.slip
        self.slip = np.minimum(exponential_step(rate, self.slip, time), LOCKED)
        if not frozen:
            middle = (before + self.slip) / 2
            self.speed = self.speed - time * slowing(plant, middle, speed)
        self.lowest, self.highest = np.minimum(self.lowest, self.slip), np.maximum(self.highest, self.slip)


def wheels(slip: Any, speed: Any, torque: Any) -> Wheels:
    """Start runs."""
    slip, speed, torque = (np.array(each, float) for each in np.broadcast_arrays(slip, speed, torque))
    return Wheels(slip, speed, torque, slip.copy(), slip.copy())


def pulse(plant: Plant, state: Wheels, duty: Any, sample_time: float, *, steps: int, frozen: bool) -> None:
    """One sample: fill for the duty, vent for the rest, both exact, at full supply pressure."""
    for phase, share in ((filled, duty), (vented, 1.0 - duty)):
        time = share * sample_time / steps
        for _ in range(steps):
            middle = phase(plant, state.torque, time / 2)
            state.move(plant, middle, time, frozen=frozen)
            state.torque = phase(plant, state.torque, time)


def vent(plant: Plant, state: Wheels, time: float, *, steps: int, frozen: bool) -> None:
    """Vent fully."""
    step = time / steps
    for _ in range(steps):
        state.move(plant, vented(plant, state.torque, step / 2), step, frozen=frozen)
        state.torque = vented(plant, state.torque, step)


def hold(plant: Plant, state: Wheels, time: float, *, steps: int, frozen: bool) -> None:
    """Hold the torque."""
    for _ in range(steps):
        state.move(plant, state.torque, time / steps, frozen=frozen)


def sampled_run(
    case: Case, plant: Plant, state: Wheels, samples: int, *, steps: int = 3, frozen: bool = True
) -> Any:
    """Run a law without adaptation with true pulses; return the slips at the samples, samples along the first axis."""
    integral, seen = np.zeros_like(state.slip), []
    for _ in range(samples):
        seen.append(state.slip.copy())
        duty = sampled_duty(case, state.slip, state.speed, state.torque, integral)
        integral = integral + case.sample_time * (case.slip - state.slip)
        pulse(plant, state, duty, case.sample_time, steps=steps, frozen=frozen)
    return np.array(seen)


def layer_run(
    case: Case, plant: Plant, slip: Any, speed: Any, integral: Any, *, time: float, step: float
) -> list[tuple[float, Any, Any, Any]]:
    """Run the sliding-mode law with T = u in small steps: (time, slip, speed, integral of e) at each."""
    path = [(0.0, slip, speed, integral)]
    for k in range(round(time / step)):
        lost = slowing(plant, slip, speed)
        middle_speed = np.maximum(speed - step / 2 * lost, 1e-3)
        middle_integral = integral + step / 2 * (case.slip - slip)

        def rate(x: Any, speed: Any = middle_speed, integral: Any = middle_integral) -> Any:
            return slip_rate(plant, x, speed, sliding_torque(case, x, speed, integral))

        after = np.clip(exponential_step(rate, slip, step), -0.5, LOCKED)
        middle = (slip + after) / 2
        speed = np.maximum(speed - step * slowing(plant, middle, middle_speed), 1e-3)
        integral = integral + step * (case.slip - middle)
        slip = after
        path.append(((k + 1) * step, slip, speed, integral))
    return path


@dataclass(frozen=True, slots=True, kw_only=True)
class Adapted:
    """What a run of the adaptive law with T = u gave: all arrays over the runs."""

    integral: Any  # of abs(s_D) d sigma, or dt
    inside: Any  # whether the slip stayed in the domain
    rise: Any  # largest increase of V from one step to the next
    rate: Any  # largest abs(d s_D) per unit of sigma, or time
    lowest: Any
    highest: Any


NEAR, SHORT = (
    0.8,
    10.0,
)  # from this share of the boundary layer on, where the law adapts, steps are shorter by this


def adaptive_run(
    case: Case,
    plant: Plant,
    slip: Any,
    speed: Any,
    *,
    least_speed: float,
    constant: Any,
    bound: Any,
    step: float,
) -> Adapted:
    """Run the adaptive law with T = u inside the brake, in sigma = int dt/v for scheduled rates, else in time.

    V = s_D^2/(2 g) + abs(b - b*)^2/(2 alpha_1) + (psi - psi*)^2/(2 alpha_2) with b* all equal to ``constant`` and psi*
    ``bound``; in time its first part has a factor v.
    """
    gains, unit = case.gains, case.gains["torque_unit"]
    scheduled = gains["scheduled_rates"]
    slip, speed = np.broadcast_arrays(np.array(slip, float), np.array(speed, float))
    slip, speed = slip.copy(), speed.copy()
    weights = np.multiply.outer(np.asarray(gains["initial_weights"]) * unit, np.ones_like(slip))
    psi, error = gains["initial_bound"] * unit * np.ones_like(slip), np.zeros_like(slip)
    total, rise, steepest = np.zeros_like(slip), np.full_like(slip, -np.inf), np.zeros_like(slip)
    lowest, highest = slip.copy(), slip.copy()
    g = plant.wheel_radius / plant.wheelset_inertia
    alpha1, alpha2 = gains["weight_rate"] * unit, gains["bound_rate"] * unit
    kp = gains["proportional_gain"]

    def energy(s_d: Any, weights: Any, psi: Any, speed: Any) -> Any:
        first = s_d**2 / (2 * g * kp) * (1.0 if scheduled else speed)
        return (
            first + ((weights - constant) ** 2).sum(axis=0) / (2 * alpha1) + (psi - bound) ** 2 / (2 * alpha2)
        )

    def variable(slip: Any, error: Any) -> Any:
        return kp * surface(case, slip, error)

    alive = np.ones_like(slip, bool)
    s_d = dead_zone(case, variable(slip, error))
    value = energy(s_d, weights, psi, speed)
    while alive.any():
        s = variable(slip, error)
        span = np.where(abs(s) > NEAR * gains["boundary_layer"], step / SHORT, step)
        time = np.where(alive, span * speed if scheduled else span, 0.0)
        middle_error = error + time / 2 * (case.slip - slip)

        def torque(x: Any, error: Any = middle_error, weights: Any = weights, psi: Any = psi) -> Any:
            demand = fuzzy_torque(case, variable(x, error), weights, psi)
            real = np.real(demand)
            return np.where(real > plant.max_torque, plant.max_torque, np.where(real < 0.0, 0.0, demand))

        demand = fuzzy_torque(case, s, weights, psi)
        held = ((demand > plant.max_torque) & (s > 0)) | ((demand < 0.0) & (s < 0))
        change, widening = adaptation(case, s, speed)
        if gains["hold_when_saturated"]:
            change, widening = np.where(held, 0.0, change), np.where(held, 0.0, widening)

        def rate(x: Any, speed: Any = speed, torque: Any = torque) -> Any:
            return slip_rate(plant, x, speed, torque(x))

        after = np.clip(exponential_step(rate, slip, np.maximum(time, 1e-12)), -0.2, LOCKED)
        after = np.where(alive, after, slip)
        middle = (slip + after) / 2
        speed = speed - time * slowing(plant, middle, speed)
        error = error + time * (case.slip - middle)
        weights, psi, slip = weights + time * change, psi + time * widening, after
        following = dead_zone(case, variable(slip, error))
        total = total + (abs(s_d) + abs(following)) / 2 * np.where(alive, span, 0.0)
        steepest = np.maximum(steepest, abs(following - s_d) / span)
        new = energy(following, weights, psi, speed)
        rise = np.maximum(rise, np.where(alive, (new - value) / (abs(value) + 1.0), -np.inf))
        lowest, highest = np.minimum(lowest, slip), np.maximum(highest, slip)
        value, s_d = new, following
        alive = alive & (speed > least_speed) & (slip >= case.slips[0]) & (slip <= case.slips[1])
    inside = (lowest >= case.slips[0]) & (highest <= case.slips[1])
    return Adapted(integral=total, inside=inside, rise=rise, rate=steepest, lowest=lowest, highest=highest)


def ideal_stop(plant: Plant, speed: Any, *, step: float = 0.01, pull: float = 60.0) -> tuple[Any, Any]:
    """Time [s] and distance [m] of a brake that fills until the adhesion peak and then stays there.

    The torque is at most that of a brake that only fills; below it, it moves the slip to the peak with a rate ``pull``
    [1/s]. The stop ends at 5 mm/s.
    """
    shape = np.broadcast(speed, plant.mass, plant.mu0, plant.max_torque).shape
    speed = np.broadcast_to(np.asarray(speed, float), shape).copy()
    slip, clock, way = np.full(shape, 1e-6), np.zeros(shape), np.zeros(shape)
    top, peaks = np.geomspace(4e-3, float(speed.max()), 90), []
    for each in top:
        peaks.append(np.broadcast_to(adhesion_peak(plant, each)[0], shape))
    table, logs = np.array(peaks), np.log(top)
    now = 0.0
    while (speed > 5e-3).any():
        alive = speed > 5e-3
        time = np.where(alive, step, 0.0)
        place = np.clip(
            np.interp(np.log(np.maximum(speed, top[0])), logs, np.arange(len(top))), 0, len(top) - 1
        )
        below = np.minimum(place.astype(int), len(top) - 2)
        rest = place - below
        low = np.take_along_axis(table, below[None], 0)[0]
        high = np.take_along_axis(table, below[None] + 1, 0)[0]
        goal = (1 - rest) * low + rest * high
        most = filling_from_empty(plant, now + step / 2)
        safe = np.maximum(speed, 5e-3)

        def rate(x: Any, safe: Any = safe, most: Any = most, goal: Any = goal) -> Any:
            free = slip_rate(plant, x, safe, most)
            wanted = pull * (goal - x)
            return np.where(np.real(free) < np.real(wanted), free, wanted)

        after = np.clip(exponential_step(rate, slip, step), 0.0, LOCKED)
        middle = (slip + after) / 2
        lost = slowing(plant, middle, safe)
        last = np.minimum(time, np.where(alive, speed / lost, 0.0))
        way = way + speed * last - lost * last**2 / 2
        clock = clock + last
        speed = np.where(alive, speed - lost * last, speed)
        slip = np.where(alive, after, slip)
        now += step
    return clock, way


def transient(case: Case, start: Any, time: Any) -> Any:
    """Return c abs(E1) exp(-c t), the transient of the band of the boundary layer."""
    rate = surface_rate(case)
    return rate * abs(start) * np.exp(-rate * time)
