"""State and plant of a wheelset that is followed from rolling, in affine forms over a box of their numbers.

The state is written in the sliding speed, in which rolling is 0 for every train speed, and in the innovation of the
observer, so that what belongs together cancels.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.theorems.slip_band.statement import NAMES as STATED
from wspd_design.model.adhesion import contact_stiffness
from wspd_design.model.slip import wheels
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle


class State(NamedTuple):
    """State of the loop at a sample, before the law computes."""

    speed: Affine  # m/s
    sliding: Affine  # m/s, of the rim against the rail
    innovation: Affine  # m/s, wheel speed less what the observer expects, times the radius
    friction: Affine  # N m, observed torque
    torque: Affine  # N m
    acceleration: Affine  # m/s2, of the train as the law has it
    change: Affine  # m/s, of the train speed over the last sample
    supply: Affine  # -, demanded pressure over the full one


SCALES = np.array([1.0, 1.0, 0.3, 1e3, 1e3, 0.1, 0.02, 0.05])  # of the states, to compare symbols


@dataclass(frozen=True, slots=True, kw_only=True)
class Plant:
    """The numbers of wheel, train and brake in the combinations that count, each with an uncertainty of its own."""

    vehicle: Vehicle  # what is held at its nominal value
    rail: Rail
    radius: Affine  # m
    curvature: Affine  # 1/m, over the radius
    mass: Affine  # 1/kg, one over it
    inertia: Affine  # 1/(kg m2), one over that of a wheelset
    gripping: Affine  # m/s2, of the train by friction alone, over the force that is used
    turning: Affine  # m/s2, of the rim
    gradient: Affine  # -, initial slope of the force over mu0 times the load
    train_stiffness: (
        Affine  # m/s2, of the train over the slip, by contacts that adhere; mu0 has no part in it
    )
    rim_stiffness: Affine  # m/s2, of the rim
    effect: Affine  # m/s2 of the rim for a N m of the nominal torque
    fill_rate: Affine  # 1/s
    vent_rate: Affine  # 1/s
    supply_rate: Affine  # 1/s


NUMBERS = (*STATED, "supply rate")
"""Numbers that differ from box to box; those of the band, and the rate of the supply."""


def plant_of(vehicle: Vehicle, rail: Rail, full: float, numbers: Mapping[str, Affine], first: int) -> Plant:
    """Return the plant.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        What the names do not say.
    full : float
        Nominal torque at full pressure, in which the law counts [N m].
    numbers : mapping of str to form
        Of :data:`NUMBERS`.
    first : int
        First of the symbols that stand for the errors of combinations.
    """
    mass, inertia, radius, mu0, torque, fill, vent, supply = (numbers[name] for name in NUMBERS)
    named = (
        combined.named(first + k)
        for k, combined in enumerate(_combined(vehicle, full, mass, inertia, radius, mu0, torque))
    )
    curvature, over_mass, over_inertia, turning, gradient, train_stiffness, rim_stiffness, effect = named
    return Plant(
        vehicle=vehicle,
        rail=rail,
        radius=radius,
        curvature=curvature,
        mass=over_mass,
        inertia=over_inertia,
        gripping=mu0 * constants().gravity,
        turning=turning,
        gradient=gradient,
        train_stiffness=train_stiffness,
        rim_stiffness=rim_stiffness,
        effect=effect,
        fill_rate=fill.inverse().named(first + 8),
        vent_rate=vent.inverse().named(first + 9),
        supply_rate=supply,
    )


def _combined(
    vehicle: Vehicle, full: float, mass: Affine, inertia: Affine, radius: Affine, mu0: Affine, torque: Affine
) -> tuple[Affine, ...]:
    over_inertia = inertia.inverse()
    load = mass * (constants().gravity / wheels(vehicle))
    stiffness = float(contact_stiffness(vehicle.contact, 1.0))  # of a load of 1 N, and with its power 2/3
    return (
        radius.inverse(),
        mass.inverse(),
        over_inertia,
        (radius**2 * over_inertia) * (load * mu0) * 2.0,
        load.power(-1.0 / 3.0) * mu0.inverse() * stiffness,
        load.power(-1.0 / 3.0) * (stiffness * constants().gravity),
        (radius**2 * over_inertia) * load.power(2.0 / 3.0) * (2.0 * stiffness),
        (radius * over_inertia) * (torque * (1.0 / full)),
    )
