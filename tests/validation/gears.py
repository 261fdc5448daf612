"""Vehicles of every running gear, and their wheel loads from the equilibrium of each of their parts."""

import math
from dataclasses import replace

import numpy as np

from wspd_design.parameters.gear import contradiction
from wspd_design.parameters.loading import load_vehicle

GRAVITY = 9.81


def vehicle_on(name, *, shares=(), **changes):
    """A vehicle whose masses add up; ``shares`` are those of the brakes."""
    base = load_vehicle("er24pc")
    made = replace(base, name=name, **changes, brake=replace(base.brake, max_torque=9e3, axle_shares=shares))
    assert contradiction(made) == ""
    supports = made.wheelsets // made.axles_per_bogie
    return replace(made, mass=made.bodies * made.body_mass + supports * made.bogie_mass)


SINGLE = {
    "axles_per_bogie": 1,
    "bogie_mass": 1.6e3,
    "bogie_height": 0.5,
    "wheelbase": 0.0,
    "wheelset_inertia": 110.0,
}
BOGIE = {"bogie_mass": 7e3, "bogie_height": 0.55, "traction_rod_height": 0.6, "wheelset_inertia": 130.0}
GEARS = {
    vehicle.name: vehicle
    for vehicle in (
        vehicle_on("two single axles", wheelsets=2, body_mass=22e3, bogie_spacing=9.0, **SINGLE),
        vehicle_on("three single axles", wheelsets=3, body_mass=30e3, bogie_spacing=4.5, **SINGLE),
        vehicle_on(
            "two two-axle bogies", wheelsets=4, body_mass=32e3, bogie_spacing=19.0, wheelbase=2.5, **BOGIE
        ),
        vehicle_on(
            "three two-axle bogies", wheelsets=6, body_mass=70e3, bogie_spacing=6.0, wheelbase=2.7, **BOGIE
        ),
        vehicle_on(
            "two three-axle bogies",
            wheelsets=6,
            axles_per_bogie=3,
            body_mass=80e3,
            bogie_spacing=11.0,
            wheelbase=4.0,
            **BOGIE,
        ),
        vehicle_on(
            "three bodies on four bogies",
            wheelsets=8,
            bodies=3,
            body_mass=18e3,
            bogie_spacing=12.0,
            wheelbase=2.4,
            **BOGIE,
        ),
        vehicle_on(
            "two bodies on three axles", wheelsets=3, bodies=2, body_mass=12e3, bogie_spacing=8.0, **SINGLE
        ),
    )
}


def loads_by_hand(vehicle, axle_forces, deceleration, grade):
    """Load of each axle [N] from the equilibrium of every body and support, one after the other.

    A support is a bogie or a single axle. Unknown are the loads of the axles and of each support by each body on it.
    Every part has its weight across the track, and along it its inertia less its weight there; the creep forces act at
    the rail, and bodies hold their supports at the height of the traction rods. No resistance acts.
    """
    slope = math.atan(grade)
    across, held = GRAVITY * math.cos(slope), deceleration - GRAVITY * math.sin(slope)
    per, axles, bodies = vehicle.axles_per_bogie, vehicle.wheelsets, vehicle.bodies
    supports, spacing, rod = axles // per, vehicle.bogie_spacing, vehicle.traction_rod_height
    # (body, support, place in front of the middle of the body) of each unknown force of a body on a support
    if bodies == 1:
        resting = [(0, k, (0.5 * (supports - 1) - k) * spacing) for k in range(supports)]
    else:
        resting = [(b, b + end, (0.5 - end) * spacing) for b in range(bodies) for end in (0, 1)]
    place = [0.0] if per == 1 else list(np.linspace(0.5, -0.5, per) * vehicle.wheelbase)
    own = vehicle.bogie_mass * held
    moments = []  # of each support about the rail
    for k in range(supports):
        creep = sum(axle_forces[per * k : per * (k + 1)])
        moments.append(own * vehicle.bogie_height + (creep - own) * rod)
    rows, right = [], []

    def equation(terms, value):
        row = np.zeros(axles + len(resting))
        for index, factor in terms:
            row[index] += factor
        rows.append(row)
        right.append(value)

    for k in range(supports):
        loads = [per * k + j for j in range(per)]
        carried = [(axles + n, -1.0) for n, (_, s, _) in enumerate(resting) if s == k]
        equation([*((n, 1.0) for n in loads), *carried], vehicle.bogie_mass * across)
        if per > 1:
            equation(list(zip(loads, place, strict=True)), moments[k])
        for j in range(per - 2):  # springs alike: a straight line over three axles
            equation([(loads[j], 1.0), (loads[j + 1], -2.0), (loads[j + 2], 1.0)], 0.0)
    for body in range(bodies):
        forces = [(axles + n, x) for n, (b, _, x) in enumerate(resting) if b == body]
        equation([(n, 1.0) for n, _ in forces], vehicle.body_mass * across)
        pitching = vehicle.body_mass * held * (vehicle.body_height - rod)
        equation(forces, pitching + (sum(moments) / bodies if per == 1 else 0.0))
        for j in range(len(forces) - 2):  # the same for the supports of one body
            equation([(forces[j][0], 1.0), (forces[j + 1][0], -2.0), (forces[j + 2][0], 1.0)], 0.0)
    assert len(rows) == axles + len(resting)
    return np.linalg.solve(np.array(rows), np.array(right))[:axles]
