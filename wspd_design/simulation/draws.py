"""Numbers that differ from stop to stop, each drawn from a sequence of its own.

The share that stop k gets of a number depends on the seed, the name of the number and k alone (a counter-based
generator, Philox): not on the other numbers that are drawn, and not on how the stops are divided.
"""

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from difflib import get_close_matches
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Protocol

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.gear import gear_of
from wspd_design.parameters.provenance import ParameterSet
from wspd_design.parameters.schema import Kind, schema_of
from wspd_design.parameters.taken import check_record
from wspd_design.plants.protocol import PLANAR_NUMBERS, CoupledPlant, Plant, is_coupled
from wspd_design.simulation.records import Scenario

FILE_KINDS: Mapping[str, Kind] = {"vehicle": "vehicle", "rail": "rail"}
"""Roots of names whose numbers stand in parameter files."""

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_PER_COUNT = 4  # numbers that Philox makes of one state of its counter
_CASTS: Mapping[Any, Callable[[float], Any]] = {
    float: float,
    float | None: float,
    int: round,
    bool: bool,
}  # of fields that can be drawn
_OWN = "multibody"  # begins the names of numbers of a coupled plant's own file
_NEVER = (
    "seed",
    "wheelsets",
    "axles_per_bogie",
    "bodies",
    "multibody",
    "rail",
    "bounds",
    "load_irregularity",
    "irregularities",
)  # of each stop anyway, or no number


class Distribution(Protocol):
    """How a number spreads."""

    @property
    def ends(self) -> tuple[float, float]:
        """Least and largest number that can come out."""

    def at(self, share: "Array") -> "Array":
        """Return the numbers below which these shares of all lie."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Uniform:
    """Evenly between two numbers [SI units].

    Attributes
    ----------
    low : float [SI unit]
    high : float [SI unit]
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        """Refuse ends that are not in order."""
        _check_ends("uniform", self.low, self.high)

    @property
    def ends(self) -> tuple[float, float]:
        """Least and largest number."""
        return self.low, self.high

    def at(self, share: "Array") -> "Array":
        """Return the numbers below which these shares of all lie."""
        return self.low + (self.high - self.low) * share


@dataclass(frozen=True, slots=True, kw_only=True)
class Normal:
    """Normal distribution, cut at two numbers [SI units].

    Attributes
    ----------
    mean : float [SI unit]
    deviation : float [SI unit]
    low : float [SI unit]
    high : float [SI unit]
    """

    mean: float
    deviation: float
    low: float
    high: float

    def __post_init__(self) -> None:
        """Refuse ends that are not in order, and no width."""
        _check_ends("normal", self.low, self.high)
        if not (math.isfinite(self.mean) and 0.0 < self.deviation < math.inf):
            raise UserError(
                f"normal distribution with mean {self.mean:g} and deviation {self.deviation:g}: both must be "
                "finite, and the deviation above 0"
            )
        if not self.low <= self.mean <= self.high:
            raise UserError(
                f"normal distribution with mean {self.mean:g} must be cut on both sides of it, not at {self.low:g} "
                f"and {self.high:g}"
            )

    @property
    def ends(self) -> tuple[float, float]:
        """Least and largest number."""
        return self.low, self.high

    def at(self, share: "Array") -> "Array":
        """Return the numbers below which these shares of all lie."""
        import numpy as np
        from scipy.special import ndtr, ndtri

        below, above = (ndtr((end - self.mean) / self.deviation) for end in self.ends)
        free = self.mean + self.deviation * ndtri(below + (above - below) * share)
        cut: Array = np.clip(free, self.low, self.high)
        return cut


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """One of several numbers, each as often as the others [SI units].

    Attributes
    ----------
    values : tuple[float, ...] [SI unit]
    """

    values: tuple[float, ...]

    def __post_init__(self) -> None:
        """Refuse an empty list and what is not a number."""
        if not self.values or not all(math.isfinite(value) for value in self.values):
            raise UserError(f"choice among {list(self.values)}: name one or more finite numbers")

    @property
    def ends(self) -> tuple[float, float]:
        """Least and largest number."""
        return min(self.values), max(self.values)

    def at(self, share: "Array") -> "Array":
        """Return the values at these shares of their list."""
        import numpy as np

        return np.array(self.values, dtype=np.float64)[(share * len(self.values)).astype(np.int64)]


@dataclass(frozen=True, slots=True, kw_only=True)
class About:
    """Evenly about the nominal number, which the records of a campaign have, by a share of it to both sides [-]."""

    share: float

    def __post_init__(self) -> None:
        """Refuse no width, and more than the number itself."""
        if not 0.0 < self.share <= 1.0:
            raise UserError(
                f"a draw about the nominal number by {self.share:g} of it must lie in (0, 1], such as 25 %"
            )

    def of(self, nominal: float, name: str) -> Uniform:
        """Return the distribution about a number of this name."""
        if nominal == 0.0:
            raise UserError(
                f"{name} is drawn about its nominal number, which is 0; draw it uniform between two numbers"
            )
        low, high = sorted((nominal * (1.0 - self.share), nominal * (1.0 + self.share)))
        return Uniform(low=low, high=high)


