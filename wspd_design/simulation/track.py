"""Random track irregularities with the spectrum of eq. (49): tables of values and slopes over distance.

A profile is a sum of cosines whose amplitudes follow the spectrum and whose phases are random. Values and derivatives
at the points of the table are exact sums, made by a fast Fourier transform; between them the profile is the cubic that
has both (Hermite's interpolation), so that it has no steps for the stiff contact of a wheel.
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

LEVELS = ("high", "low")
"""Levels of irregularity of ERRI B176."""

SPACING = 0.5  # m of tables of the wheel loads, a sixth of the shortest wavelength
FINE = 0.05  # m of tables that wheels roll on: between points it is exact to less than a nanometer
PERIOD = 2048.0  # m
_GRID = 4001  # points of the integral over a band


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class IrregularTrack:
    """Channels of a synthesized track over distance, faded in from level track at distance 0.

    Values are in m for displacements and in rad for the cross level, slopes in the same per m. The tables begin at
    distance 0. Their first ``lead`` points fade in; the others are one period, which repeats without end.
    """

    channels: tuple[str, ...]
    seed: int
    spacing: float  # m
    lead: int
    values: "Array"  # a row for each channel
    slopes: "Array"
    interpolation_errors: tuple[float, ...]  # of each channel between the points, at most

    @property
    def period(self) -> float:
        """Distance after which the profiles repeat [m]."""
        return self.spacing * float(self.values.shape[1] - self.lead)

    @property
    def fade_in(self) -> float:
        """Distance over which the irregularity grows from level track [m]."""
        return self.spacing * self.lead

    def at(self, distance: "Array") -> "tuple[Array, Array]":
        """Irregularity and its slope at each distance, a row for each channel; before the start the track is level."""
        import numpy as np

        points = self.values.shape[1]
        place = np.maximum(distance, 0.0) / self.spacing
        cell = np.floor(place).astype(np.int64)
        left, right = (
            np.where(index < points, index, self.lead + (index - self.lead) % (points - self.lead))
            for index in (cell, cell + 1)
        )
        t = place - cell
        low, high = self.values[:, left], self.values[:, right]
        start, end = (self.spacing * self.slopes[:, index] for index in (left, right))
        # Hermite's cubic by its rise and what the slopes at both ends differ from it.
        rise = high - low
        first, last = start - rise, end - rise
        value = low + t * (rise + (1.0 - t) * ((1.0 - t) * first - t * last))
        slope = rise + (1.0 - t) * (1.0 - 3.0 * t) * first + t * (3.0 * t - 2.0) * last
        return value, slope / self.spacing


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
    track: TrackSpectrum,
    channels: tuple[str, ...],
    *,
    seed: int,
    period: float = PERIOD,
    spacing: float = FINE,
    fade_in: float = 30.0,
) -> IrregularTrack:
    """Draw random profiles.

    Parameters
    ----------
    track : TrackSpectrum
        Spectra and band of wavelengths.
    channels : tuple of str
        Rows of the spectra, such as ``"vertical-high"``; each has its own random numbers, whatever the others are.
    seed : int
        The same seed gives the same track.
    period : float
        Distance after which the profiles repeat, a multiple of the spacing [m].
    spacing : float
        Distance of the points of the tables [m].
    fade_in : float
        Distance over which the irregularity grows from level track, rounded up to points [m].

    Returns
    -------
    IrregularTrack
        Tables of values and slopes.
    """
    import numpy as np

    low, high = band(track)
    shortest, longest = track.shortest_wavelength, track.longest_wavelength
    if not 0.0 < spacing <= 0.25 * shortest:
        raise UserError(
            f"spacing = {spacing:g} m must lie above 0 and at most at a quarter of the shortest wavelength, "
            f"{0.25 * shortest:g} m; {FINE:g} m is exact enough for wheels"
        )
    if not 4.0 * longest <= period < math.inf:
        raise UserError(
            f"period = {period:g} m must be finite and at least four times the longest wavelength, "
            f"{4.0 * longest:g} m; {PERIOD:g} m reach further than a stop"
        )
    if not 0.0 < fade_in < math.inf:
        raise UserError(f"fade-in = {fade_in:g} m must be above 0 and finite; 20 to 50 m is usual")
    points, lead = round(period / spacing), math.ceil(fade_in / spacing - 1e-9)
    step = 2.0 * math.pi / (points * spacing)
    harmonics = np.arange(round(low / step), round(high / step) + 1)
    wavenumbers = step * harmonics.astype(np.float64)
    # The part of the band that belongs to each harmonic.
    widths = np.minimum(wavenumbers + 0.5 * step, high) - np.maximum(wavenumbers - 0.5 * step, low)
    index = np.arange(lead + points)
    fade, fade_rate = _fade(spacing * index.astype(np.float64), lead * spacing)
    values, slopes, errors = [], [], []
    for channel in channels:
        amplitudes = np.sqrt(2.0 * spectrum(track, channel, wavenumbers) * widths)
        generator = np.random.default_rng(np.random.SeedSequence([seed, list(track.rows).index(channel)]))
        phases = generator.uniform(0.0, 2.0 * math.pi, len(harmonics))
        coefficients = np.zeros(points // 2 + 1, dtype=np.complex128)
        waves = 0.5 * points * amplitudes * np.exp(1j * phases)
        derivatives = []
        for order in range(5):
            coefficients[harmonics] = waves * (1j * wavenumbers) ** order
            derivatives.append(np.fft.irfft(coefficients, points))
        profile, rate = (derivative[index % points] for derivative in derivatives[:2])
        values.append(fade * profile)
        slopes.append(fade_rate * profile + fade * rate)
        largest = [float(np.abs(derivative).max()) for derivative in derivatives]
        errors.append(_interpolation_error(largest, spacing, lead * spacing, float(wavenumbers[-1])))
    return IrregularTrack(
        channels=channels,
        seed=seed,
        spacing=spacing,
        lead=lead,
        values=np.array(values),
        slopes=np.array(slopes),
        interpolation_errors=tuple(errors),
    )


def irregular_track(track: TrackSpectrum, level: str, *, seed: int) -> IrregularTrack:
    """Draw the track that wheels roll on: vertical, lateral, cross level, of the level ``"high"`` or ``"low"``."""
    if level not in LEVELS:
        raise UserError(f'level of irregularity "{level}" must be one of {", ".join(LEVELS)}')
    return synthesize(
        track, tuple(f"{name}-{level}" for name in ("vertical", "lateral", "cross-level")), seed=seed
    )


def _fade(distance: "Array", fade_in: float) -> "tuple[Array, Array]":
    """Smooth step from 0 to 1 over the fade-in, and its derivative."""
    import numpy as np

    part = np.clip(distance / fade_in, 0.0, 1.0)
    rate = np.where(part < 1.0, 0.5 * math.pi / fade_in * np.sin(math.pi * part), 0.0)
    return 0.5 - 0.5 * np.cos(math.pi * part), rate


def _interpolation_error(largest: list[float], spacing: float, fade_in: float, highest: float) -> float:
    """Bound of the error of Hermite's interpolation between points, spacing^4 / 384 times the fourth derivative.

    Parameters
    ----------
    largest : list of float
        Magnitude of the profile and its derivatives up to the fourth, the largest at the points.
    spacing, fade_in : float
        Of the table [m].
    highest : float
        Wavenumber [rad/m]. Between the points a sum of waves exceeds its largest value at them by at most
        1 / cos(highest spacing / 2).

    References
    ----------
    Ehlich and Zeller (1964), Mathematische Zeitschrift 86, 41-44.
    """
    fades = [1.0] + [0.5 * (math.pi / fade_in) ** order for order in range(1, 5)]
    fourth = sum(math.comb(4, order) * fades[order] * largest[4 - order] for order in range(5))
    return spacing**4 / 384.0 * fourth / math.cos(0.5 * highest * spacing)


def irregular_load(
    vehicle: Vehicle, vertical: IrregularTrack, *, sigma: float, spread: float
) -> LoadIrregularity:
    """Give the wheel loads the shape of a vertical profile.

    Each axle meets the profile when it gets there. How a load follows a profile depends on suspension and masses
    that the paper does not print; only shape and spread are claimed here.

    Parameters
    ----------
    vehicle : Vehicle
        For the distances of its axles.
    vertical : IrregularTrack
        Of one channel, the profile over distance.
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
    rows = (1.0 + spread / sigma * vertical.at(distance - offset)[0][0] for offset in offsets)
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
