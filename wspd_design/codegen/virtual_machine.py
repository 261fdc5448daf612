"""The closed loop without a C compiler: integration steps in CasADi's virtual machine, the rest in Python.

Steps, their order and the events are those of ``templates/closed_loop.c``; a test holds the two together.
"""

import math
from collections import deque
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from wspd_design.codegen.bound import Bound
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.kernels import WINDOW, Kernels, plant_kernels
from wspd_design.codegen.law_library import virtual_law
from wspd_design.codegen.laws import law_kernels
from wspd_design.codegen.loop_numbers import LANE_TOTALS, RAIL_NUMBERS, STOP_TOTALS, LoopInput, LoopOutput
from wspd_design.codegen.plant_numbers import PARAMETERS
from wspd_design.codegen.sampled import BAD_COMMAND, BUFFER_FULL, GOOD, drive, flat
from wspd_design.codegen.virtual_coupled import TrackTable
from wspd_design.codegen.virtual_functions import StepFunctions, step_functions
from wspd_design.codegen.virtual_judgment import VirtualJudgment
from wspd_design.codegen.virtual_sensors import VirtualSensors
from wspd_design.codegen.virtual_step import INERTIA, MASS, RADIUS
from wspd_design.codegen.virtual_valves import START, VirtualValves
from wspd_design.controllers.protocol import Command, Law, State, VehicleMeasurement
from wspd_design.model.further_brakes import friction_share
from wspd_design.plants.protocol import Plant

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SHORTEST = 1e-9  # s: edges closer together than this are one
_BATCHES = (64, 16, 8, 4, 2)
_OFFSET = PARAMETERS.index(("surroundings", "axle_offset"))
_MAX_TORQUE = PARAMETERS.index(("brake", "max_torque"))
_GRADE = PARAMETERS.index(("surroundings", "grade_force"))
_DROP_SLIP = PARAMETERS.index(("dynamic", "drop_slip"))
_BLENDED = WINDOW.index("share")
_FIRST_RAIL = next(k for k, (record, _) in enumerate(PARAMETERS) if record == "rail")


def run_virtual(
    plant: Plant,
    controller: Law,
    given: LoopInput,
    *,
    sample_rows: int,
    disturbed: bool,
) -> LoopOutput:
    """Run a single stop; takes and returns what :meth:`ClosedLoop.run` does."""
    import numpy as np

    kernels = plant_kernels(plant, disturbed=disturbed)
    driven = _VirtualPlant(kernels, _functions(kernels, given.held_slips is not None, _track(given)), given)
    result, samples = drive(driven, _traced(controller, plant.axles), sample_rows)
    valves, judgment = driven.valves, driven.judgment
    valves.end(driven.part("filled"))
    counted = (valves.vented, valves.switches, valves.filled, valves.watchdog, judgment.slip_band)
    lane = np.vstack([driven.part("lane").reshape(-1, plant.axles), *counted])
    stop = [*driven.part("stop"), driven.part("speed")[0], judgment.speed_error, judgment.distance_error]
    stop_totals = {name: np.array([value]) for name, value in zip(STOP_TOTALS, stop, strict=True)}
    return LoopOutput(
        result=result,
        stopped=stop_totals["end_speed"] <= given.settings.stop_speed * (1.0 + 1e-6),
        lane_totals=dict(zip(LANE_TOTALS, lane, strict=True)),
        stop_totals=stop_totals,
        wheel_speeds=driven.wheels.copy(),
        trace=np.array(driven.rows).reshape(len(driven.rows), driven.layout.row),
        samples=samples,
        bad_command=driven.bad_command,
        steps=driven.steps,
    )


@lru_cache(maxsize=8)
def _functions(kernels: Kernels, holding: bool, track: TrackTable | None) -> StepFunctions:
    return step_functions(kernels, holding=holding, batches=() if holding else _BATCHES, track=track)


def _track(given: LoopInput) -> TrackTable | None:
    if given.track is None:
        return None
    return TrackTable(points=given.track.shape[1], again=given.track_again, spacing=given.track_spacing)


