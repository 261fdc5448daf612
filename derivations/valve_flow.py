"""Build-up by a ramp, leak in hold, and an orifice as valve: closed forms beside those of eqs. (8)-(11).

An orifice passes what ISO 6358 says: with r the absolute pressure behind it over that before it, the flow is choked up
to r = b and falls as an ellipse from there to r = 1, phi = sqrt(1 - ((r - b)/(1 - b))^2). Air and cylinder keep their
temperature, the volume of the cylinder does not change. With r = b + (1 - b) cos(2 chi) the flow is phi = sin(2 chi),
and both directions have closed forms: filling, the angle falls evenly in time; venting, y = tan(chi) obeys a Riccati
equation with constant coefficients, whose solution is a tangent for b > 1/2, a hyperbolic tangent for b < 1/2 and a
straight line for b = 1/2.

Claims: each closed form solves its equation, begins where it should, and meets the choked flow with the same slope.
"""

import sympy as sp

from derivations.notation import Generated, symbols

t, t0, P0, P_in, P = symbols("time start_time start_pressure supply_pressure pressure")
T_F, T_V, elapsed = symbols("fill_time vent_time elapsed")
t_r, k, t_V, t_H, leak = symbols("ramp_start ramp_rate vented_for held_for hold_leak")
b, r, y, chi, tau = symbols("critical_ratio pressure_ratio tangent half_angle flow_time")
xi, Y, kappa = symbols("progress advance root")

# --- filling through the lag (9) from a supply that rises evenly ----------------------------------------------
ramp = k * (t - t_r)
ramp_filled = ramp - k * T_F + (P0 - k * (t0 - t_r) + k * T_F) * sp.exp((t0 - t) / T_F)
ramp_residual = sp.simplify(sp.diff(ramp_filled, t) - (ramp - ramp_filled) / T_F)
ramp_start_residual = sp.simplify(ramp_filled.subs(t, t0) - P0)

# --- filling from a constant supply, (10) as printed -----------------------------------------------------------
approached = P_in + (P0 - P_in) * sp.exp(-elapsed / T_F)
approached_residual = sp.simplify(sp.diff(approached, elapsed) - (P_in - approached) / T_F)

# --- venting through the lag, then holding with a leak ---------------------------------------------------------
released = P0 * sp.exp(-t_V / T_V - leak * t_H)
released_residual = sp.simplify(sp.diff(released, t_V) + released / T_V)
leak_residual = sp.simplify(sp.diff(released, t_H) + leak * released)

# --- orifice: the ellipse as an angle --------------------------------------------------------------------------
flow = sp.sqrt(1 - ((r - b) / (1 - b)) ** 2)  # phi above the critical ratio
ratio_of_angle = b + (1 - b) * sp.cos(2 * chi)
filled_ratio = 1 - 2 * (1 - b) * sp.sin(chi) ** 2
angle_residual = sp.simplify(sp.expand_trig(ratio_of_angle - filled_ratio))
ellipse_residual = sp.simplify(flow.subs(r, ratio_of_angle) ** 2 - sp.sin(2 * chi) ** 2)
tangent_squared = (1 - r) / (r + 1 - 2 * b)
ratio_of_tangent = (1 + (2 * b - 1) * y**2) / (1 + y**2)
tangent_residual = sp.simplify(tangent_squared.subs(r, ratio_of_tangent) - y**2)
ratio_residual = sp.simplify(sp.expand_trig(filled_ratio - ratio_of_tangent.subs(y, sp.tan(chi))))
flow_of_tangent = 2 * y / (1 + y**2)  # sin(2 chi)
flow_residual = sp.simplify(flow.subs(r, ratio_of_tangent) ** 2 - flow_of_tangent**2)

# --- filling: r' = phi(r)/tau; chi' = -1/(2 (1 - b) tau) -------------------------------------------------------
_angle_rate = -1 / (2 * (1 - b) * tau)
filling_residual = sp.simplify(
    sp.expand_trig(sp.diff(filled_ratio, chi) * _angle_rate - sp.sin(2 * chi) / tau)
)

# --- venting: p' = -p phi(p_a/p)/tau, r = p_a/p, so that r' = r phi(r)/tau ---------------------------------------
_time = sp.Symbol("s", real=True)
_y = sp.Function("y", positive=True)(_time)
_tangent_rate = -(1 + (2 * b - 1) * _y**2) / (2 * (1 - b) * tau)
_ratio = ratio_of_tangent.subs(y, _y)
venting_residual = sp.simplify(
    sp.diff(_ratio, _time).subs(sp.Derivative(_y, _time), _tangent_rate)
    - _ratio * flow_of_tangent.subs(y, _y) / tau
)
vented_ratio = (1 + y**2) / (1 + (2 * b - 1) * y**2)  # p/p_a
vented_residual = sp.simplify(vented_ratio * ratio_of_tangent - 1)

