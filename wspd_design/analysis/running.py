"""A multibody vehicle in steady running, rolling or braked at a slip, and its equations of motion linearized there."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from wspd_design.analysis.modes import SmallMotion
from wspd_design.model.hertz import contact_from_radii
from wspd_design.model.number import maximum
from wspd_design.model.wheel_rail import WheelRail, wheel_rail
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, steel
from wspd_design.parameters.records import Rail
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.motion import wheel_on_rail
from wspd_design.plants.multibody.preloads import balanced, rest_function
from wspd_design.plants.multibody.records import Multibody, gears_of
from wspd_design.plants.multibody.wheels import Irregularity

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Matrix = NDArray[np.float64]

_STEPS = 30  # of Newton's method
_PLANE = ("x", "z", "pitch", "turn")  # directions of motion in the plane of symmetry
_HELD = 1e-9  # of the weight: what may be left of it in steady running
_FASTEST = 150.0  # m/s
_FORWARD = 0  # the coordinate of the vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class RunningVehicle:
    """Equations of motion of a vehicle on its rails with their derivatives, for any speed and torques.

    They are the balance M(q) v' - (all forces) = 0, which the plants of the closed loop solve for v', without running
    resistance and the damping of the wheels.
    """

    model: Multibody  # with the preloads of its conicity
    balance: Any  # casadi.Function of q, v, v', torques, track, conicity, preloads
    rest: Any  # of :func:`wspd_design.plants.multibody.preloads.rest_function`

    def with_conicity(self, conicity: float) -> "RunningVehicle":
        """Return the same vehicle on other cones."""
        return replace(self, model=balanced(self.model.with_numbers({"conicity": conicity}), self.rest))

    @property
    def neutral(self) -> "dict[str, Matrix]":
        """Motion that no force opposes, by the coordinate that stands for it: all forward, each wheelset turning."""
        import numpy as np

        names = self.model.coordinates
        forward = np.zeros(len(names))
        forward[[names.index(f"{body.name}.x") for body in self.model.bodies if not body.on]] = 1.0
        found = {names[_FORWARD]: forward}
        for wheelset in self.model.wheelset_names:
            turning = np.zeros(len(names))
            turning[names.index(f"{wheelset}.pitch")] = 1.0
            for gear in gears_of(self.model, wheelset):
                turning[names.index(f"{gear.rotor}.turn")] = -self.model.numbers[f"{gear.kind}.ratio"]
            found[f"{wheelset}.pitch"] = turning
        return found


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyRunning:
    """A state in which wheels and suspension are at rest against the vehicle, and small motion about it.

    The torques of a braked vehicle hold the slips while it slows down; its speed is taken as fixed.
    """

    speed: float  # m/s
    acceleration: float  # m/s2
    torques: "Matrix"  # (axles,), N m, braking
    slips: "Matrix"  # (axles,), positive when braking
    loads: "Matrix"  # (axles, 2), N, of left and right wheel
    coordinates: "Matrix"  # (n,), from rest on the track, m and rad
    sideways: float  # N or N m, the largest force that is left out of the plane of symmetry
    motion: SmallMotion
    from_inputs: (
        "Matrix"  # (n, 2 axles), generalized forces of 1 N m on each axle, then of 1 m of track under each
    )
    to_outputs: (
        "Matrix"  # (4 axles, 2 n + 2 axles), slip and load of each wheel by coordinates, rates, inputs
    )


def contact_of(model: Multibody, *, lateral_slope: float = 1.0) -> WheelRail:
    """Return the contact of the wheels of a vehicle by Hertz and Kalker at their mean load, steel on steel.

    ``lateral_slope`` is that of :func:`wspd_design.model.wheel_rail.wheel_rail`.
    """
    ellipse = contact_from_radii(
        wheel_load=model.numbers["mass"] * constants().gravity / len(model.wheel_names),
        wheel_radius=model.numbers["wheel_radius"],
        rail_radius=steel().rail_crown,
        young=steel().young,
        poisson=steel().poisson,
    )
    return wheel_rail(ellipse, poisson=steel().poisson, lateral_slope=lateral_slope)


def full_slope(rail: Rail) -> Rail:
    """Return a rail on which small longitudinal creep meets the whole slope of Kalker's theory."""
    return replace(rail, name=f"{rail.name} with Kalker's slope", adhesion_reduction=1.0, slip_reduction=1.0)


def running_vehicle(model: Multibody, contact: WheelRail, rail: Rail) -> RunningVehicle:
    """Set up the equations of a vehicle on one rail.

    Parameters
    ----------
    model : Multibody
        The vehicle; its preloads are worked out anew for each conicity.
    contact : WheelRail
        Of every wheel.
    rail : Rail
        Friction under all wheels.
    """
    import casadi as ca

    rest = rest_function(model)
    n, axles = len(model.coordinates), model.wheelsets
    q, v, a = (ca.SX.sym(name, n) for name in ("q", "v", "a"))
    torques, track, conicity = ca.SX.sym("t", axles), ca.SX.sym("z", axles), ca.SX.sym("c")
    preloads = ca.SX.sym("p", len(model.preload_names))
    on_symbols = model.with_numbers({"conicity": conicity}).with_preloads(
        dict(zip(model.preload_names, ca.vertsplit(preloads), strict=True))
    )
    under = tuple(Irregularity(vertical=each) for each in ca.vertsplit(track))
    equations = mechanics(on_symbols, q, v, irregularities=under)
    force = equations.force + ca.mtimes(equations.brake_directions, torques)
    reference = maximum(v[_FORWARD], constants().slip_regularization_speed)
    outputs = []
    for wheel in equations.wheels:
        touching = wheel_on_rail(on_symbols, wheel, contact, rail, reference)
        force[wheel.first : wheel.first + 6] += touching.force
        outputs += [touching.slip, touching.load]
    left = ca.mtimes(equations.mass_matrix, a) - force
    seen = ca.vertcat(*outputs)
    derivatives = [
        ca.jacobian(expression, each)
        for expression in (left, seen)
        for each in (q, v, ca.vertcat(torques, track))
    ]
    return RunningVehicle(
        model=balanced(model, rest),
        rest=rest,
        balance=ca.Function(
            "balance",
            [q, v, a, torques, track, conicity, preloads],
            [left, equations.mass_matrix, seen, *derivatives],
        ),
    )


