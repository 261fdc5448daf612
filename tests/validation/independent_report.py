"""Numbers of a report, worked out again from its files: formulas and stops that share nothing with the package.

Files are read with the standard library; eqs. (1)-(14), (19), (22) and (35)-(42) are written out again, and SciPy
integrates. Two things are told by the data book alone: slip is referred to at least 0.1 m/s, and a stop ends at
5 mm/s.
"""

import math
import tomllib
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

GRAVITY = 9.81
SLIP_REFERENCE_SPEED = 0.1  # m/s
STOP_SPEED = 0.005  # m/s
JUDGED = 10.0 / 3.6  # m/s, above which slip counts
UNITS = {
    "mm": 1e-3,
    "kN": 1e3,
    "kN m": 1e3,
    "kN m/s": 1e3,
    "bar": 1e5,
    "GPa": 1e9,
} | dict.fromkeys(
    ("-", "kg", "m", "kg m^2", "N", "N m", "N m s", "1/s", "s", "s/m", "N s/m", "N s^2/m^2", "Hz"), 1.0
)


def entries(table, prefix=""):
    """Yield the dotted name of every number of a parsed file with its table."""
    for name, each in table.items():
        if isinstance(each, dict):
            if "value" in each:
                yield prefix + name, each
            else:
                yield from entries(each, f"{prefix}{name}.")


def numbers(text, kind):
    """Return the numbers of a vehicle or rail in SI units by their names, and their bounds."""
    every = {f"{kind}.{name}": each for name, each in entries(tomllib.loads(text))}
    found = {name: each for name, each in every.items() if not isinstance(each["value"], str)}
    values = {name: each["value"] * UNITS[each["unit"]] for name, each in found.items()}
    bounds = {
        name: [end * UNITS[each["unit"]] for end in each["bounds"]]
        for name, each in found.items()
        if "bounds" in each
    }
    return values, bounds


@dataclass(frozen=True)
class Trace:
    """States of a stop at the steps of the solver, and what its valves did."""

    time: np.ndarray
    speed: np.ndarray
    distance: np.ndarray
    slip: np.ndarray
    torque: np.ndarray  # N m per wheelset
    switches: int = 0
    vented: float = 0.0  # full cylinders, until the last sample
    pulsed: tuple = ()  # filling share of each sample


