"""The same stop by SciPy and by python-control: their solvers, a right-hand side in Python, from edge to edge.

The right-hand side is written twice: in plain Python on floats, which is the fastest for four axles, and in NumPy on
vectors of four, as most would write it. The torque is in closed form as in the compiled loop, so that the solvers
see no discontinuity within a call.
"""

import math
import warnings

import control
import numpy as np
from case import LAW, RAIL, SPEED, VEHICLE
from scipy.integrate import solve_ivp

from wspd_design.controllers.protocol import Measurement

AXLES = VEHICLE.wheelsets
STOP_SPEED = 0.005
TOLERANCES = {"rtol": 1e-6, "atol": 1e-8}
NEAR_ROUNDING = {"rtol": 1e-12, "atol": 1e-12}
exp, atan, pi = math.exp, math.atan, math.pi


class Valves:
    """Torque of every axle within one sample."""

    def __init__(self) -> None:
        self.start, self.pressure = 0.0, [0.0] * AXLES
        self.fill_end, self.vent_end = [0.0] * AXLES, [0.0] * AXLES

    def pressures(self, t: float) -> list[float]:
        b = VEHICLE.brake
        r, pmax, start = b.supply_rate, b.max_pressure, self.start
        result = []
        for from_, fill_end, vent_end in zip(self.pressure, self.fill_end, self.vent_end, strict=True):
            x = min(t, fill_end)
            passed = exp((start - x) / b.fill_time)
            p = pmax * (1.0 - (exp(-r * x) - passed * exp(-r * start)) / (1.0 - b.fill_time * r))
            p += passed * (from_ - pmax)
            vented = min(t, vent_end) - fill_end
            result.append(p * exp(-vented / b.vent_time) if vented > 0.0 else p)
        return result

    def command(self, t: float, commands: list) -> list[float]:
        """Take the commands at a sampling instant; returns the edges up to the next one."""
        h, self.pressure, self.start = LAW.sample_time, self.pressures(t), t
        self.fill_end = [t + command.fill * h for command in commands]
        self.vent_end = [t + h for _ in commands]  # the law vents for the rest of the sample
        edges = sorted({edge for edge in self.fill_end if t + 1e-9 < edge < t + h - 1e-9})
        return [*edges, t + h]


def initial_slope(contact):
    """Slope of the creep force at zero slip under the reference load [N]."""
    area = contact.semi_axis_rolling * contact.semi_axis_lateral
    return 0.25 * pi * contact.shear_modulus * contact.kalker_c11 * area


def make_rates(valves: Valves, locked: list[bool]):
    """Right-hand side of (v, four omega, distance, three load transfers and their rates)."""
    c, rail = VEHICLE, RAIL
    static, radius = c.mass * 9.81 / 8.0, c.wheel_radius
    contact = c.contact
    slope = initial_slope(contact)
    unit = c.brake.max_torque / c.brake.max_pressure
    body_omega, bogie_omega = 2.0 * pi * c.body_pitch_frequency, 2.0 * pi * c.bogie_pitch_frequency
    drag = 2.0 * c.pitch_damping_ratio

    def rates(t, y):
        v, w1, w2, w3, w4, _, zb, zf, zr, db, df, dr = y.tolist()
        by_body = 0.25 * zb
        loads = (
            static + by_body + 0.5 * zf,
            static + by_body - 0.5 * zf,
            static - by_body + 0.5 * zr,
            static - by_body - 0.5 * zr,
        )
        reference = v if v > 0.1 else 0.1
        damping = c.wheel_damping * exp(-c.wheel_damping_decay * t)
        forces, turning = [], []
        for w, load, p, is_locked in zip((w1, w2, w3, w4), loads, valves.pressures(t), locked, strict=True):
            sliding = v - radius * w
            mu = rail.mu0 * (
                rail.friction_ratio + (1.0 - rail.friction_ratio) * exp(-rail.friction_decay * abs(sliding))
            )
            stiffness = slope * (load / contact.reference_load) ** (2.0 / 3.0)
            eps = stiffness * sliding / (reference * mu * load)
            x = rail.adhesion_reduction * eps
            force = 2.0 * mu * load / pi * (x / (1.0 + x * x) + atan(rail.slip_reduction * eps))
            forces.append(force)
            turning.append(
                0.0 if is_locked else (radius * force - 0.5 * unit * p - damping * w) / c.wheel_inertia
            )
        resistance = c.resistance_constant + c.resistance_linear * v + c.resistance_quadratic * v * v
        a = -(2.0 * sum(forces) + resistance) / c.mass
        own = -c.bogie_mass * a
        body = -c.body_mass * a * (c.body_height - c.traction_rod_height) / c.bogie_spacing
        front, rear = (
            (own * c.bogie_height + (2.0 * pair - own) * c.traction_rod_height) / c.wheelbase
            for pair in (forces[0] + forces[1], forces[2] + forces[3])
        )
        return (
            a,
            *turning,
            v,
            *(db, df, dr),
            body_omega * (body_omega * (body - zb) - drag * db),
            bogie_omega * (bogie_omega * (front - zf) - drag * df),
            bogie_omega * (bogie_omega * (rear - zr) - drag * dr),
        )

    return rates


