"""Bounds on the way in that hold for all of its numbers: friction, pulses, filling, and an observer that is cut at 0.

With q the rate at which the slip grows, s' = R q/v, S = (R/v) df/ds, L = -v'/v and a = (s_r - s)/(1 - s_r), time
counted in samples:

Claims: q' = g T' - (1 + kappa (1 + a)) (S q + f_v v') - (1 + a) drag' + L q, so that S q cannot grow beyond what the
torque grows by, where S does not rise with the slip. A pulse of the part l of a sample fills what it would from a
constant supply, and of what the supply rises by in the sample at most l/2 + l^2 h/(12 T_F) of its part of the room.
Of a change the share 1 - l/2 to 1 - l/2 + l^2 h/(12 T_F) is in the mean. While the valve only fills, rate and room at a
torque grow with the supply rate, the rate falls and the room grows with T_F, and the rate has one maximum. An observer
that takes no friction below 0 differs from one that does by bounded numbers.
"""

from functools import partial

import sympy as sp

from derivations import adhesion
from derivations import brake_actuator as brake
from derivations.notation import described, numerator

# --- slip and friction along the motion: s, v and the torque over the time t ----------------------------------------
_s, _v, _R, _g, _kappa, _s_r = sp.symbols("slip speed wheel_radius g kappa s_r", positive=True)
_q, _T, _T_rate, _damped = sp.symbols("growth T T_rate damping", real=True)
_f, _drag = (sp.Function(name, real=True)(_s, _v) for name in ("f", "drag"))
_lost = _kappa * _f + _drag  # by the reference
_aside = (_s_r - _s) / (1 - _s_r)
_fall = _g * _T - (1 + _kappa) * _f - _drag
_growth = _fall - _aside * _lost  # q
_slip_rate, _speed_rate = _R * _q / _v, -_R * _lost / (1 - _s_r)
_slowing = -_speed_rate / _v  # L


def _rate(value: sp.Expr) -> sp.Expr:
    """Rate along the motion of a function of slip, speed and torque, where the slip grows by q."""
    return sp.diff(value, _s) * _slip_rate + sp.diff(value, _v) * _speed_rate + sp.diff(value, _T) * _T_rate


_error = (_s_r - _s) * _v / _R
error_rate_residual = sp.simplify((_rate(_error) + _fall).subs(_q, _growth))
_wheel = (1 - _s) * _v / _R
wheel_rate_residual = numerator(_rate(_wheel) + (1 - _s) * _lost / (1 - _s_r) + _q)
# Without torque the slip stands at this friction: below it q > 0, with any torque, so that the friction rises there.
_free = -_drag * (1 - _s) / (1 - _s_r + _kappa * (1 - _s))
free_residual = sp.simplify(_growth.subs(_T, 0).subs(_f, _free))
_S, _fixed = _R / _v * sp.diff(_f, _s), sp.diff(_f, _v) * _speed_rate  # and f_v v'
friction_rate_residual = sp.expand(_rate(_f) - (_S * _q + _fixed))
growth_rate = (
    _g * _T_rate
    - (1 + _kappa * (1 + _aside)) * (_S * _q + _fixed)
    - (1 + _aside) * _rate(_drag)
    + _slowing * _q
)
growth_rate_residual = numerator(_rate(_growth) - growth_rate)
_resisted = sp.Function("resisted", real=True)(_v)
_whole_drag = _kappa * _damped * (1 - _s) * _v / _R + _resisted
drag_rate = -_kappa * _damped * _q - _slowing * (
    _kappa * _damped * (1 - _s) * _v / _R + _v * sp.diff(_resisted, _v)
)
drag_rate_residual = numerator((_rate(_whole_drag) - drag_rate).doit())
steepness_rate_residual = sp.expand(
    _rate(_S) - (sp.diff(_S, _s) * _slip_rate - _slowing * _v * sp.diff(_S, _v))
)
# Where S does not rise with the slip, S' <= L S_l, the level l = (1 + kappa) S q has l' <= (1 + kappa) S (B - l).
_steep, _S_l, _L, _Ph, _drag_rate = sp.symbols(
    "steepness steepness_rise slowing at_fixed_slip drag_rate", real=True
)
_q_rate = (
    _g * _T_rate - (1 + _kappa * (1 + _aside)) * (_steep * _q + _Ph) - (1 + _aside) * _drag_rate + _L * _q
)
level_bound = (
    _g * _T_rate
    + _q * (_L * (1 + _S_l / _steep) - _kappa * _aside * _steep)
    - (1 + _kappa * (1 + _aside)) * _Ph
    - (1 + _aside) * _drag_rate
)
_level = (1 + _kappa) * _steep * _q
level_residual = numerator(
    (1 + _kappa) * (_steep * _q_rate + _L * _S_l * _q) - (1 + _kappa) * _steep * (level_bound - _level)
)

