"""A second simulation of the four-axle locomotive: eqs. (1)-(9) and the load transfer written out again, with Radau.

As for the quarter locomotive it shares nothing with the package but the numbers of the records and the sampled
controllers. Cylinder pressures are integrated, SciPy steps from valve edge to valve edge and finds the locks.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from wspd_design.controllers.protocol import Measurement

GRAVITY = 9.81
SLIP_REFERENCE_SPEED = 0.1  # m/s, the regularization that the data book names
STOP_SPEED = 0.005  # m/s
AXLES = 4
SIGNS = np.array(
    [[1, 1, 0], [1, -1, 0], [-1, 0, 1], [-1, 0, -1]]
)  # of body, front and rear bogie pitch, per axle
V, W, X, P, Z, DZ = 0, slice(1, 5), 5, slice(6, 10), slice(10, 13), slice(13, 16)


class Below(NamedTuple):
    """Friction below the axles."""

    mu0: np.ndarray
    friction_ratio: np.ndarray
    friction_decay: np.ndarray
    adhesion_reduction: np.ndarray
    slip_reduction: np.ndarray


class IndependentFourAxles:
    """State: v, four omega, distance, four P / P_max, load transfer of body and bogies [N] and its rates."""

    def __init__(self, vehicle, rail, *, patches=(), grade=0.0, rtol=1e-8):
        self.vehicle, self.brake, self.rtol = vehicle, vehicle.brake, rtol
        self.rails, self.starts = [rail, *(rail for _, rail in patches)], [start for start, _ in patches]
        self.reached = np.zeros(AXLES, dtype=int)  # of the rails, per axle
        self.behind = np.array(
            [0.0, vehicle.wheelbase, vehicle.bogie_spacing, vehicle.bogie_spacing + vehicle.wheelbase]
        )
        self.climbing = vehicle.mass * GRAVITY * grade
        self.static = vehicle.mass * GRAVITY / 8.0
        contact = vehicle.contact
        self.slope = 0.25 * math.pi * contact.shear_modulus * contact.kalker_c11
        self.slope *= contact.semi_axis_rolling * contact.semi_axis_lateral
        self.modes = (
            2.0
            * math.pi
            * np.array(
                [vehicle.body_pitch_frequency, vehicle.bogie_pitch_frequency, vehicle.bogie_pitch_frequency]
            )
        )

    @property
    def friction(self):
        """Numbers of the rails below the axles, as vectors."""
        below = [self.rails[k] for k in self.reached]
        return Below(*(np.array([getattr(rail, name) for rail in below]) for name in Below._fields))

    def creep_forces(self, v, omega, load):
        rail, sliding = self.friction, v - self.vehicle.wheel_radius * omega
        slip = sliding / max(v, SLIP_REFERENCE_SPEED)
        mu = rail.mu0 * (
            (1.0 - rail.friction_ratio) * np.exp(-rail.friction_decay * abs(sliding)) + rail.friction_ratio
        )
        stiffness = self.slope * (load / self.vehicle.contact.reference_load) ** (2.0 / 3.0)
        epsilon = stiffness * slip / (load * mu)
        adhering = rail.adhesion_reduction * epsilon / (1.0 + (rail.adhesion_reduction * epsilon) ** 2)
        return 2.0 * load * mu / math.pi * (adhering + np.arctan(rail.slip_reduction * epsilon))

    def loads(self, transfer):
        """Half of an axle's transfer on each wheel; the body's is shared by the two axles of a bogie."""
        return self.static + SIGNS @ (transfer * np.array([0.25, 0.5, 0.5]))

    def rates(self, t, y, fill, vent, locked):
        c, v, omega, p = self.vehicle, y[V], y[W], y[P]
        f = self.creep_forces(v, omega, self.loads(y[Z]))
        resistance = c.resistance_constant + c.resistance_linear * v + c.resistance_quadratic * v**2
        resistance += self.climbing
        a = -(resistance + 2.0 * f.sum()) / c.mass
        damping = c.wheel_damping * math.exp(-c.wheel_damping_decay * t)
        turning = (c.wheel_radius * f - 0.5 * self.brake.max_torque * p - damping * omega) / (
            0.5 * c.wheelset_inertia
        )
        # Quasi-static transfer: the body's inertia above the traction rods, the rods' pull and the bogie's inertia.
        held = -a - self.climbing / c.mass  # what is held beside gravity
        body = c.body_mass * held * (c.body_height - c.traction_rod_height) / c.bogie_spacing
        inertia = c.bogie_mass * held
        bogies = [
            (inertia * c.bogie_height + (2.0 * pair.sum() - inertia) * c.traction_rod_height) / c.wheelbase
            for pair in (f[:2], f[2:])
        ]
        bending = self.modes**2 * (np.array([body, *bogies]) - y[Z])
        bending -= 2.0 * c.pitch_damping_ratio * self.modes * y[DZ]
        supply = 1.0 - math.exp(-self.brake.supply_rate * t)
        pressing = fill * (supply - p) / self.brake.fill_time - vent * p / self.brake.vent_time
        return np.concatenate([[a], np.where(locked, 0.0, turning), [v], pressing, y[DZ], bending])

    def run(self, controller, initial_speed):
        """Brake to standstill; returns time and state."""
        y = np.zeros(16)
        y[V], y[W] = initial_speed, initial_speed / self.vehicle.wheel_radius
        states = [controller.start(m) for m in self.measure(y)]
        t, locked, h = 0.0, np.zeros(AXLES, dtype=bool), controller.sample_time
        for sample in range(10_000):
            steps = [controller.step(s, m) for s, m in zip(states, self.measure(y), strict=True)]
            states = [state for state, _ in steps]
            fill_end = np.array([sample * h + command.fill * h for _, command in steps])
            vent_end = np.array(
                [end + command.vent * h for end, (_, command) in zip(fill_end, steps, strict=True)]
            )
            edges = [e for e in sorted({*fill_end, *vent_end, (sample + 1) * h}) if e > t + 1e-9]
            for edge in edges:
                while t < edge - 1e-12:
                    middle = 0.5 * (t + edge)
                    fill, vent = middle < fill_end, (middle > fill_end) & (middle < vent_end)
                    t, y, locked, stopped = self.advance(t, edge, y, fill * 1.0, vent * 1.0, locked)
                    if stopped:
                        return t, y
        raise AssertionError("the train does not stop")

    def measure(self, y):
        return [
            Measurement(speed=y[V], wheel_speed=w, torque=self.brake.max_torque * p)
            for w, p in zip(y[W], y[P], strict=True)
        ]

    def advance(self, t, end, y, fill, vent, locked):
        def standstill(_t, y):
            return y[V] - STOP_SPEED

        def change(axle):
            def lock_or_release(_t, y):
                if not locked[axle]:
                    return y[W][axle]
                force = self.creep_forces(y[V], y[W], self.loads(y[Z]))[axle]
                return 0.5 * self.brake.max_torque * y[P][axle] - self.vehicle.wheel_radius * force

            lock_or_release.terminal, lock_or_release.direction = True, -1.0
            return lock_or_release

        def change_of_rail(axle):
            start = self.starts[self.reached[axle]] if self.reached[axle] < len(self.starts) else math.inf

            def place(_t, y):
                return y[X] - self.behind[axle] - start if start < math.inf else -1.0

            place.terminal, place.direction = True, 1.0
            return place

        standstill.terminal = True
        solution = solve_ivp(
            lambda t, y: self.rates(t, y, fill, vent, locked),
            (t, end),
            y,
            method="Radau",
            rtol=self.rtol,
            atol=0.01
            * self.rtol
            * np.concatenate([[1.0], np.full(4, 10.0), [1e3], np.full(4, 0.1), np.full(6, 1e5)]),
            events=[
                standstill,
                *(change(axle) for axle in range(AXLES)),
                *(change_of_rail(axle) for axle in range(AXLES)),
            ],
        )
        assert solution.success, solution.message
        y, locked = solution.y[:, -1].copy(), locked.copy()
        for axle in range(AXLES):
            if solution.t_events[1 + axle].size > 0:
                locked[axle] = not locked[axle]
                y[W][axle] = 0.0
            if solution.t_events[1 + AXLES + axle].size > 0:
                self.reached[axle] += 1
        return solution.t[-1], y, locked, solution.t_events[0].size > 0
