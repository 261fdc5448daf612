"""The slip dynamics as functions of named quantities, for claims on intervals.

Every number of vehicle and rail is a quantity of its own, so that nothing is rounded before the arithmetic of the
prover or of the checker begins.
"""

from collections.abc import Mapping
from dataclasses import replace
from math import pi
from typing import NamedTuple

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.claim import Variable, variable
from wspd_design.certificates.records import Point, Problem
from wspd_design.certificates.setting import domain
from wspd_design.model.generated import adhesion as generated
from wspd_design.model.number import Number, atan, exp
from wspd_design.model.slip import SlipDynamics, resistance, slip_dynamics, static_wheel_load
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

Values = Mapping[str, Number]
Parameters = tuple[float, float, float]
"""Mass [kg], inertia of a wheelset [kg m2] and mu0 [-]."""

VEHICLE = (
    ("wheel_radius", "m"),
    ("wheel_damping", "N m s"),
    ("resistance_constant", "N"),
    ("resistance_linear", "N s/m"),
    ("resistance_quadratic", "N s2/m2"),
)
CONTACT = (
    ("shear_modulus", "Pa"),
    ("semi_axis_rolling", "m"),
    ("semi_axis_lateral", "m"),
    ("kalker_c11", "-"),
    ("reference_load", "N"),
)
RAIL = (
    ("friction_ratio", "-"),
    ("friction_decay", "s/m"),
    ("adhesion_reduction", "-"),
    ("slip_reduction", "-"),
)
UNITS = {"slip": "-", "speed": "m/s", "mass": "kg", "wheelset inertia": "kg m2", "mu0": "-"}
"""Quantities that span the domain."""


def plant_variables(problem: Problem, **ranges: float | tuple[float, float]) -> tuple[Variable, ...]:
    """Return the quantities of the plant: five with the ranges of the domain, the rest known.

    Parameters
    ----------
    problem : Problem
        Domain, vehicle and rail.
    **ranges : float or tuple of float
        Other ranges or numbers for ``slip``, ``speed``, ``mass``, ``inertia`` (of a wheelset) or ``mu0``.

    Raises
    ------
    OutsideModel
        If the domain holds a speed, mass, inertia or friction that is not positive.
    """
    low, high = domain.box(problem)
    short = ("slip", "speed", "mass", "inertia", "mu0")
    spans = {name: (float(low[k]), float(high[k])) for k, name in enumerate(short)} | ranges
    spanning = tuple(
        variable(name, spans[key], unit) for (name, unit), key in zip(UNITS.items(), short, strict=True)
    )
    nominal = variable("nominal mass", problem.vehicle.mass, "kg")
    return (*spanning, nominal, *known_variables(problem.vehicle, problem.rail, ""))


def model_variables(vehicle: Vehicle, rail: Rail) -> tuple[Variable, ...]:
    """Return the quantities of a design model, all known."""
    spanning = (
        variable("model mass", vehicle.mass, "kg"),
        variable("model wheelset inertia", vehicle.wheelset_inertia, "kg m2"),
        variable("model mu0", rail.mu0, "-"),
    )
    return spanning + known_variables(vehicle, rail, "model ")


def known_variables(vehicle: Vehicle, rail: Rail, prefix: str) -> tuple[Variable, ...]:
    """Return the numbers of vehicle and rail that no range covers."""
    records = ((vehicle, VEHICLE), (vehicle.contact, CONTACT), (rail, RAIL))
    return tuple(
        variable(prefix + name, getattr(record, name), unit)
        for record, fields in records
        for name, unit in fields
    )


def records_of(values: Values, vehicle: Vehicle, rail: Rail, prefix: str = "") -> tuple[Vehicle, Rail]:
    """Return vehicle and rail with the quantities in place of their numbers."""

    def named(fields: tuple[tuple[str, str], ...]) -> dict[str, Number]:
        return {name: values[prefix + name] for name, _ in fields}

    contact = replace(vehicle.contact, **named(CONTACT))
    mass, inertia = values[f"{prefix}mass"], values[f"{prefix}wheelset inertia"]
    changed = replace(vehicle, mass=mass, wheelset_inertia=inertia, contact=contact, **named(VEHICLE))
    return changed, replace(rail, mu0=values[f"{prefix}mu0"], **named(RAIL))


def plant_records(problem: Problem, values: Values) -> tuple[Vehicle, Rail]:
    """Return the plant's records; its contact follows the load or not, as the problem says."""
    vehicle, rail = records_of(values, problem.vehicle, problem.rail)
    if not problem.contact_grows_with_load:
        load = vehicle.contact.reference_load * vehicle.mass / values["nominal mass"]
        vehicle = replace(vehicle, contact=replace(vehicle.contact, reference_load=load))
    return vehicle, rail


