"""The theorem on the band of slip, with the identities that carry its proof."""

import sympy as sp

from derivations import adhesion, slip_loop
from derivations.theorem import Identity, Theorem

# --- a function of the state falls by alpha, and what disturbs it adds at most the shares -----------------------------
_alpha, _share, _P, _x, _d = sp.symbols("alpha sigma P x d", positive=True)
_budget = sp.expand(
    (1 - (_alpha * _P * _x**2 + _share * _d**2))
    - (_alpha * (1 - _P * _x**2) + _share * (1 - _d**2) + (1 - _alpha - _share))
)

# --- one ellipse in another: what the larger function leaves of 1 is at least t times what the smaller leaves ---------
_t, _Pf, _Ps, _z, _D = sp.symbols("t P_f P_s z D", real=True)
_form = (_t * _Pf - _Ps) * _z**2 - 2 * _Ps * _D * _z + (1 - _t - _D * _Ps * _D)
_nested = sp.expand((1 - _Ps * (_z + _D) ** 2) - _t * (1 - _Pf * _z**2) - _form)

# --- with Q = 1/P: both conditions are Schur complements of one block, and the other part of it is positive ----------
_Q, _m, _o = sp.symbols("Q m o", positive=True)
_alpha_, _d1 = sp.symbols("alpha_ d_1", positive=True)
_block = sp.Matrix([[_alpha_ / _Q, 0, _m], [0, _d1, _o], [_m, _o, _Q]])
_both = sp.Matrix([[_alpha_ / _Q - _m**2 / _Q, -_m * _o / _Q], [-_m * _o / _Q, _d1 - _o**2 / _Q]])
_turned = sp.simplify(_block.det() - _Q * _both.det())
_turned_other = sp.simplify(_block.det() - _alpha_ / _Q * _d1 * (_Q - _m * _Q * _m / _alpha_ - _o**2 / _d1))
_Qf, _Qs = sp.symbols("Q_f Q_s", positive=True)
_inner = sp.Matrix([[_t / _Qf, 0, 1], [0, 1 - _t, _D], [1, _D, _Qs]])
_form_of = sp.Matrix([[_t / _Qf - 1 / _Qs, -_D / _Qs], [-_D / _Qs, 1 - _t - _D**2 / _Qs]])
_inside = sp.simplify(_inner.det() - _Qs * _form_of.det())
_inside_other = sp.simplify(_inner.det() - _t / _Qf * (1 - _t) * (_Qs - _Qf / _t - _D**2 / (1 - _t)))

# --- about a center: X+ - c of X+ = A X + B (m + r z) ---------------------------------------------------------------
_A, _B, _c, _m, _r, _X = sp.symbols("A B c m r X", real=True)
_centered = sp.expand(
    (_A * _X + _B * (_m + _r * _z) - _c) - (_A * (_X - _c) + (_A * _c - _c + _B * _m) + _B * _r * _z)
)

# --- a center that moves with a steady drift: c + b (s - n), n the middle of its range; the next is s + y -----------
_b, _sigma, _n, _y, _B_s = sp.symbols("b s n y B_s", real=True)
_moving_center = sp.expand(
    (_A * _X + _B * (_m + _r * _z) + _B_s * _sigma - _c - _b * (_sigma + _y - _n))
    - (
        _A * (_X - _c - _b * (_sigma - _n))
        + (_A * _c - _c + _B * _m + _B_s * _n)
        + (_A * _b + _B_s - _b) * (_sigma - _n)
        - _b * _y
        + _B * _r * _z
    )
)

