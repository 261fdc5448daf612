"""Section 7 of the paper, computed again: Table 10, Figures 3 and 9 to 21, Table 9, and what they show."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.model import adhesion
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.loading import load_rail, load_track_spectrum, load_vehicle
from wspd_design.parameters.records import Rail, TrackSpectrum, Vehicle
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import Run, Scenario
from wspd_design.simulation.track import irregular_load, standard_deviation, synthesize
from wspd_design.studies.paper.ablation import IDEAL_FILL_TIME, IDEAL_SAMPLE_TIME, ablation
from wspd_design.studies.paper.conclusions import conclusions
from wspd_design.studies.paper.conclusions.records import Conclusion
from wspd_design.studies.paper.disturbances import (
    CHANNELS,
    LOAD_SPREAD,
    Disturbance,
    TrackChannel,
    disturbance,
    ideal_change,
    track_channel,
)
from wspd_design.studies.paper.evidence import (
    CONSTANT_RAILS,
    CONTROLLERS,
    RAILS,
    UNPROTECTED,
    Evidence,
    StopFigures,
    Yardstick,
)
from wspd_design.studies.paper.published import load_table10
from wspd_design.studies.paper.slip_history import slip_history
from wspd_design.studies.paper.table10 import Table10Row, table10_rows
from wspd_design.studies.provenance import Provenance, provenance

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FRICTION_SPEEDS = (120.0, 60.0, 20.0)  # km/h, of Figure 3
FRICTION_SLIPS = 201


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionCurve:
    """Friction force of one wheel over slip under the static load: a curve of Figure 3."""

    rail: str
    speed: float  # m/s
    slip: "Array"
    force: "Array"  # N


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduction:
    """Everything that the page about the paper shows."""

    vehicle: Vehicle
    specification: Specification
    trials: dict[tuple[str, str], Trial]  # by controller and rail
    table10: tuple[Table10Row, ...]
    evidence: Evidence
    conclusions: tuple[Conclusion, ...]
    friction: tuple[FrictionCurve, ...]
    spectra: TrackSpectrum
    track: tuple[TrackChannel, ...]
    disturbances: tuple[Disturbance, ...]
    ideal_changes: tuple[float, ...]  # m, of the ideal stop by the track, for each rail
    provenance: Provenance


def reproduce(progress: Callable[[str], object], *, command: str, seed: int = 1) -> Reproduction:
    """Compute Section 7 of the paper again.

    Parameters
    ----------
    progress : callable
        Told each stage before it starts.
    seed : int
        Of the synthesized track.
    command : str
        The command line, for the record.
    """
    vehicle, specification, published = load_vehicle("er24pc"), Specification(), load_table10()
    speed = published.initial_speed_kmh / 3.6
    scenarios = {name: Scenario(rail=load_rail(name), initial_speed=speed) for name in RAILS}
    trials: dict[tuple[str, str], Trial] = {}
    for rail, scenario in scenarios.items():
        for name in (*CONTROLLERS, UNPROTECTED):
            progress(f"{name} on {rail}")
            law = controller(name, vehicle, scenario.rail, specification)
            trials[name, rail] = trial(vehicle, law, scenario, slip_reference=specification.slip)
    ablations = []
    for rail, scenario in scenarios.items():
        progress(f"parts of the adaptive fuzzy law on {rail}")
        law = cast(AdaptiveFuzzy, controller("afsmc", vehicle, scenario.rail, specification))
        ablations.append(ablation(vehicle, law, scenario))
    progress("track irregularities")
    spectra = load_track_spectrum("erri-b176")
    sigma = standard_deviation(spectra, "vertical-high")
    load = irregular_load(
        vehicle, synthesize(spectra, ("vertical-high",), seed=seed), sigma=sigma, spread=LOAD_SPREAD
    )
    disturbances = [
        disturbance(
            vehicle,
            controller(name, vehicle, scenarios[rail].rail, specification),
            done,
            scenarios[rail],
            load,
        )
        for (name, rail), done in trials.items()
        if name in CONTROLLERS
    ]
    evidence = Evidence(
        initial_speed=speed,
        slip_reference=specification.slip,
        slip_tolerance=specification.slip_tolerance,
        published=published,
        stops=tuple(_figures(done, vehicle, specification) for done in trials.values()),
        ablations=tuple(ablations),
        yardsticks=tuple(_yardstick(vehicle, each, specification) for each in scenarios.values()),
        ideal_fill_time=IDEAL_FILL_TIME,
        ideal_sample_time=IDEAL_SAMPLE_TIME,
        fill_time=vehicle.brake.fill_time,
        load_range=_load_range(trials["afsmc", CONSTANT_RAILS[1]].run),
    )
    return Reproduction(
        vehicle=vehicle,
        specification=specification,
        trials=trials,
        table10=table10_rows(published.stops, trials, vehicle),
        evidence=evidence,
        conclusions=conclusions(evidence),
        friction=tuple(
            _friction(vehicle, each.rail, v) for each in scenarios.values() for v in FRICTION_SPEEDS
        ),
        spectra=spectra,
        track=tuple(track_channel(spectra, channel, seed=seed) for channel in CHANNELS),
        disturbances=tuple(disturbances),
        ideal_changes=tuple(ideal_change(vehicle, each, load) for each in scenarios.values()),
        provenance=provenance(command=command, seed=seed),
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


def _load_range(run: Run) -> tuple[float, float]:
    """Mean vertical force of the lightest and of the heaviest wheelset over a stop [N]."""
    import numpy as np

    means = 2.0 * np.trapezoid(run.wheel_load, run.time, axis=0) / (run.time[-1] - run.time[0])
    return float(means.min()), float(means.max())


def _friction(vehicle: Vehicle, rail: Rail, speed_kmh: float) -> FrictionCurve:
    import numpy as np

    speed, load = speed_kmh / 3.6, float(static_wheel_load(vehicle))
    slip = np.linspace(0.0, 1.0, FRICTION_SLIPS) ** 2  # close together where the curve rises
    stiffness = adhesion.contact_stiffness(vehicle.contact, load)
    force = adhesion.creep_force(slip, speed * slip, load, rail, stiffness)
    return FrictionCurve(rail=rail.name, speed=speed, slip=slip, force=force)
