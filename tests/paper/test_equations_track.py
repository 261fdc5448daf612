"""Eq. (49) and Table 9 against the published coefficients and standard deviations of ERRI B176."""

import numpy as np
import pytest
from scipy.integrate import quad

from tests.lazily import Lazily
from wspd_design.model.generated.track import irregularity_spectrum
from wspd_design.parameters.loading import load_track_spectrum

track = Lazily("track")


def spectrum(row, wavenumber):
    return irregularity_spectrum(wavenumber, *(float(c) for c in track.DERIVED[row].values()))


def test_expansion_of_the_published_spectra():
    assert track.expansion_residual == (0, 0, 0)
    for wavenumber in (0.05, 0.3, 2.0):
        w2 = wavenumber**2
        factors = (w2 + 0.0206**2) * (w2 + 0.8246**2)
        assert spectrum("Vertical", wavenumber) == pytest.approx(1.080e-6 * 0.8246**2 / factors, rel=1e-12)
        cross = 1.080e-6 / 0.75**2 * 0.8246**2 * w2 / (factors * (w2 + 0.4380**2))
        assert spectrum("Lateral", wavenumber) == pytest.approx(cross, rel=1e-12)


def test_coefficients_of_the_published_library():
    for row, beta0 in (("Horizontal", 4.164787e-7), ("Vertical", 7.343623e-7)):
        derived = track.DERIVED[row]
        assert float(derived["beta0"]) == pytest.approx(beta0, rel=1e-6)
        assert float(derived["gamma0"]) == pytest.approx(2.8855e-4, rel=1e-6)
        assert float(derived["gamma2"]) == pytest.approx(0.6803895, rel=1e-6)


@pytest.mark.parametrize(
    ("row", "deviation"), [("Vertical", 1.61e-3), ("Horizontal", 1.21e-3), ("Lateral", 1.49e-3)]
)
def test_standard_deviation_in_the_band_of_the_paper(row, deviation):
    variance, _ = quad(lambda w: spectrum(row, w), 2 * np.pi / 25.0, 2 * np.pi / 3.0)
    assert np.sqrt(variance) == pytest.approx(deviation, rel=0.005)


def test_table_9():
    found = track.disagreements()
    assert list(found) == [("Lateral", "beta2")]
    assert float(found["Lateral", "beta2"]) == pytest.approx(-1e-6, rel=1e-5)


def test_wrong_digit_in_table_9_is_caught(monkeypatch):
    monkeypatch.setitem(track.PRINTED["Vertical"], "gamma2", ("0.68138", 0))
    assert ("Vertical", "gamma2") in track.disagreements()


# What the rows of Table 9 are, and ERRI B176's roughness of both levels, recalled [m rad].
ROWS = {"Horizontal": "lateral", "Vertical": "vertical", "Lateral": "cross-level"}
ROUGHNESS = {
    ("vertical", "high"): 1.080e-6,
    ("lateral", "high"): 6.125e-7,
    ("vertical", "low"): 4.032e-7,
    ("lateral", "low"): 2.119e-7,
}


@pytest.mark.parametrize("row", ROWS)
def test_shipped_spectra_are_table_9_as_recovered(row):
    shipped = load_track_spectrum("erri-b176").rows[f"{ROWS[row]}-high"]
    for name, derived in track.DERIVED[row].items():
        assert getattr(shipped, name) == pytest.approx(float(derived), rel=1.5e-5)  # five printed digits


@pytest.mark.parametrize(("direction", "level"), ROUGHNESS)
def test_shipped_roughness_of_both_levels(direction, level):
    rows = load_track_spectrum("erri-b176").rows
    beta0 = ROUGHNESS[direction, level] * 0.8246**2
    assert rows[f"{direction}-{level}"].beta0 == pytest.approx(beta0, rel=1e-5)
    if direction == "vertical":
        assert rows[f"cross-level-{level}"].beta2 == pytest.approx(beta0 / 0.75**2, rel=1e-5)


def test_the_lost_digit_halves_the_cross_level():
    # Locomotive.md section 6: 0.72 mrad in place of 1.49.
    printed = {name: float(c) for name, c in track.DERIVED["Lateral"].items()} | {"beta2": 0.305533e-6}
    variance, _ = quad(
        lambda w: irregularity_spectrum(w, *printed.values()), 2 * np.pi / 25.0, 2 * np.pi / 3.0
    )
    assert np.sqrt(variance) == pytest.approx(0.72e-3, rel=0.005)
