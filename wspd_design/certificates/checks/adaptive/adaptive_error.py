"""Errors of the adaptive law against ideal weights and bound, chosen after the run that they judge."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.ideal_run import ProofRun, State
from wspd_design.certificates.kernel.arb import point
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains, firing_strengths, sliding_variable
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number, saturation
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

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


def ideal(vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains, run: ProofRun, reserve: float) -> Ideal:
    """Choose b* and psi that make V start as low as possible among all that satisfy (34) along the run.

    Any constant b* with a psi that bounds the rest satisfies the hypotheses of the proof; this choice is the
    one most favorable to it.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Plant.
    gains : AdaptiveFuzzyGains
        Law of the run.
    run : ProofRun
        The run.
    reserve : float
        Reaching rate eta [m/s2].
    """
    import numpy as np
    from scipy.optimize import minimize

    strengths, torque = map(np.array, _ideal_torque(vehicle, rail, gains, run.states))
    fastest = slip_dynamics(vehicle, rail, run.slip[0], run.speed[0])
    margin = reserve / float(fastest.gain * run.speed[0]) / gains.torque_unit
    start = np.array(gains.initial_weights)

    def energy(x: "Array") -> float:
        weights, bound = x[:-1] - start, x[-1] + margin - gains.initial_bound
        return float(weights @ weights / gains.weight_rate + bound**2 / gains.bound_rate)

    def slope(x: "Array") -> "Array":
        bound = x[-1] + margin - gains.initial_bound
        return np.append(2.0 * (x[:-1] - start) / gains.weight_rate, 2.0 * bound / gains.bound_rate)

    ones = np.ones((len(torque), 1))
    matrix = np.vstack([np.hstack([strengths.T, ones]), np.hstack([-strengths.T, ones])])
    limits = np.concatenate([torque, -torque])
    guess = np.append(np.full(len(start), torque.mean()), np.ptp(torque))
    found = minimize(
        energy,
        guess,
        jac=slope,
        method="SLSQP",
        constraints=[{"type": "ineq", "fun": lambda x: matrix @ x - limits, "jac": lambda _: matrix}],
    )
    weights = found.x[:-1] if np.all(np.isfinite(found.x)) else guess[:-1]
    rest = np.abs(torque - weights @ strengths).max()
    return Ideal(weights=tuple(weights.tolist()), bound=float(rest) + margin)


def signals(vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains, states: State, target: Ideal) -> Signals:
    """Evaluate the errors of the law at states of the idealized loop: arrays over time, or balls at one instant."""
    unit = gains.torque_unit
    strengths, torque = _ideal_torque(vehicle, rail, gains, states)
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


def _ideal_torque(
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
