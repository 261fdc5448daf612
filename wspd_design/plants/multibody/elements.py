"""Forces of springs, dampers, rods, bump stops and gears: each acts on two bodies, equal and opposite.

All of them follow from an energy and a dissipation function of the coordinates, so that no force creates energy.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from wspd_design.model.number import Number, maximum, sqrt
from wspd_design.plants.multibody.kinematics import BodyMotion, first_coordinates, marker
from wspd_design.plants.multibody.records import BumpStop, Gear, Multibody, Rod, Spring
from wspd_design.plants.multibody.vectors import (
    ZERO,
    Vector,
    add,
    cross,
    dot,
    inward,
    outward,
    scaled,
    subtract,
)

_AXES = ("x", "y", "z")
_TURNS = {"roll": 3, "pitch": 4, "yaw": 5}


@dataclass(slots=True)
class Forces:
    """What acts on the bodies: a force and a moment on each frame, and forces on single coordinates."""

    on_frames: dict[str, tuple[Vector, Vector]] = field(default_factory=dict)  # N and N m, in track axes
    on_coordinates: dict[int, Number] = field(default_factory=dict)
    potential: Number = 0.0  # J
    dissipation: Number = 0.0  # W

    def push(self, body: str, force: Vector, arm: Vector = ZERO) -> None:
        """Let a force act on the frame of a body, at the end of an arm from its center of gravity."""
        before, moment = self.on_frames.get(body, (ZERO, ZERO))
        self.on_frames[body] = add(before, force), add(moment, cross(arm, force))

    def twist(self, coordinate: int, moment: Number) -> None:
        """Let a generalized force act on one coordinate."""
        self.on_coordinates[coordinate] = self.on_coordinates.get(coordinate, 0.0) + moment


def act(model: Multibody, bodies: Mapping[str, BodyMotion], q: Any, v: Any, gravity: Number) -> Forces:
    """Return the forces of all elements and of gravity."""
    forces = Forces()
    for body in model.bodies:
        weight = model.mass(body) * gravity
        forces.push(body.name, (0.0, 0.0, -weight))
        forces.potential += weight * bodies[body.name].displacement[2]
    for spring in model.springs:
        _spring(model, spring, bodies, forces)
        _turns(model, spring, q, v, forces)
    for rod in model.rods:
        _rod(model, rod, bodies, forces)
    for stop in model.stops:
        _bump_stop(model, stop, bodies, forces)
    for gear in model.gears:
        _torsion(model, gear, q, v, forces)
    return forces


class _Relative(NamedTuple):
    """The second body against the first at one point."""

    displacement: Vector  # m, in axes of the first body
    velocity: Vector  # m/s, in axes of the first body, as seen from there
    apart: Vector  # m, in track axes
    arms: tuple[Vector, Vector]  # m, in track axes, from each center of gravity to where the second body is


def _relative(model: Multibody, element: Spring | BumpStop, bodies: Mapping[str, BodyMotion]) -> _Relative:
    """Return how one body moves against the other; a force on the first acts where the second is, without a moment."""
    first, second = (bodies[name] for name in element.between)
    on_first, on_second = (marker(model, motion, element.at) for motion in (first, second))
    apart = subtract(on_second.displacement, on_first.displacement)
    displacement = inward(first.axes, apart)
    arm = add(model.offset(element.at, first.body.at), displacement)
    drift = inward(first.axes, subtract(on_second.velocity, first.velocity))
    return _Relative(
        displacement=displacement,
        velocity=subtract(drift, cross(first.frame_turning, arm)),
        apart=apart,
        arms=(add(on_first.arm, apart), on_second.arm),
    )


def _pair(forces: Forces, between: tuple[str, str], force: Vector, arms: tuple[Vector, Vector]) -> None:
    """Let a force act on the second body, and its reaction on the first."""
    forces.push(between[0], scaled(-1.0, force), arms[0])
    forces.push(between[1], force, arms[1])


def _spring(model: Multibody, spring: Spring, bodies: Mapping[str, BodyMotion], forces: Forces) -> None:
    keys = {key: [f"{spring.kind}.{key}_{axis}" for axis in _AXES] for key in ("stiffness", "damping")}
    if not any(name in model.numbers for names in keys.values() for name in names):
        return
    stiffness, damping = ([model.numbers.get(name, 0.0) for name in names] for names in keys.values())
    relative = _relative(model, spring, bodies)
    elastic = [k * d for k, d in zip(stiffness, relative.displacement, strict=True)]
    viscous = [c * d for c, d in zip(damping, relative.velocity, strict=True)]
    x, y, z = (-(a + b) for a, b in zip(elastic, viscous, strict=True))
    _pair(forces, spring.between, outward(bodies[spring.between[0]].axes, (x, y, z)), relative.arms)
    forces.potential += 0.5 * sum(a * d for a, d in zip(elastic, relative.displacement, strict=True))
    forces.dissipation += sum(b * d for b, d in zip(viscous, relative.velocity, strict=True))
    if spring.carries:
        _carry(model.preloads[spring.name], spring.between, relative, bodies, forces)


def _carry(
    preload: Number,
    between: tuple[str, str],
    relative: _Relative,
    bodies: Mapping[str, BodyMotion],
    forces: Forces,
) -> None:
    """Let a preload act, half along the vertical of each body.

    A loaded spring is symmetric: tilting one of its ends tilts its force by half as much. Where it acts is half at the
    point of one body and half at that of the other.
    """
    first, second = (bodies[name].axes[2] for name in between)
    on_first, on_second = relative.arms
    _pair(forces, between, scaled(0.5 * preload, first), relative.arms)
    back = subtract(on_first, relative.apart), subtract(on_second, relative.apart)
    _pair(forces, between, scaled(0.5 * preload, second), back)
    forces.potential -= 0.5 * preload * dot(add(first, second), relative.apart)


def _turns(model: Multibody, spring: Spring, q: Any, v: Any, forces: Forces) -> None:
    """Let springs and dampers of relative turns act, on the coordinates themselves."""
    starts = first_coordinates(model)
    for turn, k in _TURNS.items():
        keys = [f"{spring.kind}.{key}_{turn}" for key in ("stiffness", "damping")]
        if not any(key in model.numbers for key in keys):
            continue
        stiffness, damping = (model.numbers.get(key, 0.0) for key in keys)
        first, second = (starts[name] + k for name in spring.between)
        angle, rate = q[second] - q[first], v[second] - v[first]
        moment = stiffness * angle + damping * rate
        forces.twist(first, moment)
        forces.twist(second, -moment)
        forces.potential += 0.5 * stiffness * angle**2
        forces.dissipation += damping * rate**2


def _rod(model: Multibody, rod: Rod, bodies: Mapping[str, BodyMotion], forces: Forces) -> None:
    first, second = (
        marker(model, bodies[name], end) for name, end in zip(rod.between, rod.ends, strict=True)
    )
    at_rest, apart = model.offset(rod.ends[1], rod.ends[0]), subtract(second.displacement, first.displacement)
    line = add(at_rest, apart)
    rest_length, length = sqrt(dot(at_rest, at_rest)), sqrt(dot(line, line))
    # The difference of both lengths, without the loss of digits.
    elongation = (2.0 * dot(at_rest, apart) + dot(apart, apart)) / (length + rest_length)
    direction = scaled(1.0 / length, line)
    rate = dot(direction, subtract(second.velocity, first.velocity))
    stiffness = model.numbers[f"{rod.kind}.stiffness"]
    damping = model.numbers.get(f"{rod.kind}.damping", 0.0)
    force = scaled(-(stiffness * elongation + damping * rate), direction)
    _pair(forces, rod.between, force, (first.arm, second.arm))
    forces.potential += 0.5 * stiffness * elongation**2
    forces.dissipation += damping * rate**2


def _bump_stop(model: Multibody, stop: BumpStop, bodies: Mapping[str, BodyMotion], forces: Forces) -> None:
    relative = _relative(model, stop, bodies)
    k = _AXES.index(stop.axis)
    force, energy = 0.0, 0.0
    for start, gain in _slopes(model, stop):
        for sign in (1.0, -1.0):
            beyond = maximum(sign * relative.displacement[k] - start, 0.0)
            force += -sign * gain * beyond
            energy += 0.5 * gain * beyond**2
    along = tuple(force if j == k else 0.0 for j in range(3))
    axes = bodies[stop.between[0]].axes
    _pair(forces, stop.between, outward(axes, (along[0], along[1], along[2])), relative.arms)
    forces.potential += energy


def _slopes(model: Multibody, stop: BumpStop) -> Iterator[tuple[Number, Number]]:
    """Yield each travel at which the slope of the force changes, and by how much; the last slope goes on."""
    travel, force = (
        [model.numbers[f"{stop.kind}.{column}.{k}"] for k in range(1, stop.points + 1)]
        for column in ("travel", "force")
    )
    before: Number = 0.0
    for k in range(stop.points - 1):
        slope = (force[k + 1] - force[k]) / (travel[k + 1] - travel[k])
        yield travel[k], slope - before
        before = slope


def torsion(model: Multibody, gear: Gear) -> dict[int, Number]:
    """Return by coordinates what the twist between rotor and pinion is made of."""
    starts = first_coordinates(model)
    housing, rotor = model.body(gear.housing), model.body(gear.rotor)
    ratio = model.numbers[f"{gear.kind}.ratio"]
    return {
        starts[rotor.name]: 1.0,
        starts[rotor.on] + _TURNS["pitch"]: 1.0,
        starts[housing.name]: -(1.0 + ratio),
        starts[housing.on] + _TURNS["pitch"]: ratio,
    }


def gear_moment(model: Multibody, gear: Gear, q: Any, v: Any) -> Number:
    """Return the moment in the torsion spring between rotor and pinion [N m]."""
    twist, rate = _twist(model, gear, q, v)
    return model.numbers[f"{gear.kind}.stiffness"] * twist + model.numbers[f"{gear.kind}.damping"] * rate


def _twist(model: Multibody, gear: Gear, q: Any, v: Any) -> tuple[Number, Number]:
    shares = torsion(model, gear)
    twist, rate = (sum(share * of[k] for k, share in shares.items()) for of in (q, v))
    return twist, rate


def _torsion(model: Multibody, gear: Gear, q: Any, v: Any, forces: Forces) -> None:
    twist, rate = _twist(model, gear, q, v)
    moment = gear_moment(model, gear, q, v)
    for k, share in torsion(model, gear).items():
        forces.twist(k, -share * moment)
    forces.potential += 0.5 * model.numbers[f"{gear.kind}.stiffness"] * twist**2
    forces.dissipation += model.numbers[f"{gear.kind}.damping"] * rate**2
