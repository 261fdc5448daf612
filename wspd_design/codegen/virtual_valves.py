"""Valves, reservoir and watchdogs of a stop in the virtual machine: as ``act`` of ``templates/closed_loop.c``."""

import math
from typing import TYPE_CHECKING

from wspd_design.codegen.loop_numbers import STUCK_VALVES, LoopInput
from wspd_design.codegen.plant_numbers import PARAMETERS
from wspd_design.codegen.valves import CLOSED, followed
from wspd_design.controllers.protocol import Command

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SHORTEST = 1e-9  # s: times closer together than this are one
_DRAIN = PARAMETERS.index(("surroundings", "reservoir_drain"))
_OPEN = Command(fill=1.0, vent=0.0)
_STUCK = {"holds": CLOSED, "vents": Command(fill=0.0, vent=1.0), "fills": _OPEN}
START, START_PRESSURE, FILL_END, VENT_END, RESERVOIR = range(5)
"""Columns of the patterns."""


class VirtualValves:
    """What the valves of all wheelsets follow, and what is counted of it."""

    def __init__(self, given: LoopInput) -> None:
        import numpy as np

        axles = len(given.pressures)
        self._sample_time = given.settings.sample_time
        self._shortest = float(given.disturbance("shortest_pulse")[0])
        self._longest = float(given.disturbance("longest_release")[0])
        self._full = float(given.disturbance("reservoir_pressure")[0])
        self._drain = np.array(given.lane_parameters[_DRAIN])
        self._stuck = [round(number) for number in given.fault("stuck").tolist()]
        self._stuck_since = given.fault("stuck_since").tolist()
        self._following = [CLOSED] * axles
        self._states = [-1] * axles  # last states: fill, vent, hold; -1 before the first
        self._last_filled = np.zeros(axles)
        self._watched = [False] * axles
        self.patterns = np.zeros((axles, 5))
        self.patterns[:, START_PRESSURE], self.patterns[:, RESERVOIR] = given.pressures, self._full
        self.vented, self.switches, self.filled, self.watchdog = (np.zeros(axles) for _ in range(4))

    @property
    def edges(self) -> tuple[float, ...]:
        """When valves close, in order."""
        return tuple(sorted({*self.patterns[:, FILL_END].tolist(), *self.patterns[:, VENT_END].tolist()}))

    @property
    def watch_time(self) -> float:
        """When the next watchdog fills; infinite without one."""
        return min(map(self._watch_time, range(len(self._watched))))

    def _watch_time(self, axle: int) -> float:
        waits = self._longest > 0.0 and not self._watched[axle]
        return float(self._last_filled[axle]) + self._longest if waits else math.inf

    def _stuck_in(self, axle: int, present: float) -> Command | None:
        """What the valves of a wheelset do that no longer follow commands."""
        stuck = self._stuck[axle] and present >= self._stuck_since[axle]
        return _STUCK[STUCK_VALVES[self._stuck[axle] - 1]] if stuck else None

    @property
    def reservoir(self) -> float:
        """Pressure of the reservoir after what was counted [Pa]."""
        return self._full - float(self._drain @ self.filled)

    def follow(
        self, commands: tuple[Command, ...], present: float, pressures: "Array", filled: "Array"
    ) -> None:
        """Let every wheelset follow its command; ``filled`` is the pressure without venting since the last one."""
        h = self._sample_time
        for axle, command in enumerate(commands):
            before = self._following[axle]
            fill, vent = followed(command, before, sample_time=h, shortest_pulse=self._shortest)
            if fill > 0.0:
                self._last_filled[axle], self._watched[axle] = present + fill * h, False
            elif self._watched[axle]:
                fill, vent = _OPEN
            fill, vent = self._stuck_in(axle, present) or (fill, vent)
            fill_end = present + fill * h
            vent_end = present + h if 1.0 - fill - vent < 1e-12 else fill_end + vent * h
            self._following[axle] = Command(fill=fill, vent=vent)
            self._begin_pattern(axle, (present, float(pressures[axle]), fill_end, vent_end), filled)
        self.patterns[:, RESERVOIR] = self.reservoir

    def watch(self, present: float, pressures: "Array", filled: "Array") -> None:
        """Let the watchdogs fill that have waited long enough, until the next command acts."""
        for axle in range(len(self._watched)):
            if self._watch_time(axle) > present + _SHORTEST:
                continue
            done = self._stuck_in(axle, present) or _OPEN
            self._watched[axle], self._following[axle] = True, done
            self.watchdog[axle] += 1.0
            fill_end = 1e300 if done.fill else present
            vent_end = fill_end if not done.vent else 1e300
            self._begin_pattern(axle, (present, float(pressures[axle]), fill_end, vent_end), filled)
            self.patterns[axle, RESERVOIR] = self.reservoir

    def end(self, filled: "Array") -> None:
        """Count what was filled last."""
        import numpy as np

        self.filled += np.maximum(filled - self.patterns[:, START_PRESSURE], 0.0)

    def _begin_pattern(self, axle: int, pattern: tuple[float, float, float, float], filled: "Array") -> None:
        """Close the accounts of a pattern; ``filled`` begins anew."""
        # Nothing where the cylinder was let down.
        self.filled[axle] += max(float(filled[axle] - self.patterns[axle, START_PRESSURE]), 0.0)
        self.vented[axle] += filled[axle] - pattern[START_PRESSURE]
        filled[axle] = pattern[START_PRESSURE]
        self.patterns[axle, :RESERVOIR] = pattern
        fill, vent = self._following[axle]
        for state, share in enumerate((fill, vent, 1.0 - fill - vent)):
            if share > 1e-9:
                self.switches[axle] += self._states[axle] not in (-1, state)
                self._states[axle] = state
