"""The torque feedback near its equilibrium: where that lies, and the sampled map with true pulses, differentiated."""

from typing import Any, NamedTuple

import numpy as np

from tests.attack.case import Case
from tests.attack.laws import feedback_duty, layer, surface_rate
from tests.attack.plant import Plant, deceleration, filling_duty, holding_torque, slip_pole

SLIPS = np.concatenate([np.geomspace(1e-3, 0.02, 12), np.linspace(0.025, 0.995, 120)])
ROUNDS = 45  # of the bisections


class Orbit(NamedTuple):
    """Periodic shares of T_max of a valve that fills for a duty and vents for the rest of each sample."""

    start: Any  # at the sample
    top: Any  # when filling ends
    mean: Any


def orbit(plant: Plant, duty: Any, sample_time: float) -> Orbit:
    """Return the periodic orbit of the torque."""
    kept = np.exp(-duty * sample_time / plant.fill_time)
    left = np.exp(-(1.0 - duty) * sample_time / plant.vent_time)
    top = (1.0 - kept) / (1.0 - kept * left)
    start = top * left
    area = duty * sample_time - (1.0 - start) * plant.fill_time * (1.0 - kept)
    area = area + top * plant.vent_time * (1.0 - left)
    return Orbit(start, top, area / sample_time)


def duty_of(plant: Plant, share: Any, sample_time: float) -> Any:
    """Duty whose orbit has a mean share of T_max; it is clear of 0 and 1."""
    low, high = np.full(np.shape(share), 1e-9), np.full(np.shape(share), 1.0 - 1e-9)
    for _ in range(ROUNDS):
        middle = (low + high) / 2
        above = orbit(plant, middle, sample_time).mean > share
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return (low + high) / 2


def equilibrium(case: Case, plant: Plant, speed: Any, *, sampled: bool = True) -> tuple[Any, Any]:
    """Slip and duty at which plant and law agree, nearest to the reference; not a number where there is none.

    Sampled, the law reads the torque where it is lowest, at the samples; the ripple of the slip is left out.
    """

    def excess(slip: Any) -> tuple[Any, Any]:
        share = np.clip(holding_torque(plant, slip, speed) / plant.max_torque, 1e-6, 1.0 - 1e-6)
        if sampled:
            duty = duty_of(plant, share, case.sample_time)
            seen = orbit(plant, duty, case.sample_time).start
        else:
            duty, seen = filling_duty(plant, share), share
        wanted = feedback_duty(case, slip, speed, seen * plant.max_torque, limited=False)
        return wanted - duty, duty

    shape = np.broadcast(speed, plant.mass, plant.mu0, plant.fill_time, plant.vent_time).shape
    grid = SLIPS.reshape((-1,) + (1,) * len(shape))
    values, _ = excess(np.broadcast_to(grid, (len(SLIPS), *shape)))
    crossing = np.sign(values[:-1]) != np.sign(values[1:])
    distance = np.where(crossing, abs((grid[:-1] + grid[1:]) / 2 - case.slip), np.inf)
    first = np.argmin(distance, axis=0)
    low, high = SLIPS[first], SLIPS[first + 1]
    sign = np.sign(np.take_along_axis(values, first[None], 0)[0])
    for _ in range(30):
        middle = (low + high) / 2
        same = np.sign(excess(middle)[0]) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    slip = (low + high) / 2
    lost = np.isinf(np.min(distance, axis=0))
    return np.where(lost, np.nan, slip), np.where(lost, np.nan, excess(slip)[1])


def difference_rate(plant: Plant, slip: Any, speed: Any) -> Any:
    """Return q = p - a/v [1/s]."""
    return slip_pole(plant, slip, speed) - deceleration(plant, slip, speed) / speed


def _lag(rate: Any, q: Any, time: Any) -> Any:
    """Integral of exp(q (time - s)) exp(-s rate) ds from 0 to time."""
    total = q + rate
    small = abs(total) * time < 1e-7
    safe = np.where(small, 1.0, total)
    return np.where(small, time * np.exp(q * time), (np.exp(q * time) - np.exp(-rate * time)) / safe)


def sampled_map(case: Case, plant: Plant, slip: Any, speed: Any, duty: Any, *, q: Any | None = None) -> Any:
    """Derivative of the one-sample map in (y, t) at an orbit, matrices along the first two axes.

    y = v e is the error of the sliding speed [m/s], t that of the torque over T_max of the design model. The instant at
    which filling ends depends on the state, which adds the jump of the rate of the torque there.
    """
    scale = plant.max_torque / case.model.max_torque
    gamma = plant.wheel_radius * case.model.max_torque / plant.wheelset_inertia
    q = difference_rate(plant, slip, speed) if q is None else q
    top = orbit(plant, duty, case.sample_time).top
    jump = case.sample_time * scale * ((1.0 - top) / plant.fill_time + top / plant.vent_time)
    zero, one = np.zeros(np.shape(q)), np.ones(np.shape(q))

    def flow(time: Any, lag: Any) -> Any:
        return np.array(
            [
                [np.exp(q * time), -gamma * _lag(1.0 / lag, q, time)],
                [zero, one * np.exp(-time / lag)],
            ]
        )

    feedback = np.array([case.gains["sliding_gain"] * one, -case.gains["torque_gain"] * one])
    filling = flow(duty * case.sample_time, plant.fill_time)
    filling = filling + np.array([zero * feedback, jump * feedback])
    venting = flow((1.0 - duty) * case.sample_time, plant.vent_time)
    return np.einsum("ij...,jk...->ik...", venting, filling)


