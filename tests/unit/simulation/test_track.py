"""Synthesized track against the published spectra of ERRI B176 and against what it has to be by construction."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_track_spectrum
from wspd_design.simulation.track import (
    band,
    spectrum,
    standard_deviation,
    synthesize,
    welch_spectrum,
)

TRACK = load_track_spectrum("erri-b176")
LONG = 2000  # harmonics: repeats after 6.8 km


@pytest.mark.parametrize(
    ("channel", "sigma"),
    [
        # Data book section 4, 3 to 25 m: mm, mm, mrad.
        ("vertical-high", 1.61e-3),
        ("lateral-high", 1.21e-3),
        ("cross-level-high", 1.49e-3),
        ("vertical-low", 0.98e-3),
        ("lateral-low", 0.71e-3),
        ("cross-level-low", 0.91e-3),
    ],
)
def test_standard_deviation_in_the_band(channel, sigma):
    assert standard_deviation(TRACK, channel) == pytest.approx(sigma, rel=0.011)


def test_spectrum_from_the_corner_wavenumbers():
    # ERRI B176 states the spectra by corner wavenumbers [rad/m] and A_V, not by polynomials.
    a_v, wc, wr, ws, b0 = 1.080e-6, 0.8246, 0.0206, 0.4380, 0.75
    w = np.linspace(0.1, 3.0, 50)
    vertical = a_v * wc**2 / ((w**2 + wr**2) * (w**2 + wc**2))
    assert spectrum(TRACK, "vertical-high", w) == pytest.approx(vertical, rel=1e-4)
    cross = vertical * w**2 / b0**2 / (w**2 + ws**2)
    assert spectrum(TRACK, "cross-level-high", w) == pytest.approx(cross, rel=1e-4)


def test_variance_of_the_profile_is_the_integral_of_the_spectrum():
    channel = synthesize(TRACK, "vertical-high", seed=3)
    place = channel.fade_in + np.linspace(0.0, channel.period, 20_000, endpoint=False)
    exact, _ = quad(lambda w: float(spectrum(TRACK, "vertical-high", np.array(w))), *band(TRACK))
    assert np.var(channel.profile(place)) == pytest.approx(exact, rel=1e-3)
    assert channel.period == pytest.approx(1364.0, abs=1.0)


@pytest.mark.parametrize("channel", ["vertical-high", "lateral-high", "cross-level-high"])
def test_welch_finds_the_spectrum_again(channel):
    made = synthesize(TRACK, channel, seed=1, harmonics=LONG)
    place = np.arange(made.fade_in, made.fade_in + made.period, 0.5)
    wavenumber, density = welch_spectrum(made.profile(place), 0.5, 200.0)
    low, high = band(TRACK)
    inside = (wavenumber > low + 0.06) & (wavenumber < high - 0.06)
    ratio = density[inside] / spectrum(TRACK, channel, wavenumber[inside])
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.08)
    assert np.all((ratio > 0.4) & (ratio < 2.0))
    outside = density[wavenumber > high + 0.2]
    assert outside.max() < 1e-3 * density[inside].min()


def test_welch_refuses_a_two_sided_track():
    """The planted fault: the same table read as two-sided has twice the density."""
    made = synthesize(replace(TRACK, one_sided=False), "vertical-high", seed=1, harmonics=LONG)
    place = np.arange(made.fade_in, made.fade_in + made.period, 0.5)
    wavenumber, density = welch_spectrum(made.profile(place), 0.5, 200.0)
    inside = (wavenumber > 0.35) & (wavenumber < 2.0)
    ratio = density[inside] / spectrum(TRACK, "vertical-high", wavenumber[inside])
    assert np.mean(ratio) == pytest.approx(2.0, rel=0.08)


def test_slope_is_the_derivative():
    channel = synthesize(TRACK, "vertical-high", seed=5)
    place = np.array([0.0, 1.0, 14.9, 29.99, 30.0, 31.0, 200.0])
    step = 1e-5
    numeric = (channel.profile(place + step) - channel.profile(place - step)) / (2.0 * step)
    inside = place > 0.0
    assert channel.slope(place)[inside] == pytest.approx(numeric[inside], abs=1e-9)


def test_the_track_begins_level():
    channel = synthesize(TRACK, "vertical-high", seed=5)
    assert channel.profile(np.array([0.0]))[0] == 0.0
    assert channel.slope(np.array([0.0]))[0] == 0.0


def test_seeds_and_channels_are_independent_and_repeatable():
    place = np.linspace(50.0, 300.0, 2000)
    first = synthesize(TRACK, "vertical-high", seed=1).profile(place)
    assert (first == synthesize(TRACK, "vertical-high", seed=1).profile(place)).all()
    other = synthesize(TRACK, "vertical-high", seed=2).profile(place)
    channel = synthesize(TRACK, "lateral-high", seed=1).profile(place)
    for each in (other, channel):
        assert abs(np.corrcoef(first, each)[0, 1]) < 0.3


def test_bad_input_is_refused():
    with pytest.raises(UserError, match='unknown channel "up" of track erri-b176; available: lateral-high'):
        synthesize(TRACK, "up", seed=0)
    with pytest.raises(UserError, match="harmonics = 1"):
        synthesize(TRACK, "vertical-high", seed=0, harmonics=1)
    with pytest.raises(UserError, match="fade-in = 0 m"):
        synthesize(TRACK, "vertical-high", seed=0, fade_in=0.0)