class _VirtualPlant:
    """The plant behind the interface of ``SampledPlant``."""

    def __init__(self, kernels: Kernels, functions: StepFunctions, given: LoopInput) -> None:
        import numpy as np

        self.given, self.set, self.kernels, self.layout = given, given.settings, kernels, functions.layout
        axles = self.layout.axles
        # The numbers of an axle are a column for CasADi and a row here.
        self._by_axle = np.array(given.lane_parameters.T, dtype=np.float64, order="C")
        self.parameters = self._by_axle.T
        self.state, self.inputs = np.zeros(self.layout.states), np.zeros(self.layout.inputs)
        self.part("speed")[:] = given.speeds[0]
        self.wheels[:] = given.wheel_speeds
        self.part("rest")[:] = given.rest[:, 0]
        table = np.zeros(0) if given.track is None else np.ascontiguousarray(given.track[0]).ravel()
        self.edges: tuple[float, ...] = ()
        self.valves = VirtualValves(given)
        self.sensors = VirtualSensors(given, self.parameters[RADIUS])
        self.judgment = VirtualJudgment(axles, given.settings)
        self.waiting: deque[tuple[float, tuple[Command, ...]]] = deque()
        self.dropped = np.zeros(axles, dtype=bool)  # electrodynamic brakes
        self.recorded = -1.0
        self.sample = self.steps = 0
        self._bends = _bends(given.load_factors)
        self._last_step = given.settings.longest_step
        self.patch = [0] * axles
        self.moving = bool(given.speeds[0] > given.settings.stop_speed)  # or at rest already
        self.rows: list[NDArray[np.float64]] = []
        self.bad_command = (0.0, 0.0, 0.0)
        self._steps = {
            number: Bound(function, self.state, self.inputs, table)
            for number, function in ((1, functions.single), *functions.batches.items())
        }
        self._observe = Bound(functions.observe, self.state, self.inputs, table)
        self._window = np.zeros((axles, len(WINDOW)))
        self._kinks = Bound(kernels.kinks.map(axles), self._by_axle, self._window)
        self._window_constants = Bound(kernels.window_constants.map(axles), self._by_axle, self._window)
        self._write_fixed_inputs()
        self._close_valves()
        if kernels.coupled and given.trace_rows:
            self.rows.append(self._first_row())
            self.recorded = 0.0

    def part(self, name: str) -> "Array":
        """One part of the state, to read and to write."""
        return self.state[self.layout.state[name]]

    @property
    def wheels(self) -> "Array":
        """Wheel speeds, to read and to write [rad/s]."""
        return self.part("axle")[: self.layout.axles]

    def _give(self, name: str, values: Any) -> None:
        self.inputs[self.layout.given[name]] = values

    def _write_fixed_inputs(self) -> None:
        settings = self.set
        for name in ("longest_step", "creep_rate", "slope_limit"):
            self._give(name, getattr(settings, name))
        for name in ("regularization_speed", "stop_speed", "judging_speed"):
            self._give(name, getattr(settings, name))
        self._give("scale", 1.0)
        self._give("load_factors", [0.0, *[1.0] * self.layout.axles, *[0.0] * self.layout.axles])
        self._give("radius", self.parameters[RADIUS])
        self._give("inertia", self.parameters[INERTIA])
        self._give("mass", self.parameters[MASS, 0])
        self._stop_constants = self.kernels.stop_constants(self.given.stop_parameters[:, 0])
        self._give("stop_constants", _flat(self._stop_constants))
        self._give("offset", self.parameters[_OFFSET])
        self._work_out_lanes()

    def _work_out_lanes(self) -> None:
        """Work out the constants of wheelsets and vehicle for the rails that lie below the wheels."""
        self._give("lane_constants", _flat(self.kernels.lane_constants(self.parameters)))
        if self.kernels.coupled:
            given = self.given
            rails = self.parameters[_FIRST_RAIL : _FIRST_RAIL + RAIL_NUMBERS].ravel()
            constants = self.kernels.whole.vehicle_constants(
                given.stop_parameters[:, 0], given.numbers[:, 0], rails
            )
            self._give("vehicle_constants", _flat(constants))

    def _first_row(self) -> "Array":
        """The row of the traces at the start."""
        import numpy as np

        begin = [self.part(name) for name in ("time", "speed", "distance")]
        present = [self.part(name) for name in ("slip", "passed", "load", "given", "dynamic")]
        others = self.part("axle")[self.layout.axles :]
        row: Array = np.concatenate([*begin, self.wheels, *present, others, self.part("further")])
        return row

    def running(self) -> bool:
        return self.moving and self.part("time")[0] <= self.set.time_limit

    @property
    def angles(self) -> "Array":
        """Angles that the wheels have turned [rad]."""
        angles: Array = self.part("lane").reshape(-1, self.layout.axles)[LANE_TOTALS.index("angle")]
        return angles

    @property
    def wheelsets(self) -> int:
        return self.layout.axles

    def measure(self) -> VehicleMeasurement:
        time = float(self.part("time")[0])
        return self.sensors.measure(
            time=time,
            speed=float(self.part("speed")[0]),
            acceleration=float(self.part("rates")[0])
            + float(self.parameters[_GRADE, 0] / self.parameters[MASS, 0]),
            wheels=self.wheels,
            angles=self.angles,
            torques=self.part("torque") + self.part("dynamic"),
            pressures=self.part("pressure"),
            demand=float(self.kernels.demand(self._stop_constants, time)),
            reservoir=self.valves.reservoir,
        )

    def judge(self, speed: float | None, references: tuple[float, ...]) -> None:
        self.judgment.judge(
            speed,
            references,
            true_speed=float(self.part("speed")[0]),
            distance=float(self.part("distance")[0]),
            slips=self.part("slip"),
        )

    def advance(self, commands: tuple[Command, ...]) -> int:
        h, dead_time = self.set.sample_time, float(self.given.disturbance("dead_time")[0])
        start = self.sample * h
        for fill, vent in commands:
            if not (0.0 <= fill <= 1.0 and vent >= 0.0 and fill + vent <= 1.0 + 1e-9):
                self.bad_command = (start, fill, vent)
                return BAD_COMMAND
        self.sensors.decided(self.angles)
        self.waiting.append((start + dead_time, commands))
        self.sample += 1
        end, result = self.sample * h, GOOD
        while self.waiting and self.waiting[0][0] <= end and result == GOOD:
            time, due = self.waiting.popleft()
            result = self._follow_until(time)
            if self.moving:
                present = float(self.part("time")[0])
                self.valves.follow(due, present, self.part("pressure"), self.part("filled"))
                self._blend()
                self._set_windows()
        return result or self._follow_until(end)

    def _set_windows(self) -> None:
        """Work out the constants of the actuators for the patterns of the valves."""
        import numpy as np

        self._window[:, :_BLENDED] = self.valves.patterns
        self._window_constants.call()
        self._give("window_constants", self._window_constants.outputs[0].ravel())
        self._kinks.call()
        kinks = self._kinks.outputs[0].ravel()
        self.edges = tuple(sorted({*self.valves.edges, *kinks[np.isfinite(kinks)].tolist()}))

    def _blend(self) -> None:
        """Say what is asked of the friction brakes whose patterns begin now, and where the electrodynamic ones go to.

        An electrodynamic brake drops out when its wheel slides too much, for the rest of the stop.
        """
        import numpy as np

        begun = self.valves.patterns[:, START] == self.part("time")[0]
        self.dropped |= begun & (self.part("slip") > self.parameters[_DROP_SLIP])
        demanded = self.parameters[_MAX_TORQUE].tolist()
        shares = list(map(friction_share, self.part("dynamic").tolist(), demanded))
        goals = np.where(self.dropped, 0.0, 1.0)
        self._window[begun, _BLENDED:] = np.stack([shares, self.part("level"), goals], axis=1)[begun]

    def _close_valves(self) -> None:
        """Begin with closed valves."""
        self._set_windows()
        present = [self.kernels.actuator(constants, 0.0) for constants in self._window_constants.outputs[0]]
        names = ("pressure", "torque", "filled", "damping", "level")
        for name, values in zip(names, zip(*present, strict=True), strict=True):
            self.part(name)[:] = [float(value) for value in values]
        self._look_up()
        self._work_out_stage()

    def _follow_until(self, goal: float) -> int:
        """Advance to a time; watchdogs may fill on the way."""
        result = GOOD
        while self.moving and result == GOOD and (watched := self.valves.watch_time) < goal - _SHORTEST:
            result = self._advance_to(watched)
            if self.moving:
                self.valves.watch(float(self.part("time")[0]), self.part("pressure"), self.part("filled"))
                self._blend()
                self._set_windows()
        return result or self._advance_to(goal)

    def _advance_to(self, goal: float) -> int:
        result = GOOD
        while self.moving and result == GOOD and (time := float(self.part("time")[0])) < goal:
            near = (edge for edge in self.edges if time + _SHORTEST < edge < goal - _SHORTEST)
            result = self._advance_some(next(near, goal))
        return result

    def _work_out_stage(self) -> None:
        self._observe.call()
        self.state[:] = self._observe.outputs[0][0]

    def _advance_some(self, until: float) -> int:
        """Make one step, or several where nothing has to be looked up on the way."""
        time = float(self.part("time")[0])
        soonest, number = self._lay_rails(), 1
        if soonest > until - time and self.given.held_slips is None:
            needed = math.ceil((until - time) / min(self._last_step, self.set.longest_step))
            number = next((batch for batch in _BATCHES if batch <= needed), 1)
        self._give("until", until)
        self._give("soonest", soonest)
        self._give("scale", 1.0)
        self._give("last_cut", 0.0)
        self._look_up()
        rows = self._step(number)
        kept = int(rows[:, self.layout.row].sum())
        result = self._follow(rows[:kept])
        cut = kept < number and float(self.part("time")[0]) < until and rows[kept, self.layout.row + 1] < 1.0
        if cut:  # once more up to the event
            scale = rows[kept, self.layout.row + 1]
            self._give("scale", scale)
            rows = self._step(1)
            if not rows[0, self.layout.row]:  # an event is found by interpolation, and once more
                self._give("scale", scale * rows[0, self.layout.row + 1])
                self._give("last_cut", 1.0)
                rows = self._step(1)
            result = result or self._follow(rows)
            kept += 1
        else:
            self._last_step = (float(self.part("time")[0]) - time) / kept
        self.steps += kept
        self.moving = bool(self.part("speed")[0] > self.set.stop_speed * (1.0 + 1e-6))
        return result

    def _step(self, number: int) -> "Array":
        """Advance the state; returns one row per step."""
        steps = self._steps[number]
        steps.call()
        self.state[:] = steps.outputs[0][0]
        return steps.outputs[1]

    def _lay_rails(self) -> float:
        """Put the wheels on the rail of their place; the time to the next change of rail or kink of the loads."""
        given, soonest = self.given, math.inf
        distance = float(self.part("distance")[0])
        if given.patch_starts is not None and given.patch_rails is not None:
            changed = False
            for axle in range(self.layout.axles):
                place = distance - self.parameters[_OFFSET, axle]
                reached = self.patch[axle]
                while reached < len(given.patch_starts) and given.patch_starts[reached, 0] <= place:
                    reached += 1
                if reached != self.patch[axle]:
                    rail = given.patch_rails[reached - 1, 0]
                    self.parameters[_FIRST_RAIL : _FIRST_RAIL + RAIL_NUMBERS, axle] = rail
                    self.patch[axle] = reached
                    changed = True
            if changed:
                self._work_out_lanes()
                self._work_out_stage()
            for axle, reached in enumerate(self.patch):
                if reached < len(given.patch_starts):
                    place = distance - self.parameters[_OFFSET, axle]
                    soonest = min(soonest, self._wait_for(float(given.patch_starts[reached, 0] - place)))
        if given.load_factors is not None and given.load_spacings is not None:
            place = math.floor(distance / given.load_spacings[0] + 1e-6)
            point = next((bend for bend in self._bends if bend > place), None)
            if point is not None:
                soonest = min(soonest, self._wait_for(point * float(given.load_spacings[0]) - distance))
        return soonest

    def _wait_for(self, ahead: float) -> float:
        """Time to a place ahead under the present deceleration, and a little more so that it is reached."""
        speed = float(self.part("speed")[0])
        square = speed * speed + 2.0 * float(self.part("rates")[0]) * ahead
        return 2.0 * ahead / (speed + math.sqrt(square)) + _SHORTEST if square > 0.0 else math.inf

    def _look_up(self) -> None:
        """Take the wheel loads and the slips to be held from their tables."""
        import numpy as np

        given, speed = self.given, float(self.part("speed")[0])
        if given.load_factors is not None and given.load_spacings is not None:
            distance, spacing = float(self.part("distance")[0]), float(given.load_spacings[0])
            k = math.floor(distance / spacing + 1e-6)
            last = given.load_factors.shape[1] - 1
            here, above = (given.load_factors[:, min(point, last)] for point in (k, k + 1))
            self._give("load_factors", np.concatenate([[k * spacing], here, (above - here) / spacing]))
        if given.held_slips is not None:
            first, spacing = (
                math.log(given.held_speeds[0]),
                math.log(given.held_speeds[1] / given.held_speeds[0]),
            )
            k = min(max(int((math.log(speed) - first) / spacing), 0), given.held_slips.shape[1] - 2)
            here, above = given.held_slips[:, k], given.held_slips[:, k + 1]
            below = given.held_slips[:, k - 1] if k > 0 else 2.0 * here - above
            further = given.held_slips[:, k - 2] if k > 1 else 2.0 * below - here
            self._give("hold", np.concatenate([[first, spacing, k], further, below, here, above]))

    def _follow(self, rows: "Array") -> int:
        """Tell the sensors and the traces of the steps that were made."""
        axles = self.layout.axles
        for row in rows if self.sensors.timed else ():
            self.sensors.follow(float(row[0]), row[-axles:].copy(), row[3 : 3 + axles].copy())
        return self._record(rows)

    def _record(self, rows: "Array") -> int:
        """Keep a row of the traces whenever the interval has passed, and the last one."""
        for row in rows if self.given.trace_rows else ():
            time, speed = row[0], row[1]
            last = speed <= self.set.stop_speed * (1.0 + 1e-6)
            if time - self.recorded >= self.set.record_interval or last:
                if len(self.rows) == self.given.trace_rows:
                    return BUFFER_FULL
                self.recorded = time
                self.rows.append(row[: self.layout.row].copy())
        return GOOD


