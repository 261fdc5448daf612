"""The ladder of models: the same stop on ever larger models of a vehicle, and which of them suffices for what."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import Law
from wspd_design.parameters.gear import gear_of, wrong_counts
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.locomotive import Locomotive
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.names import plant_of
from wspd_design.plants.planar import Planar
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Irregularities, Scenario
from wspd_design.simulation.self_check import distance_difference, perturbed_spread
from wspd_design.simulation.stop import simulate
from wspd_design.studies.inferred import mark
from wspd_design.studies.rung import AxleFigures, Rung, axle_figures


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """A model of the vehicle, and the track that it stops on."""

    title: str
    plant: str
    irregularities: Irregularities | None = None  # of the track; None: those of the stop


@dataclass(frozen=True, slots=True, kw_only=True)
class Measure:
    """What is compared over the rungs, and from which deviation on a model does not suffice for it."""

    name: str
    tolerance: float
    deviation: Callable[[Rung, Rung], float]  # of a rung from the largest one
    unit: str = ""  # of both; empty for a plain number
    share: bool = False  # told in percent of what ``unit`` says


def _worst(read: Callable[[AxleFigures], float]) -> Callable[[Rung, Rung], float]:
    """Largest deviation over the wheelsets."""

    def deviation(rung: Rung, top: Rung) -> float:
        return max(abs(read(a) - read(b)) for a, b in zip(rung.axles, top.axles, strict=True))

    return deviation


NEIGHBOURS = 2
"""Stops from slightly different speeds, where the first is not near: a larger model takes its time."""

MEASURES = (
    Measure(
        name="distance",
        tolerance=0.01,
        share=True,
        deviation=lambda rung, top: abs(rung.metrics.distance / top.metrics.distance - 1.0),
    ),
    Measure(
        name="time",
        tolerance=0.01,
        share=True,
        deviation=lambda rung, top: abs(rung.metrics.stopping_time / top.metrics.stopping_time - 1.0),
    ),
    Measure(
        name="mean slip",
        tolerance=0.01,
        deviation=_worst(lambda axle: axle.slip_mean),
    ),
    Measure(
        name="largest slip",
        tolerance=0.05,
        deviation=_worst(lambda axle: axle.slip_max),
    ),
    Measure(
        name="longest lock",
        unit="s",
        tolerance=0.05,
        deviation=_worst(lambda axle: axle.lock),
    ),
    Measure(
        name="load transfer",
        unit="of static load",
        tolerance=0.02,
        share=True,
        deviation=_worst(lambda axle: axle.transfer),
    ),
    Measure(
        name="load spread",
        unit="of static load",
        tolerance=0.01,
        share=True,
        deviation=_worst(lambda axle: axle.relative_spread),
    ),
    Measure(
        name="rim vibration",
        unit="m/s",
        tolerance=0.05,
        deviation=_worst(lambda axle: axle.vibration),
    ),
)
"""In the order of tables."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """How far each rung is from the highest one in one measure."""

    measure: Measure
    deviations: tuple[float, ...]  # of each rung, 0 of the highest; NaN where a stop has no such figure

    @property
    def suffices(self) -> int:
        """Number of the lowest rung from which on all are within the tolerance."""
        near = [each <= self.measure.tolerance for each in self.deviations]
        return next(rung for rung in range(len(near)) if all(near[rung:]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Ladder:
    """The same stop on ever larger models; what is said holds for this vehicle, law, rail and speed."""

    vehicle: str
    controller: str
    rail: str
    initial_speed: float  # m/s
    rungs: tuple[Rung, ...]  # the smallest model first
    remark: str = ""  # what is inferred about the models; empty where nothing is

    @property
    def spread(self) -> float:
        """Largest spread of the distance of a sensitive loop [m]: smaller differences between models say nothing."""
        return max(each.spread for each in self.rungs)

    @property
    def agreements(self) -> tuple[Agreement, ...]:
        """One for each measure."""
        *lower, top = self.rungs
        return tuple(
            Agreement(measure=each, deviations=(*(each.deviation(rung, top) for rung in lower), 0.0))
            for each in MEASURES
        )


def models_of(vehicle: Vehicle) -> tuple[Model, ...]:
    """Return the models that a vehicle has, the smallest first; the largest stops on irregular track as well."""
    found = [Model(title=Quarter.name, plant=Quarter.name)]
    if not wrong_counts(vehicle) and gear_of(vehicle).supports > 1:
        found.append(Model(title=Planar.name, plant=Planar.name))
    if vehicle.multibody:
        found += [
            Model(title=Locomotive.name, plant=Locomotive.name),
            Model(title="irregular track", plant=Locomotive.name, irregularities="high"),
        ]
    return tuple(found)


def ladder(
    vehicle: Vehicle,
    law: Law,
    scenario: Scenario,
    *,
    slip_reference: float,
    models: Sequence[Model],
    progress: Callable[[str], object] = str,
) -> Ladder:
    """Simulate the same stop on several models.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, from whose numbers every model is made.
    law : Law
        As it was designed; it is the same on every model.
    scenario : Scenario
        The stop; its seed is that of an irregular track.
    slip_reference : float
        Reference of the slip for a law that holds none of its own [-].
    models : sequence of Model
        The smallest first.
    progress : callable, optional
        Told each model before its stops.
    """
    held = slip_reference_of(law)
    reference = slip_reference if held is None else held
    rungs = []
    for model in models:
        progress(model.title)
        rungs.append(rung(vehicle, law, scenario, model, slip_reference=reference))
    multibody = [model for model in models if model.plant == Locomotive.name]
    return Ladder(
        vehicle=vehicle.name,
        controller=law.name,
        rail=scenario.rail.name,
        initial_speed=scenario.initial_speed,
        rungs=tuple(rungs),
        remark=mark(load_multibody(vehicle.multibody)) if multibody else "",
    )


def rung(vehicle: Vehicle, law: Law, scenario: Scenario, model: Model, *, slip_reference: float) -> Rung:
    """Simulate a stop on one model, again with half the steps, and from slightly different speeds."""
    stop = replace(scenario, irregularities=model.irregularities) if model.irregularities else scenario
    run = simulate(vehicle, law, stop, plant=model.plant)
    finer = simulate(vehicle, law, stop, plant=model.plant, refinement=2)
    judged = metrics(run, vehicle, stop, slip_reference=slip_reference)
    return Rung(
        title=model.title,
        plant=model.plant,
        run=run,
        metrics=judged,
        axles=axle_figures(
            run, wheelsets=vehicle.wheelsets, wheel_radius=vehicle.wheel_radius, build_up=judged.build_up
        ),
        step_change=distance_difference(finer, run.totals.distance),
        spread=perturbed_spread(plant_of(model.plant, vehicle), law, stop, run, neighbours=NEIGHBOURS),
    )
