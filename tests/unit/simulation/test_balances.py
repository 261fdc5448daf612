"""Momentum and energy balances of every controller on every kind of rail, and faults that they see."""

from dataclasses import replace

import pytest

from wspd_design.model.generated import motion as generated
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.metrics import energy_residual, momentum_residual
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

CONTROLLERS = ("afsmc", "smc", "trenitalia", "knorr-bremse", "mitsubishi", "none")
RAILS = ("table10-dry", "table10-wet", "polach-dry")


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize("name", CONTROLLERS)
def test_residuals(judged, name, rail):
    assert abs(judged(name, rail).momentum_residual) < 1e-12  # to rounding
    assert (
        abs(judged(name, rail).energy_residual) < 1e-6
    )  # the quadrature of the works has the order of the steps


@pytest.mark.parametrize("name", CONTROLLERS)
def test_work_has_the_right_signs_and_sizes(er24pc, stop, name):
    totals = stop(name, "table10-dry").totals
    energy = 0.5 * (er24pc.mass + 4 * er24pc.wheelset_inertia / 0.55**2) * (120 / 3.6) ** 2
    shares = [
        w / energy
        for w in (totals.brake_work, totals.sliding_work, totals.resistance_work, totals.damping_work)
    ]
    assert all(0.0 < share < 1.0 for share in shares)
    assert 0.01 < shares[2] < 0.03  # 4 kN over 180 m of 46 MJ
    assert shares[3] < 1e-3  # "negligible either way" (findings)


FAULTS = {
    "inertia of the wheel 1 % larger": lambda a: {**a, "wheel_inertia": 1.01 * a["wheel_inertia"]},
    "sign of the damping": lambda a: {**a, "wheel_damping": -a["wheel_damping"]},
    "torque 1 % larger": lambda a: {**a, "braking_torque": 1.01 * a["braking_torque"]},
    "creep force 1 % larger": lambda a: {**a, "creep_force": 1.01 * a["creep_force"]},
}
ARGUMENTS = ("creep_force", "wheel_speed", "braking_torque", "wheel_inertia", "wheel_radius", "wheel_damping")


@pytest.fixture
def residuals_with(monkeypatch, er24pc, make_controller):
    """Simulate a stop that does not slide, with a fault planted in eq. (2); return both residuals."""

    def simulated(fault):
        true = generated.wheel_acceleration
        monkeypatch.setattr(
            generated,
            "wheel_acceleration",
            lambda *values: true(**fault(dict(zip(ARGUMENTS, values, strict=True)))),
        )
        # A name of its own, so that the loop is traced anew.
        gentle = replace(er24pc, name=f"faulty {fault}", brake=replace(er24pc.brake, max_torque=25e3))
        scenario = Scenario(rail=load_rail("polach-dry"), initial_speed=20.0)
        run = simulate(gentle, make_controller("none"), scenario, plant="quarter")
        assert run.totals.lock_time == 0.0
        return abs(momentum_residual(run, gentle)), abs(energy_residual(run, gentle))

    return simulated


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_in_the_wheel_equation_is_seen(residuals_with, fault):
    momentum, energy = residuals_with(FAULTS[fault])
    assert momentum > 1e-5
    assert energy > 1e-5


def test_without_a_fault_nothing_is_seen(residuals_with):
    momentum, energy = residuals_with(lambda arguments: arguments)
    assert momentum < 1e-6
    assert energy < 1e-5


def test_another_inertia_or_mass_in_the_balance_is_seen(er24pc, stop):
    run = stop("trenitalia", "table10-dry")
    for changed in ({"wheelset_inertia": 753.0}, {"mass": 76842.0}, {"wheel_radius": 0.5501}):
        assert abs(momentum_residual(run, replace(er24pc, **changed))) > 1e-6
        if "wheel_radius" not in changed:  # which is not in the energy of masses that move and turn
            assert abs(energy_residual(run, replace(er24pc, **changed))) > 1e-6
