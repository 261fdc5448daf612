"""The valve with two time constants: bilinear on average, exact from sample to sample.

Claims: under full supply a sample that fills for a h and vents for b h gives T_a = T_in - (T_in - T) exp(-a h/T_F)
and T+ = T_a exp(-b h/T_V); on average T' = a (T_in - T)/T_F - b T/T_V, which is (14) only for T_F = T_V. The effect of
the duty on T+ over a short sample grows as either time constant falls: a loop that is stable for the slower one in both
places may be unstable.
"""

import sympy as sp

from derivations.brake_actuator import P, P_in, fill, pressure_rate, vent
from derivations.notation import symbols, time

T, T_F, T_V, h = symbols("torque fill_time vent_time period")
a, b = sp.symbols("a b", nonnegative=True)  # shares of the sample
T_in = sp.Symbol("T_in", positive=True)

# --- (9) in torques: T_in is the torque of the supply pressure ------------------------------------------------
rate = pressure_rate.subs({P: T, P_in: T_in, fill: a, vent: b})
_filling = T_in - (T_in - T) * sp.exp(-time / T_F)
filling_residual = sp.simplify(sp.diff(_filling, time) - rate.subs({a: 1, b: 0}).subs(T, _filling))
_venting = T * sp.exp(-time / T_V)
venting_residual = sp.simplify(sp.diff(_venting, time) - rate.subs({a: 0, b: 1}).subs(T, _venting))
filled = _filling.subs(time, a * h)
sampled = _venting.subs(time, b * h).subs(T, filled)
average_residual = sp.simplify(sp.diff(sampled, h).subs(h, 0) - rate)  # for short samples

# --- effect of the duty: fill for d h, vent for the rest -----------------------------------------------------
d = sp.Symbol("d", positive=True)
_of_duty = sampled.subs({a: d, b: 1 - d})
duty_effect = sp.diff(_of_duty, d)
_kept = sp.exp(-(1 - d) * h / T_V)
effect_residual = sp.simplify(
    duty_effect - h * _kept * ((T_in - filled.subs(a, d)) / T_F + filled.subs(a, d) / T_V)
)
short_effect_residual = sp.simplify(sp.diff(duty_effect, h).subs(h, 0) - ((T_in - T) / T_F + T / T_V))
torque_effect_residual = sp.simplify(sp.diff(_of_duty, T) - sp.exp(-d * h / T_F - (1 - d) * h / T_V))

# --- counterexample: feedback of the torque u = u* - K (T - T*)/T_in that is deadbeat for one lag of .3 s ----------
_times = {h: sp.Rational("0.02"), T_in: 1}
_gain = sp.Rational("0.3") / sp.Rational("0.02") - 1  # K = tau/h - 1


def torque_loop_factor(fill_time: sp.Rational, vent_time: sp.Rational, held: sp.Rational) -> sp.Float:
    """Factor by which a deviation of the torque changes in one sample, at the torque ``held`` of T_in = 1."""
    numbers = _times | {T_F: fill_time, T_V: vent_time, T: held}
    duty = sp.nsolve(_of_duty.subs(numbers) - held, d, (0, 1), solver="bisect", prec=30)
    at = numbers | {d: duty}
    return sp.N((sp.diff(_of_duty, T) - _gain * duty_effect).subs(at), 20)


_slow, _fast, _half = sp.Rational("0.3"), sp.Rational("0.08"), sp.Rational(1, 2)
factor_of_slower = torque_loop_factor(_slow, _slow, _half)
factor_of_valve = torque_loop_factor(_slow, _fast, _half)
