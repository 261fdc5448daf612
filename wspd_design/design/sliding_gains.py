"""Gains of the laws with a sliding surface, by stated rules.

Every rule is a formula of the vehicle, the rail, the specification and the bounds of the parameters; the reason
that goes with a gain repeats it with its numbers.
"""

import math

from wspd_design.certificates.checks.sliding.reaching import required_gain
from wspd_design.certificates.theorems.sliding import reserve
from wspd_design.controllers.sliding_mode import SlidingMode, SlidingModeGains
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Gain, Specification
from wspd_design.model.slip import resistance, slip_dynamics, static_wheel_load
from wspd_design.parameters.loading import load_paper_gains
from wspd_design.parameters.records import Rail, Vehicle

LAG_SEPARATION = 4.0  # the surface is this many times slower than valve and sampling
RULES = 5  # membership functions, as in the paper
ADAPTATION_SHARE = 0.1  # of the brake torque that adaptation may move in one time constant of the surface
SWITCHING_RESERVE = 1.02  # on the sampled supremum, which is a lower bound of the true one


def sliding_mode_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose c, W0 and the boundary layer of the sliding mode with a friction model.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Nominal values, with the bounds that span the uncertainty.
    specification : Specification
        Reference, ranges, tolerance and sample time.

    Returns
    -------
    tuple of Gain
        ``surface_rate`` [1/s], ``switching_gain`` [m/s^2] and ``boundary_layer`` [-].
    """
    rate = _surface_rate(vehicle, rail, specification)
    layer = _boundary_layer(specification)
    return rate, _switching_gain(vehicle, rail, specification, rate), layer


def _surface_rate(vehicle: Vehicle, rail: Rail, specification: Specification) -> Gain:
    lag = vehicle.brake.fill_time + specification.sample_time / 2.0
    value = 1.0 / (LAG_SEPARATION * lag)
    top_speed = specification.speeds[1]
    shortest = top_speed / deceleration_limit(vehicle, rail, top_speed)
    return Gain(
        name="surface_rate",
        value=value,
        unit="1/s",
        why=f"c = K_I/K_P = 1/({LAG_SEPARATION:g} (tau + h/2)): {LAG_SEPARATION:g} times slower than the valve "
        f"(tau = {vehicle.brake.fill_time:g} s) and half a sample (h = {specification.sample_time:g} s); "
        f"its time constant of {1.0 / value:.2f} s stands against a stop of at least {shortest:.1f} s",
    )


def _boundary_layer(specification: Specification) -> Gain:
    return Gain(
        name="boundary_layer",
        value=specification.slip_tolerance / 2.0,
        unit="-",
        why=f"Phi/K_P = tolerance/2: inside the layer abs(e) <= 2 Phi/K_P = {specification.slip_tolerance:g}",
    )


def _switching_gain(vehicle: Vehicle, rail: Rail, specification: Specification, rate: Gain) -> Gain:
    assert isinstance(rate.value, float)
    # What is needed depends on surface and design model alone, so the law may still lack its switching gain.
    unfinished = SlidingMode(
        name="unfinished",
        sample_time=specification.sample_time,
        vehicle=vehicle,
        rail=rail,
        gains=SlidingModeGains(
            slip_reference=specification.slip,
            surface_rate=rate.value,
            switching_gain=0.0,
            boundary_layer=specification.slip_tolerance / 2.0,
        ),
    )
    problem = stability_problem(vehicle, rail, unfinished, specification)
    needed = required_gain(problem)
    place = ", ".join(f"{point.name} {point.value:.4g} {point.unit}".rstrip(" -") for point in needed.point)
    return Gain(
        name="switching_gain",
        value=SWITCHING_RESERVE * needed.value,
        unit="m/s^2",
        why=f"W0 = W v = {SWITCHING_RESERVE:g} sup (abs(r) + eta)/rho, the reaching condition; it is tightest with "
        f"{needed.value:.4g} m/s^2 at {place}; eta = {reserve(problem):.3g} m/s^2 lets the surface be reached above "
        f"{specification.speeds[0] * 3.6:.3g} km/h",
    )


def adaptive_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains of the adaptive law in its repaired form from those of the sliding mode.

    Parameters and result are those of :func:`sliding_mode_gains`, with the gains of ``afsmc``.
    """
    rate, switching, layer = sliding_mode_gains(vehicle, rail, specification)
    assert isinstance(rate.value, float)
    assert isinstance(switching.value, float)
    assert isinstance(layer.value, float)
    unit = load_paper_gains().torque_unit
    low, high = specification.speeds
    middle = math.sqrt(low * high)
    point = slip_dynamics(vehicle, rail, specification.slip, middle)
    full = vehicle.brake.max_torque / unit
    equilibrium = -point.drift / point.gain / unit
    held = f"slip {specification.slip:g} at {middle * 3.6:.0f} km/h on {rail.name}"
    bound = switching.value / (middle * point.gain) / unit
    adaptation = ADAPTATION_SHARE * vehicle.brake.max_torque / unit * rate.value / layer.value
    span = specification.slip
    spacing = 2.0 * span / (RULES - 1)
    centres = tuple(-span + spacing * index for index in range(RULES))
    width = spacing / (2.0 * math.sqrt(math.log(2.0)))
    share = f"{ADAPTATION_SHARE:.0%} of the brake torque"
    return (
        Gain(name="proportional_gain", value=1.0, unit="-", why="K_P = 1: s is then a slip; only ratios act"),
        Gain(name="integral_gain", value=rate.value, unit="1/s", why=rate.why),
        Gain(name="boundary_layer", value=layer.value, unit="-", why=layer.why),
        Gain(
            name="weight_rate",
            value=adaptation,
            unit="kN m/s",
            why=f"alpha_1 = {ADAPTATION_SHARE:g} T_max c/(Phi/K_P): one boundary layer of error, held for the "
            f"time constant of the surface, moves the weights by {share}",
        ),
        Gain(
            name="bound_rate",
            value=adaptation,
            unit="kN m/s",
            why="alpha_2 = alpha_1: weights and bound adapt alike, since both are torques",
        ),
        Gain(
            name="initial_weights",
            value=(min(equilibrium, full),) * RULES,
            unit="kN m",
            why=f"b_hat(0) = -F/G: the torque that holds {held}"
            if equilibrium <= full
            else f"b_hat(0) = T_max: the {equilibrium:.4g} kN m that would hold {held} are more than the brake has",
        ),
        Gain(
            name="initial_bound",
            value=bound,
            unit="kN m",
            why=f"psi_hat(0) = W0 2 I/R: the switching torque that the reaching condition asks for; {switching.why}",
        ),
        Gain(
            name="centres",
            value=centres,
            unit="-",
            why=f"{RULES} membership functions evenly over +-{span:g}: at the start of braking s = slip reference",
        ),
        Gain(
            name="widths",
            value=(width,) * RULES,
            unit="-",
            why="spacing/(2 sqrt(ln 2)): neighbors cross at one half",
        ),
        Gain(name="torque_unit", value=unit, unit="N m", why="u counts in kN m, as the printed gains do"),
        Gain(
            name="dead_zone",
            value=True,
            unit="-",
            why="adapt with the part of s outside the boundary layer: the repaired V needs it",
        ),
        Gain(
            name="hold_when_saturated",
            value=True,
            unit="-",
            why="hold the adaptation while the command pushes beyond 0 or T_max: the repaired V needs it",
        ),
        Gain(
            name="scheduled_rates",
            value=False,
            unit="-",
            why="constant rates, as printed; rates alpha/v, which Barbalat's lemma needs, would grow as the "
            "train slows",
        ),
    )


def deceleration_limit(vehicle: Vehicle, rail: Rail, speed: float) -> float:
    """Upper bound on the deceleration: full friction on all wheels plus resistance at a speed [m/s2]."""
    friction = 2 * vehicle.wheelsets * rail.mu0 * static_wheel_load(vehicle)
    return float((friction + resistance(vehicle, speed)) / vehicle.mass)
