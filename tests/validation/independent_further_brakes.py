"""A second simulation of pads, electrodynamic brake and track brake: written out again, integrated by SciPy's Radau.

It adds to :mod:`independent_stop` two integrated states, the temperature of the pads and the level of the
electrodynamic brake. Corners are rounded by the polynomial that integrating the bump twice gives.
"""

import math

import numpy as np
from independent_stop import IndependentStop
from numpy.polynomial import Polynomial

from wspd_design.controllers.protocol import Measurement

BUMP = Polynomial(
    [15 / 16, 0.0, -15 / 8, 0.0, 15 / 16]
)  # second derivative of a rounded corner, over [-1, 1]
CORNER = BUMP.integ(2, lbnd=-1.0)
WIDTH, WARM_WIDTH, POWER_WIDTH = 0.5, 10.0, 0.05  # m/s, K, of the torque: as the documentation names them


def corner(x, width):
    if abs(x) >= width:
        return max(x, 0.0)
    return width * CORNER(x / width)


def rounded(x, points, values, width):
    """The table at a place: its broken line, with each bend in the rounded form."""
    slopes = np.concatenate([[0.0], np.diff(values) / np.diff(points), [0.0]])
    return values[0] + sum(
        bend * corner(x - point, width) for point, bend in zip(points, np.diff(slopes), strict=True)
    )


class IndependentFurtherBrakes(IndependentStop):
    """States (v, omega, distance, P / P_max, temperature of the pads, level of the electrodynamic brake)."""

    def __init__(self, vehicle, rail):
        super().__init__(vehicle, rail)
        self.pads, self.dynamic, self.magnets = vehicle.pads, vehicle.dynamic, vehicle.track_brake
        self.axles = vehicle.wheelsets

    def electric(self, omega, level):
        brake, rim = self.dynamic, self.R * omega
        if brake is None:
            return 0.0
        power = brake.power / max(omega, 1e-3)
        most = brake.torque - corner(brake.torque - power, POWER_WIDTH * brake.torque)
        gone = corner(rim - brake.cut_out_speed, WIDTH) - corner(rim - brake.fade_speed, WIDTH)
        return level * most * gone / (brake.fade_speed - brake.cut_out_speed)

    def friction(self, omega, p, temperature):
        torque, pads = self.brake.max_torque * p, self.pads
        if pads is not None and pads.speeds:
            torque *= rounded(self.R * omega, pads.speeds, pads.speed_factors, WIDTH)
        if pads is not None and pads.temperatures:
            torque *= rounded(temperature, pads.temperatures, pads.temperature_factors, WARM_WIDTH)
        return torque

    def pulled(self, v, t):
        brake = self.magnets
        if brake is None:
            return 0.0
        force = brake.force * (1.0 - math.exp(-t / brake.build_up_time))
        if brake.speeds:
            force *= rounded(v, brake.speeds, brake.speed_factors, WIDTH)
        out = brake.cut_out_speed
        return force * (corner(v - out + WIDTH, WIDTH) - corner(v - out - WIDTH, WIDTH)) / (2.0 * WIDTH)

    def rates(self, t, y, fill, vent, locked):
        v, omega, _, p, temperature, level = y
        given = self.friction(omega, p, temperature)
        electric = self.electric(omega, level)
        deceleration, turning, distance, pressing = super().rates(t, y[:4], 0.0, 0.0, locked)
        if not locked:  # the other simulation knows the nominal torque alone
            turning += 0.5 * (self.brake.max_torque * p - given - electric) / self.I
        supply = (
            self.share * (1.0 - math.exp(-self.brake.supply_rate * t)) if self.left is None else self.left
        )
        pressing = fill * (supply - p) / self.brake.fill_time - vent * p / self.brake.vent_time
        warming = 0.0
        if self.pads is not None and self.pads.temperatures:
            warming = (given * omega - self.pads.cooling * temperature) / self.pads.heat_capacity
        rising = 0.0 if self.dynamic is None else (self.goal - level) / self.dynamic.build_up_time
        return deceleration - self.pulled(v, t) / self.m, turning, distance, pressing, warming, rising

    def run(self, controller, initial_speed):
        """Brake to standstill; return time and states, and when the electrodynamic brake dropped out."""
        y = np.array([initial_speed, initial_speed / self.R, 0.0, 0.0, 0.0, 0.0])
        self.braking_time, self.goal, dropped = 0.0, 1.0, math.nan
        state = controller.start(self._measure(y))
        t, locked, sample, h = 0.0, False, 0, controller.sample_time
        while True:
            state, command = controller.step(state, self._measure(y))
            slip = (y[0] - self.R * y[1]) / max(y[0], 0.1)
            if self.dynamic is not None and slip > self.dynamic.drop_slip and self.goal:
                self.goal, dropped = 0.0, t
            self.share = max(1.0 - self.electric(y[1], y[5]) / self.brake.max_torque, 0.0)
            left = self.share * (1.0 - math.exp(-self.brake.supply_rate * t))
            self.left = left if y[3] > left else None  # what a cylinder that has more is let down to
            edges = (0.0, command.fill, command.fill + command.vent, 1.0)
            for (fill, vent), begin, end in zip(((1, 0), (0, 1), (0, 0)), edges, edges[1:], strict=False):
                end_time = (sample + end) * h
                while end - begin > 1e-9 and t < end_time - 1e-12:
                    t, y, locked, stopped = self._advance(t, end_time, y, fill, vent, locked)
                    if stopped:
                        return t, y, dropped
            sample += 1

    def _measure(self, y):
        nominal = self.brake.max_torque * y[3] + self.electric(y[1], y[5])
        return Measurement(speed=y[0], wheel_speed=y[1], torque=nominal)

    def _lock(self, y, locked):
        if locked:
            return 0.5 * self.friction(0.0, y[3], y[4]) - self.R * self.creep_force(y[0], 0.0)
        return y[1]

    tolerances = (1e-10, 1e-10, 1e-7, 1e-12, 1e-8, 1e-11)
