"""The slip dynamics as functions of named quantities, for claims on intervals and for points of the domain.

Every number of vehicle and rail is a quantity of its own, so that nothing is rounded before the arithmetic of the
prover or of the checker begins. With the quantities "axle load share" k and "train deceleration" a among the values,
the functions describe one axle of the vehicle, whatever the others do: its wheels carry k times the static load, and

    F = -(1/v) [R^2 f(k) / I + (1 - slip) a] + B_W (1 - slip) / I.

Without them they describe the axle at static load, and a = (f_d + n f) / m with the n wheels of the vehicle.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.claim import Variable, variable
from wspd_design.certificates.quantities import AXLE, PLANT, QUANTITIES, TABLE, Record
from wspd_design.certificates.records import Point, Problem
from wspd_design.certificates.setting import domain
from wspd_design.model.generated import adhesion as generated
from wspd_design.model.number import Number, atan, exp
from wspd_design.model.slip import SlipDynamics, resistance, slip_dynamics, static_wheel_load
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

Values: TypeAlias = Mapping[str, Number]

LOAD_SHARE, DECELERATION = AXLE
AXLE_PLANT = PLANT + AXLE
"""What (19) depends on at any axle."""

OTHERS = tuple(name for name in PLANT if name not in domain.BASIC)
"""Numbers that a claim holds at their nominal values with ``hold=OTHERS``: all of the plant but mass, inertia, mu0."""


def plant_variables(
    problem: Problem,
    *,
    uses: Sequence[str] = PLANT,
    hold: Iterable[str] = (),
    ranges: Mapping[str, float | Ends] | None = None,
) -> tuple[Variable, ...]:
    """Return the quantities of a claim about the plant: every number with bounds varies.

    Parameters
    ----------
    problem : Problem
        Domain, vehicle and rail.
    uses : sequence of str
        Names in the table of what the claim uses, :data:`PLANT` or :data:`AXLE_PLANT`, with numbers of the brake
        where they count.
    hold : iterable of str
        Names that keep their nominal value, which the claim has to say.
    ranges : mapping, optional
        Other ranges or numbers than those of the domain, by names.

    Raises
    ------
    OutsideModel
        If the domain holds a value that has no meaning, such as a mass that is not positive.
    ValueError
        If a name is not in use.
    """
    low, high = domain.box(problem, uses)
    spans: dict[str, float | Ends] = {name: (float(low[k]), float(high[k])) for k, name in enumerate(uses)}
    stated = dict(ranges or {})
    held = {name: problem.nominal(name) for name in hold if name not in stated}
    unknown = [name for name in (*stated, *held) if name not in spans]
    if unknown:
        raise ValueError(f"{', '.join(unknown)}: not among the quantities of the claim, {', '.join(uses)}")
    spans |= held | stated
    nominal = variable("nominal mass", problem.vehicle.mass, "kg")
    return (*(variable(name, spans[name], QUANTITIES[name].unit) for name in uses), nominal)


def model_variables(vehicle: Vehicle, rail: Rail) -> tuple[Variable, ...]:
    """Return the quantities of a design model, all known."""
    return known_variables(vehicle, rail, "model ")


def known_variables(vehicle: Vehicle, rail: Rail, prefix: str) -> tuple[Variable, ...]:
    """Return the numbers of vehicle and rail that (19) depends on, without their ranges."""
    records: dict[Record, object] = {"vehicle": vehicle, "contact": vehicle.contact, "rail": rail}
    return tuple(
        variable(prefix + row.name, getattr(records[row.record], row.field), row.unit)
        for row in TABLE
        if row.record in records
    )


def records_of(values: Values, vehicle: Vehicle, rail: Rail, prefix: str = "") -> tuple[Vehicle, Rail]:
    """Return vehicle and rail with the quantities in place of their numbers; those of the brake if there are any."""

    def named(record: Record) -> dict[str, Number]:
        rows = (row for row in TABLE if row.record == record)
        return {row.field: values[prefix + row.name] for row in rows}

    brake = {
        row.field: values[prefix + row.name]
        for row in TABLE
        if row.record == "brake" and prefix + row.name in values
    }
    changed = replace(
        vehicle,
        contact=replace(vehicle.contact, **named("contact")),
        brake=replace(vehicle.brake, **brake),
        **named("vehicle"),
    )
    return changed, replace(rail, **named("rail"))


def plant_records(problem: Problem, values: Values) -> tuple[Vehicle, Rail]:
    """Return the plant's records; its contact follows the load or not, as the problem says."""
    vehicle, rail = records_of(values, problem.vehicle, problem.rail)
    if not problem.contact_grows_with_load:
        # The slope depends on load / reference load; scaling both keeps it.
        load = vehicle.contact.reference_load * vehicle.mass / values["nominal mass"]
        vehicle = replace(vehicle, contact=replace(vehicle.contact, reference_load=load))
    return vehicle, rail


