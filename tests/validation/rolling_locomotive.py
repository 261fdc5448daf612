"""The 82-degree-of-freedom locomotive rolling on Kalker's creep slopes, as expressions and as a step in time."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import casadi as ca
import numpy as np

from wspd_design.model.hertz import contact_from_radii
from wspd_design.model.wheel_rail import wheel_rail
from wspd_design.parameters.records import Rail
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.motion import rest_names, rolling, vehicle_motion
from wspd_design.plants.multibody.preloads import balanced
from wspd_design.plants.multibody.wheels import Irregularity

AXLES = 4
KALKER = Rail(
    name="kalker",
    mu0=0.5,
    friction_ratio=1.0,
    friction_decay=0.0,
    adhesion_reduction=1.0,
    slip_reduction=1.0,
)


@dataclass(frozen=True)
class RollingLocomotive:
    """Expressions over the state, and over the height of the track under each wheelset [m]."""

    state: Any
    height: Any
    rates: Any
    loads: Any  # N, of the left wheels from the front, then of the right ones
    names: tuple[str, ...]  # of the state
    radius: float  # m
    model: Any

    def rolls(self, speed):
        """State of steady rolling, everything else at rest."""
        wheel_speeds = [speed / self.radius] * AXLES
        return np.array([speed, *wheel_speeds, *rolling(self.model, speed, wheel_speeds)])

    def steps(self, length, count):
        """Return a function from a state and heights at begin, middle and end of each step to states and loads.

        By the classical method of Runge and Kutta; the loads are those at the beginning of each step.
        """
        move = ca.Function("move", [self.state, self.height], [self.rates])
        x, under = ca.MX.sym("x", len(self.names)), ca.MX.sym("under", 3 * AXLES)
        first, middle, last = ca.vertsplit(under, AXLES)
        k1 = move(x, first)
        k2 = move(x + 0.5 * length * k1, middle)
        k3 = move(x + 0.5 * length * k2, middle)
        k4 = move(x + length * k3, last)
        loads = ca.Function("loads", [self.state, self.height], [self.loads])(x, first)
        after = x + length / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return ca.Function("step", [x, under], [after, loads]).mapaccum(count)


@cache
def locomotive():
    """Suspension expanded about rest, contact as it is."""
    model = balanced(load_multibody("er24pc-82"))
    ellipse = contact_from_radii(
        wheel_load=94.2e3, wheel_radius=0.55, rail_radius=0.3, young=210e9, poisson=0.25
    )
    names = ("speed", *(f"wheel_{k}" for k in range(AXLES)), *rest_names(model))
    state, height = ca.SX.sym("state", len(names)), ca.SX.sym("height", AXLES)
    motion = vehicle_motion(
        model,
        wheel_rail(ellipse, poisson=0.25),
        speed=state[0],
        wheel_speeds=ca.vertsplit(state[1 : 1 + AXLES]),
        rest=state[1 + AXLES :],
        torques=[0.0] * AXLES,
        locked=[0.0] * AXLES,
        rails=[KALKER] * AXLES,
        irregularities=tuple(map(Irregularity, ca.vertsplit(height))),
        linear=True,
    )
    return RollingLocomotive(
        state=state,
        height=height,
        rates=ca.vertcat(motion.acceleration, *motion.wheel_rates, motion.rest_rates),
        loads=ca.vertcat(*motion.wheel_loads_left, *motion.wheel_loads_right),
        names=names,
        radius=model.numbers["wheel_radius"],
        model=model,
    )
