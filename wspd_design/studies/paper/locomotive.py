"""Section 7 on the multibody model: on smooth and on irregular track, and what its inferred numbers do."""

import math
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace

from wspd_design.controllers.protocol import Law
from wspd_design.design.catalog import controller
from wspd_design.design.judging import threads
from wspd_design.design.records import Specification
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.locomotive import LinearLocomotive, Locomotive
from wspd_design.plants.multibody.records import Multibody
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.held_slip import build_up
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.self_check import (
    StepCheck,
    distance_difference,
    perturbed_spread,
    slip_difference,
)
from wspd_design.simulation.stop import simulate_on
from wspd_design.studies.paper.evidence import CONSTANT_RAILS
from wspd_design.studies.paper.published import PublishedStops
from wspd_design.studies.paper.section7 import Section7, judged, laws_and_rails, parts
from wspd_design.studies.rung import AxleFigures, axle_figures
from wspd_design.studies.tornado import Tornado, tornado

LAW = "afsmc"
"""The law of the figures of loads."""

SETTLING = ("torque-feedback", "polach-wet", 0.02)
"""Law, rail and sample time [s] of the single effects: a loop that settles, whose stop moves with the numbers alone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OnLocomotive:
    """What Section 7 comes to on the multibody model; all of it rests on numbers that are inferred."""

    model: Multibody
    smooth: Section7
    irregular: Section7  # the parts of the law are those on smooth track
    seed: int  # of the irregular track
    tornado: Tornado

    def axles(self, stops: Section7) -> tuple[AxleFigures, ...]:
        """Take the stop of Figure 21 apart by wheelset."""
        done = stops.trials[LAW, CONSTANT_RAILS[1]]
        return axle_figures(
            done.run,
            wheelsets=stops.vehicle.wheelsets,
            wheel_radius=stops.vehicle.wheel_radius,
            build_up=done.metrics.build_up,
        )


NEIGHBOURS = 2
"""Stops from slightly different speeds: fewer than on the small model, as each takes longer."""


def on_locomotive(
    small: Section7,
    published: PublishedStops,
    stops: Mapping[str, Scenario],
    *,
    seed: int,
    progress: Callable[[str], object],
) -> OnLocomotive:
    """Simulate the stops of Section 7 on the multibody model of the locomotive.

    Parameters
    ----------
    small : Section7
        The same stops on the small model.
    published : PublishedStops
        Table 10.
    stops : mapping of str to Scenario
        By rail.
    seed : int
        Of the irregular track.
    progress : callable
        Told each stop once it is done.
    """
    vehicle, specification = small.vehicle, small.specification
    plant = Locomotive(vehicle)
    rough = {rail: replace(scenario, irregularities="high", seed=seed) for rail, scenario in stops.items()}

    def law(name: str, rail: str) -> Law:
        return controller(name, vehicle, stops[rail].rail, specification)

    def checked(name: str, rail: str) -> Trial:
        return checked_trial(plant, law(name, rail), stops[rail], small.trials[name, rail])

    def on_rough_track(name: str, rail: str) -> Trial:
        return checked_trial(plant, law(name, rail), rough[rail], small.trials[name, rail])

    keys = laws_and_rails()
    with threads() as pool:

        def told(run: Callable[[str, str], Trial], what: str) -> dict[tuple[str, str], Trial]:
            found = {}
            for (name, rail), done in zip(keys, pool.map(run, *zip(*keys, strict=True)), strict=True):
                progress(f"{name} on {rail}, {what}")
                found[name, rail] = done
            return found

        trials = told(checked, "multibody model")
        progress("parts of the adaptive fuzzy law, multibody model")
        ablations = tuple(
            pool.map(lambda each: parts(vehicle, specification, each, plant=plant.name), stops.values())
        )
        smooth = judged(
            vehicle, specification, published, stops, plant=plant.name, trials=trials, ablations=ablations
        )
        irregular = judged(
            vehicle,
            specification,
            published,
            stops,
            plant=plant.name,
            trials=told(on_rough_track, "irregular track"),
            ablations=ablations,
        )
        progress("inferred numbers, one at a time")
        found = single_effects(vehicle, specification, stops, pool)
    return OnLocomotive(model=plant.model, smooth=smooth, irregular=irregular, seed=seed, tornado=found)


def single_effects(
    vehicle: Vehicle, specification: Specification, stops: Mapping[str, Scenario], pool: Executor
) -> Tornado:
    """Simulate a stop with each number of the multibody file at both ends of its bounds, on the linear model."""
    name, rail, sample_time = SETTLING
    law = controller(name, vehicle, stops[rail].rail, replace(specification, sample_time=sample_time))
    linear = LinearLocomotive(vehicle)
    nominal = simulate_on(linear, law, stops[rail])
    return tornado(
        linear,
        law,
        stops[rail],
        linear.own_bounds,
        varied=linear.with_number,
        build_up=build_up(nominal)[0],
        pool=pool,
    )


def checked_trial(plant: Plant, law: Law, scenario: Scenario, small: Trial) -> Trial:
    """Simulate one stop, again with half the steps, and from slightly different speeds, and judge it.

    The ideal stop is that of the small model, which is known: its brake and friction are the same.
    """
    run = simulate_on(plant, law, scenario)
    finer = simulate_on(plant, law, scenario, refinement=2)
    spread = perturbed_spread(plant, law, scenario, run, neighbours=NEIGHBOURS)
    reference, ideal = small.slip_reference, small.metrics.ideal_stop
    judged = metrics(run, plant.vehicle, scenario, slip_reference=reference)
    stopped = run.ending is Ending.STOPPED
    return Trial(
        run=run,
        metrics=replace(
            judged,
            ideal_stop=ideal,
            ideal_ending=small.metrics.ideal_ending,
            efficiency=ideal / judged.distance if stopped else math.nan,
        ),
        slip_reference=reference,
        check=StepCheck(
            distance=distance_difference(finer, run.totals.distance),
            slip=slip_difference(plant.vehicle, run, finer),
            refinement=1,
            sensitive=spread > 0.0,
            spread=spread,
        ),
    )
