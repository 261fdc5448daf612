"""Electro-pneumatic brake, eqs. (8)-(15): a first-order lag under conditions that the paper leaves out.

Claims: (10) solves (9) for a constant supply only, the exact filling law with (8) has a second exponential;
(13) drops a product-rule term; the right side of (14) is a misprint and needs full supply pressure and T_F
= T_V; (15) is exact for the average over a period, about which the torque ripples by T_max tanh(h/(4 tau))
peak to peak at half duty.
"""

import sympy as sp

from derivations.notation import Generated, symbols, time

t, t0, elapsed, P, P_in = symbols("time start_time elapsed pressure supply_pressure")
P_max, P0, rate, T_F, T_V = symbols("max_pressure start_pressure supply_rate fill_time vent_time")
fill, vent, T, T_max, u, tau, h = symbols("fill vent torque max_torque command time_constant period")

# --- (8): build-up of the supply --------------------------------------------------------------------------
supply = P_max * (1 - sp.exp(-rate * t))
supply_residual = sp.simplify(sp.diff(supply, t) - rate * (P_max - supply))  # a first-order lag

# --- (9) and Table 2 --------------------------------------------------------------------------------------
pressure_rate = fill * (P_in - P) / T_F - vent * P / T_V
u_EV, u_BV = sp.symbols("u_EV u_BV", real=True)
pressure_rate_printed = u_EV * (-P / T_V) + (1 - u_BV) * ((P_in - P) / T_F)
pressure_rate_residual = sp.simplify(pressure_rate_printed - pressure_rate.subs({fill: 1 - u_BV, vent: u_EV}))
pressure_rate_on_hold = pressure_rate_printed.subs({u_EV: 0, u_BV: 1})
pressure_rate_on_reduction = pressure_rate_printed.subs({u_EV: 1, u_BV: 1})
pressure_rate_on_increase = pressure_rate_printed.subs({u_EV: 0, u_BV: 0})

# --- (10): filling ----------------------------------------------------------------------------------------
filled_printed = P0 + (P_in - P0) * (1 - sp.exp(-(t - t0) / T_F))


def filling_residual(law: sp.Expr) -> sp.Expr:
    """Residual of a filling law in (9) with the supply (8) [Pa/s]: zero for a solution."""
    return sp.simplify(sp.diff(law, t) - (supply - law) / T_F)


fading = sp.exp(-(t - t0) / T_F)
filled = (
    P_max
    + (P0 - P_max) * fading
    - P_max / (1 - rate * T_F) * (sp.exp(-rate * t) - sp.exp(-rate * t0) * fading)
)
filled_residual_printed = filling_residual(filled_printed.subs(P_in, supply))
filled_residual_constant_supply = sp.simplify(sp.diff(filled_printed, t) - (P_in - filled_printed) / T_F)
filled_residual = filling_residual(filled)
filled_start_residual = sp.simplify(filled.subs(t, t0) - P0)

# --- (11): venting ----------------------------------------------------------------------------------------
vented = P0 * sp.exp(-elapsed / T_V)
vented_residual = sp.simplify(sp.diff(vented, elapsed) + vented / T_V)

# --- (12), (13): torque of the cylinder, with a pad friction that depends on the relative speed -----------
# The paper prints R for the radius r_b at which the pads act, its letter for the wheel too, and K_b without a word.
A_eff, E_b, eta_b, r_b = sp.symbols("A_eff E_b eta_b r_b", positive=True)
K = 2 * A_eff * E_b * eta_b * r_b
mu_pad = sp.Function("mu_brake", positive=True)(time)
P_t = sp.Function("P_c", real=True)(time)
torque_rate_derived = sp.diff(K * mu_pad * P_t, time)
torque_rate_printed_13 = K * mu_pad * sp.diff(P_t, time)
product_rule_residual = sp.simplify(torque_rate_printed_13 - torque_rate_derived)
bracket_13 = (P / T_V + (P_in - P) / T_F) * u - P / T_V
bracket_residual = sp.simplify(bracket_13 - pressure_rate.subs({fill: u, vent: 1 - u}))
torque_of_pressure = T_max * P / P_max

