"""The same design under other conditions, one at a time: rails, speeds, loads, worn wheels, sensors, dead time."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias

from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.description import disturbances_of
from wspd_design.simulation.records import Scenario

Case: TypeAlias = tuple[Plant, Scenario]

OTHER_RAIL = "low-adhesion"
"""Below the front wheelset alone."""
SPEED_SHARES = (1.0 / 3.0, 2.0 / 3.0)  # of the initial speed
SENSOR_ERRORS: tuple[Mapping[str, float], ...] = (
    {"speed_noise": 0.05},
    {"pulses_per_turn": 80},
    {"reference_error": 0.02},
    {"reference_error": -0.02},
    {"reference_noise": 0.1},
    {"torque_error": 0.1},
    {"torque_error": -0.1},
    {"accelerometer_bias": 0.05},
    {"accelerometer_bias": -0.05},
)
"""Sizes that we chose to look at; no measured one is known here."""
RADIUS_ERROR = 0.005  # of the first wheelset, read too large
DEAD_TIMES = (0.02, 0.05, 0.1)  # s


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """A stop that differs from the nominal one in one thing."""

    subject: str
    words: str
    case: Case


def conditions(
    plant: Plant, scenario: Scenario, bounds: Mapping[str, Ends], laden: Vehicle | None
) -> tuple[Condition, ...]:
    """Return the conditions that a stop can be put under.

    Parameters
    ----------
    plant : Plant
        The nominal vehicle.
    scenario : Scenario
        The nominal stop.
    bounds : mapping
        Of the numbers of the files, by their names [SI units].
    laden : Vehicle or None
        The vehicle with its load, if that is known.
    """
    return (
        *_of_rails(plant, scenario),
        *_of_speeds(plant, scenario),
        *_of_vehicle(plant, scenario, bounds, laden),
        *_of_sensors(plant, scenario),
    )


def _of_rails(plant: Plant, scenario: Scenario) -> Iterator[Condition]:
    along = bool(scenario.patches or scenario.axle_rails)
    for name in uniform_rails():
        rail = load_rail(name)
        if along or rail != scenario.rail:
            stop = replace(scenario, rail=rail, axle_rails=None, patches=())
            yield Condition(subject="rail", words=name, case=(plant, stop))
    if not along and not plant.alike and plant.axles > 1:
        rails = (load_rail(OTHER_RAIL), *(scenario.rail for _ in range(plant.axles - 1)))
        stop = replace(scenario, axle_rails=rails)
        yield Condition(subject="rail", words=f"front wheelset on {OTHER_RAIL}", case=(plant, stop))


def _of_speeds(plant: Plant, scenario: Scenario) -> Iterator[Condition]:
    for share in SPEED_SHARES:
        stop = replace(scenario, initial_speed=share * scenario.initial_speed)
        yield Condition(
            subject="speed", words=f"from {3.6 * stop.initial_speed:.3g} km/h", case=(plant, stop)
        )


def _of_vehicle(
    plant: Plant, scenario: Scenario, bounds: Mapping[str, Ends], laden: Vehicle | None
) -> Iterator[Condition]:
    if laden is not None:
        yield Condition(
            subject="load", words=f"laden, {laden.mass / 1e3:.3g} t", case=(plant.on(laden), scenario)
        )
    worn = bounds.get("vehicle.wheel_radius", (plant.vehicle.wheel_radius,) * 2)[0]
    if worn < plant.vehicle.wheel_radius:
        vehicle = replace(plant.vehicle, wheel_radius=worn)
        words = f"all wheels worn to {1e3 * worn:.3g} mm radius"
        yield Condition(subject="wheels", words=words, case=(plant.on(vehicle), scenario))


def _of_sensors(plant: Plant, scenario: Scenario) -> Iterator[Condition]:
    plain = scenario.sensing
    radii = (RADIUS_ERROR, *(0.0 for _ in range(plant.vehicle.wheelsets - 1)))
    changed = (
        *(("sensors", each) for each in SENSOR_ERRORS),
        ("sensors", {"radius_errors": radii}),
        *(("dead time", {"dead_time": time}) for time in DEAD_TIMES),
    )
    undisturbed = Scenario(rail=scenario.rail, initial_speed=scenario.initial_speed)
    for subject, change in changed:
        sensing = replace(plain, **change)  # type: ignore[arg-type]  # by the names of the fields
        alone = replace(undisturbed, sensing=replace(undisturbed.sensing, **change))  # type: ignore[arg-type]
        yield Condition(
            subject=subject, words=disturbances_of(alone), case=(plant, replace(scenario, sensing=sensing))
        )
