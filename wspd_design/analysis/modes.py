"""Modes of small vibrations: eigenvalues, damping, and names from where the energy of motion is."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from wspd_design.parameters.errors import UserError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Matrix = NDArray[np.float64]
    Shape = NDArray[np.complex128]

_NEUTRAL = 1e-6
"""Rate [1/s] below which an eigenvalue counts as zero: a vehicle without resistance keeps any speed."""
_REAL = 1e-6  # share of an eigenvalue by which it may leave the real axis through rounding

_ALONE = 0.75  # share of the energy of bodies of one kind from which a mode is one body's
_CARRIED = 0.4  # share of the energy with which bodies that turn on others name a mode
_MIXED = 0.15  # share of the energy that a second motion of the same bodies needs to count in the name

_DIRECTIONS = {
    "x": "surge",
    "y": "lateral",
    "z": "bounce",
    "roll": "roll",
    "pitch": "pitch",
    "yaw": "yaw",
    "turn": "turn",
}
_SPIN = (("wheelset", "pitch"), ("rotor", "turn"))
"""What spins with one axle: together a driveline where it oscillates, slip where it does not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SmallMotion:
    """Small motion about a steady state: M a + D v + K q = 0 in the deviations of n coordinates.

    Contact and gyroscopic terms may make D and K unsymmetric. What is neutral is motion that no force opposes: a
    vehicle may stand anywhere, and wheels may have turned by any angle. Each neutral motion has one coordinate that
    stands for it and moves by 1, while those of all others stay.
    """

    coordinates: tuple[str, ...]  # such as "bogie_1.z": a body and a direction
    kinds: tuple[str, ...]  # what each of these bodies is, such as "bogie"
    mass: "Matrix"  # (n, n), symmetric and positive definite
    damping: "Matrix"  # (n, n)
    stiffness: "Matrix"  # (n, n)
    neutral: "Mapping[str, Matrix]" = field(default_factory=dict)  # (n,) by the coordinate that stands for it

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states: coordinates without neutral ones, against which they count, then all rates."""
        kept = tuple(name for name in self.coordinates if name not in self.neutral)
        return (*kept, *(f"{name}'" for name in self.coordinates))

    def state_matrix(self) -> "Matrix":
        """Return the matrix of the rates of :attr:`states`."""
        import numpy as np

        kept = [k for k, name in enumerate(self.coordinates) if name not in self.neutral]
        against = np.eye(len(self.coordinates))
        for name, motion in self.neutral.items():
            against[:, self.coordinates.index(name)] -= motion
        above = np.hstack([np.zeros((len(kept), len(kept))), against[kept]])
        return np.vstack(
            [above, -np.linalg.solve(self.mass, np.hstack([self.stiffness[:, kept], self.damping]))]
        )


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

    name: str  # numbered where several modes have one
    motion: str  # the same without a number
    pole: complex  # 1/s
    shares: tuple[Share, ...]  # largest first
    shape: "Shape"  # (n,), rates of the coordinates, of unit kinetic energy; the strongest has phase 0

    @property
    def oscillates(self) -> bool:
        """Tell whether the mode oscillates rather than decaying or growing evenly."""
        return self.pole.imag > 0.0

    @property
    def natural_frequency(self) -> float:
        """Size of the eigenvalue, which is the frequency without damping [Hz]."""
        return abs(self.pole) / (2.0 * math.pi)

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


def poles(motion: SmallMotion) -> "Shape":
    """Return the eigenvalues of small motion [1/s] without those of neutral motion, fastest growing first."""
    import numpy as np

    values = np.linalg.eigvals(motion.state_matrix())
    values = values[np.abs(values) >= _NEUTRAL]
    return np.asarray(values[np.argsort(-values.real)], dtype=np.complex128)


def modes(motion: SmallMotion) -> tuple[Mode, ...]:
    """Return the modes of small motion: those that oscillate by rising frequency, then the real ones, slowest first.

    Neutral motion is left out.

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
        found.append(_mode(motion, pole, vector[-n:]))
    found.sort(key=lambda mode: (not mode.oscillates, mode.natural_frequency))
    return _distinct(found)


