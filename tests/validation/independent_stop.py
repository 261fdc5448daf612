"""A second simulation of the stop, written from the paper alone and integrated by SciPy's Radau method.

It shares nothing with the package but the numbers of the records and the sampled controllers: eqs. (1)-(9) are
written out again, the cylinder pressure is integrated instead of solved, and SciPy finds the events.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from wspd_design.controllers.protocol import Measurement

GRAVITY = 9.81
SLIP_REFERENCE_SPEED = 0.1  # m/s, the regularization that the data book names
STOP_SPEED = 0.005  # m/s


class IndependentStop:
    """The quarter locomotive of the paper in the variables (v, omega, distance, P / P_max)."""

    def __init__(self, vehicle, rail):
        contact, brake = vehicle.contact, vehicle.brake
        self.m, self.R, self.I = vehicle.mass, vehicle.wheel_radius, vehicle.wheelset_inertia / 2.0
        self.resistance = (
            vehicle.resistance_constant,
            vehicle.resistance_linear,
            vehicle.resistance_quadratic,
        )
        self.damping = (vehicle.wheel_damping, vehicle.wheel_damping_decay)
        self.Q = self.m * GRAVITY / 8.0
        ellipse = (
            contact.semi_axis_rolling
            * contact.semi_axis_lateral
            * (self.Q / contact.reference_load) ** (2 / 3)
        )
        self.Gabc11 = contact.shear_modulus * ellipse * contact.kalker_c11
        self.rail, self.brake = rail, brake

    def creep_force(self, v, omega):
        rail = self.rail
        slip = (v - self.R * omega) / max(v, SLIP_REFERENCE_SPEED)
        mu = rail.mu0 * (
            (1.0 - rail.friction_ratio) * math.exp(-rail.friction_decay * abs(v - self.R * omega))
            + rail.friction_ratio
        )
        epsilon = 0.25 * self.Gabc11 * math.pi * slip / (self.Q * mu)
        adhering = rail.adhesion_reduction * epsilon / (1.0 + (rail.adhesion_reduction * epsilon) ** 2)
        return 2.0 * self.Q * mu / math.pi * (adhering + math.atan(rail.slip_reduction * epsilon))

    def rates(self, t, y, fill, vent, locked):
        v, omega, _, p = y
        t += self.braking_time
        f = self.creep_force(v, omega)
        a0, a1, a2 = self.resistance
        damping = self.damping[0] * math.exp(-self.damping[1] * t)
        torque = self.brake.max_torque * p
        supply = 1.0 - math.exp(-self.brake.supply_rate * t)
        return (
            -(a0 + a1 * v + a2 * v**2 + 8.0 * f) / self.m,
            0.0 if locked else (-0.5 * torque - damping * omega + self.R * f) / self.I,
            v,
            fill * (supply - p) / self.brake.fill_time - vent * p / self.brake.vent_time,
        )

    def run(self, controller, initial_speed, duration=math.inf, *, slip=0.0, torque=0.0, braking_time=0.0):
        """Brake to standstill, or for a duration; return the states (v, omega, distance, P/P_max) and the time."""
        y = np.array(
            [initial_speed, initial_speed * (1.0 - slip) / self.R, 0.0, torque / self.brake.max_torque]
        )
        self.braking_time = braking_time
        state = controller.start(self._measure(y))
        t, locked, sample, h = 0.0, False, 0, controller.sample_time
        while t < duration:
            state, command = controller.step(state, self._measure(y))
            edges = (0.0, command.fill, command.fill + command.vent, 1.0)
            for (fill, vent), begin, end in zip(((1, 0), (0, 1), (0, 0)), edges, edges[1:], strict=False):
                end_time = (sample + end) * h
                if end - begin < 1e-9:
                    continue
                while t < end_time - 1e-12:
                    t, y, locked, stopped = self._advance(t, end_time, y, fill, vent, locked)
                    if stopped:
                        return t, y
            sample += 1
        return t, y

    def _measure(self, y):
        return Measurement(speed=y[0], wheel_speed=y[1], torque=self.brake.max_torque * y[3])

    tolerances = (1e-10, 1e-10, 1e-7, 1e-12)

    def _lock(self, y, locked):
        """What is positive until the wheel locks, or is let go."""
        if locked:
            return 0.5 * self.brake.max_torque * y[3] - self.R * self.creep_force(y[0], 0.0)
        return y[1]

    def _advance(self, t, end, y, fill, vent, locked):
        def standstill(_t, y):
            return y[0] - STOP_SPEED

        def change(_t, y):
            return self._lock(y, locked)

        standstill.terminal = change.terminal = True
        change.direction = -1.0
        solution = solve_ivp(
            lambda t, y: self.rates(t, y, fill, vent, locked),
            (t, end),
            y,
            method="Radau",
            rtol=1e-9,
            atol=self.tolerances,
            events=(standstill, change),
        )
        assert solution.success, solution.message
        t, y = solution.t[-1], solution.y[:, -1].copy()
        stopped = solution.t_events[0].size > 0
        if solution.t_events[1].size > 0:
            locked = not locked
            y[1] = 0.0
        return t, y, locked, stopped
