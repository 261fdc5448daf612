"""One stop: from the records to the numbers of the closed loop and back.

The plant is compiled once for all vehicles of as many axles, the law once whatever its gains are. Without a C
compiler the law runs in CasADi's virtual machine on the plant that came with the package, and where none did, the
plant runs there as well, slower, with the same numbers. A controller that cannot be traced runs in Python.
"""

import math
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.compiler import COMPILER_INSTALLATION, NoCompilerError
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.loop_numbers import LANE_SEEN, STOP_SEEN, LoopInput, LoopOutput
from wspd_design.codegen.notices import tell_once
from wspd_design.codegen.sampled import BAD_COMMAND, places_told
from wspd_design.controllers.protocol import Law, Measurement, acts_on_vehicle
from wspd_design.model.brake import torque_disturbance
from wspd_design.model.further_brakes import pad_factor, track_brake_force
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.plants.protocol import Plant, is_coupled
from wspd_design.simulation.loop_input import RECORD_INTERVAL, first_slip, loop_input, sample_rows
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runaway import runs_away
from wspd_design.simulation.runs import Ending, Run, Sample, Totals
from wspd_design.simulation.taken import check_stop

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.simulation.runs import Trace


def simulate(
    vehicle: Vehicle,
    controller: Law,
    scenario: Scenario,
    *,
    plant: str = DEFAULT_PLANT,
    refinement: int = 1,
) -> Run:
    """Brake from the initial speed to standstill.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    controller : Law
        Law of every wheelset, or of the vehicle.
    scenario : Scenario
        Rails, initial speed and disturbances.
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        With load transfer, without, or with all degrees of freedom.
    refinement : int
        The integration steps are divided by it.

    Returns
    -------
    Run
        Traces, samples and integrals; ``ending`` says whether the train stopped.

    Raises
    ------
    UserError
        If an argument is of another kind, numbers of the vehicle contradict each other, the controller returns a
        command outside [0, 1] or one that is not a number, there is no such plant, or the scenario asks for what the
        plant does not have.
    """
    check_stop(vehicle, controller, scenario, plant, by="simulate")
    return simulate_on(plant_of(plant, vehicle), controller, scenario, refinement=refinement)


def simulate_on(plant: Plant, controller: Law, scenario: Scenario, *, refinement: int = 1) -> Run:
    """Brake a plant from the initial speed to standstill; otherwise as :func:`simulate`."""
    given = traced(loop_input([(plant, scenario)], controller, refinement=refinement))
    output, engine = run_loop(plant, controller, scenario, given)
    if output.result == BAD_COMMAND:
        time, fill, vent = output.bad_command
        raise UserError(
            f"controller {controller.name} commanded fill = {fill:g}, vent = {vent:g} at t = {time:.3f} s; "
            "both must lie in [0, 1] and their sum must not exceed 1: limit the command in its step function"
        )
    return run_record(plant, controller, scenario, output, engine)


def traced(given: LoopInput) -> LoopInput:
    """Return the numbers of a stop that records its traces up to the time limit."""
    return replace(given, trace_rows=math.ceil(1.1 * constants().time_limit / RECORD_INTERVAL))


def run_loop(plant: Plant, controller: Law, scenario: Scenario, given: LoopInput) -> tuple[LoopOutput, str]:
    """Run a single stop on the fastest engine that can; returns also its name."""
    rows = sample_rows(controller)
    disturbed = scenario.pad_vibration
    try:
        try:
            loop = load_closed_loop(plant, controller, disturbed=disturbed)
            return loop.run(given, sample_rows=rows), loop.engine
        except UntraceableError as error:
            warnings.warn(
                f"controller {error} cannot be traced by CasADi and runs in Python; write its step with the "
                "functions of wspd_design.model.number in place of if, max and math",
                stacklevel=3,
            )
            loop = load_closed_loop(plant, None, disturbed=disturbed)
            return loop.run_with(given, controller, sample_rows=rows), loop.engine
    except NoCompilerError as error:
        from wspd_design.codegen.virtual_machine import run_virtual

        tell_once(
            str(error),
            "simulating in CasADi's virtual machine, about 170 times slower; "
            f"{COMPILER_INSTALLATION} brings a compiler",
        )
        output = run_virtual(plant, controller, given, sample_rows=rows, disturbed=disturbed)
        return output, "CasADi virtual machine"