def complete(problem: Problem, values: Values) -> dict[str, Number]:
    """Return values of all numbers of the plant: the nominal ones where none is given.

    For numbers, arrays and balls; a claim names all its quantities instead.
    """
    vehicle, rail = problem.vehicle, problem.rail
    records: dict[Record, object] = {"vehicle": vehicle, "contact": vehicle.contact, "rail": rail}
    nominal = {row.name: getattr(records[row.record], row.field) for row in TABLE if row.record in records}
    return {**nominal, "nominal mass": vehicle.mass, **values}


def plant_with(problem: Problem, values: Values) -> tuple[Vehicle, Rail]:
    """Return vehicle and rail with some numbers changed, the others at their nominal values.

    Parameters
    ----------
    problem : Problem
        The closed loop.
    values : mapping
        From names in the table to numbers, arrays or balls.
    """
    return plant_records(problem, complete(problem, values))


def exact_plant(problem: Problem, values: Mapping[str, float] | None = None) -> tuple[Vehicle, Rail]:
    """Return vehicle and rail with their numbers as balls, so that nothing is rounded.

    Parameters
    ----------
    problem : Problem
        The closed loop.
    values : mapping, optional
        Numbers that differ from the nominal ones, by their names in the table.
    """
    return plant_records(problem, {name: point(x) for name, x in complete(problem, values or {}).items()})


def plant_dynamics(problem: Problem, values: Values) -> SlipDynamics:
    """Evaluate the kernels of (19) for the plant; see the head of the module for one axle of several."""
    vehicle, rail = plant_records(problem, values)
    slip, speed = values["slip"], values["speed"]
    if LOAD_SHARE not in values:
        return slip_dynamics(vehicle, rail, slip, speed)
    load = static_wheel_load(vehicle) * values[LOAD_SHARE]
    return slip_dynamics(vehicle, rail, slip, speed, wheel_load=load, deceleration=values[DECELERATION])


def dynamics_at(
    problem: Problem,
    points: "Array",
    names: Sequence[str] = domain.BASIC,
    held: Mapping[str, float] | None = None,
) -> SlipDynamics:
    """Slip dynamics (19) of the plant at many points of the domain at once.

    Parameters
    ----------
    problem : Problem
        Domain, vehicle and rail.
    points : ndarray
        One point per row, the columns as in ``names``, SI units.
    names : sequence of str
        Slip, speed and the numbers that vary.
    held : mapping, optional
        One point, such as a worst one, from which the other uncertain numbers are taken; without it they are nominal.
    """
    others = {name: held[name] for name in domain.uncertain(problem) if name in held} if held else {}
    columns = {name: points[..., k] for k, name in enumerate(names)}
    return plant_dynamics(problem, complete(problem, {**others, **columns}))


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
    slip, speed = values["slip"], values["speed"]
    share, given = values.get(LOAD_SHARE), values.get(DECELERATION)
    if problem.contact_grows_with_load:
        return forces(vehicle, rail, slip, speed, share=share, deceleration=given)
    # Load over reference load does not depend on the mass; the stiffness per load falls with it.
    known = replace(vehicle, mass=values["nominal mass"])
    growth = static_wheel_load(known) / vehicle.contact.reference_load
    if share is None:
        per_load = growth**EXPONENT / static_wheel_load(vehicle)
    else:
        per_load = (growth * share) ** (EXPONENT - 1.0) * growth / static_wheel_load(vehicle)
    return forces(vehicle, rail, slip, speed, per_load, share=share, deceleration=given)


