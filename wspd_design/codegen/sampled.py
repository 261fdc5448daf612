"""Closing the loop in Python: a plant that is advanced from sample to sample, and its law."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from wspd_design.codegen.loop_numbers import LANE_SEEN, STOP_SEEN
from wspd_design.controllers.protocol import (
    TRAIN_SPEED,
    ByWheelset,
    Command,
    Law,
    VehicleController,
    VehicleMeasurement,
    acts_on_vehicle,
    slip_reference_name,
)
from wspd_design.model.number import Number

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

GOOD, BUFFER_FULL, BAD_COMMAND = range(3)
"""Result codes of a run, as in ``templates/closed_loop.c``."""


class SampledPlant(Protocol):
    """One stop that is advanced from sample to sample."""

    @property
    def wheelsets(self) -> int:
        """Number of wheelsets."""

    def running(self) -> bool:
        """Tell whether the train moves and the time limit is not reached."""

    def measure(self) -> VehicleMeasurement:
        """Return what the law sees."""

    def judge(self, speed: float | None, references: tuple[float, ...]) -> None:
        """Compare the train speed that the law goes by and the slips that it holds with the truth."""

    def advance(self, commands: tuple[Command, ...]) -> int:
        """Run to the next sample; 0 when all went well."""


def drive(plant: SampledPlant, controller: Law, sample_rows: int) -> tuple[int, "Array"]:
    """Close the loop in Python. Returns the result code and the samples, as :class:`LoopOutput` has them."""
    import numpy as np

    law = of_vehicle(controller, plant.wheelsets)
    speed, reference = places_told(controller)
    state = law.start(plant.measure())
    rows: list[list[float]] = []
    result = GOOD
    while plant.running() and result == GOOD:
        if len(rows) == sample_rows:
            result = BUFFER_FULL
            break
        seen = plant.measure()
        state, commands = law.step(state, seen)
        held = () if reference < 0 else state[reference : reference + plant.wheelsets]
        plant.judge(None if speed < 0 else float(state[speed]), tuple(map(float, held)))
        decided = (*state, *(each.fill for each in commands), *(each.vent for each in commands))
        rows.append([len(rows) * law.sample_time, *map(float, decided), *map(float, flat(seen))])
        result = plant.advance(commands)
    width = 1 + len(state) + (2 + LANE_SEEN) * plant.wheelsets + STOP_SEEN
    return result, np.asarray(rows, dtype=np.float64).reshape(len(rows), width)


def of_vehicle(law: Law, wheelsets: int) -> VehicleController:
    """Return a law of a vehicle: itself, or one that asks a law of one wheelset for each of them."""
    return law if acts_on_vehicle(law) else ByWheelset(law=law, wheelsets=wheelsets)


def places_told(law: Law) -> tuple[int, int]:
    """Places in the state of a law of a vehicle: of its train speed, and of the first slip that it holds.

    They are found by their names in ``memory``; -1 for what it does not tell.
    """
    memory = tuple(getattr(law, "memory", ())) if acts_on_vehicle(law) else ()
    names = (TRAIN_SPEED, slip_reference_name(1))
    speed, reference = (memory.index(name) if name in memory else -1 for name in names)
    return speed, reference


def measurement_of(numbers: Sequence[Number], wheelsets: int) -> VehicleMeasurement:
    """Return what a law of a vehicle sees, from its numbers: of all wheelsets, then of the vehicle."""
    speeds, wheels, torques, healthy, pressures = (
        tuple(numbers[row * wheelsets : (row + 1) * wheelsets]) for row in range(LANE_SEEN)
    )
    acceleration, demand, reservoir = numbers[LANE_SEEN * wheelsets :]
    return VehicleMeasurement(
        speed=speeds[0],
        wheel_speeds=wheels,
        torques=torques,
        healthy=healthy,
        pressures=pressures,
        acceleration=acceleration,
        demand=demand,
        reservoir=reservoir,
    )


def flat(seen: VehicleMeasurement) -> tuple[Number, ...]:
    """Return the numbers of a measurement, in the order of :func:`measurement_of`."""
    speeds = (seen.speed,) * len(seen.wheel_speeds)
    of_wheelsets = (*speeds, *seen.wheel_speeds, *seen.torques, *seen.healthy, *seen.pressures)
    return (*of_wheelsets, seen.acceleration, seen.demand, seen.reservoir)
