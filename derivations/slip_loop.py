"""Sampled loop of observer, surface and valve: in deviations from the torque that holds the slip reference.

With q the secant of the friction over the wheel speed, tau(w) - tau(w_r) = q I (w - w_r), g = (T/T_seen) I^/I, where
T_seen and I^ are torque and inertia as the law has them, and y = T_seen/I^ - t0, t0 = (tau(w_r)/I - w_r')/g the torque
that holds the reference, the wheel obeys e' = q e - g y, e = w - w_r. The observer and the surface know friction,
pads and inertia through t0 alone; in N = h (tau^/I^ - t0 - w_r') and Y = h y constant errors of them drop out.

Claims: between samples e is phi e - g psi y for a constant y. For every course of q between two bounds, (phi, psi) lies
in a convex set whose edges are courses that change once between the bounds; its edges are concave above and convex
below, so that tangents enclose it. The observer takes (e, p, N) to (p+, N+) as below, whatever the wheel did. A valve
that is inverted with wrong times goes the part rho of the wanted way, rho between c = (assumed over true time) and
its value at the longest pulse. The share of the sample that sees the old torque is at most that of a steady rise over
the longest pulse, as late as pulses begin. While the supply rises by (8) a pulse that fills gets more than from the
supply at the sample, by no more than below. An error of a measured speed moves the wanted torque by k times itself, and
the filter of the acceleration shows errors of the train speed at most twice, its first step over h times them.

Errors may be counted from another wheel speed, w_s = w_r + E with a constant E, and torques from the one that holds it:
all of the above stands, with E k added to the wanted torque. What changes steadily is then no disturbance of the same
size: with u_c the wanted change at a center, u = u_c + (u - u_c), and the ways are rho u = rho_a (u - u_c) + rho_c u_c.
"""

from functools import partial

import sympy as sp

from derivations import brake_actuator as brake
from derivations import slip_tracking
from derivations.notation import described, time

h, g, rho, late, seen, phi, psi = sp.symbols("h g rho late seen phi psi", positive=True)
e, p, N, Y, k, a, theta = sp.symbols(
    "error observer_error friction torque gain ahead observer_pole", real=True
)
accel, asked, rise, held, turn, turned, moved, bent, misread = sp.symbols(
    "acceleration_error command_error torque_drift mean_torque_drift reference_drift mean_reference_drift "
    "slip_drift uneven_slip_drift speed_error",
    real=True,
)

# --- between samples: e' = q e - g y --------------------------------------------------------------------------------
q, q1, q2, s, y = sp.symbols("q q_1 q_2 s y", real=True, nonzero=True)
_grown = sp.exp(q * time)
_psi = (_grown - 1) / q
between_residual = sp.simplify(
    sp.diff(_grown * e - g * _psi * y, time) - (q * (_grown * e - g * _psi * y) - g * y)
)
delta = sp.Symbol("delta", real=True)  # slip' v/R, steady
moving_residual = sp.simplify(
    sp.diff(_grown * e + delta * time + delta * (_psi - time), time)
    - (q * (_grown * e + delta * time + delta * (_psi - time)) + delta)
)

# --- one change of q, at the time s before the end: q_1 first, q_2 for s --------------------------------------------
last, first = sp.symbols("last_secant first_secant", real=True, nonzero=True)
span = sp.Symbol("span", positive=True)  # of the last secant, as a share of h
_phi = sp.exp(last * span * h + first * (1 - span) * h)
_psi_per_h = (
    (sp.exp(last * span * h) - 1) / last
    + sp.exp(last * span * h) * (sp.exp(first * (1 - span) * h) - 1) / first
) / h
slope = (1 - sp.exp(-first * (1 - span) * h)) / (first * h)  # of psi/h over phi along the edge
slope_residual = sp.simplify(sp.diff(_psi_per_h, span) - slope * sp.diff(_phi, span))
# The slope falls while the share of the last secant grows: with the larger secant last phi rises, the edge is concave;
# with the smaller one last phi falls, it is convex.
bend_residual = sp.simplify(sp.diff(slope, span) + sp.exp(-first * (1 - span) * h))
run_residual = sp.simplify(sp.diff(_phi, span) - (last - first) * h * _phi)