class Locomotive:
    """The quarter locomotive: one wheel for eight, all of them under the same load."""

    def __init__(self, values):
        def of(name, kind="vehicle"):
            return values[f"{kind}.{name}"]

        self.mass, self.radius, self.axles = of("mass"), of("wheel_radius"), round(of("wheelsets"))
        self.wheelset = of("wheelset_inertia")
        self.inertia = self.wheelset / 2.0
        self.resistances = of("resistance_constant"), of("resistance_linear"), of("resistance_quadratic")
        self.damping, self.damping_decay = of("wheel_damping"), of("wheel_damping_decay")
        self.full, self.supply_rate = of("brake.max_torque"), of("brake.supply_rate")
        self.fill_time, self.vent_time = of("brake.fill_time"), of("brake.vent_time")
        self.load = self.mass * GRAVITY / (2.0 * self.axles)
        ellipse = of("contact.semi_axis_rolling") * of("contact.semi_axis_lateral")
        ellipse *= (self.load / of("contact.reference_load")) ** (2.0 / 3.0)
        self.stiffness = 0.25 * math.pi * of("contact.shear_modulus") * ellipse * of("contact.kalker_c11")
        self.mu0, self.ratio, self.decay = (
            of(name, "rail") for name in ("mu0", "friction_ratio", "friction_decay")
        )
        self.near, self.far = of("adhesion_reduction", "rail"), of("slip_reduction", "rail")

    def force(self, slip, speed):
        """Polach's creep force of a wheel at a slip [N]."""
        sliding = abs(slip) * max(speed, SLIP_REFERENCE_SPEED)
        mu = self.mu0 * ((1.0 - self.ratio) * math.exp(-self.decay * sliding) + self.ratio)
        gradient = self.stiffness * slip / (self.load * mu)
        adhering = self.near * gradient
        shape = adhering / (1.0 + adhering * adhering) + math.atan(self.far * gradient)
        return 2.0 / math.pi * self.load * mu * shape

    def slip(self, speed, turning):
        return (speed - self.radius * turning) / max(speed, SLIP_REFERENCE_SPEED)

    def resistance(self, speed):
        constant, linear, quadratic = self.resistances
        return constant + linear * speed + quadratic * speed * speed

    def retardation(self, slip, speed):
        return (self.resistance(speed) + 2.0 * self.axles * self.force(slip, speed)) / self.mass

    def supply(self, time):
        return 1.0 - math.exp(-self.supply_rate * time)

    # The brake by mean values, EN 14531-1, while no wheel slides.

    @property
    def rim_force(self):
        return self.axles * self.full / self.radius

    @property
    def rotating_mass(self):
        return self.axles * self.wheelset / self.radius**2

    @property
    def demanded_adhesion(self):
        return self.rim_force / ((self.mass + self.rotating_mass) * GRAVITY)

    def mean_stop(self, speed):
        """Equivalent time, deceleration, distance and time."""
        constant, linear, quadratic = self.resistances
        total = self.rim_force + constant + linear * speed * 2.0 / 3.0 + quadratic * speed**2 / 2.0
        late = (1.0 / self.supply_rate + self.fill_time) * self.rim_force / total
        deceleration = total / (self.mass + self.rotating_mass)
        return (
            late,
            deceleration,
            speed * late + speed**2 / (2.0 * deceleration),
            late + speed / deceleration,
        )

    # The slip linearized at a frozen speed.

    def slip_rate(self, slip, speed, torque):
        """Eq. (19)."""
        force = self.force(slip, speed)
        falling = self.radius**2 * force / self.inertia
        falling += (1.0 - slip) * (self.resistance(speed) + 2.0 * self.axles * force) / self.mass
        return -falling / speed + self.damping * (1.0 - slip) / self.inertia + self.gain(speed) * torque

    def gain(self, speed):
        return self.radius / (2.0 * self.inertia * speed)

    def holding_torque(self, slip, speed):
        return -self.slip_rate(slip, speed, 0.0) / self.gain(speed)

    def pole(self, slip, speed):
        torque, step = self.holding_torque(slip, speed), 1e-6
        return (self.slip_rate(slip + step, speed, torque) - self.slip_rate(slip - step, speed, torque)) / (
            2.0 * step
        )

    # Stops.

    def peak_slip(self, speed):
        return minimize_scalar(
            lambda slip: -self.force(slip, speed),
            bounds=(1e-4, 1.0),
            method="bounded",
            options={"xatol": 1e-9},
        ).x

    def held_stop(self, slip, start):
        """Fill until the slip is reached, then hold it; ``slip`` is a function of the speed."""

        def filling(t, y):
            speed, turning, _, pressure = y
            force = self.force(self.slip(speed, turning), speed)
            turned = (
                self.radius * force - 0.5 * self.full * pressure - self.damping * turning
            ) / self.inertia
            slowed = -(self.resistance(speed) + 2.0 * self.axles * force) / self.mass
            return slowed, turned, speed, (self.supply(t) - pressure) / self.fill_time

        def reached(_t, y):
            return self.slip(y[0], y[1]) - slip(y[0])

        def standstill(_t, y):
            return y[0] - STOP_SPEED

        reached.terminal = standstill.terminal = True
        until = solve_ivp(
            filling, (0.0, 60.0), (start, start / self.radius, 0.0, 0.0), method="LSODA", rtol=1e-9,
            atol=1e-10, events=reached, max_step=1e-3,
        )  # fmt: skip
        held = solve_ivp(
            lambda _t, y: (-self.retardation(slip(y[0]), y[0]), y[0]), (until.t[-1], 600.0),
            (until.y[0, -1], until.y[2, -1]), rtol=1e-9, atol=1e-9, events=standstill,
        )  # fmt: skip
        before = [self.slip(v, w) for v, w in zip(until.y[0], until.y[1], strict=True)]
        return Trace(
            time=np.concatenate([until.t, held.t]),
            speed=np.concatenate([until.y[0], held.y[0]]),
            distance=np.concatenate([until.y[2], held.y[1]]),
            slip=np.array([*before, *(slip(v) for v in held.y[0])]),
            torque=np.concatenate([self.full * until.y[3], np.full(len(held.t), math.nan)]),
        )

    @cached_property
    def peaks(self):
        speeds = np.geomspace(STOP_SPEED, 45.0, 400)
        found = np.array([self.peak_slip(v) for v in speeds])
        return lambda speed: float(np.interp(speed, speeds, found))

    def ideal_stop(self, start):
        return self.held_stop(self.peaks, start)

    def stop(self, law, start):
        """Brake with a sampled law whose valve fills for its duty and vents for the rest of the sample."""
        y = np.array([start, start / self.radius, 0.0, 0.0, 0.0])
        times, states, duties = [np.zeros(1)], [y[:, np.newaxis]], []
        time, sample, locked = 0.0, 0, False
        while True:
            duty = law.step(y[0], y[1])
            duties.append(duty)
            begin = sample * law.sample_time
            ends = ((1.0, begin + duty * law.sample_time), (0.0, begin + law.sample_time))
            for filling, end in ends:
                while time < end - 1e-12:
                    found, locked = self._advance(time, end, y, filling, locked)
                    time, y = found.t[-1], found.y[:, -1].copy()
                    if locked:
                        y[1] = 0.0
                    times.append(found.t[1:])
                    states.append(found.y[:, 1:])
                    if found.t_events[0].size:
                        return self._trace(np.concatenate(times), np.hstack(states), duties, law.sample_time)
            sample += 1

    def _advance(self, time, end, y, filling, locked):
        def rates(t, y):
            speed, turning, _, pressure, _ = y
            force = self.force(self.slip(speed, turning), speed)
            damping = self.damping * math.exp(-self.damping_decay * t) * turning
            turned = (self.radius * force - 0.5 * self.full * pressure - damping) / self.inertia
            venting = (1.0 - filling) * pressure / self.vent_time
            return (
                -(self.resistance(speed) + 2.0 * self.axles * force) / self.mass,
                0.0 if locked else turned,
                speed,
                filling * (self.supply(t) - pressure) / self.fill_time - venting,
                venting,
            )

        def standstill(_t, y):
            return y[0] - STOP_SPEED

        def change(_t, y):
            if not locked:
                return y[1]
            return 0.5 * self.full * y[3] - self.radius * self.force(1.0, y[0])

        standstill.terminal = change.terminal = True
        change.direction = -1.0
        found = solve_ivp(
            rates, (time, end), y, method="LSODA", rtol=1e-10, atol=1e-11, events=(standstill, change)
        )
        return found, locked != bool(found.t_events[1].size)

    def _trace(self, time, states, duties, sample_time):
        speed, turning, distance, pressure, vented = states
        kinds = [kind for duty in duties for kind in ([1] if duty == 1.0 else [0] if duty == 0.0 else [1, 0])]
        return Trace(
            time=time,
            speed=speed,
            distance=distance,
            slip=np.array([self.slip(v, w) for v, w in zip(speed, turning, strict=True)]),
            torque=self.full * pressure,
            switches=sum(one != two for one, two in pairwise(kinds)),
            vented=float(vented[np.searchsorted(time, (len(duties) - 1) * sample_time)]),
            pulsed=tuple(duties),
        )

    def share_of_peak(self, time, speed, *, slips=None):
        """Impulse of the creep forces over that of the adhesion peak; without slips from what slows the train."""
        every = 2.0 * self.axles
        offered = np.trapezoid([every * self.force(self.peaks(v), v) for v in speed], time)
        if slips is not None:
            used = np.trapezoid([every * self.force(s, v) for s, v in zip(slips, speed, strict=True)], time)
        else:
            used = self.mass * (speed[0] - speed[-1]) - np.trapezoid(self.resistance(speed), time)
        return used / offered


