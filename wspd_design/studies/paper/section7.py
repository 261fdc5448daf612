"""The stops of Section 7 on one model of the locomotive, and which conclusions of the paper hold there."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run
from wspd_design.studies.paper.ablation import IDEAL_FILL_TIME, IDEAL_SAMPLE_TIME, ablation
from wspd_design.studies.paper.conclusions import conclusions
from wspd_design.studies.paper.conclusions.records import Conclusion
from wspd_design.studies.paper.evidence import (
    CONSTANT_RAILS,
    CONTROLLERS,
    RAILS,
    UNPROTECTED,
    Ablation,
    Evidence,
    StopFigures,
    Yardstick,
)
from wspd_design.studies.paper.published import PublishedStops
from wspd_design.studies.paper.slip_history import slip_history
from wspd_design.studies.paper.table10 import Table10Row, table10_rows


@dataclass(frozen=True, slots=True, kw_only=True)
class Section7:
    """All stops of Section 7 on one model, beside those of the paper."""

    plant: str
    vehicle: Vehicle
    specification: Specification
    trials: dict[tuple[str, str], Trial]  # by controller and rail
    table10: tuple[Table10Row, ...]
    evidence: Evidence
    conclusions: tuple[Conclusion, ...]


def scenarios(published: PublishedStops) -> dict[str, Scenario]:
    """Return the stop on each rail."""
    speed = published.initial_speed_kmh / 3.6
    return {name: Scenario(rail=load_rail(name), initial_speed=speed) for name in RAILS}


def section7(
    vehicle: Vehicle,
    specification: Specification,
    published: PublishedStops,
    stops: Mapping[str, Scenario],
    *,
    progress: Callable[[str], object],
) -> Section7:
    """Simulate the stops of Section 7 on the small model and judge the paper by them.

    Parameters
    ----------
    vehicle : Vehicle
        The locomotive.
    specification : Specification
        What is asked of the laws.
    published : PublishedStops
        Table 10.
    stops : mapping of str to Scenario
        By rail.
    progress : callable
        Told each stop before it starts.
    """
    trials: dict[tuple[str, str], Trial] = {}
    for name, rail in laws_and_rails():
        progress(f"{name} on {rail}")
        law = controller(name, vehicle, stops[rail].rail, specification)
        trials[name, rail] = trial(vehicle, law, stops[rail], slip_reference=specification.slip)
    ablations = []
    for rail, scenario in stops.items():
        progress(f"parts of the adaptive fuzzy law on {rail}")
        ablations.append(parts(vehicle, specification, scenario))
    return judged(
        vehicle, specification, published, stops, plant=DEFAULT_PLANT, trials=trials, ablations=ablations
    )


def laws_and_rails() -> tuple[tuple[str, str], ...]:
    """Return controller and rail of each stop."""
    return tuple((name, rail) for rail in RAILS for name in (*CONTROLLERS, UNPROTECTED))


def parts(
    vehicle: Vehicle, specification: Specification, scenario: Scenario, *, plant: str = DEFAULT_PLANT
) -> Ablation:
    """Take the adaptive fuzzy law of the paper apart on one rail."""
    law = cast(AdaptiveFuzzy, controller("afsmc", vehicle, scenario.rail, specification))
    return ablation(vehicle, law, scenario, plant=plant)


def judged(
    vehicle: Vehicle,
    specification: Specification,
    published: PublishedStops,
    stops: Mapping[str, Scenario],
    *,
    plant: str,
    trials: dict[tuple[str, str], Trial],
    ablations: Sequence[Ablation],
) -> Section7:
    """Judge the paper by stops that were simulated; the idealized stops beside them are those of the small model."""
    evidence = Evidence(
        initial_speed=published.initial_speed_kmh / 3.6,
        slip_reference=specification.slip,
        slip_tolerance=specification.slip_tolerance,
        published=published,
        stops=tuple(_figures(done, vehicle, specification) for done in trials.values()),
        ablations=tuple(ablations),
        yardsticks=tuple(_yardstick(vehicle, each, specification) for each in stops.values()),
        ideal_fill_time=IDEAL_FILL_TIME,
        ideal_sample_time=IDEAL_SAMPLE_TIME,
        fill_time=vehicle.brake.fill_time,
        mean_loads=_mean_loads(trials["afsmc", CONSTANT_RAILS[1]].run),
    )
    return Section7(
        plant=plant,
        vehicle=vehicle,
        specification=specification,
        trials=trials,
        table10=table10_rows(published.stops, trials, vehicle),
        evidence=evidence,
        conclusions=conclusions(evidence),
    )


def _figures(done: Trial, vehicle: Vehicle, specification: Specification) -> StopFigures:
    history = slip_history(done.run, slip_reference=specification.slip, max_torque=vehicle.brake.max_torque)
    return StopFigures(
        controller=done.run.controller,
        rail=done.run.rail,
        metrics=done.metrics,
        check=done.check,
        history=history,
    )


def _yardstick(vehicle: Vehicle, scenario: Scenario, specification: Specification) -> Yardstick:
    peak = ideal_stop(vehicle, scenario)
    return Yardstick(
        rail=scenario.rail.name,
        ideal_stop=peak.distance,
        ideal_time=peak.stopping_time,
        ideal_at_once=ideal_stop(vehicle, scenario, instantaneous=True).distance,
        constant_slip=ideal_stop(vehicle, scenario, slip=specification.slip).distance,
    )


def _mean_loads(run: Run) -> tuple[float, ...]:
    """Mean vertical force on each wheelset over a stop, front first [N]."""
    import numpy as np

    means = 2.0 * np.trapezoid(run.wheel_load, run.time, axis=0) / (run.time[-1] - run.time[0])
    return tuple(means.tolist())
