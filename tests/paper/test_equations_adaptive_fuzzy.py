"""Eqs. (29)-(44) along simulated trajectories of the closed loop: V2 rises, the repaired V does not."""

import numpy as np
import pytest

from tests.lazily import Lazily
from wspd_design.model.adhesion import contact_stiffness
from wspd_design.model.generated.adaptive_fuzzy import (
    lyapunov_printed,
    lyapunov_printed_rate_claimed,
    lyapunov_printed_rate_true,
    lyapunov_repaired,
    lyapunov_repaired_rate,
    membership,
)
from wspd_design.model.generated.adhesion import creep_force_speed_derivative
from wspd_design.parameters.loading import load_rail

adaptive_fuzzy = Lazily("adaptive_fuzzy")
slip_equation = Lazily("slip_equation")

# The setting of the proof: u* = b'w(s) + xi with constant b and |xi| < psi; torque in kN m.
K_P, ALPHA1, ALPHA2, PSI = 18.0, 10.0, 0.85, 1.0
IDEAL = np.array([-8.0, -4.0, 1.0, 5.0, 9.0])
CENTRES, WIDTH = np.linspace(-2.0, 2.0, 5), 0.8
SPEED0, DECELERATION, GAIN_TIMES_SPEED = 33.3, 3.3, 0.83


def basis(s):
    mu = membership(s, CENTRES, WIDTH)
    return mu / mu.sum()


def error_at(t):
    return 0.6 * np.sin(7.0 * t)


def simulate(duration, step, adapted, speed0=SPEED0):
    """Euler simulation of (39), (41), (42); ``adapted(sbar)`` gives (what adapts, what u_r multiplies)."""
    sbar, weights, bound = 0.09, np.array([-1.0, -0.5, 0.0, 0.5, 1.0]), 0.1
    rows = []
    for n in range(round(duration / step)):
        t = n * step
        speed = speed0 - DECELERATION * t
        w, (driver, direction) = basis(K_P * sbar), adapted(sbar)
        error = IDEAL - weights
        rows.append((t, speed, sbar, error @ error, PSI - bound, direction))
        sbar += step * GAIN_TIMES_SPEED / speed * (error @ w + error_at(t) - bound * direction)
        weights = weights + step * ALPHA1 * driver * w
        bound += step * ALPHA2 * abs(driver)
    return np.array(rows).T


def printed_law(sbar):
    return K_P * sbar, np.sign(sbar)


def repaired_law(sbar, layer=0.005):
    saturated = np.clip(sbar / layer, -1.0, 1.0)
    return sbar - layer * saturated, saturated


def test_fuzzy_basis():
    assert membership(0.5, 0.5, 0.8) == 1.0
    assert membership(1.3, 0.5, 0.8) == pytest.approx(np.exp(-1.0))
    assert basis(0.3).sum() == pytest.approx(1.0)
    mu = membership(0.3, CENTRES, WIDTH)
    assert IDEAL @ basis(0.3) == pytest.approx((IDEAL * mu).sum() / mu.sum())
    assert adaptive_fuzzy.partition_residual == adaptive_fuzzy.output_residual == 0


@pytest.mark.parametrize(("name", "at_33", "at_2"), [("polach-dry", -187, -2544), ("polach-wet", -204, -469)])
def test_ideal_control_depends_on_speed(name, at_33, at_2, er24pc):
    """du*/dv at slip 0.14 with the friction and the resistance of the speed, in N m per m/s."""
    rail = load_rail(name)
    law = (rail.mu0, rail.friction_ratio, rail.friction_decay, rail.adhesion_reduction, rail.slip_reduction)
    load = er24pc.mass * 9.81 / 8
    stiffness = contact_stiffness(er24pc.contact, load)

    def slope(speed):
        return float(
            adaptive_fuzzy.ideal_speed_dependence.subs(
                {
                    adaptive_fuzzy.force_slope: creep_force_speed_derivative(
                        0.14, speed, load, *law, stiffness
                    ),
                    adaptive_fuzzy.resistance_slope: er24pc.resistance_linear
                    + 2 * er24pc.resistance_quadratic * speed,
                    slip_equation.inertia: er24pc.wheelset_inertia / 2,
                    slip_equation.R: er24pc.wheel_radius,
                    slip_equation.m: er24pc.mass,
                    slip_equation.slip: 0.14,
                    slip_equation.B_W: 0.25,
                    adaptive_fuzzy.e: 0,
                    adaptive_fuzzy.slip_d_rate: 0,
                }
            )
        )

    assert slope(120 / 3.6) == pytest.approx(at_33, abs=1.5)
    assert slope(2.0) == pytest.approx(at_2, rel=0.01)


def test_ideal_control_is_bounded_on_its_domain():
    assert adaptive_fuzzy.ideal_singular_part == 0


def test_saturation_is_a_relay():
    assert float(adaptive_fuzzy.layer_in_slip) == pytest.approx(5.6e-4, rel=0.01)
    for s in (-0.5, 0.5):  # either side of the surface
        inside = adaptive_fuzzy.layer_excess.subs({adaptive_fuzzy.s: s, adaptive_fuzzy.psi_hat: 1})
        assert inside.subs(adaptive_fuzzy.G, 1) == pytest.approx(0.25)  # G psi_hat |s| (1 - |s|)
    assert adaptive_fuzzy.layer_excess_at_edge == 0


