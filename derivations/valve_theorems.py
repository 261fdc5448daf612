"""Theorems about the loop with the lag of the valve and with sampling."""

import sympy as sp

from derivations import recovery, sampled_loop, sliding_surface, stop_limit
from derivations.notation import symbols
from derivations.theorem import Identity, Theorem

p, tau, c, k, G = symbols("pole time_constant surface_rate layer_rate gain")

# --- no-go: the trace of the Jacobian does not depend on the law ------------------------------------------
_u_slip, _u_memory, _memory_slip = sp.symbols("u_slip u_memory h_slip", real=True)
_jacobian = sp.Matrix(  # slip, torque, one memory state that is driven by the slip alone
    [[p, G, 0], [_u_slip / tau, -1 / tau, _u_memory / tau], [_memory_slip, 0, 0]]
)
trace_residual = sp.simplify(_jacobian.trace() - (p - 1 / tau))

# --- Routh: e' = p e - G (T - T_0), tau T' + T = u for a law that is linear near its reference ---------------
_P, _I, _K, _q = sp.symbols("P I K q", real=True)
_linear = sp.Matrix([[p, -G, 0], [_P / tau, -(1 + _K) / tau, _I / tau], [1, 0, 0]])  # e, T - T_0, int e
_characteristic = tau * _q**3 + (1 + _K - p * tau) * _q**2 + (G * _P - (1 + _K) * p) * _q + G * _I
linear_residual = sp.expand(tau * (_q * sp.eye(3) - _linear).det() - _characteristic)

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
        anchor="routh",
        title="The loop near its reference with the lag of the valve",
        statement="A law that near its reference is u = u_0 + P e + I int e - K (T - T_0) gives the characteristic "
        "polynomial a_3 q^3 + a_2 q^2 + a_1 q + a_0 = tau q^3 + (1 + K - p tau) q^2 + (G P - (1 + K) p) q + G I. The "
        "loop is stable if and only if a_2 > 0, a_0 > 0 and a_2 a_1 > tau a_0, or, with I = 0, if and only if p tau < "
        "1 + K and G P > (1 + K) p. The sliding mode with k = W K_P/Phi on its own design model has a_1 = c + k, the "
        "adaptive law with k = G K_P du/ds has a_1 = k - p; both have K = 0 and a_0 = k c.",
        hypotheses=(
            "small deviations: nothing saturates, and abs(s) stays inside the layer of a law that has one",
            "train speed frozen",
            "no sampling",
        ),
        sketch="Routh's criterion for a cubic with tau > 0. With I = 0 the integral decides nothing, and the "
        "quadratic that remains needs positive coefficients.",
        not_said="Anything about sampling at h: see the sampled checks.",
        identities=(
            Identity("tau det(q - A) = a_3 q^3 + a_2 q^2 + a_1 q + a_0", linear_residual),
            *(
                Identity(f"coefficient of q^{3 - n} of the sliding mode", residual)
                for n, residual in enumerate(sliding_surface.characteristic_residual)
            ),
            Identity(
                "a_2 a_1 - a_3 a_0 of the sliding mode",
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
)
