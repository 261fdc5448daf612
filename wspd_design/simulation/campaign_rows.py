"""Rows of a campaign: what is computed for each stop, from its index alone.

Stops run in groups of sixteen whose members depend on their indices alone, and a part of a group is computed as the
whole one: a row is the same bit by bit however a campaign is divided among workers.
"""

import hashlib
import math
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import TYPE_CHECKING, Any

from wspd_design.codegen.sampled import places_told
from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import Law
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.fingerprint import fingerprint
from wspd_design.parameters.records import Brake, Vehicle
from wspd_design.plants.names import plant_of
from wspd_design.plants.protocol import is_coupled
from wspd_design.simulation.batch import STOPS_SIDE_BY_SIDE, Batch, Cases, run_batch
from wspd_design.simulation.draws import Deck, Draw
from wspd_design.simulation.ideal import FILLING, ideal_input
from wspd_design.simulation.loop_input import first_slip, loop_input
from wspd_design.simulation.metrics import air_used, lowest_reservoir
from wspd_design.simulation.records import Scenario, Sensing, Start
from wspd_design.simulation.self_check import distance_difference, slip_difference
from wspd_design.simulation.stop import simulate_on

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FIGURES = (
    "distance_m",
    "stopping_time_s",
    "torque_integral_Nms",
    "efficiency",
    "slip_mean",
    "slip_max",
    "slip_rms",
    "lock_time_s",
    "valve_switches_per_s",
    "vented_air",
)
"""Of each stop, beside those of its axles."""
AIR_FIGURES = ("air_used_Nl", "lowest_reservoir_Pa")
"""Of each stop of a vehicle whose cylinders and reservoir have a volume."""
TOLD_FIGURES = ("speed_error", "distance_error", "slip_band")
"""Of each stop of a law that tells the train speed which it goes by, and the slips that it holds."""
AXLE_FIGURES = ("longest_lock_s", "total_lock_s", "sliding_work_J")
"""Of each axle, front axle first; locks count above 10 km/h, to one integration step."""
CHECKED = ("step_distance_change", "step_slip_change")
"""What half the integration steps change, NaN in the rows that are not checked."""
_ROOMS = ("parameters", "model", "plants", "controllers", "codegen", "simulation")
_KEY_FORMAT = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """All that the rows of a campaign depend on, beside their index."""

    vehicle: Vehicle
    controller: Law
    scenario: Scenario
    plant: str
    draws: tuple[Draw, ...]
    check_every: int
    program: str  # fingerprint of the program that shall compute the rows


def make_plan(
    vehicle: Vehicle,
    controller: Law,
    scenario: Scenario,
    *,
    plant: str,
    draws: tuple[Draw, ...],
    check_every: int,
) -> Plan:
    """Check what a campaign is to be, before anything is computed."""
    if check_every < 0:
        raise UserError(f"check_every = {check_every} must be 1 or more, or 0 for no step checks")
    deck = Deck(plant_of(plant, vehicle), scenario, draws)
    for case in deck.extremes():
        loop_input([case], controller)
    return Plan(
        vehicle=vehicle,
        controller=controller,
        scenario=scenario,
        plant=plant,
        draws=draws,
        check_every=check_every,
        program=program_fingerprint(),
    )


def plan_key(plan: Plan) -> str:
    """Return the content key of a campaign: the same for the same rows."""
    plant = plant_of(plan.plant, plan.vehicle)
    return fingerprint(_KEY_FORMAT, plan, *((plant.model,) if is_coupled(plant) else ()))


@cache
def program_fingerprint() -> str:
    """Return the SHA-256 of all sources of this package that the numbers of a row come from."""
    digest = hashlib.sha256()
    for room in _ROOMS:
        for name, content in sorted(_sources(files("wspd_design").joinpath(room), room)):
            digest.update(f"{name} {len(content)}\n".encode() + content)
    digest.update(files("wspd_design").joinpath("data", "constants.toml").read_bytes())
    return digest.hexdigest()


def _sources(folder: Traversable, name: str) -> list[tuple[str, bytes]]:
    found = []
    for each in folder.iterdir():
        path = f"{name}/{each.name}"
        if each.is_dir():
            found += _sources(each, path)
        elif each.name.endswith((".py", ".c", ".h")):
            found.append((path, each.read_bytes()))
    return found


