"""Whole stops with every build-up and valve: pressures replayed pulse by pulse, air that is conserved, watchdogs."""

import math
from dataclasses import dataclass, replace

import pytest

from wspd_design.analysis.stopping import full_adhesion_stop
from wspd_design.codegen import kernels
from wspd_design.codegen.memory import Memory
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.controllers.protocol import Command
from wspd_design.model import brake as brake_model
from wspd_design.model.brake import Valve, braking_torque, build_up_delay, pressure_after
from wspd_design.model.number import where
from wspd_design.model.valve_flow import ATMOSPHERE
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.campaign_rows import columns, make_plan
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Scenario, Sensing
from wspd_design.simulation.self_check import simulate_checked, slip_difference
from wspd_design.simulation.stop import simulate

BAR = 1e5
RAMP = {"build_up": "electro-pneumatic", "build_up_delay": 0.25, "build_up_ramp": 1.3}
ORIFICE = {"valve": "orifice", "fill_time": 0.5, "vent_time": 0.3, "reservoir_pressure": 8 * BAR}
AIR = {"cylinder_volume": 0.012, "reservoir_volume": 0.06}
KINDS = {
    "ramp": RAMP,
    "orifice": ORIFICE,
    "ramp and orifice": RAMP | ORIFICE | {"fill_time": 2.0},
    "leak": {"hold_leak": 0.1},
    "low reservoir": AIR,
    "ramp and low reservoir": RAMP | AIR,
    "orifice and low reservoir": ORIFICE | AIR,
    "ramp, orifice, leak, low reservoir": RAMP
    | ORIFICE
    | AIR
    | {"hold_leak": 0.1, "reservoir_pressure": 6 * BAR},
}


@dataclass(frozen=True)
class Repeated:
    """Give the same commands again and again."""

    commands: tuple
    name: str = "repeated"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return (0.0,)

    def step(self, state, measurement):  # noqa: ARG002
        (number,) = state
        fill, vent = self.commands[-1]
        for k, (a, b) in reversed(list(enumerate(self.commands[:-1]))):
            fill, vent = where(number < k + 0.5, a, fill), where(number < k + 0.5, b, vent)
        last = number > len(self.commands) - 1.5
        return (where(last, 0.0, number + 1.0),), Command(fill=fill, vent=vent)


VARIED = Repeated(
    commands=((0.5, 0.3), (1.0, 0.0), (0.0, 0.5), (0.0, 0.0), (0.2, 0.8), (0.9, 0.0), (1.0, 0.0))
)
PUMPING = Repeated(commands=((1.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0)))


@pytest.fixture
def braked(er24pc):
    """The locomotive with a weak brake, so that no wheel locks on a dry rail, and some changes."""

    def make(**changes):
        return replace(er24pc, brake=replace(er24pc.brake, max_torque=12e3, **changes))

    return make


def dry(speed, **changes):
    return Scenario(rail=load_rail("polach-dry"), initial_speed=speed, **changes)


def replayed(vehicle, run):
    """Pressures of a wheelset at its samples, and what was filled and vented, from the scalar functions alone."""
    brake, h, end = vehicle.brake, run.sample_time, float(run.time[-1])
    drain = (
        vehicle.wheelsets * brake.cylinder_volume / brake.reservoir_volume if brake.reservoir_volume else 0.0
    )
    pressures, pressure, filled, vented = [], 0.0, 0.0, 0.0
    for sample in run.samples:
        reservoir, vented_before = brake.supply_pressure - drain * filled, vented
        pressures.append(pressure)
        time = sample.time
        for valve, share in ((Valve.FILL, sample.fill), (Valve.VENT, sample.vent), (Valve.HOLD, 1.0)):
            until = min(time + share * h, sample.time + h, end)
            after = float(pressure_after(brake, valve, until, time, pressure, reservoir))
            filled += max(after - pressure, 0.0)
            vented += max(pressure - after, 0.0)
            pressure, time = after, until
    return pressures, pressure, filled, vented, vented_before


@pytest.mark.parametrize("kind", KINDS)
def test_pressures_and_air_of_a_stop_are_those_of_its_pulses(braked, kind):
    vehicle = braked(**KINDS[kind])
    run = simulate(vehicle, VARIED, dry(15.0))
    pressures, last, filled, vented, vented_before = replayed(vehicle, run)
    seen = [sample.seen.torque for sample in run.samples]
    full = vehicle.brake.max_torque
    assert seen == pytest.approx([braking_torque(vehicle.brake, p) for p in pressures], abs=1e-9 * full)
    assert max(seen) > 0.2 * full
    # Air is neither made nor lost; the venting of the last sample is not counted.
    assert filled - vented == pytest.approx(last, abs=1e-9 * filled)
    assert run.totals.filled_pressure == pytest.approx(4.0 * filled, rel=1e-9)
    assert run.totals.vented_pressure == pytest.approx(4.0 * vented_before, rel=1e-9)


