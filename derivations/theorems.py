"""The statements that can be made in place of the paper's, with the identity that carries each proof.

Claims: every identity below has the residual zero. The theorems are those that the certificates of the package
establish for numbers; here stands why they are true for symbols. `make derive` writes them to docs/theory.md.
"""

from dataclasses import dataclass

import sympy as sp

from derivations import adaptive_fuzzy, barbalat, sliding_surface, slip_equation, torque_balance
from derivations.notation import symbols

p, tau, c, k, e = symbols("pole time_constant surface_rate layer_rate error")
F, G, v, g, T = symbols("drift gain speed gain_times_speed torque")
W0, rho, Psi, Psi_hat, sat = sp.symbols("W_0 rho Psi Psi_hat sat", real=True)
m, R, inertia, f, f_d = symbols("mass wheel_radius wheel_inertia creep_force resistance")


@dataclass(frozen=True, slots=True)
class Identity:
    """An equation that a proof rests on, as text, and its residual."""

    text: str
    residual: sp.Expr


@dataclass(frozen=True, slots=True)
class Theorem:
    """A statement with what it needs, why it holds and what it does not say."""

    anchor: str
    title: str
    statement: str
    hypotheses: tuple[str, ...]
    sketch: str
    not_said: str
    identities: tuple[Identity, ...]
    certificates: tuple[str, ...]


# --- no-go: the trace of the Jacobian does not depend on the law ------------------------------------------
_u_slip, _u_memory, _memory_slip = sp.symbols("u_slip u_memory h_slip", real=True)
_jacobian = sp.Matrix(  # slip, torque, one memory state that is driven by the slip alone
    [[p, G, 0], [_u_slip / tau, -1 / tau, _u_memory / tau], [_memory_slip, 0, 0]]
)
trace_residual = sp.simplify(_jacobian.trace() - (p - 1 / tau))

# --- reaching: the law with a design model in the true plant, times the speed -----------------------------
_g_hat = g / rho  # rho = g / g_hat = I_hat / I
_u = (-Psi_hat + v * c * e + W0 * sat) / _g_hat
_surface_rate = v * (-(Psi / v + g / v * _u) + c * e)  # v (e' + c e) at a constant reference
reaching_residual = sp.simplify(
    _surface_rate - ((1 - rho) * v * c * e - Psi + rho * Psi_hat - rho * W0 * sat)
)
# |sbar|' <= -eta in sigma = int dt/v, and v' >= -a: dv/d sigma = -a v at worst.
_a, _eta, _s0, _v0 = sp.symbols("a_max eta s_0 v_0", positive=True)
_sigma = sp.Symbol("sigma", positive=True)
_speed = _v0 * sp.exp(-_a * _sigma)
speed_residual = sp.simplify(sp.diff(_speed, _sigma) + _a * _speed)
speed_left_residual = sp.simplify(_speed.subs(_sigma, _s0 / _eta) - _v0 * sp.exp(-_a * _s0 / _eta))

# --- existence: the ideal torque keeps a distance eta/g from both limits ----------------------------------
_u_star = (-F + c * e) / G
existence_residual = sp.simplify((F + G * (_u_star + _eta / (G * v)) - c * e) - _eta / v)

# --- bound of every stop: eliminate the creep force from (1), (2) -----------------------------------------
_v_rate = (-f_d - 8 * f) / m
_omega_rate = (-T / 2 + R * f) / inertia
bound_residual = sp.simplify(m * _v_rate + 8 * inertia / R * _omega_rate - (-f_d - 4 * T / R))