# --- y' = -(1 + (2 b - 1) y^2) over xi = elapsed/(2 (1 - b) tau), by the solution Y that starts at 0 -------------
falling = (y - Y) / (1 + (2 * b - 1) * y * Y)
_Y = sp.Function("Y", positive=True)(xi)
_falling = falling.subs(Y, _Y)
falling_residual = sp.simplify(
    sp.diff(_falling, xi).subs(sp.Derivative(_Y, xi), 1 + (2 * b - 1) * _Y**2) + 1 + (2 * b - 1) * _falling**2
)
above = sp.tan(kappa * xi) / kappa  # kappa^2 = 2 b - 1
_fading = sp.exp(-2 * kappa * xi)
below = (1 - _fading) / (kappa * (1 + _fading))  # tanh(kappa xi)/kappa, kappa^2 = 1 - 2 b
near = xi + (2 * b - 1) * xi**3 / 3
above_residual = sp.simplify(sp.diff(above, xi) - 1 - kappa**2 * above**2)
below_residual = sp.simplify(sp.diff(below, xi) - 1 + kappa**2 * below**2)
near_residual = sp.simplify(sp.series(above, xi, 0, 5).removeO() - near.subs(b, (1 + kappa**2) / 2))
half_residual = sp.simplify((sp.diff(near, xi) - 1).subs(b, sp.Rational(1, 2)))

# --- choked: r' = 1/tau while filling, p' = -p/tau while venting; both up to r = b ------------------------------
choked_vent_time = tau * sp.log(b / r)  # from p_a/p = r to p_a/p = b
choked_residual = sp.simplify((r * sp.exp(choked_vent_time / tau)) - b)
meeting_residual = sp.simplify(flow_of_tangent.subs(y, 1) - 1)  # y = 1 at r = b, where the flow is still full
meeting_ratio_residual = sp.simplify(ratio_of_tangent.subs(y, 1) - b)

# --- where a cylinder that follows the demand leaves it: flow = slope, A cos + B sin = C on the ellipse -----------
_A, _B, _C = sp.symbols("A B C", positive=True)
_sine = (_B * _C + _A * sp.sqrt(_A**2 + _B**2 - _C**2)) / (_A**2 + _B**2)
_cosine = (_A * _C - _B * sp.sqrt(_A**2 + _B**2 - _C**2)) / (_A**2 + _B**2)
leaving_residual = sp.simplify(_A * _cosine + _B * _sine - _C)
circle_residual = sp.simplify(_sine**2 + _cosine**2 - 1)

FUNCTIONS = (
    Generated(
        name="ramp_filled_pressure",
        arguments=(t, t0, P0, t_r, k, T_F),
        value=ramp_filled,
        summary="Cylinder pressure while filling from a supply that rises evenly",
        returns="Cylinder pressure [Pa]",
        equation="solution of eq. (9)",
    ),
    Generated(
        name="approached_pressure",
        arguments=(elapsed, P0, P_in, T_F),
        value=approached,
        summary="Cylinder pressure while filling from a constant supply",
        returns="Cylinder pressure [Pa]",
        equation="10",
        meanings={"elapsed": "Time since the filling started [s]"},
    ),
    Generated(
        name="released_pressure",
        arguments=(t_V, t_H, P0, T_V, leak),
        value=released,
        summary="Cylinder pressure after venting and then holding with a leak",
        returns="Cylinder pressure [Pa]",
        equation="solution of eq. (9)",
    ),
    Generated(
        name="tangent_squared",
        arguments=(r, b),
        value=tangent_squared,
        summary="Square of the tangent of half the angle of the flow ellipse",
        returns="1 at the critical ratio, 0 at equal pressures [-]",
        equation="ISO 6358",
    ),
    Generated(
        name="filled_ratio",
        arguments=(chi, b),
        value=filled_ratio,
        summary="Pressure ratio at half the angle of the flow ellipse, which falls evenly while an orifice fills",
        returns="Absolute pressure of the cylinder over that of the supply [-]",
        equation="ISO 6358",
    ),
    Generated(
        name="vented_ratio",
        arguments=(y, b),
        value=vented_ratio,
        summary="Pressure of a cylinder that an orifice vents, over that of the atmosphere",
        returns="Absolute pressures, the inverse of the ratio of ISO 6358 [-]",
        equation="ISO 6358",
    ),
    Generated(
        name="choked_vent_time",
        arguments=(r, b, tau),
        value=choked_vent_time,
        summary="Time until the flow of a venting orifice is no longer choked",
        returns="Negative where it is not [s]",
        equation="ISO 6358",
    ),
    Generated(
        name="falling_tangent",
        arguments=(y, Y, b),
        value=falling,
        summary="Tangent of half the angle of the flow ellipse while an orifice vents",
        returns="Below 0 once the cylinder is empty [-]",
        equation="ISO 6358",
    ),
    Generated(
        name="advance_above_half",
        arguments=(xi, kappa),
        value=above,
        summary="Advance of the tangent for a critical ratio above 1/2",
        returns="Advance [-]",
        equation="ISO 6358",
    ),
    Generated(
        name="advance_below_half",
        arguments=(xi, kappa),
        value=below,
        summary="Advance of the tangent for a critical ratio below 1/2",
        returns="Advance [-]",
        equation="ISO 6358",
    ),
    Generated(
        name="advance_near_half",
        arguments=(xi, b),
        value=near,
        summary="Advance of the tangent for a critical ratio of nearly 1/2, by its series",
        returns="Advance [-]",
        equation="ISO 6358",
    ),
)