def run_record(plant: Plant, controller: Law, scenario: Scenario, output: LoopOutput, engine: str) -> Run:
    """Return what became of a single stop that was run with traces."""
    import numpy as np

    axles, magnets = plant.axles, plant.vehicle.track_brake
    columns = 1 if plant.alike else axles
    lane, stop = output.lane_totals, {name: float(x[0]) for name, x in output.stop_totals.items()}
    braked, valved = np.array(plant.vehicle.braked), np.array(plant.vehicle.brake_shares) > 0.0
    trace = output.trace
    if not is_coupled(plant):
        trace = np.vstack([_first_row(plant, scenario, output), trace])
    wheel, slip, passed, load, given, dynamic, *others = (
        trace[:, begin : begin + columns] for begin in range(3, trace.shape[1], axles)
    )
    warmth, further = others[: plant.axle_states - 1], others[plant.axle_states - 1 :]
    band = lane["slip_band"][lane["slip_band"] >= 0.0]
    told_speed, _ = places_told(controller)
    return Run(
        controller=controller.name,
        vehicle=plant.vehicle.name,
        rail=scenario.rail.name,
        plant=plant.name,
        sample_time=controller.sample_time,
        dead_time=scenario.sensing.dead_time_of(plant.vehicle.brake),
        shortest_pulse=scenario.sensing.shortest_pulse_of(plant.vehicle.brake),
        initial_speed=scenario.initial_speed,
        seed=scenario.seed,
        wheel_radius=plant.vehicle.wheel_radius,
        ending=_ending(plant, scenario, output),
        time=trace[:, 0],
        speed=trace[:, 1],
        distance=trace[:, 2],
        wheel_speed=wheel,
        slip=slip,
        torque=passed,
        wheel_load=load,
        cylinder_pressure=_pressures(plant, scenario, trace[:, 0], given - dynamic, wheel, warmth),
        axle_samples=tuple(
            _samples(output.samples, axle, axles=axles, vehicle=acts_on_vehicle(controller))
            if valved[axle]
            else ()
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
            slip=float(lane["slip"][braked].mean()),
            slip_squared=float(lane["slip_squared"][braked].mean()),
            vented_pressure=float(lane["vented_pressure"][valved].sum()),
            valve_switches=float(lane["valve_switches"][valved].mean()),
            filled_pressure=float(lane["filled_pressure"][valved].sum()),
            watchdog_fills=round(float(lane["watchdog"][valved].sum())),
            judged_lock=float(lane["longest_lock"].max()),
            slip_band=float(band.max()) if band.size else math.nan,
            speed_error=math.nan if told_speed < 0 else stop["speed_error"],
            distance_error=math.nan if told_speed < 0 else stop["distance_error"],
        ),
        final_wheel_speeds=tuple(output.wheel_speeds.tolist()),
        slip_max=max(float(lane["slip_max"].max()), first_slip(scenario)),
        engine=engine,
        shared_state=acts_on_vehicle(controller),
        memory=tuple(getattr(controller, "memory", ())),
        dynamic_torque=None if plant.vehicle.dynamic is None else dynamic,
        pad_temperature=warmth[0] if warmth else None,
        further=dict(zip(plant.further_traces, further, strict=True)) if is_coupled(plant) else {},
        further_units=plant.further_traces if is_coupled(plant) else {},
        track_brake_force=None
        if magnets is None
        else np.array(
            [
                track_brake_force(magnets, v, t + scenario.start.braking_time)
                for t, v in zip(trace[:, 0].tolist(), trace[:, 1].tolist(), strict=True)
            ]
        ),
    )


def _pressures(
    plant: Plant, scenario: Scenario, time: "Trace", friction: "Trace", wheel: "Trace", warmth: "list[Trace]"
) -> "Trace":
    """Cylinder pressures that make the torques of the friction brakes, eq. (12) with pads and vibration [Pa]."""
    import numpy as np

    vehicle, columns = plant.vehicle, friction.shape[1]
    brake, pads = vehicle.brake, vehicle.pads
    full = brake.max_torque * np.array(vehicle.brake_shares[:columns])
    made = np.ones_like(friction)
    if scenario.pad_vibration:
        made *= (1.0 + torque_disturbance(brake, time + scenario.start.braking_time))[:, None]
    if pads is not None:
        made *= pad_factor(pads, vehicle.wheel_radius * wheel, warmth[0] if warmth else 0.0)
    if not is_coupled(plant):
        made[0] = 1.0  # the first row is told by the pressures alone
    valved = full > 0.0
    pressures = np.zeros_like(friction)
    pressures[:, valved] = friction[:, valved] / made[:, valved] / full[valved] * brake.max_pressure
    return pressures


def _ending(plant: Plant, scenario: Scenario, output: LoopOutput) -> Ending:
    if output.stopped[0]:
        return Ending.STOPPED
    return Ending.RUNAWAY if runs_away(plant.vehicle, scenario) else Ending.TIME_LIMIT


def _samples(rows: "NDArray[np.float64]", axle: int, *, axles: int, vehicle: bool) -> tuple[Sample, ...]:
    """Samples of one wheelset; a law of the vehicle has one state for all of them."""
    states = rows.shape[1] - 1 - (2 + LANE_SEEN) * axles - STOP_SEEN
    decided = 1 + states
    seen = decided + 2 * axles
    columns = (
        rows[:, 0].tolist(),
        rows[:, decided + axle].tolist(),
        rows[:, decided + axles + axle].tolist(),
        map(tuple, (rows[:, 1:decided] if vehicle else rows[:, 1 + axle : decided : axles]).tolist()),
        map(Measurement._make, rows[:, seen + axle : seen + 3 * axles : axles].tolist()),
    )
    return tuple(map(Sample._make, zip(*columns, strict=True)))


def _first_row(plant: Plant, scenario: Scenario, output: LoopOutput) -> "NDArray[np.float64]":
    """Row of the traces at t = 0, where no load has moved."""
    import numpy as np

    speed, slip, axles = scenario.initial_speed, scenario.start.slip, plant.axles
    loads = plant.loads_at_rest()
    referred = slip * min(speed / constants().slip_regularization_speed, 1.0)
    alike = (speed * (1.0 - slip) / plant.vehicle.wheel_radius, referred)
    at_rest = len(output.samples) == 0  # a start below the stop speed
    # As the first sample saw them, without the error of their measurement.
    factor = 1.0 + scenario.sensing.torque_error
    others = np.zeros(
        axles * plant.axle_states
    )  # electrodynamic brakes, which begin at zero, and further states
    torques = (
        scenario.start.torque * np.array(plant.vehicle.brake_shares)
        if at_rest
        else output.samples[0, _told_torques(axles)] / factor
    )
    return np.concatenate([(0.0, speed, 0.0), np.repeat(alike, axles), torques, loads, torques, others])


def _told_torques(axles: int) -> slice:
    """Columns of the samples with the torques that the law was told."""
    first = (2 - LANE_SEEN) * axles - STOP_SEEN
    return slice(first, first + axles)