def make_numpy_rates(valves: Valves, locked: list[bool]):
    """The same with the axles as vectors."""
    c, rail, contact = VEHICLE, RAIL, VEHICLE.contact
    slope = initial_slope(contact)
    unit, static = c.brake.max_torque / c.brake.max_pressure, c.mass * 9.81 / 8.0
    shares = np.array([[0.25, 0.5, 0.0], [0.25, -0.5, 0.0], [-0.25, 0.0, 0.5], [-0.25, 0.0, -0.5]])
    omega = 2.0 * pi * np.array([c.body_pitch_frequency, c.bogie_pitch_frequency, c.bogie_pitch_frequency])

    def rates(t, y):
        v, w = y[0], y[1:5]
        load = static + shares @ y[6:9]
        sliding = v - c.wheel_radius * w
        falling = (1.0 - rail.friction_ratio) * np.exp(-rail.friction_decay * np.abs(sliding))
        mu = rail.mu0 * (rail.friction_ratio + falling)
        stiffness = slope * (load / contact.reference_load) ** (2.0 / 3.0)
        eps = stiffness * sliding / (max(v, 0.1) * mu * load)
        x = rail.adhesion_reduction * eps
        force = 2.0 * mu * load / pi * (x / (1.0 + x * x) + np.arctan(rail.slip_reduction * eps))
        torque = unit * np.array(valves.pressures(t))
        damping = c.wheel_damping * exp(-c.wheel_damping_decay * t)
        turning = (c.wheel_radius * force - 0.5 * torque - damping * w) / c.wheel_inertia
        a = -(
            2.0 * force.sum()
            + c.resistance_constant
            + c.resistance_linear * v
            + c.resistance_quadratic * v * v
        )
        a /= c.mass
        own = -c.bogie_mass * a
        target = np.empty(3)
        target[0] = -c.body_mass * a * (c.body_height - c.traction_rod_height) / c.bogie_spacing
        pairs = 2.0 * force.reshape(2, 2).sum(axis=1)
        target[1:] = (own * c.bogie_height + (pairs - own) * c.traction_rod_height) / c.wheelbase
        rate = np.empty(12)
        rate[0], rate[1:5], rate[5] = a, np.where(locked, 0.0, turning), v
        rate[6:9] = y[9:12]
        rate[9:12] = omega * (omega * (target - y[6:9]) - 2.0 * c.pitch_damping_ratio * y[9:12])
        return rate

    return rates


def start() -> np.ndarray:
    y = np.zeros(12)
    y[0], y[1:5] = SPEED, SPEED / VEHICLE.wheel_radius
    return y


def samples(valves: Valves, y: np.ndarray, until: float):
    """Ask the controllers at every sample; yields the edges, and takes the state at the end of the sample."""
    torque_per_pressure = VEHICLE.brake.max_torque / VEHICLE.brake.max_pressure
    states, t, index = [LAW.start(None)] * AXLES, 0.0, 0
    while t < until - 1e-9:
        seen = [
            Measurement(speed=float(y[0]), wheel_speed=float(w), torque=torque_per_pressure * p)
            for w, p in zip(y[1:5], valves.pressures(t), strict=True)
        ]
        decided = [LAW.step(state, m) for state, m in zip(states, seen, strict=True)]
        states = [state for state, _ in decided]
        edges = valves.command(t, [command for _, command in decided])
        index += 1
        y = yield t, [*edges[:-1], index * LAW.sample_time]
        t = index * LAW.sample_time


