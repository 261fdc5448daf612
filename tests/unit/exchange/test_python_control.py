"""Plants and laws as systems of python-control: the same numbers as ours, and loops that close."""

import numpy as np
import pytest
from scipy.linalg import expm

import wspd_design as wd
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.protocol import Measurement
from wspd_design.exchange.python_control import decided_names, seen_names

PERIOD, KMH = 0.02, 80.0


@pytest.fixture(scope="module")
def rail():
    return wd.load_rail("polach-wet")


@pytest.fixture(scope="module")
def point(er24pc, rail):
    return wd.linearize(er24pc, rail, slip=0.14, speed_kmh=KMH)


@pytest.fixture(scope="module")
def law(er24pc, rail):
    return wd.controller("smc", er24pc, rail, wd.Specification(sample_time=PERIOD))


def test_the_slip_rests_and_linearizes_as_ours(er24pc, rail, point):
    system = wd.slip_system(er24pc, rail, speed_kmh=KMH)
    state, valve = [0.14, point.equilibrium_torque], [point.equilibrium_duty, 1.0 - point.equilibrium_duty]
    assert system.dynamics(0.0, state, valve) == pytest.approx([0.0, 0.0], abs=1e-7)
    found = system.linearize(state, valve)
    assert pytest.approx(point.state_matrix, rel=1e-4, abs=1e-9) == found.A
    assert pytest.approx(point.input_matrix, rel=1e-4, abs=1e-6) == found.B @ [[1.0], [-1.0]]


def test_an_orifice_rests_as_well(er24pc, rail):
    from dataclasses import replace

    vehicle = replace(er24pc, brake=replace(er24pc.brake, valve="orifice"))
    point = wd.linearize(vehicle, rail, slip=0.14, speed_kmh=KMH)
    system = wd.slip_system(vehicle, rail, speed_kmh=KMH)
    valve = [point.equilibrium_duty, 1.0 - point.equilibrium_duty]
    assert system.dynamics(0.0, [0.14, point.equilibrium_torque], valve) == pytest.approx(
        [0.0, 0.0], abs=1e-6
    )


def test_the_quarter_has_the_rates_of_the_simulation(er24pc, rail):
    """Integrated by python-control with the brake filling, it is the first second of a stop."""
    import control

    law = wd.controller("none", er24pc, rail, wd.Specification())
    run = wd.simulate(er24pc, law, wd.Scenario.stop(from_kmh=KMH, rail=rail), plant="quarter")
    system = wd.quarter_system(er24pc, rail)
    times = np.linspace(0.0, 1.0, 51)
    start = [KMH / 3.6, KMH / 3.6 / er24pc.wheel_radius, 0.0]
    found = control.input_output_response(
        system,
        times,
        [np.ones(51), np.zeros(51)],
        start,
        solve_ivp_method="Radau",
        solve_ivp_kwargs={"rtol": 1e-9, "atol": 1e-9},
    )
    assert found.outputs[0] == pytest.approx(np.interp(times, run.time, run.speed), rel=1e-6)
    assert found.outputs[1] == pytest.approx(np.interp(times, run.time, run.wheel_speed[:, 0]), rel=1e-4)
    pressure = np.interp(times, run.time, run.cylinder_pressure[:, 0])
    assert found.outputs[2] == pytest.approx(pressure, rel=1e-4, abs=50.0)


def test_a_law_steps_as_itself(law):
    system = wd.law_system(law)
    seen = Measurement(22.0, 22.0 * 0.8 / 0.55, 2e4)
    state = wd.law_start(law, seen)
    assert state.tolist() == pytest.approx(list(law.start(seen)))
    after, command = law.step(tuple(state), seen)
    assert system.dt == PERIOD
    assert system.dynamics(0.0, state, seen) == pytest.approx(list(after))
    assert system.output(0.0, state, seen) == pytest.approx(list(command))
    assert (system.input_labels, system.output_labels) == (
        ["speed", "wheel_speed", "torque"],
        ["fill", "vent"],
    )


