"""Recovery of the slip by full venting: how large a deviation a brake with a lag brings back.

Claims: with the slope p of the drift and g = G T* at the reference, the deviations that full venting brings back end
at delta = g/(p (1 + p tau)); a deviation A below it never gets further than -delta ln(1 - A/delta), which is below
the room X if (A/X)^2 + A/delta <= 1.
"""

import sympy as sp

from derivations.notation import time

p, tau, g, X, A, delta = sp.symbols("p tau g X A delta", positive=True)
x, z, y, u, E = sp.symbols("x z y u E", positive=True)

# --- the deviation x and the torque T = T* (1 + z) while the brake vents ------------------------------------
deviation_rate, torque_rate = p * x + g * z, -(1 + z) / tau
largest = g / (p * (1 + p * tau))

# What full venting takes off, seen from the start: the largest deviation that it balances.
_removed = sp.integrate(sp.exp(-p * time) * g * (1 - sp.exp(-time / tau)), (time, 0, sp.oo))
largest_residual = sp.simplify(_removed - largest)

# A combination that moves by itself: w' = p (w - delta).
_w = x + g * tau * z / (1 + p * tau)
_w_rate = sp.diff(_w, x) * deviation_rate + sp.diff(_w, z) * torque_rate
combination_residual = sp.simplify(_w_rate - p * (_w - largest))

# --- how far the slip gets: w begins at A, where z = 0; E = exp(p t), and -z = 1 - exp(-t/tau) <= t/tau -------
_path = delta - (delta - A) * E + g * tau / (1 + p * tau) * (sp.log(E) / p) / tau
_bound = delta * (1 - (1 - A / delta) * E + sp.log(E))
path_residual = sp.simplify((_path - _bound).subs(delta, largest))
_top = delta / (delta - A)
flat_residual = sp.simplify(sp.diff(_bound, E).subs(E, _top))
furthest_residual = sp.simplify(
    sp.expand_log(_bound.subs(E, _top) + delta * sp.log((delta - A) / delta), force=True)
)

# --- a condition without logarithm: y/(1 - exp(-y)) <= y/2 + sqrt(1 + (y/2)^2), y = X/delta -----------------
_exact = y / (1 - sp.exp(-y))
half_residual = sp.simplify((_exact - (y / 2 + y / 2 * sp.coth(y / 2))).rewrite(sp.exp))
# u coth u <= sqrt(1 + u^2), squared and times sinh^2 u, is u^2 <= sinh^2 u.
squares_residual = sp.expand(
    ((1 + u**2) * sp.sinh(u) ** 2 - u**2 * sp.cosh(u) ** 2 - (sp.sinh(u) ** 2 - u**2)).rewrite(sp.exp)
)
_q = 1 / delta
_root = 1 / (_q / 2 + sp.sqrt(_q**2 / 4 + 1 / X**2))
root_residual = sp.simplify((_root / X) ** 2 + _root / delta - 1)
