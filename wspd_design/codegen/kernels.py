"""The kernels of the compiled closed loop: the plant's and the controller's own functions, traced by CasADi.

The numbers of vehicle and rail are inputs of the plant kernels, so that one compiled loop serves every vehicle,
rail and sample of parameters; those of the controller are constants of its kernel.
"""

from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

from wspd_design.codegen.emitter import UntraceableError
from wspd_design.controllers.protocol import Controller, Measurement
from wspd_design.model import brake as brake_model
from wspd_design.model.generated import brake as generated
from wspd_design.model.number import maximum, minimum
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle
from wspd_design.plants import four_axle
from wspd_design.plants.four_axle import AXLES, AxleCondition, Pitch


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What a scenario adds to vehicle and rail, as numbers of one wheelset."""

    grade_force: float = 0.0  # N, positive uphill
    axle_offset: float = 0.0  # m, behind the first axle


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
    "mass_bounds",
    "wheelset_inertia_bounds",
    "mu0_bounds",
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
    """CasADi functions of dense vectors; the first input of a plant kernel is the parameter vector."""

    loads: Any  # (p, pitch[6]) -> wheel load[4]
    condition: Any  # (p, [time, load]) -> [stiffness, damping]
    axle: Any  # (p, [speed, wheel speed, load, torque, stiffness, damping]) -> [force, acceleration, slip, damping]
    train: Any  # (p, [speed, force[4], pitch[6]]) -> [acceleration, resistance, pitch'[6]]
    actuator: (
        Any  # (p, [time, start, start pressure, fill end, vent end]) -> [pressure, torque, filled pressure]
    )
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

    pitch = ca.SX.sym("pitch", 6)
    loads = four_axle.wheel_loads(loco, Pitch(*(pitch[i] for i in range(6))))

    c = ca.SX.sym("c", 2)
    condition = four_axle.axle_condition(loco, time=c[0], wheel_load=c[1])

    x = ca.SX.sym("x", 6)
    axle = four_axle.axle_motion(
        loco,
        track,
        speed=x[0],
        wheel_speed=x[1],
        wheel_load=x[2],
        torque=x[3],
        condition=AxleCondition(stiffness=x[4], damping=x[5]),
    )
    outputs = (axle.creep_force, axle.wheel_acceleration, axle.slip, axle.damping_torque)

    y = ca.SX.sym("y", 1 + AXLES + 6)
    train = four_axle.train_motion(
        loco,
        speed=y[0],
        creep_forces=tuple(y[1 + i] for i in range(AXLES)),
        pitch=Pitch(*(y[1 + AXLES + i] for i in range(6))),
        grade_force=symbols["surroundings"]["grade_force"],
    )

    z = ca.SX.sym("z", 5)
    time, start, pressure, fill_end, vent_end = (z[i] for i in range(5))
    filled = generated.filled_pressure(
        minimum(time, fill_end),
        start,
        pressure,
        loco.brake.max_pressure,
        loco.brake.supply_rate,
        loco.brake.fill_time,
    )
    vented_for = maximum(minimum(time, vent_end) - fill_end, 0.0)
    reached = generated.vented_pressure(vented_for, filled, loco.brake.vent_time)
    torque = brake_model.braking_torque(loco.brake, reached)
    if disturbed:
        torque *= 1.0 + brake_model.torque_disturbance(loco.brake, time)

    start_kernel, step_kernel, states = _controller_kernels(controller)
    return Kernels(
        loads=ca.Function("loads_kernel", [p, pitch], [ca.vertcat(*loads)]),
        condition=ca.Function("condition_kernel", [p, c], [ca.vertcat(*condition)]),
        axle=ca.Function("axle_kernel", [p, x], [ca.vertcat(*outputs)]),
        train=ca.Function(
            "train_kernel", [p, y], [ca.vertcat(train.acceleration, train.resistance, *train.pitch)]
        ),
        actuator=ca.Function("actuator_kernel", [p, z], [ca.vertcat(reached, torque, filled)]),
        start=start_kernel,
        step=step_kernel,
        states=states,
    )


def _controller_kernels(controller: Controller | None) -> tuple[Any, Any, int]:
    """Trace ``start`` and ``step``; whatever goes wrong there means that the controller cannot be traced."""
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
        raise UntraceableError(f"{controller.name}: {error}") from error
    if len(following) != len(initial):
        raise UntraceableError(
            f"{controller.name}: step returns {len(following)} states, start {len(initial)}"
        )
    return start, step, len(initial)
