"""Calibration on Table 10: the numbers that the printed stops determine, and a search whose fixed point they are.

Fitted is the root mean square of the relative deviations of distance, stopping time and torque integral from Table 10:
over all 24 for the inertia of a wheelset, over the twelve of a rail for its friction, over the six of a controller for
a number of its own. The plant is the four-axle locomotive from 120 km/h, sampled every 100 ms. The optimizer is a
coordinate search in steps of 2 %: one number after the other goes to its better neighbour until no neighbour of any is
better.

The step is what the table resolves: it prints times to tenths of a second, from which the plateau of the deceleration
follows within 1.2 %; and below it the laws that switch make the deviations jump instead of falling smoothly. The other
numbers of the set either have a better neighbour (the pulses of Trenitalia, the duty gain of Mitsubishi) or hardly
change the stops (resistance, heights, pitching): they are not calibrated but assumed, and their data files say so.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_mitsubishi, load_rail, load_vehicle
from wspd_design.parameters.records import MitsubishiTable, Rail, Vehicle
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate
from wspd_design.studies.paper.published import PublishedStop, load_table10

STEP = 1.02
"""Factor from a number to its neighbours."""
MOST_PASSES = 50


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Everything a stop of Table 10 is simulated with, as far as it is fitted."""

    vehicle: Vehicle
    rails: Mapping[str, Rail]
    mitsubishi: MitsubishiTable


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted:
    """A number that is fitted: where its data file has it, and which printed stops it is fitted to."""

    file: str
    entry: str
    read: Callable[[Case], float]
    write: Callable[[Case, float], Case]
    fits: Callable[[PublishedStop], bool]


def shipped() -> Case:
    """Return the case of the data files."""
    return Case(
        vehicle=load_vehicle("er24pc"),
        rails={name: load_rail(name) for name in ("table10-dry", "table10-wet")},
        mitsubishi=load_mitsubishi("calibrated"),
    )


def _friction(rail: str) -> Fitted:
    return Fitted(
        file=rail,
        entry="mu0",
        read=lambda case: case.rails[rail].mu0,
        write=lambda case, value: replace(
            case, rails={**case.rails, rail: replace(case.rails[rail], mu0=value)}
        ),
        fits=lambda stop: stop.rail == rail,
    )


FITTED: tuple[Fitted, ...] = (
    Fitted(
        file="er24pc",
        entry="wheelset_inertia",
        read=lambda case: case.vehicle.wheelset_inertia,
        write=lambda case, value: replace(case, vehicle=replace(case.vehicle, wheelset_inertia=value)),
        fits=lambda _: True,
    ),
    _friction("table10-dry"),
    _friction("table10-wet"),
    Fitted(
        file="mitsubishi",
        entry="calibrated.duty_offset",
        read=lambda case: case.mitsubishi.duty_offset,
        write=lambda case, value: replace(case, mitsubishi=replace(case.mitsubishi, duty_offset=value)),
        fits=lambda stop: stop.controller == "mitsubishi",
    ),
)


def objective(case: Case, number: Fitted) -> float:
    """Root mean square of the relative deviations from the printed stops that a number is fitted to [-]."""
    printed = load_table10()
    found = [
        each
        for stop in printed.stops
        if number.fits(stop)
        for each in _deviations(case, stop, printed.initial_speed_kmh)
    ]
    return math.sqrt(sum(each * each for each in found) / len(found))


def _deviations(case: Case, stop: PublishedStop, speed_kmh: float) -> tuple[float, float, float]:
    rail = case.rails[stop.rail]
    law: Any = controller(stop.controller, case.vehicle, rail, Specification())
    if stop.controller == "mitsubishi":
        law = replace(law, table=case.mitsubishi)
    run = simulate(case.vehicle, law, Scenario.stop(from_kmh=speed_kmh, rail=rail))
    return (
        run.totals.distance / stop.distance_m - 1.0,
        float(run.time[-1]) / stop.stopping_time_s - 1.0,
        run.totals.torque / (1e3 * stop.torque_integral_kNms) - 1.0,
    )


def better_neighbour(case: Case, number: Fitted) -> Case | None:
    """Return the better of the two neighbours of a number, or None where neither improves the objective."""
    value = number.read(case)
    neighbours = (number.write(case, value * factor) for factor in (1.0 / STEP, STEP))
    told = [(objective(each, number), each) for each in neighbours]
    least, best = min(told, key=lambda each: each[0])
    return best if least < objective(case, number) else None


def calibrate(case: Case, numbers: Sequence[Fitted] = FITTED) -> Case:
    """Search by coordinates until no number has a better neighbour.

    Parameters
    ----------
    case : Case
        Where the search starts.
    numbers : sequence of Fitted
        Numbers that are fitted, in the order of the search.

    Returns
    -------
    Case
        A fixed point of the search.

    Raises
    ------
    RuntimeError
        If the search does not end within ``MOST_PASSES`` passes through the numbers.
    """
    for _ in range(MOST_PASSES):
        moved = False
        for number in numbers:
            found = better_neighbour(case, number)
            case, moved = (case, moved) if found is None else (found, True)
        if not moved:
            return case
    raise RuntimeError(f"the calibration still moves after {MOST_PASSES} passes")
