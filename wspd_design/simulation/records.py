"""What goes into a simulated stop and what comes out of it."""

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Trace = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """A stop on level, straight track."""

    rail: Rail
    initial_speed: float  # m/s
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse a speed that is no speed."""
        if not 0.0 < self.initial_speed < 150.0:
            raise UserError(
                f"initial speed = {self.initial_speed:g} m/s must be above 0 and below 150 m/s (540 km/h); "
                'give it with its unit, for example "120 km/h"'
            )

    @classmethod
    def stop(cls, *, from_kmh: float, rail: Rail, seed: int = 0) -> "Scenario":
        """Brake to standstill from a speed in km/h."""
        return cls(rail=rail, initial_speed=from_kmh / 3.6, seed=seed)


class Ending(Enum):
    """How a run ended; the value says what it means to the reader."""

    STOPPED = "the train came to a standstill"
    TIME_LIMIT = (
        "the train was still moving at the time limit; more brake torque, another controller "
        "or a lower initial speed is needed"
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """What one controller did at one sampling instant."""

    time: float  # s
    fill: float  # share of the sample time
    vent: float
    state: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Totals:
    """Integrals over a run; torques and their work are sums over all wheelsets."""

    distance: float  # m
    torque: float  # N m s, transmitted braking torque
    resistance_impulse: float  # N s
    damping_impulse: float  # N m s, sum over wheels
    brake_work: float  # J
    sliding_work: float  # J
    resistance_work: float  # J
    damping_work: float  # J
    lock_time: float  # s, longest of the wheelsets
    judged_time: float  # s, above the judging speed
    slip: float  # s, integral of the slip over the judged time
    slip_squared: float  # s


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """A simulated stop. Traces are arrays over time; those of a wheelset have a second axis."""

    controller: str
    vehicle: str
    rail: str
    plant: str
    sample_time: float  # s
    initial_speed: float  # m/s
    ending: Ending
    time: "Trace"  # s
    speed: "Trace"  # m/s
    distance: "Trace"  # m
    wheel_speed: "Trace"  # rad/s, per wheelset
    slip: "Trace"  # -, per wheelset
    torque: "Trace"  # N m, per wheelset, transmitted
    samples: tuple[Sample, ...]
    totals: Totals
    final_wheel_speed: float  # rad/s
    slip_max: float  # -, above the judging speed
