"""The sampled loop in deviations: its identities, and the same loop simulated in numbers of the plant."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from tests.lazily import Lazily, residuals
from wspd_design.model.generated import slip_loop as generated

slip_loop = Lazily("slip_loop")


def test_every_identity_holds():
    assert residuals("slip_loop")
    assert {name for name, left in residuals("slip_loop").items() if left != 0} == set()


def test_there_are_identities():
    assert len(residuals("slip_loop")) == 17


def test_bend_says_which_way_the_edges_curve():
    assert slip_loop.bend_residual == 0  # d slope/d span = -exp(...) < 0
    assert slip_loop.run_residual == 0  # d phi/d span has the sign of last - first


H, INERTIA, TRUE_INERTIA, PADS, RADIUS = 0.02, 752.0, 830.0, 0.88, 0.55
SPEED, BRAKING, SLIP, JERK = 8.0, -1.3, 0.14, 0.6
SLIP_RATE = 0.05  # 1/s, of the slip that is held, where it changes
FRICTION, SECANT = 21e3, -3.0  # N m on the reference at the start, 1/s
RATE, OBSERVER, AHEAD = 8.0, 30.0, 0.45
FULL, FILL_TIME, SHARE = 60e3, 0.45, 0.6 * 0.6  # N m, s, s that the law assumes


def reference(t, rate):
    """Wheel speed of a slip that changes, and its rate at a fixed slip."""
    v, slip = SPEED + BRAKING * t + JERK * t * t / 2.0, SLIP + rate * t
    return (1.0 - slip) * v / RADIUS, (1.0 - slip) * (BRAKING + JERK * t) / RADIUS


@pytest.mark.parametrize(
    ("slip_rate", "delay", "misread"),
    [(0.0, 0.0, (0.0, 0.0)), (SLIP_RATE, 0.3, (0.01, -0.02)), (-SLIP_RATE, 0.7, (-0.01, 0.02))],
)
def test_loop_in_deviations_is_the_loop_in_numbers_of_the_plant(slip_rate, delay, misread):
    """With a pulse that begins late, over the sample time, and errors of the wheel speed at both samples [rad/s]."""

    def reference_at(t):
        return reference(t, slip_rate)

    def friction(t, w):
        return FRICTION + 900.0 * t + SECANT * TRUE_INERTIA * (w - reference_at(t)[0])

    def held(t):
        """Torque that holds the reference, over the inertia of the law."""
        g = PADS * INERTIA / TRUE_INERTIA
        return (friction(t, reference_at(t)[0]) / TRUE_INERTIA - reference_at(t)[1]) / g

    e, p, observed_friction, torque = 0.03, -0.004, FRICTION * 1.02, 22.9e3
    w0, rate0 = reference_at(0.0)
    known_rate, theta = rate0 - 0.05, math.exp(-OBSERVER * H)
    ahead = e + misread[0] + AHEAD * H * ((observed_friction - torque) / INERTIA - known_rate)
    target = observed_friction - INERTIA * (known_rate - RATE * ahead)
    assert target > torque
    pulse = SHARE * math.log((FULL - torque) / (FULL - target))
    assert pulse + delay * H < H

    def assumed_torque(t):
        return FULL - (FULL - torque) * math.exp(-min(t, pulse) / FILL_TIME)

    def seen_torque(t):
        return assumed_torque(max(t - delay * H, 0.0))

    def motion(t, state):
        return [(friction(t, state[0]) - PADS * seen_torque(t)) / TRUE_INERTIA]

    run = solve_ivp(motion, (0.0, H), [w0 + e], rtol=1e-12, atol=1e-12, max_step=1e-3)
    w1 = float(run.y[0, -1])
    mean = quad(assumed_torque, 0.0, H, epsabs=1e-9)[0] / H  # what a law with a good model works out
    expected = w0 + e + p + H / INERTIA * (observed_friction - mean)
    r = w1 + misread[1] - expected
    after = (
        w1 - reference_at(H)[0],
        expected + (1 - theta**2) * r - w1,
        H
        * ((observed_friction + (1 - theta) ** 2 * INERTIA / H * r) / INERTIA - held(H) - reference_at(H)[1]),
        H * (seen_torque(H) / INERTIA - held(H)),
    )

    state = (e, p, H * (observed_friction / INERTIA - held(0.0) - rate0), H * (torque / INERTIA - held(0.0)))
    accel = H * (rate0 - known_rate)
    wanted = generated.wanted_torque(e, state[2], state[3], RATE * H, AHEAD, accel)
    way = wanted - state[3]
    asked = RATE * H * misread[0]
    assert way + asked == pytest.approx(H / INERTIA * (target - torque), rel=1e-12)
    phi, psi, _ = generated.switched_slide(SECANT, SECANT, 1.0, H)
    rho = (seen_torque(H) - torque) / (target - torque)

    def weighted(value):
        weight = [
            quad(lambda t, f=f: f(t) * math.exp(SECANT * (H - t)), 0.0, H)[0] for f in (value, lambda _: 1.0)
        ]
        return weight[0] / weight[1]

    late = weighted(lambda t: 1.0 - (seen_torque(t) - torque) / (seen_torque(H) - torque))

    def sliding(t):
        return slip_rate * (SPEED + BRAKING * t + JERK * t * t / 2.0) / RADIUS

    moved = quad(sliding, 0.0, H)[0]
    found = generated.next_sample(
        *state,
        way,
        phi,
        psi,
        PADS * INERTIA / TRUE_INERTIA,
        rho,
        late,
        (mean - torque) / (target - torque),
        theta,
        asked,
        H * (held(H) - held(0.0)),
        H * weighted(lambda t: held(t) - held(0.0)),
        H * (reference_at(H)[1] - rate0),
        reference_at(H)[0] - w0 - H * rate0 + moved,
        moved,
        quad(lambda t: (math.exp(SECANT * (H - t)) - 1.0) * sliding(t), 0.0, H)[0],
        misread[1],
    )
    np.testing.assert_allclose(found, after, rtol=1e-7, atol=1e-10)
    assert generated.part_of_way(SHARE / FILL_TIME, H / SHARE) >= rho >= SHARE / FILL_TIME
    latest = generated.lateness(SECANT * H, pulse / H, delay)
    assert 0.0 <= late <= latest <= generated.lateness(SECANT * H, 1.0, delay)
    assert (late > generated.lateness(SECANT * H, pulse / H, 0.0)) is (delay > 0.0)
    assert rho >= (mean - torque) / (target - torque) >= rho * (1.0 - pulse / H / 2.0)
    steady = 1.0 - generated.lateness(SECANT * H, 1.0, 0.0)  # of a steady drift in its weighted mean
    assert weighted(lambda t: t / H) == pytest.approx(steady, rel=1e-9)
