"""One sample of a loop with filling and venting pulses, against an integration of the nonlinear map."""

import math
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.setting.pulsed_valve import Times, rates, sample_of


def one_sample(y, share, fill, vent, duty, q, span, size, steps=200):
    """Integrate y' = q y - size (T - T0) with the true pulses; Simpson's rule in each pulse."""
    for part, aim, tau in ((duty, 1.0, fill), (1.0 - duty, 0.0, vent)):
        length = part * span
        times = np.linspace(0.0, length, steps + 1)
        torque = aim + (share - aim) * np.exp(-times / tau)
        weights = np.exp(q * (length - times)) * np.array([1, *([4, 2] * (steps // 2))[:-1], 1])
        y = math.exp(q * length) * y - size * float(torque @ weights) * length / steps / 3.0
        share = torque[-1]
    return y, share


@pytest.mark.parametrize(("fill", "vent"), [(0.6, 0.6), (0.3, 0.09), (0.9, 0.3)])
@pytest.mark.parametrize("q", [-8.0, 4.0])
@pytest.mark.parametrize("duty", [0.2, 0.7])
def test_linearized_sample_is_the_slope_of_the_true_one(fill, vent, q, duty):
    span, size = 0.02, 40.0
    a, b = math.exp(-duty * span / fill), math.exp(-(1.0 - duty) * span / vent)
    foot = b * (1.0 - a) / (1.0 - a * b)

    def after(y, share, u):
        return np.array(one_sample(y, share, fill, vent, u, q, span, size))

    d = 1e-4
    by_y = (after(d, foot, duty) - after(-d, foot, duty)) / (2 * d)
    by_t = (after(0, foot + d, duty) - after(0, foot - d, duty)) / (2 * d)
    by_u = (after(0, foot, duty + d) - after(0, foot, duty - d)) / (2 * d)
    exact = [Fraction(x) for x in (fill, vent, q, duty, span)]
    f, v, pole, u, h = exact
    found = [tuple(map(float, each)) for each in sample_of(Times((f, f), (v, v)), (pole, pole), h, (u, u))]
    kept, forced, held, moved, delay = (low for low, _ in found)
    assert by_y == pytest.approx([kept, 0.0], rel=1e-6)
    assert by_t[1] == pytest.approx(held, rel=1e-6)
    assert by_u == pytest.approx([-size * moved * delay, moved], rel=1e-5)
    # D is between those of the faster and the slower rate.
    assert found[1][0] * (1 - 1e-7) <= -by_t[0] / size <= found[1][1] * (1 + 1e-7)
    assert forced < span * math.exp(max(q, 0.0) * span)
    # What ranges enclose, a point inside must not leave.
    wide = sample_of(Times((f / 2, f * 2), (v / 2, v * 2)), (pole - 1, pole + 1), h)
    for (low, high), (point, _) in zip(wide, found, strict=True):
        assert float(low) < point < float(high)


def test_rates_of_the_averaged_valve_span_both_times():
    assert rates(Times((Fraction(1, 2), Fraction(1)), (Fraction(1, 4), Fraction(1, 3)))) == (1, 4)
