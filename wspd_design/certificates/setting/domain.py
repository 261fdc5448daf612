"""The box of states and parameters on which a claim is made, and the slip dynamics anywhere inside it."""

from dataclasses import replace
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import OutsideModel
from wspd_design.certificates.records import Point, Problem
from wspd_design.model.number import Number
from wspd_design.model.slip import SlipDynamics, slip_dynamics
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SLIP, SPEED, MASS, INERTIA, MU0 = range(5)
"""Columns of an array of points of the domain, in SI units; the inertia is that of a wheelset."""

KMH = 3.6


def box(problem: Problem) -> tuple["Array", "Array"]:
    """Lowest and highest corner of the domain, in the order of the columns.

    Raises
    ------
    OutsideModel
        If the box holds a speed, mass, inertia or friction that is not positive.
    """
    import numpy as np

    ranges = (
        ("slip", problem.slips),
        ("speed", problem.speeds),
        ("mass", problem.mass_bounds),
        ("wheelset inertia", problem.inertia_bounds),
        ("mu0", problem.mu0_bounds),
    )
    for name, (low, high) in ranges:
        if low <= 0.0:
            raise OutsideModel(f"the {name} range {low:g} to {high:g} holds values that are not positive")
    return np.array([low for _, (low, _) in ranges]), np.array([high for _, (_, high) in ranges])


def slip_held(problem: Problem) -> tuple["Array", "Array"]:
    """Return the domain with the slip at its reference."""
    low, high = box(problem)
    low[SLIP] = high[SLIP] = problem.slip
    return low, high


def varied(problem: Problem, mass: Number, inertia: Number, mu0: Number) -> tuple[Vehicle, Rail]:
    """Return the plant with other uncertain parameters [kg, kg m2 per wheelset, -]."""
    contact = problem.vehicle.contact
    if not problem.contact_grows_with_load:
        # The slope depends on load / reference load; scaling both keeps it.
        contact = replace(contact, reference_load=contact.reference_load * mass / problem.vehicle.mass)
    vehicle = replace(problem.vehicle, mass=mass, wheelset_inertia=inertia, contact=contact)
    return vehicle, replace(problem.rail, mu0=mu0)


def dynamics(problem: Problem, points: "Array") -> SlipDynamics:
    """Slip dynamics (19) of the plant at many points of the domain at once."""
    vehicle, rail = varied(problem, points[:, MASS], points[:, INERTIA], points[:, MU0])
    return slip_dynamics(vehicle, rail, points[:, SLIP], points[:, SPEED])


def readable(point: "Array") -> tuple[Point, ...]:
    """One point of the domain in the units that people read."""
    return (
        Point(name="slip", value=float(point[SLIP]), unit="-"),
        Point(name="speed", value=float(point[SPEED]) * KMH, unit="km/h"),
        Point(name="mass", value=float(point[MASS]), unit="kg"),
        Point(name="wheelset inertia", value=float(point[INERTIA]), unit="kg m2"),
        Point(name="mu0", value=float(point[MU0]), unit="-"),
    )


def described(problem: Problem) -> str:
    """The domain in words."""
    low, high = (speed * KMH for speed in problem.speeds)
    return (
        f"slip {problem.slips[0]:g} to {problem.slips[1]:g}, {low:.3g} to {high:.3g} km/h, "
        f"mass {problem.mass_bounds[0]:g} to {problem.mass_bounds[1]:g} kg, "
        f"wheelset inertia {problem.inertia_bounds[0]:g} to {problem.inertia_bounds[1]:g} kg m2, "
        f"mu0 {problem.mu0_bounds[0]:g} to {problem.mu0_bounds[1]:g}"
    )
