"""Convergence, eqs. (45)-(48): which hypotheses of Barbalat's lemma fail, and where the lemma does hold.

Claims: (45) is false because V2 rises; the stop is finite, so that t -> infinity does not exist; G' is
unbounded, so Gamma need not be uniformly continuous; psi >= |xi| alone allows Gamma = 0 with s != 0; (47)
excludes nothing. inf G > 0 does hold. In sigma = int dt/v, with adaptation rates alpha/v, the horizon is
infinite and V falls without G' terms.
"""

import sympy as sp

from derivations import adaptive_fuzzy, slip_equation
from derivations.notation import symbols, time

s, G, xi, psi, G_rate = symbols("sliding_variable gain approximation_error bound gain_rate")
b_squared, psi_error, alpha1, alpha2 = symbols("weight_error_squared bound_error weight_rate bound_rate")
s_D, v, g, psi_hat = symbols("dead_zone_variable speed gain_times_speed bound_estimate")
v0, a = sp.symbols("v_0 a", positive=True)

# --- (45): Gamma <= -V2' ----------------------------------------------------------------------------------
gamma = sp.Abs(s) * G * (psi - sp.Abs(xi))
# The approximation error that helps least has the sign of s: s xi = |s| |xi|.
excess = sp.simplify(
    (gamma + adaptive_fuzzy.rate_true).subs(s * xi, sp.Abs(s) * sp.Abs(xi)) - adaptive_fuzzy.rate_omitted
)  # zero: Gamma exceeds -V2' by exactly the omitted terms
violation_on_surface = sp.simplify((gamma + adaptive_fuzzy.rate_true).subs(s, 0))  # positive while braking

# --- infinite horizon: with a deceleration of at least a, the train stands at t = v0/a --------------------
stopping_time = sp.solve(v0 - a * time, time)[0]

# --- inf G > 0: not shown in the paper, but true ----------------------------------------------------------
gain_slope_in_speed = sp.diff(slip_equation.slip_gain, slip_equation.v)  # negative: smallest at the start
gain_infimum = slip_equation.slip_gain.subs(slip_equation.v, v0)

# --- uniform continuity: Gamma' contains G' |s| (psi - |xi|) with G' = G a/v ------------------------------
gain_rate = slip_equation.slip_gain * a / slip_equation.v
gain_rate_at_standstill = sp.limit(gain_rate, slip_equation.v, 0, "+")

# --- strictness: (34) allows psi = |xi| -------------------------------------------------------------------
gamma_without_margin = gamma.subs(psi, sp.Abs(xi))

# --- s -> 0 gives e -> 0: e is s/K_P through q/(q + c), whose step response exp(-c t) dies out ----------------
_c = sp.Symbol("c", positive=True)
error_after_step = sp.limit(sp.exp(-_c * time), time, sp.oo)
_step = sp.exp(-_c * time)
filter_residual = sp.simplify(
    sp.diff(_step, time) + _c * _step
)  # e' + c e = s'/K_P, zero after the step of s

# --- (47): "<= infinity" holds even for Gamma = 1, which does not converge to zero ------------------------
integral_of_one = sp.limit(sp.integrate(1, (time, 0, v0)), v0, sp.oo)
vacuous_limit_holds = bool(integral_of_one <= sp.oo)

# --- where the lemma can be used: sigma-time --------------------------------------------------------------
sigma_horizon = sp.limit(
    sp.integrate(1 / v, (v, sp.Symbol("v_end", positive=True), v0)) / a,
    sp.Symbol("v_end", positive=True),
    0,
    "+",
)
lyapunov_sigma = s_D**2 / (2 * g) + b_squared / (2 * alpha1) + psi_error**2 / (2 * alpha2)
_b_w, _sgn = adaptive_fuzzy.b_w, adaptive_fuzzy.sgn
_sigma_loop = {  # d/d sigma = v d/dt, with adaptation rates alpha/v in time
    s_D: g * (_b_w + xi - psi_hat * _sgn),
    b_squared: -2 * alpha1 * s_D * _b_w,
    psi_error: -alpha2 * s_D * _sgn,
}
sigma_rate_derived = sp.expand(
    sum(sp.diff(lyapunov_sigma, x) * rate for x, rate in _sigma_loop.items())
    .subs(psi_hat, psi - psi_error)
    .expand()
    .subs(s_D * _sgn, sp.Abs(s_D))
)
sigma_rate = s_D * xi - psi * sp.Abs(s_D)
sigma_rate_residual = sp.simplify(sigma_rate_derived - sigma_rate)
