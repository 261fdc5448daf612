"""The kernels of the compiled closed loop: the plant's and the controller's own functions, traced by CasADi.

The numbers of vehicle and rail are inputs of the plant kernels, so that one compiled loop serves every vehicle,
rail and sample of parameters; those of the controller are constants of its kernel.
"""

import re
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.hoisting import hoist
from wspd_design.controllers.protocol import Controller, Measurement
from wspd_design.model import brake as brake_model
from wspd_design.model.generated import brake as generated
from wspd_design.model.number import maximum, minimum, where
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle
from wspd_design.plants import four_axle
from wspd_design.plants.four_axle import AXLES, AxleCondition, Pitch


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What a scenario adds to vehicle and rail, as numbers of one wheelset."""

    grade_force: float = 0.0  # N, positive uphill
    axle_offset: float = 0.0  # m, behind the first axle
    braking_time: float = 0.0  # s, from the application of the brake to the begin of the stop


_RECORDS: tuple[tuple[str, type], ...] = (
    ("vehicle", Vehicle),
    ("brake", Brake),
    ("contact", Contact),
    ("rail", Rail),
    ("surroundings", Surroundings),
)
_NOT_NUMBERS = (
    "name",
    "wheelsets",
    "brake",
    "contact",
    "bounds",
)

PARAMETERS: tuple[tuple[str, str], ...] = tuple(
    (record, field.name)
    for record, kind in _RECORDS
    for field in fields(kind)
    if field.name not in _NOT_NUMBERS
)
"""Record and field of every element of the parameter vector."""


def parameter_values(vehicle: Vehicle, rail: Rail, surroundings: Surroundings) -> list[float]:
    """Parameter vector of one wheelset: the vehicle, the rail below it and what the scenario adds."""
    records = {
        "vehicle": vehicle,
        "brake": vehicle.brake,
        "contact": vehicle.contact,
        "rail": rail,
        "surroundings": surroundings,
    }
    return [getattr(records[record], field) for record, field in PARAMETERS]


class Kernels(NamedTuple):
    """CasADi functions of dense vectors; the first inputs of a plant kernel are the constants made for it."""

    stop_constants: Any  # (p) -> constants of loads and train
    lane_constants: Any  # (p) -> constants of condition and axle
    window_constants: Any  # (p, [start, start pressure, fill end, vent end]) -> constants of actuator
    loads: Any  # (constants, pitch[6]) -> wheel load[4]
    train: Any  # (constants, speed, force[4], pitch[6]) -> acceleration, resistance, pitch'[6]
    condition: Any  # (constants, time, load) -> [stiffness, damping]
    axle: Any  # (constants, speed, wheel speed, load, torque, locked, [stiffness, damping])
    #           -> force, wheel acceleration, slip, damping torque, torque that is passed on
    actuator: Any  # (constants, time) -> pressure, torque, pressure without venting
    start: Any  # ([speed, wheel speed, torque]) -> state
    step: Any  # (state, [speed, wheel speed, torque]) -> [state, fill, vent]
    states: int  # length of the controller state


def closed_loop_kernels(
    vehicle: Vehicle, rail: Rail, controller: Controller | None, *, disturbed: bool
) -> Kernels:
    """Trace plant and controller; without a controller its kernels hold the valves.

    ``disturbed`` adds the vibration of the pads, T_d, to the torque.
    """
    import casadi as ca

    p = ca.SX.sym("p", len(PARAMETERS))
    symbols: dict[str, dict[str, Any]] = {record: {} for record, _ in _RECORDS}
    for index, (record, field) in enumerate(PARAMETERS):
        symbols[record][field] = p[index]
    loco = replace(
        vehicle,
        **symbols["vehicle"],
        brake=Brake(**symbols["brake"]),
        contact=Contact(**symbols["contact"]),
    )
    track = replace(rail, **symbols["rail"])

    plant = _plant_functions(loco, track, p, Surroundings(**symbols["surroundings"]), disturbed)
    stop_constants, (loads, train) = hoist(plant[:2], 1, "stop_constants")
    lane_constants, (condition, axle) = hoist(plant[2:4], 1, "lane_constants")
    window_constants, (actuator,) = hoist(plant[4:], 2, "window_constants")
    start, step, states = controller_kernels(controller)
    return Kernels(
        stop_constants=stop_constants,
        lane_constants=lane_constants,
        window_constants=window_constants,
        loads=loads,
        train=train,
        condition=condition,
        axle=axle,
        actuator=actuator,
        start=start,
        step=step,
        states=states,
    )


def _plant_functions(
    loco: Vehicle, track: Rail, p: Any, surroundings: Surroundings, disturbed: bool
) -> list[Any]:
    """Trace the plant; the first input of every function is the parameter vector."""
    import casadi as ca

    speed, wheel_speed, load, demand, locked, time = (
        ca.SX.sym(name) for name in ("speed", "wheel_speed", "load", "torque", "locked", "time")
    )
    held, force, pitch = ca.SX.sym("condition", 2), ca.SX.sym("force", AXLES), ca.SX.sym("pitch", 6)
    motions = Pitch(*(pitch[i] for i in range(6)))
    loads = four_axle.wheel_loads(loco, motions)
    train = four_axle.train_motion(
        loco,
        speed=speed,
        creep_forces=tuple(force[i] for i in range(AXLES)),
        pitch=motions,
        grade_force=surroundings.grade_force,
    )
    braking_time = time + surroundings.braking_time
    condition = four_axle.axle_condition(loco, time=braking_time, wheel_load=load)
    axle = four_axle.axle_motion(
        loco,
        track,
        speed=speed,
        wheel_speed=wheel_speed,
        wheel_load=load,
        torque=demand,
        condition=AxleCondition(stiffness=held[0], damping=held[1]),
    )
    rolling = where(locked != 0.0, 0.0, axle.wheel_acceleration)
    passed = where(locked != 0.0, 2.0 * loco.wheel_radius * axle.creep_force, demand)
    valves = ca.SX.sym("valves", 4)
    pressures = _pressure(loco.brake, time, surroundings.braking_time, *(valves[i] for i in range(4)))
    torque = brake_model.braking_torque(loco.brake, pressures[0])
    if disturbed:
        torque *= 1.0 + brake_model.torque_disturbance(loco.brake, braking_time)
    return [
        ca.Function("loads_kernel", [p, pitch], [ca.vertcat(*loads)]),
        ca.Function(
            "train_kernel",
            [p, speed, force, pitch],
            [train.acceleration, train.resistance, ca.vertcat(*train.pitch)],
        ),
        ca.Function("condition_kernel", [p, time, load], [ca.vertcat(*condition)]),
        ca.Function(
            "axle_kernel",
            [p, speed, wheel_speed, load, demand, locked, held],
            [axle.creep_force, rolling, axle.slip, axle.damping_torque, passed],
        ),
        ca.Function("actuator_kernel", [p, valves, time], [pressures[0], torque, pressures[1]]),
    ]


def _pressure(
    brake: Brake, time: Any, before: Any, start: Any, start_pressure: Any, fill_end: Any, vent_end: Any
) -> tuple[Any, Any]:
    """Cylinder pressure under fill, then vent, then hold; and what it would be without the venting.

    The brake was applied ``before`` the time zero [s].
    """
    filled = generated.filled_pressure(
        minimum(time, fill_end) + before,
        start + before,
        start_pressure,
        brake.max_pressure,
        brake.supply_rate,
        brake.fill_time,
    )
    vented_for = maximum(minimum(time, vent_end) - fill_end, 0.0)
    return generated.vented_pressure(vented_for, filled, brake.vent_time), filled


def controller_kernels(controller: Controller | None) -> tuple[Any, Any, int]:
    """Trace ``start`` and ``step``; returns also the number of states.

    Whatever goes wrong there means that the controller cannot be traced.
    """
    import casadi as ca

    m = ca.SX.sym("m", 3)
    measurement = Measurement(speed=m[0], wheel_speed=m[1], torque=m[2])
    if controller is None:
        return (
            ca.Function("start_kernel", [m], [ca.SX(0, 1)]),
            ca.Function("step_kernel", [ca.SX(0, 1), m], [ca.SX.zeros(2)]),
            0,
        )
    try:
        initial = controller.start(measurement)
        state = ca.SX.sym("state", len(initial))
        following, command = controller.step(tuple(state[i] for i in range(len(initial))), measurement)
        start = ca.Function("start_kernel", [m], [ca.vertcat(*initial)])
        step = ca.Function("step_kernel", [state, m], [ca.vertcat(*following, command.fill, command.vent)])
    except Exception as error:  # the user's code may fail on symbols in any way
        reason = re.sub(r"\S*\.[ch]pp:\d+: ", "", str(error))  # without CasADi's places in its own source
        raise UntraceableError(f"{controller.name}: {reason}") from error
    if len(following) != len(initial):
        raise UntraceableError(
            f"{controller.name}: step returns {len(following)} states, start {len(initial)}"
        )
    return start, step, len(initial)