# --- Polach's curve: f = grip phi S_z(B s/phi) less q_d times the wheel speed ---------------------------------------
_grip, _B, _A, _D, _kA, _kS = sp.symbols(
    "grip gradient_of_slip friction_ratio friction_decay adhesion_reduction slip_reduction", positive=True
)
_z = sp.Symbol("z", positive=True)
_shape = (2 / sp.pi * adhesion.shape).subs({adhesion.gradient: _z, adhesion.kA: _kA, adhesion.kS: _kS})
_u = _s * _v
_phi = (1 - _A) * sp.exp(-_D * _u) + _A
_fading = _D * (1 - _A) * sp.exp(-_D * _u)  # -dphi/du
_here = {_z: _B * _s / _phi}
_slope, _bend = sp.diff(_shape, _z).subs(_here), -sp.diff(_shape, _z, 2).subs(_here)
_lacking = (_shape - _z * sp.diff(_shape, _z)).subs(_here)  # W
_force = _grip * _phi * _shape.subs(_here) - _damped * (1 - _s) * _v / _R
_adhering = _R * _grip * _B * _slope / _v
_sliding = _R * _grip * _fading * _lacking
_held = _R * _grip * _here[_z] ** 2 * _bend * _fading * (1 + _u * _fading / _phi)


def _zero(residual: sp.Expr) -> sp.Expr:
    """The residual, with phi and the arctangent as symbols of their own where it is rational in them."""
    # exp(-D u) and atan(k_S z) are independent of the rest, s and v.
    faded, turned = sp.symbols("faded turned", positive=True)
    plain = residual.subs(sp.exp(-_D * _s * _v), faded)
    plain = plain.replace(sp.atan, lambda _: turned)
    return numerator(plain)


steepness_residual = _zero(_R / _v * sp.diff(_force, _s) - (_adhering - _sliding + _damped))
falling_steepness = _adhering - _D * _u * _sliding + _held  # S_l = -v dS/dv
falling_steepness_residual = _zero(-_v * sp.diff(_adhering - _sliding + _damped, _v) - falling_steepness)
fixed_slip = _grip * _fading * _u * _lacking + _damped * (1 - _s) * _v / _R  # f_v v' over L
fixed_slip_residual = _zero(-_v * sp.diff(_force, _v) - fixed_slip)
lacking_residual = sp.simplify(
    sp.diff(_shape - _z * sp.diff(_shape, _z), _z) + _z * sp.diff(_shape, _z, 2)
)  # W' = -z S_z''
bend_residual = sp.simplify(
    -sp.diff(_shape, _z, 2)
    - 4
    / sp.pi
    * _z
    * (_kA**3 * (3 - (_kA * _z) ** 2) / (1 + (_kA * _z) ** 2) ** 3 + _kS**3 / (1 + (_kS * _z) ** 2) ** 2)
)
# For k_A = 3 k_S, as on wet and slippery rails, -S_z'' is positive: with t = (k_S z)^2 it goes with this.
_t = sp.Symbol("t", positive=True)
_of_t = 27 * (3 - 9 * _t) * (1 + _t) ** 2 + (1 + 9 * _t) ** 3
concave_residual = sp.expand(_of_t - (64 + 162 * (3 * _t + 1) * (_t - sp.Rational(1, 3)) ** 2))

