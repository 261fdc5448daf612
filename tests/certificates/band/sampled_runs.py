"""Runs of the protection on the plant of the attacker, over arrays of runs; of the package come only the numbers."""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from tests.attack.plant import Plant, creep_force, filled, resistance, static_load, vented

BOX = {
    "mass": "mass",
    "wheelset inertia": "wheelset_inertia",
    "wheel radius": "wheel_radius",
    "mu0": "mu0",
    "max torque": "max_torque",
    "fill time": "fill_time",
    "vent time": "vent_time",
}
"""Numbers that cells divide, in the order of the proof, by their names in the plant."""
BESIDE = {
    "supply rate": "supply_rate",
    "resistance constant": "resistance_constant",
    "resistance linear": "resistance_linear",
    "resistance quadratic": "resistance_quadratic",
}
"""Other numbers that differ between the runs."""
SUBSTEP = 2e-3  # s, at most


def plant_of(problem, points):
    """The plant with numbers of a box, arrays over the runs."""
    vehicle, rail = problem.vehicle, problem.rail
    sources = (vehicle, vehicle.brake, vehicle.contact, rail)
    names = [each.name for each in fields(Plant) if each.name not in ("load_share", "train_deceleration")]
    own = {name: next(getattr(s, name) for s in sources if hasattr(s, name)) for name in names}
    return Plant(**own | {name: points[word] for word, name in (BOX | BESIDE).items()})


def some(record, chosen):
    """The same record for some of the runs."""
    values = {each.name: getattr(record, each.name) for each in fields(record)}
    return replace(record, **{n: v[chosen] for n, v in values.items() if isinstance(v, np.ndarray)})


@dataclass(frozen=True)
class Memory:
    """What the law remembers of each run, after a measurement."""

    scale: Any  # of the told speed
    told: Any  # m/s, as scaled
    acceleration: Any  # m/s2
    observed: Any  # rad/s
    friction: Any  # N m
    exact: Any  # m/s, as "told" without its error
    unspoiled: (
        Any  # m/s2, what the filter of the acceleration makes of that: the lag of the theorem is its error
    )


class Law:
    """Friction-torque observer, surface with braking curve, and inverted valve, for a constant reference."""

    def __init__(self, protection, slip):
        self.tracking, self.valve, self.source = protection.core.tracking, protection.valve, protection.source
        self.h, self.inertia, self.radius = (
            protection.sample_time,
            protection.wheelset_inertia,
            protection.wheel_radius,
        )
        self.slip, self.slew = slip, protection.core.torque_slew / self.inertia
        self.full = self.valve.brake.max_torque
        self.theta = np.exp(-protection.observer_rate * self.h)
        self.new = 1.0 - np.exp(-self.h / self.source.acceleration_time)

    def rolling(self, speed, radius):
        """Memory where rolling wheels and a released brake have shown the scale of the speed."""
        found = self.radius / radius
        scale = np.where(abs(found - 1.0) <= self.source.largest_scale_error, found, 1.0)
        still = 0.0 * speed
        return Memory(scale, scale * speed, still, speed / radius, still, scale * speed, still)

    def measured(self, memory, mean, speed, wheel, error=0.0):
        """Take in a measurement after a sample with a mean torque; ``error`` is in the speed of the train."""
        told, exact, h = memory.scale * (speed + error), memory.scale * speed, self.h
        expected = memory.observed + h / self.inertia * (memory.friction - mean)
        r = wheel - expected
        return Memory(
            scale=memory.scale,
            told=told,
            acceleration=self.filtered(memory.acceleration, memory.told, told),
            observed=expected + (1.0 - self.theta**2) * r,
            friction=np.maximum(memory.friction + (1.0 - self.theta) ** 2 * self.inertia / h * r, 0.0),
            exact=exact,
            unspoiled=self.filtered(memory.unspoiled, memory.exact, exact),
        )

    def filtered(self, acceleration, before, after):
        """Acceleration after one more sample."""
        return acceleration + self.new * ((after - before) / self.h - acceleration)

    def desired(self, memory):
        """Wheel speed at the reference, and its rate."""
        return tuple((1.0 - self.slip) / self.radius * each for each in (memory.told, memory.acceleration))

    def pulses(self, memory, wheel, seen, available):
        """Seconds of filling and of venting, and the mean torque that the law makes of them."""
        h, k, brake = self.h, self.tracking.approach_rate, self.valve.brake
        wanted, rate = self.desired(memory)
        error = wheel - wanted + self.tracking.ahead * h * ((memory.friction - seen) / self.inertia - rate)
        curve = np.sqrt(np.maximum(2.0 * self.slew * (error - 0.5 * self.slew / k**2), 0.0))
        pull = np.where(error * k**2 > self.slew, curve, k * error)
        target = np.clip(memory.friction - self.inertia * (rate - pull), 0.0, available)
        sliding = memory.told / self.radius - wanted
        narrowed = self.tracking.dead_band_share * sliding * self.inertia * k
        band = np.minimum(np.minimum(self.tracking.dead_band, narrowed), 0.5 * seen)
        least = 1e-3 * self.full + 1e-3  # what a logarithm is taken of

        def share(way, time, ratio):
            found = np.minimum(self.valve.time_share * time * np.log(ratio), h)
            return np.where((way > band) & (found >= self.valve.least_pulse), found, 0.0)

        room, left = np.maximum(available - seen, least), np.maximum(available - target, least)
        fill = share(target - seen, brake.fill_time, room / left)
        vent = share(seen - target, brake.vent_time, np.maximum(seen, least) / np.maximum(target, least))
        supply = np.maximum(available, seen)
        full = supply - (supply - seen) * np.exp(-fill / brake.fill_time)
        end = full * np.exp(-vent / brake.vent_time)
        area = supply * fill - brake.fill_time * (full - seen) + brake.vent_time * (full - end)
        return fill, vent, (area + (h - fill - vent) * end) / h


