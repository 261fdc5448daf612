"""What a law goes by against the truth, without a C compiler: as ``wspd_judge`` of ``templates/closed_loop.c``."""

import math
from typing import TYPE_CHECKING

from wspd_design.codegen.loop_numbers import DISTANCE_TOLERANCE, ERROR_SPEED, Settings

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class VirtualJudgment:
    """Largest errors so far of the train speed that a law goes by, of its integral, and of the slips that it holds."""

    def __init__(self, axles: int, settings: Settings) -> None:
        import numpy as np

        self._sample_time, self._judging = float(settings.sample_time), float(settings.judging_speed)
        self.speed_error = self.distance_error = 0.0
        self.slip_band = np.full(axles, -1.0)
        self._estimated: float | None = None
        self._travelled = 0.0

    def judge(
        self,
        speed: float | None,
        references: tuple[float, ...],
        *,
        true_speed: float,
        distance: float,
        slips: "Array",
    ) -> None:
        """Judge a sample; what the law does not tell is None or empty."""
        if speed is not None:
            if self._estimated is not None:
                self._travelled += 0.5 * self._sample_time * (self._estimated + speed)
            self._estimated = speed
            free, share = DISTANCE_TOLERANCE
            away = abs(self._travelled - distance) / (free + share * distance)
            self.distance_error = _larger(self.distance_error, away)
            if true_speed > ERROR_SPEED:
                self.speed_error = _larger(self.speed_error, abs(speed / true_speed - 1.0))
        for axle, reference in enumerate(references if true_speed > self._judging else ()):
            over = float(slips[axle]) - reference
            if over >= 0.0 or self.slip_band[axle] >= 0.0 or math.isnan(over):
                self.slip_band[axle] = _larger(max(float(self.slip_band[axle]), 0.0), abs(over))


def _larger(worst: float, error: float) -> float:
    """The larger of two errors; a number that is none is an error without end."""
    return math.inf if math.isnan(error) else max(worst, error)
