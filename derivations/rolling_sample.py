"""One sample of the way in for all numbers at once: motion, observer, curve and valve in means over the samples.

Rates of the wheel speed and torques are in rad/s per sample: a torque that the law has counts with h over its inertia
J. With means over the sample of the creep force, the wheel speed and the resistance, f is the friction less the damping
of the wheel, D = kappa f + drag what the reference w_r loses, g the true over the assumed effect of a torque. The
torque changes by c, of which lambda c is in its mean; the law takes chi lambda c for that. In

    y = g T - (1 + kappa) f - drag, by which the error E = w - w_r would fall at the torque T,
    p = observed less true wheel speed, z = fhat - f + (g - 1) T - beta p, beta = (1 - theta)/theta,
    e = K + D, K the filtered change of the reference, x = T* - T, T* = fhat + P - K, P the pull to the predicted error,

one sample makes the map below of means Df and D(drag) of the changes, whatever friction and speeds do in it.

Claims: the map follows from the observer, the target, the filter and Newton's laws; y = P - x + z + beta p - e; what
the observer and the filter have is a sum over all samples before.
"""

from functools import partial

import sympy as sp

from derivations import friction_observer as observer
from derivations import motion
from derivations import slip_tracking as tracking
from derivations.notation import described, numerator

theta, kept, ahead, steep, g, kappa = sp.symbols("observer_pole kept ahead pull_slope g kappa", positive=True)
y, z, p, e, x, P = sp.symbols("fall observed observer_error lag way pull", real=True)
c, in_mean, own, apart = sp.symbols("change in_mean own means_apart", real=True)
friction_change, drag_change, part = sp.symbols("friction_change drag_change part", real=True)
beta, quick = (1 - theta) / theta, (1 - theta) ** 2

# --- the map --------------------------------------------------------------------------------------------------------
means_apart = in_mean * c * (g - own)
fall = P - x + z + beta * p - e
learned = (1 - kept) * e - quick * (z + p / theta + apart)
fall_next = y + g * c - (1 + kappa) * friction_change - drag_change
observed_next = theta * z - friction_change + (g - 1) * c - (1 - theta) * apart
error_next = theta * p + theta**2 * (z + apart)
lag_next = kept * e + kappa * friction_change + drag_change
pull_change = -(y + g * in_mean * c) + ahead * (learned - c)  # over the slope of the curve
_gained = 1 + steep * ahead
_beside = (
    ((1 - kept) * _gained + steep) * e
    - (quick * _gained + steep) * z
    - (quick / theta * _gained + steep * beta) * p
    - quick * _gained * apart
    - steep * P
)
_of_change = 1 + steep * (g * in_mean + ahead)
way_next = (1 + steep) * x - _of_change * c + _beside
way_next_of_part = (1 + steep - part * _of_change) * x + _beside
learned_residual = sp.expand(
    way_next - (x - c + learned + steep * pull_change.subs(y, fall))
)  # of the same map, each state once
part_residual = sp.expand(way_next.subs(c, part * x) - way_next_of_part)

# --- Newton: what wheel and reference change by over a sample, from means -------------------------------------------
h, J, inertia, R, m, R_law, pads, slip, damping = sp.symbols(
    "h J I R m R_law pads slip damping", positive=True
)
T, tau, w, v, told_acceleration = sp.symbols("T tau w v a", real=True)  # as the law and the train have them
_forces, _speeds, _resistances = (sp.symbols(f"{name}_0 {name}_1", real=True) for name in ("F", "w_m", "f_d"))
_g = pads * J / inertia
_kappa = (1 - slip) * 4 * inertia / (R**2 * m)


def _friction(sample: int) -> sp.Expr:
    """Friction less damping over a sample."""
    return h / inertia * 2 * (R * _forces[sample] - damping * _speeds[sample])


def _drag(sample: int) -> sp.Expr:
    """What the reference loses beside kappa f."""
    damped = _kappa * 2 * damping * h / inertia * _speeds[sample]
    return damped + (1 - slip) * h * _resistances[sample] / (R * m)


def _train_change(sample: int) -> sp.Expr:
    """Change of the train speed over a sample."""
    return h * motion.train_acceleration.subs(
        {motion.f: _forces[sample], motion.f_d: _resistances[sample], motion.m: m}, simultaneous=True
    )


def _lost(sample: int) -> sp.Expr:
    """What the reference loses over a sample."""
    return -(1 - slip) / R * _train_change(sample)


reference_residual = numerator(_lost(0) - (_kappa * _friction(0) + _drag(0)))
_true_mean = pads * (T + J / h * in_mean * c)
_wheel_change = h * motion.wheel_acceleration.subs(
    {
        motion.f: _forces[0],
        motion.T: _true_mean,
        motion.omega: _speeds[0],
        motion.inertia: inertia / 2,  # of one wheel of the wheelset
        motion.B_W: damping,
        motion.R: R,
    },
    simultaneous=True,
)
_torque = h / J * T
wheel_residual = numerator(_wheel_change - (_friction(0) - _g * (_torque + in_mean * c)))

