"""Drawn sets of vehicle, rail and stop: the same for every law that is judged by them.

Set k is run k of the deck of rail k modulo their number, whatever else is drawn, so that a set depends on requirements,
seed and k alone. The distance of its ideal stop is worked out once.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.design.requirements import DrawnSets, Requirements
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import load_entries
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.batch import STOPS_SIDE_BY_SIDE
from wspd_design.simulation.campaign_rows import ideal_distances
from wspd_design.simulation.draws import Choice, Deck, Draw, within_bounds
from wspd_design.simulation.records import Scenario

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.parameters.records import Vehicle

    Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Stops that run side by side, with the distances of their ideal stops [m]."""

    numbers: tuple[int, ...]  # of the sets
    cases: tuple[tuple[Plant, Scenario], ...]
    ideal: "Array"


@dataclass(frozen=True, slots=True, kw_only=True)
class Sets:
    """All stops of a search, or all held-out ones."""

    drawn: DrawnSets
    groups: tuple[Group, ...]  # the last may hold more sets than are asked for


def draw_sets(
    requirements: Requirements, vehicle: "Vehicle", vehicle_name: str, drawn: DrawnSets, pool: Executor
) -> Sets:
    """Draw sets.

    Parameters
    ----------
    requirements : Requirements
        Rails, numbers of the stop and draws; paths of rails as seen from here.
    vehicle : Vehicle
        Nominal vehicle.
    vehicle_name : str
        Shipped name or path of its file, whose bounds may be drawn from.
    drawn : DrawnSets
        How many, and from which seed.
    pool : Executor
        Threads that simulate the ideal stops.

    Raises
    ------
    UserError
        If a number cannot be drawn, or a train cannot stop even ideally.
    """
    import numpy as np

    numbers = _grouped(drawn.sets, len(requirements.rails))
    decks = [_deck(requirements, vehicle, vehicle_name, rail, drawn.seed) for rail in requirements.rails]
    made = []
    for deck in decks:
        deck.extremes()  # refuses what cannot be before anything is simulated
        made.append(deck.cases(0, len(numbers) * STOPS_SIDE_BY_SIDE))
    cases = [tuple(made[k % len(decks)][k] for k in group) for group in numbers]
    ideals = list(pool.map(lambda group, each: np.array(ideal_distances(each, told(group))), numbers, cases))
    for group, ideal in zip(numbers, ideals, strict=True):
        for k, distance in zip(group, ideal, strict=True):
            if not np.isfinite(distance):
                raise UserError(
                    f"set {k} of seed {drawn.seed} on {requirements.rails[k % len(decks)]} has no ideal stop to "
                    "compare with: the train cannot stop, or does not start rolling; draw less, or take another rail"
                )
    groups = [
        Group(numbers=group, cases=each, ideal=ideal)
        for group, each, ideal in zip(numbers, cases, ideals, strict=True)
    ]
    return Sets(drawn=drawn, groups=tuple(groups))


def _grouped(count: int, rails: int) -> list[tuple[int, ...]]:
    """Divide sets into groups of one rail each, since stops that take alike end together; the rest share groups.

    The last group is filled up with further sets.
    """
    side = STOPS_SIDE_BY_SIDE
    groups, rest = [], []
    for rail in range(rails):
        of_rail = list(range(rail, count, rails))
        whole = len(of_rail) // side * side
        groups += [tuple(of_rail[first : first + side]) for first in range(0, whole, side)]
        rest += of_rail[whole:]
    rest += range(count, count + -len(rest) % side)
    return [*groups, *(tuple(rest[first : first + side]) for first in range(0, len(rest), side))]


def told(numbers: Sequence[int]) -> str:
    """Name sets in a sentence."""
    return f"sets {min(numbers)} to {max(numbers)}"


def _deck(
    requirements: Requirements, vehicle: "Vehicle", vehicle_name: str, rail_name: str, seed: int
) -> Deck:
    fixed = dict(requirements.stop)
    scenario = Scenario(rail=load_rail(rail_name), initial_speed=fixed["stop.initial_speed"], seed=seed)
    files = {"vehicle": vehicle_name, "rail": rail_name}
    bounded = within_bounds(
        *(
            load_entries("vehicle" if kind == "vehicle" else "rail", files[kind])
            for kind in requirements.within_bounds
        )
    )
    named = {draw.name for draw in requirements.draws}
    # A number that is the same in all stops is a choice of one.
    same = tuple(Draw(name=name, distribution=Choice(values=(value,))) for name, value in requirements.stop)
    draws = (*(draw for draw in bounded if draw.name not in named), *requirements.draws, *same)
    return Deck(plant_of(DEFAULT_PLANT, vehicle), scenario, draws)


def disjoint(one: DrawnSets, other: DrawnSets) -> bool:
    """Tell whether two series of sets share neither drawn numbers nor the seeds of the noise of any stop."""
    return abs(one.seed - other.seed) >= max(one.sets, other.sets) + STOPS_SIDE_BY_SIDE
