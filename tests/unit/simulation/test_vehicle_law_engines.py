"""Laws of a whole vehicle in every engine: what they see, what is judged of them, what fails under them."""

import math
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.sampled import flat, measurement_of
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.controllers.protocol import ByWheelset, Command, VehicleMeasurement
from wspd_design.model.number import clip, log, maximum, minimum, sqrt, where
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.draws import Draw, Uniform
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import Fault, Scenario, Sensing
from wspd_design.simulation.stop import simulate

SHORT = 6.0  # m/s
NAMES = ("train_speed", *(f"slip_reference_{k}" for k in range(1, 5)), "clock")


@dataclass(frozen=True, slots=True, kw_only=True)
class FastestWheel:
    """A law of four wheelsets that takes the rim of the fastest wheel for the train."""

    name: str = "fastest wheel"
    sample_time: float = 0.05
    wheelsets: int = 4
    radius: float = 0.55
    slip: float = 0.1
    memory: tuple[str, ...] = NAMES
    seen: list = field(default_factory=list, compare=False)  # by a run in Python

    def start(self, measurement):
        return (measurement.speed, *(self.slip,) * 4, 0.0)

    def step(self, state, measurement):
        self.seen.append(measurement)
        fastest = maximum(maximum(*measurement.wheel_speeds[:2]), maximum(*measurement.wheel_speeds[2:]))
        speed = maximum(fastest * self.radius, 0.01)
        # Elementary functions of gains and of symbols.
        held = self.slip * sqrt(log(math.e)) + 0.0 * sqrt(self.slip) * log(self.slip)
        commands = []
        for wheel, healthy in zip(measurement.wheel_speeds, measurement.healthy, strict=True):
            over = clip(20.0 * (1.0 - self.radius * wheel / speed - held) + 0.0 * log(speed), -1.0, 1.0)
            over = where(healthy > 0.5, over, 1.0)
            commands.append(Command(fill=maximum(-over, 0.0), vent=maximum(over, 0.0)))
        clock = state[-1] + minimum(self.sample_time, 1.0)
        return (speed, *(held,) * 4, clock), tuple(commands)


@pytest.fixture(scope="module")
def polach_wet():
    return load_rail("polach-wet")


@pytest.fixture
def law(er24pc):
    return FastestWheel(radius=er24pc.wheel_radius)


@pytest.fixture
def noisy(polach_wet):
    return Scenario(
        rail=polach_wet,
        initial_speed=SHORT,
        seed=3,
        grade=0.004,
        sensing=Sensing(
            accelerometer_bias=0.03,
            accelerometer_noise=0.05,
            radius_errors=(0.0, 0.004, -0.003, 0.0),
            speed_noise=0.02,
            torque_error=0.1,
            pulses_per_turn=100,
            period_timing=True,
        ),
        faults=(Fault(axle=3, kind="sensor-lost", since=1.02), Fault(axle=2, kind="valve-holds", since=2.0)),
    )


def outputs(plant, law, scenario):
    given = loop_input([(plant, scenario)], law)
    rows = sample_rows(law)
    yield "compiled", load_closed_loop(plant, law).run(given, sample_rows=rows)
    yield "python", load_closed_loop(plant, None).run_with(given, law, sample_rows=rows)
    yield "virtual", run_virtual(plant, law, given, sample_rows=rows, disturbed=False)


def test_every_engine_has_the_same_numbers(er24pc, law, noisy):
    found = dict(outputs(Planar(er24pc), law, noisy))
    compiled = found.pop("compiled")
    for name, other in found.items():
        np.testing.assert_allclose(other.samples, compiled.samples, rtol=1e-6, atol=1e-6, err_msg=name)
        for totals in ("lane_totals", "stop_totals"):
            for key, values in getattr(compiled, totals).items():
                told = getattr(other, totals)[key]
                np.testing.assert_allclose(told, values, rtol=1e-6, atol=1e-6, err_msg=f"{name} {key}")
    assert compiled.stop_totals["speed_error"][0] > 0.0
    assert compiled.lane_totals["slip_band"].max() > 0.0


@pytest.mark.parametrize("kind", ["valve-holds", "valve-vents", "valve-fills"])
def test_stuck_valves_in_every_engine(er24pc, law, polach_wet, kind):
    brake = replace(er24pc.brake, longest_release=0.4)  # the watchdog cannot move them either
    scenario = Scenario(rail=polach_wet, initial_speed=SHORT, faults=(Fault(axle=1, kind=kind, since=1.0),))
    found = dict(outputs(Planar(replace(er24pc, brake=brake)), law, scenario))
    for other in found.values():
        np.testing.assert_allclose(other.samples, found["compiled"].samples, rtol=1e-6, atol=1e-6)
    pressure = found["compiled"].samples[:, -3 - 4]  # of the first wheelset
    after = pressure[found["compiled"].samples[:, 0] >= 1.0 + law.sample_time]
    rises = np.diff(after)
    assert {"valve-holds": abs(rises).max() < 1e-3, "valve-vents": rises.max() <= 0.0}.get(
        kind, rises.min() >= 0.0
    )


