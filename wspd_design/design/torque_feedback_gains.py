"""Gains of the static law with torque feedback by stated rules.

Near the reference the loop in y = v e, the error of the sliding speed, and t, the error of the torque over T_max,
has the matrix [[q, -gamma], [kappa/tau, -(1 + K)/tau]] with q = p - a/v and gamma = R T_max / (inertia of the
wheelset). With a fast pole (1 + K)/tau the torque follows the line t = kappa/(1 + K) y, on which

    y' = -(gamma kappa/(1 + K) - q) y.

Sampling limits the fast pole, the valve the slow one: on the line t falls as omega t, while venting changes the
torque by no more than its share of T_max over tau.
"""

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.linear_loop import lag_of
from wspd_design.certificates.theorems.quadratic import held, loop_of
from wspd_design.controllers.torque_feedback import TorqueFeedback, TorqueFeedbackGains
from wspd_design.design.maximize import maximize
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Gain, Specification
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

VENTED_SHARE = 0.5  # of T_max: the largest torque error that venting from full brake lets out along the line
POLES = 9  # values of q between the ends of its range
SHORTEST = 1e-3  # s, of the sample times that are tried
HALVINGS = 12  # of their range


class Poles(NamedTuple):
    """Ends of q = p - a/v that were found on the domain [1/s], and where the upper one is."""

    low: float
    high: float
    where: str


def torque_feedback_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose kappa and K.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, nominal values; its bounds and those of the rail span the uncertainty.
    rail : Rail
        Design rail.
    specification : Specification
        Reference, ranges and sample time.

    Returns
    -------
    tuple of Gain
        ``sliding_gain`` [s/m] and ``torque_gain`` [-].
    """
    unfinished = TorqueFeedback(
        name="unfinished",
        sample_time=specification.sample_time,
        vehicle=vehicle,
        rail=rail,
        gains=TorqueFeedbackGains(slip_reference=specification.slip, sliding_gain=0.0, torque_gain=0.0),
    )
    problem = stability_problem(vehicle, rail, unfinished, specification)
    poles, lag, period = _poles(problem), lag_of(problem), specification.sample_time
    kappa, back = _rules(problem, poles, period)
    heaviest = problem.inertia_bounds[1]
    gamma = _acceleration(problem)
    largest = (
        f"q = p - a/v = {poles.high:.3g} 1/s, the largest that sampling finds ({poles.where})"
        if poles.high > 0.0
        else "q = 0, since sampling finds no positive p - a/v"
    )
    return (
        Gain(
            name="sliding_gain",
            value=kappa,
            unit="s/m",
            why=f"kappa = (1 + K)(omega + q)/gamma: the slow pole is at least omega = 1/({VENTED_SHARE:g} tau) = "
            f"{_slow_pole(lag):.3g} 1/s, so that venting from full brake lets out {VENTED_SHARE:.0%} of T_max along "
            f"the line; {largest}; gamma = R T_max/inertia = {gamma:.3g} m/s^2 with the "
            f"heaviest wheelset of {heaviest:g} kg m^2",
        ),
        Gain(
            name="torque_gain",
            value=back,
            unit="-",
            why=f"K = tau/h - 1, at least 0: the torque settles within a sample, (1 + K)/tau = 1/h, with "
            f"tau = {lag:g} s and h = {period:g} s; {_sampled(problem, poles)}",
        ),
    )


def _rules(problem: Problem, poles: Poles, sample_time: float) -> tuple[float, float]:
    """Both gains, kappa [s/m] and K [-], for a sample time [s]."""
    lag = lag_of(problem)
    back = max(lag / sample_time - 1.0, 0.0)
    return (1.0 + back) * (_slow_pole(lag) + max(poles.high, 0.0)) / _acceleration(problem), back


def _slow_pole(lag: float) -> float:
    return 1.0 / (VENTED_SHARE * lag)


def _acceleration(problem: Problem) -> float:
    """Change of the sliding speed by full torque with the heaviest wheelset, gamma [m/s2]."""
    vehicle = problem.vehicle
    return vehicle.wheel_radius * vehicle.brake.max_torque / problem.inertia_bounds[1]


def _poles(problem: Problem) -> Poles:
    """Search the ends of q on the domain, at the reference."""

    def pole(points: "Array") -> "Array":
        at = domain.dynamics(problem, points)
        found: Array = at.pole - at.deceleration / points[:, domain.SPEED]
        return found

    low, high = domain.slip_held(problem)
    largest = maximize(pole, low, high, seed=problem.seed)
    smallest = maximize(lambda points: -pole(points), low, high, seed=problem.seed)
    place = ", ".join(
        f"{each.name} {each.value:.4g} {each.unit}".removesuffix(" -")
        for each in domain.readable(largest.point)
        if each.name != "slip"
    )
    return Poles(low=-smallest.value, high=largest.value, where=place)


def _sampled(problem: Problem, poles: Poles) -> str:
    """Say how fast the sampled loop is, or from which sample time on it would be stable."""
    kept = _kept_per_sample(problem, poles, problem.sample_time)
    if kept < 1.0:
        return f"near the reference a deviation keeps at most {kept:.2g} of itself per sample"
    low, high = SHORTEST, problem.sample_time
    if _kept_per_sample(problem, poles, low) >= 1.0:
        return "not stable near the reference, whatever the sample time"
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _kept_per_sample(problem, poles, middle) < 1.0 else (low, middle)
    return (
        f"with this sample time the loop is not stable near the reference on all of the domain: it takes less than "
        f"{low * 1e3:.2g} ms"
    )


def _kept_per_sample(problem: Problem, poles: Poles, sample_time: float) -> float:
    """Largest eigenvalue of the sampled loop with the gains for a sample time [s], over q and the inertias."""
    import numpy as np

    kappa, back = _rules(problem, poles, sample_time)
    gains = TorqueFeedbackGains(slip_reference=problem.slip, sliding_gain=kappa, torque_gain=back)
    law = TorqueFeedback(
        name="tried", sample_time=sample_time, vehicle=problem.vehicle, rail=problem.rail, gains=gains
    )
    loop = loop_of(replace(problem, controller=law, sample_time=sample_time), law)
    steps = [
        held(loop, point(float(q)), point(gamma))
        for q in np.linspace(poles.low, poles.high, POLES)
        for gamma in loop.gamma
    ]
    matrices = np.array([[[float(each) for each in row] for row in step] for step in steps])
    return float(np.abs(np.linalg.eigvals(matrices)).max())
