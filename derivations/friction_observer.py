"""Observer of the friction torque: wheel speed and friction from sampled wheel speeds and the mean braking torque.

The wheelset turns with J w' = tau_r - T. Over a sample the observer expects w_e = w^ + (h/J)(tau^ - T_m), compares it
with the measured speed, r = w - w_e, and corrects w^+ = w_e + (1 - theta^2) r, tau^+ = tau^ + (1 - theta)^2 (J/h) r.

Claims: for a constant friction torque the errors of speed and torque decay with the double pole theta; an error of the
torque T_m or of the inertia J that is constant leaves no error of the speed, so that what is observed is the torque
which explains the motion; a friction torque that drifts evenly is followed at a constant distance.
"""

import sympy as sp

from derivations.notation import Generated, symbols

omega, w, tau, T_m, J, h, theta = symbols(
    "wheel_speed observed_speed observed_friction mean_torque wheelset_inertia sample_time observer_pole"
)

expected = w + h / J * (tau - T_m)
innovation = omega - expected
corrected_speed = expected + (1 - theta**2) * innovation
corrected_friction = tau + (1 - theta) ** 2 * J / h * innovation

# --- errors: p = w^ - w, n = tau^ - tau_r; the wheel turns on by (h/J)(tau_r - T_m) -----------------------------
p, n, tau_r, before, mismatch, z = sp.symbols("p n tau_r omega_0 T_d z", real=True)
_turned = {omega: before + h / J * (tau_r - T_m + mismatch), w: before + p, tau: tau_r + n}
_next_p = sp.expand((corrected_speed - omega).subs(_turned))
_next_n = sp.expand((corrected_friction - tau_r).subs(_turned))
errors = sp.Matrix([[sp.diff(_next_p, p), sp.diff(_next_p, n)], [sp.diff(_next_n, p), sp.diff(_next_n, n)]])
poles_residual = sp.simplify((z * sp.eye(2) - errors).det() - (z - theta) ** 2)

# --- a constant mismatch of the torque that was applied: T_m of the observer is that of the wheel plus T_d --------
_rest = {p: 0, n: mismatch}
offset_residual = sp.simplify(_next_p.subs(_rest)) ** 2 + sp.simplify(_next_n.subs(_rest) - mismatch) ** 2

# --- an even drift of the friction torque, by delta in a sample -----------------------------------------------------
drift = sp.Symbol("delta", real=True)
_lag = sp.Matrix([-h / J * theta**2 / (1 - theta) ** 2 * drift, -(1 + theta) / (1 - theta) * drift])
_kept = (errors * _lag - sp.Matrix([0, drift])).subs(mismatch, 0) - _lag
drift_residual = sp.simplify(sum(entry**2 for entry in _kept))

FUNCTIONS = (
    Generated(
        name="observed",
        arguments=(omega, w, tau, T_m, h, J, theta),
        value=(corrected_speed, corrected_friction),
        summary="Wheel speed and friction torque after a measurement",
        returns="As observed: wheel speed in rad/s, friction torque in N m",
        equation="observer of eq. (2)",
    ),
)
