"""How far a stop spreads over the bounds of all numbers, what each of them does alone, and other conditions."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import Law
from wspd_design.design.judging import threads
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.provenance import ParameterSet
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import plant_of
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.batch import STOPS_SIDE_BY_SIDE
from wspd_design.simulation.campaign import simulate_many, whole
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.draws import Choice, Deck, Draw, within_bounds_of_stop
from wspd_design.simulation.records import Scenario
from wspd_design.studies.conditions import Case, Condition, conditions
from wspd_design.studies.key_figures import KEY_FIGURES, Outcome, key_figures, outcome_of, outcomes

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SETS = 12 * STOPS_SIDE_BY_SIDE
LEAST, MOST = 0.05, 0.95  # shares of the sets below the percentiles


@dataclass(frozen=True, slots=True, kw_only=True)
class WorstSet:
    """The drawn set at which a figure is worst, simulated once more alone and with its steps checked."""

    number: int
    value: float  # of the figure, as ``wspd simulate`` shows it
    parameters: tuple[tuple[str, float], ...]  # the drawn numbers by their names [SI units]
    command: str  # that simulates it again; empty where no command made the report


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """How one key figure spreads over the drawn sets [SI units]; infinite where a train does not stop."""

    name: str  # as in KEY_FIGURES
    nominal: float
    low: float  # least of all sets
    high: float
    p05: float  # value of a set, at or below which a twentieth of them lie
    p95: float
    worst: WorstSet
    values: tuple[float, ...]  # of all sets, in their order; NaN where a stop has no such figure

    @property
    def width(self) -> float:
        """What lies between the percentiles, or all sets if nothing does: the digits of the figure follow from it."""
        return self.p95 - self.p05 or self.high - self.low


@dataclass(frozen=True, slots=True, kw_only=True)
class Effect:
    """What one number does alone, at both ends of its bounds with all others nominal."""

    name: str  # such as vehicle.brake.fill_time
    low: float  # ends of the bounds [SI units]
    high: float
    at_low: Outcome
    at_high: Outcome

    def ends(self, figure: str) -> tuple[float, float]:
        """Return a key figure at the lower and at the upper bound; NaN where a stop has none."""
        return dict(self.at_low).get(figure, math.nan), dict(self.at_high).get(figure, math.nan)

    def reach(self, figure: str, nominal: float) -> float:
        """Return the largest change of a key figure; NaN where a stop has none."""
        return max(abs(end - nominal) for end in self.ends(figure))


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """One stop under another condition."""

    subject: str
    words: str
    outcome: Outcome


@dataclass(frozen=True, slots=True, kw_only=True)
class Uncertainty:
    """What the bounds of all numbers make of a stop."""

    sets: int
    seed: int
    drawn: tuple[str, ...]  # numbers that were drawn, by their names
    held: tuple[str, ...]  # numbers with bounds that were not
    unstopped: int  # sets whose train does not come to a standstill
    checked: int  # sets that were simulated again with half the steps
    step_change: float  # -, largest relative change of the distance in those
    numerical: float  # m, spread of the nominal distance over starts that nobody can tell apart
    numbers: tuple[tuple[float, ...], ...]  # of each set, in the order of their names
    spreads: tuple[Spread, ...]
    effects: tuple[Effect, ...]  # one for each drawn number
    variants: tuple[Variant, ...]

    def spread_of(self, name: str) -> Spread | None:
        """Return how a key figure spreads; None where no stop has it."""
        return next((each for each in self.spreads if each.name == name), None)

    def strongest(self, figure: str) -> tuple[Effect, ...]:
        """Return the effects on a key figure, the strongest first; those without the figure are left out."""
        spread = self.spread_of(figure)
        if spread is None:
            return ()
        reaches = [(each.reach(figure, spread.nominal), each) for each in self.effects]
        known = [pair for pair in reaches if not math.isnan(pair[0])]
        return tuple(each for _, each in sorted(known, key=lambda pair: -pair[0]))


def uncertainty(
    vehicle: Vehicle,
    law: Law,
    scenario: Scenario,
    nominal: Trial,
    *,
    slip_reference: float,
    parameters: Sequence[ParameterSet],
    laden: Vehicle | None,
    plant: str,
    command: str,
    sets: int = SETS,
    progress: Callable[[str], None] = lambda _stage: None,
) -> Uncertainty | None:
    """Simulate the stop of a design with numbers drawn from their bounds, with each at its ends, and elsewhere.

    Parameters
    ----------
    vehicle : Vehicle
        Nominal vehicle.
    law : Law
        As it was designed: it knows the nominal numbers, whatever is drawn.
    scenario : Scenario
        Nominal stop; its seed is that of the drawing.
    nominal : Trial
        That stop, simulated.
    slip_reference : float
        Reference of the slip for laws that hold none of their own [-].
    parameters : sequence of ParameterSet
        Files of vehicle and rail, whose bounds are drawn from.
    laden : Vehicle or None
        The vehicle with its load, if that is known.
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        With load transfer, without, or with all degrees of freedom.
    command : str
        ``wspd simulate`` with the options of the nominal stop; empty where there was no command.
    sets : int
        Number of drawn sets.
    progress : callable, optional
        Told what is simulated.

    Returns
    -------
    Uncertainty or None
        None where no number has bounds that can be drawn from.
    """
    import numpy as np

    draws = within_bounds_of_stop(scenario, parameters)
    if not draws:
        return None
    bounds = {f"{each.kind}.{name}": ends for each in parameters for name, ends in each.bounds.items()}
    progress(f"uncertainty: {sets} drawn sets")
    campaign = whole(simulate_many(vehicle, law, scenario, count=sets, draws=draws, plant=plant))
    table = campaign.table
    checked = table["step_distance_change"][~np.isnan(table["step_distance_change"])]
    basis = _Basis(
        plant=plant_of(plant, vehicle),
        law=law,
        scenario=scenario,
        draws=draws,
        bounds=bounds,
        nominal=nominal,
        slip_reference=slip_reference,
        command=command,
    )
    with threads() as pool:
        progress("uncertainty: worst sets")
        spreads = _spreads(key_figures({name: table[name] for name in table.dtype.names or ()}), basis, pool)
        progress("uncertainty: single effects and other conditions")
        effects = _effects(basis, pool)
        variants = _variants(basis, conditions(basis.plant, scenario, bounds, laden), effects, pool)
    names = tuple(draw.name for draw in draws)
    return Uncertainty(
        sets=sets,
        seed=scenario.seed,
        drawn=names,
        held=tuple(name for name in bounds if name not in names),
        unstopped=int((~table["stopped"]).sum()),
        checked=len(checked),
        step_change=float(checked.max()) if len(checked) else math.nan,
        numerical=nominal.check.spread,
        numbers=tuple(zip(*(table[name].tolist() for name in names), strict=True)),
        spreads=spreads,
        effects=effects,
        variants=variants,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Basis:
    """The nominal stop, and the numbers that are drawn."""

    plant: Plant
    law: Law
    scenario: Scenario
    draws: tuple[Draw, ...]
    bounds: Mapping[str, Ends]  # of all numbers of the files, by their names
    nominal: Trial
    slip_reference: float
    command: str

    def with_numbers(self, numbers: Mapping[str, float]) -> Case:
        """Return the stop with some of the numbers in place of the nominal ones."""
        fixed = [Draw(name=name, distribution=Choice(values=(value,))) for name, value in numbers.items()]
        return Deck(self.plant, self.scenario, fixed).cases(0, 1)[0]


def _spreads(figures: "dict[str, Array]", basis: _Basis, pool: Executor) -> tuple[Spread, ...]:
    """Tell how the key figures spread; the worst sets are simulated alone, whose finer steps may move the worst."""
    import numpy as np

    deck = Deck(basis.plant, basis.scenario, basis.draws)
    done: set[int] = set()
    while missing := sorted({_worst(*each) for each in figures.items()} - done):
        for number, outcome in zip(
            missing, pool.map(lambda each: _alone(basis, deck, each), missing), strict=True
        ):
            for name, value in outcome:
                if name in figures:
                    figures[name][number] = value
        done.update(missing)
    nominal = dict(outcome_of(basis.nominal))
    found = []
    for name, values in figures.items():
        known, number = values[~np.isnan(values)], _worst(name, values)
        p05, p95 = np.quantile(known, (LEAST, MOST), method="inverted_cdf").tolist()
        found.append(
            Spread(
                name=name,
                nominal=nominal.get(name, math.nan),
                low=float(known.min()),
                high=float(known.max()),
                p05=p05,
                p95=p95,
                worst=WorstSet(
                    number=number,
                    value=float(values[number]),
                    parameters=tuple(
                        zip(
                            (draw.name for draw in basis.draws),
                            deck.values(number, 1)[0].tolist(),
                            strict=True,
                        )
                    ),
                    command=f"{basis.command} --only-run {number}" if basis.command else "",
                ),
                values=tuple(values.tolist()),
            )
        )
    return tuple(found)


def _worst(name: str, values: "Array") -> int:
    """Return the number of the set at which a figure is worst; of several the first."""
    import numpy as np

    return int(np.nanargmin(values) if KEY_FIGURES[name].least_is_worst else np.nanargmax(values))


def _alone(basis: _Basis, deck: Deck, number: int) -> Outcome:
    """Simulate a drawn set as ``wspd simulate --only-run`` does."""
    ((plant, scenario),) = deck.cases(number, 1)
    held = slip_reference_of(basis.law)
    reference = basis.slip_reference if held is None else held
    return outcome_of(trial(plant.vehicle, basis.law, scenario, slip_reference=reference, plant=plant.name))


def _effects(basis: _Basis, pool: Executor) -> tuple[Effect, ...]:
    ends = [(draw.name, basis.bounds[draw.name]) for draw in basis.draws]
    cases = [basis.with_numbers({name: end}) for name, pair in ends for end in pair]
    found = outcomes(cases, basis.law, pool)
    return tuple(
        Effect(name=name, low=low, high=high, at_low=found[2 * k], at_high=found[2 * k + 1])
        for k, (name, (low, high)) in enumerate(ends)
    )


def _variants(
    basis: _Basis, changed: Sequence[Condition], effects: Sequence[Effect], pool: Executor
) -> tuple[Variant, ...]:
    """Simulate the conditions, and last all numbers together at the ends that lengthen, or shorten, the stop alone."""
    together = [
        Condition(subject="all numbers", words=words, case=basis.with_numbers(_corner(effects, pick)))
        for words, pick in (
            ("each where it shortens the stop", min),
            ("each where it lengthens the stop", max),
        )
    ]
    listed = [*changed, *together]
    found = outcomes([each.case for each in listed], basis.law, pool)
    return tuple(
        Variant(subject=each.subject, words=each.words, outcome=outcome)
        for each, outcome in zip(listed, found, strict=True)
    )


def _corner(
    effects: Sequence[Effect], pick: Callable[[Sequence[tuple[float, float]]], tuple[float, float]]
) -> dict[str, float]:
    """Return for each number the end of its bounds with the shortest, or the longest, stop."""
    return {
        each.name: pick(list(zip(each.ends("distance"), (each.low, each.high), strict=True)))[1]
        for each in effects
    }
