"""Starts on the boundary of the proved ellipsoids, with a plant and a law of their own: none leaves what was proved."""

import numpy as np
import pytest

from wspd_design.certificates.theorems.band import CELLS
from wspd_design.certificates.theorems.slip_band.proof import read
from wspd_design.certificates.theorems.slip_band.statement import NAMES, windows_of

pytestmark = pytest.mark.slow
STARTS, SAMPLES, SUBSTEPS = 2000, 50, 20
G, WHEELS = 9.81, 8


class Axle:
    """Polach's force and one wheelset of a train whose axles are all alike, arrays over the starts."""

    def __init__(self, problem, numbers):
        self.__dict__ |= numbers
        rail, contact = problem.rail, problem.vehicle.contact
        self.load = self.mass * G / WHEELS
        ellipse = contact.shear_modulus * np.pi * contact.semi_axis_rolling * contact.semi_axis_lateral
        self.stiff = ellipse * contact.kalker_c11 / 4.0 * (self.load / contact.reference_load) ** (2.0 / 3.0)
        self.rail, self.vehicle = rail, problem.vehicle

    def force(self, slip, speed):
        rail = self.rail
        mu = self.mu0 * (
            (1.0 - rail.friction_ratio) * np.exp(-rail.friction_decay * slip * speed) + rail.friction_ratio
        )
        strain = self.stiff * slip / (self.load * mu)
        weak, slow = rail.adhesion_reduction * strain, rail.slip_reduction * strain
        return 2.0 * self.load * mu / np.pi * (weak / (1.0 + weak**2) + np.arctan(slow))

    def braking(self, slip, speed):
        drag = self.vehicle.resistance_constant + self.vehicle.resistance_linear * speed
        drag = drag + self.vehicle.resistance_quadratic * speed**2
        return (WHEELS * self.force(slip, speed) + drag) / self.mass

    def rates(self, speed, wheel, torque):
        slip = 1.0 - self.radius * wheel / speed
        friction = 2.0 * self.radius * self.force(slip, speed) - 2.0 * self.vehicle.wheel_damping * wheel
        return -self.braking(slip, speed), (friction - torque) / self.inertia

    def held(self, slip, speed):
        """Friction torque at the reference."""
        damped = 2.0 * self.vehicle.wheel_damping * (1.0 - slip) * speed / self.radius
        return 2.0 * self.radius * self.force(slip, speed) - damped


