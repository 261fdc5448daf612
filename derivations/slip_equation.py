"""Slip dynamics, eqs. (3), (19), (20): lambda' = F + G T follows from (1)-(3), with G = R/(2 I v) > 0.

Claims: (19) is correct as printed, affine in the torque, with an exact slope dF/d(lambda) at fixed speed;
the uncertainty of (20) contains Delta G T, which grows as 1/v: no constant bound W exists down to
standstill.
"""

import sympy as sp

from derivations import motion
from derivations.notation import Generated, symbols, time

v, omega, R, inertia, m = symbols("speed wheel_speed wheel_radius wheel_inertia mass")
f, f_d, T, B_W = symbols("creep_force resistance braking_torque wheel_damping")
slip, f_slope, v_r = symbols("slip creep_force_slip_derivative reference_speed")

# --- (3) --------------------------------------------------------------------------------------------------
slip_of_speeds = (v - R * omega) / v
slip_referred = (v - R * omega) / v_r
wheel_speed_of_slip = (1 - slip) * v / R
round_trip_residual = sp.simplify(slip_of_speeds.subs(omega, wheel_speed_of_slip) - slip)
turning = sp.Symbol("omega", positive=True)
slip_at_standstill = sp.limit(slip_of_speeds.subs(omega, turning), v, 0, "+")  # minus infinity: singular
# Along R omega = k v the slip is 1 - k down to v = omega = 0: it has no limit there, and (1), (2) no right side.
_ratio = sp.Symbol("k", positive=True)
slip_along_ray = sp.simplify(slip_of_speeds.subs(omega, _ratio * v / R))
slip_speed_slope = sp.diff(slip_of_speeds, v)  # unbounded: not Lipschitz near v = 0

# --- (19): differentiate (3) in time and insert (1), (2) --------------------------------------------------
v_t, omega_t = sp.Function("v", positive=True)(time), sp.Function("omega", real=True)(time)
slip_rate_derived = (
    sp.diff(slip_of_speeds.subs({v: v_t, omega: omega_t}, simultaneous=True), time)
    .subs({sp.diff(v_t, time): motion.train_acceleration, sp.diff(omega_t, time): motion.wheel_acceleration})
    .subs({v_t: v, omega_t: omega})
)
slip_rate_printed = -R / v * ((-T / 2 - B_W * omega + R * f) / inertia) + R * omega / v**2 * (
    (-f_d - 8 * f) / m
)
slip_rate_residual = sp.simplify(slip_rate_printed - slip_rate_derived)

# --- separation into drift and gain -----------------------------------------------------------------------
slip_gain = sp.simplify(sp.diff(slip_rate_derived, T))
slip_rate_is_affine = sp.simplify(sp.diff(slip_rate_derived, T, 2)) == 0
drift_derived = sp.expand(slip_rate_derived.subs(T, 0).subs(omega, wheel_speed_of_slip))
drift = -((R**2 * f / inertia + (1 - slip) * (f_d + 8 * f) / m) / v) + B_W * (1 - slip) / inertia
drift_residual = sp.simplify(drift_derived - drift)

# F(slip, t) hides v: (19) is scalar only along a given v(t).
drift_speed_slope = sp.simplify(sp.diff(drift, v))  # even at fixed f and f_d

# --- slope at fixed speed: f depends on slip, f_d on speed only -------------------------------------------
force_of_slip = sp.Function("f", real=True)(slip)
drift_slope_derived = sp.diff(drift.subs(f, force_of_slip), slip).subs(
    {sp.diff(force_of_slip, slip): f_slope, force_of_slip: f}
)
drift_slope = (
    -((R**2 * f_slope / inertia + ((1 - slip) * 8 * f_slope - (f_d + 8 * f)) / m) / v) - B_W / inertia
)
drift_slope_residual = sp.simplify(drift_slope_derived - drift_slope)

# --- (20): the true inertia is I / rho --------------------------------------------------------------------
inertia_ratio = sp.Symbol("rho", positive=True)  # assumed / true inertia
gain_uncertainty = sp.simplify(slip_gain.subs(inertia, inertia / inertia_ratio) - slip_gain)
uncertainty_at_standstill = sp.limit(sp.Abs((gain_uncertainty * T).subs({inertia_ratio: 2, T: 1})), v, 0, "+")
uncertainty_times_speed = sp.simplify(gain_uncertainty * T * v)  # bounded: W = W0 / v is possible
# With T = u = u_eq + W/G, delta contains W: W >= |Delta F| + q (G |u_eq| + W), q = |Delta G|/G, asks for q < 1.
_share, _apart, W = sp.symbols("q D W", positive=True)  # D = |Delta F| + q G |u_eq|
smallest_bound = sp.solve(sp.Eq(W, _apart + _share * W), W)[0]
circular_residual = sp.simplify(smallest_bound - _apart)  # what the bound grows by, without end as q -> 1
circular_limit = sp.limit(smallest_bound.subs(_apart, 1), _share, 1, "-")

FUNCTIONS = (
    Generated(
        name="slip_ratio",
        arguments=(v, omega, R, v_r),
        value=slip_referred,
        summary="Longitudinal slip ratio",
        returns="Slip ratio, positive when braking [-]",
        equation="3",
        notes="Eq. (3) has the train speed as reference speed and is singular at standstill.",
    ),
    Generated(
        name="wheel_speed_at_slip",
        arguments=(slip, v, R),
        value=wheel_speed_of_slip,
        summary="Angular speed of a wheel that runs at a given slip",
        returns="Angular speed [rad/s]",
        equation="3",
    ),
    Generated(
        name="slip_drift",
        arguments=(slip, v, f, f_d, m, inertia, R, B_W),
        value=drift,
        summary="Drift F of the slip: its rate of change without braking torque",
        returns="Drift F [1/s]",
        equation="19",
    ),
    Generated(
        name="slip_gain",
        arguments=(v, inertia, R),
        value=slip_gain,
        summary="Input gain G of the slip: rate of change of slip per braking torque",
        returns="Input gain G, always positive [1/(N m s)]",
        equation="19",
    ),
    Generated(
        name="slip_drift_slip_derivative",
        arguments=(slip, v, f, f_slope, f_d, m, inertia, R, B_W),
        value=drift_slope,
        summary="Derivative of the drift F with respect to slip at fixed speed: the open-loop slip pole",
        returns="dF/d(slip) [1/s]",
        equation="19",
    ),
)
