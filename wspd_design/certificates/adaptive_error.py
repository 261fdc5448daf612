"""Errors of the adaptive law against ideal weights and bound, chosen after the run that they judge."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.certificates.proof_run import ProofRun
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains, firing_strengths, sliding_variable
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import saturation
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

    weights: "Array"
    bound: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Signals:
    """What the candidates for V are made of, over time; torques in N m."""

    speed: "Array"  # m/s
    surface: "Array"  # s
    dead_zone: "Array"  # s_D, part of s / K_P outside the layer
    outside: "Array"  # whether s is outside the layer
    gain: "Array"  # 1/(N m s), G
    gain_rate: "Array"  # G' = G a / v
    deceleration: "Array"  # m/s2
    approximation_error: "Array"  # xi = u* - b*'w
    weight_error_squared: "Array"
    bound_error: "Array"
    bound: float  # psi


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

    strengths, torque, margin = _ideal_torque(vehicle, rail, gains, run.states, reserve)
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
    return Ideal(weights=weights, bound=float(rest) + margin)


def signals(
    vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains, states: "Array", target: Ideal
) -> Signals:
    """Evaluate the errors of the law along states of the idealized loop."""
    import numpy as np

    unit = gains.torque_unit
    strengths, torque, _ = _ideal_torque(vehicle, rail, gains, states, 0.0)
    speed, slip, integral = states[:3]
    plant = slip_dynamics(vehicle, rail, slip, speed)
    surface = sliding_variable(gains, sliding_surface.slip_error(gains.slip_reference, slip), integral)
    layer = gains.boundary_layer
    differences = target.weights[:, None] - states[3:-1]
    return Signals(
        speed=speed,
        surface=surface,
        dead_zone=(surface - layer * saturation(surface / layer)) / gains.proportional_gain,
        outside=np.abs(surface) > layer,
        gain=plant.gain,
        gain_rate=plant.gain * plant.deceleration / speed,
        deceleration=plant.deceleration,
        approximation_error=unit * (torque - target.weights @ strengths),
        weight_error_squared=unit**2 * np.sum(differences**2, axis=0),
        bound_error=unit * (target.bound - states[-1]),
        bound=unit * target.bound,
    )


def _ideal_torque(
    vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains, states: "Array", reserve: float
) -> tuple["Array", "Array", float]:
    """Rule strengths w, ideal torque u* and the reserve eta/g, the last two in units of u."""
    import numpy as np

    speed, slip, integral = states[:3]
    error = sliding_surface.slip_error(gains.slip_reference, slip)
    rate = gains.integral_gain / gains.proportional_gain
    plant = slip_dynamics(vehicle, rail, slip, speed)
    torque = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, error, rate)
    strengths = np.array(firing_strengths(gains, sliding_variable(gains, error, integral)))
    margin = reserve / float(plant.gain[0] * speed[0])
    return strengths, torque / gains.torque_unit, margin / gains.torque_unit
