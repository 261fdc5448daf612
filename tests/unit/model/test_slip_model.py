"""Slip ratio and eq. (19), against the chain rule and against numerical derivatives."""

import numpy as np
import pytest

from wspd_design.model import slip
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.quarter import quarter

SPEEDS = (0.5, 1.0, 5.0, 20.0, 33.333)
SLIPS = (0.001, 0.05, 0.14, 0.6, 0.99)
RAILS = uniform_rails()


def test_slip_ratio_is_kept_finite_at_standstill():
    assert slip.slip_ratio(10.0, 10.0 / 0.55, 0.55) == pytest.approx(0.0, abs=1e-15)
    assert slip.slip_ratio(10.0, 0.0, 0.55) == 1.0
    assert slip.slip_ratio(0.1, 0.0, 0.55) == 1.0
    assert slip.slip_ratio(0.05, 0.0, 0.55) == 0.5
    assert slip.slip_ratio(0.0, 0.0, 0.55) == 0.0


def test_resistance_and_wheel_load_of_the_calibrated_vehicle(er24pc):
    assert slip.resistance(er24pc, 30.0) == pytest.approx(2000.0 + 20.0 * 30.0 + 3.0 * 900.0)
    assert slip.static_wheel_load(er24pc) == pytest.approx(76841 * 9.81 / 8)


@pytest.mark.parametrize("name", RAILS)
def test_slip_equation_is_the_chain_rule_of_the_motion(er24pc, name):
    # lambda' = -R omega'/v + R omega v'/v^2 by (3), with v' and omega' of (1), (2) from the plant.
    rail = load_rail(name)
    plant = quarter(er24pc, rail)
    radius = er24pc.wheel_radius
    for v in SPEEDS:
        for lam in SLIPS:
            omega = (1.0 - lam) * v / radius
            dynamics = slip.slip_dynamics(er24pc, rail, lam, v)
            for torque in (0.0, 23e3, 60e3):
                motion = plant.motion(0.0, v, omega, torque)
                by_chain = (
                    -radius * motion.wheel_acceleration / v + radius * omega * motion.acceleration / v**2
                )
                scale = dynamics.gain * 60e3 + abs(dynamics.drift)
                assert dynamics.drift + dynamics.gain * torque == pytest.approx(by_chain, abs=1e-12 * scale)
            assert dynamics.deceleration == pytest.approx(-motion.acceleration, rel=1e-13)
            assert dynamics.creep_force == pytest.approx(motion.creep_force, rel=1e-12)


@pytest.mark.parametrize("name", RAILS)
def test_pole_against_complex_step_and_finite_differences(er24pc, name):
    rail = load_rail(name)

    def drift(lam, v):
        return slip.slip_dynamics(er24pc, rail, lam, v).drift

    for v in SPEEDS:
        for lam in SLIPS:
            pole = slip.slip_dynamics(er24pc, rail, lam, v).pole
            exact = drift(np.complex128(complex(lam, 1e-30)), v).imag / 1e-30
            assert pole == pytest.approx(exact, rel=1e-11)
            # Richardson's extrapolation of the central difference; its step shrinks with the slip.
            coarse, fine = (
                (drift(lam * (1 + h), v) - drift(lam * (1 - h), v)) / (2 * lam * h) for h in (2e-3, 1e-3)
            )
            scale = abs(pole) + abs(drift(lam, v)) / lam * 1e-3
            assert (4 * fine - coarse) / 3 == pytest.approx(pole, abs=1e-6 * scale)


def test_wheel_load_can_be_fixed_apart_from_the_mass(er24pc):
    rail = load_rail("polach-dry")
    own = slip.slip_dynamics(er24pc, rail, 0.14, 10.0)
    same = slip.slip_dynamics(er24pc, rail, 0.14, 10.0, wheel_load=slip.static_wheel_load(er24pc))
    lighter = slip.slip_dynamics(er24pc, rail, 0.14, 10.0, wheel_load=0.8 * slip.static_wheel_load(er24pc))
    assert own == same
    assert lighter.creep_force < 0.85 * own.creep_force
