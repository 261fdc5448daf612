"""The statements that can be made in place of the paper's, with the identity that carries each proof.

Claims: every identity below has the residual zero. The theorems are those that the certificates of the package
establish for numbers; here stands why they are true for symbols. `make derive` writes them to docs/theory.md.
"""

from dataclasses import dataclass

import sympy as sp

from derivations import (
    adaptive_fuzzy,
    barbalat,
    recovery,
    sampled_loop,
    sliding_surface,
    slip_equation,
    stop_limit,
    torque_balance,
)
from derivations.notation import symbols

p, tau, c, k, e = symbols("pole time_constant surface_rate layer_rate error")
F, G, v, g = symbols("drift gain speed gain_times_speed")
W0, rho, Psi, Psi_hat, sat = sp.symbols("W_0 rho Psi Psi_hat sat", real=True)


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
        anchor="hard-limits",
        title="What full venting brings back",
        statement="Let the slip stand d above its reference while the torque is T*, which holds the reference, and let "
        "a law see it h later. Full venting keeps the slip below the reference plus X and brings it back if "
        "(A/X)^2 + A p (1 + p tau)/g <= 1 with A = d exp(p h), g = G T* and p > 0 the largest slope of F in between. "
        "Where full venting does not, no law does. If no slope is positive, d < X is enough.",
        hypotheses=(
            "train speed frozen",
            "T* > 0; the valve vents as in (9) with the time constant tau",
            "the law holds T* until its next sample",
        ),
        sketch="No command empties the cylinder faster than T* exp(-t/tau), and less torque means less slip. While the "
        "slip is within X, x' <= p x + g z with z = T/T* - 1. The combination w = x + g tau z/(1 + p tau) obeys "
        "w' = p (w - delta), delta = g/(p (1 + p tau)), and begins at A: below delta it falls for good, and x stays "
        "below -delta ln(1 - A/delta). That is below X if A <= delta (1 - exp(-X/delta)), which follows from the "
        "condition because u coth u <= sqrt(1 + u^2). For small deviations delta itself is the limit.",
        not_said="That more is impossible: friction that levels off allows more, so that a refutation needs a path "
        "that passes the limit. Nor what a falling train speed changes within the second that recovery takes, which "
        "counts at the lowest speeds. A deviation below the reference is benign: the wheel falls back to rolling.",
        identities=(
            Identity("delta = int exp(-p t) g (1 - exp(-t/tau)) dt", recovery.largest_residual),
            Identity("w' = p (w - delta)", recovery.combination_residual),
            Identity("x <= delta (1 - (1 - A/delta) E + ln E), E = exp(p t)", recovery.path_residual),
            Identity("its slope in E vanishes at E = delta/(delta - A)", recovery.flat_residual),
            Identity("it is -delta ln(1 - A/delta) there", recovery.furthest_residual),
            Identity("y/(1 - exp(-y)) = y/2 + (y/2) coth(y/2)", recovery.half_residual),
            Identity("(1 + u^2) sinh^2 u - u^2 cosh^2 u = sinh^2 u - u^2", recovery.squares_residual),
            Identity(
                "1/A = 1/(2 delta) + sqrt(1/(4 delta^2) + 1/X^2) meets the condition", recovery.root_residual
            ),
        ),
        certificates=("hard_limits",),
    ),
    Theorem(
        anchor="sampling",
        title="The largest slip pole that sampled feedback of the slip stabilizes",
        statement="A gain on the slip, sampled every h and held, stabilizes the pole p > 0 through the lag tau if and "
        "only if p tau (exp(p h) - 1) < 1 - exp(-h/tau).",
        hypotheses=(
            "train speed frozen",
            "proportional feedback",
            "command held over a sample, no computing time",
        ),
        sketch="With alpha = exp(p h), beta = exp(-h/tau) the loop has the polynomial z^2 - (alpha + beta) z + alpha "
        "beta + K (b_1 z + b_0). It is positive at z = 1 only for K > p, and at K = p its roots are 1 and r. Since "
        "b_0 > 0 their product grows with K: a gain exists exactly if r < 1. For small h the limit is p < 1/(tau + "
        "h/2).",
        not_said="Anything about laws with memory, or with feedback of torque or acceleration.",
        identities=(
            Identity("step response of 1/((s - p)(tau s + 1))", sampled_loop.step_residual),
            Identity("static gain -1/p", sampled_loop.static_residual),
            Identity(
                "roots 1 and r = (beta + p tau alpha)/(1 + p tau) at K = p", sampled_loop.roots_residual
            ),
            Identity(
                "b_0 p (1 + p tau)/(alpha beta) = p tau (exp(h/tau) - 1) - (1 - exp(-p h))",
                sampled_loop.product_residual,
            ),
            Identity("(1 - r)(1 + p tau) = 1 - beta - p tau (alpha - 1)", sampled_loop.condition_residual),
        ),
        certificates=("sampling",),
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
        certificates=("lyapunov_surface", "reaching", "boundary_layer"),
    ),
    Theorem(
        anchor="layer",
        title="Error inside the boundary layer",
        statement="Inside abs(s) <= Phi the slip error satisfies abs(e) <= 2 Phi/K_P after the transient of rate c.",
        hypotheses=("the surface is reached and not left", "c > 0"),
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
        certificates=("surface_hurwitz", "boundary_layer", "tracking"),
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
        certificates=("sliding_exists",),
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
        anchor="lpv",
        title="One quadratic function for all speeds",
        statement="In y = v e and t = (T - T*)/T_max a static law with the duty u* + kappa y - K t gives x' = A x, x "
        "= (y, t), A = [[q, -gamma], [kappa/tau, -(1 + K)/tau]], with q = p - a/v and gamma = R T_max/I_w. If A'P + "
        "PA < -2 alpha P at the four vertices of an interval of q and one of gamma, x'Px falls at least as exp(-2 "
        "alpha t) whatever the course of q and gamma within them. If A_h'P A_h < c^2 P for the matrices A_h from "
        "sample to sample, for all q and both ends of gamma, it falls by c^2 per sample.",
        hypotheses=(
            "small deviations; nothing saturates",
            "q = p - a/v and gamma stay in their intervals on the domain",
            "P > 0; sampled: q and gamma constant within a sample",
            "the change of T* is slow",
        ),
        sketch="A is affine in q and gamma, so that A'P + PA is negative between the vertices if it is at them. A_h is "
        "affine in gamma, and x'Px is convex; in q it is not affine, so that the interval is covered by parts whose "
        "matrix exponential is enclosed. P is positive definite if the pivots of LDL' are.",
        not_said="What happens beyond small deviations, or when the brake is the limit.",
        identities=(
            Identity("y' = q y - gamma t", sampled_loop.sliding_residual),
            Identity("t' = (kappa y - (1 + K) t)/tau", sampled_loop.loop_residual),
            Identity("A is affine in q and gamma", sampled_loop.affine_residual),
            Identity("-(A'P + PA) - 2 alpha P as the checker has it", sampled_loop.decrease_residual),
            Identity("c^2 P - A_h'P A_h as the checker has it", sampled_loop.contraction_residual),
            Identity("x'Px by the pivots P_11 and P_22 - P_12^2/P_11", sampled_loop.pivots_residual),
            Identity("x'Px is convex", sampled_loop.convex_residual),
        ),
        certificates=("lpv_lyapunov",),
    ),
    Theorem(
        anchor="invariance",
        title="Sets of slip and torque that one sample maps into themselves",
        statement="Let a set of slip and torque be given for each of some windows of speed. If every state of a set "
        "is, one sample later, again in this set and in that of the next slower window, at all speeds of the window "
        "and for all parameters of the box, then a wheel that is in the set once stays in the sets down to the lowest "
        "speed.",
        hypotheses=(
            "a law without memory",
            "windows that cover the range of speed, and that no sample can jump over",
            "a valve that fills, vents and holds within a sample; full supply pressure",
            "static wheel load; the parameters may change with time within their box",
        ),
        sketch="Between two samples the torque is known and the slip obeys a scalar equation that rises with the "
        "torque. By the comparison theorem the slip stays below that of the upper edge under the largest torque, and "
        "above that of the lower edge under the smallest; both are followed in steps on which the rate is bounded. "
        "The creep force grows with friction and load, so that their ends bound it.",
        not_said="That a wheel gets into the set, or anything below the lowest speed.",
        identities=(
            Identity(
                "slip' = [R (T/2 - R f)/I - (1 - slip) a]/v + (1 - slip) B_W/I is (19)",
                sampled_loop.map_residual,
            ),
            Identity("d slip'/dT = R/(2 I v)", sampled_loop.torque_slope_residual),
            Identity(
                "S - eps S' = 2 x^3/(1 + x^2)^2 + atan y - y/(1 + y^2), x = k_A eps, y = k_S eps",
                stop_limit.friction_residual,
            ),
        ),
        certificates=("sampled_invariance",),
    ),
    Theorem(
        anchor="bound",
        title="No controller stops shorter than the rail and the filling brake allow",
        statement="At every instant v' >= -P(v), P = (f_d + m g_0 mu)/m, with g_0 = 9.81 m/s2 and mu(v) the largest "
        "creep force over load of any slip, and (m + n I_w/R^2)(v_0 - v) <= (f_d(v_0) + 2 n B_W v_0 (1 + s)/R^2) t + "
        "(n/R) int T_fill dt + n I_w s v_0/R^2 for n wheelsets of inertia I_w, T_fill the torque of a brake that "
        "only fills, and s = 0.0001. The second bounds the speed until some instant and the first from then on; the "
        "best instant bounds time and distance of every stop.",
        hypotheses=(
            "the wheels roll and the cylinders are empty at v_0",
            "level track, equal loads: load transfer lowers the sum of the peaks",
            "f_d and B_W >= 0 are largest at v_0",
            "abs(f(-s)) (8/m + 2 R^2/I_w) >= (1 + s) f_d/m at v_0",
        ),
        sketch="The momentum of train and wheels changes by resistance, brake and damping alone. At the slip -s the "
        "creep force turns the slip back to 0 by the last hypothesis, so that R omega <= (1 + s) v for good. The "
        "creep force grows with the friction, since S - eps S' >= 0: the peak falls with the speed, and the bound of "
        "mu at one speed holds above it.",
        not_said="That a controller reaches it.",
        identities=(
            Identity("R m v' + 8 I omega' = -R f_d - 4 T - 8 B_W omega", stop_limit.momentum_residual),
            Identity(
                "(m + J)(v_0 - v) = m (v_0 - v) + J (v_0 - R omega) + J s v for R omega = (1 + s) v, J = 8 I/R^2",
                stop_limit.overspeed_residual,
            ),
            Identity(
                "v slip' at the slip -s = abs(f)(8/m + R^2/I) - (1 + s) f_d/m + 8 s abs(f)/m + (1 + s) v B_W/I + "
                "R T/(2 I)",
                stop_limit.outrun_residual,
            ),
            Identity(
                "S - eps S' = 2 x^3/(1 + x^2)^2 + atan y - y/(1 + y^2), x = k_A eps, y = k_S eps",
                stop_limit.friction_residual,
            ),
            Identity("(atan y - y/(1 + y^2))' = 2 y^2/(1 + y^2)^2", stop_limit.surplus_rate_residual),
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