def leave(problem, ellipsoids, bands, *, larger=1.0):
    """Share of the starts that leave the proved sets or bands; ``larger`` starts outside."""
    random = np.random.default_rng(7)
    law, h = problem.controller, problem.sample_time
    names = ("mass", "inertia", "radius", "mu0", "pads", "fill", "vent")
    ends = [problem.span(name) for name in NAMES]
    unit = np.where(
        random.random((7, STARTS)) < 0.5, random.integers(0, 2, (7, STARTS)), random.random((7, STARTS))
    )
    numbers = {n: low + (high - low) * u for n, (low, high), u in zip(names, ends, unit, strict=True)}
    axle = Axle(problem, numbers)
    windows = windows_of(problem)
    full, inertia = law.valve.brake.max_torque, law.wheelset_inertia
    kappa = axle.pads / full
    place = random.integers(0, len(windows), STARTS)
    lows, highs = (np.array([w[k] for w in windows])[place] for k in (0, 1))
    speed = np.maximum(lows + h * 10.0, lows) + random.random(STARTS) * (highs - lows - h * 10.0)
    lam = problem.slip
    matrices = np.array([[[float(each) for each in row] for row in e.matrix] for e in ellipsoids])
    roots = np.linalg.cholesky(np.linalg.inv(matrices))
    direction = random.normal(size=(STARTS, 4))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    centers = np.array([[float(each) for each in e.center] for e in ellipsoids])
    e, p, n, y = centers[place].T + larger * np.einsum("kij,kj->ik", roots[place], direction)
    rolling = (1.0 - lam) / axle.radius

    def balance(speed, slip):
        rate = -rolling * axle.braking(slip, speed)
        return (axle.held(lam, speed) - axle.inertia * rate) / (kappa * inertia), rate

    wheel = rolling * speed + e
    t0, rate = balance(speed, 1.0 - axle.radius * wheel / speed)
    observed, tau, seen = wheel + p, inertia * (n / h + t0 + rate), inertia * (y / h + t0)
    acceleration, before, mean = rate / rolling, None, None
    tracking, valve = law.core.tracking, law.valve
    theta, new = np.exp(-law.observer_rate * h), 1.0 - np.exp(-h / law.source.acceleration_time)
    left = np.zeros(STARTS, dtype=bool)
    for _ in range(SAMPLES):  # what is below the lowest speed counts no more, and may stand still
        if before is not None:
            acceleration = acceleration + new * ((speed - before) / h - acceleration)
            expected = observed + h / inertia * (tau - mean)
            r = wheel - expected
            observed, tau = (
                expected + (1 - theta**2) * r,
                np.maximum(tau + (1 - theta) ** 2 * inertia / h * r, 0.0),
            )
        wanted, wanted_rate = rolling * speed, rolling * acceleration
        slip = 1.0 - axle.radius * wheel / speed
        t0, rate = balance(speed, slip)
        state = np.array(
            [wheel - wanted, observed - wheel, h * (tau / inertia - t0 - rate), h * (seen / inertia - t0)]
        )
        going = speed > problem.speeds[0]
        inside, lowest, highest = np.zeros(STARTS, dtype=bool), np.full(STARTS, lam), np.full(STARTS, lam)
        for (low, high), matrix, center, (less, more) in zip(windows, matrices, centers, bands, strict=True):
            within = (speed >= low) & (speed <= high)
            apart = state - center[:, None]
            size = np.einsum("ik,ij,jk->k", apart, matrix, apart)
            inside |= within & (size <= 1.0 + 1e-9)
            lowest = np.where(within, np.minimum(lowest, lam - less), lowest)
            highest = np.where(within, np.maximum(highest, lam + more), highest)
        left |= going & ~(inside & (slip >= lowest) & (slip <= highest))
        error = state[0] + tracking.ahead * h * ((tau - seen) / inertia - wanted_rate)
        target = np.clip(tau - inertia * (wanted_rate - tracking.approach_rate * error), 0.0, full)
        share = valve.time_share
        fill = np.where(
            target > seen, share * valve.brake.fill_time * np.log((full - seen) / (full - target)), 0.0
        )
        vent = np.where(target < seen, share * valve.brake.vent_time * np.log(seen / target), 0.0)
        fill, vent = np.minimum(fill, h), np.minimum(vent, h)

        def pulse(t, fill_time, vent_time, fill=fill, vent=vent, begin=seen):
            filled = full - (full - begin) * np.exp(-np.minimum(t, fill) / fill_time)
            return filled * np.exp(-np.minimum(t, vent) / vent_time)

        times = (np.arange(200) + 0.5) * h / 200
        mean = np.mean([pulse(t, valve.brake.fill_time, valve.brake.vent_time) for t in times], axis=0)
        before, dt = speed, h / SUBSTEPS
        for k in range(SUBSTEPS):
            torque = kappa * pulse((k + 0.5) * dt, axle.fill, axle.vent)
            v1, w1 = axle.rates(speed, wheel, torque)
            v2, w2 = axle.rates(speed + dt / 2 * v1, wheel + dt / 2 * w1, torque)
            speed, wheel = speed + dt * v2, wheel + dt * w2
            slip = 1.0 - axle.radius * wheel / speed
            left |= (speed > problem.speeds[0]) & ((slip < lowest) | (slip > highest))
        seen = pulse(h, axle.fill, axle.vent)
    return float(left.mean())


@pytest.fixture(scope="module")
def found(half, proved):
    numbers = proved.findings[CELLS].numbers
    proof = read(proved.findings[CELLS].stated.proof, len(windows_of(half)))
    assert len(proof.cells) == 1
    bands = [(numbers[f"band {k} below"], numbers[f"band {k} above"]) for k in range(len(windows_of(half)))]
    return proof.cells[0], bands


@np.errstate(all="ignore")
def test_no_start_on_the_boundary_leaves(half, found):
    assert leave(half, *found) == 0.0


@np.errstate(all="ignore")
def test_starts_outside_are_seen_outside(half, found):
    """The attack can tell: from twice the ellipsoid all starts are outside at first."""
    assert leave(half, *found, larger=2.0) == 1.0