# --- the law: a measurement of the next sample, then what it asks for -----------------------------------------------
_measured = {
    observer.omega: w + _wheel_change,
    observer.w: w + p,
    observer.tau: tau,
    observer.T_m: T + J / h * own * in_mean * c,
    observer.J: J,
    observer.h: h,
    observer.theta: theta,
}
_observed_speed, _tau_next = (
    each.subs(_measured, simultaneous=True)
    for each in (observer.corrected_speed, observer.corrected_friction)
)
_told = R_law / R  # of the train speed, from rolling wheels
_acceleration_next = told_acceleration + (1 - kept) * (_told * _train_change(0) / h - told_acceleration)


def _reference_rate(acceleration: sp.Expr) -> sp.Expr:
    """Acceleration of the reference as the law has it."""
    return tracking.reference_acceleration.subs(
        {tracking.v_rate: acceleration, tracking.slip: slip, tracking.slope: 0, tracking.R: R_law}
    )


def _asked(friction: sp.Expr, acceleration: sp.Expr, pull: sp.Expr) -> sp.Expr:
    """Torque that the law asks for, times h/J."""
    target = tracking.target_torque.subs(
        {
            tracking.tau: friction,
            tracking.w_rate: _reference_rate(acceleration),
            tracking.y: pull / h,
            tracking.J: J,
        }
    )
    return h / J * target


def _predicted(error: sp.Expr, friction: sp.Expr, torque: sp.Expr, acceleration: sp.Expr) -> sp.Expr:
    """Error that the pull goes by."""
    return tracking.predicted_error.subs(
        {
            tracking.e: error,
            tracking.tau: friction,
            tracking.T: torque,
            tracking.w_rate: _reference_rate(acceleration),
            tracking.J: J,
            tracking.h: h,
            tracking.a: ahead,
        },
        simultaneous=True,
    )


_T_next = T + J / h * c
_error = w - (1 - slip) * v / R
_error_next = _error + _wheel_change + _lost(0)
_p_next = _observed_speed - w - _wheel_change
_ahead_of = _predicted(_error, tau, T, told_acceleration)
_ahead_next = _predicted(_error_next, _tau_next, _T_next, _acceleration_next)
_P_next = P + steep * (_ahead_next - _ahead_of)


def _state(
    sample: int, friction: sp.Expr, torque: sp.Expr, observed: sp.Expr, acceleration: sp.Expr, pull: sp.Expr
) -> tuple[sp.Expr, ...]:
    """y, z, p, e and x of a sample in numbers of plant and law."""
    counted, seen = h / J * torque, h / J * friction
    return (
        _g * counted - (1 + _kappa) * _friction(sample) - _drag(sample),
        seen - _friction(sample) + (_g - 1) * counted - beta * observed,
        observed,
        h * _reference_rate(acceleration) + _lost(sample),
        _asked(friction, acceleration, pull) - counted,
    )


_now = _state(0, tau, T, p, told_acceleration, P)
_then = _state(1, _tau_next, _T_next, _p_next, _acceleration_next, _P_next)
_as_numbers = dict(zip((y, z, e, x), (_now[0], _now[1], _now[3], _now[4]), strict=True)) | {
    g: _g,
    kappa: _kappa,
    friction_change: _friction(1) - _friction(0),
    drag_change: _drag(1) - _drag(0),
}


def _left(claimed: sp.Expr, true: sp.Expr) -> sp.Expr:
    """What a claim in the states leaves over in numbers of plant and law."""
    with_means = claimed.subs(apart, means_apart)
    return numerator(with_means.subs(_as_numbers, simultaneous=True) - true)


fall_residual = _left(fall, _now[0])
error_fall_residual = _left(-(y + g * in_mean * c), _error_next - _error)
predicted_residual = _left(ahead * (x - P), _ahead_of - _error)
predicted_change_residual = _left(pull_change, _ahead_next - _ahead_of)
fall_next_residual = _left(fall_next, _then[0])
observed_next_residual = _left(observed_next, _then[1])
error_next_residual = _left(error_next, _then[2])
lag_next_residual = _left(lag_next, _then[3])
way_next_residual = _left(way_next, _then[4])
# What the error falls by and what is observed of it: the friction in between counts with kappa only.
unseen_residual = sp.expand(
    (observed_next - fall_next)
    - (theta * (z - y) - (1 - theta) * y - c + kappa * friction_change - (1 - theta) * apart + drag_change)
)

# --- sums over the samples before: what is put in is the change of the wheel speed and the mean torque of the law ---
_j = sp.symbols("j", integer=True, nonnegative=True)
_fhat, _in, _in_next, _K, _D = sp.symbols("fhat in_0 in_1 K D_0", real=True)


