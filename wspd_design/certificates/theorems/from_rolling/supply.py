"""Torque and supply while the valve fills from rest: closed forms over time, and what they are at a torque.

Times are in samples from when the brake is demanded. The supply rises to the full pressure at a rate s, and from the
first sample on the cylinder follows it with the rate tau: with u = t - 1

    supply = U (1 - exp(-s t)),   T = U (1 - exp(-tau u) - b (exp(-s u) - exp(-tau u))),   b = tau exp(-s)/(tau - s).

At a torque T' = tau room rises with the supply rate and falls with the fill time, the room rises with both, and both
have one maximum over the torque: docs/theory.md#bounds-of-ways-in.
"""

from typing import NamedTuple

import numpy as np

from wspd_design.certificates.kernel.interval import Array

SPARE = 1e-9  # relative, by which what is worked out here is made larger or smaller: rounding is far less
LATER = 1e-3  # samples, by which times of a torque are moved so that the torque is passed for sure
STEPS = 4  # of Newton's method, each from the time of a torque a little lower


class Filling(NamedTuple):
    """Pure filling from rest, for one corner of the numbers of each cell."""

    full: float  # U [rad/s]
    supply_rate: Array  # s, per sample
    fill_rate: Array  # tau, per sample

    def torque(self, time: Array) -> Array:
        """Torque [rad/s]."""
        u = np.maximum(time - 1.0, 0.0)
        late = self.fill_rate * np.exp(-self.supply_rate) / (self.fill_rate - self.supply_rate)
        slow, fast = np.exp(-self.supply_rate * u), np.exp(-self.fill_rate * u)
        found: Array = self.full * (1.0 - fast - late * (slow - fast))
        return found

    def room(self, time: Array) -> Array:
        """Supply above the torque [rad/s]."""
        found: Array = self.full * (1.0 - np.exp(-self.supply_rate * time)) - self.torque(time)
        return found

    def rate(self, time: Array) -> Array:
        """Rate of the torque [rad/s per sample]."""
        found: Array = self.fill_rate * self.room(time)
        return found

    @property
    def peak(self) -> Array:
        """When the room is largest."""
        late = self.fill_rate * np.exp(-self.supply_rate) / (self.fill_rate - self.supply_rate)
        fast, slow = 1.0 - late, late - np.exp(-self.supply_rate)
        ratio = -self.fill_rate * fast / (self.supply_rate * slow)
        found: Array = 1.0 + np.log(np.maximum(ratio, 1.0)) / (self.fill_rate - self.supply_rate)
        return found

    def column(self) -> "Filling":
        """Return the same for arrays of times, a row for each cell."""
        return Filling(self.full, self.supply_rate[:, None], self.fill_rate[:, None])

    def near(self, torque: Array, guess: Array) -> Array:
        """Return about when there is a torque; from a time at which there is less."""
        time = guess
        for _ in range(STEPS):
            slope = np.maximum(self.rate(time), 1e-9)
            time = np.maximum(time + (torque - self.torque(time)) / slope, 1.0)
        return time

    def until(self, torque: Array, guess: Array) -> Array:
        """Return a time at which there is a torque or more; infinite if none was found."""
        time = self.near(torque, guess) + LATER
        return np.where(self.torque(time) >= torque + SPARE, time, np.inf)

    def since(self, torque: Array, guess: Array) -> Array:
        """Return a time before which there is less than a torque."""
        time = np.maximum(self.near(torque, guess) - LATER, 1.0)
        return np.where((self.torque(time) <= torque - SPARE) | (time <= 1.0), time, 1.0)
