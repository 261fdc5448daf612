"""Wheels of cells that are braked from rolling, sample by sample: the plant of the attacker with the law in NumPy."""

from dataclasses import replace
from functools import cache

import numpy as np

import wspd_design as wd
from tests.attack.plant import creep_force, resistance, static_load
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.sampled_runs import BESIDE, BOX, Law, rolling, supplied
from tests.certificates.band.test_rolling_sample import over_samples
from wspd_design.certificates.theorems.band import contact_held
from wspd_design.certificates.theorems.from_rolling.braked_wheel import wheels_of
from wspd_design.certificates.theorems.from_rolling.cells import gathered
from wspd_design.certificates.theorems.from_rolling.sample import law_numbers
from wspd_design.certificates.theorems.slip_band.statement import NAMES, law_of
from wspd_design.parameters.bounds import Bounds

EIGHT = (*NAMES, "supply rate")
LOW, WET = "low-adhesion", "polach-wet"
SHARES = {
    LOW: dict(zip(EIGHT, (0.2, 0.1, 0.5, 0.15, 0.15, 0.07, 0.25, 0.08), strict=True)),
    WET: dict(zip(EIGHT, (0.08, 0.05, 0.3, 0.06, 0.06, 0.04, 0.15, 0.05), strict=True)),
}  # of each range, that a cell has
UNTIL = {LOW: 0.06, WET: 0.075}  # slip
SAMPLES = {LOW: 160, WET: 440}  # at most
PARTS = 4  # of the spans of a sample
STATES = ("y", "z", "p", "error", "way", "room")
TOLERANCE = 1e-8  # rad/s, of the simulation


@cache
def problem(rail):
    """The whole box; the running resistance is held at its own value."""
    found = contact_held(problem_of(1.0, rail=wd.load_rail(rail)))
    bounds = {name: ends for name, ends in found.bounds.items() if not name.startswith("resistance")}
    return replace(found, bounds=Bounds.of(bounds))


def cell(rail, places, scale=1.0):
    """Ranges of a cell whose place in each range of the box is given, from 0 to 1; in the middle where it is not."""
    found = {}
    for name in EIGHT:
        (low, high), share = problem(rail).span(name), scale * SHARES[rail][name]
        begin = low + (1.0 - share) * places.get(name, 0.5) * (high - low)
        found[name] = begin, begin + share * (high - low)
    return found


def cells_of(rail, seed=1):
    """Cells at ends of the box, in which supply and valves are fast or slow, some at random, and single wheels."""
    random = np.random.default_rng(seed)
    ends = [
        ({"supply rate": 1.0, "fill time": 0.0, "vent time": 0.0}, 0.2),
        ({"supply rate": 0.0, "fill time": 1.0, "vent time": 1.0}, 0.6),
        ({"supply rate": 1.0, "fill time": 0.93, "max torque": 1.0, "wheelset inertia": 0.0}, 0.6),
        ({"supply rate": 0.0, "fill time": 0.0, "max torque": 0.0, "wheelset inertia": 1.0}, 0.15),
        ({"mu0": 0.0, "mass": 0.0}, 0.7),
        ({"mu0": 1.0, "mass": 1.0}, 0.7),
    ]
    some = [({name: float(random.random()) for name in EIGHT}, 0.8) for _ in range(2)]
    # Of one wheel each: bounds are as close to it as they can be.
    single = [
        {name: float(random.random()) if k < 2 else float(random.integers(2)) for name in EIGHT}
        for k in range(6)
    ]
    # No valve that is slower than the supply.
    single = [(each | {"fill time": min(each["fill time"], 0.9)}, 0.0) for each in single]
    return [cell(rail, places, scale) for places, scale in (*ends, *some, *single)]


FASTEST = {"max torque": 1, "wheelset inertia": 0, "fill time": 0, "supply rate": 1}
"""Ends at which the torque moves a wheel most."""


