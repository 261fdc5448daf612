"""What the ``step`` of a law is: traced to a graph, compared with the law of a theorem, and asked for its memory.

A verdict belongs to the law that runs. A theorem speaks about a law that is written out in
:mod:`wspd_design.certificates.setting.written_laws`; it applies to a controller only if the step that runs is shown
to be the same function, whatever its class or its attributes say.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from wspd_design.certificates.kernel.checker import PRIME, element
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.graph_field import UndecidedError, field_point, same_in_field, values
from wspd_design.certificates.setting.written_laws import WRITTEN, WrittenLaw
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.laws import law_constants
from wspd_design.controllers import offers
from wspd_design.controllers.family import FAMILIES
from wspd_design.controllers.protocol import Law, Measurement, acts_on_vehicle
from wspd_design.parameters.fingerprint import fingerprint

POINTS = 3  # of the field at which two graphs are compared
DOUBLES = 40  # points at which they are compared in doubles
DIGITS = 1e-9  # relative and absolute difference that rounding may make
TORQUE = Measurement._fields.index("torque")
FASTEST, STRONGEST = 40.0, 60e3  # train speed [m/s] and torque [N m] of these points
OF_VEHICLE = "acts on all wheelsets of a vehicle together, not on one of them"
LARGEST_RATIO = 2.5  # of wheel speed over train speed [rad/m]


@dataclass(frozen=True, slots=True, kw_only=True)
class TracedLaw:
    """A law as graphs of CasADi."""

    name: str
    start: Any  # casadi.Function, measurement -> state
    step: (
        Any  # casadi.Function, (state, measurement) -> [state, fill of each wheelset, vent of each wheelset]
    )
    states: int
    wheelsets: int | None = None  # that a law of a vehicle acts on; it sees and commands all of them

    def fingerprint(self) -> str:
        """SHA-256 of the graphs: every operation and every constant to its last bit."""
        return fingerprint([_instructions(self.start), _instructions(self.step)])


@dataclass(frozen=True, slots=True, kw_only=True)
class LawMemory:
    """How the state of a law follows from the state before it.

    ``own_dynamics`` names the elements that are not integrals: what a step makes of such an element depends on the
    element in another way than by adding to it, or on itself through other elements. Without them all eigenvalues of
    the memory are 1, so that in continuous time trace(A_c) = 0.
    """

    names: tuple[str, ...]
    own_dynamics: tuple[str, ...]
    command_reads_torque: bool  # within one step
    memory_reads_torque: bool  # so that a later command may depend on it

    @property
    def integrals_alone(self) -> bool:
        """Whether the memory holds integrals and nothing else."""
        return not self.own_dynamics


def trace(law: Law) -> TracedLaw | str:
    """Run ``start`` and ``step`` of a law on symbols.

    Returns
    -------
    TracedLaw or str
        The graphs, or the reason why there are none.
    """
    import casadi as ca

    try:
        made = law_constants(law)
    except UntraceableError as reason:
        return f"the step of {law.name} cannot be traced ({reason})"
    x, m, none = ca.SX.sym("x", made.states), ca.SX.sym("m", made.step.size1_in(1)), ca.SX(0, 1)
    return TracedLaw(
        name=law.name,
        start=ca.Function("start", [m], [made.start(m, none)]),
        step=ca.Function("step", [x, m], [made.step(x, m, none)]),
        states=made.states,
        wheelsets=made.wheelsets,
    )


def same_function(one: TracedLaw, other: TracedLaw) -> bool:
    """Whether two laws are the same function of state and measurement; False where that cannot be decided.

    As functions of real numbers, by their values in a prime field. A graph can still lose digits on purpose, so that
    both are also compared in doubles at a number of points.
    """
    if one.states != other.states:
        return False
    pairs = ((one.start, other.start), (one.step, other.step))
    return same_in_field(pairs, POINTS) and all(_agree_in_doubles(a, b) for a, b in pairs)


def law_of_theorem(problem: Problem, family: str) -> str | None:
    """Say why a theorem about a family of laws does not speak about the controller of a problem.

    Parameters
    ----------
    problem : Problem
        The closed loop.
    family : str
        Name of a family with a written law, such as ``smc``.

    Returns
    -------
    str or None
        The reason, a clause without a full stop; None if the step that runs is the written law.
    """
    law = problem.controller
    if acts_on_vehicle(law):
        return f"{law.name} {OF_VEHICLE}"
    title = FAMILIES[family].title if family in FAMILIES else family
    if family not in WRITTEN:
        return f"no theorem is written for the {title}"
    written = written_law(law, family)
    if written is None:
        return f"it does not have the gains and the model of the {title}"
    found = trace(law)
    if isinstance(found, str):
        return found
    wanted = trace(written)
    if isinstance(wanted, str):
        return wanted
    if not same_function(found, wanted):
        return f"the step of {law.name} is not the {title} that this theorem speaks about, or was not shown to be"
    return None


def written_law(law: Law, family: str) -> WrittenLaw | None:
    """Write out the law of the theorems with the gains of a controller; None if it lacks what the law needs."""
    record = FAMILIES[family].gains
    gains = getattr(law, "gains", None)
    if record is None or type(gains) is not record:
        return None
    kind = WRITTEN[family]
    try:
        return kind.of(law, gains)
    except (AttributeError, TypeError):
        return None


def memory(law: Law) -> LawMemory | str:
    """Differentiate the step of a law in its memory, on the graph.

    Returns
    -------
    LawMemory or str
        What was found, or the reason why nothing was.
    """
    import casadi as ca

    if acts_on_vehicle(law):
        return f"{law.name} {OF_VEHICLE}"
    traced = trace(law)
    if isinstance(traced, str):
        return traced
    states, step = traced.states, traced.step
    x, m = ca.SX.sym("x", states), ca.SX.sym("m", len(Measurement._fields))
    slopes = ca.densify(ca.jacobian(step(x, m)[:states], x)) if states else ca.SX(0, 0)
    jacobian = ca.Function("memory_slopes", [x, m], [slopes])
    try:
        rows = [_square(values(jacobian, field_point(jacobian, k))[0], states) for k in range(POINTS)]
        moved = [_with_other_torque(step, k) for k in range(POINTS)]
    except UndecidedError as reason:
        return f"the memory of {law.name} is not decided ({reason})"
    names = state_names(law, states)
    own = [
        names[i]
        for i in range(states)
        if any(matrix[i][i] != 1 for matrix in rows) or i in _in_circles(rows, states)
    ]
    return LawMemory(
        names=names,
        own_dynamics=tuple(own),
        command_reads_torque=any(plain[states:] != other[states:] for plain, other in moved),
        memory_reads_torque=any(plain[:states] != other[:states] for plain, other in moved),
    )


def _agree_in_doubles(one: Any, other: Any) -> bool:
    import numpy as np

    for number in range(DOUBLES):
        speed, wheel, torque = (_share(number, name) for name in ("speed", "wheel", "torque"))
        measured = [FASTEST * speed, LARGEST_RATIO * wheel * FASTEST * speed, STRONGEST * torque]
        sizes = one.nnz_in(0) if one.n_in() > 1 else 0
        state = [(2.0 * _share(number, k) - 1.0) * 10.0 ** (number % 5 - 3) for k in range(sizes)]
        point = [state, measured] if one.n_in() > 1 else [measured]
        found, wanted = (np.array(each.call(point)[0]).ravel() for each in (one, other))
        if not np.allclose(found, wanted, rtol=DIGITS, atol=DIGITS):
            return False
    return True


def _share(*content: object) -> float:
    """Pseudo-random number between 0 and 1."""
    return element("double", *content) / PRIME


def _with_other_torque(step: Any, number: int) -> tuple[list[int], list[int]]:
    """Outputs of a step at two points that differ in the torque alone."""
    point = field_point(step, number)
    other = [point[0], [*point[1][:TORQUE], element("other torque", number)]]
    return values(step, point)[0], values(step, other)[0]


def _square(column: Sequence[int], size: int) -> list[list[int]]:
    """Rows of a matrix that is stored column by column."""
    return [[column[j * size + i] for j in range(size)] for i in range(size)]


def _in_circles(rows: list[list[list[int]]], size: int) -> set[int]:
    """Elements of the state that act on themselves through others.

    What is left when elements on which nothing else acts are taken away one by one is not all in a circle, but acts on
    or is reached from one; it is counted with it.
    """
    acts = {(j, i) for i in range(size) for j in range(size) if i != j and any(m[i][j] for m in rows)}
    left = set(range(size))
    while free := {i for i in left if not any((j, i) in acts for j in left)}:
        left -= free
    return left


def state_names(law: Law, states: int) -> tuple[str, ...]:
    """Names of the elements of the state of a law."""
    if isinstance(law, offers.Memory) and len(law.memory) == states:
        return tuple(law.memory)
    return tuple(f"element {number} of the state" for number in range(1, states + 1))


def _instructions(function: Any) -> list[tuple[object, ...]]:
    import casadi as ca

    return [
        (
            function.instruction_id(k),
            tuple(function.instruction_input(k)),
            tuple(function.instruction_output(k)),
            float(function.instruction_constant(k)).hex()
            if function.instruction_id(k) == ca.OP_CONST
            else "",
        )
        for k in range(function.n_instructions())
    ]