def _observe(error: sp.Expr, friction: sp.Expr, put_in: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Error and friction of the observer one sample later."""
    innovation = put_in - error - friction
    return -(theta**2) * innovation, friction + quick * innovation


_put_in = {_in: _wheel_change + h / J * _measured[observer.T_m], _fhat: h / J * tau}
_once = _observe(p, _fhat, _in)
_twice = _observe(*_once, _in_next)
put_in_residual = numerator(_once[1].subs(_put_in, simultaneous=True) - h / J * _tau_next)
put_in_error_residual = numerator(_once[0].subs(_put_in, simultaneous=True) - _p_next)
friction_sum_residual = sp.expand(_twice[1] - 2 * theta * _once[1] + theta**2 * _fhat - quick * _in_next)
error_sum_residual = sp.expand(_twice[0] - 2 * theta * _once[0] + theta**2 * p + theta**2 * (_in_next - _in))
weight = (_j + 1) * theta**_j  # of what was put in 1 + j samples ago; (1 - theta)^2 of it in fhat
weight_residual = sp.simplify(
    (weight.subs(_j, _j + 2) - 2 * theta * weight.subs(_j, _j + 1) + theta**2 * weight) / theta**_j
)
first_weights_residual = sp.Abs(weight.subs(_j, 0) - 1) + sp.Abs(
    sp.expand(weight.subs(_j, 1) - 2 * theta * weight.subs(_j, 0))
)
_many = (
    1 - (_j + 1) * theta**_j + _j * theta ** (_j + 1)
)  # of the weight of j samples, over (1 - theta)^-2: below 1
many_residual = sp.simplify((_many.subs(_j, _j + 1) - _many - quick * weight) / theta**_j)
_K_next = h * _reference_rate(_acceleration_next)
filter_sum_residual = numerator(
    _K_next - (kept * h * _reference_rate(told_acceleration) - (1 - kept) * _lost(0))
)
asked_residual = numerator(
    _now[4] - P - (h / J * tau - _torque - h * _reference_rate(told_acceleration))
)  # x - P = fhat - T - K

_MEANINGS = {
    "fall": "Fall y of the error of the wheel speed over the sample, but for the change of the torque [rad/s]",
    "observed": "What the observer has beside that which explains the motion, z [rad/s]",
    "observer_error": "Observed wheel speed minus the true one, p [rad/s]",
    "lag": "Filtered change of the reference over a sample, less its true one, e [rad/s]",
    "way": "Change x = T* - T of the torque that is wanted, times h over the inertia of the law [rad/s]",
    "pull": "Fall P of the predicted error that is asked for over a sample [rad/s]",
    "change": "Change c of the torque over the sample, times h over the inertia of the law [rad/s]",
    "part": "Part of the wanted way that the torque goes, c/x [-]",
    "in_mean": "Share lambda of the change in the mean of the torque over the sample [-]",
    "own": "What the law takes for the change in the mean, over that, chi [-]",
    "means_apart": "What a change does in the mean beyond what the law takes it for, d [rad/s]",
    "friction_change": "Mean friction less damping of the next sample, less that of this one [rad/s]",
    "drag_change": "Mean drag of the next sample, less that of this one [rad/s]",
    "g": "True over assumed effect of the torque [-]",
    "kappa": "What the reference loses over the friction that makes it, kappa [-]",
    "observer_pole": "Pole theta of the observer [-]",
    "kept": "Part of its error that the filter of the acceleration keeps over a sample [-]",
    "ahead": "Share of a sample by which the error is predicted [-]",
    "pull_slope": "Change of the pull over that of the predicted error, between its slopes at both [-]",
}
_function = partial(described, equation="docs/theory.md#all-ways-in", meanings=_MEANINGS)

FUNCTIONS = (
    _function(
        "fall_of_error",
        (z, p, e, x, P, theta),
        fall,
        "Fall of the error over a sample, but for the change of the torque",
        "y [rad/s]",
    ),
    _function(
        "unlike_means",
        (c, in_mean, own, g),
        means_apart,
        "What a change of the torque does in the mean beyond what the law takes it for",
        "d [rad/s]",
    ),
    _function(
        "learned",
        (z, p, e, apart, theta, kept),
        learned,
        "Change of the wanted torque by what observer and filter learn in a sample",
        "Change, without that of the pull [rad/s]",
    ),
    _function(
        "next_sample",
        (
            *(y, z, p, e, x, P, c, in_mean, apart, friction_change, drag_change),
            *(g, kappa, theta, kept, ahead, steep),
        ),
        (fall_next, observed_next, error_next, lag_next, way_next),
        "State of the way in one sample later",
        "y, z, p, e and x [rad/s], affine in each argument but observer_pole",
    ),
    _function(
        "next_way",
        (z, p, e, x, P, c, in_mean, apart, g, theta, kept, ahead, steep),
        way_next,
        "Wanted change of the torque one sample later",
        "x [rad/s], affine in each argument but observer_pole",
    ),
    _function(
        "next_way_of_part",
        (z, p, e, x, P, part, in_mean, apart, g, theta, kept, ahead, steep),
        way_next_of_part,
        "Wanted change of the torque one sample later, where the torque goes a part of it",
        "x [rad/s], affine in each argument but observer_pole",
    ),
)
