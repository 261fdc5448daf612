"""The kernels of the plant in the compiled closed loop: its own functions, traced by CasADi.

The numbers of vehicle and rail are inputs of the kernels, so that one compiled loop serves every vehicle of as many
axles, every rail and every sample of parameters.
"""

from dataclasses import fields, replace
from typing import Any, NamedTuple

from wspd_design.codegen.further_numbers import blank_parts, symbolic_parts
from wspd_design.codegen.hoisting import hoist
from wspd_design.codegen.memory import Memory
from wspd_design.codegen.plant_numbers import KINDS, PARAMETERS, RAIL, RECORDS, Surroundings
from wspd_design.model import adhesion
from wspd_design.model import brake as brake_model
from wspd_design.model import slip as slip_model
from wspd_design.model.further_brakes import build_up
from wspd_design.model.number import maximum, where
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle
from wspd_design.plants.protocol import (
    TRACK_CHANNELS,
    AxleCondition,
    CoupledPlant,
    Plant,
    SplitPlant,
    is_coupled,
    is_split,
)

_LEAST_SLIDING = 1e-9  # m/s, below which the secant of the creep curve is not asked for

WINDOW = ("start", "start_pressure", "fill_end", "vent_end", "reservoir", "share", "start_level", "goal")
"""What holds from one command of the valves to the next: times [s], pressures [Pa], share of the pressure that is asked
of the friction brake, and the level of the electrodynamic brake, there and where it goes to."""


class Kernels(NamedTuple):
    """CasADi functions of dense vectors; the first inputs of a kernel are the constants made for it."""

    window_constants: Any  # (p, window) -> constants of actuator
    kinks: Any  # (p, window) -> times at which the rate of the pressure jumps; most brakes have none
    actuator: Any  # (constants, time) -> pressure, torque, pressure without venting, damping, level
    stop_constants: Any  # (p) -> constants of demand and of the train
    demand: Any  # (constants, time) -> pressure that the build-up demands over the largest one
    lane_constants: Any  # (p) -> constants of what belongs to a wheelset
    of_plant: "SplitKernels | CoupledKernels"

    @property
    def coupled(self) -> bool:
        """Tell whether the right-hand side is one kernel."""
        return isinstance(self.of_plant, CoupledKernels)

    @property
    def split(self) -> "SplitKernels":
        """Those of a plant that splits."""
        assert isinstance(self.of_plant, SplitKernels)
        return self.of_plant

    @property
    def whole(self) -> "CoupledKernels":
        """Those of a coupled plant."""
        assert isinstance(self.of_plant, CoupledKernels)
        return self.of_plant

    @property
    def slope(self) -> Any:
        """Slope of the wheel's acceleration, by which steps are chosen."""
        return self.of_plant.slope

    @property
    def axles(self) -> int:
        """Number of wheelsets."""
        return self.of_plant.axles

    @property
    def axle_states(self) -> int:
        """Number of states of one wheelset; the first is its wheel speed."""
        return self.of_plant.axle_states

    @property
    def rest_states(self) -> int:
        """Number of states beyond the train speed and those of the wheelsets."""
        return self.of_plant.rest_states


class SplitKernels(NamedTuple):
    """Kernels of a plant that splits into wheelsets, loads and train."""

    loads: Any  # (constants, rest) -> wheel load of each axle
    train: Any  # (constants, speed, force of each axle, rest, time) -> acceleration, resistance, rest'
    contact: Any  # (constants, load) -> stiffness there, and the reciprocal of the load: where a step begins
    axle: Any  # (constants, speed, axle states, load, torque, level, locked, contact, damping)
    #           -> force, axle states', slip, damping torque, torque that is passed on, torque of all brakes,
    #              torque of the electrodynamic brake
    slope: Any  # (constants, speed, axle states, load, contact, damping) -> slope of the wheel's acceleration

    @property
    def axles(self) -> int:
        """Number of wheelsets."""
        return int(self.loads.size1_out(0))

    @property
    def axle_states(self) -> int:
        """Number of states of one wheelset."""
        return int(self.axle.size1_in(2))

    @property
    def rest_states(self) -> int:
        """Number of further states."""
        return int(self.loads.size1_in(1))