# --- observer and surface, in numbers of the law --------------------------------------------------------------------
J, w_r, w_r1, rate, T_h, tau_h, T_m, w = sp.symbols(
    "J w_r w_r1 rate T_h tau_h T_m w", real=True
)  # rate: w_r'
_t0 = sp.Symbol("t_0", real=True)
_e1 = sp.Symbol("e_1", real=True)  # error at the next sample, whatever made it
_observed = w_r + e + p  # what the observer has for w
_friction = J * (N / h + _t0 + rate)
_torque = J * (Y / h + _t0)
_known_rate = rate - accel / h  # what the law has for w_r'
_ahead = e + a * h * ((_friction - _torque) / J - _known_rate)
_wanted = _friction - J * (_known_rate - k / h * _ahead)
wanted = N + k * (e + a * (N - Y + accel)) + accel  # Y*
wanted_residual = sp.expand(h * (_wanted / J - _t0) - wanted)
_misread_by = sp.Symbol("misread_by", real=True)  # of w - w_r, as it is measured
misread_residual = sp.expand(wanted.subs(e, e + _misread_by) - wanted - k * _misread_by)

way = sp.Symbol("way", real=True)  # Y* - Y
went = way + asked  # what dead band, shortest pulse and errors of measured speeds make of it
_mean = J * ((Y + seen * went) / h + _t0)  # of the torque over the sample, as the law works it out
_expected = _observed + h / J * (_friction - _mean)
_true = w_r1 + _e1
_r = _true + misread - _expected
innovation = _e1 + misread - e - p - N + Y + seen * went + turned - moved
_reference = {w_r1: w_r + h * rate + turned - moved}
innovation_residual = sp.expand((_r - innovation).subs(_reference))
_observer_next = _expected + (1 - theta**2) * _r - _true
_friction_next = h * ((_friction + (1 - theta) ** 2 * J / h * _r) / J - (_t0 + rise / h) - (rate + turn / h))
observer_next = -(theta**2) * innovation + misread
friction_next = N + (1 - theta) ** 2 * innovation - rise - turn
observer_residual = sp.expand((_observer_next - observer_next).subs(_reference))
friction_residual = sp.expand((_friction_next - friction_next).subs(_reference))

# --- the valve: T goes the part rho of the way to T* -----------------------------------------------------------------
_step = rho * went
torque_next = Y + _step - rise
error_next = phi * e - g * psi * (Y + (1 - late) * _step - held) + moved + bent
x, c, u = sp.symbols("x c u", positive=True)
part = (1 - x**c) / (1 - x)  # with x = (T_in - T*)/(T_in - T), or T*/T
longest = sp.Symbol("longest", positive=True)
part_of_pulse = part.subs(x, sp.exp(-longest))  # x at the end of a pulse, its length over the assumed time
part_residual = sp.simplify(sp.integrate(c * u ** (c - 1), (u, x, 1), conds="none") - part * (1 - x))

# --- changes about the wanted change u_c at a center: rho_a (u - u_c) + rho_c u_c is rho u, with rho_a = rho_c = rho
# where u and u_c have one sign; where u has the other one, with a rho_a between those of both sides -------------------
_u, _u_c, _rho_u, _rho_c = sp.symbols("u u_c rho_u rho_c", real=True)
_weight_of_u = _u / (_u - _u_c)  # between 0 and 1 where u and u_c have opposite signs
_rho_a = _weight_of_u * _rho_u + (1 - _weight_of_u) * _rho_c
about_residual = sp.simplify(_rho_a * (_u - _u_c) + _rho_c * _u_c - _rho_u * _u)

# --- what grows with what is asked, evenly up to 1 and less beyond: ways up to the longest pulse, which is all that the
# valve has, and the pull on the braking curve, sqrt(2 c - 1) at c times the error and over the pull at its beginning.
# Both are concave, so that from a point below 1 at least the share of the secant to the largest one is left -----------
left, beyond, own = sp.symbols("left beyond own", real=True)
share_left = (left - own) / (beyond - own)
own_residual = sp.simplify(sp.diff(share_left, own) + (beyond - left) / (beyond - own) ** 2)
_slew, _rate, _times = sp.symbols("slew rate_of_pull times", positive=True)
_begins = _slew / _rate**2
_square = slip_tracking.curve_square.subs(
    {slip_tracking.e: _times * _begins, slip_tracking.k: _rate, slip_tracking.s: _slew}, simultaneous=True
)
curve_residual = sp.simplify(_square / (_rate * _begins) ** 2 - (2 * _times - 1))
concave_residual = sp.simplify(
    sp.diff(sp.sqrt(2 * _times - 1), _times, 2) + (2 * _times - 1) ** sp.Rational(-3, 2)
)