@dataclass(frozen=True, slots=True, kw_only=True)
class Draw:
    """A number that each stop draws anew.

    Its name is the path of its record: ``vehicle.mass``, ``vehicle.brake.fill_time``, ``rail.mu0``,
    ``stop.initial_speed``, ``stop.sensing.speed_noise``; ``multibody.primary.stiffness_z`` of the file behind the plant
    ``locomotive``. Every number of :class:`Vehicle`, :class:`Rail` and
    :class:`Scenario` can be drawn, and what is on or off as 0 and 1.

    Attributes
    ----------
    name : str
    distribution : Distribution or About
    """

    name: str
    distribution: Distribution | About


def within_bounds(*parameters: ParameterSet) -> tuple[Draw, ...]:
    """Draw every number of parameter files that has bounds evenly within them; those of a laden state stay.

    Parameters
    ----------
    *parameters : ParameterSet
        Files, as :func:`wspd_design.load_entries` returns them.
    """
    for each in parameters:
        check_record(each, ParameterSet, by="within_bounds", remedy='give load_entries("vehicle", "er24pc")')
    return tuple(
        Draw(name=f"{each.kind}.{name}", distribution=Uniform(low=limits[0], high=limits[1]))
        for each in parameters
        for name, entry in each.entries.items()
        if (limits := entry.bounds) is not None and limits[0] < limits[1] and isinstance(entry.value, float)
        if not name.startswith("laden.")  # which the empty vehicle does not have
    )


def within_bounds_of_stop(
    scenario: Scenario, parameters: Sequence[ParameterSet], plant: Plant | None = None
) -> tuple[Draw, ...]:
    """Draw every number with bounds that counts on a plant.

    Rails of single axles stay, or they would all become the same rail.
    """
    draws = within_bounds(
        *(each for each in parameters if each.kind != "rail" or scenario.axle_rails is None)
    )
    if plant is None or not is_coupled(plant):
        return draws
    return tuple(draw for draw in draws if draw.name.removeprefix("vehicle.") not in PLANAR_NUMBERS)


def within_own_bounds(plant: CoupledPlant) -> tuple[Draw, ...]:
    """Draw every number with bounds of the multibody file behind a plant, but those that the vehicle file has."""
    return tuple(
        Draw(name=f"{_OWN}.{name}", distribution=Uniform(low=low, high=high))
        for name, (low, high) in plant.own_bounds.items()
    )


class Deck:
    """The stops of a campaign: nominal records, and the draws in their places."""

    def __init__(self, plant: Plant, scenario: Scenario, draws: Sequence[Draw]) -> None:
        self._plant, self._scenario = plant, scenario
        roots = {"vehicle": plant.vehicle, "rail": scenario.rail, "stop": scenario}
        self._columns = {draw.name: column for column, draw in enumerate(draws)}
        self._own: dict[str, float] = {}  # numbers of the plant's own file
        if is_coupled(plant):
            known = dict(zip(plant.number_names, plant.numbers, strict=True))
            self._own = {f"{_OWN}.{name}": known[name] for name in plant.own_bounds}
        for draw in draws:
            _check_name(draw.name, roots, self._own)
        self._spreads = {draw.name: _spread(draw, roots, self._own) for draw in draws}
        if len(self._columns) < len(draws):
            raise UserError(f"{_twice([draw.name for draw in draws])} is drawn twice; name it once")
        drawn = {root: _below(self._columns, root) for root in roots}
        if scenario.axle_rails is not None and drawn["rail"]:
            raise UserError(
                "numbers of the rail are drawn and the axles have rails of their own, which would all become the "
                "same one; leave out one of the two"
            )
        self._stop = _maker(scenario, drawn["stop"])
        self._make = {root: _maker(roots[root], drawn[root]) for root in ("vehicle", "rail") if drawn[root]}

    def extremes(self) -> list[tuple[Plant, Scenario]]:
        """Records with all numbers at their least, and at their largest; what cannot be is refused."""
        return [self._case([spread.ends[end] for spread in self._spreads.values()], 0) for end in (0, 1)]

    def values(self, first: int, count: int) -> "Array":
        """Numbers of ``count`` stops from ``first`` on, one row a stop, one column a draw."""
        import numpy as np

        columns = [
            spread.at(_shares(self._scenario.seed, name, first, count))
            for name, spread in self._spreads.items()
        ]
        return np.array(columns, dtype=np.float64).reshape(len(columns), count).T

    def cases(self, first: int, count: int) -> list[tuple[Plant, Scenario]]:
        """Records of ``count`` stops from ``first`` on."""
        rows = self.values(first, count).tolist()
        return [self._case(row, self._scenario.seed + run) for run, row in enumerate(rows, first)]

    def _case(self, row: list[float], seed: int) -> tuple[Plant, Scenario]:
        plant, rail = self._plant, self._scenario.rail
        if "vehicle" in self._make:
            plant = plant.on(self._make["vehicle"](row, **self._carried(row)))
        own = _below(self._columns, _OWN)
        if own and is_coupled(plant):
            plant = plant.with_own({name: row[column] for name, column in own.items()})
        if "rail" in self._make:
            rail = self._make["rail"](row)
        return plant, self._stop(row, rail=rail, seed=seed)

    def _carried(self, row: list[float]) -> dict[str, float]:
        """Mass of each body, which takes up what a drawn mass gains or loses, unless it is drawn itself."""
        vehicle = self._plant.vehicle
        mass, body, bogie = (
            self._columns.get(f"vehicle.{name}") for name in ("mass", "body_mass", "bogie_mass")
        )
        if mass is None or body is not None:
            return {}
        each = vehicle.bogie_mass if bogie is None else row[bogie]
        gear = gear_of(vehicle)
        return {"body_mass": (row[mass] - gear.supports * each) / gear.bodies}


