"""What the law misjudges by noise, and the small changes that it leaves out, against a law in equations of its own."""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from tests.certificates.band.courses import (
    EXACT,
    NOISE,
    WINDOW,
    doubles,
    friction_of,
    laws,
    loop_in,
    misjudged,
    within,
)
from tests.certificates.band.sampled_runs import Law
from wspd_design.certificates.theorems.slip_band.statement import law_of


@pytest.mark.parametrize("smoothing", [Fraction(1, 10), Fraction(1000)])
@pytest.mark.parametrize("number", [0, 2])
def test_noise_shows_in_error_and_acceleration_as_far_as_is_told(plain, number, smoothing):
    """Errors of one sign all the time, then of the other, of wheel and train; and slips beside those of the law."""
    law = replace(laws(plain)[number], acceleration_time=smoothing, slip_error=Fraction(3, 20))
    conditions, noise = EXACT._replace(noise=NOISE), float(NOISE)
    friction = friction_of(plain, replace(law, slip_error=Fraction(0)), WINDOW)
    loop = loop_in(plain, law, friction=friction, conditions=conditions)
    known, command, measured = (doubles(loop.disturbances[k]) for k in (0, 1, 8))
    rim = noise / plain.vehicle.wheel_radius
    gain = float(law.approach_rate * law.sample_time)
    seen = []
    for sign, aside, turns in product((-1.0, 1.0), (-0.15, 0.15), (-1.0, 1.0)):
        off, rate = misjudged(law, plain, aside, [sign * noise] * 400 + [turns * sign * noise])
        for of_rim in (-rim, rim):
            assert within(gain * (of_rim - off), command)
            assert within(of_rim, measured)
            seen.append(gain * abs(of_rim - off))
        assert within(rate, known)
        asked = (1.0 + gain * float(law.ahead)) * rate + gain * (-math.copysign(rim, off) - off)
        assert within(asked, doubles(loop.wants[0].beside))
    assert max(seen) > 0.8 * command[1]


@pytest.mark.parametrize(
    ("band", "share", "least"), [(400.0, 1e3, 0.0), (4e3, 0.2, 0.0), (0.0, 0.0, 0.004), (300.0, 0.01, 0.004)]
)
def test_changes_that_are_left_out_are_no_larger_than_told(plain, band, share, least):
    protection = plain.controller
    brake = replace(protection.valve.brake, vent_time=0.5 * protection.valve.brake.vent_time)
    valve = replace(protection.valve, brake=brake, least_pulse=least)
    tracking = replace(protection.core.tracking, dead_band=band, dead_band_share=share, valve=valve)
    protection = replace(protection, valve=valve, core=replace(protection.core, tracking=tracking))
    law = replace(law_of(protection), falls=False, slip=Fraction(9, 50))
    low, high = doubles(loop_in(plain, law, conditions=EXACT._replace(noise=NOISE)).disturbances[1])
    simple, radius = Law(protection, 0.18), plain.vehicle.wheel_radius
    told = WINDOW[1] + float(NOISE)
    wheel = (1.0 - 0.18) * told / radius
    still = np.zeros(1)

    def left_out(torque, way):
        """Whether neither valve opens for a wanted change: the observed friction, where the predicted error is none."""
        memory = simple.rolling(np.array([told]), radius)
        memory = replace(memory, told=np.array([told]), acceleration=still, friction=np.array([torque + way]))
        error = simple.tracking.ahead * simple.h * way / simple.inertia
        fill, vent, _ = simple.pulses(memory, np.array([wheel - error]), np.array([torque]), simple.full)
        return fill[0] == vent[0] == 0.0

    seen = []
    for torque, sign in product(simple.full * np.array([0.02, 0.3, 0.6, 0.98]), (-1.0, 1.0)):
        least, most = 0.0, 0.999 * (torque if sign < 0.0 else simple.full - torque)
        for _ in range(30):
            middle = (least + most) / 2.0
            least, most = (middle, most) if left_out(torque, sign * middle) else (least, middle)
        seen.append(simple.h / simple.inertia * sign * least)
    noise = float(law.approach_rate * law.sample_time) * float(NOISE) / radius
    assert low + noise <= min(seen) <= max(seen) <= high - noise
    assert max(np.abs(seen)) > 0.5 * (high - 2.0 * noise)


def test_dead_band_is_that_of_the_told_speed(plain):
    """It narrows with the desired slip, of which a train speed that is told too high has more."""
    law = replace(laws(plain)[0], dead_band=Fraction(10**6), dead_band_share=Fraction(1, 5))
    friction = friction_of(plain, law, WINDOW)
    wide, none = (
        doubles(
            loop_in(
                plain,
                replace(law, dead_band_share=share),
                friction=friction,
                conditions=EXACT._replace(noise=NOISE),
            ).disturbances[1]
        )
        for share in (law.dead_band_share, Fraction(0))
    )
    sliding = 0.18 * (WINDOW[1] + float(NOISE)) / plain.vehicle.wheel_radius
    left_out = float(law.sample_time * law.dead_band_share * law.approach_rate) * sliding
    assert wide[1] - none[1] == pytest.approx(left_out, rel=1e-6)
    assert none[0] - wide[0] == pytest.approx(left_out, rel=1e-6)
