"""Theorems about the sliding surface and the adaptive law in the setting of their proofs, T = u."""

import sympy as sp

from derivations import adaptive_fuzzy, barbalat, sliding_surface
from derivations.notation import symbols
from derivations.theorem import Identity, Theorem

c, e, F, G, v, g = symbols("surface_rate error drift gain speed gain_times_speed")
W0, rho, Psi, Psi_hat, sat = sp.symbols("W_0 rho Psi Psi_hat sat", real=True)

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
_T = sp.Symbol("T", real=True)
holding_residual = sp.simplify(F + G * _T - G * (_T + F / G))
existence_residual = sp.simplify((F + G * (_u_star + _eta / (G * v)) - c * e) - _eta / v)

THEOREMS = (
    Theorem(
        anchor="reaching",
        title="Moving towards the sliding surface",
        statement="As long as the slip stays inside the range on which abs(r) + eta <= rho W0, the law u = g_hat^-1 "
        "[-Psi_hat + v c e + W0 sat(sbar/Phi)] makes abs(sbar) fall with at least eta in sigma = int dt/v outside "
        "the layer. If the slip stays there, and only if v_0 exp(-a_max abs(sbar_0)/eta) > v_low, the lowest "
        "speed of the domain, this shows that the layer is reached within it.",
        hypotheses=(
            "the slip stays inside the range of the domain",
            "T = u: no lag, no sampling, no limits of the brake",
            "r = (1 - rho) v c e - Psi + rho Psi_hat is bounded so on the domain and the box of parameters",
            "slip reference constant",
        ),
        sketch="v sbar' = r - rho W0 sat(sbar/Phi), and sat is the sign outside the layer. A constant bound W of "
        "eq. (20) cannot do this: the uncertainty grows as 1/v, so that W = W0/v.",
        not_said="That the slip stays inside its range, or that the slip error falls: an integral of the error "
        "that is not zero drives the error away from zero until sbar is in the layer. Anything about the loop "
        "with the valve: see the no-go theorem.",
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
        statement="If abs(s) <= Phi holds for good, the slip error satisfies abs(e) <= 2 Phi/K_P after the "
        "transient of rate c.",
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
        statement="If T = u and eta/g <= u* <= T_max - eta/g on the domain, a torque within 0 and T_max makes the "
        "surface attractive with eta.",
        hypotheses=("u* = (-F + c e)/G", "T = u"),
        sketch="A torque that differs from u* by eta/g moves v sbar by eta.",
        not_said="That u* > T_max is dangerous: the wheel then slips less than asked, the brake is the limit.",
        identities=(Identity("slip' at u* + eta/(G v) exceeds c e by eta/v", existence_residual),),
        certificates=("sliding_exists",),
    ),
    Theorem(
        anchor="holding",
        title="What holds the reference, and what goes beyond it",
        statement="slip' = G (T - T_h) with the torque T_h = -F/G that holds the slip and G > 0. Where T_h >= 0 no "
        "slip grows at a vented brake. Where T_h at the reference exceeds T_max, a slip that lies below it stays "
        "there, whatever the law does. How far the slip goes beyond its reference under a law is seen in a "
        "simulated stop.",
        hypotheses=("v > 0", "T = u for what is said about a vented or full brake"),
        sketch="(19) is affine in the torque and G > 0.",
        not_said="That the law vents, or fills: what it does is seen in the stop. That another start, rail or vehicle "
        "gives the same stop.",
        identities=(Identity("F + G T = G (T + F/G)", holding_residual),),
        certificates=("holding_torque", "overshoot"),
    ),
    Theorem(
        anchor="energy",
        title="The repaired Lyapunov function of the adaptive fuzzy law",
        statement="While T = u, or else the adaptation is held and eta <= u* <= T_max - eta, and as long as the "
        "slip stays where the bound psi holds, V = v s_D^2/(2 g) + abs(b~)^2/(2 alpha_1) + psi~^2/(2 alpha_2) "
        "does not increase, b_hat and psi_hat stay bounded, and int abs(s_D) dt <= V(0)/eta.",
        hypotheses=(
            "a = -v' >= 0",
            "u_r = psi_hat sat(sbar/Phi), b_hat' = alpha_1 s_D w, psi_hat' = alpha_2 abs(s_D), with the dead zone "
            "s_D",
            "psi >= abs(u* - b*^T w) + eta for one constant b* and every state that the stop passes",
            "T = u: no lag, no pulses; where the command pushes beyond a limit of the brake, so that T is 0 or "
            "T_max, the adaptation is held and u* lies inside the limits by eta, eta <= u* <= T_max - eta",
        ),
        sketch="V' = s_D xi - psi abs(s_D) - a s_D^2/(2 g) <= -eta abs(s_D). Dividing (43) by G turns the term of G' "
        "that invalidates the printed argument into one that helps. At a limit of the brake V' = s_D (u* - T) - a "
        "s_D^2/(2 g), which is at most -eta abs(s_D) for T = T_max, s_D > 0, and for T = 0, s_D < 0, if u* is "
        "inside by eta. It has to be: with u* = 65 kN m, T_max = 60 kN m and s_D = .05 V' is "
        f"{float(adaptive_fuzzy.held_counterexample):+.0f} N m (a = 3 m/s2, R = .55 m, I = 331 kg m2).",
        not_said="That the slip converges within the stop, or at all under the lag of the valve.",
        identities=(
            Identity("V' = s_D xi - psi abs(s_D) - a s_D^2/(2 g)", adaptive_fuzzy.repaired_rate_residual),
            Identity("adaptation held: V' = s_D (u* - T) - a s_D^2/(2 g)", adaptive_fuzzy.held_rate_residual),
            Identity(
                "at T = T_max, u* = T_max - eta, s_D > 0: V' = -eta s_D - a s_D^2/(2 g)",
                adaptive_fuzzy.held_full_residual,
            ),
            Identity(
                "at T = 0, u* = eta, s_D < 0: V' = eta s_D - a s_D^2/(2 g)",
                adaptive_fuzzy.held_empty_residual,
            ),
            Identity(
                "without dead zone V = V2/(G K_P), the rates of V2 being K_P times those of V",
                adaptive_fuzzy.repaired_scale_residual,
            ),
        ),
        certificates=("lyapunov_repaired", "afsmc_energy"),
    ),
    Theorem(
        anchor="printed",
        title="V2 of eq. (43) is not a Lyapunov function",
        statement="With T = u and constant b and psi, V2' exceeds along the closed loop of the paper what (44) "
        "claims by (G'/2)(abs(b~)^2/alpha_1 + psi~^2/alpha_2), and G' = G a/v > 0 while the train brakes.",
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
        title="Barbalat's lemma says nothing about a stop, unless the rates of adaptation are alpha/v",
        statement="The train stands at t = v_0/a, so that the limit t -> infinity of (48) does not exist. If the "
        "rates of adaptation are alpha/v, if the slip stays where psi bounds the error of approximation at all "
        "speeds above 0, and if T = u, or the adaptation is held and u* inside the limits of the brake by eta/g, "
        "then the horizon is infinite in sigma = int dt/v: V = s_D^2/(2 g) + abs(b~)^2/(2 alpha_1) + psi~^2/(2 "
        "alpha_2) falls with at least (eta/g) abs(s_D), the integral of abs(s_D) d sigma is at most V(0) g/eta, "
        "and s_D tends to zero as the train comes to a standstill.",
        hypotheses=(
            "b_hat' = alpha_1 s_D w/v, psi_hat' = alpha_2 abs(s_D)/v in time, with the dead zone s_D",
            "the slip stays in the range of the domain, which a stop that starts rolling has to enter first",
            "psi >= abs(u* - b*^T w) + eta/g for one constant b*, at all speeds above 0",
            "T = u: no lag, no pulses; where the command pushes beyond a limit of the brake, the adaptation is "
            "held and u* lies inside the limits by eta/g",
            "a <= a_max",
        ),
        sketch="v = v_0 exp(-a_max sigma) at least, so that sigma grows without bound as v falls to zero, and the "
        "term of G' is gone. abs(ds_D/d sigma) = g abs(u* - T) is bounded, so that s_D is uniformly continuous, "
        "and the lemma applies to its integral. Then e enters the layer's bound as well: it is sbar through a "
        "stable filter.",
        not_said="That a stop satisfies the conditions. How soon the error enters the boundary layer, nor how "
        "small it is inside.",
        identities=(
            Identity("dV/d sigma = s_D xi - psi abs(s_D)", barbalat.sigma_rate_residual),
            Identity("dv/d sigma = -a_max v for v = v_0 exp(-a_max sigma)", speed_residual),
            Identity("(45) exceeds -V2' by the omitted terms", barbalat.excess),
            Identity("e' + c e = 0 after a step of sbar: e = exp(-c t)", barbalat.filter_residual),
        ),
        certificates=("barbalat",),
    ),
)
