"""Trains that hold a slip, in equations of their own, and the loop of the same numbers to compare with them."""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise, product

import numpy as np
from flint import ctx

import wspd_design as wd
from wspd_design.certificates.theorems.slip_band.friction import FADINGS, SLOPES, Friction, Part
from wspd_design.certificates.theorems.slip_band.loop import Conditions, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice
from wspd_design.certificates.theorems.slip_band.reference import slip_at, slips_held, turning_at
from wspd_design.certificates.theorems.slip_band.statement import NAMES, law_of
from wspd_design.design.problem import stability_problem
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import constants

LOCO, WET = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")

WINDOW = (8.0, 8.05)  # m/s
EXACT = Conditions(supply=Fraction(1), delay=Fraction(0), noise=Fraction(0))
LAW_SPEEDS = (10.0 / 3.6, 120.0 / 3.6)  # m/s
PULSE = Fraction(1, 2)
SPEED = 8.0495  # m/s, at the beginning of a sample in the window
ERROR, DRIFT = Fraction(1, 100), Fraction(2, 5)  # -, m/s2, of a slip that wanders
NOISE = Fraction(1, 50)  # m/s


def everywhere(friction):
    """Bounds of the friction for wheels of any steepness."""
    return (Part((0.0, math.inf), friction),)


def falling_problem(rail, share, **numbers):
    """Closed loop of the designed law on a slip c/sqrt(v), without dead band, on a part of the stated box."""
    specification = wd.Specification(sample_time=0.02, reference="falling", speeds=LAW_SPEEDS)
    law = wd.design_controller(LOCO, rail, specification, law="observer-smc").build(LOCO, rail)
    law = replace(law, core=replace(law.core, tracking=replace(law.core.tracking, dead_band=0.0)))
    problem = stability_problem(
        LOCO, rail, replace(law, reference=replace(law.reference, **numbers)), specification
    )
    ends = {}
    for name in NAMES:
        (low, high), middle = problem.span(name), problem.nominal(name)
        ends[name] = (middle + share * (low - middle), middle + share * (high - middle))
    return replace(problem, bounds=Bounds.of(ends))


def polach(rail, vehicle, mu0, slip, speed, load):
    """Polach's creep force, written once more [N]."""
    contact = vehicle.contact
    grown = (load / contact.reference_load) ** (2.0 / 3.0)
    area = contact.semi_axis_rolling * contact.semi_axis_lateral * grown
    sliding = slip * speed
    friction = mu0 * (
        (1.0 - rail.friction_ratio) * math.exp(-rail.friction_decay * sliding) + rail.friction_ratio
    )
    gradient = contact.shear_modulus * math.pi * area * contact.kalker_c11 / (4.0 * load * friction) * slip
    elastic = rail.adhesion_reduction * gradient / (1.0 + (rail.adhesion_reduction * gradient) ** 2)
    return 2.0 * load * friction / math.pi * (elastic + math.atan(rail.slip_reduction * gradient))


class Course:
    """A train all of whose wheels hold a slip over time exactly, in equations of its own."""

    def __init__(self, problem, law, slip):
        self.problem, self.law, self.slip = problem, law, slip

    def braking(self, speed, slip):
        vehicle, mass = self.problem.vehicle, self.problem.nominal("mass")
        drag = vehicle.resistance_constant + vehicle.resistance_linear * speed
        drag += vehicle.resistance_quadratic * speed**2
        return (8.0 * self.force(speed, slip) + drag) / mass

    def force(self, speed, slip):
        load = self.problem.nominal("mass") * constants().gravity / 8.0
        return polach(self.problem.rail, self.problem.vehicle, self.problem.rail.mu0, slip, speed, load)

    def speeds(self, speed, times):
        found = [speed]
        for before, after in pairwise(times):
            middle = found[-1] - (after - before) / 2.0 * self.braking(
                found[-1], self.slip(before, found[-1])
            )
            at = (before + after) / 2.0
            found.append(found[-1] - (after - before) * self.braking(middle, self.slip(at, middle)))
        return np.array(found)

    def numbers(self, speed, start=0.0, settled=0.0):
        """h (change of t0), h (change of w_r' at a fixed course of the slip) and what the slip moves, in a sample.

        t0 holds a wheel beside the train's, of which the speed differs from the reference by one that is settled.
        """
        h, radius = float(self.law.sample_time), self.problem.vehicle.wheel_radius
        inertia = self.problem.vehicle.wheelset_inertia
        times = start + np.linspace(0.0, h, 21)
        speeds = self.speeds(speed, times)
        known = []
        for t, v in zip(times, speeds, strict=True):
            slip = self.slip(t, v)
            aside = slip - slip_at(self.law, v, radius)
            rate = -self.braking(v, slip) * (turning_at(self.law, v, radius) - aside) / radius
            known.append((self.holding(v, slip, settled) / inertia - rate, rate))
        (t0, rate0), (t1, rate1) = known[0], known[-1]
        asides = [self.slip(t, v) - slip_at(self.law, v, radius) for t, v in zip(times, speeds, strict=True)]
        middle = (speeds[1:] + speeds[:-1]) / 2.0
        return h * (t1 - t0), h * (rate1 - rate0), float(np.sum(np.diff(asides) * middle)) / radius

    def holding(self, speed, slip, settled):
        """Torque of friction and damping on a wheel that is faster than the reference by a settled error [N m]."""
        radius = self.problem.vehicle.wheel_radius
        wheel = (1.0 - slip) * speed / radius + settled
        torque = 2.0 * radius * self.force(speed, 1.0 - radius * wheel / speed)
        return torque - 2.0 * self.problem.vehicle.wheel_damping * wheel

    def lags(self, speed, samples):
        """Errors of the filtered acceleration of the reference, times h, from the moment when the filter is exact."""
        h, radius = float(self.law.sample_time), self.problem.vehicle.wheel_radius
        kept = math.exp(-h / float(self.law.acceleration_time))
        filtered, found = -self.braking(speed, self.slip(0.0, speed)), [0.0]
        for k in range(samples):
            after = self.speeds(speed, h * (k + np.linspace(0.0, 1.0, 21)))[-1]
            filtered += (1.0 - kept) * ((after - speed) / h - filtered)
            speed = after
            rate = -self.braking(speed, self.slip(h * (k + 1), speed))
            found.append(h * turning_at(self.law, speed, radius) / radius * (rate - filtered))
        return found


