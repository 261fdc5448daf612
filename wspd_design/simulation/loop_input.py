"""Convert vehicle, rails, controller and scenario to the numeric input of the closed loop."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from wspd_design.codegen.loop_numbers import (
    DISTURBANCES,
    FAULTS,
    RAIL_NUMBERS,
    STUCK_VALVES,
    LoopInput,
    Settings,
)
from wspd_design.codegen.plant_numbers import Surroundings, parameter_values
from wspd_design.controllers.protocol import Law, acts_on_vehicle
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, load_track_spectrum
from wspd_design.parameters.records import Brake, Rail, Vehicle
from wspd_design.plants.planar import Planar
from wspd_design.plants.protocol import Plant, is_coupled
from wspd_design.simulation.records import LoadIrregularity, Scenario, Sensing, Start
from wspd_design.simulation.runaway import runs_away
from wspd_design.simulation.start import available_torque
from wspd_design.simulation.track import irregular_track

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

LONGEST_STEP = 5e-3  # s
SLOPE_LIMIT = 2.0  # step over creep time; Runge-Kutta of order four is stable up to 2.8
LOAD_MARGIN = 1.3  # wheel load under braking against the static one, at most
RECORD_INTERVAL = 2e-3  # s, of the traces
TRACK = "erri-b176"
"""Spectra of the irregular track."""
_RUNAWAY_TIME = 10.0  # s, that are simulated of a stop of trains that cannot stop
JUDGING_SPEED = 10.0 / 3.6  # m/s, slip statistics count above it


def loop_input(
    cases: Sequence[tuple[Plant, Scenario]],
    controller: Law,
    *,
    refinement: int = 1,
    longest_step: float | None = None,
) -> LoopInput:
    """Numbers of one or several stops for the closed loop.

    Stops side by side share the kind of the plant, its number of wheelsets and the controller. Steps are at most
    ``LONGEST_STEP`` long where no other length is given, and no longer than the plant allows, over the refinement.
    """
    import numpy as np

    axles = cases[0][0].axles
    for each_plant, each in cases:
        _check(each, controller, each_plant)
        _check_start(each_plant.vehicle, each.start)
    shaken = any(each.pad_vibration for _, each in cases)
    lanes = [_lanes(plant, each, calm=shaken and not each.pad_vibration) for plant, each in cases]
    columns = [[rows[axle] for rows in lanes] for axle in range(axles)]
    scenarios = [each for _, each in cases]
    starts, rails = _patches(scenarios)
    track, lead, spacing = _tracks(scenarios)
    factors, spacings = _load_factors(scenarios, axles)
    return LoopInput(
        stop_parameters=np.array(columns[0]).T,
        lane_parameters=np.array([row for axle in columns for row in axle]).T,
        numbers=np.array([plant.numbers if is_coupled(plant) else () for plant, _ in cases]).T,
        speeds=np.array([each.initial_speed for _, each in cases]),
        wheel_speeds=np.tile([_rim_speed(each) / p.vehicle.wheel_radius for p, each in cases], axles),
        rest=np.array([_rest(*case) for case in cases]).T,
        pressures=np.tile([_pressure(p.vehicle.brake, each.start) for p, each in cases], axles),
        settings=_settings(
            cases,
            controller,
            refinement,
            min(longest_step or LONGEST_STEP, *(plant.longest_step for plant, _ in cases)),
        ),
        disturbances=np.array([_disturbances(p.vehicle.brake, each.sensing) for p, each in cases]).T,
        faults=np.array([column for rows in zip(*map(_faults, cases), strict=True) for column in rows]).T,
        seeds=np.array([each.seed for each in scenarios], dtype=np.uint64),
        patch_starts=starts,
        patch_rails=rails,
        load_factors=factors,
        load_spacings=spacings,
        track=track,
        track_again=lead,
        track_spacing=spacing,
    )


def _check(scenario: Scenario, controller: Law, plant: Plant) -> None:
    if not 1e-3 <= controller.sample_time <= 10.0:
        raise UserError(
            f"sample time = {controller.sample_time:g} s of controller {controller.name} must lie between 1 ms and 10 s"
        )
    shortest = scenario.sensing.shortest_pulse_of(plant.vehicle.brake)
    if shortest > controller.sample_time:
        raise UserError(
            f"shortest pulse = {shortest:g} s must not exceed the sample time of "
            f"{controller.sample_time:g} s of controller {controller.name}, whose valves would never open"
        )
    if acts_on_vehicle(controller) and controller.wheelsets != plant.axles:
        raise UserError(
            f"controller {controller.name} acts on {controller.wheelsets} wheelsets and vehicle "
            f'{plant.vehicle.name} has {plant.axles} on plant "{plant.name}"; make the controller for this vehicle'
        )
    for fault in scenario.faults:
        if fault.axle > plant.axles:
            raise UserError(
                f"fault {fault.kind} of axle {fault.axle}: vehicle {plant.vehicle.name} has "
                f'{plant.axles} on plant "{plant.name}"; name one of them'
            )
    errors = scenario.sensing.radius_errors
    if errors and len(errors) != plant.axles:
        raise UserError(
            f"radius errors: the stop names {len(errors)}; name {plant.axles}, one for each wheelset of vehicle "
            f"{plant.vehicle.name}, front axle first"
        )
    irregularity = scenario.load_irregularity
    if plant.alike and (scenario.axle_rails is not None or irregularity is not None):
        raise UserError(f'rails and loads of single axles need the plant "{Planar.name}"')
    if is_coupled(plant):
        if irregularity is not None:
            raise UserError(
                f'plant "{plant.name}" works out its wheel loads itself; in place of a load irregularity give '
                'the stop irregularities of the track, "low" or "high"'
            )
    elif scenario.irregularities != "none":
        raise UserError(
            f'irregularities of the track need a plant that rolls over them, and "{plant.name}" does not; take '
            'the plant "locomotive", or give the stop a load irregularity'
        )
    if plant.alike and not plant.vehicle.brakes_alike:
        raise UserError(
            f"vehicle {plant.vehicle.name} has axles with other brakes than the rest, which need the plant "
            f'"{Planar.name}"'
        )
    tables = None if irregularity is None else irregularity.factors
    for what, one, several in (
        ("axle rails", "rail", scenario.axle_rails),
        ("load irregularity", "table", tables),
    ):
        if several is not None and len(several) != plant.axles:
            raise UserError(
                f"{what}: the stop names {len(several)} {one}{'s' * (len(several) != 1)}; name {plant.axles}, "
                f"one for each wheelset of vehicle {plant.vehicle.name}, front axle first"
            )


def _check_start(vehicle: Vehicle, start: Start) -> None:
    most = available_torque(vehicle.brake, start.braking_time)
    if start.torque > most:
        raise UserError(
            f"torque = {start.torque:g} N m of the start must not exceed the {most:g} N m that the supply of "
            f"{vehicle.name} gives {start.braking_time:g} s after the brake was applied; lower it, or start "
            "with a longer braking time"
        )


def _rim_speed(scenario: Scenario) -> float:
    return scenario.initial_speed * (1.0 - scenario.start.slip)


def _rest(plant: Plant, scenario: Scenario) -> tuple[float, ...]:
    turning = _rim_speed(scenario) / plant.vehicle.wheel_radius
    return plant.rest_at(scenario.initial_speed, (turning,) * plant.axles)


def _pressure(brake: Brake, start: Start) -> float:
    return brake.max_pressure * (start.torque / brake.max_torque)


def first_slip(scenario: Scenario) -> float:
    """Slip at the start of a stop, as far as the figures count it [-]."""
    return scenario.start.slip if scenario.initial_speed > JUDGING_SPEED else 0.0


def _rails(scenario: Scenario, plant: Plant) -> tuple[Rail, ...]:
    return scenario.axle_rails or (scenario.rail,) * plant.axles


def _settings(
    cases: Sequence[tuple[Plant, Scenario]], controller: Law, refinement: int, longest_step: float
) -> Settings:
    steepest = max(
        plant.creep_rate(rail, 1.0)
        for plant, scenario in cases
        for rail in {*_rails(scenario, plant), *(patch.rail for patch in scenario.patches)}
    )
    fixed = constants()
    hopeless = all(runs_away(plant.vehicle, scenario) for plant, scenario in cases)
    return Settings(
        sample_time=controller.sample_time,
        longest_step=longest_step / refinement,
        creep_rate=steepest * LOAD_MARGIN ** (2.0 / 3.0),
        slope_limit=SLOPE_LIMIT / refinement,
        stop_speed=fixed.stop_speed,
        regularization_speed=fixed.slip_regularization_speed,
        time_limit=min(fixed.time_limit, _RUNAWAY_TIME) if hopeless else fixed.time_limit,
        judging_speed=JUDGING_SPEED,
        record_interval=RECORD_INTERVAL,
    )


def _lanes(plant: Plant, scenario: Scenario, *, calm: bool) -> list[list[float]]:
    """Parameters of each axle of a stop; ``calm`` are pads that do not vibrate beside stops where they do."""
    vehicle, rails, offsets = plant.vehicle, _rails(scenario, plant), plant.offsets
    grade_force = vehicle.mass * (constants().gravity * scenario.grade)
    usual = not (
        calm or vehicle.brake.axle_shares or vehicle.dynamic
    )  # so that campaigns do not wait for copies
    below = {*rails, *(patch.rail for patch in scenario.patches)}
    growth = max(map(plant.creep_growth, below)) if is_coupled(plant) else 1.0
    return [
        parameter_values(
            vehicle if usual else _lane_vehicle(vehicle, axle, calm=calm),
            rails[axle],
            Surroundings(
                grade_force=grade_force,
                axle_offset=offsets[axle],
                braking_time=scenario.start.braking_time,
                reservoir_drain=_drain(vehicle, axle),
                creep_growth=growth,
            ),
        )
        for axle in range(plant.axles)
    ]


def _lane_vehicle(vehicle: Vehicle, axle: int, *, calm: bool) -> Vehicle:
    """The vehicle with the brakes of an axle."""
    brake = vehicle.brake_of(axle)
    brake = replace(brake, disturbance_gain=0.0) if calm else brake
    return replace(vehicle, brake=brake, dynamic=vehicle.dynamic_of(axle))


def _drain(vehicle: Vehicle, axle: int) -> float:
    """Volume of the cylinders of an axle over that of the reservoir; 0 where the reservoir does not run low."""
    brake = vehicle.brake
    braked = vehicle.brake_shares[axle] > 0.0
    return brake.cylinder_volume / brake.reservoir_volume if brake.reservoir_volume and braked else 0.0


def _disturbances(brake: Brake, sensing: Sensing) -> list[float]:
    pulses = sensing.pulses_per_turn
    numbers = {
        "reference_factor": 1.0 + sensing.reference_error,
        "reference_drift": sensing.reference_drift,
        "reference_noise": sensing.reference_noise,
        "speed_noise": sensing.speed_noise,
        "pulse_angle": 2.0 * math.pi / pulses if pulses else 0.0,
        "timed": float(sensing.period_timing),
        "torque_factor": 1.0 + sensing.torque_error,
        "dead_time": sensing.dead_time_of(brake),
        "shortest_pulse": sensing.shortest_pulse_of(brake),
        "longest_release": brake.longest_release,
        "reservoir_pressure": brake.supply_pressure,
        "accelerometer_bias": sensing.accelerometer_bias,
        "accelerometer_noise": sensing.accelerometer_noise,
    }
    return [numbers[name] for name in DISTURBANCES]


def _faults(case: tuple[Plant, Scenario]) -> list[list[float]]:
    """What each wheelset of a stop has of its own."""
    plant, scenario = case
    errors = scenario.sensing.radius_errors or (0.0,) * plant.axles
    rows = []
    for axle, error in enumerate(errors, start=1):
        numbers = {
            "wheel_factor": 1.0 + error,
            "sensor_lost": math.inf,
            "stuck": 0.0,
            "stuck_since": math.inf,
        }
        for fault in (each for each in scenario.faults if each.axle == axle):
            kind = fault.kind.removeprefix("valve-")
            if kind in STUCK_VALVES:
                numbers |= {"stuck": 1.0 + STUCK_VALVES.index(kind), "stuck_since": fault.since}
            else:
                numbers["sensor_lost"] = fault.since
        rows.append([numbers[name] for name in FAULTS])
    return rows


def _patches(scenarios: Sequence[Scenario]) -> "tuple[Array, Array] | tuple[None, None]":
    """Starts and rails of the patches of every stop, filled up with patches that no train reaches."""
    import numpy as np

    most = max(len(each.patches) for each in scenarios)
    if not most:
        return None, None
    starts = np.full((most, len(scenarios)), np.inf)
    rails = np.zeros((most, len(scenarios), RAIL_NUMBERS))
    for stop, each in enumerate(scenarios):
        for row, patch in enumerate(each.patches):
            r = patch.rail
            starts[row, stop] = patch.start
            rails[row, stop] = (
                *(r.mu0, r.friction_ratio, r.friction_decay),
                *(r.adhesion_reduction, r.slip_reduction),
            )
    return starts, rails


def _load_factors(scenarios: Sequence[Scenario], axles: int) -> "tuple[Array, Array] | tuple[None, None]":
    """Tables of the wheel loads of every stop, as long as the longest (the last value stays), and their spacings."""
    import numpy as np

    if not any(each.load_irregularity for each in scenarios):
        return None, None
    even = LoadIrregularity(spacing=1.0, factors=((1.0, 1.0),) * axles)
    given = [each.load_irregularity or even for each in scenarios]
    points = max(len(row) for each in given for row in each.factors)
    table = np.empty((axles, len(given), points))
    for stop, each in enumerate(given):
        for axle, row in enumerate(each.factors):
            table[axle, stop] = (*row, *(row[-1],) * (points - len(row)))
    return table.reshape(axles * len(given), points), np.array([each.spacing for each in given])


def _tracks(scenarios: Sequence[Scenario]) -> "tuple[Array | None, int, float]":
    """Table of the irregular tracks of every stop, the point that comes after its last one, and its spacing [m]."""
    import numpy as np

    if all(each.irregularities == "none" for each in scenarios):
        return None, 0, 1.0
    spectra = load_track_spectrum(TRACK)
    drawn = {
        key: irregular_track(spectra, key[0], seed=key[1])
        for key in dict.fromkeys(
            (each.irregularities, each.seed) for each in scenarios if each.irregularities != "none"
        )
    }
    some = next(iter(drawn.values()))
    table = np.zeros((len(scenarios), some.values.shape[1], 2 * len(some.channels)))
    for stop, each in enumerate(scenarios):
        if each.irregularities != "none":
            track = drawn[each.irregularities, each.seed]
            table[stop, :, ::2], table[stop, :, 1::2] = track.values.T, track.slopes.T
    return table, some.lead, some.spacing


def sample_rows(controller: Law) -> int:
    """Most samples that a run can take."""
    return math.ceil(constants().time_limit / controller.sample_time) + 2
