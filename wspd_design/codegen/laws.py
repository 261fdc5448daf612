"""The kernels of a law: its own ``start`` and ``step``, traced by CasADi at each call.

A law may change between two calls in any way that Python knows: attributes, contents of lists and arrays, methods,
closures. What runs is therefore what the trace says, never what a law with the same identity once was. Only an
immutable law of this package has a key by which its trace may be remembered, while no code has been replaced.
"""

import re
from array import array
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.gains import Gain, with_gains
from wspd_design.codegen.loop_numbers import LANE_SEEN, STOP_SEEN
from wspd_design.codegen.sampled import measurement_of, places_told
from wspd_design.controllers.protocol import Law, Measurement, acts_on_vehicle

_PACKAGE = "wspd_design."


@dataclass(frozen=True, slots=True, kw_only=True)
class LawKernels:
    """CasADi functions of dense vectors, and the numbers that they are called with; compared by the functions."""

    start: Any = field(compare=False)  # (seen, gains) -> state
    step: Any = field(compare=False)  # (state, seen, gains) -> [state, fill, vent]
    states: int  # length of the state
    wheelsets: int | None  # that a law of a vehicle acts on; it sees and commands all of them
    speed: int  # place in the state of the train speed that the law goes by, -1 for none
    reference: int  # places from there on of the slips that it holds, likewise
    gains: tuple[float, ...] = field(compare=False)
    content: str  # the functions written out

    def lanes(self, axles: int, stops: int) -> int:
        """How often the functions are called at a sample: for each wheelset of each stop, or for each stop."""
        return stops if self.wheelsets else axles * stops

    def states_of_stop(self, axles: int) -> int:
        """Numbers that the law remembers for all wheelsets of a stop."""
        return self.states if self.wheelsets else self.states * axles


def law_kernels(law: Law) -> LawKernels:
    """Trace a law with its floats as inputs, or as constants where it does not take them.

    Raises
    ------
    UntraceableError
        Whatever goes wrong in ``start`` and ``step``.
    """
    import casadi as ca

    values: list[float] = []
    try:
        with_gains(law, values.append)
        symbols = ca.SX.sym("gains", len(values))
        elements = iter(range(len(values)))
        gained = with_gains(law, lambda value: Gain(float(value), symbols[next(elements)]))
        made = _functions(gained, symbols, tuple(map(float, values)))
        # C has no power of a negative base with an exponent that is not known in advance.
        steps = (made.step.instruction_id(k) for k in range(made.step.n_instructions()))
        if ca.OP_POW not in steps:
            return made
    except Exception:  # the law does not take gains; whether it takes plain numbers is seen next
        pass
    return law_constants(law)


def law_constants(law: Law) -> LawKernels:
    """Trace a law with its numbers as constants of the functions.

    Raises
    ------
    UntraceableError
        Whatever goes wrong in ``start`` and ``step``.
    """
    import casadi as ca

    return _functions(law, ca.SX(0, 1), ())


def _functions(law: Law, symbols: Any, values: tuple[float, ...]) -> LawKernels:
    import casadi as ca

    wheelsets = law.wheelsets if acts_on_vehicle(law) else None
    m = ca.SX.sym("m", LANE_SEEN * wheelsets + STOP_SEEN if wheelsets else len(Measurement._fields))
    told = speed, reference = places_told(law)
    try:
        if acts_on_vehicle(law):
            seen = measurement_of(m.elements(), law.wheelsets)
            initial = law.start(seen)
            state = ca.SX.sym("state", len(initial))
            following, commands = law.step(tuple(state.elements()), seen)
        else:
            initial = law.start(Measurement._make(m.elements()))
            state = ca.SX.sym("state", len(initial))
            following, command = law.step(tuple(state.elements()), Measurement._make(m.elements()))
            commands = (command,)
        start = ca.Function("start_kernel", [m, symbols], [_vector(*initial)])
        decided = (*(each.fill for each in commands), *(each.vent for each in commands))
        step = ca.Function("step_kernel", [state, m, symbols], [_vector(*following, *decided)])
    except Exception as error:  # the user's code may fail on symbols in any way
        reason = re.sub(r"\S*\.[ch]pp:\d+: ", "", str(error))  # without CasADi's places in its own source
        raise UntraceableError(f"{law.name}: {reason}") from error
    if len(following) != len(initial):
        raise UntraceableError(f"{law.name}: step returns {len(following)} states, start {len(initial)}")
    if len(commands) != (wheelsets or 1):
        raise UntraceableError(f"{law.name}: step returns {len(commands)} commands for {wheelsets} wheelsets")
    content = f"{told}" + start.serialize() + step.serialize()
    return LawKernels(
        start=start,
        step=step,
        states=len(initial),
        wheelsets=wheelsets,
        speed=speed,
        reference=reference,
        gains=values,
        content=content,
    )


def _vector(*elements: Any) -> Any:
    import casadi as ca

    return ca.vertcat(ca.SX(0, 1), *elements)


def immutable(law: Law) -> tuple[Any, tuple[type, ...]] | None:
    """Key of a law of this package by all that it holds, and the classes of that.

    None for a law that may change without being replaced.
    """
    floats, kinds = array("d"), dict[type, None]()
    try:
        return (_shape(law, floats, kinds), floats.tobytes()), tuple(kinds)
    except _MutableError:
        return None


class _MutableError(TypeError):
    """Something in a law may change without being replaced."""


def _shape(value: Any, floats: "array[float]", kinds: dict[type, None]) -> Any:
    kind = type(value)
    if kind is float:
        floats.append(value)
        return float
    if kind in (int, bool, str, type(None)):
        return kind, value
    if kind is tuple:
        return tuple(_shape(element, floats, kinds) for element in value)
    ours = is_dataclass(value) and kind.__module__.startswith(_PACKAGE)
    if ours and kind.__dataclass_params__.frozen and not hasattr(value, "__dict__"):
        kinds[kind] = None
        return kind, *(_shape(getattr(value, each.name), floats, kinds) for each in fields(value))
    raise _MutableError
