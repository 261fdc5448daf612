"""The compiled closed loop: the plant as one library, the law as another, run on arrays of numbers.

One library of a plant serves all vehicles of as many axles, all rails and all laws. One lane is one wheelset of one
stop: lane ``axle * stops + stop``. Arrays over lanes or stops have them as their last axis.
"""

import ctypes
import math
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from wspd_design.codegen.compiler import load_library
from wspd_design.codegen.emitter import emit
from wspd_design.codegen.kernels import WINDOW, Kernels, kinds_of, plant_kernels
from wspd_design.codegen.law_library import LoadedLaw, load_law, pointer
from wspd_design.codegen.loop_numbers import (
    DISTANCE_TOLERANCE,
    DOUBLES,
    ERROR_SPEED,
    LANE_SEEN,
    LANE_TOTALS,
    STOP_SEEN,
    STOP_TOTALS,
    Head,
    LoopInput,
    LoopOutput,
)
from wspd_design.codegen.memory import Memory
from wspd_design.codegen.plant_numbers import PARAMETERS
from wspd_design.codegen.prebuilt import prebuilt_library
from wspd_design.codegen.sampled import drive, measurement_of
from wspd_design.controllers.protocol import Command, Law, VehicleMeasurement
from wspd_design.model.further_brakes import LEAST_SHARE
from wspd_design.plants.protocol import Plant

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class ClosedLoop:
    """A loop of a number of stops side by side; without a law it is driven from Python."""

    def __init__(self, library: ctypes.CDLL, law: LoadedLaw | None, *, axles: int, stops: int) -> None:
        self.stops, self.axles = stops, axles
        self._library, self._law = library, law
        for name in ("wspd_lane_totals", "wspd_stop_totals", "wspd_wheel_speeds", "wspd_bad_command"):
            getattr(library, name).restype = DOUBLES
        for name in ("wspd_size", "wspd_row", "wspd_steps", "wspd_samples"):
            getattr(library, name).restype = ctypes.c_long

    @property
    def engine(self) -> str:
        """What computes a stop."""
        law = "controller in Python" if self._law is None else self._law.engine
        return "compiled" if law == "compiled" else f"compiled plant, {law}"

    def run(self, given: LoopInput, *, sample_rows: int = 0) -> LoopOutput:
        """Run all stops with the law."""
        import numpy as np

        law = self._law
        assert law is not None, "a loop without a law is driven by run_with"
        buffer, trace, keep = self._begin(given)
        width = law.states + (2 + LANE_SEEN) * self.axles + STOP_SEEN
        samples = np.zeros((sample_rows, 1 + width * self.stops))
        result = law.run(self._library, buffer, pointer(samples) if sample_rows else None, sample_rows)
        del keep
        return self._output(buffer, result, trace, samples)

    def run_with(self, given: LoopInput, controller: Law, *, sample_rows: int) -> LoopOutput:
        """Run a single stop with a controller that stays in Python."""
        buffer, trace, keep = self._begin(given)
        result, samples = drive(_Plant(self._library, buffer, self.axles), controller, sample_rows)
        del keep
        return self._output(buffer, result, trace, samples)

    def _begin(self, given: LoopInput) -> tuple[Any, "Array", list[Any]]:
        import numpy as np

        buffer = _aligned(self._library.wspd_size())
        head = Head.from_buffer(buffer)
        trace = np.zeros((given.trace_rows, self._library.wspd_row()))
        head.set = given.settings
        head.trace_rows, head.queue_rows = given.trace_rows, given.waiting_commands
        arrays = {
            "disturbance": given.disturbances,
            "fault": given.faults,
            "queue": np.empty((given.waiting_commands, 2 * self.axles * self.stops)),
            "patch_start": given.patch_starts,
            "patch_rail": given.patch_rails,
            "load_factor": given.load_factors,
            "load_spacing": given.load_spacings,
            "hold": given.held_slips,
            "track": given.track,
            "trace": trace if given.trace_rows else None,
        }
        keep = [np.ascontiguousarray(a, dtype=np.float64) for a in arrays.values() if a is not None]
        for name, array in zip((n for n, a in arrays.items() if a is not None), keep, strict=True):
            setattr(head, name, pointer(array))
        seeds = np.ascontiguousarray(given.seeds, dtype=np.uint64)
        head.seed = seeds.ctypes.data_as(ctypes.POINTER(ctypes.c_uint64))
        if given.patch_starts is not None:
            head.patches = len(given.patch_starts)
        if given.load_factors is not None:
            head.load_points = given.load_factors.shape[1]
        if given.held_slips is not None:
            first, second = given.held_speeds
            head.hold_points = given.held_slips.shape[1]
            head.hold_first, head.hold_spacing = math.log(first), math.log(second / first)
        if given.track is not None:
            head.track_points, head.track_again = given.track.shape[1], given.track_again
            head.track_spacing = given.track_spacing
        numbers = (given.stop_parameters, given.lane_parameters, given.numbers)
        initial = (given.speeds, given.wheel_speeds, given.rest, given.pressures)
        blocks = [np.ascontiguousarray(block, dtype=np.float64) for block in (*numbers, *initial)]
        self._library.wspd_begin(buffer, *(pointer(block) for block in blocks))
        return buffer, trace, [keep, seeds, blocks]

    def _output(self, buffer: Any, result: int, trace: "Array", samples: "Array") -> LoopOutput:
        import numpy as np

        library, lanes = self._library, self.axles * self.stops

        def block(name: str, rows: int, columns: int) -> "Array":
            return np.ctypeslib.as_array(getattr(library, name)(buffer), (rows, columns)).copy()

        lane = block("wspd_lane_totals", len(LANE_TOTALS), lanes)
        stop = block("wspd_stop_totals", len(STOP_TOTALS), self.stops)
        settings = Head.from_buffer(buffer)
        totals = dict(zip(STOP_TOTALS, stop, strict=True))
        bad = block("wspd_bad_command", 1, 3)[0]
        return LoopOutput(
            result=result,
            stopped=totals["end_speed"] <= settings.set.stop_speed * (1.0 + 1e-6),
            lane_totals=dict(zip(LANE_TOTALS, lane, strict=True)),
            stop_totals=totals,
            wheel_speeds=block("wspd_wheel_speeds", 1, lanes)[0],
            trace=trace[: settings.trace_used],
            samples=samples[: library.wspd_samples(buffer)],
            bad_command=(float(bad[0]), float(bad[1]), float(bad[2])),
            steps=library.wspd_steps(buffer),
        )


