"""Theorems about the loop with the lag of the valve and with sampling."""

import sympy as sp

from derivations import (
    adaptive_loop,
    recovery,
    sampled_loop,
    sliding_surface,
    stop_limit,
    traced_sample,
    valve_limit,
    valve_map,
)
from derivations.notation import symbols
from derivations.theorem import Identity, Theorem

p, tau, c, k, G = symbols("pole time_constant surface_rate layer_rate gain")

# --- Routh: e' = p e - G (T - T_0), tau T' + T = u for a law that is linear near its reference ---------------
_P, _I, _K, _q = sp.symbols("P I K q", real=True)
_linear = sp.Matrix([[p, -G, 0], [_P / tau, -(1 + _K) / tau, _I / tau], [1, 0, 0]])  # e, T - T_0, int e
_characteristic = tau * _q**3 + (1 + _K - p * tau) * _q**2 + (G * _P - (1 + _K) * p) * _q + G * _I
linear_residual = sp.expand(tau * (_q * sp.eye(3) - _linear).det() - _characteristic)

THEOREMS = (
    Theorem(
        anchor="no-go",
        title="A law whose memory only integrates, without feedback of torque or acceleration, does not beat the "
        "valve",
        statement="If a law does not read the torque (du/dT = 0) and its memory holds nothing but integrals of "
        "slip and speed, every equilibrium at which the open-loop slip pole exceeds 1/tau is unstable, whatever "
        "the gains. In general the poles of the loop with the valve add up to p - 1/tau + (du/dT)/tau + "
        "trace(A_c), A_c the dynamics of the law's own memory.",
        hypotheses=(
            "train speed frozen",
            "valve a first-order lag tau, eq. (14), that is not saturated at the equilibrium",
            "no feedback of pressure, torque or wheel acceleration: du/dT = 0",
            "memory without dynamics of its own: its rates depend on slip and speed only, so that trace(A_c) = 0",
        ),
        sketch="The sum of the poles is the trace of the Jacobian, and the hypotheses leave p - 1/tau of it. A "
        "positive trace has an eigenvalue with positive real part.",
        not_said="Anything about a law with dynamics of its own. A lead filter on the slip error, z' = -(p + 12) "
        "z + e, reads the slip alone and puts the poles to -6, -6 and -1/tau for every p; a copy of the valve "
        "that follows the law's own commands does it too, without a sensor of torque. Both have trace(A_c) < 0. "
        "Nor that the motion is unbounded: it settles on a limit cycle. Nor that p < 1/tau suffices.",
        identities=(
            Identity(
                "trace of the Jacobian = p - 1/tau + (du/dT)/tau + trace(A_c)", valve_limit.trace_residual
            ),
            Identity(
                "it is p - 1/tau for du/dT = 0 and a memory of integrals", valve_limit.integral_residual
            ),
            Identity("lead filter: det(q - A) = (q + 1/tau)(q + 6)^2", valve_limit.lead_residual),
            Identity("lead filter: trace(A_c) = -(p + 12)", valve_limit.lead_trace_residual),
            Identity(
                "copy of the valve: tau det(q - A) = (q + 1/tau)(tau q^2 + (1 + K - p tau) q + G kappa - (1 + K) p)",
                valve_limit.copy_residual,
            ),
            Identity("copy of the valve: trace(A_c) = -(1 + K)/tau", valve_limit.copy_trace_residual),
        ),
        certificates=("open_loop_pole", "no_go"),
    ),
    Theorem(
        anchor="hard-limits",
        title="What full venting brings back",
        statement="Let the slip stand d above its reference while the torque is T*, which holds the reference, "
        "and let a law see it h later. Full venting keeps the slip below the reference plus X and brings it back if "
        "(A/X)^2 + A p (1 + p tau)/g <= 1 with A = d exp(p h), g = G T* and p > 0 the largest slope of F in between. "
        "Where full venting does not, no law does. If no slope is positive, d < X is enough.",
        hypotheses=(
            "train speed frozen",
            "T* > 0; the valve vents as in (9) with the time constant tau",
            "the law holds T* until its next sample",
        ),
        sketch="No command empties the cylinder faster than T* exp(-t/tau), and less torque means less slip. "
        "While the slip is within X, x' <= p x + g z with z = T/T* - 1. The combination w = x + g tau z/(1 + p "
        "tau) obeys w' = p (w - delta), delta = g/(p (1 + p tau)), and begins at A: below delta it falls for "
        "good, and x stays below -delta ln(1 - A/delta). That is below X if A <= delta (1 - exp(-X/delta)), which "
        "follows from the condition because u coth u <= sqrt(1 + u^2). For small deviations delta itself is the "
        "limit.",
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
        statement="A gain on the slip, sampled every h and held, stabilizes the pole p > 0 through the lag tau if "
        "and only if p tau (exp(p h) - 1) < 1 - exp(-h/tau).",
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
        anchor="valve",
        title="The valve from sample to sample: two time constants, of which the slower one is not the safe side",
        statement="Under full supply a sample that fills for a h and vents for b h takes the torque T to T_a = "
        "T_in - (T_in - T) exp(-a h/T_F) and then to T+ = T_a exp(-b h/T_V). On average T' = a (T_in - T)/T_F - b "
        "T/T_V, which is the lag (14) only if T_F = T_V. For samples that are short against both times the effect "
        "of the duty on T+ is h ((T_in - T)/T_F + T/T_V): it grows as either time falls.",
        hypotheses=(
            "supply pressure constant over the sample, T_in its torque",
            "valves that open and close at once, one after the other, a + b <= 1",
            "constant pad friction",
        ),
        sketch="(9) is linear while one valve is open. A faster vent raises the gain of the sampled loop: the "
        "feedback of torque with K = tau/h - 1, tau = .3 s, h = .02 s, multiplies a deviation of the torque at "
        "T_in/2 by "
        f"{float(valve_map.factor_of_slower):.2f} a sample if both times are .3 s, and by "
        f"{float(valve_map.factor_of_valve):.2f} if it vents with .08 s: it is unstable, and the slower of the two "
        "times says that it is not.",
        not_said="Anything about dead times of the valves, or about a supply that still rises.",
        identities=(
            Identity("T_a solves (9) while filling", valve_map.filling_residual),
            Identity("T_a exp(-b h/T_V) solves (9) while venting", valve_map.venting_residual),
            Identity("(T+ - T)/h tends to a (T_in - T)/T_F - b T/T_V", valve_map.average_residual),
            Identity("dT+/d(duty) = h exp(-b h/T_V) ((T_in - T_a)/T_F + T_a/T_V)", valve_map.effect_residual),
            Identity("it is h ((T_in - T)/T_F + T/T_V) to first order in h", valve_map.short_effect_residual),
            Identity("dT+/dT = exp(-a h/T_F - b h/T_V)", valve_map.torque_effect_residual),
        ),
        certificates=("lpv_lyapunov", "sampled_invariance"),
    ),
    Theorem(
        anchor="routh",
        title="The loop near its equilibrium with the lag of the valve",
        statement="If the estimates of an adaptive law are frozen, a law that near the equilibrium of the actual "
        "parameters is u = u_0 + P e + I int e - K (T - T_0) gives the characteristic polynomial a_3 q^3 + a_2 q^2 + "
        "a_1 q + a_0 = tau q^3 + (1 + K - p tau) q^2 + (G P - (1 + K) p) q + G I. The loop is stable if and only if "
        "a_2 > 0, a_0 > 0 and a_2 a_1 > tau a_0, or, with I = 0, if and only if p tau < 1 + K and G P > (1 + K) "
        "p. The sliding mode with k = W K_P/Phi on its own design model has a_1 = c + k, the adaptive law with k "
        "= G K_P du/ds and frozen b_hat, psi_hat has a_1 = k - p; both have K = 0 and a_0 = k c. With the "
        "adaptation (41) the polynomial is tau q^4 + (1 - p tau) q^3 + (G K_P k_s - p) q^2 + G (K_I k_s + K_P "
        "kappa) q + G K_I kappa, k_s = du/ds, kappa = alpha_1 w^T w.",
        hypotheses=(
            "small deviations from the equilibrium of the actual parameters, p and G being those of this "
            "equilibrium: nothing saturates, and abs(s) stays inside the layer of a law that has one",
            "an equilibrium lies within the tolerance about the reference: without an integral of the error it is at "
            "the reference only if the law knows the holding torque exactly",
            "b_hat and psi_hat frozen, which is so inside the dead zone of the repaired law, and not in (41)",
            "train speed frozen",
            "valve a first-order lag, T_F = T_V",
            "no sampling",
        ),
        sketch="Routh's criterion for a cubic with tau > 0. With I = 0 the integral decides nothing, and the "
        "quadratic that remains needs positive coefficients. With the adaptation the linearized law has a further "
        "integral, w^T (b_hat - b_0), of alpha_1 w^T w s; psi_hat multiplies s, which vanishes at the equilibrium.",
        not_said="That small deviations of the printed law die out: the quartic decides that, and it can have "
        "unstable roots where the cubic has none. Anything about sampling at h: see the sampled checks.",
        identities=(
            Identity(
                "with adaptation: tau det(q - A) = q^2 times the quartic, for two rules and psi_hat",
                adaptive_loop.characteristic_residual,
            ),
            Identity("the quartic is q times the cubic for kappa = 0", adaptive_loop.frozen_residual),
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
        anchor="traced-loop",
        title="The step of any law as its graph tells it",
        statement="Let the step of a law be traced to a graph. A measurement from which no path leads to a command, "
        "through the memory of any number of samples, does not change it. If the loop of this step and of the valve "
        "rests at a state, is differentiable there, and all poles of the map from one sample to the next lie inside "
        "the unit circle, small deviations die out; if one lies outside, some grow. A family of states at which the "
        "loop rests has poles at 1, which are left out.",
        hypotheses=(
            "the graph is the step that runs",
            "train speed frozen, parameters known, measurement without error",
            "supply at its full pressure; valves that open and close at once, filling first",
            "within a sample slip' = F + p (s - s_k) + G T with F, p and G at the sampled slip s_k",
        ),
        sketch="(9) is linear while the valve stays in one state, and so is the slip with a constant pole: filling, "
        "venting and holding have closed forms. Newton's method looks for the rest, CasADi differentiates the map. A "
        "law that switches, holds its valves or moves on in every sample has no such slopes, and nothing is said.",
        not_said="That there is no rest where none was found. Anything about deviations that are not small, about "
        "speeds between those that were tried, or about a train that slows down. A path of the graph alone does not "
        "show that a command depends on a measurement: two histories do.",
        identities=(
            Identity("filling: slip' = F + p (s - s_k) + G T", traced_sample.filling_residual),
            Identity("venting: the same", traced_sample.venting_residual),
            Identity("holding: the same", traced_sample.holding_residual),
            Identity("the sample begins at s_k", traced_sample.start_residual),
            Identity("d(s_k + F (exp(p h) - 1)/p)/ds_k = exp(p h) for F' = p", traced_sample.slope_residual),
            Identity(
                "x+ = A x + B m, u = C x + D m: the next command follows m by C B",
                traced_sample.memory_residual,
            ),
        ),
        certificates=("feedback", "traced_loop"),
    ),
    Theorem(
        anchor="lpv",
        title="One quadratic function for all speeds",
        statement="If an equilibrium of the actual parameters lies within the tolerance about the reference, let "
        "e and T - T* be the deviations from it, gamma = R T_max/I_w and u, theta the duty and T*/T_max there. In y "
        "= v e and w = gamma (T - T*)/T_max a static law with the duty u + kappa y - K (T - T*)/T_max gives x' = A x, "
        "x = (y, w), A = [[q, -1], [b g, -(a + b K)]], with q = p - a_v/v at the equilibrium, a_v the deceleration, "
        "g = gamma kappa, a = u/T_F + (1 - u)/T_V and b = (1 - theta)/T_F + theta/T_V. If A^T P + P A < -2 alpha P "
        "at the corners of intervals of q, a, b and of (g, K), x^T P x falls at least as exp(-2 alpha t) whatever "
        "the course of these numbers within them. If A_h^T P A_h < c^2 P for the matrices A_h from sample to sample, "
        "it falls by c^2 per sample.",
        hypotheses=(
            "an equilibrium lies within the tolerance about the reference: it is at the reference only if the law "
            "knows the holding torque u* of the actual parameters, and elsewhere the pole is another one",
            "small deviations from that equilibrium; nothing saturates",
            "q stays in its interval, for every slip within the tolerance; T_max and the inertia do not change",
            "the valve averaged, or from sample to sample; full supply pressure",
            "P > 0; sampled: q constant within a sample",
            "the change of the equilibrium is slow",
        ),
        sketch="A is affine in each of its numbers, so that A^T P + P A is negative between the corners if it is at "
        "them; a and b lie between 1/T_F and 1/T_V because u and theta lie in [0, 1]. A_h is affine in each of the "
        "numbers of a sample, which are enclosed, and x^T P x is convex. P is positive definite if the pivots of "
        "LDL' are.",
        not_said="Where the equilibrium lies: without an integral of the error it moves with mass, inertia and "
        "friction. What happens beyond small deviations, or when the brake is the limit.",
        identities=(
            Identity("y' = q y - w", sampled_loop.sliding_residual),
            Identity("w' = b g y - (a + b K) w near the equilibrium, from (9)", sampled_loop.loop_residual),
            Identity("A is affine in each of q, a, b", sampled_loop.affine_residual),
            Identity("-(A^T P + P A) - 2 alpha P by entries, for any A", sampled_loop.decrease_residual),
            Identity("c^2 P - A^T P A by entries, for any A", sampled_loop.contraction_residual),
            Identity("x^T P x by the pivots P_11 and P_22 - P_12^2/P_11", sampled_loop.pivots_residual),
            Identity("x^T P x is convex", sampled_loop.convex_residual),
        ),
        certificates=("lpv_lyapunov",),
    ),
    Theorem(
        anchor="invariance",
        title="Sets of slip and torque that one sample maps into themselves",
        statement="Let a set of slip and torque be given for each of some windows of speed. If every state of a set "
        "is, one sample later, again in this set and in that of the next slower window, at all speeds of the window "
        "and for all parameters of the box, then a wheel that is in the set once stays in the sets down to the "
        "lowest speed.",
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
