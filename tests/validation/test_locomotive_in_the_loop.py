"""Stops of the locomotive in the compiled loop against SciPy's integrators on the same equations.

Constant torques on even and on irregular track; the track of SciPy is the table itself, not the code of the loop.
"""

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wspd_design.codegen.bound import Bound
from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.kernels import plant_kernels
from wspd_design.codegen.plant_numbers import RAIL
from wspd_design.controllers.protocol import Command
from wspd_design.parameters.loading import load_rail, load_track_spectrum
from wspd_design.plants.locomotive import LinearLocomotive
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import Scenario, Start
from wspd_design.simulation.track import irregular_track

TORQUE, BRAKED = 20e3, 100.0  # N m, s
DRY = load_rail("table10-dry")
STOP = Scenario(rail=DRY, initial_speed=30.0, start=Start(torque=TORQUE, braking_time=BRAKED))


@dataclass(frozen=True, kw_only=True)
class Holding:
    """A law that leaves its valves closed."""

    name: str = "holding"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return ()

    def step(self, state, measurement):  # noqa: ARG002
        return (), Command(fill=0.0, vent=0.0)


def in_the_loop(plant, scenario, seconds):
    """Speed, wheel speeds and distance at the end."""
    given = replace(loop_input([(plant, scenario)], Holding()), trace_rows=2000)
    given.settings.time_limit = seconds - 0.05  # it ends at the sample after that
    out = load_closed_loop(plant, Holding()).run(given, sample_rows=sample_rows(Holding()))
    last = out.trace[-1]
    assert last[0] == pytest.approx(seconds, abs=1e-9)
    return given, np.array([last[1], *last[3:7], last[2]])


def by_scipy(plant, given, seconds, *, torque=TORQUE, track=None, **options):
    """The same, from the same start."""
    kernels = plant_kernels(plant, disturbed=False).whole
    rails = np.repeat([getattr(DRY, name) for name in RAIL], plant.axles)
    constants = kernels.vehicle_constants(given.stop_parameters[:, 0], given.numbers[:, 0], rails)
    start = np.concatenate([given.speeds, given.wheel_speeds, given.rest[:, 0], [0.0]])
    state, time = ca.SX.sym("state", len(start)), ca.SX.sym("time")
    under = ca.SX.sym("under", 3 * plant.axles)
    damping = ca.repmat(plant.wheel_damping(BRAKED + time), plant.axles, 1)
    found = kernels.vehicle(
        constants, state[0], state[1:5], state[5:-1], torque, 0.0, damping, under, BRAKED + time
    )
    rates = ca.vertcat(found[0], found[1], found[2], state[0])
    places, now, level = np.zeros(len(start)), np.zeros(1), np.zeros(3 * plant.axles)
    call = Bound(ca.Function("rates", [state, time, under], [rates]), places, now, level)
    slopes = ca.Function("slopes", [state, time, under], [ca.jacobian(rates, state)])

    def right_side(t, y):
        places[:], now[0] = y, t
        if track is not None:
            level[:] = track.at(y[-1] - np.array(plant.offsets))[0].ravel()
        call.call()
        return call.outputs[0].ravel().copy()

    if options["method"] == "Radau":
        options["jac"] = lambda t, y: np.array(slopes(y, t, level))
    reached = solve_ivp(right_side, (0.0, seconds), start, **options).y[:, -1]
    return reached[[0, 1, 2, 3, 4, -1]]


@pytest.mark.parametrize(("level", "seconds", "tolerance"), [("none", 2.0, 1e-7), ("high", 0.4, 1e-6)])
def test_braking_with_constant_torques(er24pc, level, seconds, tolerance):
    plant, scenario = LinearLocomotive(er24pc), replace(STOP, irregularities=level, seed=3)
    given, compiled = in_the_loop(plant, scenario, seconds)
    track = None if level == "none" else irregular_track(load_track_spectrum("erri-b176"), level, seed=3)
    other = by_scipy(plant, given, seconds, track=track, method="DOP853", rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(compiled, other, rtol=tolerance)


@pytest.mark.slow
def test_two_seconds_against_radau(er24pc):
    plant = LinearLocomotive(er24pc)
    given, compiled = in_the_loop(plant, STOP, 2.0)
    other = by_scipy(plant, given, 2.0, method="Radau", rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(compiled, other, rtol=1e-6)


def test_another_torque_is_seen(er24pc):
    # The planted fault: 0.2 N m more on each wheelset.
    plant = LinearLocomotive(er24pc)
    given, compiled = in_the_loop(plant, STOP, 1.0)
    other = by_scipy(plant, given, 1.0, torque=TORQUE + 0.2, method="DOP853", rtol=1e-8, atol=1e-10)
    assert not np.allclose(compiled, other, rtol=1e-7)
