"""Numbers of a stop for the closed loop: what vehicle, rails, controller and scenario mean to the machine."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from wspd_design.codegen.closed_loop import LoopInput, Settings
from wspd_design.codegen.kernels import Surroundings, parameter_values
from wspd_design.controllers.protocol import Controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Brake, Rail, Vehicle
from wspd_design.plants.four_axle import AXLES
from wspd_design.plants.quarter import quarter
from wspd_design.simulation.records import PLANTS, Scenario, Start
from wspd_design.simulation.start import available_torque

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LONGEST_STEP = 1e-3  # s
STEPS_PER_CREEP_TIME = 0.5  # Runge-Kutta of order four is stable up to 2.8 creep times
LOAD_MARGIN = 1.3  # wheel load under braking against the static one, at most
RECORD_INTERVAL = 2e-3  # s, of the traces
JUDGING_SPEED = 10.0 / 3.6  # m/s, slip statistics count above it


def loop_input(
    cases: Sequence[tuple[Vehicle, Scenario]], controller: Controller, *, plant: str, refinement: int = 1
) -> LoopInput:
    """Numbers of one or several stops for the closed loop.

    Stops side by side may differ in the numbers of vehicle, rail, initial speed, start and seed; patches, grade,
    sensing and load irregularity are those of the first.
    """
    import numpy as np

    scenario = cases[0][1]
    sensing = scenario.sensing
    _check(scenario, controller, plant)
    for vehicle, each in cases:
        _check_start(vehicle, each.start)
    placed = [(_flat(vehicle) if plant == "quarter" else vehicle, each) for vehicle, each in cases]
    grade = constants().gravity * scenario.grade
    columns = [
        [
            parameter_values(
                vehicle,
                rail,
                Surroundings(
                    grade_force=vehicle.mass * grade,
                    axle_offset=offset,
                    braking_time=each.start.braking_time,
                ),
            )
            for vehicle, each in placed
            for rail, offset in [(_rails(each)[axle], axle_offsets(vehicle, plant)[axle])]
        ]
        for axle in range(AXLES)
    ]
    irregularity = scenario.load_irregularity
    pulses = sensing.pulses_per_turn * controller.sample_time
    return LoopInput(
        stop_parameters=np.array(columns[0]).T,
        lane_parameters=np.array([row for axle in columns for row in axle]).T,
        speeds=np.array([each.initial_speed for _, each in cases]),
        wheel_speeds=np.tile([_rim_speed(each) / vehicle.wheel_radius for vehicle, each in cases], AXLES),
        pressures=np.tile([_pressure(vehicle.brake, each.start) for vehicle, each in cases], AXLES),
        settings=_settings(cases, controller, refinement),
        patch_starts=np.array([patch.start for patch in scenario.patches]) if scenario.patches else None,
        patch_rails=_patch_rails(scenario) if scenario.patches else None,
        wheel_noise=_wheel_noise(cases, controller) if sensing.speed_noise else None,
        quantum=2.0 * math.pi / pulses if pulses else 0.0,
        reference_factor=1.0 + sensing.reference_error,
        load_factors=np.array(irregularity.factors) if irregularity else None,
        load_spacing=irregularity.spacing if irregularity else 1.0,
    )


def _check(scenario: Scenario, controller: Controller, plant: str) -> None:
    if plant not in PLANTS:
        raise UserError(f'unknown plant "{plant}"; available: {", ".join(PLANTS)}')
    if not 1e-3 <= controller.sample_time <= 10.0:
        raise UserError(
            f"sample time = {controller.sample_time:g} s of controller {controller.name} must lie between 1 ms and 10 s"
        )
    if not 0.0 <= scenario.sensing.dead_time <= controller.sample_time:
        raise UserError(
            f"dead time = {scenario.sensing.dead_time:g} s must lie between 0 and the sample time "
            f"of {controller.sample_time:g} s"
        )
    if plant == "quarter" and (scenario.axle_rails is not None or scenario.load_irregularity is not None):
        raise UserError('rails and loads of single axles need the plant "four-axle"')


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


def _flat(vehicle: Vehicle) -> Vehicle:
    """Take the heights out: no load is transferred."""
    return replace(vehicle, body_height=0.0, bogie_height=0.0, traction_rod_height=0.0)


def _rails(scenario: Scenario) -> tuple[Rail, ...]:
    return scenario.axle_rails or (scenario.rail,) * AXLES


def axle_offsets(vehicle: Vehicle, plant: str) -> tuple[float, float, float, float]:
    """Distance of each axle behind the first one; the quarter locomotive is a point [m]."""
    if plant == "quarter":
        return (0.0, 0.0, 0.0, 0.0)
    base, spacing = vehicle.wheelbase, vehicle.bogie_spacing
    return (0.0, base, spacing, spacing + base)


def _settings(cases: Sequence[tuple[Vehicle, Scenario]], controller: Controller, refinement: int) -> Settings:
    steepest = max(
        quarter(vehicle, rail).creep_rate(1.0)
        for vehicle, scenario in cases
        for rail in {*_rails(scenario), *(patch.rail for patch in scenario.patches)}
    )
    fixed = constants()
    return Settings(
        sample_time=controller.sample_time,
        dead_time=cases[0][1].sensing.dead_time,
        longest_step=LONGEST_STEP / refinement,
        creep_rate=steepest * LOAD_MARGIN ** (2.0 / 3.0) * STEPS_PER_CREEP_TIME * refinement,
        stop_speed=fixed.stop_speed,
        regularization_speed=fixed.slip_regularization_speed,
        time_limit=fixed.time_limit,
        judging_speed=JUDGING_SPEED,
        record_interval=RECORD_INTERVAL,
    )


def _patch_rails(scenario: Scenario) -> "NDArray[np.float64]":
    import numpy as np

    rows = [
        (r.mu0, r.friction_ratio, r.friction_decay, r.adhesion_reduction, r.slip_reduction)
        for r in (patch.rail for patch in scenario.patches)
    ]
    return np.repeat(np.array(rows)[:, np.newaxis, :], AXLES, axis=1)


def _wheel_noise(cases: Sequence[tuple[Vehicle, Scenario]], controller: Controller) -> "NDArray[np.float64]":
    """Noise of the measured wheel speeds [rad/s]; each stop draws from its own seed."""
    import numpy as np

    rows = sample_rows(controller)
    draws = [
        np.random.default_rng(np.random.SeedSequence([scenario.seed, 0])).standard_normal((rows, AXLES))
        * (scenario.sensing.speed_noise / vehicle.wheel_radius)
        for vehicle, scenario in cases
    ]
    return np.stack(draws, axis=2).reshape(rows, AXLES * len(cases))


def sample_rows(controller: Controller) -> int:
    """Most samples that a run can take."""
    return math.ceil(constants().time_limit / controller.sample_time) + 2
