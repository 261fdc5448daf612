"""Sampled loop of the mended adaptive fuzzy law: bounded weights, and one sample inside the layer.

The adaptation moves a weight to (1 - p) b + p sigma_D w/leakage, p = h alpha leakage while it adapts and 0 while it is
held. A weight stays in every interval that holds it, 0 and all sigma_D w/leakage, if p <= 1. With memberships of one
width W a rule of center c has w <= exp(-kappa (sigma - m)) for every other rule of center c_o > c, kappa = 2 (c_o -
c)/W^2, m = (c + c_o)/2, so that (sigma - Phi) w has a bound on sigma > Phi: what drives a rule the other way.

Inside the layer sigma_D = 0: the weights fade, and the command is u = psi sigma/Phi. Near the torque T_0 that holds the
reference a short pulse at the start of the sample moves the torque by u h (T_in - T_0)/T_F or u h T_0/T_V. With
e' = q e - W, W = R (T - T_0)/J, that is linear but for the authority A, the change of W for u = 1, which is one number
while the valve fills and another one while it vents.

Claims: bound and interval of a weight, and that the map below is one sample of e' = q e - W.
"""

from functools import partial

import sympy as sp

from derivations.notation import described, time

# --- weights ----------------------------------------------------------------------------------------------------------
b, drive, part, low, high = sp.symbols("b drive part low high", real=True)
_h, _alpha, _leak, _sigma, _strength = sp.symbols("h alpha leak sigma strength", positive=True)
_step = b + _h * _alpha * (_sigma * _strength - _leak * b)
mixed_residual = sp.expand(
    _step - ((1 - _h * _alpha * _leak) * b + _h * _alpha * _leak * (_sigma * _strength / _leak))
)

own, other, surface = sp.symbols("own_center other_center surface", real=True)
width, layer, leakage = sp.symbols("width layer leakage", positive=True)
kappa = 2 * (other - own) / width**2
middle = (own + other) / 2
_ratio = (
    -(((surface - own) / width) ** 2) + ((surface - other) / width) ** 2
)  # of memberships, in the exponent
ratio_residual = sp.expand(_ratio + kappa * (surface - middle))
_decay = sp.Symbol("decay", positive=True)
_excess = sp.Symbol("excess", positive=True)  # of the surface beyond the layer
_driven = _excess * sp.exp(-_decay * _excess)
turning_residual = sp.simplify(sp.diff(_driven, _excess).subs(_excess, 1 / _decay))
_worst = sp.Symbol("worst", positive=True)  # surface at which the drive is largest
_steps = ((_decay, kappa), (_worst, layer + 1 / _decay))
_bound = (_worst - layer) * sp.exp(-_decay * (_worst - middle)) / leakage
drive_bound = sp.exp(-kappa * (layer - middle) - 1) / (kappa * leakage)
bound_residual = sp.simplify(
    (_driven.subs(_excess, 1 / _decay) * sp.exp(-_decay * (layer - middle)) / leakage).subs(_decay, kappa)
    - drive_bound
)
steps_residual = sp.simplify(_bound.subs(_worst, _steps[1][1]).subs(_decay, kappa) / drive_bound - 1)

# --- one sample inside the layer --------------------------------------------------------------------------------------
e, before, rate, W, phi, psi = sp.symbols("error error_before rate torque phi psi", real=True)
k, new, authority, h = sp.symbols("surface_rate new authority h", positive=True)
filtered = rate + new * ((e - before) / h - rate)
sigma = filtered + k * e
moved = W + authority * sigma
next_state = (phi * e - psi * moved, e, filtered, moved)
q, _w = sp.symbols("q w", real=True, nonzero=True)
_grown = sp.exp(q * time)
between_residual = sp.simplify(
    sp.diff(_grown * e - (_grown - 1) / q * _w, time) - (q * (_grown * e - (_grown - 1) / q * _w) - _w)
)
_u, _T, _T_in, _T_F, _T_V = sp.symbols("u T T_in T_F T_V", positive=True)
_filled = _T_in - (_T_in - _T) * sp.exp(-_u * _h / _T_F)
_vented = _T * sp.exp(-_u * _h / _T_V)
fill_residual = sp.simplify(sp.diff(_filled, _u).subs(_u, 0) - _h * (_T_in - _T) / _T_F)
vent_residual = sp.simplify(sp.diff(_vented, _u).subs(_u, 0) + _h * _T / _T_V)

_MEANINGS = {
    "own_center": "Center of the membership function of a rule [m/s2]",
    "other_center": "Center of that of another rule, larger [m/s2]",
    "width": "Width of the membership functions [m/s2]",
    "layer": "Layer Phi of the surface [m/s2]",
    "leakage": "Leakage of the adaptation [m/s2]",
    "error": "Rim speed above the desired one, e [m/s]",
    "error_before": "The same one sample before [m/s]",
    "rate": "Filtered rate of e at the sample before [m/s2]",
    "torque": "W = R (T - T_0)/J, what the deviation of the torque takes off the rim speed [m/s2]",
    "phi": "What becomes of an error within the sample without torque [-]",
    "psi": "What W contributes within the sample [s]",
    "authority": "Change of W in a sample for one unit of the surface [-]",
    "new": "Share of the newest difference in the filtered rate [-]",
    "surface_rate": "Gain k of the surface [1/s]",
    "h": "Sample time [s]",
}


_function = partial(described, equation="docs/theory.md#fuzzy-sector", meanings=_MEANINGS)

FUNCTIONS = (
    _function(
        "largest_drive",
        (own, other, width, layer, leakage),
        _bound,
        "Bound of what a surface above the layer drives the weight of a rule to",
        "Weight, a share of the sample [-]",
        _steps,
    ),
    _function(
        "surface",
        (e, before, rate, new, k, h),
        sigma,
        "Surface of the law at a sample",
        "Surface [m/s2]",
    ),
    _function(
        "next_sample",
        (e, before, rate, W, phi, psi, authority, new, k, h),
        next_state,
        "State of the loop one sample later, inside the layer",
        "Error [m/s], the one before it [m/s], filtered rate [m/s2] and W [m/s2]",
    ),
)