def plant_dynamics(problem: Problem, values: Values) -> SlipDynamics:
    """Evaluate the kernels of (19) for the plant."""
    vehicle, rail = plant_records(problem, values)
    return slip_dynamics(vehicle, rail, values["slip"], values["speed"])


class Forces(NamedTuple):
    """What (19) is made of, arranged so that each quantity stands in it as few times as possible."""

    creep_force: Number  # N per wheel
    deceleration: Number  # m/s2
    pole: Number  # 1/s, dF/dslip


EXPONENT = 2.0 / 3.0
"""Of the contact stiffness in the wheel load, as in the kernel."""


def plant_forces(problem: Problem, values: Values) -> Forces:
    """Arrange force and deceleration of the plant."""
    vehicle, rail = records_of(values, problem.vehicle, problem.rail)
    if problem.contact_grows_with_load:
        return forces(vehicle, rail, values["slip"], values["speed"])
    # Load over reference load does not depend on the mass; the stiffness per load falls with it.
    known = replace(vehicle, mass=values["nominal mass"])
    growth = static_wheel_load(known) / vehicle.contact.reference_load
    per_load = growth**EXPONENT / static_wheel_load(vehicle)
    return forces(vehicle, rail, values["slip"], values["speed"], per_load)


def model_forces(values: Values, vehicle: Vehicle, rail: Rail) -> Forces:
    """Arrange force and deceleration of a design model."""
    changed, track = records_of(values, vehicle, rail, "model ")
    return forces(changed, track, values["slip"], values["speed"])


def forces(
    vehicle: Vehicle, rail: Rail, slip: Number, speed: Number, per_load: Number | None = None
) -> Forces:
    """Arrange Polach's force and the deceleration so that mass and load cancel where they can.

    The kernels multiply a stiffness that grows with the power 2/3 of the load by the slip, divide by friction and
    load, and multiply by the load in the end. ``per_load`` is the stiffness over its value at the reference load
    and over the load [1/N].
    """
    contact = vehicle.contact
    load = static_wheel_load(vehicle)
    if per_load is None:
        per_load = (load / contact.reference_load) ** (EXPONENT - 1.0) / contact.reference_load
    stiffness = generated.contact_stiffness(
        contact.shear_modulus, contact.semi_axis_rolling, contact.semi_axis_lateral, contact.kalker_c11
    )
    falling = rail.mu0 * (1.0 - rail.friction_ratio) * exp(-rail.friction_decay * (slip * speed))
    friction = rail.mu0 * rail.friction_ratio + falling
    gradient = stiffness * per_load * slip / friction
    weak, slow = rail.adhesion_reduction * gradient, rail.slip_reduction * gradient
    adhesion, sliding = weak**2 + 1.0, slow**2 + 1.0
    used = friction * (weak / adhesion + atan(slow)) * 2.0 / pi
    gravity = 8.0 * constants().gravity / (2 * vehicle.wheelsets)
    deceleration = used * gravity + resistance(vehicle, speed) / vehicle.mass
    # The slope of force over load and speed: by the creep itself, and by the friction that falls with sliding.
    by_creep = (
        stiffness
        * per_load
        * (rail.adhesion_reduction * (2.0 - adhesion) / adhesion**2 + rail.slip_reduction / sliding)
    )
    shape = weak**3 * 2.0 / adhesion**2 + atan(slow) - slow / sliding
    slope = (by_creep / speed - rail.friction_decay * falling * shape) * (2.0 / pi)
    inertia = vehicle.wheel_inertia
    pole = (
        deceleration / speed
        - slope * (load * vehicle.wheel_radius**2 / inertia + (1.0 - slip) * gravity)
        - vehicle.wheel_damping / inertia
    )
    return Forces(creep_force=used * load, deceleration=deceleration, pole=pole)


def place(values: Mapping[str, float]) -> tuple[Point, ...]:
    """Return a point of the domain in the units that people read."""
    import numpy as np

    return domain.readable(np.array([values[name] for name in UNITS]))


def exact_plant(problem: Problem, parameters: Parameters | None = None) -> tuple[Vehicle, Rail]:
    """Return vehicle and rail with their numbers as balls, so that nothing is rounded.

    Parameters
    ----------
    problem : Problem
        The closed loop.
    parameters : tuple of float, optional
        Mass [kg], inertia of a wheelset [kg m2] and mu0 [-]; the nominal ones by default.
    """
    nominal = (problem.vehicle.mass, problem.vehicle.wheelset_inertia, problem.rail.mu0)
    mass, inertia, mu0 = parameters or nominal
    known = plant_variables(problem, mass=mass, inertia=inertia, mu0=mu0)
    return plant_records(problem, {v.name: point(v.low) for v in known})