class _Plant:
    """The compiled plant behind the interface of :class:`~wspd_design.codegen.sampled.SampledPlant`."""

    def __init__(self, library: ctypes.CDLL, buffer: Any, axles: int) -> None:
        self._library, self._buffer, self._axles = library, buffer, axles

    def running(self) -> bool:
        return bool(self._library.wspd_running(self._buffer))

    @property
    def wheelsets(self) -> int:
        return self._axles

    def measure(self) -> VehicleMeasurement:
        seen = (ctypes.c_double * (LANE_SEEN * self._axles + STOP_SEEN))()
        self._library.wspd_measure(self._buffer, seen)
        return measurement_of(list(seen), self._axles)

    def judge(self, speed: float | None, references: tuple[float, ...]) -> None:
        one = None if speed is None else (ctypes.c_double * 1)(speed)
        held = (ctypes.c_double * self._axles)(*references) if references else None
        self._library.wspd_judge(self._buffer, one, held)

    def advance(self, commands: tuple[Command, ...]) -> int:
        fill = (ctypes.c_double * self._axles)(*(command.fill for command in commands))
        vent = (ctypes.c_double * self._axles)(*(command.vent for command in commands))
        return int(self._library.wspd_sample(self._buffer, fill, vent))


def load_closed_loop(
    plant: Plant, controller: Law | None, *, stops: int = 1, disturbed: bool = False
) -> ClosedLoop:
    """Load the loop of a controller with its present numbers; what was not compiled before is compiled.

    Parameters
    ----------
    plant : Plant
        Of the kind to be simulated; its numbers are inputs of the loop.
    controller : Law or None
        Law of every wheelset or of the vehicle; None for a loop that is driven from Python.
    stops : int
        Stops side by side.
    disturbed : bool
        With the vibration of the pads, T_d.

    Raises
    ------
    NoCompilerError
        Where the plant has to be compiled, without a working C compiler.
    UntraceableError
        If ``step`` contains what CasADi cannot trace or the emitter cannot translate.
    """
    kernels = plant_kernels(plant, disturbed=disturbed)
    library = _plants.get((kernels, stops), kinds_of(plant), lambda: _plant_library(kernels, stops))
    law = None if controller is None else load_law(controller, axles=plant.axles, stops=stops)
    return ClosedLoop(library, law, axles=plant.axles, stops=stops)