# --- the mean torque that the law works out: a pulse of the length P over h, of the room or of the torque to vent -----
P, T_n, T_a = sp.symbols(
    "P T_n T_a", positive=True
)  # T_n: nominal time, T_a: the one that the inversion assumes
_gone = 1 - sp.exp(-P * h / T_n)
_in_mean = sp.integrate(1 - sp.exp(-u * h / T_n), (u, 0, P)) + _gone * (1 - P)
mean_residual = sp.simplify(sp.diff(_in_mean, P) - (1 - P) * sp.diff(_gone, P))
_asked_for = 1 - sp.exp(-P * h / T_a)
rate = (T_a / T_n) * sp.exp(
    (1 - T_a / T_n) * P * h / T_a
)  # of the way over the wanted one, at the end of the pulse
rate_residual = sp.simplify(sp.diff(_gone, P) - rate * sp.diff(_asked_for, P))
_length = -T_a / h * sp.log(1 - u)  # of the pulse that is wanted, over the part of the room: convex
convex_residual = sp.simplify(sp.diff(_length, u, 2) - T_a / h / (1 - u) ** 2)

# --- what a supply that rises by (8) adds to a pulse that fills: D' = (what the supply has risen by - D)/T_F, so that D
# is at most as if the supply rose at its first rate and D did not hold it back; a pulse that begins late sees it later.
# A pulse over T_F of x goes at least the part x - x^2/2 of the room, a share "room" of what the supply lacks ----------
_begun = brake.supply.subs(brake.t, brake.t0)
_added = brake.filled - (_begun + (brake.P0 - _begun) * brake.fading)
_risen = (brake.P_max - _begun) * (1 - sp.exp(-brake.rate * (brake.t - brake.t0)))
added_residual = sp.simplify(sp.diff(_added, brake.t) - (_risen - _added) / brake.T_F)
pulse = sp.Symbol("pulse", positive=True)  # its length over h
delay = sp.Symbol("delay", nonnegative=True)  # until it begins, over h
rising, filling = sp.symbols("supply_rate fill_time", positive=True)
room = sp.Symbol("room", positive=True)
_gained = sp.integrate(rising * (u + delay * h) / filling, (u, 0, pulse * h))  # over what the supply lacks
_x = pulse * h / filling
added = rising * h * (delay + pulse / 2) / (room * (1 - _x / 2))
added_bound_residual = sp.simplify(_gained / (room * (_x - _x**2 / 2)) - added)
_more = sp.Symbol("more", positive=True)  # what is added, at worst when the sample is over
latest_residual = sp.simplify((1 - (late + _more) / (1 + _more)) * (1 + _more) - (1 - late))

# --- errors of the measured train speed in its filtered slope, a <- a + (1 - kept) ((v - v before)/h - a): the last one
# counts (1 - kept)/h, those of up to count samples ago sum up to less, whatever their signs ---------------------------
_kept = kept = sp.Symbol("kept", positive=True)  # below 1
lag, lag_drift = sp.symbols("lag lag_drift", real=True)
_count, _j = sp.symbols("count j", integer=True, positive=True)
_d, _jerk, _gone_by = sp.symbols("d jerk gone_by", real=True)
_filtered = (
    (1 - (1 - _kept)) * _d + h * _jerk - (1 - _kept) * h * _jerk / 2
)  # v' - a, while v' changes steadily
_weighed = sp.integrate(_jerk * (1 - (1 - _kept) * (1 - _gone_by / h)), (_gone_by, 0, h))  # or in any way
filter_residual = sp.simplify(_filtered - (_kept * _d + _weighed))
# What it, or the reference, drifts by beside k s, while the train loses y h a sample and the held torque moves by s.
_y, _g, _k, _force, _more_force, _turned, _weight_torque, _damped, _resisted, _times = sp.symbols(
    "y g k F delta T W d_w r_w j", real=True
)
_steady = -h * _y * (_weight_torque * _g * _force - _damped)
_lag_moves = h * _y * _times * _turned * (_g * (_force + _more_force) + _resisted)
_rising = _g * (_force + _more_force) + _resisted
_together = (_times * _turned + _k * _weight_torque) * _rising
_together -= _k * _weight_torque * (_g * _more_force + _resisted)
lag_beside_residual = sp.expand(_lag_moves - _k * _steady - h * _y * (_together - _k * _damped))
_earlier = sp.summation((1 - _kept) * (_kept ** (_j - 1) - _kept**_j), (_j, 1, _count))
earlier_residual = sp.simplify(_earlier - (1 - _kept) * (1 - _kept**_count))