def columns(plan: Plan) -> list[tuple[str, str]]:
    """Names and types of the columns."""
    plant = plant_of(plan.plant, plan.vehicle)
    axles = 1 if plant.alike else plant.axles
    numbers = [draw.name for draw in plan.draws]
    numbers += [
        *FIGURES,
        *_brake_figures(plan.vehicle.brake),
        *_told_figures(plan.controller),
        *(f"{name}_{axle + 1}" for name in AXLE_FIGURES for axle in range(axles)),
        *CHECKED,
    ]
    return [("run", "i8"), ("seed", "i8"), *((name, "f8") for name in numbers), ("stopped", "?")]


def _brake_figures(brake: Brake) -> list[str]:
    """Figures that only some brakes have."""
    known = (brake.cylinder_volume, brake.reservoir_volume, brake.longest_release)
    return [name for name, number in zip((*AIR_FIGURES, "watchdog_fills"), known, strict=True) if number]


def _told_figures(controller: Law) -> tuple[str, ...]:
    """Figures that only some laws have."""
    speed, reference = places_told(controller)
    return (*TOLD_FIGURES[: 2 * (speed >= 0)], *TOLD_FIGURES[2 : 2 + (reference >= 0)])


def compute_rows(plan: Plan, first: int, count: int) -> "NDArray[Any]":
    """Simulate stops ``first`` to ``first + count - 1``; runs in any process that has the same program."""
    import numpy as np

    if program_fingerprint() != plan.program:
        raise UserError(
            "a worker has another version of wspd_design than the campaign; install the same one on all machines"
        )
    deck = Deck(plant_of(plan.plant, plan.vehicle), plan.scenario, plan.draws)
    whole = first // STOPS_SIDE_BY_SIDE * STOPS_SIDE_BY_SIDE
    groups = range(whole, first + count, STOPS_SIDE_BY_SIDE)
    made = len(groups) * STOPS_SIDE_BY_SIDE
    table = np.zeros(made, dtype=columns(plan))
    table["run"] = np.arange(whole, whole + made)
    table["seed"] = plan.scenario.seed + table["run"]
    for draw, values in zip(plan.draws, deck.values(whole, made).T, strict=True):
        table[draw.name] = values
    cases = deck.cases(whole, made)
    for group in groups:
        rows = slice(group - whole, group - whole + STOPS_SIDE_BY_SIDE)
        runs = f"runs {group} to {group + STOPS_SIDE_BY_SIDE - 1}"
        ideal = ideal_distances(cases[rows], runs)
        for name, figures in figures_of(cases[rows], plan.controller, ideal, runs).items():
            table[name][rows] = figures
    kept = table[first - whole : first - whole + count]
    for row, case in zip(kept, cases[first - whole :], strict=False):
        row["step_distance_change"], row["step_slip_change"] = _step_check(plan, row, case)
    return kept