def test_error_dynamics():
    assert adaptive_fuzzy.error_dynamics_residual == 0
    assert adaptive_fuzzy.error_dynamics_residual_printed != 0
    # Without T_brake = u the error moves by G (u - T) more.
    gap = adaptive_fuzzy.torque_residual
    assert gap == adaptive_fuzzy.G * (adaptive_fuzzy.u - adaptive_fuzzy.torque)


def test_printed_adaptation_is_zero():
    assert adaptive_fuzzy.adaptation_printed == 0
    assert adaptive_fuzzy.adaptation_residual != 0


def test_bound_estimate_never_falls():
    _, _, _, _, bound_error, _ = simulate(1.0, 1e-3, printed_law)
    assert (np.diff(bound_error) <= 0).all()
    assert adaptive_fuzzy.bound_rate_residual == 0  # sgn(G) = 1 by (19)
    assert adaptive_fuzzy.sign_of_gain == 1


def test_true_rate_of_v2_along_a_trajectory():
    t, speed, sbar, b_squared, bound_error, _ = simulate(0.02, 1e-6, printed_law, speed0=5.0)
    assert (sbar > 0).all()  # before the surface, where sgn(s) would switch
    s, gain = K_P * sbar, GAIN_TIMES_SPEED / speed
    v2 = lyapunov_printed(s, gain, b_squared, bound_error, K_P, ALPHA1, ALPHA2)
    by_difference = np.gradient(v2, t)[1:-1]
    claimed = lyapunov_printed_rate_claimed(s, gain, error_at(t), PSI)[1:-1]
    gain_rate = gain * DECELERATION / speed
    true = lyapunov_printed_rate_true(
        s, gain, gain_rate, error_at(t), PSI, b_squared, bound_error, ALPHA1, ALPHA2
    )[1:-1]
    assert true == pytest.approx(by_difference, rel=1e-4, abs=1e-4)
    assert (np.abs(claimed - by_difference) > 0.3).all()
    assert adaptive_fuzzy.omitted_residual == adaptive_fuzzy.frozen_gain_residual == 0
    assert adaptive_fuzzy.omitted != 0
    assert adaptive_fuzzy.gain_growth == adaptive_fuzzy.a / adaptive_fuzzy.v  # G' / G > 0 while braking
    assert adaptive_fuzzy.last_line_residual != 0


def test_printed_v2_rises_and_repaired_v_falls():
    duration = (SPEED0 - 0.3) / DECELERATION
    _, speed, sbar, b_squared, bound_error, _ = simulate(duration, 2e-4, printed_law)
    v2 = lyapunov_printed(K_P * sbar, GAIN_TIMES_SPEED / speed, b_squared, bound_error, K_P, ALPHA1, ALPHA2)
    assert v2[-1] > 10.0 * v2[0]
    assert abs(sbar[-1]) < 0.1 * abs(sbar[0])  # while the slip error converges all the same

    t, speed, sbar, b_squared, bound_error, saturated = simulate(duration, 2e-4, repaired_law)
    dead_zone = sbar - 0.005 * saturated
    v = lyapunov_repaired(dead_zone, speed, GAIN_TIMES_SPEED, b_squared, bound_error, ALPHA1, ALPHA2)
    assert np.diff(v).max() < 1e-6 * v[0]
    rate = lyapunov_repaired_rate(dead_zone, DECELERATION, GAIN_TIMES_SPEED, error_at(t), PSI)
    assert (rate <= 0).all()
    assert rate[1:-1] == pytest.approx(np.gradient(v, t)[1:-1], abs=2e-3)
    assert adaptive_fuzzy.repaired_rate_residual == 0
    assert adaptive_fuzzy.repaired_scale_residual == 0  # V is V2/(G K_P)


def test_energy_with_held_adaptation_needs_the_ideal_torque_inside_the_limits():
    """u* = 65 kN m, T_max = 60 kN m, s_D = .05: V' = +245 N m."""
    g, deceleration, dead_zone = 0.55 / (2 * 331), 3.0, 0.05
    rate = dead_zone * (65e3 - 60e3) - deceleration * dead_zone**2 / (2 * g)
    assert rate == pytest.approx(245.0, abs=1.0)
    assert float(adaptive_fuzzy.held_counterexample) == pytest.approx(rate)
    # Inside by eta it falls, at either limit.
    assert adaptive_fuzzy.held_full_residual == adaptive_fuzzy.held_empty_residual == 0


def test_wrong_lyapunov_function_is_caught():
    # The repaired V multiplied by the gain again: the dead zone alone does not repair V2.
    _, speed, sbar, b_squared, bound_error, saturated = simulate(9.0, 1e-3, repaired_law)
    planted = (
        GAIN_TIMES_SPEED
        / speed
        * lyapunov_repaired(
            sbar - 0.005 * saturated, speed, GAIN_TIMES_SPEED, b_squared, bound_error, ALPHA1, ALPHA2
        )
    )
    assert np.diff(planted).max() > 1e-6 * planted[0]