class CoupledKernels(NamedTuple):
    """Kernels of a coupled plant."""

    brakes: Any  # (constants, axle states, torque, level) -> torque of all brakes, of the electrodynamic one, warming
    slope: Any  # as of a plant that splits, by the fastest of its motions; the contact is not used
    vehicle_constants: Any  # (p, numbers, rail numbers of the axles) -> constants of vehicle
    vehicle: Any  # (constants, speed, wheel speeds, rest, torques, locked, damping, track, time)
    #              -> acceleration, wheel speeds', rest', forces, slips, damping torques, torques that are passed on,
    #                 loads, resistance, further traces

    @property
    def axles(self) -> int:
        """Number of wheelsets."""
        return int(self.vehicle.size1_in(2))

    @property
    def axle_states(self) -> int:
        """Number of states of one wheelset."""
        return int(self.brakes.size1_in(1))

    @property
    def rest_states(self) -> int:
        """Number of further states."""
        return int(self.vehicle.size1_in(3))

    @property
    def numbers(self) -> int:
        """Numbers of the plant beyond those of the vehicle."""
        return int(self.vehicle_constants.size1_in(1))

    @property
    def further(self) -> int:
        """Numbers of the further traces."""
        return int(self.vehicle.size1_out(9))


def plant_kernels(plant: Plant, *, disturbed: bool) -> Kernels:
    """Trace a plant, whatever the numbers of its vehicle are.

    ``disturbed`` adds the vibration of the pads, T_d, to the torque.
    """
    blank: dict[str, Any] = {field.name: None for field in fields(Vehicle)}
    counts = {
        name: getattr(plant.vehicle, name) for name in ("wheelsets", "axles_per_bogie", "bodies", "multibody")
    }
    brake: dict[str, Any] = {field.name: None for field in fields(Brake)}
    present = plant.vehicle.brake
    kinds = {name: getattr(present, name) for name in KINDS} | {
        "reservoir_volume": float(present.reservoir_volume > 0.0)
    }
    filed = plant.as_filed() if is_coupled(plant) else plant  # its numbers are inputs
    shape = filed.on(
        Vehicle(**{**blank, **counts, **blank_parts(plant.vehicle), "brake": Brake(**brake | kinds)})
    )
    return _memory.get((shape, disturbed), kinds_of(plant), lambda: _traced(shape, disturbed))


def kinds_of(plant: Plant) -> tuple[type, ...]:
    """Classes whose methods and properties make the kernels of a plant."""
    return type(plant), *(kind for _, kind in RECORDS)


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
    traced = _Traced(blank.on(vehicle), track, p, Surroundings(**symbols["surroundings"]))
    return traced.kernels(disturbed)


