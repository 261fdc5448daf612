"""What V(0) of the repaired energy bounds for the adaptive law, and the conditions that its theorems share."""

import math
from dataclasses import dataclass

from wspd_design.certificates.kernel.arb import Ball, above, point
from wspd_design.certificates.kernel.obligation import Condition
from wspd_design.certificates.records import Problem
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains

CHOICES = 401  # of the constant ideal weight


@dataclass(frozen=True, slots=True, kw_only=True)
class Energy:
    """What V(0) bounds, for ideal weights that are all alike."""

    weight: float  # N m, ideal
    bound: float  # N m, psi
    start: Ball  # N m s, V(0)
    integral: Ball  # s, of abs(s_D)
    weight_error: Ball  # N m, norm of the distance of the weights from the ideal ones
    highest_bound: Ball  # N m, of psi_hat


def energy(
    problem: Problem,
    gains: AdaptiveFuzzyGains,
    lowest: float,
    highest: float,
    eta: float,
    factor: float,
) -> Energy:
    """Bounds for all time, from V = v s_D^2/(2 g) + abs(b~)^2/(2 alpha1) + psi~^2/(2 alpha2).

    With g = R/I_w, s_D' = G (u* - u) outside the layer, and the adaptation with s_D,
    V' = s_D (u* - b*'w) - psi abs(s_D) - a s_D^2/(2 g). The rule strengths sum to one, so that weights that are all
    beta make b*'w = beta, and any psi >= abs(u* - beta) + eta/g gives V' <= -(eta/g) abs(s_D) where a >= 0: the
    integral of abs(s_D) is at most V(0) g/eta. beta and psi are free: those that make V(0) smallest are taken.

    Where the command leaves [0, T_max] and pushes further in the direction that s_D asks for, the adaptation is
    held and V' = s_D (u* - T) - a s_D^2/(2 g) <= -(eta/g) abs(s_D), because u* stays inside by eta/g. Where it
    leaves the range against s_D, the limit moves T towards u*, which only makes V' smaller.

    Parameters
    ----------
    problem : Problem
        Bounds of the parameters and the highest speed.
    gains : AdaptiveFuzzyGains
        Law.
    lowest, highest : float
        Lower bound of u* - eta/g and upper bound of u* + eta/g on the domain [N m].
    eta : float
        Reaching rate [m/s2].
    factor : float
        Of s_D^2/(2 g) in V: the speed at the start [m/s]; in sigma = integral of dt/v it is 1.
    """
    unit = gains.torque_unit
    # The law adapts with s, which counts K_P times s / K_P.
    rates = [point(unit) * gains.proportional_gain * rate for rate in (gains.weight_rate, gains.bound_rate)]
    starts = [point(unit) * weight for weight in gains.initial_weights]
    guessed = point(unit) * gains.initial_bound

    def adaptive(beta: float) -> tuple[Ball, float]:
        """What weights and bound contribute to V(0), and psi."""
        bound = max(
            math.nextafter(highest - beta, math.inf), math.nextafter(beta - lowest, math.inf), above(guessed)
        )
        squares = sum(((point(beta) - b) ** 2 for b in starts), point(0.0))
        return squares / rates[0] / 2 + (point(bound) - guessed) ** 2 / rates[1] / 2, bound

    span = highest - lowest
    choices = [lowest - span + 3.0 * span * k / (CHOICES - 1) for k in range(CHOICES)]
    beta = min(choices, key=lambda choice: float(adaptive(choice)[0]))
    stored, bound = adaptive(beta)
    light, heavy = (point(each) for each in problem.span("wheelset inertia"))
    radius = point(problem.vehicle.wheel_radius)
    outside = point(gains.slip_reference) - point(gains.boundary_layer) / gains.proportional_gain
    # From the layer, of a rolling wheel or one that slips more.
    distance = outside if outside > 0 else point(0.0)
    kinetic = point(factor) * distance**2 / 2
    start = kinetic * heavy / radius + stored
    return Energy(
        weight=beta,
        bound=bound,
        start=start,
        integral=kinetic / eta + stored * radius / light / eta,
        weight_error=(2 * rates[0] * start).sqrt(),
        highest_bound=point(bound) + (2 * rates[1] * start).sqrt(),
    )


def smallest_gain(gains: AdaptiveFuzzyGains) -> float:
    """Return the smallest of the gains that must be positive; one that is not a number counts as the smallest."""
    needed = (
        gains.weight_rate,
        gains.bound_rate,
        gains.proportional_gain,
        gains.integral_gain,
        gains.boundary_layer,
    )
    return -math.inf if any(math.isnan(each) for each in needed) else min(needed)


def adaptation_conditions(gains: AdaptiveFuzzyGains, *, scheduled: bool) -> tuple[Condition, ...]:
    """Return what the repaired Lyapunov function asks of the law.

    Parameters
    ----------
    gains : AdaptiveFuzzyGains
        Of the law.
    scheduled : bool
        Whether the rates of adaptation have to be alpha/v, or must not depend on the speed.
    """
    rates = "are alpha/v" if scheduled else "do not depend on the speed"
    return (
        Condition(
            key="gains",
            text="K_P, K_I, Phi and both adaptation rates are positive",
            holds=smallest_gain(gains) > 0.0,
        ),
        Condition(key="dead zone", text="the law adapts with s_D alone", holds=gains.dead_zone),
        Condition(
            key="rates", text=f"the adaptation rates {rates}", holds=gains.scheduled_rates is scheduled
        ),
        Condition(
            key="hold",
            text="the adaptation is held while the command pushes beyond the brake",
            holds=gains.hold_when_saturated,
        ),
    )


def rounded_up(bound: float) -> str:
    """Write an upper bound so that what stands there is still one."""
    return f"{math.ceil(100.0 * bound) / 100.0:.2f}"