# --- (14): T_F = T_V = tau and full supply pressure -------------------------------------------------------
pressure_of_torque = P_max * T / T_max
lag_derived = sp.expand(  # tau T' + T, from (9) and (12), for equal time constants
    tau * T_max / P_max * bracket_13.subs({T_F: tau, T_V: tau, P: pressure_of_torque}) + T
)
lag_right_side = lag_derived.subs(P_in, P_max)  # = T_max u
supply_residual_of_lag = sp.simplify(lag_derived - lag_right_side)  # zero only under full supply
supply_share = (supply / P_max).subs(t, 1 / rate)  # of the full pressure, one time constant after the start
command_rate = sp.Symbol("command_rate", real=True)
lag_right_side_printed = T * command_rate
lag_residual = sp.simplify(lag_right_side_printed - lag_right_side)
bilinear_coefficient = sp.simplify(sp.diff(bracket_13, u, P))  # of u P: zero only for T_F = T_V
torque_rate = (T_max * u - T) / tau

# --- (15): average over a period h of any solution of (14); N and M are integrals of T and u ----------------
_N = sp.Function("N", real=True)(time)
_M = (tau * sp.diff(_N, time) + _N) / T_max  # the integral of (14)


def _average(integral: sp.Expr) -> sp.Expr:
    return (integral - integral.subs(time, time - h)) / h


average_residual = sp.simplify(
    (tau * sp.diff(_average(_N), time) + _average(_N) - T_max * _average(_M)).doit()
)

# --- ripple about it: periodic solution of (14) under a square wave of half duty ----------------------------
high, low = sp.symbols("T_high T_low", real=True)
half = sp.exp(-h / (2 * tau))
orbit = sp.solve([T_max + (low - T_max) * half - high, high * half - low], [high, low], dict=True)[0]
ripple_derived = sp.simplify(orbit[high] - orbit[low])
ripple_printed = T_max * sp.tanh(h / (4 * tau))
ripple = T_max * (1 - half) / (1 + half)
ripple_residual = sp.simplify((ripple_derived - ripple_printed).rewrite(sp.exp))

FUNCTIONS = (
    Generated(
        name="supply_pressure",
        arguments=(t, P_max, rate),
        value=supply,
        summary="Pressure that the air supply offers to the valves after the brake is applied",
        returns="Supply pressure [Pa]",
        equation="8",
    ),
    Generated(
        name="cylinder_pressure_rate",
        arguments=(P, P_in, fill, vent, T_F, T_V),
        value=pressure_rate,
        summary="Rate of change of the cylinder pressure through the fill and vent valves",
        returns="Rate of change of the pressure [Pa/s]",
        equation="9",
    ),
    Generated(
        name="filled_pressure",
        arguments=(t, t0, P0, P_max, rate, T_F),
        value=filled,
        summary="Cylinder pressure while filling from the growing supply pressure of eq. (8)",
        returns="Cylinder pressure [Pa]",
        equation="10",
        notes="Exact, in place of the printed eq. (10) which holds for constant supply only. Singular where\n"
        "``supply_rate * fill_time`` is 1.",
    ),
    Generated(
        name="vented_pressure",
        arguments=(elapsed, P0, T_V),
        value=vented,
        summary="Cylinder pressure while venting",
        returns="Cylinder pressure [Pa]",
        equation="11",
    ),
    Generated(
        name="braking_torque",
        arguments=(P, T_max, P_max),
        value=torque_of_pressure,
        summary="Braking torque of one wheelset at constant pad friction",
        returns="Braking torque [N m]",
        equation="12",
    ),
    Generated(
        name="torque_rate",
        arguments=(T, u, T_max, tau),
        value=torque_rate,
        summary="Rate of change of the braking torque of the brake as a first-order lag",
        returns="Rate of change of the torque [N m/s]",
        equation="14",
        notes="Holds at full supply pressure and equal time constants of filling and venting.",
    ),
    Generated(
        name="torque_ripple",
        arguments=(T_max, h, tau),
        value=ripple,
        summary="Ripple of the torque, peak to peak, under pulse width modulation of half duty",
        returns="T_max tanh(h / (4 tau)) [N m]",
        equation="15",
    ),
)