def members(rail, numbers, count, seed=0):
    """Numbers of wheels of a cell, half of them at corners, the first with the fastest or slowest torque."""
    random, points = np.random.default_rng(seed), {}
    number = np.arange(count)
    corners, extreme = number < count // 2, number < min(8, count // 2)
    for name in (*BOX, *BESIDE):
        low, high = numbers.get(name, problem(rail).span(name))
        share = random.random(count)
        share = np.where(corners, np.round(share), share)
        if name in FASTEST:
            share = np.where(extreme, (number + FASTEST[name] + 1) % 2, share)
        elif name in ("mass", "mu0", "wheel radius"):
            share = np.where(extreme, number // (4 if name == "wheel radius" else 2) % 2, share)
        points[name] = low + share * (high - low)
    points["speed"] = np.full(count, float(problem(rail).speeds[1]))
    return points


def courses(rail, points, samples, until=np.inf, parts=PARTS):
    """States of wheels at each sample, until the slip of all is beyond one: a row for each sample."""
    stated = problem(rail)
    protection = stated.controller
    law = Law(protection, stated.slip)
    runs, h, inertia, found = rolling(stated, law, points), law.h, law.inertia, []
    plant, unit, slip = runs.plant, law.h / law.inertia, law.slip
    own, radius = plant.wheelset_inertia, plant.wheel_radius
    pads, damping = plant.max_torque / law.full, 2.0 * plant.wheel_damping * h / own
    kappa = (1.0 - slip) * plant.wheelsets * own / (radius**2 * plant.mass)
    g, beta = pads * inertia / own, (1.0 - law.theta) / law.theta
    for _ in range(samples):
        memory, available, seen = runs.memory, law.full * supplied(runs), runs.torque / pads
        fill, vent, mean = law.pulses(memory, runs.wheel, seen, available)
        (speed, wheel), (force, turning, held, _), torque = over_samples(
            plant, runs.since, runs.speed, runs.wheel, runs.torque, fill, vent, h, parts
        )
        wanted, rate = law.desired(memory)
        ahead = law.tracking.ahead
        error = runs.wheel - wanted + ahead * h * ((memory.friction - seen) / inertia - rate)
        k, begins = law.tracking.approach_rate, law.slew / law.tracking.approach_rate**2
        curve = np.sqrt(np.maximum(2.0 * law.slew * (error - 0.5 * begins), 0.0))
        pull = np.where(error > begins, curve, k * error)
        friction = 2.0 * radius * force * h / own - damping * turning
        lost = kappa * (friction + damping * turning) + (1.0 - slip) * h * held / (radius * plant.mass)
        p = memory.observed - runs.wheel
        found.append(
            {
                "y": g * seen * unit - friction - lost,
                "z": memory.friction * unit - friction + (g - 1.0) * seen * unit - beta * p,
                "p": p,
                "error": h * rate + lost,
                "way": unit * (memory.friction - inertia * (rate - pull) - seen),
                "room": unit * (available - seen),
                "pull": h * pull,
                "whole": fill >= h * (1.0 - 1e-12),
                "slip": 1.0 - radius * runs.wheel / runs.speed,
                "speed": runs.speed,
                "torque": unit * seen,
                "change": unit * (torque / pads - seen),
                "friction": friction,
                **moving(plant, law, runs, g * seen * unit),
            }
        )
        runs = replace(
            runs,
            memory=law.measured(memory, mean, speed, wheel),
            since=runs.since + h,
            measured=wheel,
            speed=speed,
            wheel=wheel,
            torque=torque,
        )
        if (found[-1]["slip"] > until).all():
            break
    return {name: np.array([each[name] for each in found]) for name in found[0]}


def moving(plant, law, runs, pulled):
    """Motion q at the moment of a sample, and S q, by a complex step."""
    radius, unit = plant.wheel_radius, law.h / plant.wheelset_inertia
    slip = 1.0 - radius * runs.wheel / runs.speed
    force = creep_force(plant, slip + 1e-30j, runs.speed, static_load(plant))
    damping = 2.0 * plant.wheel_damping * unit
    friction = 2.0 * radius * force.real * unit - damping * runs.wheel
    slowing = 2.0 * plant.wheelsets * force.real + resistance(plant, runs.speed)
    lost = (1.0 - law.slip) * law.h * slowing / (radius * plant.mass)
    motion = pulled - friction - lost * (1.0 + (law.slip - slip) / (1.0 - law.slip))
    slope = radius / runs.speed * 2.0 * radius * unit * force.imag / 1e-30 + damping
    return {"motion": motion, "level": slope * motion, "slope": slope}


@cache
def law(rail):
    """Numbers of the law."""
    return law_numbers(law_of(problem(rail).controller))


def wheels(rail, numbers):
    """Numbers of the wheels of cells, as the proof has them."""
    of_law = law_of(problem(rail).controller)
    return gathered([wheels_of(problem(rail), of_law, each) for each in numbers])


@cache
def simulated(rail, seed=3, count=16):
    """Courses of members of all cells until they are caught, their cells, and whether the valve filled so far."""
    drawn = [members(rail, each, count, seed + k) for k, each in enumerate(cells_of(rail))]
    points = {name: np.concatenate([each[name] for each in drawn]) for name in drawn[0]}
    found = courses(rail, points, SAMPLES[rail], UNTIL[rail] + 0.001)
    cell_of = np.repeat(np.arange(len(drawn)), count)
    so_far = np.ones(
        found["whole"].shape, dtype=bool
    )  # before the third sample nothing is measured of the torque
    so_far[2:] = np.logical_and.accumulate(found["whole"][2:], axis=0)
    return found, cell_of, so_far