@pytest.mark.parametrize("rail", ["polach-wet", "low-adhesion"])
@pytest.mark.parametrize("kind", KINDS)
def test_stops_that_slide_pass_the_step_check_and_keep_their_balances(er24pc, make_controller, kind, rail):
    vehicle = replace(er24pc, brake=replace(er24pc.brake, **KINDS[kind]))
    law = make_controller("trenitalia")
    stop = Scenario(rail=load_rail(rail), initial_speed=15.0)
    run, check = simulate_checked(vehicle, law, stop)
    judged = metrics(run, vehicle, stop, slip_reference=0.14)
    assert not check.unresolved
    assert judged.slip_max > 0.1
    assert abs(judged.momentum_residual) < 1e-6
    assert abs(judged.energy_residual) < 1e-6


KINKED = {
    "meets the demand of the main pipe": ORIFICE,
    "follows a ramp from its start": RAMP | ORIFICE | {"fill_time": 0.3, "build_up_delay": 0.2237},
}


@pytest.mark.parametrize("kind", KINKED)
def test_no_step_goes_across_a_kink_of_the_pressure(er24pc, make_controller, kind, monkeypatch):
    vehicle = replace(er24pc, brake=replace(er24pc.brake, **KINKED[kind]))
    stop = Scenario(rail=load_rail("low-adhesion"), initial_speed=10.0)

    def change():
        law = make_controller("trenitalia")
        runs = [simulate(vehicle, law, stop, plant="quarter", refinement=parts) for parts in (1, 8)]
        early = [replace(run, axle_samples=(run.samples[:16],)) for run in runs]  # while the demand rises
        return slip_difference(vehicle, *early)

    with_kinks = change()
    assert with_kinks < 1e-7
    # The planted fault: nobody says where they are.
    plain = brake_model.kinks
    monkeypatch.setattr(
        brake_model, "kinks", lambda *given, **more: tuple(1e300 for _ in plain(*given, **more))
    )
    monkeypatch.setattr(kernels, "_memory", Memory(4))
    assert change() > 10.0 * with_kinks


@pytest.mark.filterwarnings("ignore:brake.reservoir_volume of vehicle er24pc = 10")
def test_a_reservoir_that_runs_low_lengthens_the_stop(braked):
    stop = dry(25.0)
    distances, pressures = [], []
    for volume in (10.0, 0.12, 0.06):
        vehicle = braked(cylinder_volume=0.012, reservoir_volume=volume)
        run = simulate(vehicle, PUMPING, stop)
        judged = metrics(run, vehicle, stop, slip_reference=0.14)
        distances.append(judged.distance)
        pressures.append(judged.lowest_reservoir)
        expected = 6 * BAR - 0.012 / volume * run.totals.filled_pressure
        assert judged.lowest_reservoir == pytest.approx(expected, rel=1e-12)
    without = simulate(braked(), PUMPING, stop).totals.distance
    assert distances[0] == pytest.approx(without, rel=0.02)
    assert 1.02 * distances[0] < distances[1]
    assert 1.05 * distances[1] < distances[2]
    assert pressures[0] > 5.6 * BAR > 3 * BAR > pressures[1] > pressures[2] > 0.0


def test_a_stroke_takes_its_normal_litres(braked):
    vehicle = braked(max_pressure=3.8 * BAR, cylinder_volume=1e-3)
    stop = dry(30.0)
    run = simulate(vehicle, Unprotected(name="none", sample_time=0.1), stop)
    judged = metrics(run, vehicle, stop, slip_reference=0.14)
    assert run.time[-1] > 20.0  # filled to the last digit
    assert judged.air_used == pytest.approx(4.0 * 3.750, rel=1e-3)  # 3.75 a litre and stroke of 3.8 bar
    assert judged.air_used == pytest.approx(4.0 * 3.8 * BAR / ATMOSPHERE, rel=1e-6)
    assert math.isnan(judged.lowest_reservoir)


@pytest.mark.parametrize(
    ("changes", "least"), [(RAMP, 0.9), (ORIFICE, 1.0 / 0.75), (RAMP | ORIFICE | {"fill_time": 4.0}, 1.4)]
)
def test_stops_without_sliding_are_those_of_mean_values(braked, changes, least):
    vehicle, law = braked(**changes), Unprotected(name="none", sample_time=0.1)
    found = simulate(vehicle, law, dry(30.0)).totals.distance
    by_rule = full_adhesion_stop(vehicle, 30.0)
    assert found == pytest.approx(by_rule.distance, rel=5e-3)  # what mean values leave out
    # Build-up and filling together are later than the demand alone: the slow orifice by half a second.
    assert least <= build_up_delay(vehicle.brake) < least + 0.7