class AdaptiveFuzzyLaw:
    """Eqs. (22), (29)-(42) with the dead zone and the hold, from the gains of a design file."""

    def __init__(self, design, radius, full):
        gains = design["gains"]

        def of(name):
            value = gains[name]["value"]
            return np.array(value) if isinstance(value, list) else value

        self.sample_time, self.reference = (
            design["specification"]["sample_time"],
            design["specification"]["slip"],
        )
        self.proportional, self.integral = of("proportional_gain"), of("integral_gain")
        self.layer, self.centres, self.widths = of("boundary_layer"), of("centres"), of("widths")
        self.weight_rate, self.bound_rate = 1e3 * of("weight_rate"), 1e3 * of("bound_rate")
        self.weights, self.bound = 1e3 * of("initial_weights"), 1e3 * of("initial_bound")
        for name, wanted in (("dead_zone", True), ("hold_when_saturated", True), ("scheduled_rates", False)):
            assert of(name) is wanted, f"{name} is not written out here"
        self.radius, self.full, self.summed = radius, full, 0.0

    def strengths(self, surface):
        fired = np.exp(-(((surface - self.centres) / self.widths) ** 2))
        return fired / fired.sum()

    def torque(self, surface):
        within = min(max(surface / self.layer, -1.0), 1.0)
        return float(self.weights @ self.strengths(surface)) + self.bound * within

    def step(self, speed, turning):
        error = self.reference - (speed - self.radius * turning) / max(speed, SLIP_REFERENCE_SPEED)
        surface = self.proportional * error + self.integral * self.summed
        wanted = self.torque(surface)
        outside = surface - self.layer * min(max(surface / self.layer, -1.0), 1.0)
        pushing = (wanted > self.full and surface > 0.0) or (wanted < 0.0 and surface < 0.0)
        if not pushing:
            self.weights = self.weights + self.sample_time * self.weight_rate * outside * self.strengths(
                surface
            )
            self.bound += self.sample_time * self.bound_rate * abs(outside)
        self.summed += self.sample_time * error
        return min(max(wanted / self.full, 0.0), 1.0)


