"""The quarter locomotive against eqs. (1)-(7) written out again."""

import math

import pytest

from wspd_design.model.number import maximum
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.quarter import quarter


def written_out(vehicle, rail, time, v, omega, torque):
    """Eqs. (1)-(7) with the paper's letters."""
    c = vehicle.contact
    Q, R, I_W, m = vehicle.mass * 9.81 / 8, vehicle.wheel_radius, vehicle.wheelset_inertia / 2, vehicle.mass
    lam = (v - R * omega) / maximum(v, 0.1)
    mu = rail.mu0 * (
        (1 - rail.friction_ratio) * math.exp(-rail.friction_decay * abs(v - R * omega)) + rail.friction_ratio
    )
    G_a_b = c.shear_modulus * c.semi_axis_rolling * c.semi_axis_lateral * (Q / c.reference_load) ** (2 / 3)
    eps = math.pi * G_a_b * c.kalker_c11 / (4 * Q * mu) * lam
    kA, kS = rail.adhesion_reduction, rail.slip_reduction
    f = 2 * Q * mu / math.pi * (kA * eps / (1 + (kA * eps) ** 2) + math.atan(kS * eps))
    f_d = vehicle.resistance_constant + vehicle.resistance_linear * v + vehicle.resistance_quadratic * v**2
    B_W = vehicle.wheel_damping * math.exp(-vehicle.wheel_damping_decay * time)
    return (-f_d - 8 * f) / m, (-0.5 * torque - B_W * omega + R * f) / I_W, lam, f, f_d, B_W


@pytest.mark.parametrize("name", uniform_rails())
@pytest.mark.parametrize(
    ("v", "omega", "torque"),
    [(33.3, 60.0, 0.0), (20.0, 20.0, 31e3), (10.0, 0.0, 60e3), (0.05, 0.05, 1e3), (5.0, 9.2, 100.0)],
)
def test_motion(er24pc, name, v, omega, torque):
    rail = load_rail(name)
    motion = quarter(er24pc, rail).motion(2.5, v, omega, torque)
    assert tuple(motion) == pytest.approx(
        written_out(er24pc, rail, 2.5, v, omega, torque), rel=1e-12, abs=1e-12
    )


@pytest.mark.parametrize("name", uniform_rails())
@pytest.mark.parametrize("v", [0.01, 1.0, 30.0])
def test_the_creep_force_balances_a_locked_wheel(er24pc, name, v):
    # With exactly this torque a wheel at rest has no acceleration.
    rail = load_rail(name)
    plant = quarter(er24pc, rail)
    torque = 2 * 0.55 * plant.motion(0.0, v, 0.0, 0.0).creep_force
    assert torque == pytest.approx(2 * 0.55 * written_out(er24pc, rail, 0.0, v, 0.0, 0.0)[3], rel=1e-12)
    assert plant.motion(0.0, v, 0.0, torque).wheel_acceleration == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", uniform_rails())
@pytest.mark.parametrize("v", [0.2, 2.0, 33.0])
def test_creep_rate_bounds_the_rate_of_the_slip(er24pc, name, v):
    rail = load_rail(name)
    plant = quarter(er24pc, rail)
    radius = er24pc.wheel_radius

    def slip_rate(lam):
        omega = (1.0 - lam) * v / radius
        motion = plant.motion(0.0, v, omega, 0.0)
        return -radius * motion.wheel_acceleration / v + radius * omega * motion.acceleration / v**2

    rates = [
        -(slip_rate(lam * 1.0001) - slip_rate(lam * 0.9999)) / (2e-4 * lam)
        for lam in (1e-6, 1e-4, 0.01, 0.14, 0.9)
    ]
    assert max(rates) < plant.creep_rate(v) * (1.0 + 1e-3)
    assert max(rates) > 0.9 * plant.creep_rate(v)
