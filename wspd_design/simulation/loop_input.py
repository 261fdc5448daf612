"""Convert vehicle, rails, controller and scenario to the numeric input of the closed loop."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from wspd_design.codegen.kernels import Surroundings, parameter_values
from wspd_design.codegen.loop_numbers import LoopInput, Settings
from wspd_design.controllers.protocol import Controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Brake, Rail, Vehicle
from wspd_design.plants.planar import Planar
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.records import Scenario, Start
from wspd_design.simulation.runaway import runs_away
from wspd_design.simulation.start import available_torque

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LONGEST_STEP = 5e-3  # s
SLOPE_LIMIT = 2.0  # step over creep time; Runge-Kutta of order four is stable up to 2.8
LOAD_MARGIN = 1.3  # wheel load under braking against the static one, at most
RECORD_INTERVAL = 2e-3  # s, of the traces
_RUNAWAY_TIME = 10.0  # s, that are simulated of a stop of trains that cannot stop
JUDGING_SPEED = 10.0 / 3.6  # m/s, slip statistics count above it


def loop_input(
    cases: Sequence[tuple[Plant, Scenario]], controller: Controller, *, refinement: int = 1
) -> LoopInput:
    """Numbers of one or several stops for the closed loop.

    Stops side by side may differ in the numbers of vehicle, rail, initial speed, start and seed; patches, grade,
    sensing and load irregularity are those of the first.
    """
    import numpy as np

    plant, scenario = cases[0]
    sensing, axles = scenario.sensing, plant.axles
    _check(scenario, controller, plant)
    for each_plant, each in cases:
        _check_start(each_plant.vehicle, each.start)
    grade = constants().gravity * scenario.grade
    columns = [
        [
            parameter_values(
                each_plant.vehicle,
                _rails(each, each_plant)[axle],
                Surroundings(
                    grade_force=each_plant.vehicle.mass * grade,
                    axle_offset=each_plant.offsets[axle],
                    braking_time=each.start.braking_time,
                ),
            )
            for each_plant, each in cases
        ]
        for axle in range(axles)
    ]
    irregularity = scenario.load_irregularity
    pulses = sensing.pulses_per_turn * controller.sample_time
    return LoopInput(
        stop_parameters=np.array(columns[0]).T,
        lane_parameters=np.array([row for axle in columns for row in axle]).T,
        speeds=np.array([each.initial_speed for _, each in cases]),
        wheel_speeds=np.tile([_rim_speed(each) / p.vehicle.wheel_radius for p, each in cases], axles),
        pressures=np.tile([_pressure(p.vehicle.brake, each.start) for p, each in cases], axles),
        settings=_settings(cases, controller, refinement),
        patch_starts=np.array([patch.start for patch in scenario.patches]) if scenario.patches else None,
        patch_rails=_patch_rails(scenario, axles) if scenario.patches else None,
        wheel_noise=_wheel_noise(cases, controller) if sensing.speed_noise else None,
        quantum=2.0 * math.pi / pulses if pulses else 0.0,
        reference_factor=1.0 + sensing.reference_error,
        load_factors=np.array(irregularity.factors) if irregularity else None,
        load_spacing=irregularity.spacing if irregularity else 1.0,
    )


def _check(scenario: Scenario, controller: Controller, plant: Plant) -> None:
    if not 1e-3 <= controller.sample_time <= 10.0:
        raise UserError(
            f"sample time = {controller.sample_time:g} s of controller {controller.name} must lie between 1 ms and 10 s"
        )
    if not 0.0 <= scenario.sensing.dead_time <= controller.sample_time:
        raise UserError(
            f"dead time = {scenario.sensing.dead_time:g} s must lie between 0 and the sample time "
            f"of {controller.sample_time:g} s"
        )
    irregularity = scenario.load_irregularity
    if plant.alike and (scenario.axle_rails is not None or irregularity is not None):
        raise UserError(f'rails and loads of single axles need the plant "{Planar.name}"')
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


def _pressure(brake: Brake, start: Start) -> float:
    return brake.max_pressure * (start.torque / brake.max_torque)


def first_slip(scenario: Scenario) -> float:
    """Slip at the start of a stop, as far as the figures count it [-]."""
    return scenario.start.slip if scenario.initial_speed > JUDGING_SPEED else 0.0


def _rails(scenario: Scenario, plant: Plant) -> tuple[Rail, ...]:
    return scenario.axle_rails or (scenario.rail,) * plant.axles


def _settings(cases: Sequence[tuple[Plant, Scenario]], controller: Controller, refinement: int) -> Settings:
    steepest = max(
        plant.creep_rate(rail, 1.0)
        for plant, scenario in cases
        for rail in {*_rails(scenario, plant), *(patch.rail for patch in scenario.patches)}
    )
    fixed = constants()
    hopeless = all(runs_away(plant.vehicle, scenario) for plant, scenario in cases)
    return Settings(
        sample_time=controller.sample_time,
        dead_time=cases[0][1].sensing.dead_time,
        longest_step=LONGEST_STEP / refinement,
        creep_rate=steepest * LOAD_MARGIN ** (2.0 / 3.0),
        slope_limit=SLOPE_LIMIT / refinement,
        stop_speed=fixed.stop_speed,
        regularization_speed=fixed.slip_regularization_speed,
        time_limit=min(fixed.time_limit, _RUNAWAY_TIME) if hopeless else fixed.time_limit,
        judging_speed=JUDGING_SPEED,
        record_interval=RECORD_INTERVAL,
    )


def _patch_rails(scenario: Scenario, axles: int) -> "NDArray[np.float64]":
    import numpy as np

    rows = [
        (r.mu0, r.friction_ratio, r.friction_decay, r.adhesion_reduction, r.slip_reduction)
        for r in (patch.rail for patch in scenario.patches)
    ]
    return np.repeat(np.array(rows)[:, np.newaxis, :], axles, axis=1)


def _wheel_noise(cases: Sequence[tuple[Plant, Scenario]], controller: Controller) -> "NDArray[np.float64]":
    """Noise of the measured wheel speeds [rad/s]; each stop draws from its own seed."""
    import numpy as np

    rows, axles = sample_rows(controller), cases[0][0].axles
    draws = [
        np.random.default_rng(np.random.SeedSequence([scenario.seed, 0])).standard_normal((rows, axles))
        * (scenario.sensing.speed_noise / plant.vehicle.wheel_radius)
        for plant, scenario in cases
    ]
    return np.stack(draws, axis=2).reshape(rows, axles * len(cases))


def sample_rows(controller: Controller) -> int:
    """Most samples that a run can take."""
    return math.ceil(constants().time_limit / controller.sample_time) + 2