def model_forces(values: Values, vehicle: Vehicle, rail: Rail) -> Forces:
    """Arrange force and deceleration of a design model."""
    changed, track = records_of(values, vehicle, rail, "model ")
    return forces(changed, track, values["slip"], values["speed"])


def forces(
    vehicle: Vehicle,
    rail: Rail,
    slip: Number,
    speed: Number,
    per_load: Number | None = None,
    *,
    share: Number | None = None,
    deceleration: Number | None = None,
) -> Forces:
    """Arrange Polach's force and the deceleration so that mass and load cancel where they can.

    The kernels multiply a stiffness that grows with the power 2/3 of the load by the slip, divide by friction and
    load, and multiply by the load in the end. ``per_load`` is the stiffness over its value at the reference load
    and over the load [1/N]; ``share`` the load over the static load, and ``deceleration`` that of the train if it is
    not the one of wheels that are all like this one [m/s2].
    """
    contact = vehicle.contact
    load = static_wheel_load(vehicle) if share is None else static_wheel_load(vehicle) * share
    if per_load is None:
        per_load = (load / contact.reference_load) ** (EXPONENT - 1.0) / contact.reference_load
    stiffness = generated.contact_stiffness(
        contact.shear_modulus, contact.semi_axis_rolling, contact.semi_axis_lateral, contact.kalker_c11
    )
    fading = (1.0 - rail.friction_ratio) * exp(-rail.friction_decay * (slip * speed))
    friction = rail.mu0 * (rail.friction_ratio + fading)
    gradient = stiffness * per_load * slip / friction
    weak, slow = rail.adhesion_reduction * gradient, rail.slip_reduction * gradient
    # 1/(x + 1/x) is x/(1 + x^2), tighter on intervals, and the sign of its slope is that of 1/x^2 - 1.
    used = friction * (1.0 / (weak + 1.0 / weak) + atan(slow)) * 2.0 / pi
    adhesion, sliding = weak**2 + 1.0, slow**2 + 1.0
    # The slope of force over load and speed: by the creep itself, and by the friction that falls with sliding.
    by_creep = (
        stiffness
        * per_load
        * (rail.adhesion_reduction * (2.0 - adhesion) / adhesion**2 + rail.slip_reduction / sliding)
    )
    shape = weak**3 * 2.0 / adhesion**2 + atan(slow) - slow / sliding
    slope = (by_creep / speed - rail.friction_decay * rail.mu0 * fading * shape) * (2.0 / pi)
    inertia = vehicle.wheel_inertia
    per_slope = load * vehicle.wheel_radius**2 / inertia
    if deceleration is None:
        gravity = constants().gravity  # per adhesion, where every wheel brakes alike
        deceleration = used * gravity + resistance(vehicle, speed) / vehicle.mass
        per_slope = per_slope + (1.0 - slip) * gravity
    pole = deceleration / speed - slope * per_slope - vehicle.wheel_damping / inertia
    return Forces(creep_force=used * load, deceleration=deceleration, pole=pole)


def place(values: Mapping[str, float], names: Sequence[str] = domain.BASIC) -> tuple[Point, ...]:
    """Return a point of the domain in the units that people read: the quantities of these names."""
    import numpy as np

    return domain.readable(np.array([float(values[name]) for name in names]), names)
