"""Gains of the static law with torque feedback by stated rules.

Near an equilibrium the loop in y, the deviation of the sliding speed, and t, that of the torque over T_max, is

    y' = q y - gamma t,   t' = -a t + b (kappa y - K t),   q = p - a/v,   gamma = R T_max / (inertia of the wheelset),

a and b between 1/T_F and 1/T_V. With a fast pole a + b K the torque follows a line, on which

    y' = -(gamma kappa / (a/b + K) - q) y.

Sampling limits the fast pole of the *fastest* valve that the bounds allow, with the largest T_max: there the torque
settles within a sample, and a faster valve would let it swing. The *slowest* valve limits the slow pole omega: on the
line t falls as omega t, while venting changes the torque by no more than its share of T_max over T_V. It is reached
with the smallest T_max, the heaviest wheelset and the largest a/b, slowest over fastest time constant.
"""

from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.creep_slope import USED
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.certificates.setting.pulsed_valve import Sample, Times, sample_of
from wspd_design.certificates.theorems.quadratic import Law, gains, one_sample, ranges_of
from wspd_design.controllers.torque_feedback import TorqueFeedback, TorqueFeedbackGains
from wspd_design.design.maximize import maximize
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Gain, Specification
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

VENTED_SHARE = 0.5  # of T_max: the largest torque error that venting from full brake lets out along the line
POLES = 9  # values of q between the ends of its range
DUTIES = (Fraction(1, 5), Fraction(1, 2), Fraction(4, 5))  # that hold the torque
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
    poles, period = _poles(problem), specification.sample_time
    fast, slow = _times(problem)
    kappa, back = _rules(problem, poles, period)
    heaviest, (least, most) = problem.span("wheelset inertia")[1], problem.span("max torque")
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
            why=f"kappa = (tau_slow/tau_fast + K T_max/T_nominal)(omega + q)/gamma: the slow pole is at least omega = "
            f"1/({VENTED_SHARE:g} tau_slow) = {_slow_pole(slow):.3g} 1/s, so that venting from full brake lets out "
            f"{VENTED_SHARE:.0%} of T_max along the line; {largest}; tau from {fast:g} to {slow:g} s; gamma = "
            f"R T_max/inertia = {_acceleration(problem):.3g} m/s^2 with the smallest T_max of {least / 1e3:g} kN m and "
            f"the heaviest wheelset of {heaviest:g} kg m^2",
        ),
        Gain(
            name="torque_gain",
            value=back,
            unit="-",
            why=f"K = (tau/h - 1) T_nominal/T_max, at least 0: with the fastest valve, tau = {fast:g} s, and the "
            f"largest T_max of {most / 1e3:g} kN m the torque settles within a sample, h = {period:g} s; "
            f"{_sampled(problem, poles)}",
        ),
    )


def _rules(problem: Problem, poles: Poles, sample_time: float) -> tuple[float, float]:
    """Both gains, kappa [s/m] and K [-], for a sample time [s]."""
    fast, slow = _times(problem)
    least, most = problem.span("max torque")
    own = problem.nominal("max torque")
    back = max(fast / sample_time - 1.0, 0.0) * own / most
    opened = slow / fast + back * least / own
    return opened * (_slow_pole(slow) + max(poles.high, 0.0)) / _acceleration(problem), back


def _slow_pole(lag: float) -> float:
    return 1.0 / (VENTED_SHARE * lag)


def _times(problem: Problem) -> tuple[float, float]:
    """Smallest and largest time constant of the valve [s]."""
    spans = problem.span("fill time"), problem.span("vent time")
    return min(low for low, _ in spans), max(high for _, high in spans)


def _acceleration(problem: Problem) -> float:
    """Smallest change of the sliding speed that the law measures by full torque, gamma [m/s2]."""
    radius = problem.vehicle.wheel_radius
    return radius * problem.span("max torque")[0] / problem.span("wheelset inertia")[1]


def _poles(problem: Problem) -> Poles:
    """Search the ends of q on the domain, at slips within the tolerance of the reference."""
    names = ("slip", *USED)

    def pole(points: "Array") -> "Array":
        at = dynamics_at(problem, points, names)
        found: Array = at.pole - at.deceleration / points[:, names.index("speed")]
        return found

    low, high = domain.box(problem, names)
    low[0], high[0] = problem.near
    largest = maximize(pole, low, high, seed=problem.seed)
    smallest = maximize(lambda points: -pole(points), low, high, seed=problem.seed)
    varied = [k for k in range(len(names)) if low[k] < high[k]]
    shown = domain.readable(largest.point[varied], [names[k] for k in varied])
    place = ", ".join(f"{each.name} {each.value:.4g} {each.unit}".removesuffix(" -") for each in shown)
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
    """Largest eigenvalue of the sampled loop with the gains for a sample time [s], over q, valve, T_max and inertia."""
    import numpy as np

    kappa, back = _rules(problem, poles, sample_time)
    vehicle = problem.vehicle
    law = Law(
        slide=Fraction(kappa) * Fraction(vehicle.wheel_radius),
        torque=Fraction(back) / Fraction(vehicle.brake.max_torque),
        sample_time=Fraction(sample_time),
    )
    fill, vent, *rest = ranges_of(problem, (Fraction(0), Fraction(0)))
    found = [
        sample_of(Times((f, f), (v, v)), (Fraction(q), Fraction(q)), law.sample_time, (u, u))
        for f, v, u, q in product(
            dict.fromkeys(fill), dict.fromkeys(vent), DUTIES, np.linspace(poles.low, poles.high, POLES)
        )
    ]
    # A column of samples beside a row of corners gives all matrices at once.
    numbers = np.array([[[float(low), float(high)] for low, high in each] for each in found])
    at = Sample(*((each[:, :1], each[:, 1:]) for each in np.moveaxis(numbers, 1, 0)))
    g, torque = np.array([[float(each) for each in corner] for corner in gains(law, (fill, vent, *rest))]).T
    matrices = np.array([np.broadcast_arrays(*row) for row in one_sample(at, g, torque)])
    return float(np.abs(np.linalg.eigvals(np.moveaxis(matrices, (0, 1), (-2, -1)))).max())
