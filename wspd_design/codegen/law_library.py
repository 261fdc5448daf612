"""A law as the closed loop calls it: a small library of its own or, without a compiler, CasADi's virtual machine."""

import ctypes
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple

from wspd_design.codegen.bound import Bound
from wspd_design.codegen.compiler import COMPILER_INSTALLATION, NoCompilerError, load_library
from wspd_design.codegen.emitter import emit
from wspd_design.codegen.laws import LawKernels, immutable, law_kernels
from wspd_design.codegen.loop_numbers import DOUBLES, LANE_SEEN, STOP_SEEN
from wspd_design.codegen.memory import Memory
from wspd_design.codegen.notices import tell_once
from wspd_design.codegen.sampled import GOOD
from wspd_design.controllers.protocol import Law

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SLOWER = (
    "the law runs in CasADi's virtual machine, and stops take up to four times as long; "
    f"{COMPILER_INSTALLATION} brings a compiler"
)


class _Law(ctypes.Structure):
    """The C structure ``Law``."""

    _fields_ = (
        ("start", ctypes.c_void_p),
        ("step", ctypes.c_void_p),
        ("gains", DOUBLES),
        ("states", ctypes.c_long),
        ("speed", ctypes.c_long),
        ("reference", ctypes.c_long),
        ("seen", DOUBLES),
        ("state", DOUBLES),
        ("next", DOUBLES),
    )


class VirtualLaw(NamedTuple):
    """The law of all stops as CasADi functions of vectors, element ``k`` of stop ``s`` at ``k * stops + s``."""

    start: Any  # (seen, gains) -> states
    step: Any  # (states, seen, gains) -> states, fill, vent


class LoadedLaw:
    """A law with its present numbers, ready to be called on a number of stops."""

    def __init__(
        self, kernels: LawKernels, engine: "ctypes.CDLL | VirtualLaw", *, axles: int, stops: int
    ) -> None:
        import numpy as np

        self._axles, self._stops, self._engine = axles, stops, engine
        self.states = kernels.states_of_stop(axles)
        self._told = kernels.speed, kernels.reference
        self._gains = np.array(kernels.gains)

    @property
    def engine(self) -> str:
        """What computes the law."""
        return "law in CasADi's virtual machine" if isinstance(self._engine, VirtualLaw) else "compiled"

    def run(self, plant: ctypes.CDLL, loop: Any, samples: Any, sample_rows: int) -> int:
        """Run all stops of a loop that has begun; returns the result code."""
        import numpy as np

        rows = ctypes.c_long(sample_rows)
        seen = np.zeros((LANE_SEEN * self._axles + STOP_SEEN) * self._stops)
        if isinstance(self._engine, VirtualLaw):
            start = Bound(self._engine.start, seen, self._gains)
            step = Bound(self._engine.step, start.outputs[0], seen, self._gains)
            law = ctypes.byref(self._structure(seen, start.outputs[0], step.outputs[0]))
            plant.wspd_measure(loop, pointer(seen))
            start.call()
            result = GOOD
            while result == GOOD and plant.wspd_ask(loop, law):
                step.call()
                result = plant.wspd_answer(loop, law, samples, rows)
            return result
        decided = self.states + 2 * self._axles
        state, ahead = (np.zeros(count * self._stops) for count in (self.states, decided))
        structure = self._structure(seen, state, ahead)
        structure.start, structure.step = (
            ctypes.cast(function, ctypes.c_void_p).value
            for function in (self._engine.wspd_start, self._engine.wspd_step)
        )
        return int(plant.wspd_run(loop, ctypes.byref(structure), samples, rows))

    def _structure(self, seen: "Array", state: "Array", ahead: "Array") -> _Law:
        gains, *memory = map(pointer, (self._gains, seen, state, ahead))
        return _Law(None, None, gains, self.states, *self._told, *memory)


def load_law(controller: Law, *, axles: int, stops: int) -> LoadedLaw:
    """Trace a law as it is now, and load its library: one for all laws with the same kernels.

    Raises
    ------
    UntraceableError
        If ``step`` contains what CasADi cannot trace or the emitter cannot translate.
    """
    known = immutable(controller)
    if known is None:
        kernels = law_kernels(controller)
    else:
        content, kinds = known
        kernels = _traces.get(content, kinds, lambda: law_kernels(controller))
    engine = _engines.get((kernels, axles, stops), (), lambda: _engine(kernels, axles, stops))
    return LoadedLaw(kernels, engine, axles=axles, stops=stops)


_traces: "Memory[LawKernels]" = Memory(64)
_engines: "Memory[ctypes.CDLL | VirtualLaw]" = Memory(64)


def _engine(kernels: LawKernels, axles: int, stops: int) -> ctypes.CDLL | VirtualLaw:
    try:
        return load_library(law_source(kernels, axles=axles, stops=stops))
    except NoCompilerError as error:
        tell_once(str(error), _SLOWER)
        return virtual_law(kernels, axles=axles, stops=stops)


def law_source(law: LawKernels, *, axles: int, stops: int) -> str:
    """Return the C source of a law on all stops."""
    folder = files("wspd_design").joinpath("codegen", "templates")
    lanes = str(law.lanes(axles, stops))
    kernels = (emit(kernel, lanes, shared=kernel.n_in() - 1) for kernel in (law.start, law.step))
    return "".join(
        [
            f"#define STOPS {stops}\n",
            folder.joinpath("elementary.h").read_text(),
            *kernels,
            folder.joinpath("law.c").read_text(),
        ]
    )


def virtual_law(law: LawKernels, *, axles: int, stops: int) -> VirtualLaw:
    """Write the law out for all stops, so that one call serves them."""
    import casadi as ca

    lanes = law.lanes(axles, stops)
    seen, state, gains = (
        ca.SX.sym(name, size)
        for name, size in (
            ("seen", (LANE_SEEN * axles + STOP_SEEN) * stops),
            ("state", law.states_of_stop(axles) * stops),
            ("gains", len(law.gains)),
        )
    )
    width = law.step.size1_in(1) * lanes

    def by_element(columns: list[Any]) -> Any:
        return ca.cse(ca.reshape(ca.horzcat(*columns).T, -1, 1))

    starts = [law.start(seen[lane:width:lanes], gains) for lane in range(lanes)]
    steps = [law.step(state[lane::lanes], seen[lane:width:lanes], gains) for lane in range(lanes)]
    return VirtualLaw(
        start=ca.Function("start", [seen, gains], [by_element(starts)]),
        step=ca.Function("step", [state, seen, gains], [by_element(steps)]),
    )


def pointer(array: "Array") -> Any:
    """Return the address of an array, as C takes it."""
    return array.ctypes.data_as(DOUBLES)