def _mode(motion: SmallMotion, pole: complex, shape: "Shape") -> Mode:
    """Name one mode by the kinetic energy of its rates."""
    import numpy as np

    energy = np.real(np.conj(shape) * (motion.mass @ shape))
    energy = energy / energy.sum()
    lead = int(np.argmax(energy))
    turned = shape * np.exp(-1j * np.angle(shape[lead]))
    turned = turned / np.sqrt(np.real(np.conj(turned) @ (motion.mass @ turned)))
    parts: dict[tuple[str, str], float] = {}
    for key, part in zip(_motions(motion), energy, strict=True):
        parts[key] = parts.get(key, 0.0) + float(part)
    shares = tuple(
        Share(kind=kind, direction=direction, share=share)
        for (kind, direction), share in sorted(parts.items(), key=lambda item: -item[1])
    )
    name = _name(motion, energy, turned, shares, oscillates=pole.imag > 0.0)
    return Mode(name=name, motion=name, pole=pole, shares=shares, shape=turned)


def _motions(motion: SmallMotion) -> list[tuple[str, str]]:
    """Kind of body and direction of every coordinate."""
    return [(kind, _split(each)[1]) for kind, each in zip(motion.kinds, motion.coordinates, strict=True)]


def _split(coordinate: str) -> tuple[str, str]:
    """Split the name of a coordinate, ``"bogie_1.z"``, into body and direction."""
    body, _, direction = coordinate.rpartition(".")
    return body, direction


def _name(
    motion: SmallMotion, energy: "Matrix", shape: "Shape", shares: tuple[Share, ...], *, oscillates: bool
) -> str:
    """Say which bodies move and how, from the largest share of the energy."""
    import numpy as np

    spin = sum(each.share for each in shares if (each.kind, each.direction) in _SPIN)
    driven = any(each.share >= _CARRIED * spin for each in shares if each.kind == "rotor")
    other = max((each.share for each in shares if (each.kind, each.direction) not in _SPIN), default=0.0)
    if spin >= _CARRIED and spin > other and (driven or not oscillates):
        return _spinning(motion, energy, "driveline" if oscillates else "slip")
    # What turns on another body is moved by it: it names a mode only with much of the energy.
    leading = next(each for each in shares if each.direction != "turn" or each.share >= _CARRIED)
    kind, direction = leading.kind, leading.direction
    places = [place for place, each in enumerate(_motions(motion)) if each == (kind, direction)]
    parts = energy[places]
    strongest, _ = _split(motion.coordinates[places[int(np.argmax(parts))]])
    alone = parts.max() >= _ALONE * parts.sum()
    how = _DIRECTIONS.get(direction, direction)
    if len(places) == 1:
        return f"{_spoken(strongest)} {_level(motion, shape, shares, leading) or how}"
    if alone:
        return f"{_spoken(strongest)} {how}"
    if len(places) == 2:
        together = np.real(shape[places[0]] * np.conj(shape[places[1]])) > 0.0
        return f"{_plural(_spoken(kind))} {how}, {'in phase' if together else 'in opposition'}"
    return f"{_plural(_spoken(kind))} {how}"


def _spinning(motion: SmallMotion, energy: "Matrix", name: str) -> str:
    """Name a mode of what spins, by the axle that has most of its energy where one does."""
    parts: dict[str, float] = {}
    for (kind, direction), coordinate, part in zip(_motions(motion), motion.coordinates, energy, strict=True):
        if (kind, direction) in _SPIN:
            number = _split(coordinate)[0].removeprefix(f"{kind}_")
            parts[number] = parts.get(number, 0.0) + float(part)
    number, most = max(parts.items(), key=lambda item: item[1])
    return f"{name} {number}" if len(parts) > 1 and most >= _ALONE * sum(parts.values()) else name


def _level(motion: SmallMotion, shape: "Shape", shares: tuple[Share, ...], leading: Share) -> str:
    """Tell lower from upper sway where a body sways and rolls in one mode; empty elsewhere.

    With x forward, y left and z up a point at height h above the center moves y - h roll. Where y and roll have
    opposite signs it moves more the higher it is: the pole of the rolling lies low.
    """
    import numpy as np

    kind, direction = leading.kind, leading.direction
    other = {"y": "roll", "roll": "y"}.get(direction)
    if not any((each.kind, each.direction) == (kind, other) and each.share >= _MIXED for each in shares):
        return ""
    motions = _motions(motion)
    sway, roll = shape[motions.index((kind, "y"))], shape[motions.index((kind, "roll"))]
    return "lower sway" if np.real(sway * np.conj(roll)) < 0.0 else "upper sway"


def _spoken(name: str) -> str:
    return name.replace("_", " ")


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
