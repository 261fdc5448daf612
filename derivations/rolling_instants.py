"""What observer and filter have not yet learned, counted from the friction at an instant in place of its next mean.

Within a sample the friction moves from f_0 to f_1; its mean is f_0 + m. z and e count from that mean, z + m and
e - kappa m from the instant.

Claims: a sample adds to z + m the rate of the friction with a weight from theta to 1, which has the mean (1 + theta)/2,
and to e - kappa m that with a weight from kept to 1; x - P is what the observer has of the torque and of the motion,
less the torque, e and what the observer lacks of D. In a mean of two samples, with a weight that rises in the first and
falls in the second, what the friction rises by at an even rate, counted from its mean over the first, is 1/2 of that,
1/48 of it from before the middle of the first, where it is still below the mean.
"""

import sympy as sp

from derivations.rolling_sample import (
    apart,
    c,
    drag_change,
    g,
    kappa,
    kept,
    lag_next,
    observed_next,
    theta,
    z,
)
from derivations.rolling_sample import e as lag
from derivations.rolling_sample import friction_change as _means

_t = sp.Symbol("t", nonnegative=True)
_rise = sp.Symbol("rise", real=True)  # of the friction over the sample
_mean, _next_mean = sp.symbols("mean next_mean", real=True)  # of the friction beyond where its sample begins

# --- a sample adds what the friction changes by, with a weight ------------------------------------------------------
_change = _rise + _next_mean - _mean  # of the mean from this sample to the next
_instant, _lag_instant = z + _mean, lag - kappa * _mean
instant_next = theta * _instant - (_rise - (1 - theta) * _mean) + (g - 1) * c - (1 - theta) * apart
lag_instant_next = kept * _lag_instant + kappa * (_rise - (1 - kept) * _mean) + drag_change
instant_residual = sp.expand(observed_next.subs(_means, _change) + _next_mean - instant_next)
lag_instant_residual = sp.expand(lag_next.subs(_means, _change) - kappa * _next_mean - lag_instant_next)
_course = sum((sp.Symbol(f"a_{n}", real=True) * _t**n for n in range(1, 5)), sp.Integer(0))  # of any friction


def _weighed(weight: sp.Expr) -> sp.Expr:
    """Mean of the rate of the friction over a sample, with a weight."""
    return sp.integrate(sp.expand(weight * sp.diff(_course, _t)), (_t, 0, 1))


_lasting = 1 - (1 - theta) * (1 - _t)  # from theta at the beginning to 1 at the end
_over_sample = {_rise: _course.subs(_t, 1), _mean: sp.integrate(_course, (_t, 0, 1))}
weight_residual = sp.expand((_rise - (1 - theta) * _mean).subs(_over_sample) - _weighed(_lasting))
weights_residual = sp.expand(sp.integrate(_lasting, (_t, 0, 1)) - (1 + theta) / 2)
mean_residual = sp.expand(_mean.subs(_over_sample) - _weighed(1 - _t))

# --- what is wanted beyond the pull ---------------------------------------------------------------------------------
_torque, _seen, _moved, _lost, _filtered, _lost_now = sp.symbols(
    "T T_seen moved D_seen D_filtered D", real=True
)
_observed, _reference = _seen - _lost - _moved, -_filtered  # fhat and K
_beyond_pull = _observed - _torque - _reference
beyond_pull_residual = sp.expand(
    _beyond_pull - (_seen - _torque - _moved - (_reference + _lost_now) + (_lost_now - _lost))
)

# --- a mean over two samples ----------------------------------------------------------------------------------------
_half = sp.Rational(1, 2)
_above = sp.integrate(_t * (_t - _half), (_t, _half, 1)) + sp.integrate((2 - _t) * (_t - _half), (_t, 1, 2))
_below = sp.integrate(_t * (_half - _t), (_t, 0, _half))
above_residual = sp.expand(_above - sp.Rational(25, 48))
below_residual = sp.expand(_below - sp.Rational(1, 48))
