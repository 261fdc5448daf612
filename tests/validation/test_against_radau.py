"""Ten stops of four axles with locks, changes of rail and grades against SciPy's Radau method at rtol 1e-12.

The other simulation is :mod:`independent_four_axles`. It takes a minute for each stop, so that its distances and times
stand here; the slow tests work them out again.
"""

from dataclasses import dataclass

from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where


@dataclass(frozen=True)
class LockAndRelease:
    """Fill until the wheels are locked, vent until they roll, and again."""

    period: float = 2.0
    name: str = "lock and release"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return (1e-9,)

    def step(self, state, measurement):  # noqa: ARG002
        (time,) = state
        again = where(time >= self.period, 0.0, time)
        fill = where(again < 0.6 * self.period, 0.93, 0.0)
        return (again + self.sample_time,), Command(fill=fill, vent=where(fill > 0.0, 0.0, 0.87))


@dataclass(frozen=True)
class Case:
    """A stop, and what Radau finds."""

    law: str
    rail: str
    kmh: float
    distance: float  # m
    time: float  # s
    patches: tuple = ()
    grade: float = 0.0
    locks: bool = False
