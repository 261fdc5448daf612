"""Random track irregularities with the spectrum of eq. (49): a profile over distance for each channel.

A profile is a sum of cosines whose amplitudes follow the spectrum and whose phases are random. It is known with its
derivative in closed form, so that no finite difference adds noise.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.model.generated.track import irregularity_spectrum
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import SpectrumCoefficients, TrackSpectrum, Vehicle
from wspd_design.plants.planar import Planar
from wspd_design.simulation.records import LoadIrregularity

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SPACING = 0.5  # m of tables of the wheel loads, a sixth of the shortest wavelength
_GRID = 4001  # points of the integral over a band
_BLOCK = 4096  # points that are summed up at once, so that memory stays small


@dataclass(frozen=True, slots=True, kw_only=True)
class Irregularity:
    """One channel of a synthesized track, faded in from level track at distance 0.

    Values are in m for displacements and in rad for the cross level.
    """

    channel: str
    wavenumbers: "Array"  # rad/m
    amplitudes: "Array"
    phases: "Array"  # rad
    fade_in: float  # m

    @property
    def period(self) -> float:
        """Distance after which the profile repeats [m]."""
        return 2.0 * math.pi / float(self.wavenumbers[1] - self.wavenumbers[0])

    def profile(self, distance: "Array") -> "Array":
        """Irregularity at each distance [m; rad for the cross level]."""
        faded, _ = self._fade(distance)
        result: Array = faded * self._sum(distance, derivative=False)
        return result

    def slope(self, distance: "Array") -> "Array":
        """Derivative of the profile over distance, analytically [-; rad/m for the cross level]."""
        faded, rate = self._fade(distance)
        level, slope = self._sum(distance, derivative=False), self._sum(distance, derivative=True)
        result: Array = rate * level + faded * slope
        return result

    def _sum(self, distance: "Array", *, derivative: bool) -> "Array":
        import numpy as np

        result = np.empty(len(distance))
        for start in range(0, len(distance), _BLOCK):
            place = distance[start : start + _BLOCK, np.newaxis]
            angle = place * self.wavenumbers + self.phases
            terms = -self.wavenumbers * np.sin(angle) if derivative else np.cos(angle)
            result[start : start + _BLOCK] = terms @ self.amplitudes
        return result

    def _fade(self, distance: "Array") -> "tuple[Array, Array]":
        """Smooth step from 0 to 1 over the fade-in, and its derivative."""
        import numpy as np

        part = np.clip(distance / self.fade_in, 0.0, 1.0)
        rate = np.where(part < 1.0, 0.5 * math.pi / self.fade_in * np.sin(math.pi * part), 0.0)
        return 0.5 - 0.5 * np.cos(math.pi * part), rate


def spectrum(track: TrackSpectrum, channel: str, wavenumber: "Array") -> "Array":
    """One-sided power spectral density of a channel, eq. (49) [m2/(rad/m); rad2/(rad/m) for the cross level]."""
    row = _row(track, channel)
    density: Array = irregularity_spectrum(
        wavenumber, row.beta0, row.beta2, row.gamma0, row.gamma2, row.gamma4, row.gamma6
    )
    return density if track.one_sided else 2.0 * density


def band(track: TrackSpectrum) -> tuple[float, float]:
    """Lowest and highest wavenumber of the wavelengths of a track [rad/m]."""
    return 2.0 * math.pi / track.longest_wavelength, 2.0 * math.pi / track.shortest_wavelength


def standard_deviation(track: TrackSpectrum, channel: str) -> float:
    """Root of the integral of the spectrum over the band [m; rad for the cross level]."""
    import numpy as np

    wavenumber = np.linspace(*band(track), _GRID)
    return math.sqrt(float(np.trapezoid(spectrum(track, channel, wavenumber), wavenumber)))


def synthesize(
    track: TrackSpectrum, channel: str, *, seed: int, harmonics: int = 400, fade_in: float = 30.0
) -> Irregularity:
    """Draw a random profile of one channel.

    Parameters
    ----------
    track : TrackSpectrum
        Spectra and band of wavelengths.
    channel : str
        Row of the spectra, such as ``"vertical-high"``; each has its own random numbers.
    seed : int
        The same seed gives the same track.
    harmonics : int
        Number of cosines; the profile repeats after 2 pi times that number over the band.
    fade_in : float
        Distance over which the irregularity grows from level track [m].

    Returns
    -------
    Irregularity
        Profile and slope at any distance.
    """
    import numpy as np

    if harmonics < 2:
        raise UserError(f"harmonics = {harmonics} must be at least 2; 400 reach further than a stop")
    if not fade_in > 0.0:
        raise UserError(f"fade-in = {fade_in:g} m must be above 0; 20 to 50 m is usual")
    low, high = band(track)
    step = (high - low) / harmonics
    wavenumbers = low + step * (np.arange(harmonics, dtype=np.float64) + 0.5)
    density = spectrum(track, channel, wavenumbers)
    place = list(track.rows).index(channel)
    generator = np.random.default_rng(np.random.SeedSequence([seed, place]))
    return Irregularity(
        channel=channel,
        wavenumbers=wavenumbers,
        amplitudes=np.sqrt(2.0 * density * step),
        phases=generator.uniform(0.0, 2.0 * math.pi, harmonics),
        fade_in=fade_in,
    )


def irregular_load(
    vehicle: Vehicle, vertical: Irregularity, *, sigma: float, spread: float
) -> LoadIrregularity:
    """Give the wheel loads the shape of a vertical profile.

    Each axle meets the profile when it gets there. How a load follows a profile depends on suspension and masses
    that the paper does not print; only shape and spread are claimed here.

    Parameters
    ----------
    vehicle : Vehicle
        For the distances of its axles.
    vertical : Irregularity
        Profile over distance.
    sigma : float
        Standard deviation of the profile [m].
    spread : float
        That of the relative wheel loads to be [-].

    Returns
    -------
    LoadIrregularity
        Of every axle of the vehicle on its bogies.
    """
    import numpy as np

    # The profile fades in and the last axle begins behind the first one.
    offsets = Planar(vehicle).offsets
    distance = np.arange(0.0, vertical.period, SPACING)
    rows = (1.0 + spread / sigma * vertical.profile(np.maximum(distance - offset, 0.0)) for offset in offsets)
    return LoadIrregularity(spacing=SPACING, factors=tuple(tuple(row.tolist()) for row in rows))


def welch_spectrum(values: "Array", spacing: float, segment: float) -> "tuple[Array, Array]":
    """Estimate the one-sided spectrum of a profile by Welch's method.

    Parameters
    ----------
    values : ndarray
        Profile at equal distances.
    spacing : float
        Distance of neighboring values [m].
    segment : float
        Length of the averaged segments [m]; they overlap by half.

    Returns
    -------
    wavenumber, density : ndarray
        In rad/m, and in the squared unit of the values per rad/m.
    """
    import numpy as np
    from scipy.signal import welch

    frequency, density = welch(values, fs=1.0 / spacing, nperseg=round(segment / spacing))
    return 2.0 * math.pi * np.asarray(frequency), np.asarray(density) / (2.0 * math.pi)


def _row(track: TrackSpectrum, channel: str) -> SpectrumCoefficients:
    if channel not in track.rows:
        raise UserError(
            f'unknown channel "{channel}" of track {track.name}; available: {", ".join(track.rows)}'
        )
    return track.rows[channel]