def growth_per_sample(locomotive, law, speeds):
    """Return the largest magnitude of a pole of the loop from sample to sample, inside the dead zone.

    The duty moves the end of the filling within a sample; the torque that is reached by then decays while it vents.
    """
    h, lag = law.sample_time, locomotive.fill_time
    assert locomotive.fill_time == locomotive.vent_time
    slope = (law.torque(1e-7) - law.torque(-1e-7)) / 2e-7 / locomotive.full

    def grown(speed):
        pole, gain = locomotive.pole(law.reference, speed), locomotive.gain(speed)
        duty = locomotive.holding_torque(law.reference, speed) / locomotive.full
        free = expm(np.array([[pole, gain], [0.0, -1.0 / lag]]) * h)
        # A later end of the filling by dt adds full/lag dt of torque at duty h, whatever the pressure is there.
        left = expm(np.array([[pole, gain], [0.0, -1.0 / lag]]) * (1.0 - duty) * h)
        moved = left @ np.array([0.0, locomotive.full / lag * h])
        loop = np.zeros((3, 3))
        loop[:2, :2] = free
        loop[:2, 0] -= moved * slope * law.proportional
        loop[:2, 2] = moved * slope * law.integral
        loop[2] = (-h, 0.0, 1.0)
        return max(abs(np.linalg.eigvals(loop)))

    return max(grown(speed) for speed in speeds)


def built_up(time, torque, distance, speed):
    """Return when the torque of all wheelsets reaches 90 % of its median above 10 km/h, and the distance until then."""
    even = np.linspace(0.0, time[speed > JUDGED][-1], 20_000)
    first = int(np.argmax(torque >= 0.9 * np.median(np.interp(even, time, torque))))
    return time[first], distance[first]


def ideal_stop_of_axles(plant, peaks, start):
    """Distance of four axles with load transfer, each of which fills until its peak slip and holds that then [m]."""
    y = np.zeros(plant.DZ.stop)
    y[0], y[plant.W] = start, start / plant.vehicle.wheel_radius
    held, time = np.zeros(plant.axles, dtype=bool), 0.0

    def holding(y):
        y = y.copy()
        y[plant.W][held] = y[0] * (1.0 - peaks(max(y[0], STOP_SPEED))) / plant.vehicle.wheel_radius
        return y

    def rates(t, y):
        rate = plant.rates(t, holding(y), 1.0, 0.0, held)
        rate[plant.P] = np.where(held, 0.0, rate[plant.P])  # what holds a wheel has no part in the motion
        return rate

    def short_of_peak(axle):
        def event(_t, y):
            slip = 1.0 - plant.vehicle.wheel_radius * y[plant.W][axle] / max(y[0], STOP_SPEED)
            return 1.0 if held[axle] else peaks(max(y[0], STOP_SPEED)) - slip

        event.terminal, event.direction = True, -1.0
        return event

    def standstill(_t, y):
        return y[0] - STOP_SPEED

    standstill.terminal = True
    while True:
        found = solve_ivp(
            rates, (time, 600.0), y, method="RK45" if held.all() else "LSODA", rtol=1e-6, atol=1e-6,
            events=(standstill, *map(short_of_peak, range(plant.axles))),
        )  # fmt: skip
        time, y = found.t[-1], found.y[:, -1]
        if found.t_events[0].size:
            return y[plant.X]
        held |= np.array([each.size > 0 for each in found.t_events[1:]])


def held_slip(trace, reference):
    """Return when nine tenths of the reference are reached, and rms, overshoot and undershoot from then to 10 km/h."""
    judged = trace.speed > JUDGED
    first = int(np.argmax(judged & (trace.slip >= 0.9 * reference)))
    chosen = slice(first, int(np.flatnonzero(judged)[-1]) + 1)
    error, time = trace.slip[chosen] - reference, trace.time[chosen]
    rms = math.sqrt(np.trapezoid(error**2, time) / (time[-1] - time[0]))
    return trace.time[first], rms, error.max(), -error.min()
