"""A law as the closed loop calls it: a small library of its own or, without a compiler, CasADi's virtual machine."""

import ctypes
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple

from wspd_design.codegen.bound import Bound
from wspd_design.codegen.compiler import COMPILER_INSTALLATION, NoCompilerError, load_library
from wspd_design.codegen.emitter import emit
from wspd_design.codegen.laws import LawKernels, immutable, law_kernels
from wspd_design.codegen.loop_numbers import DOUBLES
from wspd_design.codegen.memory import Memory
from wspd_design.codegen.notices import tell_once
from wspd_design.codegen.sampled import GOOD
from wspd_design.controllers.protocol import Controller

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
        ("seen", DOUBLES),
        ("state", DOUBLES),
        ("next", DOUBLES),
    )


class VirtualLaw(NamedTuple):
    """The law of all lanes as CasADi functions of vectors, element ``k`` of lane ``l`` at ``k * lanes + l``."""

    start: Any  # (seen, gains) -> states
    step: Any  # (states, seen, gains) -> states, fill, vent


class LoadedLaw:
    """A law with its present numbers, ready to be called on a number of lanes."""

    def __init__(self, kernels: LawKernels, lanes: int, engine: "ctypes.CDLL | VirtualLaw") -> None:
        import numpy as np

        self.states, self._lanes, self._engine = kernels.states, lanes, engine
        self._gains = np.array(kernels.gains)

    @property
    def engine(self) -> str:
        """What computes the law."""
        return "law in CasADi's virtual machine" if isinstance(self._engine, VirtualLaw) else "compiled"

    def run(self, plant: ctypes.CDLL, loop: Any, samples: Any, sample_rows: int) -> int:
        """Run all stops of a loop that has begun; returns the result code."""
        import numpy as np

        rows = ctypes.c_long(sample_rows)
        seen = np.zeros(3 * self._lanes)
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
        state, ahead = (np.zeros(count * self._lanes) for count in (self.states, self.states + 2))
        structure = self._structure(seen, state, ahead)
        structure.start, structure.step = (
            ctypes.cast(function, ctypes.c_void_p).value
            for function in (self._engine.wspd_start, self._engine.wspd_step)
        )
        return int(plant.wspd_run(loop, ctypes.byref(structure), samples, rows))

    def _structure(self, seen: "Array", state: "Array", ahead: "Array") -> _Law:
        gains, *memory = map(pointer, (self._gains, seen, state, ahead))
        return _Law(None, None, gains, self.states, *memory)


def load_law(controller: Controller, *, axles: int, stops: int) -> LoadedLaw:
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
    return LoadedLaw(kernels, axles * stops, engine)


_traces: "Memory[LawKernels]" = Memory(64)
_engines: "Memory[ctypes.CDLL | VirtualLaw]" = Memory(64)


def _engine(kernels: LawKernels, axles: int, stops: int) -> ctypes.CDLL | VirtualLaw:
    try:
        return load_library(law_source(kernels, axles=axles, stops=stops))
    except NoCompilerError as error:
        tell_once(str(error), _SLOWER)
        return virtual_law(kernels, axles * stops)


def law_source(law: LawKernels, *, axles: int, stops: int) -> str:
    """Return the C source of a law on all lanes."""
    folder = files("wspd_design").joinpath("codegen", "templates")
    kernels = (emit(kernel, str(axles * stops), shared=kernel.n_in() - 1) for kernel in (law.start, law.step))
    return "".join(
        [
            f"#define STOPS {stops}\n",
            folder.joinpath("elementary.h").read_text(),
            *kernels,
            folder.joinpath("law.c").read_text(),
        ]
    )


def virtual_law(law: LawKernels, lanes: int) -> VirtualLaw:
    """Write the law out for all lanes, so that one call serves them."""
    import casadi as ca

    seen, state, gains = (
        ca.SX.sym(name, size)
        for name, size in (("seen", 3 * lanes), ("state", law.states * lanes), ("gains", len(law.gains)))
    )

    def by_element(columns: list[Any]) -> Any:
        return ca.cse(ca.reshape(ca.horzcat(*columns).T, -1, 1))

    starts = [law.start(seen[lane::lanes], gains) for lane in range(lanes)]
    steps = [law.step(state[lane::lanes], seen[lane::lanes], gains) for lane in range(lanes)]
    return VirtualLaw(
        start=ca.Function("start", [seen, gains], [by_element(starts)]),
        step=ca.Function("step", [state, seen, gains], [by_element(steps)]),
    )


def pointer(array: "Array") -> Any:
    """Return the address of an array, as C takes it."""
    return array.ctypes.data_as(DOUBLES)