class Stop(Course):
    """A train whose other wheels are off the reference by an error e R over the lowest speed."""

    def __init__(self, problem, law, slip, others=0.0):
        super().__init__(problem, law, slip)
        self.others = others

    def braking(self, speed, slip):
        return super().braking(speed, slip - self.others * self.problem.speeds[0] / speed)

    def sample(self, start, settled):
        """Times, speeds, the torque that holds over the inertia of the law, rate of the reference, slip aside."""
        radius, times = self.problem.vehicle.wheel_radius, np.linspace(0.0, float(self.law.sample_time), 41)
        speeds = self.speeds(SPEED, start + times)
        rows = []
        for t, v in zip(start + times, speeds, strict=True):
            slip = self.slip(t, v)
            aside = slip - slip_at(self.law, v, radius)
            rate = -self.braking(v, slip) * (turning_at(self.law, v, radius) - aside) / radius
            torque = self.holding(v, slip, settled) - self.problem.vehicle.wheelset_inertia * rate
            rows.append((torque / float(self.law.inertia), rate, aside))
        return times, speeds, *np.array(rows).T

    def disturbed(self, start, settled, secant):
        """What disturbs in a sample, by the number of the disturbance."""
        times, speeds, torque, rate, aside = self.sample(start, settled)
        h, radius = times[-1], self.problem.vehicle.wheel_radius
        weight = np.exp(secant * (h - times))
        moving = np.diff(aside) * (speeds[1:] + speeds[:-1]) / 2.0 / radius
        moved = float(np.sum(moving))
        turned = (1.0 - self.slip(start + h, speeds[-1])) * speeds[-1] - (
            1.0 - self.slip(start, speeds[0])
        ) * speeds[0]
        grown = (weight[1:] + weight[:-1]) / 2.0
        return {
            2: h * (torque[-1] - torque[0]),
            3: h * np.trapezoid(weight * (torque - torque[0]), times) / np.trapezoid(weight, times),
            4: h * (rate[-1] - rate[0]),
            5: turned / radius - h * rate[0] + moved,
            6: moved,
            7: float(np.sum((grown - 1.0) * moving)),
        }


class Steered(Stop):
    """A train whose deceleration rises by a factor of what it does with all wheels at the reference."""

    def __init__(self, problem, law, slip, factor):
        super().__init__(problem, law, slip)
        self.factor, d = factor, 1e-4
        held = slip_at(law, SPEED, problem.vehicle.wheel_radius)
        self.most = super().braking(SPEED, held)
        fall = [super(Steered, self).braking(v, slip(0.0, v)) for v in (SPEED - d, SPEED + d)]
        self.jerk = factor * self.most * (fall[1] - fall[0]) / (2.0 * d)

    def speeds(self, speed, times):
        t = np.asarray(times) - times[0]
        return speed - self.most * t + self.jerk * t**2 / 2.0

    def braking(self, speed, _slip):
        """At a speed of the sample that begins with the speed of the class."""
        return math.sqrt(self.most**2 - 2.0 * self.jerk * (SPEED - speed))


def wandering(law, problem, wide=1.0):
    """A slip that moves beside that of the law as fast as it may."""
    radius, error, pace = problem.vehicle.wheel_radius, float(law.slip_error), 0.0
    if error:
        pace = wide * float(law.slip_drift) / WINDOW[1] / error
    return pace, lambda t, v: slip_at(law, v, radius) + error * math.sin(pace * t)