def scipy_stop(make=make_rates, *, method: str = "RK45", tolerances: dict = TOLERANCES) -> float:
    """Brake to standstill with ``solve_ivp``; returns the distance."""
    valves, locked, y = Valves(), [False] * AXLES, start()
    rates = make(valves, locked)

    def standstill(_t, y):
        return y[0] - STOP_SPEED

    def lock(_t, y):
        return min((w for w, is_locked in zip(y[1:5], locked, strict=True) if not is_locked), default=1.0)

    standstill.terminal = lock.terminal = True
    run = samples(valves, y, math.inf)
    t, edges = next(run)
    while True:
        for edge in edges:
            while t < edge - 1e-12:
                solution = solve_ivp(
                    rates, (t, edge), y, method=method, events=(standstill, lock), **tolerances
                )
                t, y = solution.t[-1], solution.y[:, -1]
                if solution.t_events[0].size:
                    return float(y[5])
                if solution.t_events[1].size:
                    wheel = 1 + int(np.argmin(np.where(locked, np.inf, y[1:5])))
                    y[wheel], locked[wheel - 1] = 0.0, True
        t, edges = run.send(y)


def reference_stop() -> float:
    """Distance by an implicit method with tolerances near rounding; shares no code with the compiled loop."""
    return scipy_stop(method="Radau", tolerances=NEAR_ROUNDING)


def rk4_stop() -> float:
    """Brake to standstill as a good engineer would write it: Runge-Kutta in plain Python, one step per segment.

    Near standstill the creep stiffness asks for shorter ones. Returns the distance.
    """
    c, rail, contact = VEHICLE, RAIL, VEHICLE.contact
    slope = initial_slope(contact)
    fastest = 2.0 / pi * (rail.adhesion_reduction + rail.slip_reduction) * slope * c.wheel_radius**2
    fastest *= 1.5 / c.wheel_inertia  # the front axle carries more than its share
    valves, locked, y = Valves(), [False] * AXLES, start()
    rates = make_rates(valves, locked)
    run = samples(valves, y, math.inf)
    t, edges = next(run)
    while True:
        for edge in edges:
            parts = max(1, math.ceil((edge - t) * fastest / (2.0 * max(y[0], 0.1))))
            h = (edge - t) / parts
            for _ in range(parts):
                before = y
                k1 = np.array(rates(t, y))
                k2 = np.array(rates(t + 0.5 * h, y + 0.5 * h * k1))
                k3 = np.array(rates(t + 0.5 * h, y + 0.5 * h * k2))
                k4 = np.array(rates(t + h, y + h * k3))
                y = y + h / 6.0 * (k1 + k4 + 2.0 * (k2 + k3))
                t += h
                for axle in range(AXLES):
                    if y[1 + axle] < 0.0:
                        y[1 + axle], locked[axle] = 0.0, True
                if y[0] <= STOP_SPEED:
                    share = (before[0] - STOP_SPEED) / (before[0] - y[0])
                    return float(before[5] + share * (y[5] - before[5]))
            t = edge
        t, edges = run.send(y)


def control_stop(until: float) -> float:
    """Brake for a time with python-control's ``input_output_response``; returns the distance."""
    valves, y = Valves(), start()
    rates = make_rates(valves, [False] * AXLES)
    system = control.nlsys(lambda t, x, _u, _p: np.array(rates(t, x)), None, inputs=0, outputs=12, states=12)
    run = samples(valves, y, until)
    t, edges = next(run)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        while True:
            for edge in edges:
                response = control.input_output_response(
                    system, [t, edge], X0=y, solve_ivp_method="RK45", solve_ivp_kwargs=TOLERANCES
                )
                t, y = edge, response.states[:, -1]
            try:
                t, edges = run.send(y)
            except StopIteration:
                return float(y[5])