THEOREMS = (
    Theorem(
        anchor="no-go",
        title="No law without torque or acceleration feedback beats the valve",
        statement="Let a law command the valve from slip and speed, with a memory that the slip drives. Every "
        "equilibrium with an open-loop slip pole p > 1/tau is unstable, whatever the gains.",
        hypotheses=(
            "train speed frozen",
            "valve a first-order lag tau, eq. (14)",
            "no feedback of pressure, torque or wheel acceleration",
        ),
        sketch="The divergence of the closed loop, the trace of its Jacobian, is p - 1/tau: the law fills in only "
        "entries off the diagonal. A positive trace has an eigenvalue with positive real part.",
        not_said="That the motion is unbounded: it settles on a limit cycle. Nor that p < 1/tau suffices.",
        identities=(Identity("trace of the Jacobian = p - 1/tau", trace_residual),),
        certificates=("open_loop_pole", "no_go"),
    ),
    Theorem(
        anchor="reaching",
        title="Reaching the sliding surface",
        statement="With u = g_hat^-1 [-Psi_hat + v c e + W0 sat(sbar/Phi)] and abs(r) + eta <= rho W0 on the domain, "
        "abs(sbar) falls with at least eta in sigma = int dt/v outside the layer. The surface is reached while "
        "v >= v_0 exp(-a_max abs(sbar_0)/eta).",
        hypotheses=(
            "T = u: no lag, no sampling, no limits of the brake",
            "r = (1 - rho) v c e - Psi + rho Psi_hat is bounded so on the domain and the box of parameters",
            "slip reference constant",
        ),
        sketch="v sbar' = r - rho W0 sat(sbar/Phi), and sat is the sign outside the layer. A constant bound W of "
        "eq. (20) cannot do this: the uncertainty grows as 1/v, so that W = W0/v.",
        not_said="Anything about the loop with the valve: see the no-go theorem.",
        identities=(
            Identity("v sbar' = (1 - rho) v c e - Psi + rho Psi_hat - rho W0 sat", reaching_residual),
            Identity("dv/d sigma = -a_max v for v = v_0 exp(-a_max sigma)", speed_residual),
            Identity("v at sigma = abs(sbar_0)/eta", speed_left_residual),
        ),
        certificates=("reaching", "boundary_layer"),
    ),
    Theorem(
        anchor="layer",
        title="Error inside the boundary layer",
        statement="Inside abs(s) <= Phi the slip error satisfies abs(e) <= 2 Phi/K_P after the transient of rate c.",
        hypotheses=("the surface is reached and not left",),
        sketch="e is s/K_P filtered by q/(q + c), whose impulse response has the L1 norm 2.",
        not_said="That the error tends to zero.",
        identities=(
            Identity(
                "peak gain from s/K_P to e = 2",
                sp.simplify(
                    sliding_surface.layer_error_bound * sliding_surface.K_P / sliding_surface.Phi - 2
                ),
            ),
        ),
        certificates=("boundary_layer", "tracking"),
    ),
    Theorem(
        anchor="existence",
        title="Existence of sliding with a brake that only pushes",
        statement="If eta/g <= u* <= T_max - eta/g on the domain, a torque within 0 and T_max makes the surface "
        "attractive with eta.",
        hypotheses=("u* = (-F + c e)/G", "T = u"),
        sketch="A torque that differs from u* by eta/g moves v sbar by eta.",
        not_said="That u* > T_max is dangerous: the wheel then slips less than asked, the brake is the limit.",
        identities=(Identity("slip' at u* + eta/(G v) exceeds c e by eta/v", existence_residual),),
        certificates=("brake_authority", "sliding_exists"),
    ),
    Theorem(
        anchor="energy",
        title="The repaired Lyapunov function of the adaptive fuzzy law",
        statement="V = v s_D^2/(2 g) + abs(b~)^2/(2 alpha_1) + psi~^2/(2 alpha_2) does not increase, b_hat and psi_hat "
        "stay bounded, and int abs(s_D) dt <= V(0)/eta.",
        hypotheses=(
            "a = -v' >= 0",
            "u_r = psi_hat sat(sbar/Phi), b_hat' = alpha_1 s_D w, psi_hat' = alpha_2 abs(s_D), with the dead zone s_D",
            "psi >= abs(u* - b*' w) + eta for one constant b*",
            "T = u, or adaptation held while the command pushes beyond the limits of the brake",
        ),
        sketch="V' = s_D xi - psi abs(s_D) - a s_D^2/(2 g) <= -eta abs(s_D). Dividing (43) by G turns the term of G' "
        "that breaks the printed proof into one that helps.",
        not_said="That the slip converges within the stop, or at all under the lag of the valve.",
        identities=(
            Identity("V' = s_D xi - psi abs(s_D) - a s_D^2/(2 g)", adaptive_fuzzy.repaired_rate_residual),
        ),
        certificates=("lyapunov_repaired", "afsmc_energy"),
    ),
    Theorem(
        anchor="printed",
        title="V2 of eq. (43) is no Lyapunov function",
        statement="Along the closed loop of the paper V2' exceeds what (44) claims by (G'/2)(abs(b~)^2/alpha_1 + "
        "psi~^2/alpha_2), and G' = G a/v > 0 while the train brakes.",
        hypotheses=("the law and the adaptation of eqs. (36) to (42)", "a > 0"),
        sketch="G depends on the speed. (44) differentiates as if it did not.",
        not_said="That the slip diverges: in the setting of the proof it converges while V2 rises.",
        identities=(
            Identity("omitted part of V2'", adaptive_fuzzy.omitted_residual),
            Identity(
                "G'/G = a/v", sp.simplify(adaptive_fuzzy.gain_growth - adaptive_fuzzy.a / adaptive_fuzzy.v)
            ),
            Identity("(44) holds if G' = 0", adaptive_fuzzy.frozen_gain_residual),
        ),
        certificates=("lyapunov_printed",),
    ),
    Theorem(
        anchor="barbalat",
        title="Barbalat's lemma says nothing about a stop",
        statement="The train stands at t = v_0/a, so that the limit t -> infinity of (48) does not exist. In "
        "sigma-time, with adaptation rates alpha/v, V falls with s_D xi - psi abs(s_D) and the horizon is infinite.",
        hypotheses=("sigma-time: rates alpha/v, bounded u*, psi > abs(xi) by a margin",),
        sketch="sigma = int dt/v grows without bound as v falls to zero, and the term of G' is gone.",
        not_said="How small the error is when the train stands.",
        identities=(
            Identity("dV/d sigma = s_D xi - psi abs(s_D)", barbalat.sigma_rate_residual),
            Identity("(45) exceeds -V2' by the omitted terms", barbalat.excess),
        ),
        certificates=("barbalat",),
    ),
    Theorem(
        anchor="routh",
        title="The loop inside the layer with the lag of the valve",
        statement="With k = W K_P/Phi the loop has the characteristic polynomial tau q^3 + (1 - p tau) q^2 + (c + k) q "
        "+ k c. It is stable if and only if p tau < 1 and (1 - p tau)(c + k) > tau k c.",
        hypotheses=("inside the layer", "train speed frozen", "no sampling"),
        sketch="Routh's criterion for a cubic with c, k > 0.",
        not_said="Anything about sampling at h: see the sampled checks.",
        identities=(
            *(
                Identity(f"coefficient of q^{3 - n}", residual)
                for n, residual in enumerate(sliding_surface.characteristic_residual)
            ),
            Identity(
                "Routh determinant",
                sp.expand(sliding_surface.routh - ((1 - p * tau) * (c + k) - tau * k * c)),
            ),
        ),
        certificates=("routh_lag", "margins"),
    ),
    Theorem(
        anchor="bound",
        title="No controller stops shorter than the rail and the filling brake allow",
        statement="v' >= -P(v) with P the deceleration at the adhesion peak of all wheels, and (m + 8 I/R^2)(v_0 - v) "
        "<= int f_d dt + (4/R) int T_fill dt for the brake that fills from the start.",
        hypotheses=(
            "omega <= v/R: no wheel turns faster than it rolls",
            "B_W = 0",
            "equal loads: load transfer lowers the sum of the peaks",
        ),
        sketch="Eliminate the creep force from (1) and (2); a wheel that slides has given up momentum already.",
        not_said="That a controller reaches it.",
        identities=(
            Identity("m v' + (8 I/R) omega' = -f_d - (4/R) T", bound_residual),
            Identity(
                "the torque integral of Table 10 is a momentum balance", torque_balance.identity_residual
            ),
        ),
        certificates=("stop_bound", "conservation"),
    ),
    Theorem(
        anchor="slip-equation",
        title="The slip equation",
        statement="(19) follows from (1) to (3): slip' = F + G T with G = R/(2 I v) > 0, affine in the torque.",
        hypotheses=("v > 0",),
        sketch="Differentiate (3) and insert (1), (2).",
        not_said="Anything at standstill, where the slip ratio is singular.",
        identities=(
            Identity("(19) as printed", slip_equation.slip_rate_residual),
            Identity("drift F", slip_equation.drift_residual),
            Identity("slope of F at fixed speed", slip_equation.drift_slope_residual),
        ),
        certificates=("derivation", "gain_positive", "well_posed"),
    ),
)
