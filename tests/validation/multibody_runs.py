"""Stops of multibody vehicles by a Runge-Kutta method of the tests' own, with the energy kept account of apart.

The stored energy is taken from the mechanics, and the work of rails, brakes and dampers from their forces and speeds: a
force that acts on other coordinates than its power tells opens a gap.
"""

import casadi as ca
import numpy as np

from wspd_design.model.wheel_rail import creep_forces, normal_force, wheel_rail
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.motion import rest_names, rolling, vehicle_motion
from wspd_design.plants.multibody.preloads import balanced


class Vehicle:
    """A vehicle on one rail as CasADi functions of its state: speed, wheel speeds, rest."""

    def __init__(self, name="er24pc-82", *, contact="er24pc", rail="polach-dry", linear=False, model=None):
        self.model = model or balanced(load_multibody(name))
        self.contact = wheel_rail(load_vehicle(contact).contact, poisson=0.25)
        self.rail = load_rail(rail)
        self.axles = self.model.wheelsets
        self.rest = rest_names(self.model)
        self.state = ca.SX.sym("x", 1 + self.axles + len(self.rest))
        self.torques, self.locked = ca.SX.sym("t", self.axles), ca.SX.sym("l", self.axles)
        self.motion = vehicle_motion(
            self.model,
            self.contact,
            speed=self.state[0],
            wheel_speeds=ca.vertsplit(self.state[1 : 1 + self.axles]),
            rest=self.state[1 + self.axles :],
            torques=ca.vertsplit(self.torques),
            locked=ca.vertsplit(self.locked),
            rails=[self.rail] * self.axles,
            linear=linear,
        )
        self.rates = ca.vertcat(
            self.motion.acceleration, *self.motion.wheel_rates, ca.densify(self.motion.rest_rates)
        )

    @property
    def names(self):
        """Names of the states."""
        return ("speed", *(f"{name}.pitch'" for name in self.model.wheelset_names), *self.rest)

    def at_speed(self, speed):
        """State of straight rolling."""
        wheel_speed = speed / self.model.numbers["wheel_radius"]
        wheel_speeds = (wheel_speed,) * self.axles
        return np.array([speed, *wheel_speeds, *rolling(self.model, speed, wheel_speeds)])

    def place_and_rates(self):
        """Coordinates, the forward ones against the first body, and rates, as expressions of the state."""
        by_name = dict(zip(self.names, ca.vertsplit(self.state), strict=True))
        first = self.model.coordinates[0]
        q = [by_name.get(name, ca.SX(0)) for name in self.model.coordinates]
        rate_names = (f"{name}'" for name in self.model.coordinates)
        v = [by_name["speed"] if name == f"{first}'" else by_name[name] for name in rate_names]
        return ca.vertcat(*q), ca.vertcat(*v)

    def account(self):
        """Stored energy [J]; powers of brakes, creepage and dampers, and apart that of the torques alone [W]."""
        n = len(self.model.coordinates)
        q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
        exact = mechanics(self.model, q, v)
        stored, creepage = sum(exact.energies), ca.SX(0)
        reference = v[0]
        for wheel, name in zip(exact.wheels, self.model.wheel_names, strict=True):
            stiffness = self.contact.normal_stiffness
            approach = wheel.approach + (self.model.preloads[name] / stiffness) ** (2 / 3)
            stored += 0.4 * stiffness * approach**2.5
            sideways = self.model.preloads[f"{self.model.wheelset_names[wheel.axle]}.sideways"]
            stored -= 0.5 * sideways * wheel.displacement
            creepages = (each / reference for each in wheel.velocity)
            forces = creep_forces(
                *creepages, reference, normal_force(approach, stiffness), self.rail, self.contact
            )
            creepage += forces[0] * wheel.velocity[0] + forces[1] * wheel.velocity[1]
        brakes = -ca.dot(ca.mtimes(exact.brake_directions, self.motion_torques()), v)
        spins = [k for k, name in enumerate(self.model.coordinates) if name.endswith(".pitch")]
        spins = [k for k in spins if self.model.coordinates[k].split(".")[0] in self.model.wheelset_names]
        couples = ca.dot(self.motion_torques(), v[spins])
        powers = [stored, brakes, creepage, exact.dissipation, couples]
        return ca.substitute(powers, [q, v], list(self.place_and_rates()))

    def motion_torques(self):
        """Braking torques that act."""
        return ca.vertcat(*self.motion.transmitted)


def runge_kutta(vehicle, torque, *, speed, duration, step, outputs=(), state=None, integrals=()):
    """Integrate a stop by the classical method.

    ``torque(t)`` is the braking torque of each wheelset as an expression of the time. Returns the states at all steps,
    the integrals over the time, and the outputs at all steps.
    """
    t = ca.SX.sym("t")
    known = [vehicle.torques, vehicle.locked]
    values = [torque(t), ca.SX.zeros(vehicle.axles)]
    rates = ca.vertcat(vehicle.rates, *integrals)
    outs = ca.vertcat(*outputs) if outputs else ca.SX.zeros(1)
    rates, outs = ca.substitute([rates, outs], known, values)
    f = ca.Function("f", [vehicle.state, t], ca.cse([rates, outs]))
    y, h = ca.MX.sym("y", rates.numel()), step
    clock = ca.MX.sym("clock")
    x = y[: vehicle.state.numel()]
    count = vehicle.state.numel()
    k1, out = f(x, clock)
    k2, _ = f(x + h / 2 * k1[:count], clock + h / 2)
    k3, _ = f(x + h / 2 * k2[:count], clock + h / 2)
    k4, _ = f(x + h * k3[:count], clock + h)
    one = ca.Function("step", [y, clock], [y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), out])
    steps = round(duration / step)
    start = vehicle.at_speed(speed) if state is None else state
    start = np.concatenate([start, np.zeros(len(integrals))])
    ys, out = one.mapaccum("stop", steps)(start, step * np.arange(steps))
    ys, out = np.array(ys), np.array(out)
    return ys[:count], ys[count:], out