def laws(problem):
    """A constant slip and a falling one, each alone and with one that wanders beside it."""
    falling = law_of(problem.controller)
    constant = replace(falling, falls=False, slip=Fraction(9, 50))
    return [
        replace(each, slip_error=error, slip_drift=drift)
        for each, (error, drift) in product((constant, falling), ((Fraction(0), Fraction(0)), (ERROR, DRIFT)))
    ]


def misjudged(law, problem, aside, sequence):
    """How the law misjudges its reference and h times the rate of it, by errors of the train speed in a stop."""
    radius, h = problem.vehicle.wheel_radius, float(law.sample_time)
    kept = math.exp(-float(law.sample_time / law.acceleration_time))
    speeds = WINDOW[1] + 1.3 * h * np.arange(len(sequence))[::-1]
    told, exact, noisy = speeds + np.array(sequence), -1.3, -1.3
    for k in range(1, len(speeds)):
        exact += (1.0 - kept) * ((speeds[k] - speeds[k - 1]) / h - exact)
        noisy += (1.0 - kept) * ((told[k] - told[k - 1]) / h - noisy)

    def reference(v):
        return (1.0 - slip_at(law, v, radius) - aside) * v / radius

    def rate(v, acceleration):
        return (turning_at(law, v, radius) - aside) / radius * acceleration

    return reference(told[-1]) - reference(speeds[-1]), h * (rate(speeds[-1], exact) - rate(told[-1], noisy))


def friction_at(problem, window, slips):
    """Friction in the neighborhood of a reference, by differences."""
    course = Course(problem, None, None)
    weight = problem.nominal("mass") * constants().gravity / 8.0 * problem.rail.mu0
    slopes, levels, fadings = [], [], []
    for v in window:
        for slip in np.linspace(*slips, 9):
            d = 1e-5
            force = course.force(v, slip) / weight
            levels.append(force)
            slopes.append(-(course.force(v, slip + d) - course.force(v, slip - d)) / (2 * d * v) / weight)
            fade = (course.force(v + d, slip) - course.force(v - d, slip)) / (2 * d) / weight
            fadings.append(fade / slip)
    slope, level, fading = ((min(each) - 1e-4, max(each) + 1e-4) for each in (slopes, levels, fadings))
    return Friction((slope,) * len(SLOPES), level, (fading,) * len(FADINGS))


def friction_of(problem, law, window):
    """Bounds of the friction in each strip about the slips that are held, by differences."""
    course = Course(problem, law, None)
    full = problem.nominal("mass") * constants().gravity / 8.0 * problem.rail.mu0
    held, d = slips_held(law, window, (Fraction(problem.vehicle.wheel_radius),) * 2), 1e-5

    def ends(measured, strip):
        found = [
            measured(slip - x * problem.speeds[0] / v, v)
            for x, v, slip in product(np.linspace(*map(float, strip), 5), window, np.linspace(*held, 5))
        ]
        return min(found) - 1e-4, max(found) + 1e-4

    def slope(slip, v):
        return -(course.force(v, slip + d) - course.force(v, slip - d)) / (2 * d * v) / full

    def fading(slip, v):
        return (course.force(v + d, slip) - course.force(v - d, slip)) / (2 * d) / full / slip

    return Friction(
        tuple(ends(slope, strip) for strip in SLOPES),
        ends(lambda slip, v: course.force(v, slip) / full, (0.0, 0.0)),
        tuple(ends(fading, strip) for strip in FADINGS),
    )


def loop_in(
    problem, law, settled=0.0, *, friction=None, conditions=EXACT, window=WINDOW, near=0, ranges=None
):
    """Return the loop of the nominal numbers, or of some ranges of them."""
    with ctx.workprec(128):
        ends = {name: (problem.nominal(name),) * 2 for name in NAMES} | (ranges or {})
        cell = tuple(tuple(map(Fraction, each)) for each in ends.values())
        parts = everywhere(friction or friction_of(problem, law, window))
        return loop_of(problem, law, cell, window, parts, Choice(PULSE, near, Fraction(settled)), conditions)


def left_beside(loop, seen, steady=0.0):
    """What is left of all that is seen, by the number of the disturbance, beside what the loop counts elsewhere.

    That is what comes with the steady drift, and with the drift of the reference.
    """
    drifted = {2: 1.0, 3: float(loop.steady.share.mid()), 4: float(loop.steady.lag.mid())}
    brought = [float(each.mid()) for each in loop.ranges.brought]
    return {k: each - drifted.get(k, 0.0) * steady - brought[k] * seen[4] for k, each in seen.items()}


def doubles(ends):
    return tuple(float(end.mid()) for end in ends)


def within(value, ends, part=1e-9):
    return ends[0] - part <= value <= ends[1] + part
