"""Wheels that come from rolling, in plain NumPy: plant and law written once more, from their equations."""

import math
from types import SimpleNamespace

import numpy as np

import wspd_design.parameters.loading as loading
from wspd_design.certificates.theorems.slip_band.statement import NAMES, law_of
from wspd_design.model.adhesion import contact_stiffness

EIGHT = (*NAMES, "supply rate")


def drawn(numbers, count, seed=0):
    """Members of a cell: half of them corners."""
    rng = np.random.default_rng(seed)
    parts = rng.random((len(EIGHT), count))
    parts[:, : count // 2] = np.round(parts[:, : count // 2])
    low, high = (np.array([numbers[name][k] for name in EIGHT])[:, None] for k in (0, 1))
    return low + parts * (high - low)


def course(problem, members, samples, inside=24):
    """State of all members at each sample: P, z, p, x, e, E, slip and speed, in units of a sample."""
    law, vehicle, rail = law_of(problem.controller), problem.vehicle, problem.rail
    mass, inertia, radius, mu0, torque, fill, vent, supplied = members
    h, assumed, rim, full = (
        float(each) for each in (law.sample_time, law.inertia, law.radius, law.full_torque)
    )
    slip, k, ahead = float(law.slip), float(law.approach_rate), float(law.ahead)
    slew, share = float(law.torque_slew) / assumed, float(law.time_share)
    longest = float(law.fill_time) / h, float(law.vent_time) / h
    theta, kept = math.exp(-float(law.observer_rate) * h), math.exp(-h / float(law.acceleration_time))
    load = mass * loading.constants().gravity / (2 * vehicle.wheelsets)
    stiffness = contact_stiffness(vehicle.contact, 1.0) * load ** (2 / 3)
    pads, step = torque / full, h / inside
    speed = np.full(mass.size, problem.speeds[1])
    wheel, brake, supply = speed / radius, np.zeros(mass.size), np.zeros(mass.size)
    observed, friction, mean, known = wheel.copy(), *(np.zeros(mass.size) for _ in range(3))
    before, found = speed, []

    def rates(speed, wheel, brake):
        sliding = (speed - radius * wheel) / speed
        used = (
            load
            * mu0
            * (
                (1 - rail.friction_ratio) * np.exp(-rail.friction_decay * sliding * speed)
                + rail.friction_ratio
            )
        )
        reach = stiffness * sliding / used
        adhering = rail.adhesion_reduction * reach
        force = 2 * used / math.pi * (adhering / (1 + adhering**2) + np.arctan(rail.slip_reduction * reach))
        drag = (
            vehicle.resistance_constant
            + vehicle.resistance_linear * speed
            + vehicle.resistance_quadratic * speed**2
        )
        slowing = -(2 * vehicle.wheelsets * force + drag) / mass
        return slowing, (2 * radius * force - pads * brake - 2 * vehicle.wheel_damping * wheel) / inertia

    for n in range(samples):
        if n:  # rims are seen with the radius that the law assumes: the scale of the train speed is found while rolling
            known = known + (1 - kept) * ((speed - before) / h * rim / radius - known)
            expected = observed + h * (friction - mean) / assumed
            off = wheel - expected
            observed = expected + off * (1 - theta**2)
            friction = np.maximum(friction + assumed / h * (1 - theta) ** 2 * off, 0.0)
        before = speed
        error = wheel - (1 - slip) * speed / radius
        turning = known * (1 - slip) / rim
        seen = error + ahead * h * (-turning + (friction - brake) / assumed)
        pull = np.where(
            seen * k**2 > slew, np.sqrt(np.maximum(2 * slew * (seen - 0.5 * slew / k**2), 0)), k * seen
        )
        target = friction - assumed * (turning - pull)
        wanted = np.clip(target, 0, supply * full)
        least = 1e-3 * full
        room, left = np.maximum(supply * full - brake, least), np.maximum(supply * full - wanted, least)
        up = np.where(wanted > brake, np.clip(longest[0] * np.log(room / left), 0, 1), 0.0)
        down = np.where(
            wanted < brake,
            np.clip(longest[1] * np.log(np.maximum(brake, least) / np.maximum(wanted, least)), 0, 1),
            0.0,
        )
        counted = [
            np.maximum(each * h / (float(time) / share), 1e-12)
            for each, time in ((up, law.fill_time), (down, law.vent_time))
        ]
        over = np.maximum(supply * full, brake) - brake
        rises = over * (
            up * (1 - (1 - np.exp(-counted[0])) / counted[0]) + (1 - up) * (1 - np.exp(-counted[0]))
        )
        falls = brake * (
            down * (1 - (1 - np.exp(-counted[1])) / counted[1]) + (1 - down) * (1 - np.exp(-counted[1]))
        )
        mean = brake + rises - falls
        begin, summed = SimpleNamespace(speed=speed, wheel=wheel, brake=brake), np.zeros(mass.size)
        for part in range(inside):
            # The part of a pulse that lies in this part of the sample counts in all of it.
            opened, closed = (np.clip(each * inside - part, 0.0, 1.0) for each in (up, down))

            def moved(speed, wheel, brake, supply, opened=opened, closed=closed):
                filling = opened * (np.maximum(supply * full, brake) - brake) / fill
                return *rates(speed, wheel, brake), filling - closed * brake / vent, supplied * (1 - supply)

            first = moved(speed, wheel, brake, supply)
            middle = moved(
                *(x + 0.5 * step * rate for x, rate in zip((speed, wheel, brake, supply), first, strict=True))
            )
            summed = summed + (brake + 0.5 * step * first[2]) / inside
            speed, wheel, brake, supply = (
                x + step * rate for x, rate in zip((speed, wheel, brake, supply), middle, strict=True)
            )
        effect = pads * assumed / inertia
        grip = (wheel - begin.wheel) + effect * summed * h / assumed  # f, its mean over the sample
        fallen = -(1 - slip) * (speed - begin.speed) / radius  # D
        excess = observed - begin.wheel
        psi = friction * h / assumed - grip + (effect - 1) * begin.brake * h / assumed
        found.append(
            {
                "P": pull * h,
                "z": psi - (1 - theta) / theta * excess,
                "p": excess,
                "x": (target - begin.brake) * h / assumed,
                "e": turning * h + fallen,
                "E": error,
                "torque": begin.brake * h / assumed,
                "observed": friction * h / assumed,
                "slows": rates(begin.speed, begin.wheel, begin.brake)[0],
                "known": known,
                "slip": (begin.speed - radius * begin.wheel) / begin.speed,
                "speed": begin.speed,
                "supply": supply,
                "room": (supply * full - begin.brake) * h / assumed,
            }
        )
    course_of = {name: np.array([each[name] for each in found]) for name in found[0]}
    # What turns a wheel without brake, at an error of its speed.
    course_of["turned"] = lambda speed, error: (
        rates(speed, (1 - slip) * speed / radius + error, 0.0 * speed)[1] * h
    )
    return course_of