def figures_of(cases: Cases, controller: Law, ideal: "Array", runs: str) -> dict[str, Any]:
    """Simulate a group of stops and return its figures, one array over the stops for each.

    Parameters
    ----------
    cases : sequence of (Plant, Scenario)
        The stops.
    controller : Law
        Law of every wheelset.
    ideal : array
        Distances of their ideal stops [m].
    runs : str
        Names the stops in the sentence about a bad command.
    """
    import numpy as np

    batch = run_batch(cases, controller, lambda some: loop_input(some, controller), what=runs)
    lanes, stops = batch.lanes, batch.stops
    judged = np.where(stops["judged_time"] > 0.0, stops["judged_time"], np.nan)
    leading = cases[0][0].vehicle  # of all of them the same axles have a brake
    braked, valved = np.array(leading.braked), np.array(leading.brake_shares) > 0.0
    mean, square = (lanes[name][braked].mean(axis=0) / judged for name in ("slip", "slip_squared"))
    reference = slip_reference_of(controller)
    about = math.nan if reference is None else reference
    full = np.array([plant.vehicle.brake.max_pressure * valved.sum() for plant, _ in cases])
    axles = 1 if cases[0][0].alike else cases[0][0].axles
    by_axle = (lanes[name] for name in ("longest_lock", "judged_lock_time", "sliding_work"))
    band = lanes["slip_band"].max(axis=0)
    told = {
        **{name: stops[name] for name in TOLD_FIGURES[:2]},
        "slip_band": np.where(band >= 0.0, band, np.nan),  # of those that never reached their reference
    }
    moved = np.where(stops["distance"] > 0.0, stops["distance"], np.nan)  # not of a train that is at rest
    lasted = np.where(stops["time"] > 0.0, stops["time"], np.nan)
    return {
        "distance_m": stops["distance"],
        "stopping_time_s": stops["time"],
        "torque_integral_Nms": lanes["torque"].sum(axis=0),
        "efficiency": np.where(batch.stopped, ideal / moved, np.nan),
        "slip_mean": mean,
        "slip_max": np.maximum(
            lanes["slip_max"].max(axis=0), [first_slip(scenario) for _, scenario in cases]
        ),
        "slip_rms": np.sqrt(np.maximum(square - 2.0 * about * mean + about**2, 0.0)),
        "lock_time_s": lanes["lock_time"].max(axis=0),
        "valve_switches_per_s": lanes["valve_switches"][valved].mean(axis=0) / lasted,
        "vented_air": lanes["vented_pressure"][valved].sum(axis=0) / full,
        **_of_brakes(
            cases, lanes["filled_pressure"][valved].sum(axis=0), lanes["watchdog"][valved].sum(axis=0)
        ),
        **{name: told[name] for name in _told_figures(controller)},
        **{
            f"{name}_{axle + 1}": values[axle]
            for name, values in zip(AXLE_FIGURES, by_axle, strict=True)
            for axle in range(axles)
        },
        "stopped": batch.stopped,
    }


def _of_brakes(cases: Cases, filled: "Array", watchdog: "Array") -> dict[str, Any]:
    """Columns of air and watchdogs, as far as the vehicle has them."""
    brakes = [plant.vehicle.brake for plant, _ in cases]
    columns = {
        AIR_FIGURES[0]: [air_used(brake, each) for brake, each in zip(brakes, filled, strict=True)],
        AIR_FIGURES[1]: [lowest_reservoir(brake, each) for brake, each in zip(brakes, filled, strict=True)],
        "watchdog_fills": watchdog,
    }
    return {name: columns[name] for name in _brake_figures(brakes[0])}


def ideal_distances(cases: Cases, runs: str) -> "Array":
    """Return the distances of the ideal stops [m], NaN where there is none; what a law measures does not count."""
    import numpy as np

    unknown = (each.patches or each.start != Start() or is_coupled(plant) for plant, each in cases)
    if any(unknown):
        return np.full(len(cases), np.nan)
    unseeing = [(plant, _unseeing(scenario)) for plant, scenario in cases]
    alike = all(case == unseeing[0] for case in unseeing)
    batch: Batch = run_batch(unseeing[:1] if alike else unseeing, FILLING, ideal_input, what=runs)
    found = np.where(batch.stopped, batch.stops["distance"], np.nan)
    return np.broadcast_to(found, len(cases)) if alike else found


def _unseeing(scenario: Scenario) -> Scenario:
    of_valves = Sensing(dead_time=scenario.sensing.dead_time, shortest_pulse=scenario.sensing.shortest_pulse)
    return replace(scenario, seed=0, sensing=of_valves)


def _step_check(plan: Plan, row: Any, case: tuple[Any, Scenario]) -> tuple[float, float]:
    """Change of the distance of a row, relative, and of the slip at its samples, with half the steps."""
    if plan.check_every == 0 or row["run"] % plan.check_every:
        return math.nan, math.nan
    plant, scenario = case
    run, finer = (simulate_on(plant, plan.controller, scenario, refinement=parts) for parts in (1, 2))
    changes = (
        distance_difference(finer, float(row["distance_m"])),
        slip_difference(plant.vehicle, run, finer),
    )
    distance, slip = (math.inf if math.isnan(change) else change for change in changes)  # NaN is not checked
    return distance, slip
