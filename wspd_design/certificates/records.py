"""The form of a statement about stability: what is claimed, what supports it, and what it assumes."""

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any, cast

from wspd_design.certificates.quantities import QUANTITIES, STATE, is_working_name
from wspd_design.controllers.protocol import Controller, Law
from wspd_design.parameters.bounds import Bounds, Ends
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.later import later
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.kernel.finding import Finding
    from wspd_design.parameters.table import Table


class Status(Enum):
    """Verdict on a claim; the value says what it means."""

    PROVED = "holds for every point of the domain, by an exact argument"
    LIMITATION = "proved, and says what the closed loop cannot do"
    REFUTED = "false: the witness is a point where it fails"
    UNDECIDED = "neither proved nor refuted"
    EVIDENCE = "supported by samples or a simulation, which prove nothing beyond them"
    VACUOUS = "true but says nothing about a stop"
    NOT_APPLICABLE = "the claim does not speak about this controller or this vehicle"


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """A two-sided enclosure of a number; a sampled bound has one open end.

    Attributes
    ----------
    low : float or None
    high : float or None
    unit : str
    """

    low: float | None
    high: float | None
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """A coordinate of a witness or of a worst case, in the unit that people read.

    Attributes
    ----------
    name : str
    value : float
    unit : str
    """

    name: str
    value: float
    unit: str