def steady(vehicle: RunningVehicle, speed: float, *, slip: float = 0.0) -> SteadyRunning:
    """Find steady running straight on: rolling, or with the torques that hold one slip at all wheelsets.

    Newton's method on the balance of all coordinates in the plane of symmetry. Unknown are these coordinates but those
    of neutral motion, the acceleration of the train, and of each wheelset its speed where it rolls or its torque where
    it slides. A sliding wheelset has the speed (1 - slip) V/R and slows down with the train; all bodies share the speed
    V and its rate. Sideways the vehicle stays where it is: a sliding wheel guides so little that the weight of a
    gearbox beside the middle would take seconds to push the vehicle to one rail, long after the stop has gone on.

    Parameters
    ----------
    vehicle : RunningVehicle
        With its conicity.
    speed : float
        Of the train [m/s].
    slip : float
        Of all wheelsets against their nominal radius, in [0, 1) [-]; 0: no torque, the wheels roll freely.

    Raises
    ------
    UserError
        If speed or slip are out of range, or there is no such state.
    """
    import numpy as np

    _check(vehicle, speed, slip)
    model, neutral = vehicle.model, vehicle.neutral
    n, axles = len(model.coordinates), model.wheelsets
    plane = [k for k, name in enumerate(model.coordinates) if name.rpartition(".")[2] in _PLANE]
    kept = [k for k in plane if model.coordinates[k] not in neutral]
    forward, *others = neutral.values()
    turning = np.array(others).T
    radius = model.numbers["wheel_radius"]
    q, torques, track = np.zeros(n), np.zeros(axles), np.zeros(axles)
    spins, acceleration = np.full(axles, (1.0 - slip) * speed / radius), 0.0
    unknown = torques if slip else spins  # of the axles
    preloads = [model.preloads[name] for name in model.preload_names]
    for _ in range(_STEPS):
        v = forward * speed + turning @ spins
        slowing = forward + turning @ spins / speed
        found = vehicle.balance(
            q, v, slowing * acceleration, torques, track, model.numbers["conicity"], preloads
        )
        left, mass, seen, by_place, by_rate, by_input, *derivatives = (np.array(each) for each in found)
        if np.abs(left[plane]).max() < _HELD * model.numbers["mass"]:
            break
        of_axles = by_input[:, :axles] if slip else by_rate @ turning
        columns = np.column_stack([by_place[:, kept], of_axles, mass @ slowing])
        step = np.linalg.solve(columns[plane], -left[plane, 0])
        q[kept] += step[: len(kept)]
        unknown += step[len(kept) : -1]
        acceleration += step[-1]
    else:
        raise UserError(
            f"multibody vehicle {model.name} has no steady state at slip {slip:g} and {speed:g} m/s that Newton's "
            f"method finds in {_STEPS} steps; choose a smaller slip or another speed"
        )
    return SteadyRunning(
        speed=speed,
        acceleration=acceleration,
        torques=torques,
        slips=seen[::2, 0].reshape(axles, 2).mean(axis=1),
        loads=seen[1::2, 0].reshape(axles, 2),
        coordinates=q,
        motion=SmallMotion(
            coordinates=model.coordinates,
            kinds=tuple(body.kind for body in model.bodies for _ in body.coordinates),
            mass=mass,
            damping=by_rate,
            stiffness=by_place,
            neutral=neutral,
        ),
        sideways=float(np.abs(np.delete(left, plane)).max()),
        from_inputs=-by_input,
        to_outputs=np.hstack(derivatives),
    )


def _check(vehicle: RunningVehicle, speed: float, slip: float) -> None:
    """Refuse what is no state of running."""
    if not 0.0 <= slip < 1.0:
        raise UserError(f"slip = {slip:g} must lie in [0, 1); for percent write for example 0.14 or 14 %")
    if not constants().slip_regularization_speed <= speed < _FASTEST:
        raise UserError(
            f"speed = {speed:g} m/s must be at least {constants().slip_regularization_speed:g} m/s, where slip is a "
            f"ratio, and below {_FASTEST:g} m/s (540 km/h)"
        )
    model = vehicle.model
    braked = {brake.wheelset for brake in model.brakes}
    free = [name for name in model.wheelset_names if name not in braked]
    if slip and free:
        raise UserError(
            f"{', '.join(free)} of multibody vehicle {model.name} has no brake that could hold slip = {slip:g}; "
            "add one to its file, or leave the slip out, so that all wheels roll"
        )
