"""What the controllers see without a C compiler: the formulas of ``templates/sensors.c`` for a single stop."""

import math
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.codegen.loop_numbers import DISTURBANCES, LoopInput
from wspd_design.controllers.protocol import VehicleMeasurement

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_NOISE, _PHASE = range(2)  # what is drawn
_TRAIN = 0  # whose; wheelset a is 1 + a


class _Passing(NamedTuple):
    """A step of one wheelset within which a pulse came: time, angle and speed at its ends, angle of the pulse."""

    begin: float
    length: float
    start: float
    end: float
    start_speed: float
    end_speed: float
    pulse: float

    def time(self) -> float:
        """When the pulse came, by the cubic through angle and speed at both ends."""
        h, rise, goal = self.length, self.end - self.start, self.pulse - self.start
        first, last = h * self.start_speed, h * self.end_speed
        square, cube = 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise
        low, high, x = 0.0, 1.0, goal / rise
        for _ in range(60):
            beyond = ((cube * x + square) * x + first) * x - goal
            slope = (3.0 * cube * x + 2.0 * square) * x + first
            ahead = x - beyond / slope if slope else math.inf
            if abs(ahead - x) < 1e-14:
                break
            low, high = (x, high) if beyond < 0.0 else (low, x)
            x = ahead if low < ahead < high else 0.5 * (low + high)
        return self.begin + x * h


class VirtualSensors:
    """Sensors of all wheelsets of one stop."""

    def __init__(self, given: LoopInput, radius: "Array") -> None:
        import numpy as np

        self._numbers = {name: float(given.disturbance(name)[0]) for name in DISTURBANCES}
        self._factors, self._lost = given.fault("wheel_factor"), given.fault("sensor_lost")
        self._seed, self._sample_time, self._radius = int(given.seeds[0]), given.settings.sample_time, radius
        self._sample, angle, speeds = 0, self._numbers["pulse_angle"], given.wheel_speeds
        self.timed = bool(self._numbers["timed"])
        if not angle:
            return
        offsets = [_uniform(self._words(0, 1 + axle, _PHASE)[0]) for axle in range(len(speeds))]
        self._offsets = np.array(offsets)
        self._counted = self._pulses(-speeds * self._sample_time)
        periods = angle / speeds
        self._last = [
            _Passing(-2.0 * t, 2.0 * t, -2.0 * angle, 0.0, speed, speed, -offset * angle)
            for t, speed, offset in zip(periods, speeds, offsets, strict=True)
        ]
        self._previous = [last._replace(pulse=last.pulse - angle) for last in self._last]
        self._now = (0.0, np.zeros(len(speeds)), speeds)

    def measure(
        self,
        *,
        time: float,
        speed: float,
        acceleration: float,
        wheels: "Array",
        angles: "Array",
        torques: "Array",
        pressures: "Array",
        demand: float,
        reservoir: float,
    ) -> VehicleMeasurement:
        """What the law sees at the present sample; the acceleration is that of the rails and brakes alone."""
        known = self._numbers
        told = speed * known["reference_factor"] + time * known["reference_drift"]
        told += self._noise(_TRAIN, known["reference_noise"])
        lost = [time >= since for since in self._lost.tolist()]
        measured = [
            float(wheel) * factor + self._noise(1 + axle, known["speed_noise"] / float(self._radius[axle]))
            for axle, (wheel, factor) in enumerate(
                zip(self._turning(time, wheels, angles), self._factors.tolist(), strict=True)
            )
        ]
        felt = acceleration + known["accelerometer_bias"]
        return VehicleMeasurement(
            speed=max(told, 0.0),
            wheel_speeds=tuple(0.0 if gone else max(w, 0.0) for w, gone in zip(measured, lost, strict=True)),
            torques=tuple((torques * known["torque_factor"]).tolist()),
            healthy=tuple(0.0 if gone else 1.0 for gone in lost),
            pressures=tuple((pressures * known["torque_factor"]).tolist()),
            acceleration=felt + self._noise(1 + len(measured), known["accelerometer_noise"]),
            demand=demand,
            reservoir=reservoir,
        )

    def decided(self, angles: "Array") -> None:
        """Go on to the next sample."""
        if self._numbers["pulse_angle"]:
            self._counted = self._pulses(angles)
        self._sample += 1

    def follow(self, time: float, angles: "Array", wheels: "Array") -> None:
        """Keep the steps in which the last two pulses came, at the end of a step."""
        began, starts, start_speeds = self._now
        pulse_angle = self._numbers["pulse_angle"]
        before, after = self._pulses(starts), self._pulses(angles)
        for axle, (old, new) in enumerate(zip(before, after, strict=True)):
            if new <= old:
                continue
            step = _Passing(
                *(began, time - began, float(starts[axle]), float(angles[axle])),
                *(float(start_speeds[axle]), float(wheels[axle]), (new - self._offsets[axle]) * pulse_angle),
            )
            one = new - old < 2.0
            self._previous[axle] = (
                self._last[axle]
                if one
                else step._replace(pulse=(new - 1.0 - self._offsets[axle]) * pulse_angle)
            )
            self._last[axle] = step
        self._now = (time, angles, wheels)

    def _turning(self, time: float, wheels: "Array", angles: "Array") -> "Array | list[float]":
        """Wheel speeds without noise."""
        angle = self._numbers["pulse_angle"]
        if not angle:
            return wheels
        if not self.timed:
            turned: Array = (self._pulses(angles) - self._counted) * angle / self._sample_time
            return turned
        seen = []
        for last, previous in zip(self._last, self._previous, strict=True):
            came = last.time()
            seen.append(angle / max(time - came, came - previous.time()))
        return seen

    def _pulses(self, angles: "Array") -> "Array":
        """Whole pulses up to an angle."""
        import numpy as np

        whole: Array = np.floor(angles / self._numbers["pulse_angle"] + self._offsets)
        return whole

    def _noise(self, whose: int, rms: float) -> float:
        if rms == 0.0:
            return 0.0
        first, second = map(_uniform, self._words(self._sample, whose, _NOISE))
        return rms * (math.sqrt(-2.0 * math.log(first)) * math.sin(2.0 * math.pi * second))

    def _words(self, sample: int, whose: int, what: int) -> list[int]:
        """Two random words of Philox; NumPy counts one up before it draws."""
        import numpy as np

        counter = np.array([sample, whose, what, 0], dtype=np.uint64)
        key = np.array([self._seed, 0], dtype=np.uint64)
        words: list[int] = np.random.Philox(counter=counter, key=key).random_raw(2).tolist()
        return words


def _uniform(word: int) -> float:
    return ((word >> 11) + 0.5) * 2.0**-53