SHOWN = {"m/s": (KMH, "km/h")}
"""Factor and unit in which people read a quantity, where it is not the SI unit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """A quantity with its range [SI units]; both ends of a number that is held are the same.

    Attributes
    ----------
    name : str
    low : float
    high : float
    unit : str
    """

    name: str
    low: float
    high: float
    unit: str

    @property
    def numbers(self) -> tuple[str, str]:
        """The range without its unit, and the unit in which people read it; a ratio has none."""
        factor, unit = SHOWN.get(self.unit, (1.0, self.unit))
        digits = 3 if self.name == "speed" else 6
        low, high = (f"{end * factor:.{digits}g}" for end in (self.low, self.high))
        return low if low == high else f"{low} to {high}", unit.removeprefix("-")

    @property
    def text(self) -> str:
        """Name, range and unit; a speed goes without its name."""
        numbers, unit = self.numbers
        said = f"{numbers} {unit}".rstrip()
        return said if self.name == "speed" else f"{self.name} {said}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Domain:
    """On what a statement holds: for all values of what varies, with the rest of the numbers with bounds held."""

    varied: tuple[Interval, ...]
    held: tuple[Interval, ...] = ()

    @property
    def text(self) -> str:
        """The domain in words, as it stands in claims."""
        varied, held = (", ".join(each.text for each in part) for part in (self.varied, self.held))
        return "; ".join(filter(None, (varied, f"held: {held}" if held else "")))


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """What a checker accepted: a statement, on what it holds, and in how many boxes it was decided."""

    statement: str
    domain: Domain | None  # none where the statement says all of it
    boxes: int

    @property
    def text(self) -> str:
        """The whole statement in words."""
        return self.statement if self.domain is None else f"{self.statement} on {self.domain.text}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Hypothesis:
    """A condition that a theorem needs, with its own verdict.

    Attributes
    ----------
    text : str
    status : Status
    """

    text: str
    status: Status


class Role(Enum):
    """What a series is in its plot."""

    CURVE = "curve"
    LIMIT = "limit that curves must respect, or reference"
    OUTLINE = "edge of a region"
    TRIED = "edge of a region about which nothing is proved"
    FAILED = "edge of a region at which a search ended"
    LYAPUNOV = "Lyapunov function over time"
    LOOP_GAIN = "gain inside the boundary layer"


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """Samples of a quantity over another one, for the plot beside the verdict."""

    name: str
    x_label: str
    y_label: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    role: Role = Role.CURVE


@dataclass(frozen=True, slots=True, kw_only=True)
class Map:
    """Samples of a quantity over two others, for the plot beside the verdict."""

    name: str
    x_label: str
    y_label: str
    value_label: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]  # a row for each y
    limit: float | None = None  # of the values, where the verdict would change
    worst: tuple[float, float] | None = None  # x and y of the tightest point


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Certificate:
    """A claim about a closed loop and its verdict.

    ``margin`` is positive when the claim holds: how far the tightest point is from the limit. ``remark`` is what
    samples say beside the verdict; no file keeps it.

    Attributes
    ----------
    claim : str
    status : Status
    explanation : str
    method : str
    name : str
        Of the theorem, as the title and the hash of the model; put in where its verdict is completed.
    title : str
    margin : Range or None
    worst_point : tuple[Point, ...]
    witness : tuple[Point, ...]
    hypotheses : tuple[Hypothesis, ...]
    assumptions : tuple[str, ...]
    domain : Domain or None
        Whose words stand in the claim; none where the claim varies no number.
    varied : tuple[str, ...]
        Numbers with bounds that the claim speaks about on all of their range.
    held : tuple[str, ...]
        Numbers with bounds that it depends on, but takes as known.
    reference : str
    model_hash : str
    remark : str
    seconds : float [s]
        That the search took.
        Of the search; none where a file was accepted again.
    findings : Mapping[str, Finding]
    series : tuple[Series, ...]
    maps : tuple[Map, ...]
    """

    claim: str
    status: Status
    explanation: str
    method: str
    name: str = ""
    title: str = ""
    margin: Range | None = None
    worst_point: tuple[Point, ...] = ()
    witness: tuple[Point, ...] = ()
    hypotheses: tuple[Hypothesis, ...] = ()
    assumptions: tuple[str, ...] = ()
    domain: Domain | None = None
    varied: tuple[str, ...] = ()
    held: tuple[str, ...] = ()
    reference: str = ""
    model_hash: str = ""
    remark: str = ""
    seconds: float = 0.0
    findings: Mapping[str, "Finding"] = field(default_factory=dict, repr=False)
    series: tuple[Series, ...] = field(default=(), repr=False)
    maps: tuple[Map, ...] = field(default=(), repr=False)

    def __repr__(self) -> str:
        """Say in one line what was claimed about what, and the verdict."""
        return f"<Certificate {self.name}: {self.status.name}, {self.title}>"

    def _repr_html_(self) -> str:
        return str(later("notebook.proofs", "certificate_card")(self))

    @property
    def searched(self) -> bool:
        """Whether a search found it, in place of a file that was accepted again."""
        return self.seconds > 0.0 and self.status is not Status.NOT_APPLICABLE

    @property
    def boxes(self) -> int:
        """Number of boxes that the searches looked at."""
        return sum(each.effort.boxes for each in self.findings.values())

    @property
    def proved(self) -> Mapping[str, "Finding"]:
        """What a checker accepted a proof of, by the keys of the obligations."""
        return {
            key: each for key, each in self.findings.items() if each.shown and each.stated.proof is not None
        }

    @property
    def proofs(self) -> tuple[Proof, ...]:
        """What was proved, each with what it holds on, of the numbers with bounds, as its own statement has them."""
        return tuple(
            Proof(statement=each.shown, domain=self._domain_of(each.ranges), boxes=each.leaves)
            for each in self.proved.values()
        )

    def _domain_of(self, ranges: tuple[Interval, ...]) -> Domain | None:
        uncertain = {*STATE, *self.varied, *self.held}
        varied = tuple(each for each in ranges if each.low < each.high)
        held = tuple(
            each
            for each in ranges
            if each.low == each.high
            and (each.name in uncertain or not (each.name in QUANTITIES or is_working_name(each.name)))
        )
        return Domain(varied=varied, held=held) if varied or held else None

    @property
    def undecided(self) -> float:
        """Largest share of a box that a search left open."""
        return max((each.effort.undecided for each in self.findings.values()), default=0.0)

    @property
    def cut(self) -> bool:
        """Whether a search was ended by its budget."""
        return any(each.effort.cut for each in self.findings.values())


class Certificates(tuple[Certificate, ...]):
    """What was found out about one closed loop: a tuple of certificates that shows itself as a table."""

    __slots__ = ()

    def __repr__(self) -> str:
        """Count the verdicts."""
        counts = Counter(each.status.name.lower().replace("_", " ") for each in self)
        said = ", ".join(f"{number} {word}" for word, number in counts.items())
        return f"<Certificates of {len(self)} checks: {said}>"

    def _repr_html_(self) -> str:
        return str(later("notebook.proofs", "proofs_card")(self))

    def table(self) -> "Table":
        """Return a row for each check: claim, verdict in words, margin."""
        table: Table = later("notebook.proofs", "proofs_table")(self)
        return table

    def to_pandas(self) -> Any:
        """Return a row for each check as a ``pandas.DataFrame``; needs the extra ``frames``."""
        return later("notebook.frames", "frame_of_proofs")(self)

    def named(self, name: str) -> Certificate:
        """Return the certificate of a check by its name.

        Raises
        ------
        UserError
            If no such check was made.
        """
        for each in self:
            if each.name == name:
                return each
        made = ", ".join(each.name for each in self)
        raise UserError(f'there is no certificate of the check "{name}" here; there are {made}')


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """The closed loop and the domain that all checks speak about.

    ``bounds`` are the ranges of the numbers of vehicle and rail by their names in the table of
    ``wspd_design.certificates.quantities``; a number without bounds is known. ``contact_grows_with_load`` says
    whether Hertz's ellipse follows the wheel load when the mass varies.

    Attributes
    ----------
    vehicle : Vehicle
    rail : Rail
    controller : Law
    slip : float [-]
        Reference.
    speeds : tuple[float, float] [m/s]
        Lowest and highest.
    slips : tuple[float, float] [-]
        Range of slip.
    bounds : Bounds
        SI units.
    sample_time : float [s]
    slip_tolerance : float [-]
        Within which an equilibrium shall lie beside the reference.
    seed : int
    contact_grows_with_load : bool
    """

    vehicle: Vehicle
    rail: Rail
    controller: Law
    slip: float
    speeds: tuple[float, float]
    slips: tuple[float, float]
    bounds: Bounds
    sample_time: float
    slip_tolerance: float = 0.05
    seed: int = 0
    contact_grows_with_load: bool = True

    @property
    def wheelset_law(self) -> Controller:
        """The controller where it is known to act on one wheelset."""
        return cast(Controller, self.controller)

    def __post_init__(self) -> None:
        """Refuse ranges that are not ranges; a sign that no vehicle has is left to the checks to refute."""
        for name, (low, high) in (("speeds", self.speeds), ("slips", self.slips)):
            if not (math.isfinite(low) and math.isfinite(high) and low <= high):
                raise UserError(
                    f"{name} = ({low:g}, {high:g}) must be two finite numbers, the smaller one first"
                )
        if not 0.0 < self.slip < 1.0:
            raise UserError(f"slip = {self.slip:g} must lie in (0, 1); for percent write for example 14 %")
        if not 0.0 < self.slip_tolerance < 1.0:
            raise UserError(f"slip tolerance = {self.slip_tolerance:g} must lie in (0, 1)")
        if not 0.0 < self.sample_time < math.inf:
            raise UserError(f"sample time = {self.sample_time:g} s must be above 0")
        unknown = [name for name in self.bounds if name not in QUANTITIES or name in STATE]
        if unknown:
            allowed = ", ".join(name for name in QUANTITIES if name not in STATE)
            raise UserError(
                f"bounds of {', '.join(unknown)}: there is no such number; the names are {allowed}"
            )

    @property
    def near(self) -> Ends:
        """Slips within the tolerance of the reference, inside the range of slip."""
        low, high = self.slip - self.slip_tolerance, self.slip + self.slip_tolerance
        return max(low, min(self.slips[0], self.slip)), min(high, max(self.slips[1], self.slip))

    def nominal(self, name: str) -> float:
        """Return the value of a number of vehicle or rail by its name in the table, or the reference of the slip."""
        quantity = QUANTITIES[name]
        if name == "slip":
            return self.slip
        records: dict[str, object] = {
            "vehicle": self.vehicle,
            "brake": self.vehicle.brake,
            "contact": self.vehicle.contact,
            "rail": self.rail,
        }
        if quantity.record not in records:
            raise ValueError(f"{name} has no nominal value")
        value: float = getattr(records[quantity.record], quantity.field)
        return value

    def span(self, name: str) -> Ends:
        """Return the range of slip, speed, or a number of vehicle or rail; one without bounds is known."""
        states = {"slip": self.slips, "speed": self.speeds}
        if name in states or name in self.bounds:
            return states.get(name) or self.bounds[name]
        value = self.nominal(name)
        return value, value
