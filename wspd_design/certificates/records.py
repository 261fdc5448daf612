"""The form of a statement about stability: what is claimed, what supports it, and what it assumes."""

import math
from dataclasses import dataclass, field
from enum import Enum

from wspd_design.controllers.protocol import Controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle


class Status(Enum):
    """Verdict on a claim; the value says what it means."""

    PROVED = "holds for every point of the domain, by an exact argument"
    REFUTED = "false: the witness is a point where it fails"
    UNDECIDED = "neither shown nor refuted"
    EVIDENCE = "holds at every point that was tried, which proves nothing between them"
    VACUOUS = "true but says nothing about a stop"
    NOT_APPLICABLE = "the claim does not speak about this controller"


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """A two-sided enclosure of a number; a sampled bound has one open end."""

    low: float | None
    high: float | None
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """A coordinate of a witness or of a worst case, in the unit that people read."""

    name: str
    value: float
    unit: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Hypothesis:
    """A condition that a theorem needs, with its own verdict."""

    text: str
    status: Status


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """An inequality that the checker accepted, with the text from which it can be checked again."""

    claim: str  # name
    statement: str  # in words
    claim_hash: str  # SHA-256 of ranges, model text, relation and bound
    certificate: str  # JSON
    leaves: int  # boxes that the checker decided
    seconds: float  # that the check took


class Role(Enum):
    """What a series is in its plot."""

    CURVE = "curve"
    LIMIT = "limit that curves must respect, or reference"
    OUTLINE = "edge of a region"
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """A claim about a closed loop and its verdict.

    ``margin`` is positive when the claim holds: how far the tightest point is from the limit. A ``limitation`` says
    what the loop cannot do, so that its proof is no good news.
    """

    name: str
    title: str
    claim: str
    status: Status
    explanation: str
    limitation: bool = False
    margin: Range | None = None
    worst_point: tuple[Point, ...] = ()
    witness: tuple[Point, ...] = ()
    hypotheses: tuple[Hypothesis, ...] = ()
    assumptions: tuple[str, ...] = ()
    method: str
    resolution: str = ""
    reference: str = ""
    model_hash: str = ""
    seconds: float = 0.0
    undecided: float = 0.0  # share of the box that was left open
    engine: str = ""  # versions of what searched and what checked
    proofs: tuple[Proof, ...] = field(default=(), repr=False)
    series: tuple[Series, ...] = field(default=(), repr=False)
    maps: tuple[Map, ...] = field(default=(), repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """The closed loop and the domain that all checks speak about.

    ``contact_grows_with_load`` says whether Hertz's ellipse follows the wheel load when the mass varies.
    """

    vehicle: Vehicle
    rail: Rail
    controller: Controller
    slip: float  # -, reference
    speeds: tuple[float, float]  # m/s, lowest and highest
    slips: tuple[float, float]  # -, range of slip
    mass_bounds: tuple[float, float]  # kg
    inertia_bounds: tuple[float, float]  # kg m2, per wheelset
    mu0_bounds: tuple[float, float]
    sample_time: float  # s
    seed: int = 0
    contact_grows_with_load: bool = True

    def __post_init__(self) -> None:
        """Refuse ranges that are no ranges; a sign that no vehicle has is left to the checks to refute."""
        for name, (low, high) in (
            ("speeds", self.speeds),
            ("slips", self.slips),
            ("mass_bounds", self.mass_bounds),
            ("inertia_bounds", self.inertia_bounds),
            ("mu0_bounds", self.mu0_bounds),
        ):
            if not (math.isfinite(low) and math.isfinite(high) and low <= high):
                raise UserError(
                    f"{name} = ({low:g}, {high:g}) must be two finite numbers, the smaller one first"
                )
        if not 0.0 < self.slip < 1.0:
            raise UserError(f"slip = {self.slip:g} must lie in (0, 1); for percent write for example 14 %")
        if not 0.0 < self.sample_time < math.inf:
            raise UserError(f"sample time = {self.sample_time:g} s must be above 0")
