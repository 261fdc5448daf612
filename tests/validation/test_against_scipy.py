"""Whole stops against a second simulation, written from the paper and integrated by SciPy's Radau method."""

from dataclasses import replace

import pytest
from independent_stop import IndependentStop

from wspd_design.model.generated import motion as generated
from wspd_design.parameters.loading import constants, load_rail
from wspd_design.simulation import loop_input as module
from wspd_design.simulation.metrics import momentum_residual
from wspd_design.simulation.records import Scenario, Start
from wspd_design.simulation.stop import simulate

INITIAL_SPEED = 120.0 / 3.6


@pytest.mark.parametrize(
    ("controller", "rail"),
    [
        ("none", "polach-wet"),  # locks and stays locked
        ("trenitalia", "table10-dry"),  # fills, vents and holds
        ("afsmc", "polach-dry"),  # a relay on falling friction
    ],
)
def test_stop(er24pc, make_controller, stop, controller, rail):
    independent = IndependentStop(er24pc, load_rail(rail))
    time, (_, _, distance, _) = independent.run(make_controller(controller, rail), INITIAL_SPEED)
    run = stop(controller, rail)
    assert run.totals.distance == pytest.approx(distance, rel=1e-5)
    assert run.time[-1] == pytest.approx(time, rel=1e-5)
    if controller == "none":
        assert run.totals.lock_time > 15.0


@pytest.mark.parametrize(("controller", "rail"), [("none", "polach-wet"), ("trenitalia", "polach-dry")])
def test_stop_from_a_state(er24pc, make_controller, controller, rail):
    track, speed = load_rail(rail), 60.0 / 3.6
    law, begin = make_controller(controller, rail), {"slip": 0.2, "torque": 22e3, "braking_time": 1.5}
    time, (_, _, distance, _) = IndependentStop(er24pc, track).run(law, speed, **begin)
    run = simulate(
        er24pc, law, Scenario(rail=track, initial_speed=speed, start=Start(**begin)), plant="quarter"
    )
    assert run.totals.distance == pytest.approx(distance, rel=1e-5)
    assert run.time[-1] == pytest.approx(time, rel=1e-5)
    rolling = simulate(er24pc, law, Scenario(rail=track, initial_speed=speed), plant="quarter")
    assert run.totals.distance < 0.97 * rolling.totals.distance


def three_seconds(er24pc, make_controller, monkeypatch, name):
    """Brake for three seconds with both simulations; the name makes that the loop is traced anew."""
    limited = replace(constants(), time_limit=2.95)
    monkeypatch.setattr(module, "constants", lambda: limited)
    rail = load_rail("table10-dry")
    scenario = Scenario(rail=rail, initial_speed=INITIAL_SPEED)
    run = simulate(replace(er24pc, name=name), make_controller("none"), scenario, plant="quarter")
    assert run.time[-1] == pytest.approx(3.0)
    _, y = IndependentStop(er24pc, rail).run(make_controller("none"), INITIAL_SPEED, duration=2.95)
    return run, y


def test_three_seconds_agree(er24pc, make_controller, monkeypatch):
    run, (speed, wheel_speed, distance, _) = three_seconds(er24pc, make_controller, monkeypatch, "true")
    assert run.speed[-1] == pytest.approx(speed, rel=1e-8)
    assert run.final_wheel_speeds[0] == pytest.approx(wheel_speed, rel=1e-8)
    assert run.totals.distance == pytest.approx(distance, rel=1e-8)
    assert abs(momentum_residual(run, er24pc)) < 1e-6


def test_a_wrong_sign_in_the_wheel_equation_is_seen(er24pc, make_controller, monkeypatch):
    # The planted fault: the braking torque drives the wheel in eq. (2) of the plant.
    true = generated.wheel_acceleration
    monkeypatch.setattr(
        generated, "wheel_acceleration", lambda f, w, torque, *rest: true(f, w, -torque, *rest)
    )
    run, (speed, _, distance, _) = three_seconds(er24pc, make_controller, monkeypatch, "wrong sign")
    assert run.speed[-1] > 1.2 * speed
    assert abs(run.totals.distance / distance - 1.0) > 0.01
    assert abs(momentum_residual(run, er24pc)) > 0.1


def test_the_independent_simulation_is_independent():
    import inspect

    import independent_stop

    imported = [line for line in inspect.getsource(independent_stop).splitlines() if "import" in line]
    assert [line for line in imported if "wspd_design" in line] == [
        "from wspd_design.controllers.protocol import Measurement"
    ]