# --- a pulse of the length x over T_F: what is in its mean, and what a rising supply adds ---------------------------
_x, _y, _time, _l, _eta = sp.symbols("x y t pulse over_time", positive=True)
share = 1 / (1 - sp.exp(-_x)) - 1 / _x  # of an exponential change in the mean over its pulse
_mean = sp.integrate(1 - sp.exp(-_time), (_time, 0, _x)) / _x
share_residual = sp.simplify(_mean / (1 - sp.exp(-_x)) - share)
# With y = x/2 it is 1/2 and half of coth y - 1/y, which lies between 0 and y/3.
halved_residual = sp.simplify(
    (share.subs(_x, 2 * _y) - sp.Rational(1, 2) - (sp.coth(_y) - 1 / _y) / 2).rewrite(sp.exp)
)
_above = _y * sp.cosh(_y) - sp.sinh(_y)
_below = sp.sinh(_y) * (1 + _y**2 / 3) - _y * sp.cosh(_y)
above_residual = sp.simplify(sp.diff(_above, _y) - _y * sp.sinh(_y))
below_residual = sp.simplify(sp.diff(_below, _y) - _y / 3 * _above)
bounds_start_residual = sp.Abs(_above.subs(_y, 0)) + sp.Abs(_below.subs(_y, 0))
in_mean = 1 - _l * (1 - share.subs(_x, _l * _eta))
_over_sample = (
    sp.integrate(1 - sp.exp(-_eta * _time), (_time, 0, _l)) + (1 - _l) * (1 - sp.exp(-_eta * _l))
) / (1 - sp.exp(-_eta * _l))
in_mean_residual = sp.simplify(_over_sample - in_mean)
in_mean_most_residual = sp.expand(
    1 - _l * (1 - (sp.Rational(1, 2) + _l * _eta / 12)) - (1 - _l / 2 + _l**2 * _eta / 12)
)
# A supply that rises evenly by the height of T_F at its first rate adds x - 1 + exp(-x): x share(x) of 1 - exp(-x).
_raised = sp.integrate(_time * sp.exp(-(_x - _time)), (_time, 0, _x))
raised_residual = sp.simplify(_raised / (1 - sp.exp(-_x)) - _x * share)
_times = sp.Symbol("r", positive=True)
# Over the square of the pulse that is a mean of exponentials that fall: a third of the last is in the mean at least.
raised_falls_residual = sp.simplify(
    _raised / _x**2 - sp.integrate((1 - _times) * sp.exp(-_x * _times), (_times, 0, 1))
)
# D' = (risen - D)/T_F of what a rising supply adds, in its own time: over t^2 it falls where risen' >= D'.
_added, _risen = (sp.Function(name)(_time) for name in ("D", "Q"))
_D_rate = _risen - _added
_D_bend = sp.diff(_risen, _time) - _D_rate
_falling = 2 * _added - _time * _D_rate  # of D/t^2, times t^3
_falls_by = sp.diff(_falling, _time).subs(sp.diff(_added, _time), _D_rate)
added_falls_residual = sp.expand(
    _falls_by - ((_risen - _time * sp.diff(_risen, _time)) + (_time * _D_rate - _added))
)
added_grows_residual = sp.expand(
    sp.diff(_time * _D_rate - _added, _time).subs(sp.diff(_added, _time), _D_rate) - _time * _D_bend
)
_w, _m = sp.symbols(
    "from_rise m", positive=True
)  # of a change the part w came with the rise, m of the rest is in the mean
_least = 1 - _l * (1 - ((1 - _w) * _m + _w / 3))
in_mean_least_residual = sp.expand(
    _least - (1 - _l / 2 - _l * _w / 6) - _l * (1 - _w) * (_m - sp.Rational(1, 2))
)
# The mean that the law works out, for the same pulse from a constant supply.
_wanted, _power = sp.symbols("u rho", positive=True)
_left = sp.Symbol("1 - u", positive=True)
own_power_residual = sp.simplify(
    1 - sp.exp(-_power * -sp.log(_left)) - (1 - _left**_power)
)  # a pulse -T_a log(1 - u), with rho = T_a/T_F

# --- nothing but filling: V = T' at the torque T, the supply Q = U (1 - exp(-s t)), tau = h/T_F ---------------------
_U, _rate_s, _tau, _V, _r, _torque = sp.symbols("U s tau V r T", positive=True)
_supply = _torque + _V / _tau
_supply_rate = _rate_s * (_U - _supply)
filling_supply_residual = sp.expand(
    brake.rate * (brake.P_max - brake.supply) - sp.diff(brake.supply, brake.t)
)
filling_slope = (_tau * _rate_s * (_U - _torque) - (_rate_s + _tau) * _V) / _V  # dV/dT
filling_slope_residual = sp.simplify(_tau * (_supply_rate - _V) / _V - filling_slope)
faster_supply_residual = sp.simplify(sp.diff(filling_slope, _rate_s) - _tau * (_U - _supply) / _V)
faster_valve_residual = sp.simplify(
    sp.diff(filling_slope, _tau) - (_supply_rate - (_tau - _rate_s) * (_supply - _torque)) / _V
)
_filled_time = sp.Symbol("t", positive=True)
_Q_t = _U * (1 - sp.exp(-_rate_s * _filled_time))
_room_t = sp.Function("room")(_filled_time)
_ahead_of = (_tau - _rate_s) * _room_t - sp.diff(_Q_t, _filled_time)  # keeps its sign: it goes as exp(-tau t)
_room_rate = sp.diff(_Q_t, _filled_time) - _tau * _room_t
faster_valve_sign_residual = sp.simplify(
    sp.diff(_ahead_of, _filled_time).subs(sp.diff(_room_t, _filled_time), _room_rate) + _tau * _ahead_of
)
# It begins at U exp(-s) ((tau - s)(exp(s) - 1) - s), after one sample of an empty cylinder: below 0 if tau <= 1.
_begins = (_ahead_of.subs(_room_t, _Q_t)).subs(_filled_time, 1).doit()
begins_residual = sp.simplify(
    _begins - _U * sp.exp(-_rate_s) * ((_tau - _rate_s) * (sp.exp(_rate_s) - 1) - _rate_s)
)
begins_below_residual = sp.expand(
    ((1 - _rate_s) * (sp.exp(_rate_s) - 1) - _rate_s) - ((1 - _rate_s) * sp.exp(_rate_s) - 1)
)
room_slope = _rate_s * (_U - _torque - _r) / (_tau * _r) - 1  # d room/dT, falls with tau and grows with s
room_slope_residual = sp.simplify((_rate_s * (_U - _torque - _r) - _tau * _r) / (_tau * _r) - room_slope)
_V_t = sp.Function("V")(_filled_time)
_V_rate = _tau * (sp.diff(_Q_t, _filled_time) - _V_t)
one_maximum_residual = sp.simplify(
    sp.diff(_V_rate, _filled_time).subs(sp.diff(_V_t, _filled_time), 0)
    + _tau * _rate_s * sp.diff(_Q_t, _filled_time)
)  # V'' where V' = 0

