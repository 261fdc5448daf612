"""The search for the peak on a friction curve that is known, with loads that differ and slips that come late."""

import math
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.controllers.seeking import PeakSeeking, Shown

SEARCH = PeakSeeking(sample_time=0.02, amplitude=0.1, half_period=0.75, gain=3.0, bias=0.0)
LOADS = (1.07, 0.97, 1.03, 0.93)


def friction(slip, peak):
    return 2e4 * (1.0 - 0.15 * math.log(slip / peak) ** 2)


def found(search, peak, *, start=0.04, seconds=25.0, lag=0.15, noise=0.0, holds=(1.0,) * 4):
    """Slip of the reference after some time."""
    state, random = search.start(), np.random.default_rng(4)
    slips, scales = [start] * 4, (1.0,) * 4
    for _ in range(round(seconds / search.sample_time)):
        share = search.sample_time / lag
        slips = [slip + share * (start * scale - slip) for slip, scale in zip(slips, scales, strict=True)]
        shown = tuple(
            Shown(load * friction(slip, peak) + noise * random.standard_normal(), slip, held)
            for slip, load, held in zip(slips, LOADS, holds, strict=True)
        )
        state, scales = search.step(state, shown)
    return start * math.exp(state[0])


@pytest.mark.parametrize("peak", [0.025, 0.04, 0.07])
@pytest.mark.parametrize("lag", [0.05, 0.3])
def test_it_finds_the_peak(peak, lag):
    assert found(SEARCH, peak, lag=lag) == pytest.approx(peak, rel=0.05)


def test_noise_keeps_it_near_the_peak():
    assert found(SEARCH, 0.07, noise=400.0) == pytest.approx(0.07, rel=0.25)


def test_one_wheelset_less_still_finds_it():
    assert found(SEARCH, 0.07, holds=(1.0, 0.0, 1.0, 1.0)) == pytest.approx(0.07, rel=0.1)


@pytest.mark.parametrize("holds", [(0.0,) * 4, (1.0, 0.0, 0.0, 1.0)])
def test_without_both_halves_nothing_is_learned(holds):
    assert found(SEARCH, 0.07, holds=holds) == 0.04


def test_the_wrong_sign_runs_away():
    assert found(replace(SEARCH, gain=-3.0), 0.07) == pytest.approx(0.04 * math.exp(-0.7), rel=1e-6)


def test_the_halves_change_places_and_balance_each_other():
    state, sides = SEARCH.start(), []
    for _ in range(80):
        state, scales = SEARCH.step(state, (Shown(2e4, 0.04, 1.0),) * 4)
        assert scales[0] == scales[3] == pytest.approx(1.0 / scales[1])
        sides.append(scales[0] > 1.0)
    assert 0.4 < sum(sides) / len(sides) < 0.6
