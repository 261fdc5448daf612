"""Motion, eqs. (1), (2), (4): Newton's laws of the train and of one wheel, and the damping B_W.

Claims: (1) and (2) exchange momentum and power as they must (the creep force is internal), (2) has no
stiction at omega = 0, the printed damping 0.25^(-0.01 t) grows where a decaying one is meant.
"""

import sympy as sp

from derivations.notation import Generated, symbols

f, f_d, m, v = symbols("creep_force resistance mass speed")
omega, T, inertia, R, B_W = symbols("wheel_speed braking_torque wheel_inertia wheel_radius wheel_damping")
a0, a1, a2, f_r, f_c, f_t = symbols("constant linear quadratic grade_force curve_force tunnel_force")
t, initial, decay = symbols("time initial decay")

# --- (1), (2), (4) ----------------------------------------------------------------------------------------
train_acceleration = -(f_d + 8 * f) / m
wheel_acceleration = (R * f - T / 2 - B_W * omega) / inertia
running_resistance = a0 + a1 * v + a2 * v**2 + f_r + f_c + f_t

# Momentum: in R times (1) plus 8 times (2) the creep force cancels; what is left are the external torques.
momentum_rate = R * m * train_acceleration + 8 * inertia * wheel_acceleration
external_torque = -R * f_d - 4 * T - 8 * B_W * omega
momentum_residual = sp.expand(momentum_rate - external_torque)

# Power: kinetic energy goes into resistance, brakes, damping and creepage, each a product of force and speed.
power = m * v * train_acceleration + 8 * inertia * omega * wheel_acceleration
dissipated = f_d * v + 4 * T * omega + 8 * B_W * omega**2 + 8 * f * (v - R * omega)
power_residual = sp.expand(power + dissipated)

# (2) is smooth at omega = 0: nothing in it keeps a locked wheel locked while T / 2 > R f.
wheel_acceleration_at_lock = sp.simplify(wheel_acceleration.subs(omega, 0))

# (4) may be negative downhill, where the Lyapunov arguments need f_d + 8 f >= 0.
resistance_downhill = running_resistance.subs({v: 0, a0: 0, f_c: 0, f_t: 0})

# --- B_W: printed and read --------------------------------------------------------------------------------
damping_printed = sp.Rational(1, 4) ** (-t / 100)
damping_corrected = sp.exp(-t / 100) / 4
damping = initial * sp.exp(-decay * t)
damping_printed_growth = sp.simplify(sp.diff(damping_printed, t) / damping_printed)
damping_corrected_growth = sp.simplify(sp.diff(damping_corrected, t) / damping_corrected)

FUNCTIONS = (
    Generated(
        name="running_resistance",
        arguments=(v, a0, a1, a2, f_r, f_c, f_t),
        value=running_resistance,
        summary="Running resistance of the train",
        returns="Running resistance, positive against the motion [N]",
        equation="4",
        notes="Negative on a steep downhill gradient.",
    ),
    Generated(
        name="train_acceleration",
        arguments=(f, f_d, m),
        value=train_acceleration,
        summary="Acceleration of the train under eight equal creep forces",
        returns="Acceleration, negative while braking [m/s2]",
        equation="1",
    ),
    Generated(
        name="wheel_damping",
        arguments=(t, initial, decay),
        value=damping,
        summary="Damping of one wheel, falling while the brake warms up",
        returns="Damping torque per wheel speed [N m s]",
        equation="B_W",
    ),
    Generated(
        name="wheel_acceleration",
        arguments=(f, omega, T, inertia, R, B_W),
        value=wheel_acceleration,
        summary="Angular acceleration of a rolling or sliding wheel",
        returns="Angular acceleration [rad/s2]",
        equation="2",
        notes="Without stiction: a locked wheel (omega = 0 and T / 2 > R f) is to be treated by its caller.",
    ),
)
