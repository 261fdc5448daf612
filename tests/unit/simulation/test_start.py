"""Stops that start from a state: slip, torque and the time since the brake was applied."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from wspd_design.controllers.protocol import Command
from wspd_design.model.brake import torque_disturbance
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.metrics import energy_residual, metrics, momentum_residual
from wspd_design.simulation.records import Scenario, Start
from wspd_design.simulation.start import available_torque, full_supply_time, holding_torque, leaving_time
from wspd_design.simulation.stop import simulate

DRY = load_rail("polach-dry")
SPEED = 20.0
STATE = Start(slip=0.2, torque=20e3, braking_time=2.0)


@dataclass(frozen=True)
class Hold:
    """Valves that stay closed: the torque stays what it is."""

    name: str = "hold"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return ()

    def step(self, state, measurement):  # noqa: ARG002
        return state, Command(fill=0.0, vent=0.0)


def scenario(start=STATE, **changes):
    return Scenario(**{"rail": DRY, "initial_speed": SPEED, "start": start, **changes})


@pytest.mark.parametrize(
    ("state", "words"),
    [
        ({"slip": 1.0}, r"slip = 1 .*\[0, 1\)"),
        ({"slip": -0.1}, "slip = -0.1"),
        ({"slip": math.nan}, "slip = nan"),
        ({"torque": -1.0}, "torque = -1 N m"),
        ({"torque": math.inf}, "torque = inf N m"),
        ({"braking_time": -1.0}, "braking time = -1 s"),
        ({"braking_time": math.nan}, "braking time = nan s"),
    ],
)
def test_what_is_no_state(state, words):
    with pytest.raises(UserError, match=words):
        Start(**state)


@pytest.mark.parametrize(
    ("start", "words"),
    [
        (Start(torque=61e3, braking_time=100.0), "torque = 61000 N m .* 60000 N m .*er24pc"),
        (Start(torque=1.0), "torque = 1 N m .* 0 N m .* 0 s"),
        (Start(torque=40e3, braking_time=1.0), "torque = 40000 N m .* 31658 N m .* 1 s"),
    ],
)
def test_a_torque_that_the_brake_cannot_have(er24pc, start, words):
    with pytest.raises(UserError, match=words):
        simulate(er24pc, Hold(), scenario(start))


def test_a_full_supply_gives_the_whole_torque(er24pc):
    assert available_torque(er24pc.brake, full_supply_time(er24pc.brake)) == 60e3
    whole = Start(torque=60e3, braking_time=full_supply_time(er24pc.brake))
    assert simulate(er24pc, Hold(), scenario(whole)).torque[0] == pytest.approx(60e3, rel=1e-12)


@pytest.mark.parametrize("plant", ["planar", "quarter"])
def test_traces_and_controller_begin_there(er24pc, plant):
    run = simulate(er24pc, Hold(), scenario(), plant=plant)
    np.testing.assert_allclose(run.slip[0], 0.2, rtol=1e-12)
    np.testing.assert_allclose(run.wheel_speed[0], 0.8 * SPEED / er24pc.wheel_radius, rtol=1e-12)
    np.testing.assert_allclose(run.torque[0], 20e3, rtol=1e-12)
    np.testing.assert_allclose(run.torque[:50], 20e3, rtol=1e-12)  # the valves are closed
    assert run.samples[0].seen == pytest.approx((SPEED, 0.8 * SPEED / er24pc.wheel_radius, 20e3), rel=1e-12)


@pytest.mark.parametrize("slip", [0.05, 0.14, 0.4])
def test_the_holding_torque_holds(er24pc, slip):
    torque = holding_torque(er24pc, DRY, slip=slip, speed=SPEED)
    still = replace(er24pc, wheel_damping_decay=0.0)
    time = full_supply_time(er24pc.brake)
    for share in (1.0, 0.9):
        run = simulate(
            still,
            Hold(),
            scenario(Start(slip=slip, torque=share * torque, braking_time=time)),
            plant="quarter",
            refinement=5,
        )
        at = slip_dynamics(still, DRY, slip, SPEED)
        expected = at.drift + at.gain * share * torque
        rate = (run.slip[1, 0] - run.slip[0, 0]) / (run.time[1] - run.time[0])
        # Within the first millisecond pole and falling speed change the rate by some parts in a thousand.
        assert rate == pytest.approx(expected, rel=5e-3, abs=1e-3)
        assert (abs(expected) < 1e-9) == (share == 1.0)


def test_the_holding_torque_knows_grade_and_decayed_damping(er24pc):
    sticky = replace(er24pc, wheel_damping=20.0, wheel_damping_decay=0.05)
    time = full_supply_time(er24pc.brake)

    def rate(**known):
        torque = holding_torque(sticky, DRY, slip=0.14, speed=SPEED, **known)
        start = Start(slip=0.14, torque=torque, braking_time=time)
        run = simulate(sticky, Hold(), scenario(start, grade=-0.03), plant="quarter")
        return (run.slip[1, 0] - run.slip[0, 0]) / (run.time[1] - run.time[0])

    assert abs(rate(braking_time=time, grade=-0.03)) < 1e-3
    assert abs(rate(braking_time=time)) > 0.01
    assert abs(rate(grade=-0.03)) > 0.01


@pytest.mark.parametrize("vibrating", [False, True])
@pytest.mark.parametrize("law", ["none", "trenitalia"])
def test_the_rest_of_a_stop_is_a_stop_from_its_state(er24pc, make_controller, law, vibrating):
    law, whole = make_controller(law), scenario(Start(), pad_vibration=vibrating)
    run = simulate(er24pc, law, whole, plant="quarter")
    speed, wheel_speed, torque = run.samples[10].seen
    time = run.samples[10].time
    if vibrating:
        torque /= 1.0 + torque_disturbance(er24pc.brake, time)
    state = Start(slip=1.0 - er24pc.wheel_radius * wheel_speed / speed, torque=torque, braking_time=time)
    resumed = replace(whole, initial_speed=speed, start=state)
    remembering = _Remembering(law, run.samples[9].state)
    rest = simulate(er24pc, remembering, resumed, plant="quarter")
    assert rest.time[-1] == pytest.approx(run.time[-1] - time, rel=1e-6)
    passed = float(np.interp(time, run.time, run.distance))
    assert rest.totals.distance == pytest.approx(run.totals.distance - passed, rel=1e-6)
    late = replace(resumed, start=replace(state, braking_time=time + 1.0))
    other = simulate(er24pc, remembering, late, plant="quarter")
    assert abs(other.totals.distance - rest.totals.distance) > 1e-3


@dataclass(frozen=True)
class _Remembering:
    """A law that goes on with what it remembered."""

    law: object
    state: tuple

    @property
    def name(self):
        return f"{self.law.name} that remembers"

    @property
    def sample_time(self):
        return self.law.sample_time

    def start(self, measurement):  # noqa: ARG002
        return self.state

    def step(self, state, measurement):
        return self.law.step(state, measurement)


@pytest.mark.parametrize("plant", ["planar", "quarter"])
@pytest.mark.parametrize("law", ["none", "trenitalia"])
def test_momentum_and_energy_are_conserved(er24pc, make_controller, law, plant):
    run = simulate(er24pc, make_controller(law), scenario(), plant=plant)
    assert abs(momentum_residual(run, er24pc)) < 1e-9
    assert abs(energy_residual(run, er24pc)) < 1e-6
    # The planted fault: a balance that takes the wheels for rolling.
    rolling = replace(run, wheel_speed=np.full_like(run.wheel_speed, SPEED / er24pc.wheel_radius))
    assert abs(momentum_residual(rolling, er24pc)) > 1e-3
    assert abs(energy_residual(rolling, er24pc)) > 1e-3


def test_the_largest_slip_counts_from_the_start(er24pc, make_controller):
    slow = Start(slip=0.6)  # released wheels spin up at once
    law = make_controller("none")
    assert simulate(er24pc, law, scenario(slow, initial_speed=10.0)).slip_max >= 0.6
    crawling = simulate(er24pc, law, scenario(slow, initial_speed=2.0))  # below 10 km/h nothing counts
    assert crawling.slip_max == 0.0


def test_when_the_slip_has_left_its_start(er24pc):
    torque = holding_torque(er24pc, DRY, slip=0.14, speed=SPEED, braking_time=60.0)
    runs = {}
    for share in (0.99, 1.0):
        start = Start(slip=0.14, torque=share * torque, braking_time=60.0)
        runs[share] = simulate(er24pc, Hold(), scenario(start), plant="quarter")
    times = {share: leaving_time(run, 0.05) for share, run in runs.items()}
    assert 0.0 < times[0.99] < times[1.0]
    for share, run in runs.items():
        before = run.time < times[share]
        assert abs(run.slip[before] - 0.14).max() <= 0.05
        assert abs(np.interp(times[share], run.time, run.slip[:, 0]) - 0.14) > 0.05
    assert math.isnan(leaving_time(runs[1.0], 1.0))


def test_a_stop_from_a_state_has_neither_lag_nor_ideal_stop(er24pc, make_controller):
    figures = {
        name: metrics(simulate(er24pc, law, stop), er24pc, stop, slip_reference=0.14)
        for name, law, stop in (
            ("state", make_controller("none"), scenario()),
            ("rolling", make_controller("none"), scenario(Start())),
        )
    }
    for name in ("lag", "plateau", "ideal_stop", "efficiency"):
        assert math.isnan(getattr(figures["state"], name))
        assert math.isfinite(getattr(figures["rolling"], name))
    assert 0.0 < figures["state"].adhesion_utilization < 1.0
    with pytest.raises(UserError, match="starts rolling with empty cylinders"):
        ideal_stop(er24pc, scenario())


def test_a_campaign_starts_there(er24pc, make_controller):
    law, stop = make_controller("trenitalia"), scenario()
    many = simulate_many(er24pc, law, stop, count=3)
    single = simulate(er24pc, law, stop)
    np.testing.assert_allclose(many.table["distance_m"], single.totals.distance, rtol=1e-12)
    np.testing.assert_array_equal(many.table["slip_max"], single.slip_max)