def test_a_law_of_a_vehicle_has_names_in_the_order_of_its_numbers(er24pc, rail):
    sensors = Sensors(speed="wheels")
    law = wd.controller("observer-smc", er24pc, rail, wd.Specification(sample_time=PERIOD, sensors=sensors))
    system = wd.law_system(law)
    run = wd.simulate(er24pc, law, wd.Scenario.stop(from_kmh=30, rail=rail))
    assert seen_names(law)[4:6] == ["wheel_speed_1", "wheel_speed_2"]
    assert decided_names(law)[-1] == "vent_4"
    assert system.nstates == len(run.memory)
    first = dict.fromkeys(seen_names(law), 0.0)
    for axle, samples in enumerate(run.axle_samples, start=1):
        seen = samples[0].seen
        first[f"speed_{axle}"], first[f"wheel_speed_{axle}"] = seen.speed, seen.wheel_speed
        first[f"torque_{axle}"], first[f"healthy_{axle}"] = seen.torque, 1.0
    first["reservoir"] = er24pc.brake.supply_pressure
    seen = np.array(list(first.values()))
    after = system.dynamics(0.0, wd.law_start(law, seen), seen)
    assert after[run.memory.index("train_speed")] == pytest.approx(30 / 3.6, rel=1e-4)


def test_a_sampled_loop_has_the_poles_of_its_step_matrix(er24pc, point, law):
    """The loop of python-control against one that is put together by hand: differences of step, matrix exponential."""
    import control

    speed, radius, held = KMH / 3.6, er24pc.wheel_radius, point.equilibrium_torque
    at = np.array([speed, speed * 0.86 / radius, held])
    state = wd.law_start(law, at) * 0.0
    linear = wd.linear_law(law, state=state, seen=at)
    plant = control.ss(point.state_matrix, point.input_matrix, np.eye(2), 0.0)
    sampled = control.sample_system(plant, PERIOD, "zoh")
    to_seen = np.array([[0.0, 0.0], [-speed / radius, 0.0], [0.0, 1.0]])  # of deviations of slip and torque
    duty = np.array([[1.0, 0.0]])
    loop = np.block(
        [
            [sampled.A + sampled.B @ duty @ linear.D @ to_seen, sampled.B @ duty @ linear.C],
            [linear.B @ to_seen, linear.A],
        ]
    )

    def stepped(deviation):
        slip, torque, *memory = deviation
        seen = Measurement(speed, speed * (1.0 - 0.14 - slip) / radius, held + torque)
        after, command = law.step(tuple(state + memory), seen)
        _, rest = law.step(tuple(state), Measurement(*at))
        block = np.zeros((3, 3))
        block[:2, :2], block[:2, 2:] = point.state_matrix, point.input_matrix
        exact = expm(block * PERIOD)
        moved = exact[:2, :2] @ [slip, torque] + exact[:2, 2] * (command.fill - rest.fill)
        return np.array([*moved, *np.array(after)])

    rest = stepped(np.zeros(3))
    steps = (1e-6, 1e-1, 1e-6)
    by_hand = np.array(
        [(stepped(step * unit) - rest) / step for step, unit in zip(steps, np.eye(3), strict=True)]
    ).T
    assert sorted(abs(np.linalg.eigvals(loop))) == pytest.approx(
        sorted(abs(np.linalg.eigvals(by_hand))), rel=1e-4
    )


@pytest.mark.parametrize("speed", [0.0, -3.0, 600.0, float("nan")])
def test_a_speed_that_cannot_be_is_refused(er24pc, rail, speed):
    with pytest.raises(wd.UserError, match=r"speed_kmh = .* must be above 0 and below 540 km/h"):
        wd.slip_system(er24pc, rail, speed_kmh=speed)


def test_the_whole_vehicle_has_its_names_and_its_slip_grows(er24pc, rail):
    system = wd.vehicle_system(er24pc, rail, speed_kmh=KMH, slip=0.14)
    assert system.input_labels[0] == "torque_1"
    assert {"speed", "wheel_speed_4", "slip_1", "load_4_right"} <= set(system.output_labels)
    assert len(system.state_labels) == system.nstates == 159
    point = wd.linearize(er24pc, rail, slip=0.14, speed=KMH / 3.6)
    growing = sorted(pole.real for pole in system.poles() if pole.real > 0.2 and abs(pole.imag) < 1e-9)
    assert len(growing) == 4
    assert sum(growing) / 4.0 == pytest.approx(point.slip_pole, rel=0.2)  # at a speed that stays


def test_a_vehicle_without_a_multibody_file_is_refused(rail):
    with pytest.raises(wd.UserError, match="multibody"):
        wd.vehicle_system(wd.load_vehicle("metro"), rail, speed_kmh=KMH)
