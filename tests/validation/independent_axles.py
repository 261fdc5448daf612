"""A second simulation of vehicles with load transfer: eqs. (1)-(9) and the transfer written out again, with Radau.

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
V = 0


class Below(NamedTuple):
    """Friction below the axles."""

    mu0: np.ndarray
    friction_ratio: np.ndarray
    friction_decay: np.ndarray
    adhesion_reduction: np.ndarray
    slip_reduction: np.ndarray


class Standing(NamedTuple):
    """What a vehicle stands on: its axles in groups, how a transfer loads wheels, and where the axles are."""

    groups: tuple[tuple[int, ...], ...]  # axles of each bogie; none where single axles carry the body
    loading: np.ndarray  # per axle and transfer, the first by the body: of a wheel
    behind: np.ndarray  # m, each axle behind the first
    static: np.ndarray  # load of an axle over the mean


def two_bogies(vehicle):
    """Two two-axle bogies."""
    base, spacing = vehicle.wheelbase, vehicle.bogie_spacing
    body, within = 1 / 4, 1 / 2
    return Standing(
        groups=((0, 1), (2, 3)),
        loading=np.array([[body, within, 0], [body, -within, 0], [-body, 0, within], [-body, 0, -within]]),
        behind=np.array([0.0, base, spacing, spacing + base]),
        static=np.ones(4),
    )


def two_long_bogies(vehicle):
    """Two three-axle bogies, whose middle axles no pitch of the bogie loads."""
    half, spacing = 0.5 * vehicle.wheelbase, vehicle.bogie_spacing
    body, within = 1 / 6, 1 / 2
    front = [[body, within, 0], [body, 0, 0], [body, -within, 0]]
    rear = [[-body, 0, within], [-body, 0, 0], [-body, 0, -within]]
    return Standing(
        groups=((0, 1, 2), (3, 4, 5)),
        loading=np.array(front + rear),
        behind=np.array([0.0, half, 2 * half, spacing, spacing + half, spacing + 2 * half]),
        static=np.ones(6),
    )


def two_single_axles(vehicle):
    """Two axles that carry the body."""
    return Standing(
        groups=(),
        loading=np.array([[1 / 2], [-1 / 2]]),
        behind=np.array([0.0, vehicle.bogie_spacing]),
        static=np.ones(2),
    )


def two_bodies(vehicle):
    """Two bodies on three two-axle bogies; that in the middle carries two halves, and none of their pitch."""
    base, spacing = vehicle.wheelbase, vehicle.bogie_spacing
    body, within = 1 / 4, 1 / 2
    outer, inner = (share * vehicle.body_mass + vehicle.bogie_mass for share in (0.5, 1.0))
    rows = np.zeros((6, 4))
    rows[:2, 0], rows[4:, 0] = body, -body
    for bogie in range(3):
        rows[2 * bogie : 2 * bogie + 2, 1 + bogie] = within, -within
    return Standing(
        groups=((0, 1), (2, 3), (4, 5)),
        loading=rows,
        behind=np.array([bogie * spacing + axle for bogie in range(3) for axle in (0.0, base)]),
        static=np.repeat([outer, inner, outer], 2) * 3.0 / vehicle.mass,
    )


class IndependentAxles:
    """State: v, omega of the axles, distance, P / P_max of the axles, load transfers [N] and their rates."""

    def __init__(self, vehicle, rail, *, standing=None, shares=None, patches=(), grade=0.0, rtol=1e-8):
        self.vehicle, self.brake, self.rtol = vehicle, vehicle.brake, rtol
        self.standing = standing or two_bogies(vehicle)
        axles, transfers = self.standing.loading.shape
        self.axles, self.shares = axles, np.ones(axles) if shares is None else np.array(shares)
        self.W, self.X = slice(1, axles + 1), axles + 1
        self.P = slice(self.X + 1, self.X + 1 + axles)
        self.Z = slice(self.P.stop, self.P.stop + transfers)
        self.DZ = slice(self.Z.stop, self.Z.stop + transfers)
        self.rails, self.starts = [rail, *(rail for _, rail in patches)], [start for start, _ in patches]
        self.reached = np.zeros(axles, dtype=int)  # of the rails, per axle
        self.behind = self.standing.behind
        self.climbing = vehicle.mass * GRAVITY * grade
        self.static = vehicle.mass * GRAVITY / (2 * axles) * self.standing.static
        contact = vehicle.contact
        self.slope = 0.25 * math.pi * contact.shear_modulus * contact.kalker_c11
        self.slope *= contact.semi_axis_rolling * contact.semi_axis_lateral
        self.modes = (
            2.0
            * math.pi
            * np.array(
                [vehicle.body_pitch_frequency, *[vehicle.bogie_pitch_frequency] * len(self.standing.groups)]
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
        """Half of an axle's transfer on each wheel; the body's is shared by the axles of a bogie."""
        return self.static + self.standing.loading @ transfer

    def rates(self, t, y, fill, vent, locked):
        c, v, omega, p = self.vehicle, y[V], y[self.W], y[self.P]
        f = self.creep_forces(v, omega, self.loads(y[self.Z]))
        resistance = c.resistance_constant + c.resistance_linear * v + c.resistance_quadratic * v**2
        resistance += self.climbing
        a = -(resistance + 2.0 * f.sum()) / c.mass
        damping = c.wheel_damping * math.exp(-c.wheel_damping_decay * t)
        turning = (c.wheel_radius * f - 0.5 * self.brake.max_torque * self.shares * p - damping * omega) / (
            0.5 * c.wheelset_inertia
        )
        # Quasi-static transfer: the body's inertia above the traction rods, the rods' pull and the bogie's inertia.
        held = -a - self.climbing / c.mass  # what is held beside gravity
        body = c.body_mass * held * (c.body_height - c.traction_rod_height) / c.bogie_spacing
        inertia = c.bogie_mass * held
        groups = self.standing.groups or [(axle,) for axle in range(self.axles)]
        moments = [
            inertia * c.bogie_height + (2.0 * f[list(group)].sum() - inertia) * c.traction_rod_height
            for group in groups
        ]
        if self.standing.groups:
            target = np.array([body, *(moment / c.wheelbase for moment in moments)])
        else:  # nothing but the body takes up the moments of single axles
            target = np.array([body + sum(moments) / c.bogie_spacing])
        bending = self.modes**2 * (target - y[self.Z])
        bending -= 2.0 * c.pitch_damping_ratio * self.modes * y[self.DZ]
        supply = 1.0 - math.exp(-self.brake.supply_rate * t)
        pressing = fill * (supply - p) / self.brake.fill_time - vent * p / self.brake.vent_time
        return np.concatenate([[a], np.where(locked, 0.0, turning), [v], pressing, y[self.DZ], bending])

    def run(self, controller, initial_speed):
        """Brake to standstill; returns time and state."""
        y = np.zeros(self.DZ.stop)
        y[V], y[self.W] = initial_speed, initial_speed / self.vehicle.wheel_radius
        states = [controller.start(m) for m in self.measure(y)]
        t, locked, h = 0.0, np.zeros(self.axles, dtype=bool), controller.sample_time
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
            Measurement(speed=y[V], wheel_speed=w, torque=self.brake.max_torque * share * p)
            for w, share, p in zip(y[self.W], self.shares, y[self.P], strict=True)
        ]

    def advance(self, t, end, y, fill, vent, locked):
        def standstill(_t, y):
            return y[V] - STOP_SPEED

        def change(axle):
            def lock_or_release(_t, y):
                if not locked[axle]:
                    return y[self.W][axle]
                force = self.creep_forces(y[V], y[self.W], self.loads(y[self.Z]))[axle]
                return (
                    0.5 * self.brake.max_torque * self.shares[axle] * y[self.P][axle]
                    - self.vehicle.wheel_radius * force
                )

            lock_or_release.terminal, lock_or_release.direction = True, -1.0
            return lock_or_release

        def change_of_rail(axle):
            start = self.starts[self.reached[axle]] if self.reached[axle] < len(self.starts) else math.inf

            def place(_t, y):
                return y[self.X] - self.behind[axle] - start if start < math.inf else -1.0

            place.terminal, place.direction = True, 1.0
            return place

        standstill.terminal = True
        n = self.axles
        solution = solve_ivp(
            lambda t, y: self.rates(t, y, fill, vent, locked),
            (t, end),
            y,
            method="Radau",
            rtol=self.rtol,
            atol=0.01
            * self.rtol
            * np.concatenate(
                [[1.0], np.full(n, 10.0), [1e3], np.full(n, 0.1), np.full(2 * len(self.modes), 1e5)]
            ),
            events=[
                standstill,
                *(change(axle) for axle in range(self.axles)),
                *(change_of_rail(axle) for axle in range(self.axles)),
            ],
        )
        assert solution.success, solution.message
        y, locked = solution.y[:, -1].copy(), locked.copy()
        for axle in range(self.axles):
            if solution.t_events[1 + axle].size > 0:
                locked[axle] = not locked[axle]
                y[self.W][axle] = 0.0
            if solution.t_events[1 + self.axles + axle].size > 0:
                self.reached[axle] += 1
        return solution.t[-1], y, locked, solution.t_events[0].size > 0
