"""The kernels of the plant in the compiled closed loop: its own functions, traced by CasADi.

The numbers of vehicle and rail are inputs of the kernels, so that one compiled loop serves every vehicle of as many
axles, every rail and every sample of parameters.
"""

from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

from wspd_design.codegen.further_numbers import (
    FURTHER_PARAMETERS,
    PART_NAMES,
    blank_parts,
    further_values,
    symbolic_parts,
)
from wspd_design.codegen.hoisting import hoist
from wspd_design.codegen.memory import Memory
from wspd_design.model import adhesion
from wspd_design.model import brake as brake_model
from wspd_design.model.further_brakes import build_up
from wspd_design.model.number import where
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle
from wspd_design.plants.protocol import AxleCondition, Plant


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What a scenario adds to vehicle and rail, as numbers of one wheelset."""

    grade_force: float = 0.0  # N, positive uphill
    axle_offset: float = 0.0  # m, behind the first axle
    braking_time: float = 0.0  # s, from the application of the brake to the start of the stop
    reservoir_drain: float = 0.0  # -, by which a pressure filled into the cylinders lowers the reservoir


_RECORDS: tuple[tuple[str, type], ...] = (
    ("vehicle", Vehicle),
    ("brake", Brake),
    ("contact", Contact),
    ("rail", Rail),
    ("surroundings", Surroundings),
)
KINDS = ("build_up", "valve")
"""Words of a brake: another word is another kernel, and so is a reservoir that can run low."""
_NOT_NUMBERS = (
    "name",
    "wheelsets",
    "axles_per_bogie",
    "bodies",
    "brake",
    "contact",
    "axle_shares",
    *PART_NAMES,
    "bounds",
    *KINDS,
    "dead_time",  # the numbers of a stop hold these, as its disturbances
    "shortest_pulse",
    "longest_release",
    "cylinder_volume",
    "reservoir_volume",
    "reservoir_pressure",
)

PARAMETERS: tuple[tuple[str, str], ...] = (
    *(
        (record, field.name)
        for record, kind in _RECORDS
        for field in fields(kind)
        if field.name not in _NOT_NUMBERS
    ),
    *FURTHER_PARAMETERS,
)
"""Record and field of every element of the parameter vector."""


_KNOWN = PARAMETERS[: -len(FURTHER_PARAMETERS)]


def parameter_values(vehicle: Vehicle, rail: Rail, surroundings: Surroundings) -> list[float]:
    """Parameter vector of one wheelset: the vehicle, the rail below it and what the scenario adds."""
    records = {
        "vehicle": vehicle,
        "brake": vehicle.brake,
        "contact": vehicle.contact,
        "rail": rail,
        "surroundings": surroundings,
    }
    return [*(getattr(records[record], field) for record, field in _KNOWN), *further_values(vehicle)]


WINDOW = ("start", "start_pressure", "fill_end", "vent_end", "reservoir", "share", "start_level", "goal")
"""What holds from one command of the valves to the next: times [s], pressures [Pa], share of the pressure that is asked
of the friction brake, and the level of the electrodynamic brake, there and where it goes to."""


class Kernels(NamedTuple):
    """CasADi functions of dense vectors; the first inputs of a kernel are the constants made for it."""

    stop_constants: Any  # (p) -> constants of loads, train and demand
    lane_constants: Any  # (p) -> constants of contact and axle
    window_constants: Any  # (p, window) -> constants of actuator
    kinks: Any  # (p, window) -> times at which the rate of the pressure jumps; most brakes have none
    loads: Any  # (constants, transfers) -> wheel load of each axle
    train: (
        Any  # (constants, speed, force of each axle, transfers, time) -> acceleration, resistance, transfers'
    )
    contact: Any  # (constants, load) -> stiffness there, and the reciprocal of the load: where a step begins
    axle: Any  # (constants, speed, axle states, load, torque, level, locked, contact, damping)
    #           -> force, axle states', slip, damping torque, torque that is passed on, torque of all brakes,
    #              torque of the electrodynamic brake
    slope: Any  # (constants, speed, axle states, load, contact, damping) -> slope of the wheel's acceleration
    actuator: Any  # (constants, time) -> pressure, torque, pressure without venting, damping, level
    demand: Any  # (constants, time) -> pressure that the build-up demands over the largest one

    @property
    def axles(self) -> int:
        """Number of wheelsets."""
        return int(self.loads.size1_out(0))

    @property
    def axle_states(self) -> int:
        """Number of states of one wheelset; the first is its wheel speed."""
        return int(self.axle.size1_in(2))

    @property
    def transfers(self) -> int:
        """Number of load transfers, whose rates are states as well."""
        return int(self.loads.size1_in(1)) // 2


def plant_kernels(plant: Plant, *, disturbed: bool) -> Kernels:
    """Trace a plant, whatever the numbers of its vehicle are.

    ``disturbed`` adds the vibration of the pads, T_d, to the torque.
    """
    blank: dict[str, Any] = {field.name: None for field in fields(Vehicle)}
    counts = {name: getattr(plant.vehicle, name) for name in ("wheelsets", "axles_per_bogie", "bodies")}
    brake: dict[str, Any] = {field.name: None for field in fields(Brake)}
    present = plant.vehicle.brake
    kinds = {name: getattr(present, name) for name in KINDS} | {
        "reservoir_volume": float(present.reservoir_volume > 0.0)
    }
    shape = plant.on(
        Vehicle(**{**blank, **counts, **blank_parts(plant.vehicle), "brake": Brake(**brake | kinds)})
    )
    return _memory.get((shape, disturbed), kinds_of(plant), lambda: _traced(shape, disturbed))


def kinds_of(plant: Plant) -> tuple[type, ...]:
    """Classes whose methods and properties make the kernels of a plant."""
    return type(plant), *(kind for _, kind in _RECORDS)


_memory: "Memory[Kernels]" = Memory(16)


def _traced(blank: Plant, disturbed: bool) -> Kernels:
    import casadi as ca

    p = ca.SX.sym("p", len(PARAMETERS))
    symbols: dict[str, dict[str, Any]] = {record: {} for record, _ in PARAMETERS}
    for index, (record, field) in enumerate(PARAMETERS):
        symbols[record][field] = p[index]
    vehicle = replace(
        blank.vehicle,
        **symbols["vehicle"],
        brake=replace(blank.vehicle.brake, **symbols["brake"]),
        contact=Contact(**symbols["contact"]),
        **symbolic_parts(blank.vehicle, dict(zip(PARAMETERS, p.elements(), strict=True))),
    )
    rail: dict[str, Any] = {field.name: None for field in fields(Rail)}
    track = Rail(**{**rail, **symbols["rail"]})
    functions = _functions(blank.on(vehicle), track, p, Surroundings(**symbols["surroundings"]), disturbed)
    stop_constants, (loads, train, demand) = hoist((*functions[:2], functions[7]), 1, "stop_constants")
    lane_constants, (contact, axle, slope) = hoist(functions[2:5], 1, "lane_constants")
    window_constants, (actuator,) = hoist(functions[5:6], 2, "window_constants")
    return Kernels(
        stop_constants=stop_constants,
        lane_constants=lane_constants,
        window_constants=window_constants,
        kinks=functions[6],
        loads=loads,
        train=train,
        contact=contact,
        axle=axle,
        slope=slope,
        actuator=actuator,
        demand=demand,
    )


def _functions(plant: Plant, track: Rail, p: Any, surroundings: Surroundings, disturbed: bool) -> list[Any]:
    """Trace the plant; the first input of every function is the parameter vector."""
    import casadi as ca

    brake = plant.vehicle.brake
    speed, load, demand, level, locked, time = (
        ca.SX.sym(name) for name in ("speed", "load", "torque", "level", "locked", "time")
    )
    begin, damped, force = ca.SX.sym("contact", 2), ca.SX.sym("damping"), ca.SX.sym("force", plant.axles)
    states, transfers = ca.SX.sym("states", plant.axle_states), ca.SX.sym("transfers", 2 * plant.transfers)
    braking_time = time + surroundings.braking_time
    loads = plant.wheel_loads(_elements(transfers))
    train = plant.train_motion(
        speed=speed,
        creep_forces=_elements(force),
        transfers=_elements(transfers),
        time=braking_time,
        grade_force=surroundings.grade_force,
    )
    contact = plant.axle_condition(time=0.0, wheel_load=load).stiffness
    damping = plant.axle_condition(time=braking_time, wheel_load=1.0).damping
    axle = plant.axle_motion(
        track,
        speed=speed,
        states=_elements(states),
        wheel_load=load,
        torque=demand,
        condition=AxleCondition(
            stiffness=begin[0] * adhesion.stiffness_growth(load * begin[1]), damping=damped
        ),
        dynamic_level=level,
    )
    wheel, *others = axle.rates
    rates = ca.vertcat(where(locked != 0.0, 0.0, wheel), *others)
    passed = where(locked != 0.0, 2.0 * plant.vehicle.wheel_radius * axle.creep_force, axle.brake_torque)
    window, dynamic = ca.SX.sym("window", len(WINDOW)), plant.vehicle.dynamic
    *pattern, share, start_level, goal = _elements(window)
    pressures = brake_model.pattern_pressure(
        brake,
        time,
        tuple(pattern),
        surroundings.braking_time,
        share=None if dynamic is None else share,
    )
    kinks = brake_model.kinks(
        brake, tuple(pattern), surroundings.braking_time, share=None if dynamic is None else share
    )
    there = (
        ca.SX(0.0)
        if dynamic is None
        else build_up(time - pattern[0], start_level, goal, dynamic.build_up_time)
    )
    torque = brake_model.braking_torque(brake, pressures[0])
    asked = brake_model.demanded_pressure(brake, braking_time) / brake.max_pressure
    if disturbed:
        torque *= 1.0 + brake_model.torque_disturbance(brake, braking_time)
    return [
        ca.Function("loads_kernel", [p, transfers], [ca.vertcat(*loads)]),
        ca.Function(
            "train_kernel",
            [p, speed, force, transfers, time],
            [train.acceleration, train.resistance, ca.vertcat(ca.SX(0, 1), *train.transfer_rates)],
        ),
        ca.Function("contact_kernel", [p, load], [ca.vertcat(contact, 1.0 / load)]),
        ca.Function(
            "axle_kernel",
            [p, speed, states, load, demand, level, locked, begin, damped],
            [
                *(axle.creep_force, rates, axle.slip, axle.damping_torque),
                *(passed, axle.brake_torque, axle.dynamic_torque),
            ],
        ),
        ca.Function(
            "slope_kernel",
            [p, speed, states, load, begin, damped],
            [ca.substitute(ca.jacobian(wheel, states)[0], ca.vertcat(demand, level), ca.SX.zeros(2))],
        ),
        ca.Function(
            "actuator_kernel", [p, window, time], [pressures[0], torque, pressures[1], damping, there]
        ),
        ca.Function("kinks_kernel", [p, window], [ca.vertcat(ca.SX(0, 1), *kinks)]),
        ca.Function("demand_kernel", [p, time], [asked]),
    ]


def _elements(vector: Any) -> tuple[Any, ...]:
    return tuple(vector[k] for k in range(vector.size1()))