class _Traced:
    """Traces the parts of a plant; the first input of every function is the parameter vector."""

    def __init__(self, plant: Plant, track: Rail, p: Any, surroundings: Surroundings) -> None:
        import casadi as ca

        self.plant, self.track, self.p, self.surroundings = plant, track, p, surroundings
        names = ("speed", "load", "torque", "level", "locked", "time", "damping")
        self.speed, self.load, self.torque, self.level, self.locked, self.time, self.damping = (
            ca.SX.sym(name) for name in names
        )
        self.states = ca.SX.sym("states", plant.axle_states)
        self.rest = ca.SX.sym("rest", plant.rest_states)
        self.braking_time = self.time + surroundings.braking_time

    def kernels(self, disturbed: bool) -> Kernels:
        """All kernels; ``disturbed`` adds the vibration of the pads to the torque."""
        plant, (demand, kinks, actuator) = self.plant, self._valves(disturbed)
        window_constants, (actuator,) = hoist([actuator], 2, "window_constants")
        of_plant: SplitKernels | CoupledKernels
        if is_coupled(plant):
            stop_constants, (demand,) = hoist([demand], 1, "stop_constants")
            of_lane = [self._brakes(plant), self._steepness(plant)]
            lane_constants, (brakes, slope) = hoist(of_lane, 1, "lane_constants")
            vehicle_constants, (vehicle,) = hoist([self._vehicle(plant)], 3, "vehicle_constants")
            of_plant = CoupledKernels(
                brakes=brakes, slope=slope, vehicle_constants=vehicle_constants, vehicle=vehicle
            )
        else:
            assert is_split(plant)
            of_stop, of_lane = self._of_stop(plant), self._of_lane(plant)
            stop_constants, (loads, train, demand) = hoist((*of_stop, demand), 1, "stop_constants")
            lane_constants, (contact, axle, slope) = hoist(of_lane, 1, "lane_constants")
            of_plant = SplitKernels(loads=loads, train=train, contact=contact, axle=axle, slope=slope)
        return Kernels(
            window_constants=window_constants,
            kinks=kinks,
            actuator=actuator,
            stop_constants=stop_constants,
            demand=demand,
            lane_constants=lane_constants,
            of_plant=of_plant,
        )

    def _of_stop(self, plant: SplitPlant) -> list[Any]:
        import casadi as ca

        force, rest = ca.SX.sym("force", plant.axles), _elements(self.rest)
        train = plant.train_motion(
            speed=self.speed,
            creep_forces=_elements(force),
            transfers=rest,
            time=self.braking_time,
            grade_force=self.surroundings.grade_force,
        )
        return [
            ca.Function("loads_kernel", [self.p, self.rest], [ca.vertcat(*plant.wheel_loads(rest))]),
            ca.Function(
                "train_kernel",
                [self.p, self.speed, force, self.rest, self.time],
                [train.acceleration, train.resistance, ca.vertcat(ca.SX(0, 1), *train.transfer_rates)],
            ),
        ]

    def _of_lane(self, plant: SplitPlant) -> list[Any]:
        import casadi as ca

        speed, load, states, locked = self.speed, self.load, self.states, self.locked
        begin, damped = ca.SX.sym("contact", 2), self.damping
        contact = plant.axle_condition(time=0.0, wheel_load=load).stiffness
        axle = plant.axle_motion(
            self.track,
            speed=speed,
            states=_elements(states),
            wheel_load=load,
            torque=self.torque,
            condition=AxleCondition(
                stiffness=begin[0] * adhesion.stiffness_growth(load * begin[1]), damping=damped
            ),
            dynamic_level=self.level,
        )
        wheel, *others = axle.rates
        rates = ca.vertcat(where(locked != 0.0, 0.0, wheel), *others)
        passed = where(locked != 0.0, 2.0 * plant.vehicle.wheel_radius * axle.creep_force, axle.brake_torque)
        free = ca.vertcat(self.torque, self.level)
        slope = ca.substitute(ca.jacobian(wheel, states)[0], free, ca.SX.zeros(2))
        return [
            ca.Function("contact_kernel", [self.p, load], [ca.vertcat(contact, 1.0 / load)]),
            ca.Function(
                "axle_kernel",
                [self.p, speed, states, load, self.torque, self.level, locked, begin, damped],
                [
                    *(axle.creep_force, rates, axle.slip, axle.damping_torque),
                    *(passed, axle.brake_torque, axle.dynamic_torque),
                ],
            ),
            ca.Function("slope_kernel", [self.p, speed, states, load, begin, damped], [slope]),
        ]

    def _brakes(self, plant: CoupledPlant) -> Any:
        import casadi as ca

        brakes = plant.brake_torques(_elements(self.states), self.torque, self.level)
        return ca.Function(
            "brakes_kernel",
            [self.p, self.states, self.torque, self.level],
            [brakes.braking, brakes.dynamic, ca.vertcat(ca.SX(0, 1), *brakes.warming)],
        )

    def _steepness(self, plant: CoupledPlant) -> Any:
        """Slope of the acceleration of a rigid wheelset in its place, times what the fastest motion is faster.

        A sliding wheel is soft along the rail, but across it the force still grows with the secant of the creep curve.
        """
        import casadi as ca

        vehicle, speed, load, wheel = plant.vehicle, self.speed, self.load, self.states[0]
        sliding = speed - vehicle.wheel_radius * wheel
        force = adhesion.creep_force(
            slip_model.slip_ratio(speed, wheel, vehicle.wheel_radius),
            abs(sliding),
            load,
            self.track,
            adhesion.contact_stiffness(vehicle.contact, load),
        )
        tangent = ca.jacobian(force, wheel)
        secant = vehicle.wheel_radius * force / maximum(abs(sliding), _LEAST_SLIDING)
        per_force = self.surroundings.creep_growth * 2.0 * vehicle.wheel_radius / vehicle.wheelset_inertia
        return ca.Function(
            "slope_kernel",
            [self.p, speed, self.states, load, ca.SX.sym("contact", 2), self.damping],
            [-per_force * maximum(abs(tangent), abs(secant))],
        )

    def _vehicle(self, plant: CoupledPlant) -> Any:
        import casadi as ca

        axles, rail_numbers = plant.axles, len(RAIL)
        numbers = ca.SX.sym("numbers", len(plant.number_names))
        wheels, torques, locked, damping = (
            ca.SX.sym(name, axles) for name in ("wheels", "torques", "locked", "damping")
        )
        track = ca.SX.sym("track", len(TRACK_CHANNELS) * axles)
        # Element by element, each for all axles, as the loop has them.
        rail = ca.SX.sym("rail", rail_numbers * axles)
        rails = tuple(
            replace(self.track, **dict(zip(RAIL, _elements(rail)[axle::axles], strict=True)))
            for axle in range(axles)
        )
        resistance = slip_model.resistance(plant.vehicle, self.speed, self.surroundings.grade_force)
        if plant.vehicle.track_brake is not None:
            resistance += plant.track_brake_force(self.speed, self.braking_time)
        motion = plant.motion(
            rails,
            numbers=_elements(numbers),
            speed=self.speed,
            wheel_speeds=_elements(wheels),
            rest=_elements(self.rest),
            torques=_elements(torques),
            locked=_elements(locked),
            damping=_elements(damping),
            track=tuple(_elements(track)[k * axles : (k + 1) * axles] for k in range(len(TRACK_CHANNELS))),
            resistance=resistance,
            grade_force=self.surroundings.grade_force,
        )
        return ca.Function(
            "vehicle_kernel",
            [
                *(self.p, numbers, rail),
                *(self.speed, wheels, self.rest, torques, locked, damping, track, self.time),
            ],
            [
                motion.acceleration,
                *(_column(motion.wheel_rates), _column(motion.rest_rates), _column(motion.creep_forces)),
                *(_column(motion.slips), damping * wheels, _column(motion.transmitted)),
                *(_column(motion.wheel_loads), resistance),
                _column(tuple(number for row in motion.further for number in row)),
            ],
        )

    def _valves(self, disturbed: bool) -> list[Any]:
        """Demand of the build-up, kinks of the pressure, and the actuator of a wheelset."""
        import casadi as ca

        vehicle, p = self.plant.vehicle, self.p
        brake, dynamic, begun = vehicle.brake, vehicle.dynamic, self.surroundings.braking_time
        window = ca.SX.sym("window", len(WINDOW))
        *pattern, share, start_level, goal = _elements(window)
        asked = None if dynamic is None else share
        pressures = brake_model.pattern_pressure(brake, self.time, tuple(pattern), begun, share=asked)
        kinks = brake_model.kinks(brake, tuple(pattern), begun, share=asked)
        there = (
            ca.SX(0.0)
            if dynamic is None
            else build_up(self.time - pattern[0], start_level, goal, dynamic.build_up_time)
        )
        torque = brake_model.braking_torque(brake, pressures[0])
        demand = brake_model.demanded_pressure(brake, self.braking_time) / brake.max_pressure
        damping = self.plant.wheel_damping(self.braking_time)
        if disturbed:
            torque *= 1.0 + brake_model.torque_disturbance(brake, self.braking_time)
        return [
            ca.Function("demand_kernel", [p, self.time], [demand]),
            ca.Function("kinks_kernel", [p, window], [_column(kinks)]),
            ca.Function(
                "actuator_kernel",
                [p, window, self.time],
                [pressures[0], torque, pressures[1], damping, there],
            ),
        ]


def _column(numbers: tuple[Any, ...]) -> Any:
    import casadi as ca

    return ca.vertcat(ca.SX(0, 1), *numbers)


def _elements(vector: Any) -> tuple[Any, ...]:
    return tuple(vector[k] for k in range(vector.size1()))
