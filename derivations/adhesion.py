"""Adhesion, eqs. (5)-(7): Polach's creep force follows from Kalker's linear theory and Coulomb saturation.

Claims: (6) is the slope of the linear theory, (5) tends to the friction limit, (7) holds only with the
*magnitude* of the sliding speed. As mu depends on v - R omega, the creep force depends on slip and speed.
"""

import sympy as sp

from derivations.notation import Generated, symbol, symbols

G_s, a, b, c11 = symbols("shear_modulus semi_axis_rolling semi_axis_lateral kalker_c11")
C, Q, mu, w = symbols("contact_stiffness wheel_load friction sliding_speed")
mu0, A, B, kA, kS = symbols("mu0 friction_ratio friction_decay adhesion_reduction slip_reduction")
slip, speed, gradient = symbols("slip speed gradient")

# --- (7): friction falls with sliding speed ---------------------------------------------------------------
friction_printed = mu0 * ((1 - A) * sp.exp(-B * w) + A)
friction_corrected = mu0 * ((1 - A) * sp.exp(-B * sp.Abs(w)) + A)

# Friction must not care about the direction of sliding. The printed form does: this is its residual at -w.
friction_asymmetry = sp.simplify(friction_printed - friction_printed.subs(w, -w))
friction_asymmetry_corrected = sp.simplify(friction_corrected - friction_corrected.subs(w, -w))

# --- (6): gradient of the tangential stress ---------------------------------------------------------------
stiffness = sp.pi * G_s * a * b * c11 / 4
gradient_of_slip = C * slip / (Q * mu)
gradient_printed = sp.Rational(1, 4) * G_s * sp.pi * a * b * c11 / (Q * mu) * slip

# Polach's stress gradient is (2/3) C_t pi a^2 b slip/(Q mu); Kalker's linear force pins C_t = (3/8) G c11/a.
tangential_stiffness = sp.Rational(3, 8) * G_s * c11 / a
gradient_derived = sp.Rational(2, 3) * tangential_stiffness * sp.pi * a**2 * b * slip / (Q * mu)

# --- (5): creep force -------------------------------------------------------------------------------------
shape = kA * gradient / (1 + (kA * gradient) ** 2) + sp.atan(kS * gradient)
force_of_gradient = 2 * Q * mu / sp.pi * shape

# Small slip: the slope is (kA + kS)/2 of Kalker's G a b c11. Large slip: Coulomb's limit.
slope_at_zero = sp.simplify(
    sp.diff(force_of_gradient.subs(gradient, gradient_of_slip), slip).subs(slip, 0).subs(C, stiffness)
)
kalker_slope = G_s * a * b * c11
coulomb_limit = sp.limit(force_of_gradient, gradient, sp.oo)
force_parity = sp.simplify(force_of_gradient + force_of_gradient.subs(gradient, -gradient))  # odd in the slip
force_residual = (
    sp.Abs(coulomb_limit - Q * mu)
    + sp.Abs(sp.simplify(slope_at_zero.subs({kA: 1, kS: 1}) - kalker_slope))
    + sp.Abs(force_parity)
)

# --- exact derivatives along sliding speed = speed * slip -------------------------------------------------
# Written with the parts that occur in the force itself: short, and tight in interval arithmetic.
friction_slope = symbol("friction_slope")  # d mu / d(sliding speed)
shape_value, shape_slope = symbol("shape"), symbol("shape_slope")
friction_slope_of_w = sp.diff(friction_printed, w)
shape_slope_of_gradient = kA * (1 - (kA * gradient) ** 2) / (1 + (kA * gradient) ** 2) ** 2 + kS / (
    1 + (kS * gradient) ** 2
)
falling_part = 2 * Q / sp.pi * friction_slope * (shape_value - gradient * shape_slope)
force_slip_derivative = speed * falling_part + 2 * C / sp.pi * shape_slope
force_speed_derivative = slip * falling_part

_LAW = (Q, mu0, A, B, kA, kS, C)
_FORCE_STEPS = ((mu, friction_printed), (gradient, gradient_of_slip))
_DERIVATIVE_STEPS = (
    (w, speed * slip),
    (mu, friction_printed),
    (friction_slope, friction_slope_of_w),
    (gradient, gradient_of_slip),
    (shape_value, shape),
    (shape_slope, shape_slope_of_gradient),
)
_SLIDING = "The sliding speed is ``speed * slip``; valid for slip >= 0."

FUNCTIONS = (
    Generated(
        name="contact_stiffness",
        arguments=(G_s, a, b, c11),
        value=stiffness,
        summary="Contact stiffness pi G a b c11 / 4 of one wheel",
        returns="Contact stiffness: creep force per slip of the linear theory, times pi / 4 [N]",
        equation="6",
    ),
    Generated(
        name="friction_coefficient",
        arguments=(w, mu0, A, B),
        value=friction_printed,
        summary="Friction coefficient that falls with the sliding speed",
        returns="Friction coefficient [-]",
        equation="7",
        notes="The sliding speed is a magnitude: eq. (7) as printed grows without limit for v < R omega.",
    ),
    Generated(
        name="creep_gradient",
        arguments=(slip, Q, mu, C),
        value=gradient_of_slip,
        summary="Gradient of the tangential stress in the area of adhesion",
        returns="Gradient epsilon [-]",
        equation="6",
    ),
    Generated(
        name="creep_force",
        arguments=(slip, w, *_LAW),
        steps=_FORCE_STEPS,
        value=force_of_gradient,
        summary="Longitudinal creep force of one wheel by Polach's method",
        returns="Creep force, positive when it brakes the train [N]",
        equation="5",
        notes="Pure longitudinal creep. Sliding speed and slip are separate arguments, because the slip\n"
        "ratio may be regularized near standstill.",
    ),
    Generated(
        name="creep_force_slip_derivative",
        arguments=(slip, speed, *_LAW),
        steps=_DERIVATIVE_STEPS,
        value=force_slip_derivative,
        summary="Derivative of the creep force with respect to slip at fixed speed",
        returns="d(creep force)/d(slip) [N]",
        equation="5",
        notes=_SLIDING,
    ),
    Generated(
        name="creep_force_speed_derivative",
        arguments=(slip, speed, *_LAW),
        steps=_DERIVATIVE_STEPS,
        value=force_speed_derivative,
        summary="Derivative of the creep force with respect to train speed at fixed slip",
        returns="d(creep force)/d(speed) [N s/m]",
        equation="5",
        notes=_SLIDING,
    ),
)