def test_a_law_of_one_wheelset_runs_unchanged(er24pc, make_controller, polach_wet):
    scenario = Scenario(rail=polach_wet, initial_speed=SHORT)
    law = make_controller("afsmc")
    alone, together = (simulate(er24pc, each, scenario) for each in (law, ByWheelset(law=law, wheelsets=4)))
    assert together.totals.distance == pytest.approx(alone.totals.distance, rel=1e-12)
    for one, other in zip(alone.axle_samples, together.axle_samples, strict=True):
        np.testing.assert_allclose([each[:3] for each in other], [each[:3] for each in one], rtol=1e-9)
    states = together.samples[-1].state
    assert states[0::4] == pytest.approx(alone.axle_samples[0][-1].state, rel=1e-9)


def test_what_the_law_sees(er24pc, law, noisy):
    """The true numbers with their disturbances, and nothing else."""
    scenario = replace(noisy, sensing=Sensing(radius_errors=(0.0, 0.004, 0.0, 0.0)), faults=noisy.faults[:1])
    loop = load_closed_loop(Planar(er24pc), None)
    given = replace(loop_input([(Planar(er24pc), scenario)], law), trace_rows=9000)
    output = loop.run_with(given, law, sample_rows=sample_rows(law))
    seen, times = law.seen[1:], output.samples[1:, 0]  # after the first, where no trace is
    speed = np.interp(times, output.trace[:, 0], output.trace[:, 1])
    np.testing.assert_allclose([each.speed for each in seen], speed, atol=2e-3)
    wheels = np.array([each.wheel_speeds for each in seen])
    true = np.stack([np.interp(times, output.trace[:, 0], output.trace[:, 3 + k]) for k in range(4)], axis=1)
    lost = times >= 1.02
    np.testing.assert_allclose(wheels[:, 1], 1.004 * true[:, 1], atol=2e-2)
    np.testing.assert_allclose(wheels[~lost, 2], true[~lost, 2], atol=2e-2)
    assert (wheels[lost, 2] == 0.0).all()
    assert [each.healthy[2] for each in seen] == [0.0 if gone else 1.0 for gone in lost]
    unit = er24pc.brake.max_torque / er24pc.brake.max_pressure
    np.testing.assert_allclose(
        [[p * unit for p in each.pressures] for each in seen], [each.torques for each in seen], rtol=1e-9
    )
    # A grade is felt, as by a pendulum: what is left is the deceleration by rails and resistance.
    slope = np.gradient(output.trace[:, 1], output.trace[:, 0])
    felt = np.interp(times, output.trace[:, 0], slope) + 9.81 * scenario.grade
    middle = slice(5, -5)
    np.testing.assert_allclose([each.acceleration for each in seen][middle], felt[middle], atol=0.03)
    demand = 1.0 - np.exp(-er24pc.brake.supply_rate * times)
    np.testing.assert_allclose([each.demand for each in seen], demand, rtol=1e-9)
    assert all(each.reservoir == er24pc.brake.supply_pressure for each in seen)


def test_bias_and_noise_of_the_accelerometer(er24pc, law, noisy):
    def felt(**numbers):
        scenario = replace(noisy, sensing=Sensing(**numbers), faults=())
        made = replace(law, seen=[])
        given = loop_input([(Planar(er24pc), scenario)], made)
        load_closed_loop(Planar(er24pc), None).run_with(given, made, sample_rows=sample_rows(made))
        return np.array([each.acceleration for each in made.seen])

    calm = felt()
    np.testing.assert_allclose(felt(accelerometer_bias=0.03) - calm, 0.03, atol=1e-12)
    noise = felt(accelerometer_noise=0.05) - calm
    assert noise[1:].std() == pytest.approx(0.05, rel=0.3)
    assert abs(noise.mean()) < 0.02


