"""Modes of small vibrations: eigenvalues, damping, and names from where the energy of motion is."""

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from wspd_design.parameters.errors import UserError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Matrix = NDArray[np.float64]
    Shape = NDArray[np.complex128]

_NEUTRAL = 1e-4
"""Rate [1/s] below which an eigenvalue counts as zero: rounding lifts a double zero to about the root of its own."""
_REAL = 1e-6  # share of an eigenvalue by which it may leave the real axis through rounding

_ALONE = 0.75  # share of the energy of bodies of one kind from which a mode is one body's
_MIXED = 0.15  # share of the energy that a second motion of the same bodies needs to count in the name

_DIRECTIONS = {
    "x": "surge",
    "y": "sway",
    "z": "bounce",
    "roll": "roll",
    "pitch": "pitch",
    "yaw": "yaw",
    "turn": "turn",
}
_SPECIAL = {("rotor", "turn"): "driveline"}
_NUMBERED = re.compile(r"_(\d+[a-z]*|[a-z]?\d+|left|right|[lr])$")


@dataclass(frozen=True, slots=True, kw_only=True)
class SmallMotion:
    """Small motion about a steady state: M a + D v + K q = 0 in the deviations of n coordinates.

    Contact and gyroscopic terms may make D and K unsymmetric.
    """

    coordinates: tuple[str, ...]  # such as "car_body.z": a body and a direction
    mass: "Matrix"  # (n, n), symmetric and positive definite
    damping: "Matrix"  # (n, n)
    stiffness: "Matrix"  # (n, n)

    def state_matrix(self) -> "Matrix":
        """Return the matrix (2n, 2n) of the rates of coordinates and velocities."""
        import numpy as np

        n = len(self.coordinates)
        below = -np.linalg.solve(self.mass, np.hstack([self.stiffness, self.damping]))
        return np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), below])


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Part of the kinetic energy of a mode that one direction of motion of one kind of body has.

    In coupled coordinates the parts may be negative; their sum over a mode is 1.
    """

    kind: str  # of body, such as "car_body"
    direction: str  # such as "z"
    share: float  # -


@dataclass(frozen=True, slots=True, kw_only=True)
class Mode:
    """One eigenvalue with its shape; of a pair of complex ones that with the positive imaginary part."""

    name: str
    pole: complex  # 1/s
    shares: tuple[Share, ...]  # largest first
    shape: "Shape"  # (n,), of the coordinates; largest velocity energy 1, phase of the leading coordinate 0

    @property
    def oscillates(self) -> bool:
        """Tell whether the mode oscillates rather than decaying or growing evenly."""
        return self.pole.imag > 0.0

    @property
    def frequency(self) -> float:
        """Frequency of the oscillation [Hz]; 0 for a mode that does not oscillate."""
        return self.pole.imag / (2.0 * math.pi)

    @property
    def damping(self) -> float:
        """Damping ratio, -Re p / |p| [-]; negative where the mode grows, -1 or 1 where it does not oscillate."""
        return -self.pole.real / abs(self.pole)

    @property
    def unstable(self) -> bool:
        """Tell whether the mode grows."""
        return self.pole.real > 0.0


def undamped_frequencies(mass: "Matrix", stiffness: "Matrix") -> "Matrix":
    """Return the n eigenfrequencies [Hz] of M a + K q = 0 for symmetric matrices, lowest first.

    Raises
    ------
    UserError
        If the equilibrium is not stable, so that an eigenvalue is negative beyond rounding.
    """
    import numpy as np
    from scipy.linalg import eigh

    squares = eigh(stiffness, mass, eigvals_only=True)
    if squares[0] < -1e-9 * squares[-1]:
        raise UserError(
            f"the equilibrium is not stable: the lowest eigenvalue of M^-1 K is {squares[0]:.3g} 1/s2; look at the "
            "preloads of the springs and the heights of the bodies"
        )
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * math.pi))


def modes(motion: SmallMotion) -> tuple[Mode, ...]:
    """Return the modes of small motion: those that oscillate by rising frequency, then the real ones, fastest last.

    Neutral motion (a vehicle may stand anywhere, and wheels may have turned by any angle) is left out.

    Parameters
    ----------
    motion : SmallMotion
        Matrices about a steady state.
    """
    import numpy as np

    n = len(motion.coordinates)
    values, vectors = np.linalg.eig(motion.state_matrix())
    found = []
    for value, vector in zip(values, vectors.T, strict=True):
        real = abs(value.imag) <= _REAL * abs(value)
        if abs(value) < _NEUTRAL or (value.imag < 0.0 and not real):
            continue
        pole = complex(value.real, 0.0) if real else complex(value)
        found.append(_mode(motion, pole, vector[:n]))
    found.sort(key=lambda mode: (not mode.oscillates, mode.frequency, abs(mode.pole)))
    return _distinct(found)


def _mode(motion: SmallMotion, pole: complex, shape: "Shape") -> Mode:
    """Name one mode by the kinetic energy of its shape."""
    import numpy as np

    energy = np.real(np.conj(shape) * (motion.mass @ shape))  # all velocities are the pole times the shape
    energy = energy / energy.sum()
    lead = int(np.argmax(energy))
    turned = shape * np.exp(-1j * np.angle(shape[lead]))
    turned = turned / np.sqrt(np.real(np.conj(turned) @ (motion.mass @ turned)))
    parts: dict[tuple[str, str], float] = {}
    for coordinate, part in zip(motion.coordinates, energy, strict=True):
        body, direction = body_and_direction(coordinate)
        key = (kind_of(body), direction)
        parts[key] = parts.get(key, 0.0) + float(part)
    shares = tuple(
        Share(kind=kind, direction=direction, share=share)
        for (kind, direction), share in sorted(parts.items(), key=lambda item: -item[1])
    )
    name = _name(motion.coordinates, energy, turned, shares)
    return Mode(name=name, pole=pole, shares=shares, shape=turned)


def body_and_direction(coordinate: str) -> tuple[str, str]:
    """Split the name of a coordinate, ``"bogie_1.z"``, into body and direction."""
    body, _, direction = coordinate.rpartition(".")
    return body, direction


def kind_of(body: str) -> str:
    """Return what a body is called without its number: ``"bogie"`` for ``"bogie_1"``."""
    kind = body
    while (shorter := _NUMBERED.sub("", kind)) != kind:
        kind = shorter
    return kind


def _name(
    coordinates: Sequence[str], energy: "Matrix", shape: "Shape", shares: tuple[Share, ...]
) -> str:
    """Say which bodies move and how, from the largest share of the energy."""
    import numpy as np

    leading = shares[0]
    of_kind = [
        place
        for place, coordinate in enumerate(coordinates)
        if (kind_of(body_and_direction(coordinate)[0]), body_and_direction(coordinate)[1])
        == (leading.kind, leading.direction)
    ]
    special = _SPECIAL.get((leading.kind, leading.direction))
    how = special or _DIRECTIONS.get(leading.direction, leading.direction)
    if special is None and len(of_kind) == 1:
        how = _level(coordinates, shape, shares) or how
    parts = energy[of_kind]
    strongest = of_kind[int(np.argmax(parts))]
    alone = energy[strongest] >= _ALONE * parts.sum()
    kind = leading.kind.replace("_", " ")
    if special is not None:
        number = body_and_direction(coordinates[strongest])[0].removeprefix(f"{leading.kind}_")
        return f"{how} of axle {number}" if alone and len(of_kind) > 1 else how
    if len(of_kind) == 1:
        return f"{kind} {how}"
    if alone:
        return f"{body_and_direction(coordinates[strongest])[0].replace('_', ' ')} {how}"
    if len(of_kind) == 2:
        together = np.real(shape[of_kind[0]] * np.conj(shape[of_kind[1]])) > 0.0
        return f"{_plural(kind)} {how}, {'in phase' if together else 'in opposition'}"
    return f"{_plural(kind)} {how}"


def _level(coordinates: Sequence[str], shape: "Shape", shares: tuple[Share, ...]) -> str:
    """Tell lower from upper sway where a body sways and rolls in one mode; empty elsewhere.

    With x forward, y left and z up a point at height h above the center moves y - h roll. Where y and roll have
    opposite signs it moves more the higher it is: the pole of the rolling lies low.
    """
    import numpy as np

    leading = shares[0]
    if leading.direction not in ("y", "roll"):
        return ""
    other = "roll" if leading.direction == "y" else "y"
    mixed = any(
        each.kind == leading.kind and each.direction == other and each.share >= _MIXED for each in shares
    )
    if not mixed:
        return ""
    places = {
        body_and_direction(coordinate)[1]: place
        for place, coordinate in enumerate(coordinates)
        if kind_of(body_and_direction(coordinate)[0]) == leading.kind
    }
    along = np.real(shape[places["y"]] * np.conj(shape[places["roll"]]))
    return "lower sway" if along < 0.0 else "upper sway"


def _plural(kind: str) -> str:
    if kind.endswith(("x", "s", "ch", "sh")):
        return f"{kind}es"
    return f"{kind[:-1]}ies" if kind.endswith("y") and kind[-2] not in "aeiou" else f"{kind}s"


def _distinct(found: Sequence[Mode]) -> tuple[Mode, ...]:
    """Number modes of one name in their order: "driveline, 1 of 4"."""
    total = Counter(mode.name for mode in found)
    met: Counter[str] = Counter()
    named = []
    for mode in found:
        met[mode.name] += 1
        more = f", {met[mode.name]} of {total[mode.name]}" if total[mode.name] > 1 else ""
        named.append(replace(mode, name=mode.name + more))
    return tuple(named)
