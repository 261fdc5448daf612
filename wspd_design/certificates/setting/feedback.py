"""What the commands of a law depend on: the graph of its step, followed through its memory from sample to sample.

What no path of the graph connects cannot depend on each other. A path shows no more than that it may: that a command
does depend on a measurement is shown by two histories that differ in this measurement alone.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.kernel.checker import PRIME, element
from wspd_design.certificates.setting.traced_law import TracedLaw
from wspd_design.codegen.graph import evaluate
from wspd_design.codegen.loop_numbers import LANE_SEEN

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

HISTORIES = 60  # pairs that are tried
SAMPLES = 4  # of a history
TRAIN_SPEED = "train speed"
OF_WHEELSET = (TRAIN_SPEED, "wheel speed", "torque", "sensor health", "pressure")
OF_VEHICLE = ("acceleration", "demand", "reservoir pressure")
LARGEST = {
    TRAIN_SPEED: 40.0,  # m/s
    "wheel speed": 80.0,  # rad/s
    "torque": 6e4,  # N m
    "sensor health": 1.0,
    "pressure": 4e5,  # Pa
    "acceleration": -3.0,  # m/s2
    "demand": 1.0,
    "reservoir pressure": 9e5,  # Pa
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """A number that a law is told: of the vehicle, or of a wheelset counted from 1."""

    name: str
    wheelset: int | None

    @property
    def text(self) -> str:
        """The number in words."""
        return self.name if self.wheelset is None else f"{self.name} {self.wheelset}"


def measured(law: TracedLaw) -> tuple[Measured, ...]:
    """Return what a law is told, in the order of the input of its graph."""
    count = law.wheelsets
    if count is None:
        return tuple(Measured(name=name, wheelset=None) for name in OF_WHEELSET[:3])
    lanes = (
        Measured(name=name, wheelset=None if name == TRAIN_SPEED else number)
        for name in OF_WHEELSET[:LANE_SEEN]
        for number in range(1, count + 1)
    )
    return (*lanes, *(Measured(name=name, wheelset=None) for name in OF_VEHICLE))


def read_by_commands(law: TracedLaw) -> tuple[frozenset[Measured], ...]:
    """Return what the command of each wheelset may depend on, sooner or later."""
    told, count = measured(law), law.wheelsets or 1
    states = law.states
    outputs = _paths(law.step)
    of_state = [{k for k in outputs[i] if k < states} for i in range(states)]
    found = []
    for wheelset in range(count):
        direct = outputs[states + wheelset] | outputs[states + count + wheelset]
        reached, waiting = set(), {k for k in direct if k < states}
        while waiting:
            reached |= waiting
            waiting = {k for i in waiting for k in of_state[i]} - reached
        read = direct.union(*(outputs[i] for i in reached))
        found.append(frozenset(told[k - states] for k in read if k >= states))
    return tuple(found)


def read_names(law: TracedLaw) -> tuple[str, ...]:
    """Return the names of what any command may depend on."""
    used = {each.name for reads in read_by_commands(law) for each in reads}
    return tuple(dict.fromkeys(each.name for each in measured(law) if each.name in used))


def _paths(function: Any) -> list[set[int]]:
    """Return for each element of the output the elements of all inputs that a path connects with it."""
    offsets = [sum(function.nnz_in(k) for k in range(place)) for place in range(function.n_in())]
    inputs = [[{offset + k} for k in range(function.nnz_in(place))] for place, offset in enumerate(offsets)]
    nothing: set[int] = set()
    found = evaluate(function, inputs, lambda _: nothing, lambda _, x: nothing.union(*x))
    return found[0]


def differs(law: TracedLaw, wheelset: int, place: int, number: int) -> bool:
    """Tell whether a pair of histories that differ in one measurement gives a wheelset different commands.

    Parameters
    ----------
    law : TracedLaw
        The law.
    wheelset : int
        Whose command, counted from 0.
    place : int
        Of the measurement in the input of the graph.
    number : int
        Of the pair: each number gives another one.
    """
    count, states = law.wheelsets or 1, law.states
    mine = (states + wheelset, states + count + wheelset)
    plain = list(_history(law, number))
    other = [each if k == 0 else _changed(each, place, (number, k)) for k, each in enumerate(plain)]
    return any(
        one[k] != two[k] for one, two in zip(_run(law, plain), _run(law, other), strict=True) for k in mine
    )


def _history(law: TracedLaw, number: int) -> "Iterator[Array]":
    """Yield measurements of a train that slows down, with wheels that slide more or less."""
    import numpy as np

    told = measured(law)
    speed = LARGEST[TRAIN_SPEED] * _share(number, "speed")
    for sample in range(SAMPLES + 1):
        seen = np.empty(len(told))
        for k, each in enumerate(told):
            seen[k] = LARGEST[each.name] * _share(number, sample, k)
            if each.name == TRAIN_SPEED:
                seen[k] = speed * (1.0 - 0.02 * sample)
            elif each.name == "wheel speed":
                seen[k] = 2.0 * speed * (1.0 - 0.4 * _share(number, sample, k))
            elif each.name in ("sensor health", "demand"):
                seen[k] = 1.0
        yield seen


def _changed(seen: "Array", place: int, salt: tuple[int, int]) -> "Array":
    changed = seen.copy()
    changed[place] *= 2.0 * _share("changed", *salt)
    return changed


def _run(law: TracedLaw, seen: "Sequence[Array]") -> "Iterator[Array]":
    """Start with the first measurement, and yield the outputs of the step at the others."""
    import numpy as np

    state = np.array(law.start(seen[0]), dtype=np.float64).ravel()
    for each in seen[1:]:
        out = np.array(law.step(state, each), dtype=np.float64).ravel()
        state = out[: law.states]
        yield out


def _share(*content: object) -> float:
    """Pseudo-random number between 0 and 1."""
    return element("history", *content) / PRIME
