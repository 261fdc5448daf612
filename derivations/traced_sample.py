"""One sample of a wheelset whose valve fills, then vents, then holds, as the traced loop takes it.

Claims: with the drift F, the pole p and the gain G of (19) at the sampled slip s_k, the slip of each part of the sample
has a closed form; a small deviation of the slip that meets no other torque grows by exp(p h) a sample; and what a law
remembers of a measurement reaches its next command by the product of two slopes.
"""

import sympy as sp

from derivations.notation import numerator, symbols, time
from derivations.valve_map import T_F, T_V, T, T_in, h

p, G = symbols("pole gain")
F, s_k = sp.symbols("F s_k", real=True)
first, second = sp.symbols("t_F t_V", positive=True)  # spans of filling and venting


def _kept(rate: sp.Expr, span: sp.Expr) -> sp.Expr:
    """Integral of exp(-rate t) from 0 to a span."""
    return (1 - sp.exp(-rate * span)) / rate


def _slip(pulled: sp.Expr) -> sp.Expr:
    return s_k + F * (sp.exp(p * time) - 1) / p + G * sp.exp(p * time) * pulled


def _residual(slip: sp.Expr, torque: sp.Expr) -> sp.Expr:
    return numerator(sp.diff(slip, time) - F - p * (slip - s_k) - G * torque)


def _filled(span: sp.Expr) -> sp.Expr:
    return T_in * _kept(p, span) - (T_in - T) * _kept(p + 1 / T_F, span)


def _filling(span: sp.Expr) -> sp.Expr:
    return T_in - (T_in - T) * sp.exp(-span / T_F)


_crest = _filling(first)
_since = time - first
filling_residual = _residual(_slip(_filled(time)), _filling(time))
_vented = sp.exp(-p * first) * _crest * _kept(p + 1 / T_V, _since)
venting_residual = _residual(_slip(_filled(first) + _vented), _crest * sp.exp(-_since / T_V))
_foot = _crest * sp.exp(-second / T_V)
_held = sp.exp(-p * (first + second)) * _foot * _kept(p, _since - second)
holding_residual = _residual(_slip(_filled(first) + _vented.subs(time, first + second) + _held), _foot)
start_residual = sp.simplify(_slip(_filled(time)).subs(time, 0) - s_k)

_drift = sp.Function("F", real=True)(s_k)
_after = s_k + _drift * (sp.exp(p * h) - 1) / p
slope_residual = sp.simplify(sp.diff(_after, s_k).subs(sp.diff(_drift, s_k), p) - sp.exp(p * h))

# --- a law with memory: x+ = f(x, m), u = g(x, m) ---------------------------------------------------------------
_A, _B, _C, _D, _x, _m, _next = sp.symbols("A B C D x m m_1", real=True)
_second_command = _C * (_A * _x + _B * _m) + _D * _next
memory_residual = sp.expand(sp.diff(_second_command, _m) - _C * _B)
