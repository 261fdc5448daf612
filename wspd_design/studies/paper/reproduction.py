"""Section 7 of the paper, computed again: Table 10, Figures 3 and 9 to 21, Table 9, and what they show."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.model import adhesion
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.loading import load_track_spectrum, load_vehicle
from wspd_design.parameters.records import Rail, TrackSpectrum, Vehicle
from wspd_design.simulation.track import irregular_load, standard_deviation, synthesize
from wspd_design.studies.paper.disturbances import (
    CHANNELS,
    LOAD_SPREAD,
    Disturbance,
    TrackChannel,
    disturbance,
    ideal_change,
    track_channel,
)
from wspd_design.studies.paper.evidence import CONTROLLERS
from wspd_design.studies.paper.locomotive import OnLocomotive, on_locomotive
from wspd_design.studies.paper.published import load_table10
from wspd_design.studies.paper.section7 import Section7, scenarios, section7
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

    small: Section7  # four axles with weight transfer
    locomotive: OnLocomotive | None  # the multibody model; None where it was left out
    friction: tuple[FrictionCurve, ...]
    spectra: TrackSpectrum
    track: tuple[TrackChannel, ...]
    disturbances: tuple[Disturbance, ...]
    ideal_changes: tuple[float, ...]  # m, of the ideal stop by the track, for each rail
    provenance: Provenance


def reproduce(
    progress: Callable[[str], object], *, command: str, seed: int = 1, locomotive: bool = True
) -> Reproduction:
    """Compute Section 7 of the paper again.

    Parameters
    ----------
    progress : callable
        Told each stage before it starts.
    seed : int
        Of the synthesized track.
    command : str
        The command line, for the record.
    locomotive : bool
        Whether to simulate the stops on the multibody model, too, which takes most of the time.
    """
    vehicle, specification, published = load_vehicle("er24pc"), Specification(), load_table10()
    stops = scenarios(published)
    small = section7(vehicle, specification, published, stops, progress=progress)
    progress("track irregularities")
    spectra = load_track_spectrum("erri-b176")
    sigma = standard_deviation(spectra, "vertical-high")
    load = irregular_load(
        vehicle, synthesize(spectra, ("vertical-high",), seed=seed), sigma=sigma, spread=LOAD_SPREAD
    )
    disturbances = [
        disturbance(
            vehicle,
            controller(name, vehicle, stops[rail].rail, specification),
            done,
            stops[rail],
            load,
        )
        for (name, rail), done in small.trials.items()
        if name in CONTROLLERS
    ]
    return Reproduction(
        small=small,
        locomotive=on_locomotive(small, published, stops, seed=seed, progress=progress)
        if locomotive
        else None,
        friction=tuple(_friction(vehicle, each.rail, v) for each in stops.values() for v in FRICTION_SPEEDS),
        spectra=spectra,
        track=tuple(track_channel(spectra, channel, seed=seed) for channel in CHANNELS),
        disturbances=tuple(disturbances),
        ideal_changes=tuple(ideal_change(vehicle, each, load) for each in stops.values()),
        provenance=provenance(command=command, seed=seed),
    )


def _friction(vehicle: Vehicle, rail: Rail, speed_kmh: float) -> FrictionCurve:
    import numpy as np

    speed, load = speed_kmh / 3.6, float(static_wheel_load(vehicle))
    slip = np.linspace(0.0, 1.0, FRICTION_SLIPS) ** 2  # close together where the curve rises
    stiffness = adhesion.contact_stiffness(vehicle.contact, load)
    force = adhesion.creep_force(slip, speed * slip, load, rail, stiffness)
    return FrictionCurve(rail=rail.name, speed=speed, slip=slip, force=force)