class _Traced:
    """A law of a vehicle whose functions run in the virtual machine."""

    def __init__(self, controller: Law, wheelsets: int) -> None:
        import numpy as np

        self.name, self.sample_time, self.wheelsets = controller.name, controller.sample_time, wheelsets
        self.memory = getattr(controller, "memory", ())
        kernels = law_kernels(controller)
        law, self._states = virtual_law(kernels, axles=wheelsets, stops=1), kernels.states_of_stop(wheelsets)
        self._state, self._gains = np.zeros(self._states), np.array(kernels.gains)
        self._seen = np.zeros(law.start.size1_in(0))
        self._start = Bound(law.start, self._seen, self._gains)
        self._step = Bound(law.step, self._state, self._seen, self._gains)

    def start(self, measurement: VehicleMeasurement) -> State:
        self._seen[:] = flat(measurement)
        self._start.call()
        return tuple(self._start.outputs[0].ravel().tolist())

    def step(self, state: State, measurement: VehicleMeasurement) -> tuple[State, tuple[Command, ...]]:
        self._state[:] = state
        self._seen[:] = flat(measurement)
        self._step.call()
        decided = self._step.outputs[0].ravel().tolist()
        following, fill = decided[: self._states], decided[self._states : self._states + self.wheelsets]
        vent = decided[self._states + self.wheelsets :]
        return tuple(following), tuple(map(Command, fill, vent))


def _traced(controller: Law, wheelsets: int) -> Law:
    """The law in the virtual machine, or as it is where that cannot be."""
    try:
        return _Traced(controller, wheelsets)
    except UntraceableError:
        return controller


def _bends(factors: "Array | None") -> list[int]:
    """Points at which a table of loads bends; after its last value it is even."""
    import numpy as np

    if factors is None:
        return []
    slopes = np.diff(factors, axis=1, append=factors[:, -1:])
    return [int(k) + 1 for k in np.flatnonzero((np.diff(slopes, axis=1) != 0.0).any(axis=0))]


def _flat(values: Any) -> "Array":
    import numpy as np

    return np.array(values).ravel(order="F")
