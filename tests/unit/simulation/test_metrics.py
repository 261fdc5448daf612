"""Figures of a stop, on runs whose answers are known by hand."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wspd_design.controllers.protocol import Command, Measurement
from wspd_design.model.number import where
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.comparison import compare
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Patch, Scenario, Sensing
from wspd_design.simulation.runs import Ending, Run, Sample, Totals
from wspd_design.simulation.stop import simulate

SCENARIO = Scenario(rail=load_rail("polach-wet"), initial_speed=30.0)
ZERO = dict.fromkeys(
    ("torque", "resistance_impulse", "damping_impulse", "brake_work", "sliding_work", "resistance_work"), 0.0
) | dict.fromkeys(
    (
        *("damping_work", "lock_time", "judged_time", "slip", "slip_squared", "vented_pressure"),
        *("valve_switches", "filled_pressure", "watchdog_fills", "judged_lock"),
        *("slip_band", "speed_error", "distance_error"),
    ),
    0.0,
)


def made_up(
    *,
    initial_speed=30.0,
    end_time=10.0,
    distance=100.0,
    commands=((1.0, 0.0),),
    ending=Ending.STOPPED,
    **totals,
):
    one = np.zeros(2)
    return Run(
        controller="made up",
        vehicle="er24pc",
        rail="none",
        plant="quarter",
        sample_time=0.1,
        dead_time=0.0,
        shortest_pulse=0.0,
        initial_speed=initial_speed,
        seed=0,
        wheel_radius=0.5,
        ending=ending,
        time=np.array([0.0, end_time]),
        speed=np.array([initial_speed, 0.0]),
        distance=np.array([0.0, distance]),
        wheel_speed=one[:, None],
        slip=one[:, None],
        torque=one[:, None],
        wheel_load=one[:, None],
        cylinder_pressure=one[:, None],
        axle_samples=(
            tuple(
                Sample(time=0.1 * k, fill=f, vent=v, state=(), seen=Measurement(0.0, 0.0, 0.0))
                for k, (f, v) in enumerate(commands)
            ),
        ),
        totals=Totals(**{**ZERO, "distance": distance, **totals}),
        final_wheel_speeds=(0.0,) * 4,
        engine="none",
        slip_max=0.5,
    )


@pytest.mark.parametrize(("dead_time", "deceleration"), [(1.0, 3.9), (0.0, 2.5), (2.25, 0.7)])
def test_lag_and_plateau_of_a_dead_time_and_a_constant_deceleration(er24pc, dead_time, deceleration):
    # v0 for the dead time, then constant deceleration: both numbers come back exactly.
    v0 = 120.0 / 3.6
    run = made_up(
        initial_speed=v0,
        end_time=dead_time + v0 / deceleration,
        distance=v0 * dead_time + v0**2 / (2.0 * deceleration),
    )
    judged = metrics(run, er24pc, SCENARIO, slip_reference=0.14)
    assert judged.lag == pytest.approx(dead_time, abs=1e-12)
    assert judged.plateau == pytest.approx(deceleration, rel=1e-12)


def test_table_10_decomposed_as_in_the_data_book(er24pc):
    # Data book section 13: AFSMC dry 184.03 m in 9.8 s: lag 1.24 s, plateau .397 g.
    judged = metrics(
        made_up(initial_speed=120 / 3.6, end_time=9.8, distance=184.03), er24pc, SCENARIO, slip_reference=0.14
    )
    assert judged.lag == pytest.approx(1.24, abs=0.005)
    assert judged.plateau / 9.81 == pytest.approx(0.397, abs=0.0005)


def test_slip_statistics(er24pc):
    # Two seconds at slip .1, one second at .4: mean .2, mean square .06, about .14 rms sqrt(.0236).
    run = made_up(judged_time=3.0, slip=0.6, slip_squared=2 * 0.01 + 0.16)
    judged = metrics(run, er24pc, SCENARIO, slip_reference=0.14)
    assert judged.slip_mean == pytest.approx(0.2)
    assert judged.slip_rms == pytest.approx(math.sqrt((2 * 0.04**2 + 0.26**2) / 3))
    assert judged.slip_max == 0.5


def test_slip_statistics_match_the_traces(er24pc, stop):
    run = stop("trenitalia", "polach-wet")
    judged = metrics(run, er24pc, SCENARIO, slip_reference=0.14)
    fast = run.speed > 10 / 3.6
    t, slip = run.time[fast], run.slip[fast, 0]
    span = t[-1] - t[0]
    assert judged.slip_mean == pytest.approx(np.trapezoid(slip, t) / span, rel=2e-3)
    assert judged.slip_rms == pytest.approx(math.sqrt(np.trapezoid((slip - 0.14) ** 2, t) / span), rel=2e-3)
    assert judged.slip_max == pytest.approx(slip.max(), rel=1e-2)
    assert judged.distance == pytest.approx(np.trapezoid(run.speed, run.time), rel=1e-6)
    assert judged.torque_integral == pytest.approx(4 * np.trapezoid(run.torque[:, 0], run.time), rel=1e-3)


@pytest.mark.parametrize(
    ("commands", "switches", "saturated"),
    [
        ([(1.0, 0.0), (1.0, 0.0)], 0, 1.0),
        ([(1.0, 0.0), (0.0, 1.0), (1.0, 0.0)], 2, 1.0),
        ([(0.4, 0.6), (0.4, 0.6)], 3, 0.0),  # fill vent fill vent
        ([(0.5, 0.0), (0.0, 0.33)], 3, 0.0),  # fill hold vent hold
        ([(0.0, 0.0), (0.0, 0.0)], 0, 0.0),
        ([(0.0, 0.0), (1.0, 0.0), (0.3, 0.3), (0.0, 1.0)], 4, 0.5),  # hold fill (fill vent hold) vent
    ],
)
def test_valve_switches_and_saturation(er24pc, commands, switches, saturated):
    judged = metrics(made_up(commands=commands), er24pc, SCENARIO, slip_reference=0.14)
    assert judged.saturated_share == saturated
    # The loop counts the switches. It gets the same commands, then goes on in the last state of the valve, gently.
    fill, vent = commands[-1]
    last = (0.0, 0.0) if fill + vent < 1.0 else (1.0, 0.0) if vent == 0.0 else (0.0, 1.0)
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=0.3)
    run = simulate(er24pc, Listed(commands=(*commands, last)), stop, plant="quarter")
    assert len(run.samples) > len(commands)
    assert run.totals.valve_switches == switches
    assert metrics(run, er24pc, stop, slip_reference=0.14).valve_switches == switches


@dataclass(frozen=True, kw_only=True)
class Listed:
    """Commands from a list, the last one again and again."""

    commands: tuple[tuple[float, float], ...]
    name: str = "listed"
    sample_time: float = 0.01

    def start(self, measurement):  # noqa: ARG002
        return (0.0,)

    def step(self, state, measurement):  # noqa: ARG002
        (number,) = state
        fill, vent = self.commands[-1]
        for k, (a, b) in reversed(list(enumerate(self.commands[:-1]))):
            fill, vent = where(number < k + 0.5, a, fill), where(number < k + 0.5, b, vent)
        return (number + 1.0,), Command(fill=fill, vent=vent)


@pytest.mark.parametrize(("shortest", "switches"), [(0.0, 6), (0.001, 3)])
def test_pulses_that_do_not_open_a_valve_are_no_switches(er24pc, shortest, switches):
    # fill hold, hold, vent, vent (goes on) hold
    law = Listed(commands=((0.4, 0.05), (0.05, 0.0), (0.0, 1.0), (0.0, 0.05), (0.0, 0.0)))
    sensing = Sensing(shortest_pulse=shortest)
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=0.3, sensing=sensing)
    run = simulate(er24pc, law, stop, plant="quarter")
    assert metrics(run, er24pc, stop, slip_reference=0.14).valve_switches == switches


def test_a_run_without_standstill_or_on_changing_rails_has_no_lag(er24pc):
    other = replace(SCENARIO, patches=(Patch(start=50.0, rail=load_rail("low-adhesion")),))
    for run, scenario in ((made_up(ending=Ending.TIME_LIMIT), SCENARIO), (made_up(), other)):
        judged = metrics(run, er24pc, scenario, slip_reference=0.14)
        assert math.isnan(judged.lag)
        assert math.isnan(judged.plateau)


@pytest.mark.parametrize("rail", ["table10-dry", "polach-wet"])
@pytest.mark.parametrize("name", ["trenitalia", "afsmc"])
def test_vented_air_is_what_the_samples_let_out(stop, judged, name, rail):
    # From the pressure that the controller saw at each sample: fill as (8), (9), then vent; shares of P_max.
    vented, h, tau = 0.0, 0.1, 0.6
    for sample in stop(name, rail).samples:
        start, pressure = sample.time, sample.seen.torque / 60e3
        filled = solve_ivp(
            lambda t, p: (1.0 - np.exp(-0.75 * t) - p) / tau,
            (start, start + sample.fill * h + 1e-12),
            [pressure],
            rtol=1e-8,
            atol=1e-10,
        ).y[0, -1]
        vented += filled * (1.0 - np.exp(-sample.vent * h / tau))
    # The train may come to rest within the last sample.
    assert judged(name, rail).vented_air == pytest.approx(vented, abs=0.16)
    assert vented > 1.0


@pytest.mark.parametrize("rail", ["table10-dry", "polach-dry", "polach-wet"])
@pytest.mark.parametrize("name", ["trenitalia", "afsmc", "mitsubishi", "none"])
def test_nobody_beats_the_ideal_stop_or_the_adhesion(judged, name, rail):
    found = judged(name, rail)
    assert 0.0 < found.ideal_stop < found.distance * (1.0 + 1e-6)
    assert found.efficiency == found.ideal_stop / found.distance
    assert 0.3 < found.adhesion_utilization < 1.0


def test_comparison_keeps_the_order_and_tells_its_progress(er24pc, make_controller):
    told, names = [], ("none", "trenitalia")
    scenario = Scenario(rail=load_rail("table10-dry"), initial_speed=5.0)
    trials = compare(
        er24pc,
        [make_controller(n) for n in names],
        scenario,
        slip_reference=0.14,
        plant="quarter",
        progress=told.append,
    )
    assert tuple(t.run.controller for t in trials) == names == tuple(told)
    assert trials[0].metrics == metrics(trials[0].run, er24pc, scenario, slip_reference=0.14)
