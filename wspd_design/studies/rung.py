"""One stop on one model of a vehicle, taken apart by wheelset: slip, wheel load, lock and vibration."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.runs import Run
from wspd_design.studies.faults import longest_locks

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Trace = NDArray[np.float64]

SLOW = 1.0  # s, of the moving mean about which a wheel load spreads
BAND = (8.0, 18.0)  # Hz, about the torsion of a driveline, adhering or sliding
WINDOW = 0.5  # s, of which the one with most vibration counts
_ORDER = 4  # of the band-pass
_RATE = 500.0  # 1/s, to which traces are brought


@dataclass(frozen=True, slots=True, kw_only=True)
class AxleFigures:
    """One wheelset in one stop; slip and vibration count above 10 km/h, loads from the build-up of the brake on."""

    slip_mean: float  # -
    slip_max: float  # -
    static_load: float  # N, one wheel, before the brake is applied
    braking_load: float  # N, mean while the brake is built up
    load_spread: float  # N, standard deviation about a moving mean over 1 s, of the wheel with more of it
    least_load: float  # N, of either wheel
    lock: float  # s, longest without a break
    vibration: float  # m/s, rms of the rim speed from 8 to 18 Hz in the half second with most of it
    vibration_frequency: float  # Hz, at which the spectrum of that half second is highest
    vibration_speed: float  # m/s, of the train in its middle
    vibration_slip: float  # -, mean slip then

    @property
    def transfer(self) -> float:
        """Relative change of the wheel load by braking [-]."""
        return self.braking_load / self.static_load - 1.0

    @property
    def relative_spread(self) -> float:
        """Spread of the wheel load over its static value [-]."""
        return self.load_spread / self.static_load


@dataclass(frozen=True, slots=True, kw_only=True)
class Rung:
    """One stop on one model."""

    title: str  # of the model, with what disturbs the stop
    plant: str
    run: Run
    metrics: Metrics
    axles: tuple[AxleFigures, ...]  # of every wheelset of the vehicle, front first
    step_change: float  # -, relative change of the distance with half the steps
    spread: float  # m, of the distance over starts that nobody can tell apart; 0 unless the loop is sensitive

    @property
    def lock(self) -> float:
        """Longest lock of any wheelset above 10 km/h [s]."""
        return max(each.lock for each in self.axles)


def axle_figures(
    run: Run, *, wheelsets: int, wheel_radius: float, build_up: float
) -> tuple[AxleFigures, ...]:
    """Take a stop apart by wheelset.

    Parameters
    ----------
    run : Run
        The stop; where one wheelset stands for all, all have its figures.
    wheelsets : int
        Of the vehicle.
    wheel_radius : float
        For the speed of the rim [m].
    build_up : float
        Time from which on the brake is built up [s]; NaN where it never is, which counts as the start.
    """
    import numpy as np

    time = np.arange(float(run.time[0]), float(run.time[-1]), 1.0 / _RATE)
    speed = np.interp(time, run.time, run.speed)
    judged = speed > JUDGING_SPEED
    braking = judged & (time >= (0.0 if math.isnan(build_up) else build_up))
    locks = longest_locks(run)

    def at_times(column: "Trace") -> "Trace":
        values: Trace = np.interp(time, run.time, column)
        return values

    found = []
    for axle in range(run.slip.shape[1]):
        slip, load = at_times(run.slip[:, axle]), at_times(run.wheel_load[:, axle])
        rim = wheel_radius * at_times(run.wheel_speed[:, axle])
        wheels = [at_times(trace[:, axle]) for trace in _single_wheels(run)]
        place, rms, frequency = _vibration(rim, judged)
        part = slice(place, place + round(WINDOW * _RATE))
        found.append(
            AxleFigures(
                slip_mean=float(slip[judged].mean()),
                slip_max=float(slip[judged].max()),
                static_load=float(run.wheel_load[0, axle]),
                braking_load=float(load[braking].mean()) if braking.any() else math.nan,
                load_spread=max(float((each - _moving_mean(each))[braking].std()) for each in wheels)
                if braking.any()
                else math.nan,
                least_load=min(float(each[judged].min()) for each in wheels),
                lock=locks[axle],
                vibration=rms,
                vibration_frequency=frequency,
                vibration_speed=float(speed[part].mean()),
                vibration_slip=float(slip[part].mean()),
            )
        )
    return tuple(found) if len(found) == wheelsets else tuple(found) * wheelsets


def _single_wheels(run: Run) -> "tuple[Trace, ...]":
    """Return the loads of left and of right wheels where the plant tells them apart, else of one for both."""
    sides = tuple(
        run.further[name] for name in ("wheel_load_left", "wheel_load_right") if name in run.further
    )
    return sides or (run.wheel_load,)


def _moving_mean(values: "Trace") -> "Trace":
    """Mean over a second about each point; near the ends over what there is of it."""
    import numpy as np

    half = round(0.5 * SLOW * _RATE)
    total = np.concatenate([[0.0], np.cumsum(values)])
    places = np.arange(len(values))
    first, last = np.maximum(places - half, 0), np.minimum(places + half + 1, len(values))
    means: Trace = (total[last] - total[first]) / (last - first)
    return means


def _vibration(rim: "Trace", judged: "NDArray[np.bool_]") -> tuple[int, float, float]:
    """Return where the half second with most vibration in the band begins, its rms and its frequency."""
    import numpy as np
    from scipy.signal import butter, sosfiltfilt

    length = round(WINDOW * _RATE)
    last = int(np.count_nonzero(judged))
    if last < 2 * length:
        return 0, math.nan, math.nan
    filtered = sosfiltfilt(butter(_ORDER, BAND, btype="bandpass", fs=_RATE, output="sos"), rim)[:last]
    total = np.concatenate([[0.0], np.cumsum(np.square(filtered))])
    power = total[length:] - total[:-length]
    begin = int(np.argmax(power))
    part = filtered[begin : begin + length] * np.hanning(length)
    padded = 8 * length  # a line every quarter of a Hz
    frequencies = np.fft.rfftfreq(padded, 1.0 / _RATE)
    frequency = float(frequencies[np.argmax(np.abs(np.fft.rfft(part, padded)))])
    return begin, math.sqrt(float(power[begin]) / length), frequency
