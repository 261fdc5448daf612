"""Synthesized track against the published spectra of ERRI B176 and against what it has to be by construction."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from wspd_design.model.hertz import contact_from_radii
from wspd_design.model.wheel_rail import wheel_rail
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_track_spectrum
from wspd_design.simulation.track import (
    band,
    irregular_track,
    spectrum,
    standard_deviation,
    synthesize,
    welch_spectrum,
)

TRACK = load_track_spectrum("erri-b176")
VERTICAL = ("vertical-high",)
LONG, COARSE = 6800.0, 0.5  # m


@pytest.fixture(scope="module")
def high():
    return irregular_track(TRACK, "high", seed=1)


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


def test_deviations_as_printed_show_the_lost_digit_of_table_9():
    # Locomotive.md section 6: 0.72 mrad with 0.305533e-6, as it is printed, in place of 1.305533e-6.
    row = replace(TRACK.rows["cross-level-high"], beta2=0.305533e-6)
    printed = replace(TRACK, rows=TRACK.rows | {"cross-level-high": row})
    assert standard_deviation(printed, "cross-level-high") == pytest.approx(0.72e-3, rel=0.005)


def test_variance_of_the_profile_is_the_integral_of_the_spectrum(high):
    for row, channel in zip(high.values, high.channels, strict=True):
        exact, _ = quad(lambda w, name=channel: float(spectrum(TRACK, name, np.array(w))), *band(TRACK))
        assert np.var(row[high.lead :]) == pytest.approx(exact, rel=1e-3)
    assert high.period == pytest.approx(2048.0)


@pytest.mark.parametrize("channel", ["vertical-high", "lateral-high", "cross-level-high", "vertical-low"])
def test_welch_finds_the_spectrum_again(channel):
    made = synthesize(TRACK, (channel,), seed=1, period=LONG, spacing=COARSE)
    wavenumber, density = welch_spectrum(made.values[0, made.lead :], COARSE, 200.0)
    low, high = band(TRACK)
    inside = (wavenumber > low + 0.06) & (wavenumber < high - 0.06)
    ratio = density[inside] / spectrum(TRACK, channel, wavenumber[inside])
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.08)
    assert np.all((ratio > 0.4) & (ratio < 2.0))
    outside = density[wavenumber > high + 0.2]
    assert outside.max() < 1e-3 * density[inside].min()


def test_welch_refuses_a_two_sided_track():
    """The planted fault: the same table read as two-sided has twice the density."""
    made = synthesize(replace(TRACK, one_sided=False), VERTICAL, seed=1, period=LONG, spacing=COARSE)
    wavenumber, density = welch_spectrum(made.values[0, made.lead :], COARSE, 200.0)
    inside = (wavenumber > 0.35) & (wavenumber < 2.0)
    ratio = density[inside] / spectrum(TRACK, "vertical-high", wavenumber[inside])
    assert np.mean(ratio) == pytest.approx(2.0, rel=0.08)


def test_table_is_the_sum_of_its_cosines():
    # The same numbers without a transform: harmonics of one period with the amplitudes of the spectrum.
    made = synthesize(TRACK, VERTICAL, seed=5, period=400.0, spacing=COARSE)
    step = 2.0 * np.pi / 400.0
    harmonics = np.arange(16, 134)  # 25 m down to 3 m
    w = step * harmonics
    low, high = band(TRACK)
    width = np.full(len(w), step)
    width[0], width[-1] = w[0] + 0.5 * step - low, high - w[-1] + 0.5 * step
    amplitude = np.sqrt(2.0 * spectrum(TRACK, "vertical-high", w) * width)
    generator = np.random.default_rng(np.random.SeedSequence([5, list(TRACK.rows).index("vertical-high")]))
    phase = generator.uniform(0.0, 2.0 * np.pi, len(w))
    place = np.array([30.0, 31.5, 123.0, 399.5])
    angle = place[:, np.newaxis] * w + phase
    value, slope = made.at(place)
    assert value[0] == pytest.approx(np.cos(angle) @ amplitude, abs=1e-15)
    assert slope[0] == pytest.approx(-np.sin(angle) @ (w * amplitude), abs=1e-15)


def test_between_points_the_profile_is_within_its_bound_and_below_a_newton_of_wheel_load(high):
    fine = synthesize(TRACK, high.channels, seed=1, spacing=high.spacing / 5)
    place = fine.spacing * np.arange(0, fine.values.shape[1], 3)
    value, _ = high.at(place)
    found = np.abs(value - fine.values[:, ::3]).max(axis=1)
    bound = np.array(high.interpolation_errors)
    assert np.all(found <= bound)
    assert np.all(found > 0.5 * bound)
    ellipse = contact_from_radii(
        wheel_load=94.2e3, wheel_radius=0.55, rail_radius=0.3, young=210e9, poisson=0.25
    )
    spring = 1.5 * 94.2e3 ** (1.0 / 3.0) * wheel_rail(ellipse, poisson=0.25).normal_stiffness ** (2.0 / 3.0)
    assert spring == pytest.approx(1.43e9, rel=0.01)
    half_gauge = 0.75
    assert spring * (bound[0] + half_gauge * bound[2]) < 0.5


def test_a_coarse_table_would_kick_the_wheel(high):
    # Straight lines between the same points would be wrong by more than a kilonewton.
    fine = synthesize(TRACK, VERTICAL, seed=1, spacing=high.spacing / 5)
    place = fine.spacing * np.arange(fine.lead, fine.values.shape[1])
    straight = np.interp(place, high.spacing * np.arange(high.values.shape[1]), high.values[0])
    inside = place < 2000.0
    assert 1.4e9 * np.abs(straight - fine.values[0, fine.lead :])[inside].max() > 1e3


def test_slope_is_the_derivative(high):
    place = np.array([1.0, 14.9, 29.99, 30.0, 31.0, 200.02, 2078.0, 2079.3])
    step = 1e-4
    numeric = (high.at(place + step)[0] - high.at(place - step)[0]) / (2.0 * step)
    assert high.at(place)[1] == pytest.approx(numeric, abs=1e-9)


def test_the_track_begins_level_and_repeats(high):
    value, slope = high.at(np.array([-5.0, 0.0]))
    assert not value.any()
    assert not slope.any()
    place = np.array([30.0, 31.23, 500.0, 2077.99])
    for ours, later in zip(high.at(place), high.at(place + high.period), strict=True):
        assert later == pytest.approx(ours, abs=1e-13)


def test_the_same_seed_gives_the_same_bytes(high):
    again = irregular_track(TRACK, "high", seed=1)
    assert again.values.tobytes() == high.values.tobytes()
    assert again.slopes.tobytes() == high.slopes.tobytes()
    # A channel does not depend on which others are drawn.
    alone = synthesize(TRACK, ("cross-level-high",), seed=1)
    assert alone.values.tobytes() == high.values[2:].tobytes()


def test_seeds_and_channels_are_independent(high):
    other = irregular_track(TRACK, "high", seed=2)
    rows = np.concatenate([high.values, other.values])
    between = np.corrcoef(rows) - np.eye(6)
    assert np.abs(between).max() < 0.15


def test_bad_input_is_refused():
    with pytest.raises(UserError, match='unknown channel "up" of track erri-b176; available: lateral-high'):
        synthesize(TRACK, ("up",), seed=0)
    with pytest.raises(UserError, match='level of irregularity "huge" must be one of high, low'):
        irregular_track(TRACK, "huge", seed=0)
    for name, wrong in (("spacing", 0.0), ("spacing", 1.0), ("period", 50.0), ("fade-in", 0.0)):
        for value in (wrong, float("nan")):
            with pytest.raises(UserError, match=f"{name} = {value:g} m"):
                synthesize(TRACK, VERTICAL, seed=0, **{name.replace("-", "_"): value})