# --- the way in: a wheel in the sliding speed s = v - R w ------------------------------------------------------------
_v, _s, _R, _l, _h, _theta, _tau, _T, _J, _r, _w1, _o = sp.symbols(
    "v s R lambda h theta tau T J r w_1 o", real=True
)
_wheel = (_v - _s) / _R
_error_residual = sp.expand(_R * (_wheel - (1 - _l) * _v / _R) - (_l * _v - _s))
# The observer expected o: r = R (w - o). What it expects next is o + (1 - theta^2)(w - o) + h (tau - T)/J.
_next_expected = _o + (1 - _theta**2) * (_wheel - _o) + _h * (_tau - _T) / _J
_innovation = _R * _w1 - _R * _wheel + _theta**2 * _r - _R * _h * (_tau - _T) / _J
_innovation_residual = sp.expand(_R * (_w1 - _next_expected) - _innovation.subs(_r, _R * (_wheel - _o)))
# A change that goes as 1 - exp(-t/tau) and ends after x tau: the mean over the pulse lacks this part of it.
_x, _t1 = sp.symbols("x t", positive=True)
_lacks = 1 + 1 / _x - 1 / (1 - sp.exp(-_x))
_mean = sp.integrate((1 - sp.exp(-_t1)) / (1 - sp.exp(-_x)), (_t1, 0, _x)) / _x
_lacks_residual = sp.simplify(1 - _mean - _lacks)
_lacks_at_zero = sp.limit(_lacks, _x, 0) - sp.Rational(1, 2)
_lacks_slope = sp.limit((_lacks - sp.Rational(1, 2)) / _x, _x, 0) + sp.Rational(1, 12)
# A pulse for the share y of a room, by a valve with q times the rate of the inversion, goes 1 - (1 - y)^q of it; over
# q y that is the mean of (1 - u)^(q - 1) for u from 0 to y, between 1 and what it is at the largest y.
_y, _q, _rate, _L = sp.symbols("y q r L", positive=True)
_left = sp.Symbol("1 - y", positive=True)
_pulse = -_L * sp.log(_left)
_way_gone = sp.simplify(1 - sp.exp(-_rate * _pulse) - (1 - _left ** (_rate * _L)))
_way_mean = sp.simplify(sp.diff(1 - (1 - _y) ** _q, _y) - _q * (1 - _y) ** (_q - 1))
# The force over the load and mu0 is that of a wheel with both 1 and the stiffness over their product.
_scaled = adhesion.force_of_gradient.subs(adhesion.gradient, adhesion.gradient_of_slip)
_unit = _scaled.subs(
    {
        adhesion.Q: 1,
        adhesion.mu: adhesion.mu / adhesion.mu0,
        adhesion.C: adhesion.C / (adhesion.Q * adhesion.mu0),
    },
    simultaneous=True,
)
_scaled_residual = sp.simplify(_scaled - adhesion.Q * adhesion.mu0 * _unit)
# With F what it is where all of the friction is used, and K s where all of the contact adheres, it is F S(K s/F).
_F, _K, _a, _b = sp.symbols("F K a b", positive=True)
_line_residual = sp.expand(_F * (_a * _K * _s / _F + _b) - (_a * _K * _s + _b * _F))