def continuous_rates(case: Case, plant: Plant, slip: Any, speed: Any, *, frozen: bool) -> Any:
    """Matrix of the averaged loop in (y, t): q, or at frozen speed p, in place of the first entry."""
    q = slip_pole(plant, slip, speed) if frozen else difference_rate(plant, slip, speed)
    return averaged(case, plant, holding_torque(plant, slip, speed) / plant.max_torque, q)


def averaged(case: Case, plant: Plant, share: Any, q: Any) -> Any:
    """Matrix of the averaged loop in (y, t) at a share of T_max, with q as its first entry."""
    scale = plant.max_torque / case.model.max_torque
    gamma = plant.wheel_radius * case.model.max_torque / plant.wheelset_inertia
    duty = filling_duty(plant, share)
    slope = scale * ((1.0 - share) / plant.fill_time + share / plant.vent_time)
    own = duty / plant.fill_time + (1.0 - duty) / plant.vent_time
    one = np.ones(np.shape(q))
    return np.array(
        [
            [q, -gamma * one],
            [
                case.gains["sliding_gain"] * slope * one,
                -own - slope * case.gains["torque_gain"] * one,
            ],
        ]
    )


def surface_poles(case: Case, plant: Plant, speed: Any) -> Any:
    """Largest real part of the poles of the sliding-mode law inside its layer behind the averaged valve [1/s]."""
    p, c = slip_pole(plant, case.slip, speed), surface_rate(case)
    share = np.clip(holding_torque(plant, case.slip, speed) / plant.max_torque, 0.0, 1.0)
    duty = filling_duty(plant, share)
    own = duty / plant.fill_time + (1.0 - duty) / plant.vent_time
    slope = (1.0 - share) / plant.fill_time + share / plant.vent_time
    ratio = (
        case.model.wheelset_inertia / plant.wheelset_inertia * plant.wheel_radius / case.model.wheel_radius
    )
    inner = slip_pole(case.model, case.slip, speed)
    # e' = p e - G t, t' = -own t + slope u, u = G_hat^-1 ((p_hat + c) e + W (e + c z)), z' = e
    push = case.gains["switching_gain"] / speed / layer(case)
    one = np.ones(np.broadcast(p, own, ratio).shape)
    matrix = np.array(
        [
            [p * one, -ratio * one, 0 * one],
            [slope * (-inner + c + push) * one, -own * one, slope * push * c * one],
            [one, 0 * one, 0 * one],
        ]
    )
    return np.linalg.eigvals(np.moveaxis(matrix, (0, 1), (-2, -1))).real.max(axis=-1)


def spectral_radius(matrix: Any) -> Any:
    """Largest modulus of the eigenvalues of 2 x 2 matrices along the first two axes."""
    trace = matrix[0, 0] + matrix[1, 1]
    determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
    root = np.sqrt(trace**2 / 4 - determinant + 0j)
    return np.maximum(abs(trace / 2 + root), abs(trace / 2 - root))


def abscissa(matrix: Any) -> Any:
    """Largest real part of the eigenvalues of 2 x 2 matrices along the first two axes."""
    trace = matrix[0, 0] + matrix[1, 1]
    determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
    return np.real(trace / 2 + np.sqrt(trace**2 / 4 - determinant + 0j))


def contraction(matrix: Any, p: Any) -> Any:
    """Largest sqrt(V(M x)/V(x)) of V = x'Px, P = (p11, p12, p22), for matrices along the first two axes."""
    return np.sqrt(_largest(p, np.einsum("ki...,kl...,lj...->ij...", matrix, _full(p), matrix)))


def growth(matrix: Any, p: Any) -> Any:
    """Largest V'/(2 V) of V = x'Px along x' = A x."""
    moved = np.einsum("ki...,kj...->ij...", matrix, _full(p))
    return _largest(p, moved + np.swapaxes(moved, 0, 1)) / 2.0


def _full(p: Any) -> Any:
    return np.array([[p[0], p[1]], [p[1], p[2]]])


def _largest(p: Any, form: Any) -> Any:
    """Largest x'Fx/x'Px."""
    determinant = p[0] * p[2] - p[1] ** 2
    trace = (p[2] * form[0, 0] - 2.0 * p[1] * form[0, 1] + p[0] * form[1, 1]) / determinant
    product = (form[0, 0] * form[1, 1] - form[0, 1] ** 2) / determinant
    return trace / 2 + np.sqrt(np.maximum(trace**2 / 4 - product, 0.0))