def test_an_ideal_brake_that_is_there_at_once_knows_no_valves(er24pc):
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=10.0)
    other = replace(er24pc, brake=replace(er24pc.brake, **RAMP | ORIFICE | AIR, dead_time=0.05))
    plain, same = (ideal_stop(each, stop, instantaneous=True) for each in (er24pc, other))
    assert same.distance == pytest.approx(plain.distance, rel=1e-5)  # other ends of steps
    slower = ideal_stop(other, stop)
    assert slower.distance > 1.2 * plain.distance


def test_without_volumes_nothing_is_said_about_air(braked):
    vehicle, stop = braked(), dry(5.0)
    judged = metrics(simulate(vehicle, VARIED, stop), vehicle, stop, slip_reference=0.14)
    assert math.isnan(judged.air_used)
    assert math.isnan(judged.lowest_reservoir)
    assert judged.watchdog_fills is None


ONCE = Repeated(commands=((1.0, 0.0), *((0.0, 0.0),) * 16))
"""Fill for one sample, then hold."""


def test_a_watchdog_fills_after_its_time_until_the_command_fills_again(braked):
    brake = {"supply_rate": 50.0, "longest_release": 0.65}
    vehicle = braked(**brake)
    run = simulate(vehicle, ONCE, dry(12.0))
    torques = [sample.seen.torque for sample in run.samples]
    h = run.sample_time
    # Held from 0.1 s to 0.75 s, in the middle of a sample, then filled until 1.7 s, and with the command of then.
    held = float(pressure_after(vehicle.brake, Valve.FILL, h, 0.0, 0.0))
    assert torques[1:8] == pytest.approx([braking_torque(vehicle.brake, held)] * 7, rel=1e-12)
    for k in range(8, 18):
        expected = pressure_after(vehicle.brake, Valve.FILL, k * h, 0.75, held)
        assert torques[k] == pytest.approx(braking_torque(vehicle.brake, expected), rel=1e-9)
    assert torques[18:25] == pytest.approx(
        [torques[18]] * 7, rel=1e-12
    )  # the command filled, and holds again
    periods = 1.7
    expected = 4 * sum(periods * n + 0.75 < run.time[-1] for n in range(100))
    assert run.totals.watchdog_fills == expected > 4
    calm = simulate(braked(supply_rate=50.0), ONCE, dry(12.0))
    assert calm.totals.watchdog_fills == 0
    assert run.totals.distance < calm.totals.distance


def test_a_watchdog_of_a_wheelset_that_always_vents_fills_in_spite_of_its_command(braked):
    law = Repeated(commands=((1.0, 0.0), *((0.0, 1.0),) * 40))
    run = simulate(braked(longest_release=1.0), law, dry(10.0))
    at = {round(sample.time, 1): sample.seen.torque for sample in run.samples}
    assert at[1.1] < 0.2 * at[0.1]  # vented for a second
    assert at[1.5] > at[1.3] > at[1.2] > at[1.1]  # the law still vents


def test_times_of_the_valves_are_those_of_the_vehicle_unless_the_stop_says_otherwise(braked):
    stop, law = dry(8.0), VARIED
    own = braked(dead_time=0.06, shortest_pulse=0.04)
    by_option = Sensing(dead_time=0.06, shortest_pulse=0.04)
    from_vehicle = simulate(own, law, stop)
    assert from_vehicle.totals == simulate(braked(), law, replace(stop, sensing=by_option)).totals
    assert (from_vehicle.dead_time, from_vehicle.shortest_pulse) == (0.06, 0.04)
    other = Sensing(dead_time=0.0, shortest_pulse=0.0)
    assert simulate(own, law, replace(stop, sensing=other)).totals == simulate(braked(), law, stop).totals
    assert from_vehicle.totals != simulate(braked(), law, stop).totals


def test_rows_of_a_campaign_have_the_air_of_a_stop(braked):
    vehicle, stop = braked(**AIR, longest_release=0.15), dry(12.0)
    table = simulate_many(vehicle, VARIED, stop, count=2, plant="quarter").table
    judged = metrics(simulate(vehicle, VARIED, stop, plant="quarter"), vehicle, stop, slip_reference=0.14)
    assert judged.watchdog_fills > 0
    for name, figure in (
        ("air_used_Nl", judged.air_used),
        ("lowest_reservoir_Pa", judged.lowest_reservoir),
        ("watchdog_fills", judged.watchdog_fills),
    ):
        assert table[name] == pytest.approx([figure] * 2, rel=1e-9)
    usual = make_plan(braked(), VARIED, stop, plant="quarter", draws=(), check_every=0)
    assert not {"air_used_Nl", "lowest_reservoir_Pa", "watchdog_fills"} & {name for name, _ in columns(usual)}