def test_judged_speed_and_distance(er24pc, law, noisy):
    """Largest errors, worked out anew from samples and traces."""
    scenario = replace(noisy, initial_speed=12.0, faults=())
    run = simulate(er24pc, law, scenario)
    times = np.array([each.time for each in run.samples])
    told = np.array([each.state[0] for each in run.samples])
    true, passed = (np.interp(times, run.time, of) for of in (run.speed, run.distance))
    fast = true > 20.0 / 3.6
    assert run.totals.speed_error == pytest.approx(abs(told / true - 1.0)[fast].max(), rel=2e-2)
    travelled = np.concatenate([[0.0], np.cumsum(0.5 * law.sample_time * (told[1:] + told[:-1]))])
    apart = (abs(travelled - passed) / (5.0 + 0.05 * passed)).max()
    assert run.totals.distance_error == pytest.approx(apart, rel=2e-2)
    assert run.memory == NAMES


def test_a_speed_that_is_no_number_is_an_error_without_end(er24pc, law, noisy):
    @dataclass(frozen=True, slots=True, kw_only=True)
    class Broken(FastestWheel):
        def step(self, state, measurement):
            following, commands = FastestWheel.step(self, state, measurement)
            late = following[-1] > 1.0
            return (where(late, math.nan, following[0]), *following[1:]), commands

    broken = Broken(radius=law.radius)
    for name, output in outputs(Planar(er24pc), broken, replace(noisy, initial_speed=9.0, faults=())):
        assert output.stop_totals["speed_error"][0] == math.inf, name
        assert output.stop_totals["distance_error"][0] == math.inf, name


def test_rows_of_a_campaign_are_stops_alone(er24pc, law, noisy):
    drawn = (
        Draw(name="vehicle.mass", distribution=Uniform(low=70e3, high=90e3)),
        Draw(name="stop.sensing.accelerometer_bias", distribution=Uniform(low=-0.05, high=0.05)),
    )
    table = simulate_many(er24pc, law, noisy, count=16, draws=drawn, check_every=0).table
    for name in ("speed_error", "distance_error", "slip_band"):
        assert len(set(table[name])) == 16
    row = table[5]
    body = er24pc.body_mass + float(row["vehicle.mass"]) - er24pc.mass
    sensing = replace(noisy.sensing, accelerometer_bias=float(row["stop.sensing.accelerometer_bias"]))
    alone = simulate(
        replace(er24pc, mass=float(row["vehicle.mass"]), body_mass=body),
        law,
        replace(noisy, seed=int(row["seed"]), sensing=sensing),
    )
    assert row["distance_m"] == pytest.approx(alone.totals.distance, rel=1e-9)
    assert row["speed_error"] == pytest.approx(alone.totals.speed_error, rel=1e-9)
    assert row["slip_band"] == pytest.approx(alone.totals.slip_band, rel=1e-9)


def test_laws_of_one_wheelset_tell_no_speed(er24pc, make_controller, polach_wet):
    scenario = Scenario(rail=polach_wet, initial_speed=SHORT)
    totals = simulate(er24pc, make_controller("trenitalia"), scenario).totals
    assert all(math.isnan(each) for each in (totals.speed_error, totals.distance_error, totals.slip_band))


def test_measurements_as_numbers():
    seen = VehicleMeasurement(1.0, (2.0, 3.0), (4.0, 5.0), (1.0, 0.0), (6.0, 7.0), 8.0, 9.0, 10.0)
    assert measurement_of(flat(seen), 2) == seen


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"faults": (Fault(axle=5, kind="sensor-lost"),)}, "vehicle er24pc has 4"),
        ({"sensing": Sensing(radius_errors=(0.01,))}, "name 4, one for each wheelset"),
    ],
)
def test_what_does_not_fit_the_vehicle(er24pc, law, polach_wet, changes, words):
    with pytest.raises(UserError, match=words):
        simulate(er24pc, law, Scenario(rail=polach_wet, initial_speed=SHORT, **changes))


def test_a_law_of_another_number_of_wheelsets(er24pc, law, polach_wet):
    with pytest.raises(UserError, match="acts on 6 wheelsets and vehicle er24pc has 4"):
        simulate(er24pc, replace(law, wheelsets=6), Scenario(rail=polach_wet, initial_speed=SHORT))


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"axle": 0, "kind": "sensor-lost"}, "axle = 0"),
        ({"axle": 1, "kind": "broken"}, "must be one of sensor-lost"),
        ({"axle": 1, "kind": "sensor-lost", "since": math.nan}, "start = nan"),
    ],
)
def test_what_is_no_fault(numbers, words):
    with pytest.raises(UserError, match=words):
        Fault(**numbers)


def test_driving_in_python_ends_when_the_samples_are_full(er24pc, law, polach_wet):
    given = loop_input([(Planar(er24pc), Scenario(rail=polach_wet, initial_speed=SHORT))], law)
    output = load_closed_loop(Planar(er24pc), None).run_with(given, law, sample_rows=3)
    assert output.result == 1
    assert len(output.samples) == 3