# --- an observer that takes no friction below 0: what it has less what one that is not cut has ----------------------
_theta, _z_d, _p_d, _m0, _fhat, _cut = sp.symbols(
    "observer_pole cut_before p most_taken observed b", real=True
)
_beta = (1 - _theta) / _theta
_apart = _z_d + _beta * _p_d  # of the friction
_p_next = _theta**2 * (_p_d + _apart)
_friction_next = _apart - (1 - _theta) ** 2 * (_p_d + _apart) + _cut
cut_error_residual = sp.expand(sp.simplify(_p_next - (_theta * _p_d + _theta**2 * _z_d)))
cut_observed_residual = sp.simplify(_friction_next - _beta * _p_next - (_theta * _z_d + _cut))
cut_fades_residual = sp.simplify(
    _friction_next.subs(_cut, 0) - (_theta * _apart + _theta * (1 - _theta) * _z_d)
)
cut_fades_more_residual = sp.expand(
    sp.simplify(
        _apart - _friction_next.subs(_cut, 0) - ((1 - _theta) * _beta * _p_d + (1 - _theta) ** 2 * _z_d)
    )
)
# Before a cut the friction is at least theta times what it was less (1 - theta) m_0, as all inputs are at least -m_0.
_j = sp.Symbol("j", integer=True, nonnegative=True)
_weight = (_j + 1) * _theta**_j
least_ratio_residual = sp.simplify(
    (_weight.subs(_j, _j + 1) - _theta * _weight - _theta ** (_j + 1)) / _theta**_j
)
_most_cut = -(_theta * (_fhat - _apart) - (1 - _theta) * _m0) - (
    _theta * _apart + _theta * (1 - _theta) * _z_d
)
most_cut_residual = sp.expand(
    _most_cut - ((1 - _theta) * _m0 - _theta * _fhat - _theta * (1 - _theta) * _z_d)
)
_z_most, _p_most = _m0 / (1 + _theta), _theta**2 * _m0 / (1 - _theta**2)
most_observed_residual = sp.simplify((1 - _theta) * _m0 + _theta**2 * _z_most - _z_most)
most_error_residual = sp.simplify(_theta**2 * (_p_most + _m0) - _p_most)
together_residual = sp.simplify(_z_most + _beta * _p_most - _m0)

