"""The register of assumptions: what theorems and stops take for granted, where reality breaks it, and who drops it.

Theorems state their assumptions in clauses of their own; here each clause belongs to an assumption with an id that
never changes, so that documents can cite it. A test holds that no clause is left over.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True, kw_only=True)
class Registered:
    """One assumption."""

    id: str
    short: str  # for page one
    title: str
    clauses: tuple[str, ...] = ()  # words by which theorems state it; none of one that everything rests on
    broken: str  # where it does not hold in reality
    dropped: str  # which simulated stops do without it; empty: none
    shown_by: str  # what would show on the vehicle that it holds, or how far


REGISTER: Final[tuple[Registered, ...]] = (
    Registered(
        id="A1",
        short="ideal torque",
        title="the torque is what the law commands",
        clauses=("T = u",),
        broken="every air brake: cylinders fill and vent in tenths of a second",
        dropped="all",
        shown_by="step responses of the cylinder pressure",
    ),
    Registered(
        id="A2",
        short="no sampling",
        title="the law runs without sampling",
        clauses=("no sampling", "continuous adaptation"),
        broken="every programmed law",
        dropped="all",
        shown_by="the cycle time of the control unit",
    ),
    Registered(
        id="A3",
        short="no saturation",
        title="no limit of the brake torque is met",
        clauses=(
            "no limit of the brake",
            "or limits of the brake",
            "inside the limits of the brake",
            "nothing saturates",
            "u* within the limits",
        ),
        broken="a full cylinder at low speed, an empty one at a sudden loss of adhesion",
        dropped="all",
        shown_by="pressures recorded in a slide",
    ),
    Registered(
        id="A4",
        short="valves without delay",
        title="valves open and close in pulses of any length, without delay",
        clauses=("averaged valve", "without ripple", "exact pulses", "pulses of filling", "pulses begin"),
        broken="dead times and shortest pulses of some 10 ms",
        dropped="those with a dead time or a shortest pulse",
        shown_by="pulse tests of the valves",
    ),
    Registered(
        id="A5",
        short="frozen speed",
        title="the train speed stands still while the slip moves",
        clauses=("frozen train speed", "slow change of the equilibrium", "p - a/v constant"),
        broken="every stop, most of all at low speed, where the slip is fast and the speed falls fast",
        dropped="all",
        shown_by="nothing: a simplification of proofs",
    ),
    Registered(
        id="A6",
        short="nominal numbers",
        title="the numbers of the vehicle and the rail are the nominal ones, and constant",
        clauses=(
            "nominal parameters",
            "are the nominal ones",
            "other numbers are nominal",
            "do not change",
            "may even change with time",
        ),
        broken="loads, pads, valves, worn wheels and rails differ from train to train and day to day",
        dropped="those with drawn numbers",
        shown_by="tolerances of delivery and maintenance, weighing, type tests of pads",
    ),
    Registered(
        id="A7",
        short="static load",
        title="the wheel load is static, and all axles are alike",
        clauses=("static load", "static wheel load", "quarter model", "load transfer", "loads add up"),
        broken="braking loads the front axles; wheels meet the rail that others left",
        dropped="those of the planar plant",
        shown_by="pitch of body and bogies in a stop",
    ),
    Registered(
        id="A8",
        short="exact measurement",
        title="speeds and torque are measured exactly and at once",
        clauses=(
            "exact measurement",
            "measured exactly",
            "measured without error",
            "scale of the train speed was found",
            "no computing time",
            "without dead time",
            "real numbers",
        ),
        broken="pulse wheels, noise, wrong radii, filters, computing time",
        dropped="those with disturbances of the measurement",
        shown_by="recordings of the sensors against a reference",
    ),
    Registered(
        id="A9",
        short="constant reference",
        title="the slip reference is constant",
        clauses=("slip reference constant",),
        broken="laws that look for the best slip",
        dropped="those of laws with a reference that moves",
        shown_by="nothing: a property of the law",
    ),
    Registered(
        id="A10",
        short="full supply",
        title="the air supply is full",
        clauses=("full supply pressure", "full pressure is demanded"),
        broken="long slides, leaks, a short main pipe",
        dropped="those of vehicles with a reservoir",
        shown_by="reservoir pressure recorded over repeated slides",
    ),
    Registered(
        id="A11",
        short="near the reference",
        title="the loop is already near what the statement speaks about",
        clauses=(
            "the slip stood at its reference",
            "small deviations",
            "the state is on the surface",
            "integral of the error has decayed",
            "the way from rolling",
            "that an equilibrium lies",
            "equilibrium is at the reference",
            "initial weights",
            "weights that differ",
            "b* and psi",
            "at its initial value",
            "stays: it has no slope",
        ),
        broken="the first slide of every stop, and each sudden change of the rail",
        dropped="all",
        shown_by="recordings of the first slide",
    ),
    Registered(
        id="A12",
        short="level track",
        title="the track is level and nothing but the brake and the running resistance acts",
        clauses=(
            "level track",
            "the train slows down",
            "no other brake",
            "no pad vibration",
            "rolling wheels and empty cylinders",
        ),
        broken="grades, other brakes of the train, vibration of pads",
        dropped="those with a grade, pad vibration or a further brake",
        shown_by="the line and the train for which the design is used",
    ),
    Registered(
        id="A13",
        short="law as in the theorem",
        title="the law has the form of the theorem, without what its program adds",
        clauses=(
            "differentiable",
            "proportional feedback",
            "adaptation of the law",
            "the gains of the law as they are",
            "what the law reads once",
            "nothing is said about what the law commands",
            "all symbols positive",
            "s > 0 for",
            "unlimited",
        ),
        broken="limits, dead zones and switches of a program",
        dropped="all",
        shown_by="the traced step of the law, which checks compare",
    ),
    Registered(
        id="A14",
        short="little slip is harmless",
        title="too little slip does no harm",
        clauses=("a deviation below the reference is benign", "a slip below the reference costs distance"),
        broken="it costs distance",
        dropped="all",
        shown_by="the distance of stops",
    ),
    Registered(
        id="A15",
        short="Polach's friction along the track",
        title="friction falls with the sliding speed as Polach's law says, the same along the track",
        clauses=("the model of the slip",),
        broken="films, leaves, water, and adhesion that comes back behind a sliding wheel",
        dropped="",
        shown_by="stops on a rail with measured adhesion",
    ),
    Registered(
        id="A16",
        short="numbers of the sources",
        title="vehicle and rail have the numbers that the sources state, of which many are assumed",
        broken="nobody has compared them with a vehicle",
        dropped="",
        shown_by="type tests; the sources tell which numbers are assumed",
    ),
    Registered(
        id="A17",
        short="straight track, round wheels",
        title="the train moves straight on, its wheelsets round and true",
        broken="curves, flats, suspension, lateral creep",
        dropped="",
        shown_by="stops in curves and with worn wheels",
    ),
)
"""In the order of their ids; a new one goes to the end."""


def ids_of(clause: str) -> tuple[str, ...]:
    """Return the ids of the assumptions that a clause of a theorem states."""
    return tuple(each.id for each in REGISTER if any(words in clause for words in each.clauses))


def stated_in(clauses: Iterable[str]) -> tuple[str, ...]:
    """Return the ids of the assumptions that some clauses state, in the order of the register."""
    found = {found for clause in clauses for found in ids_of(clause)}
    return tuple(each.id for each in REGISTER if each.id in found)