def measured_from(law, radius, states):
    """Memory after a measurement, and the wheel speed, from the numbers of a sample that is followed from rolling.

    These are the speed of the train, the sliding speed, the innovation times the radius, the observed friction before,
    the torque, the acceleration before and the change of the speed since then; the supply comes last.
    """
    speed, sliding, innovation, friction, _, acceleration, change, _ = states
    scale, wheel, r = law.radius / radius, (speed - sliding) / radius, innovation / radius
    told = scale * speed
    memory = Memory(
        scale=scale,
        told=told,
        acceleration=law.filtered(scale * acceleration, told - scale * change, told),
        observed=wheel - r + (1.0 - law.theta**2) * r,
        friction=np.maximum(friction + (1.0 - law.theta) ** 2 * law.inertia / law.h * r, 0.0),
        exact=told,
        unspoiled=0.0 * told,
    )
    return memory, wheel


@dataclass(frozen=True)
class Disturbance:
    """Largest disturbances: drawn again for each sample, half of them at their ends."""

    late: float = 0.0  # s, beginning of pulses
    noise: float = 0.0  # m/s, of the measured speeds of rims and train

    def draw(self, random, count):
        """Lateness, and errors of the speeds of rims and train."""
        drawn = random.random((3, count))
        drawn = np.where(random.random(drawn.shape) < 0.5, np.round(drawn), drawn)
        return self.late * drawn[0], self.noise * (2.0 * drawn[1] - 1.0), self.noise * (2.0 * drawn[2] - 1.0)


@dataclass(frozen=True)
class Runs:
    """States of many runs at a sample, after the measurement."""

    plant: Plant
    memory: Memory
    since: Any  # s, the demand
    measured: Any  # rad/s, wheel speed
    speed: Any  # m/s
    wheel: Any  # rad/s
    torque: Any  # N m, of the brake
    number: Any  # of the run

    def some(self, chosen):
        """Some of the runs."""
        own = some(self, chosen)
        return replace(own, plant=some(self.plant, chosen), memory=some(self.memory, chosen))


def motion(plant, speed, wheel, torque):
    """Accelerations of train and wheel; all axles do the same."""
    force = creep_force(plant, 1.0 - plant.wheel_radius * wheel / speed, speed, static_load(plant))
    friction = 2.0 * plant.wheel_radius * force - 2.0 * plant.wheel_damping * wheel
    slowing = (2.0 * plant.wheelsets * force + resistance(plant, speed)) / plant.mass
    return -slowing, (friction - torque) / plant.wheelset_inertia


def supplied(runs):
    """Share of the full pressure that the supply has."""
    return 1.0 - np.exp(-runs.plant.supply_rate * runs.since)


def sampled(law, runs, drawn=(0.0, 0.0, 0.0)):
    """One sample later, with the smallest and the largest slip in between; ``drawn`` by a disturbance."""
    plant, h = runs.plant, law.h
    late, of_rim, of_train = drawn
    pads = plant.max_torque / law.full
    fill, vent, mean = law.pulses(runs.memory, runs.measured, runs.torque / pads, law.full * supplied(runs))

    def torque(t):
        t = np.maximum(t - late, 0.0)
        full = filled(plant, runs.torque, np.minimum(t, fill), since=runs.since + late)
        return vented(plant, full, np.clip(t - fill, 0.0, vent))

    speed, wheel, count = runs.speed, runs.wheel, int(np.ceil(h / SUBSTEP))
    slips, dt = [], h / count
    for k in range(count):
        braked = torque((k + 0.5) * dt)
        v, w = motion(plant, speed, wheel, braked)
        v, w = motion(plant, speed + dt / 2 * v, wheel + dt / 2 * w, braked)
        speed, wheel = speed + dt * v, np.maximum(wheel + dt * w, 0.0)
        slips.append(1.0 - plant.wheel_radius * wheel / speed)
    measured = wheel + of_rim / plant.wheel_radius
    after = replace(
        runs,
        memory=law.measured(runs.memory, mean, speed, measured, of_train),
        since=runs.since + h,
        measured=measured,
        speed=speed,
        wheel=wheel,
        torque=torque(h),
    )
    return after, np.min(slips, axis=0), np.max(slips, axis=0)


def rolling(problem, law, points):
    """Stops that begin with rolling wheels at the moment of the demand."""
    plant, speed = plant_of(problem, points), np.asarray(points["speed"])
    memory = law.rolling(speed, plant.wheel_radius)
    return Runs(
        plant=plant,
        memory=memory,
        since=0.0 * speed,
        measured=speed / plant.wheel_radius,
        speed=speed,
        wheel=speed / plant.wheel_radius,
        torque=0.0 * speed,
        number=np.arange(len(speed)),
    )