# --- what programs compute: with the parts that occur several times as numbers of their own -------------------------
_used, _faded, _gone, _shaped, _sloped, _bent, _left_out = sp.symbols(
    "used faded gradient shape shape_slope bend lacking", positive=True
)
_adhered, _slipped = (_kA * _gone) ** 2, (_kS * _gone) ** 2
_steps = (
    (_faded, _fading),
    (_used, _phi),
    (_gone, _B * _s / _used),
    (_shaped, _shape.subs(_z, _gone)),
    (_sloped, 2 / sp.pi * (_kA * (1 - _adhered) / (1 + _adhered) ** 2 + _kS / (1 + _slipped))),
    (
        _bent,
        (4 / sp.pi) * _gone * (_kA**3 * (3 - _adhered) / (1 + _adhered) ** 3 + _kS**3 / (1 + _slipped) ** 2),
    ),
    (
        _left_out,
        (2 / sp.pi)
        * (
            2 * _kA * _gone * _adhered / (1 + _adhered) ** 2
            + sp.atan(_kS * _gone)
            - _kS * _gone / (1 + _slipped)
        ),
    ),
)
_slid = _R * _grip * _faded * _left_out
_values = (
    _grip * _used * _shaped - _damped * (1 - _s) * _v / _R,
    _R * _grip * _B * _sloped / _v - _slid + _damped,
    _R * _grip * _B * _sloped / _v
    - _D * _u * _slid
    + _R * _grip * _gone**2 * _bent * _faded * (1 + _u * _faded / _used),
    _grip * _faded * _u * _left_out + _damped * (1 - _s) * _v / _R,
)
_MEANINGS = {
    "slip": "Slip, 0 or more [-]",
    "speed": "Train speed [m/s]",
    "wheel_radius": "Wheel radius [m]",
    "grip": "Torque of the friction mu0 of a wheelset, times h over its inertia [rad/s]",
    "gradient_of_slip": "Gradient of the stress over the slip, for the friction mu0 [-]",
    "friction_ratio": "Least over largest friction [-]",
    "friction_decay": "Decay of the friction over the sliding speed [s/m]",
    "adhesion_reduction": "Reduction in the area of adhesion [-]",
    "slip_reduction": "Reduction in the area of slip [-]",
    "damping": "Damping torque of a wheelset over its speed, times h over its inertia [-]",
    "pulse": "Length of the pulse over the sample time [-]",
    "over_time": "Sample time over the time of the valve [-]",
    "from_rise": "Part of the change that came with the rise of the supply [-]",
    "most_taken": "Largest that was taken out of the observer over a sample since it rested [rad/s]",
    "observed": "Friction that is observed before the cut [rad/s]",
    "cut_before": "What was cut before, in the z of the sample [rad/s]",
    "observer_pole": "Pole of the observer [-]",
    "torque_rate": "True effect of the rate of the torque, g T' [rad/s]",
    "growth": "Rate q at which the slip grows, times v/R [rad/s]",
    "steepness": "Steepness S of the friction over the speed, (R/v) df/ds, above 0 [-]",
    "steepness_rise": "Rise S_l of it, over the relative fall of the speed, 0 or more [-]",
    "slowing": "Relative fall of the speed over a sample [-]",
    "at_fixed_slip": "Rise of the friction at a fixed slip over a sample [rad/s]",
    "drag_rate": "Change of the drag over a sample [rad/s]",
    "kappa": "What the reference loses over the friction that makes it [-]",
    "aside": "(s_r - s)/(1 - s_r) [-]",
}
_function = partial(described, equation="docs/theory.md#bounds-of-ways-in", meanings=_MEANINGS)
_pulled, _beside = sp.symbols("torque_rate aside", real=True)
FUNCTIONS = (
    _function(
        "friction_on_the_way",
        (_s, _v, _R, _grip, _B, _A, _D, _kA, _kS, _damped),
        _values,
        "Friction less damping of a wheel, its steepness, and how they change while it slows down",
        "f [rad/s], S [-], S_l [-], and f_v v' over the relative fall of the speed [rad/s]",
        _steps,
    ),
    _function(
        "level_bound",
        (_pulled, _q, _steep, _S_l, _L, _Ph, _drag_rate, _kappa, _beside),
        level_bound.subs(_g * _T_rate, _pulled).subs(_s, _s_r - _beside * (1 - _s_r)),
        "What (1 + kappa) S q tends to at most, with the rate (1 + kappa) S",
        "B [rad/s]",
    ),
    _function(
        "added_by_rise",
        (_l, _eta),
        _l / 2 + _l**2 * _eta / 12,
        "Part of the first rise of the supply in a sample that a pulse adds, over its part of the room",
        "Part, at most [-]",
    ),
    _function(
        "share_in_mean",
        (_l, _eta, _w),
        (1 - _l / 2 - _l * _w / 6, 1 - _l / 2 + _l**2 * _eta / 12),
        "Share of a change in its mean over the sample",
        "Share, at least and at most [-]",
    ),
    _function(
        "most_cut",
        (_m0, _theta, _fhat, _z_d),
        (1 - _theta) * _m0 - _theta * _fhat - _theta * (1 - _theta) * _z_d,
        "What an observer that takes no friction below 0 is cut by at most, where that is above 0",
        "Cut [rad/s]",
    ),
)
_derived = (_force, _adhering - _sliding + _damped, falling_steepness, fixed_slip)
kernel_residual, kernel_steepness_residual, kernel_falling_residual, kernel_fixed_residual = (
    _zero(value - derived) for value, derived in zip(FUNCTIONS[0].expressions, _derived, strict=True)
)