def _shares(seed: int, name: str, first: int, count: int) -> "Array":
    """Even numbers in [0, 1) of the stops from ``first`` on."""
    import numpy as np

    key = int.from_bytes(hashlib.sha256(f"{seed}:{name}".encode()).digest()[:16], "little")
    counter, skipped = divmod(first, _PER_COUNT)
    generator = np.random.Generator(np.random.Philox(key=key, counter=counter))
    return generator.random(skipped + count)[skipped:]


def _below(columns: Mapping[str, int], root: str) -> dict[str, int]:
    """Columns of the names that begin with a root, without it."""
    return {
        name.removeprefix(f"{root}."): column
        for name, column in columns.items()
        if name.startswith(f"{root}.")
    }


def _maker(record: Any, columns: Mapping[str, int]) -> Callable[..., Any]:
    """Return what puts a row of drawn numbers into the fields of a record, several times faster than ``replace``."""
    kind, base = type(record), {field.name: getattr(record, field.name) for field in fields(record)}
    kinds = {field.name: field.type for field in fields(record)}
    own = [(name, column, _CASTS[kinds[name]]) for name, column in columns.items() if "." not in name]
    heads = dict.fromkeys(name.partition(".")[0] for name in columns if "." in name)
    inner = [(head, _maker(base[head], _below(columns, head))) for head in heads]

    def make(row: list[float], **known: object) -> Any:
        changed = base | known
        for name, column, cast in own:
            changed[name] = cast(row[column])
        for name, below in inner:
            changed[name] = below(row)
        return kind(**changed)

    return make


def drawable(record: Any, path: str) -> list[str]:
    """Return the names of all numbers of a record and of the records in it."""
    found = []
    for field in fields(record):
        value, name = getattr(record, field.name), f"{path}.{field.name}"
        if field.name in _NEVER:
            continue
        if field.type in _CASTS:
            found.append(name)
        elif is_dataclass(value):
            found += drawable(value, name)
    return found


def _twice(names: list[str]) -> str:
    return next(name for name in names if names.count(name) > 1)


def _check_name(name: str, roots: Mapping[str, Any], own: Mapping[str, float]) -> None:
    known = [*(each for root, record in roots.items() for each in drawable(record, root)), *own]
    if name not in known:
        near = get_close_matches(name, known, n=1)
        remedy = f'did you mean "{near[0]}"?' if near else f"what can be drawn: {', '.join(known)}"
        raise UserError(f'"{name}" is not a number of vehicle, rail or stop that can be drawn; {remedy}')


def _spread(draw: Draw, roots: Mapping[str, Any], own: Mapping[str, float]) -> Distribution:
    """Return the distribution of a draw; refuse ends that a parameter file must not have either."""
    root, _, name = draw.name.partition(".")
    spread = draw.distribution
    if isinstance(spread, About):
        value = own[draw.name] if root == _OWN else attrgetter(name)(roots[root])
        spread = spread.of(0.0 if value is None else float(value), draw.name)
    if root not in FILE_KINDS:
        return spread
    quantity = schema_of(FILE_KINDS[root], "")[name]
    for end in spread.ends:
        if not quantity.admits(end):
            raise UserError(f"{draw.name} is drawn down or up to {end:g}; it must be {quantity.range_text}")
    return spread


def _check_ends(what: str, low: float, high: float) -> None:
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise UserError(
            f"{what} distribution from {low:g} to {high:g}: both ends must be finite, and the first below the second"
        )