# --- what a drift of the reference brings along: of the torque that holds it, and of what weighs w_r'' in a sample ---
_I, _pads, _tau, _more_rate, _mean = sp.symbols("I pads tau more_rate mean", positive=True)


def _held_at(rotation: sp.Expr) -> sp.Expr:
    """Torque that holds a reference that turns faster and faster, as the law counts it."""
    return (_tau - _I * rotation) / (_pads * J)


turning_residual = sp.simplify(
    h * (_held_at(rate + _more_rate) - _held_at(rate)) + h * _more_rate / (_pads * J / _I)
)


def _aside(weight: sp.Expr, crossing: sp.Expr) -> sp.Expr:
    """Mean of how far a weight lies from its mean, which it falls or rises to at a part of the sample."""
    differs = weight - sp.integrate(weight, (u, 0, 1))
    return sp.integrate(differs, (u, 0, crossing)) - sp.integrate(differs, (u, crossing, 1))


even_residual = sp.simplify(_aside(1 - u, sp.Rational(1, 2)) - sp.Rational(1, 4))
filtered_residual = sp.simplify(-_aside(1 - (1 - _kept) * (1 - u), sp.Rational(1, 2)) - (1 - _kept) / 4)
# A weight that falls from 1 to 0 and is above its mean M up to c lies beyond that by at most c (1 - M) there, and by
# M (1 - c): together at most as one that falls at once, at M.
_at_once = sp.integrate(1 - _mean, (u, 0, _mean)) + sp.integrate(_mean, (u, _mean, 1))
at_once_residual = sp.expand(_at_once - 2 * _mean * (1 - _mean))
most_aside_residual = sp.expand(
    sp.Rational(1, 2) - 2 * _mean * (1 - _mean) - 2 * (_mean - sp.Rational(1, 2)) ** 2
)

# --- the share of a rise that is still to come, weighted by exp(q (h - t)); it is steady and ends with the pulse ------
m = sp.Symbol("m", real=True, nonzero=True)  # q h
_weight = sp.exp(m * (1 - u))
lateness = (1 - sp.exp(-delay * m) * (1 - sp.exp(-pulse * m)) / (pulse * m)) / (1 - sp.exp(-m))
lateness_residual = sp.simplify(
    sp.integrate(_weight, (u, 0, delay))
    + sp.integrate((1 - (u - delay) / pulse) * _weight, (u, delay, delay + pulse))
    - lateness * sp.integrate(_weight, (u, 0, 1))
)
part_left = sp.Symbol("part_left", positive=True)  # of the sample
share_after = (sp.exp(m * part_left) - 1) / (sp.exp(m) - 1)
share_after_residual = sp.simplify(
    sp.integrate(_weight, (u, 1 - part_left, 1)) - share_after * sp.integrate(_weight, (u, 0, 1))
)
seen_of_drift = 1 - lateness.subs(
    {pulse: 1, delay: 0}
)  # share of a steady drift in its mean with the same weight
seen_of_drift_residual = sp.simplify(
    sp.integrate(u * _weight, (u, 0, 1)) - seen_of_drift * sp.integrate(_weight, (u, 0, 1))
)

