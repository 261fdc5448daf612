"""Closing the loop in Python: a plant that is advanced from sample to sample, and the law of each axle."""

from typing import TYPE_CHECKING, Protocol

from wspd_design.controllers.protocol import Command, Controller, Measurement

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

GOOD, BUFFER_FULL, BAD_COMMAND = range(3)
"""Result codes of a run, as in ``templates/closed_loop.c``."""


class SampledPlant(Protocol):
    """One stop that is advanced from sample to sample."""

    def running(self) -> bool:
        """Tell whether the train moves and the time limit is not reached."""

    def measure(self) -> list[Measurement]:
        """Return what the controller of each axle sees."""

    def advance(self, commands: list[Command]) -> int:
        """Run to the next sample; 0 when all went well."""


def drive(plant: SampledPlant, controller: Controller, sample_rows: int) -> tuple[int, "Array"]:
    """Close the loop in Python: one controller per axle. Returns the result code and the samples."""
    import numpy as np

    states = [controller.start(measurement) for measurement in plant.measure()]
    rows: list[list[float]] = []
    result = GOOD
    while plant.running() and result == GOOD:
        if len(rows) == sample_rows:
            result = BUFFER_FULL
            break
        seen = plant.measure()
        decided = [controller.step(state, m) for state, m in zip(states, seen, strict=True)]
        states, commands = [state for state, _ in decided], [command for _, command in decided]
        by_element = zip(*states, strict=True) if states[0] else ()
        lists = [*by_element, *zip(*commands, strict=True), *zip(*seen, strict=True)]
        rows.append([len(rows) * controller.sample_time, *(float(x) for element in lists for x in element)])
        result = plant.advance(commands)
    width = 1 + len(states) * (len(states[0]) + 5)
    return result, np.asarray(rows, dtype=np.float64).reshape(len(rows), width)