_plants: "Memory[ctypes.CDLL]" = Memory(32)


def _plant_library(kernels: Kernels, stops: int) -> ctypes.CDLL:
    source = closed_loop_source(kernels, stops=stops)
    return prebuilt_library(source) or load_library(source)


_TEMPLATES = ("motion.c", "adhering.c", "steps.c", "events.c", "sensors.c", "closed_loop.c")


def closed_loop_source(kernels: Kernels, *, stops: int) -> str:
    """Return the C source of the loop of a plant with any law."""
    places: dict[str, float] = {
        "STOPS": stops,
        "AXLES": kernels.axles,
        "AXLE_STATES": kernels.axle_states,
        "REST_STATES": kernels.rest_states,
        "COUPLED": int(kernels.coupled),
        "FURTHER": kernels.whole.further if kernels.coupled else 0,
        "PARAMETERS": len(PARAMETERS),
        "RADIUS": PARAMETERS.index(("vehicle", "wheel_radius")),
        "MAX_TORQUE": PARAMETERS.index(("brake", "max_torque")),
        "DROP_SLIP": PARAMETERS.index(("dynamic", "drop_slip")),
        "WINDOW": len(WINDOW),
        "LEAST_SHARE": LEAST_SHARE,
        "INERTIA": PARAMETERS.index(("vehicle", "wheelset_inertia")),
        "MASS": PARAMETERS.index(("vehicle", "mass")),
        "OFFSET": PARAMETERS.index(("surroundings", "axle_offset")),
        "GRADE_FORCE": PARAMETERS.index(("surroundings", "grade_force")),
        "LANE_SEEN": LANE_SEEN,
        "STOP_SEEN": STOP_SEEN,
        "ERROR_SPEED": ERROR_SPEED,
        "FREE_DISTANCE": DISTANCE_TOLERANCE[0],
        "DISTANCE_SHARE": DISTANCE_TOLERANCE[1],
        "DRAIN": PARAMETERS.index(("surroundings", "reservoir_drain")),
        "FIRST_RAIL": next(k for k, (record, _) in enumerate(PARAMETERS) if record == "rail"),
    }
    places["KINKS"] = kernels.kinks.size1_out(0)
    for name in ("stop_constants", "lane_constants", "window_constants"):
        places[name.upper()] = getattr(kernels, name).size1_out(0)
    lanes, twice = "(AXLES * STOPS)", "(2 * AXLES * STOPS)"  # twice: middle and end of a step at once
    of_stop, of_lane = [kernels.stop_constants, kernels.demand], [kernels.lane_constants]
    if kernels.coupled:
        whole = kernels.whole
        places |= {"NUMBERS": whole.numbers, "VEHICLE_CONSTANTS": whole.vehicle_constants.size1_out(0)}
        of_stop += [whole.vehicle_constants, whole.vehicle]
        of_lane += [whole.brakes, whole.slope]
    else:
        split = kernels.split
        of_stop += [split.loads, split.train]
        of_lane += [split.contact, split.axle, split.slope]
    of_valves = [kernels.window_constants, kernels.actuator, *((kernels.kinks,) if places["KINKS"] else ())]
    folder = files("wspd_design").joinpath("codegen", "templates")
    parts = [f"#define {name} {value}\n" for name, value in places.items()]
    parts += [folder.joinpath(name).read_text() for name in ("elementary.h", "random.h")]
    groups = {"STOPS": of_stop, lanes: of_lane, twice: of_valves}
    parts += [emit(kernel, width) for width, group in groups.items() for kernel in group]
    parts += [folder.joinpath(name).read_text() for name in _TEMPLATES]
    return "".join(parts)


def _aligned(size: int) -> Any:
    """Memory whose address is a multiple of the widest vector, as the C structure expects."""
    memory = ctypes.create_string_buffer(size + 64)
    return (ctypes.c_char * size).from_buffer(memory, -ctypes.addressof(memory) % 64)
