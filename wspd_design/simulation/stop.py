"""One stop: from the records to the numbers of the closed loop and back.

The closed loop is compiled once for each controller and run by the machine. A controller that cannot be traced
runs in Python on the compiled plant; without a C compiler plant and controller run in CasADi's virtual machine
and in Python, slower, with the same numbers.
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from wspd_design.codegen.closed_loop import (
    BAD_COMMAND,
    LoopInput,
    LoopOutput,
    Settings,
    load_closed_loop,
)
from wspd_design.codegen.compiler import NoCompilerError
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.kernels import Surroundings, parameter_values
from wspd_design.controllers.protocol import Controller, Measurement
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.four_axle import AXLES
from wspd_design.plants.quarter import quarter
from wspd_design.simulation.records import PLANTS, Ending, Run, Sample, Scenario, Totals

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LONGEST_STEP = 1e-3  # s
STEPS_PER_CREEP_TIME = 0.5  # Runge-Kutta of order four is stable up to 2.8 creep times
LOAD_MARGIN = 1.3  # wheel load under braking against the static one, at most
RECORD_INTERVAL = 2e-3  # s, of the traces
JUDGING_SPEED = 10.0 / 3.6  # m/s, slip statistics count above it


def simulate(
    vehicle: Vehicle,
    controller: Controller,
    scenario: Scenario,
    *,
    plant: str = "four-axle",
    refinement: int = 1,
) -> Run:
    """Brake from the initial speed to standstill.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    controller : Controller
        Law of every wheelset.
    scenario : Scenario
        Rails, initial speed and disturbances.
    plant : {"four-axle", "quarter"}
        With or without load transfer.
    refinement : int
        The integration steps are divided by it.

    Returns
    -------
    Run
        Traces, samples and integrals; ``ending`` says whether the train stopped.

    Raises
    ------
    UserError
        If the controller returns a command outside [0, 1] or one that is not a number, if there is no such
        plant, or if the scenario asks for what the plant does not have.
    """
    given = loop_input([(vehicle, scenario)], controller, plant=plant, refinement=refinement)
    given = replace(given, trace_rows=math.ceil(1.1 * constants().time_limit / RECORD_INTERVAL))
    output, engine = run_loop(vehicle, controller, scenario, given)
    if output.result == BAD_COMMAND:
        time, fill, vent = output.bad_command
        raise UserError(
            f"controller {controller.name} commanded fill = {fill:g}, vent = {vent:g} at t = {time:.3f} s; "
            "both must lie in [0, 1] and their sum must not exceed 1: limit the command in its step function"
        )
    return _run_record(vehicle, controller, scenario, plant, output, engine)


def run_loop(
    vehicle: Vehicle, controller: Controller, scenario: Scenario, given: LoopInput
) -> tuple[LoopOutput, str]:
    """Run a single stop on the fastest engine that can; returns also its name."""
    rows = sample_rows(controller)
    disturbed = scenario.pad_vibration
    try:
        try:
            loop = load_closed_loop(vehicle, scenario.rail, controller, disturbed=disturbed)
            return loop.run(given, sample_rows=rows), "compiled"
        except UntraceableError as error:
            warnings.warn(
                f"controller {error} cannot be traced by CasADi and runs in Python; write its step with the "
                "functions of wspd_design.model.number in place of if, max and math",
                stacklevel=3,
            )
            loop = load_closed_loop(vehicle, scenario.rail, None, disturbed=disturbed)
            return loop.run_with(given, controller, sample_rows=rows), "compiled plant, controller in Python"
    except NoCompilerError as error:
        from wspd_design.codegen.virtual_machine import run_virtual

        _notice(str(error))
        output = run_virtual(vehicle, scenario.rail, controller, given, sample_rows=rows, disturbed=disturbed)
        return output, "CasADi virtual machine"


def loop_input(
    cases: Sequence[tuple[Vehicle, Scenario]], controller: Controller, *, plant: str, refinement: int = 1
) -> LoopInput:
    """Numbers of one or several stops for the closed loop.

    Stops side by side may differ in the numbers of vehicle, rail, initial speed and seed; patches, grade,
    sensing and load irregularity are those of the first.
    """
    import numpy as np

    scenario = cases[0][1]
    sensing = scenario.sensing
    _check(scenario, controller, plant)
    placed = [(_flat(vehicle) if plant == "quarter" else vehicle, each) for vehicle, each in cases]
    grade = constants().gravity * scenario.grade
    columns = [
        [
            parameter_values(
                vehicle, rail, Surroundings(grade_force=vehicle.mass * grade, axle_offset=offset)
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


def _run_record(
    vehicle: Vehicle,
    controller: Controller,
    scenario: Scenario,
    plant: str,
    output: LoopOutput,
    engine: str,
) -> Run:
    import numpy as np

    columns = 1 if plant == "quarter" else AXLES
    lane, stop = output.lane_totals, {name: float(x[0]) for name, x in output.stop_totals.items()}
    start = _first_row(vehicle, scenario, output)
    trace = np.vstack([start, output.trace])
    wheel, slip, passed, load = (trace[:, 3 + k * AXLES : 3 + k * AXLES + columns] for k in range(4))
    states = (output.samples.shape[1] - 1) // AXLES - 5
    by_axle = output.samples[:, 1:].reshape(len(output.samples), states + 5, AXLES)
    times = output.samples[:, 0]
    return Run(
        controller=controller.name,
        vehicle=vehicle.name,
        rail=scenario.rail.name,
        plant=plant,
        sample_time=controller.sample_time,
        initial_speed=scenario.initial_speed,
        ending=Ending.STOPPED if output.stopped[0] else Ending.TIME_LIMIT,
        time=trace[:, 0],
        speed=trace[:, 1],
        distance=trace[:, 2],
        wheel_speed=wheel,
        slip=slip,
        torque=passed,
        wheel_load=load,
        axle_samples=tuple(
            tuple(
                Sample(
                    time=t,
                    fill=row[states],
                    vent=row[states + 1],
                    state=tuple(row[:states]),
                    seen=Measurement(*row[states + 2 :]),
                )
                for t, row in zip(times.tolist(), by_axle[:, :, axle].tolist(), strict=True)
            )
            for axle in range(columns)
        ),
        totals=Totals(
            distance=stop["distance"],
            torque=float(lane["torque"].sum()),
            resistance_impulse=stop["resistance_impulse"],
            damping_impulse=float(lane["damping_impulse"].sum()),
            brake_work=float(lane["brake_work"].sum()),
            sliding_work=float(lane["sliding_work"].sum()),
            resistance_work=stop["resistance_work"],
            damping_work=float(lane["damping_work"].sum()),
            lock_time=float(lane["lock_time"].max()),
            judged_time=stop["judged_time"],
            slip=float(lane["slip"].mean()),
            slip_squared=float(lane["slip_squared"].mean()),
            vented_pressure=float(lane["vented_pressure"].sum()),
        ),
        final_wheel_speeds=tuple(output.wheel_speeds.tolist()),
        slip_max=float(lane["slip_max"].max()),
        engine=engine,
    )


def _first_row(vehicle: Vehicle, scenario: Scenario, output: LoopOutput) -> "NDArray[np.float64]":
    """Row of the traces at t = 0: the wheels roll, the cylinders are empty."""
    import numpy as np

    static = vehicle.mass * constants().gravity / (2 * AXLES)
    row = np.zeros(output.trace.shape[1])
    row[1] = scenario.initial_speed
    row[3 : 3 + AXLES] = scenario.initial_speed / vehicle.wheel_radius
    row[3 + 3 * AXLES : 3 + 4 * AXLES] = static
    return row


_noticed: set[str] = set()


def _notice(reason: str) -> None:
    """Say once that this machine is slower than it could be."""
    if reason not in _noticed:
        _noticed.add(reason)
        warnings.warn(
            f"{reason}; simulating in CasADi's virtual machine, about thirty times slower. "
            "Install gcc or clang, or set CC",
            stacklevel=4,
        )
