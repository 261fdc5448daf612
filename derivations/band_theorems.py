"""The theorem on the band of slip, with the identities that carry its proof."""

import sympy as sp

from derivations import slip_loop
from derivations.theorem import Identity, Theorem

# --- a function of the state falls by alpha, and what disturbs it adds at most the shares -----------------------------
_alpha, _share, _P, _x, _d = sp.symbols("alpha sigma P x d", positive=True)
_budget = sp.expand(
    (1 - (_alpha * _P * _x**2 + _share * _d**2))
    - (_alpha * (1 - _P * _x**2) + _share * (1 - _d**2) + (1 - _alpha - _share))
)

THEOREMS = (
    Theorem(
        anchor="band",
        title="Band of slip of a sampled law with friction-torque observer",
        statement="With X = (e, p, N, Y), e = w - w_r the error of the wheel speed, p that of the observed one, N and "
        "Y h over the inertia of the law times the deviations of observed friction and seen torque from those that "
        "hold the reference, one sample makes X+ = A X + B d. If P > 0, shares D >= 0 and alpha with "
        "alpha + sum D <= 1 make diag(alpha P, D) - [A B]' P [A B] positive definite at the corners of all numbers "
        "of a sample, then {X'PX <= 1} is left by no sample with |d| <= 1, and |e| stays below the root of the first "
        "entry of P^-1. If such sets are given for windows of speed, that of a faster window inside that of the next "
        "slower one, a wheel that is in the set once keeps its slip within R |e|/v down to the lowest speed.",
        hypotheses=(
            "mass, inertia, radius, pads and valve times do not change; there are sets for each cell of their box",
            "(phi, psi) in the polygon of the range of the slope of the friction, which is proved over the slips that "
            "the band reaches",
            "limits of the state that keep commands within one sample, the error below the braking curve, and friction "
            "and torque above zero: there the law is the written one",
            "wheel speed, pressure and train speed measured exactly, without dead time; full supply pressure",
            "drift of torque and reference, and the error of the filtered acceleration, within their bounds",
        ),
        sketch="In deviations from the torque that holds the reference, pads, inertia and friction drop out of what "
        "is constant: the observer estimates the torque that explains the motion. A valve that is inverted with wrong "
        "times goes the part rho of the wanted way. The map is affine in each of (phi, psi), g, rho, the late share "
        "and the share in the mean torque, so that a convex function of its values is largest at corners. Between "
        "samples e has the same form with a part of the change of the torque.",
        not_said="How a wheel gets into the set; what happens with noise, dead time or a brake that is the limit.",
        identities=(
            Identity("phi e - g psi y solves e' = q e - g y", slip_loop.between_residual),
            Identity("psi along an edge has the slope (1 - exp(-q h))/q over phi", slip_loop.slope_residual),
            Identity(
                "d phi along an edge has the sign of the last minus the first secant", slip_loop.run_residual
            ),
            Identity("the slope falls along an edge", slip_loop.bend_residual),
            Identity("Y* = N + k h (e + a (N - Y + d_1)) + d_1", slip_loop.wanted_residual),
            Identity("innovation of the observer", slip_loop.innovation_residual),
            Identity("p+ = -theta^2 r", slip_loop.observer_residual),
            Identity("N+ = N + (1 - theta)^2 r - drift", slip_loop.friction_residual),
            Identity("1 - x^c is the integral of c u^(c - 1) from x to 1", slip_loop.part_residual),
            Identity("late share of a steady rise: 1/(1 - exp(-m)) - 1/m", slip_loop.lateness_residual),
            Identity("what the shares and alpha leave of 1", _budget),
        ),
        certificates=("slip_band",),
    ),
)