THEOREMS = (
    Theorem(
        anchor="way-in",
        title="Slip on the way from rolling to the reference",
        statement="A train rolls, and the brake is demanded. Its loop has eight numbers at a sample: the speed v, the "
        "sliding speed s = v - R w, the innovation r of the observer, its friction torque, the braking torque, the "
        "filtered acceleration, the change of v over the last sample, and the supply. Each is enclosed by an affine "
        "form in symbols between -1 and 1, of which two stand for the friction and the supply rate of a strip, and six "
        "for mass, inertia, radius, pads and both valve times, each within a share of the way from its nominal value "
        "to either end of its range; along a strip the supply rate changes in proportion to all of them. What a sample "
        "makes of the forms encloses what it makes of the numbers; if a form of the slip s/v stays below a number, "
        "also between samples, for strips that cover both ranges, no wheel slips more on its way. If the forms of e, "
        "p, N, Y and D lie at a sample in the ellipsoid of a band for the same share, and the supply has what the band "
        "asks for then and when the train gets to each slower window, the wheels stay in the band down to the lowest "
        "speed.",
        hypotheses=(
            "friction and supply rate as stated, six numbers within the stated share, everything else at its nominal "
            "value, and the scale of the train speed found while rolling",
            "the law that is followed is the one that runs, compared at points in doubles",
            "IEEE 754, with exp, log, arctan and square root within 8 units in the last place",
        ),
        sketch="What is not affine is replaced by its secant and the largest distance from it. The friction is F "
        "S(K s/F), with F where all of it is used and K s where all of the contact adheres: along a line a z + b "
        "near S that is a K s + b F, so that F hardly counts while nearly all adheres, whatever mu0 is. Within a "
        "part of a sample Picard's iteration encloses both speeds: rates that hold on all that they can reach in "
        "it, then the rates there with the time as a symbol, whose mean counts. The torque goes from one sample to "
        "the next as the valve does, evenly but for h^2/8 of its second derivative. Where it is open whether a "
        "valve fills or vents, or for how long, the way x is one number from the longest venting to the longest "
        "filling: with the power q of the times of the inversion over those of the valve, filling above 0 and "
        "venting below, its change is q x but for a factor between 1 and (1 - (1 - y)^q)/(q y) at the largest share"
        " y of the room, which is a mean of (1 - u)^(q - 1). A sum of symbols lies in an ellipsoid if the lengths "
        "of center and symbols, in its coordinates, add up to less than 1. The supply lacks at most exp(-r t) of "
        "what it lacked, and t is at least the speed that is lost over the largest deceleration.",
        not_said="Masses, inertias, radii, pads and valve times farther from the nominal ones; noise and dead time.",
        identities=(
            Identity("part of its room that a pulse for the share y goes", _way_gone),
            Identity("it is the integral of q (1 - u)^(q - 1) from 0 to y", _way_mean),
            Identity("R (w - w_r) = lambda v - s", _error_residual),
            Identity("innovation of the next sample", _innovation_residual),
            Identity("what the mean over a pulse lacks of an exponential change", _lacks_residual),
            Identity("it is 1/2 for short pulses", _lacks_at_zero),
            Identity("and falls with x/12", _lacks_slope),
            Identity("the force over load and mu0", _scaled_residual),
            Identity("the force F S(K s/F) along a line S = a z + b", _line_residual),
        ),
        certificates=("slip_way_in",),
    ),
    Theorem(
        anchor="band",
        title="Band of slip of a sampled law with friction-torque observer",
        statement="Let E be an error of the wheel speed beside its reference w_r, about where the loop settles. With "
        "X = (e, p, N, Y, D), e = w - w_r - E, p the error of the observed wheel speed, N and Y h over the inertia of "
        "the law times the deviations of observed friction and seen torque from those that hold the speed w_r + E, D h "
        "times the error of the filtered acceleration of the reference (of exact speeds), one sample makes "
        "X+ = A X + B (m + r z) with -1 <= z <= 1, where m + r z is what disturbs. About a center c that is "
        "X+ - c = A (X - c) + o + B r z, "
        "o = A_c c - c + B_c m: what the valve makes of the change of the torque that is wanted at the center has "
        "numbers of its own. The drift s of the torque that comes from the fading friction lies between bounds about"
        " n, and changes by little from one sample to the next; for a vector b the state less c + b (s - n) goes on "
        "as above, with (A b + B_s - b)(s - n) and b times the rest of what s changes by among what disturbs, n in its "
        "middle and b times the middle of what s changes by taken off o. The friction that moves the torque also makes "
        "the train brake harder: of the drift t of the reference, h times what its acceleration changes by, k s is in "
        "B_s, for any k. What t brings along of other disturbances counts as one with it: by its column of B, those of "
        "the torque, of its mean, of w_r and of the lag of the filtered acceleration go with it."
        " If Q > 0, shares D > 0 and alpha > 0 with alpha + sum D <= 1 make Q - A Q A'/alpha - [o Br] D^-1 [o Br]' "
        "positive definite at the corners of all numbers of a sample, then no sample leads out of that ellipsoid "
        "about c + b (s - n), and w - w_r stays within the root of the first entry of Q around E plus the first "
        "entry of c + b (s - n). If such sets are given for windows of speed, with one E, that of a faster window "
        "inside that of the next slower one, a wheel that is in the set once keeps its slip in the band R (w - "
        "w_r)/v down to the lowest speed.",
        hypotheses=(
            "mass, inertia, radius, pads and valve times do not change; there are sets for each cell of their box",
            "(phi, psi) in the polygon of the range of the mean slope of the friction between E and what the band "
            "reaches, from bounds that are proved in strips of the error for each part of the range of the steepness "
            "k_A C/mu0 over the slip, of all parts that a cell lies in",
            "limits of the state that keep what is wanted within a stated multiple of what a pulse of the whole sample "
            "does, the predicted error within a stated multiple of that at which the braking curve begins, and "
            "friction and torque above zero: there the law is the written one",
            "pressure measured exactly, wheel and train speed within a bound; pulses begin within a bound after the "
            "sample and end in it; the supply has at least a share of the full pressure, and rises by eq. (8); of what "
            "it lacks of that, the cylinder lacks at least a stated multiple of the supply",
            "the slip that is held is constant or c/sqrt(v); beside that it may move within stated bounds, at most at "
            "a stated rate, of which the law knows nothing",
            "drift of torque and reference, and of the error of the filtered acceleration, between their bounds: while "
            "the train slows down, the friction at the reference rises; where the slip falls as c/sqrt(v), the filter "
            "has settled",
            "where the slip is constant, the steady drift from its proved bounds and from enclosures of the derivative "
            "of the friction along the speeds w_r + E for the masses and frictions of the cell, its change from those "
            "of the second derivative and from the jerk; what the reference drifts by beside k s from enclosures of "
            "how much more the friction fades along the reference than along w_r + E; else there is no steady drift, "
            "b = 0, k = 0",
            "the deceleration of the train rises 3/4 to 5/4 times as fast as at that deceleration it would with all "
            "wheels at the reference",
        ),
        sketch="In deviations from the torque that holds the reference, pads, inertia and friction drop out of what "
        "is constant: the observer estimates the torque that explains the motion. What is asked of Q is by Schur "
        "complements that diag(alpha P, D) - [A o Br]' P [A o Br] is positive definite, P = Q^-1, so that the next "
        "state has at most alpha + sum D. A valve that is inverted with wrong times goes the part rho of the wanted "
        "way; a way to the side of that at the center has a rho of this side, and one to the other side counts for "
        "its part of the distance from the center. What a longer pulse changes counts in a mean over the sample only"
        " from its end on, in the true torque as in the one that the law works out: the late share and the share in "
        "the mean torque go together, but for rates of the valve, weights and late pulses. Of a wanted way beyond the "
        "longest pulse the valve goes that pulse, and on the braking curve the pull is less than k e: both are "
        "concave, so that of what is asked beside the center at least the share of the secant from there is left. The "
        "map is affine in (phi, psi), in g, in rho, in that share, and in both other shares, so that a convex function "
        "of its values is largest at corners. Between samples e has the same form with a part of the change of the "
        "torque.",
        not_said="How a wheel gets into the set; what happens where a pulse goes on into the next sample, or with a "
        "brake that is the limit.",
        identities=(
            Identity("phi e - g psi y solves e' = q e - g y", slip_loop.between_residual),
            Identity("a steady change of the slip adds delta psi", slip_loop.moving_residual),
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
            Identity("late share of a rise over the longest pulse", slip_loop.lateness_residual),
            Identity("rate of what a rising supply adds to a pulse that fills", slip_loop.added_residual),
            Identity("what it adds at most", slip_loop.added_bound_residual),
            Identity("late share if what it adds comes last", slip_loop.latest_residual),
            Identity("an error of the measured speeds moves Y* by k h times it", slip_loop.misread_residual),
            Identity(
                "earlier errors of the train speed in its filtered slope count less than the last one",
                slip_loop.earlier_residual,
            ),
            Identity(
                "share of a steady drift in its mean with the same weight", slip_loop.seen_of_drift_residual
            ),
            Identity("share of the last part of a sample with that weight", slip_loop.share_after_residual),
            Identity("error of the filtered acceleration", slip_loop.filter_residual),
            Identity("what the reference drifts by beside k s", slip_loop.lag_beside_residual),
            Identity("a drift t of the reference moves the torque by -t/g", slip_loop.turning_residual),
            Identity("a steady weight differs from its mean by 1/4", slip_loop.even_residual),
            Identity("that of the filter by 1/4 of what it corrects", slip_loop.filtered_residual),
            Identity("one that falls at once, at M, by 2 M (1 - M)", slip_loop.at_once_residual),
            Identity("that is 1/2 less a square", slip_loop.most_aside_residual),
            Identity("rho_a (u - u_c) + rho_c u_c = rho u", slip_loop.about_residual),
            Identity("a longer pulse counts in the mean from its end on", slip_loop.mean_residual),
            Identity("change of the way over that of the wanted one", slip_loop.rate_residual),
            Identity("the length of a pulse is convex over the wanted way", slip_loop.convex_residual),
            Identity(
                "the share that a limit leaves falls with what is asked at the center", slip_loop.own_residual
            ),
            Identity(
                "square of the pull on the braking curve over that at its beginning", slip_loop.curve_residual
            ),
            Identity("that pull is concave", slip_loop.concave_residual),
            Identity("X+ - c of X+ = A X + B (m + r z)", _centered),
            Identity("and of the state less c + b (s - n), with a drift s that changes by y", _moving_center),
            Identity("what the shares and alpha leave of 1", _budget),
            Identity("what lies between an ellipse and one in it", _nested),
            Identity(
                "diag(alpha P, D) - M'PM and the condition on Q are of one block: by its last pivot", _turned
            ),
            Identity("and by its first ones", _turned_other),
            Identity("the same of an ellipse in another: by the last pivot", _inside),
            Identity("and by the first ones", _inside_other),
        ),
        certificates=("slip_band",),
    ),
)