_STATE = {
    "error": "Deviation e of the wheel speed from its reference [rad/s]",
    "observer_error": "Observed wheel speed minus the true one, p [rad/s]",
    "friction": "Deviation N of the observed friction torque, times h over the inertia of the law [rad/s]",
    "torque": "Deviation Y of the torque that the law sees, times h over the inertia of the law [rad/s]",
    "lag": "Error D of the filtered acceleration of the reference, times h [rad/s]",
    "kept": "Part of it that the filter keeps over a sample [-]",
    "lag_drift": "What the change of the acceleration adds to it over the sample [rad/s]",
    "gain": "Gain k of the surface times h [-]",
    "ahead": "Share of a sample by which the error is predicted [-]",
    "acceleration_error": "Error of the acceleration of the reference that the law has, D and more, times h [rad/s]",
    "phi": "What becomes of an error within the sample without torque [-]",
    "psi": "What a torque contributes within the sample, over h [-]",
    "g": "True over assumed effect of the torque, (T/T_seen) (assumed/true inertia) [-]",
    "rho": "Part of the wanted way that the valve goes [-]",
    "late": "Share of the sample that sees the torque before the pulse [-]",
    "seen": "Share of the wanted way in the mean torque that the law works out [-]",
    "observer_pole": "Pole theta of the observer [-]",
    "way": "Y* - Y, the change of the torque that is wanted [rad/s]",
    "command_error": "What dead band, shortest pulse and errors of measured speeds add to the wanted change [rad/s]",
    "speed_error": "Measured wheel speed at the end of the sample minus the true one [rad/s]",
    "torque_drift": "Change of h t0 over the sample [rad/s]",
    "mean_torque_drift": "Its weighted mean over the sample [rad/s]",
    "reference_drift": "Change of h w_r' over the sample [rad/s]",
    "mean_reference_drift": "Change of w_r over the sample beyond h w_r' at a fixed slip [rad/s]",
    "slip_drift": "What the change of the slip takes off w_r over the sample, D [rad/s]",
    "uneven_slip_drift": "What more it adds to the error, because an error grows or fades within the sample [rad/s]",
    "last_secant": "Secant in the last part of the sample, not 0 [1/s]",
    "first_secant": "Secant in the first part, not 0 [1/s]",
    "span": "Share of the sample that is the last part [-]",
    "h": "Sample time [s]",
    "c": "Assumed over true time of the valve [-]",
    "longest": "Longest pulse over the assumed time of the valve [-]",
    "m": "Secant times sample time, not 0 [-]",
    "pulse": "Longest pulse over the sample time [-]",
    "part_left": "Part of the sample that is left [-]",
    "delay": "Time from the sample to the latest beginning of a pulse, over the sample time [-]",
    "supply_rate": "Rate of the supply, eq. (8) [1/s]",
    "fill_time": "Time constant of filling [s]",
    "beyond": "What is asked at most, over that up to which all of it is left, above 1 [-]",
    "left": "What is left of it, over the same [-]",
    "own": "What is asked at the center, over the same, below 1 [-]",
    "room": "Least room above the cylinder over what the supply lacks of its final value [-]",
}


_function = partial(described, equation="docs/theory.md#band", meanings=_STATE)

FUNCTIONS = (
    _function(
        "wanted_torque",
        (e, N, Y, k, a, accel),
        wanted,
        "Deviation Y* of the torque that the law wants",
        "Y* [rad/s]",
    ),
    _function(
        "next_sample",
        (
            *(e, p, N, Y, lag, way, phi, psi, g, rho, late, seen, theta, kept),
            *(asked, rise, held, turn, turned, moved, bent, misread, lag_drift),
        ),
        (
            error_next,
            observer_next.subs(_e1, error_next),
            friction_next.subs(_e1, error_next),
            torque_next,
            kept * lag + lag_drift,
        ),
        "State of the loop one sample later",
        "e, p, N, Y and D [rad/s]",
    ),
    _function(
        "switched_slide",
        (last, first, span, h),
        (_phi, _psi_per_h, slope),
        "Numbers of a sample in which the secant changes once",
        "phi, psi/h, and the slope of psi/h over phi along the edge that such samples form",
    ),
    _function(
        "part_of_way",
        (c, longest),
        part_of_pulse,
        "Part of the wanted way that the valve goes with the longest pulse; with the shortest it is c",
        "Part [-]",
    ),
    _function(
        "lateness",
        (m, pulse, delay),
        lateness,
        "Largest share of the sample that can see the torque before the pulse",
        "Share [-]",
    ),
    _function(
        "share_after",
        (m, part_left),
        share_after,
        "Share of a change that is there for the last part of the sample, with the weight of an error that grows",
        "Share [-]",
    ),
    _function(
        "added_by_supply",
        (rising, filling, h, pulse, delay, room),
        added,
        "Largest way that a rising supply adds to a pulse that fills, over the way that it goes without",
        "Share [-]",
    ),
    _function(
        "share_left",
        (left, beyond, own),
        share_left,
        "Least share of what is asked beside a center that a concave limit leaves",
        "Share [-]",
    ),
)
