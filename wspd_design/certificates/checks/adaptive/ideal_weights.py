"""The ideal weights and bound that judge a run of the adaptive law, chosen after it."""

from typing import TYPE_CHECKING

from wspd_design.certificates.checks.ideal_run import ProofRun
from wspd_design.certificates.theorems.adaptive_error import Ideal, ideal_torque
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


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

    strengths, torque = map(np.array, ideal_torque(vehicle, rail, gains, run.states))
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
