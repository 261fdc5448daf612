"""Torque and supply while the valve fills from rest: closed forms over time, and what they are at a torque.

Times are in samples from when the brake is demanded. The supply rises to the full pressure at a rate s, and from the
first sample on the cylinder follows it with the rate tau: with u = t - 1

    supply = U (1 - exp(-s t)),   T = U (1 - exp(-tau u) - tau exp(-s) (exp(-s u) - exp(-tau u))/(tau - s)).

At a torque T' = tau room rises with the supply rate and falls with the fill time, the room rises with both, and both
have one maximum over the torque: docs/theory.md#bounds-of-ways-in.
"""

from typing import NamedTuple

import numpy as np

from wspd_design.certificates.kernel.interval import Array

SPARE = 1e-9  # relative, by which what is worked out here is made larger or smaller: rounding is far less
LATER = 1e-3  # samples, by which times of a torque are moved so that the torque is passed for sure
CLOSE = 1e-12  # per sample, of two rates that count as one
HALVINGS = 40  # of the times between which the room is largest
STEPS = 4  # of Newton's method, each from the time of a torque a little lower


class Filling(NamedTuple):
    """Pure filling from rest, for one corner of the numbers of each cell."""

    full: float  # U [rad/s]
    supply_rate: Array  # s, per sample
    fill_rate: Array  # tau, per sample

    def torque(self, time: Array) -> Array:
        """Torque [rad/s]."""
        u = np.maximum(time - 1.0, 0.0)
        found: Array = self.full * (
            -np.expm1(-self.fill_rate * u)
            - self.fill_rate * np.exp(-self.supply_rate - self.fill_rate * u) * self._grown(u)
        )
        return found

    def _grown(self, u: Array) -> Array:
        """(exp((tau - s) u) - 1)/(tau - s), u where both rates are nearly the same."""
        apart = self.fill_rate - self.supply_rate
        close = np.abs(apart) < CLOSE
        found: Array = np.where(
            close, u, np.expm1(np.minimum(apart * u, 700.0)) / np.where(close, 1.0, apart)
        )
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
        """When the room is largest: it rises by what the supply does, less what the torque does."""
        # log(a/b)/(a - b) is at most one over the smaller of two rates.
        low, high = np.ones_like(self.fill_rate), 2.0 + 1.0 / np.minimum(self.fill_rate, self.supply_rate)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            rises = self.full * self.supply_rate * np.exp(-self.supply_rate * middle) > self.rate(middle)
            low, high = np.where(rises, middle, low), np.where(rises, high, middle)
        return high

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
