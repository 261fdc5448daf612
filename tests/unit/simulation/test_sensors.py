"""What controllers see and valves follow, against the true angle, NumPy's random numbers and a cylinder of SciPy."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.stats import kstest

from wspd_design.codegen import closed_loop
from wspd_design.codegen.memory import Memory
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation import loop_input
from wspd_design.simulation.records import Scenario, Sensing, Start
from wspd_design.simulation.stop import simulate

SPEED = 60.0 / 3.6
NOISE, PHASE = 0, 1
TRAIN = 0


def drawn(seed, sample, whose, what):
    """Two uniform numbers at a place, from NumPy's own Philox, which counts one up before it draws."""
    words = np.random.Philox(counter=[sample, whose, what, 0], key=[seed, 0]).random_raw(2)
    return ((words >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53


def normal(seed, sample, whose):
    first, second = drawn(seed, sample, whose, NOISE)
    return np.sqrt(-2.0 * np.log(first)) * np.sin(2.0 * np.pi * second)


@pytest.fixture
def wet():
    return Scenario(rail=load_rail("polach-wet"), initial_speed=SPEED, seed=3)


@pytest.fixture
def every_step(monkeypatch):
    """Traces with a row for every step."""
    monkeypatch.setattr(loop_input, "RECORD_INTERVAL", 0.0)


def fine(vehicle, law, scenario, plant):
    """A stop in steps that are short enough for a spline through their ends."""
    return simulate(vehicle, law, scenario, plant=plant, refinement=5)


def angle_turned(run, axle):
    """The true angle over time: the integral of a spline through the wheel speeds at the ends of all steps."""
    return CubicSpline(run.time, run.wheel_speed[:, axle]).antiderivative()


def samples_of(run, axle):
    samples = run.axle_samples[axle]
    return np.array([s.time for s in samples]), np.array([s.seen.wheel_speed for s in samples])


def assert_counted(run, pulses, seed):
    """Every sample tells the pulses of the angle turned since the last one; nothing of the angle is lost."""
    q, h = 2.0 * np.pi / pulses, run.sample_time
    for axle in range(run.wheel_speed.shape[1]):
        times, seen = samples_of(run, axle)
        angle, (offset, _) = angle_turned(run, axle)(times), drawn(seed, 0, 1 + axle, PHASE)
        counts = seen * h / q
        np.testing.assert_allclose(counts, np.round(counts), atol=1e-6)
        before = np.floor(-run.wheel_speed[0, axle] * h / q + offset)
        total = before + np.cumsum(np.round(counts))
        exact = angle / q + offset
        near = np.abs(exact - np.round(exact)) < 1e-3  # an edge within what the spline knows
        np.testing.assert_array_equal(total[~near], np.floor(exact)[~near])


KINDS = [(1, 0.1), (80, 0.1), (100, 0.1), (200, 0.02), (1000, 0.1), (1000, 0.02)]


@pytest.mark.parametrize("plant", ["quarter", "planar"])
@pytest.mark.parametrize(("pulses", "sample_time"), KINDS)
@pytest.mark.usefixtures("every_step")
def test_a_counter_tells_the_angle_turned(er24pc, make_controller, wet, pulses, sample_time, plant):
    law = make_controller("trenitalia", sample_time=sample_time)
    run = fine(er24pc, law, replace(wet, sensing=Sensing(pulses_per_turn=pulses)), plant)
    assert_counted(run, pulses, wet.seed)


def periods(run, axle, pulses, seed):
    """The wheel speed at every sample from the times at which the true angle passes a pulse."""
    q, first = 2.0 * np.pi / pulses, run.wheel_speed[0, axle]
    times, _ = samples_of(run, axle)
    turned, (offset, _) = angle_turned(run, axle), drawn(seed, 0, 1 + axle, PHASE)
    last = np.floor(turned(times) / q + offset)
    wanted = (np.concatenate([last, last - 1.0]) - offset) * q
    found = np.interp(wanted, np.maximum.accumulate(turned(run.time)), run.time)
    for _ in range(3):  # Newton's method, from a straight line within the step
        found -= (turned(found) - wanted) / np.maximum(turned(found, 1), 1e-3)
    found = np.where(wanted < 0.0, wanted / first, found)  # before the stop
    came, before = np.split(found, 2)
    return q / np.maximum(came - before, times - came)


@pytest.mark.parametrize("plant", ["quarter", "planar"])
@pytest.mark.parametrize(("pulses", "sample_time"), KINDS)
@pytest.mark.usefixtures("every_step")
def test_a_timer_tells_the_last_period(er24pc, make_controller, wet, pulses, sample_time, plant):
    law = make_controller("trenitalia", sample_time=sample_time)
    sensing = Sensing(pulses_per_turn=pulses, period_timing=True)
    run = fine(er24pc, law, replace(wet, sensing=sensing), plant)
    for axle in range(run.wheel_speed.shape[1]):
        _, seen = samples_of(run, axle)
        np.testing.assert_allclose(seen, periods(run, axle, pulses, wet.seed), rtol=3e-5)


@dataclass(frozen=True)
class Scheduled:
    """Commands by the number of the sample, whatever is measured; the last one stays."""

    commands: tuple[tuple[float, float], ...]
    sample_time: float = 0.1
    name: str = "scheduled"

    def start(self, measurement):  # noqa: ARG002
        return (0.0,)

    def step(self, state, measurement):  # noqa: ARG002
        (number,) = state
        fill, vent = self.commands[-1]
        for k, (earlier_fill, earlier_vent) in enumerate(self.commands[:-1]):
            fill, vent = where(number == k, earlier_fill, fill), where(number == k, earlier_vent, vent)
        return (number + 1.0,), Command(fill=fill, vent=vent)


COMMANDS = (
    (0.7, 0.0),
    (0.3, 0.05),
    (0.05, 0.6),
    (0.0, 0.0),
    (1.0, 0.0),
    (0.04, 0.3),
    (0.6, 0.4),
    (0.0, 0.06),
    (0.3, 0.1),
)
LIGHT = 3e3  # N m: no wheel slides


@pytest.fixture
def light(er24pc):
    return replace(er24pc, brake=replace(er24pc.brake, max_torque=LIGHT))


def test_the_timer_is_accurate_in_steps_as_they_are(light, wet):
    sensing = Sensing(pulses_per_turn=100, period_timing=True)
    law = Scheduled(commands=COMMANDS, sample_time=0.02)
    usual, short = (
        simulate(light, law, replace(wet, sensing=sensing), refinement=refinement) for refinement in (1, 16)
    )
    for axle in range(4):
        (times, seen), (_, exact) = samples_of(usual, axle), samples_of(short, axle)
        before_the_end = times < times[-1] - 0.1
        np.testing.assert_allclose(seen[before_the_end], exact[before_the_end], rtol=5e-5)


def test_a_locked_wheel_is_heard_of_by_the_pulses_that_do_not_come(er24pc, make_controller, wet):
    sensing = Sensing(pulses_per_turn=100, period_timing=True)
    run = simulate(er24pc, make_controller("none"), replace(wet, sensing=sensing))
    times, seen = samples_of(run, 0)
    locked = run.time[np.argmax(run.wheel_speed[:, 0] == 0.0)]
    after = times > locked
    since = times[after] - locked
    assert after.sum() > 20
    q = 2.0 * np.pi / 100
    assert (seen[after] > 0.0).all()
    assert (seen[after] < q / since).all()  # the last pulse came before
    np.testing.assert_allclose(np.diff(1.0 / seen[after]) * q, 0.1, rtol=1e-9)  # time since that pulse
    counted = simulate(
        er24pc, make_controller("none"), replace(wet, sensing=replace(sensing, period_timing=False))
    )
    assert (samples_of(counted, 0)[1][1:][after[1:]][1:] == 0.0).all()


@pytest.mark.usefixtures("every_step")
def test_a_counter_that_loses_the_rest_of_an_angle_is_seen(er24pc, make_controller, wet, monkeypatch):
    # The planted fault: the speed of the instant, rounded to whole pulses, as it was once.
    true = closed_loop.closed_loop_source

    def faulty(*arguments, **options):
        source = true(*arguments, **options)
        count = "(pulses(loop, l, loop->lane[ANGLE * LANES + l]) - loop->counted[l]) * angle"
        assert count in source
        return source.replace(
            count, "floor(loop->now.wheel[l] * loop->set.sample_time / angle + 0.5) * angle"
        )

    monkeypatch.setattr(closed_loop, "closed_loop_source", faulty)
    monkeypatch.setattr(closed_loop, "_plants", Memory(4))
    scenario = replace(wet, sensing=Sensing(pulses_per_turn=1000))
    run = fine(er24pc, make_controller("trenitalia"), scenario, "quarter")
    with pytest.raises(AssertionError):
        assert_counted(run, 1000, wet.seed)


def test_the_train_speed_drifts_and_is_noisy_for_all_axles_alike(light, wet):
    law = Scheduled(commands=COMMANDS, sample_time=0.02)
    exact = simulate(light, law, wet)
    sensing = Sensing(reference_error=0.02, reference_drift=-0.03, reference_noise=0.2)
    told = simulate(light, law, replace(wet, sensing=sensing))
    assert told.totals == exact.totals  # the law does not listen
    time = np.array([s.time for s in exact.samples])
    true = np.array([s.seen.speed for s in exact.samples])
    errors = [0.2 * normal(wet.seed, k, TRAIN) for k in range(len(time))]
    expected = np.maximum(1.02 * true - 0.03 * time + errors, 0.0)
    for samples in told.axle_samples:
        np.testing.assert_allclose([s.seen.speed for s in samples], expected, rtol=1e-12, atol=1e-12)
    assert (expected == 0.0).any()  # a train speed is never negative


def test_the_noise_of_a_wheel_depends_on_seed_axle_and_sample_alone(light, wet):
    law = Scheduled(commands=COMMANDS, sample_time=0.02)
    exact = simulate(light, law, wet)
    noisy = simulate(light, law, replace(wet, sensing=Sensing(speed_noise=0.1)))
    for axle in range(4):
        (_, true), (_, seen) = samples_of(exact, axle), samples_of(noisy, axle)
        errors = [normal(wet.seed, k, 1 + axle) for k in range(len(true))]
        expected = np.maximum(true + 0.1 / light.wheel_radius * np.array(errors), 0.0)
        np.testing.assert_allclose(seen, expected, rtol=1e-12, atol=1e-12)


def test_the_noise_is_normal_and_independent():
    # The numbers of the test above, by their distribution alone.
    errors = np.array([[normal(3, k, whose) for k in range(2000)] for whose in range(5)])
    assert kstest(errors.ravel(), "norm").pvalue > 0.01
    correlation = np.corrcoef(np.vstack([errors, np.roll(errors, 1, axis=1)]))
    assert np.abs(correlation - np.eye(10)).max() < 4.0 / np.sqrt(2000)
    other = np.array([normal(4, k, 1) for k in range(2000)])
    assert abs(np.corrcoef(other, errors[1])[0, 1]) < 4.0 / np.sqrt(2000)


def test_the_torque_of_other_pads_is_told_and_not_braked_with(light, wet):
    law, start = Scheduled(commands=COMMANDS), Start(torque=1e3, braking_time=2.0)
    exact = simulate(light, law, replace(wet, start=start))
    told = simulate(light, law, replace(wet, start=start, sensing=Sensing(torque_error=-0.2)))
    assert told.totals == exact.totals
    np.testing.assert_allclose(
        [s.seen.torque for s in told.samples], [0.8 * s.seen.torque for s in exact.samples], rtol=1e-14
    )
    np.testing.assert_allclose(told.torque[0], 1e3, rtol=1e-12)


def opened(commands, sample_time, shortest):
    """Commands without the pulses that are too short, unless the valve has been open until then."""
    kept, open_valve = [], None
    for fill, vent in commands:
        shares = {"fill": fill, "vent": vent}
        going_on = open_valve
        for valve, share in shares.items():
            if share * sample_time < shortest * (1.0 - 1e-9) and going_on != valve:
                shares[valve] = 0.0
            going_on = None if shares[valve] > 0.0 or valve == "vent" else going_on
        kept.append((shares["fill"], shares["vent"]))
        whole = sum(shares.values()) > 1.0 - 1e-9
        open_valve = None if not whole else "vent" if shares["vent"] > 0.0 else "fill"
    return kept


def cylinder(brake, commands, sample_time, dead_time, times):
    """Torque at the times by solve_ivp from valve edge to valve edge, eqs. (8), (9) and (12)."""
    edges = [(0.0, (0.0, 0.0))]
    for k, (fill, vent) in enumerate(commands):
        begin = k * sample_time + dead_time
        edges += [
            (begin, (1.0, 0.0)),
            (begin + fill * sample_time, (0.0, 1.0)),
            (begin + (fill + vent) * sample_time, (0.0, 0.0)),
        ]
    ends = [time for time, _ in edges[1:]] + [np.inf]
    pressure, now, found = 0.0, 0.0, []
    for (begin, (fill, vent)), end in zip(edges, ends, strict=True):
        inside = times[(times >= begin) & (times < end)]
        stops = [*inside, *([end] if np.isfinite(end) else [])]
        for time in stops:
            if time > now:

                def rate(t, p, fill=fill, vent=vent):
                    supply = brake.max_pressure * (1.0 - np.exp(-brake.supply_rate * t))
                    return fill * (supply - p) / brake.fill_time - vent * p / brake.vent_time

                pressure = solve_ivp(rate, (now, time), [pressure], rtol=1e-10, atol=1e-3).y[0, -1]
                now = time
            if time < end:
                found.append(pressure)
    return brake.max_torque * np.array(found) / brake.max_pressure


@pytest.mark.parametrize("shortest", [0.0, 0.01])
@pytest.mark.parametrize("dead_time", [0.0, 0.03, 0.1, 0.25, 1.234])
def test_valves_follow_commands_after_the_dead_time(light, wet, dead_time, shortest):
    law = Scheduled(commands=COMMANDS)
    sensing = Sensing(dead_time=dead_time, shortest_pulse=shortest)
    run = simulate(light, law, replace(wet, sensing=sensing))
    known = run.samples[:25]
    seen = np.array([s.seen.torque for s in known])
    times = np.array([s.time for s in known]) + 1e-12
    commands = [COMMANDS[min(k, len(COMMANDS) - 1)] for k in range(len(seen) + 1)]
    right = cylinder(light.brake, opened(commands, 0.1, shortest), 0.1, dead_time, times)
    np.testing.assert_allclose(seen, right, rtol=1e-7, atol=1e-6 * LIGHT)
    assert right.max() > 0.1 * LIGHT
    other = cylinder(light.brake, opened(commands, 0.1, shortest), 0.1, dead_time + 0.005, times)
    assert np.abs(seen - other).max() > 1e-3 * LIGHT  # another dead time is told apart
    if shortest:
        all_open = cylinder(light.brake, commands, 0.1, dead_time, times)
        assert np.abs(seen - all_open).max() > 5e-4 * LIGHT
