"""Eqs. (3), (19), (20) against the integrated laws of motion, and with wrong signs planted."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from derivations.claim import verdicts
from tests.lazily import Lazily
from wspd_design.model.generated import adhesion, motion, slip

slip_equation, sliding = Lazily("slip_equation"), Lazily("claims.sliding")

M, R, INERTIA, B = 76841.0, 0.55, 331.0, 1.0
LAW = (94226.0, 0.55, 0.4, 0.6, 1.0, 0.4, 1.1e7)


def resistance(v):
    return motion.running_resistance(v, 2000.0, 20.0, 3.0, 0.0, 0.0, 0.0)


def force(ratio, v):
    return adhesion.creep_force(ratio, v * ratio, *LAW)


def drift(ratio, v):
    return slip.slip_drift(ratio, v, force(ratio, v), resistance(v), M, INERTIA, R, B)


def test_slip_ratio():
    assert slip.slip_ratio(20.0, 32.0, R, 20.0) == pytest.approx(0.12)
    assert slip.wheel_speed_at_slip(0.12, 20.0, R) == pytest.approx(32.0)
    assert slip_equation.slip_at_standstill == -sp.oo


def test_slip_has_no_limit_at_standstill():
    """Down to v = omega = 0 along two rays: two limits, so that (1) to (3) have no right side there."""
    for share, limit in ((0.5, 0.5), (0.9, 0.1)):
        along_ray = [slip.slip_ratio(v, share * v / R, R, v) for v in (1.0, 1e-3, 1e-6)]
        assert along_ray == pytest.approx([limit] * 3)
    assert not slip_equation.slip_along_ray.has(slip_equation.v)
    steepness = slip_equation.slip_speed_slope.subs({slip_equation.omega: 1, slip_equation.R: R})
    assert sp.limit(steepness, slip_equation.v, 0, "+") == sp.oo  # not Lipschitz


def test_drift_hides_the_speed():
    assert drift(0.14, 20.0) != pytest.approx(drift(0.14, 10.0), rel=0.1)
    assert slip_equation.drift_speed_slope != 0


def test_slip_dynamics_follow_from_the_laws_of_motion():
    torque = 2.2e4

    def rates(_, state):
        v, omega = state
        f = force((v - R * omega) / v, v)
        return (
            motion.train_acceleration(f, resistance(v), M),
            motion.wheel_acceleration(f, omega, torque, INERTIA, R, B),
        )

    start, step = (20.0, slip.wheel_speed_at_slip(0.2, 20.0, R)), 1e-3
    run = solve_ivp(
        rates, (0.0, 2 * step), start, method="Radau", rtol=1e-12, atol=1e-12, t_eval=[0, step, 2 * step]
    )
    v, ratio = run.y[0], (run.y[0] - R * run.y[1]) / run.y[0]
    by_difference = (ratio[2] - ratio[0]) / (2 * step)
    by_equation = drift(ratio[1], v[1]) + slip.slip_gain(v[1], INERTIA, R) * torque
    assert by_equation == pytest.approx(by_difference, rel=1e-5)


@pytest.mark.parametrize(("ratio", "v"), [(0.03, 30.0), (0.14, 20.0), (0.14, 5.0), (0.4, 2.0)])
def test_drift_slope_equals_finite_difference(ratio, v):
    step = 1e-4 * ratio
    slope = adhesion.creep_force_slip_derivative(ratio, v, *LAW)
    exact = slip.slip_drift_slip_derivative(ratio, v, force(ratio, v), slope, resistance(v), M, INERTIA, R, B)
    assert exact == pytest.approx((drift(ratio + step, v) - drift(ratio - step, v)) / (2 * step), rel=1e-5)


def test_drift_slope_is_the_derivative_of_the_drift():
    assert slip_equation.drift_slope_residual == 0


def test_wrong_sign_in_eq_19_is_caught():
    claim = next(c for c in sliding.CLAIMS if c.number == "19")
    assert verdicts(claim) == ("holds",)
    printed = slip_equation.slip_rate_printed
    for term in sp.Add.make_args(sp.expand(printed)):
        planted = sp.expand(printed) - 2 * term
        residual = sp.simplify(planted - slip_equation.slip_rate_derived)
        assert residual != 0
        assert verdicts(replace(claim, residual=residual)) == ("misprint",)
    with pytest.raises(ValueError, match="corrected form leaves"):
        verdicts(replace(claim, corrected_residual=slip_equation.drift_derived + slip_equation.drift))


def test_gain_is_positive_and_input_affine():
    assert slip_equation.slip_rate_is_affine
    assert slip_equation.slip_gain.is_positive
    # Published slip gain of the calibrated vehicle: 73.1 per MN m s at 10 m/s (752 kg m2 per wheelset).
    assert slip.slip_gain(10.0, 376.0, R) * 1e6 == pytest.approx(73.1, abs=0.05)


def test_uncertainty_contains_the_gain():
    speeds = np.array([10.0, 1.0, 0.1])
    uncertainty = (slip.slip_gain(speeds, 1.2 * INERTIA, R) - slip.slip_gain(speeds, INERTIA, R)) * 6e4
    assert np.abs(uncertainty[1:] / uncertainty[:-1]) == pytest.approx(10.0)
    assert np.ptp(uncertainty * speeds) < 1e-12
    assert slip_equation.uncertainty_at_standstill == sp.oo


def test_bound_of_the_uncertainty_is_circular():
    """T = u_eq + W/G puts W into delta: the bound grows without end as the gain becomes uncertain by 100 %."""
    apart, share = 0.3, 0.2
    bound = apart
    for _ in range(200):
        bound = apart + share * bound
    q, d = sorted(slip_equation.smallest_bound.free_symbols, key=str, reverse=True)
    assert float(slip_equation.smallest_bound.subs({q: share, d: apart})) == pytest.approx(bound)
    assert slip_equation.circular_limit == sp.oo
