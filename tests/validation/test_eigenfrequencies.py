"""All eigenfrequencies of the locomotive at rest on springs, by independent methods (V2)."""

import casadi as ca
import numpy as np
import pytest
from exudyn_multibody import eigenfrequencies
from independent_multibody import GroundSprings, SmallVibrations

from wspd_design.analysis.modes import undamped_frequencies
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.preloads import balanced

GROUND = GroundSprings(along=(1e7, 1e7, 1e7), turn=1e6)
TOLERANCE = 1e-6


@pytest.fixture(scope="module")
def model():
    return load_multibody("er24pc-82")


@pytest.fixture(scope="module")
def vibrations(model):
    return SmallVibrations(model, GROUND)


@pytest.fixture(scope="module")
def frequencies(vibrations):
    return undamped_frequencies(vibrations.mass(), vibrations.stiffness())


def test_the_weight_is_carried(vibrations):
    assert vibrations.residual < 1e-8
    wheels = [load for name, load in vibrations.preloads.items() if name.startswith("wheelset")]
    assert sum(wheels) == pytest.approx(76841.0 * 9.81, rel=1e-12)
    assert wheels[:2] == pytest.approx([95.20e3, 93.26e3], rel=1e-4)


def on_springs(model):
    """Mass and stiffness of the equations of motion of the package, with the springs in the place of the contact."""
    n, held = len(model.coordinates), balanced(model)
    q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
    equations = mechanics(held, q, v)
    force = equations.force
    for name in held.wheelset_names:
        first = held.coordinates.index(f"{name}.x")
        x, y, z, roll, pitch, yaw = ca.vertsplit(q[first : first + 6])
        for side, sign in (("left", 1.0), ("right", -1.0)):
            half = sign * held.numbers["wheel_half_spacing"]
            moved = ca.vertcat(
                x - half * ca.cos(roll) * ca.sin(yaw),
                y + half * (ca.cos(roll) * ca.cos(yaw) - 1.0),
                z + half * ca.sin(roll),
            )
            pushed = ca.vertcat(0.0, 0.0, held.preloads[f"{name}.{side}"]) - ca.diag(GROUND.along) @ moved
            force += ca.jacobian(moved, q).T @ pushed
        force[first + 4] -= GROUND.turn * pitch
    matrices = ca.Function("m", [q, v], [equations.mass_matrix, -ca.jacobian(force, q)])(0, 0)
    return [np.array(each) for each in matrices]


def test_82_eigenfrequencies_of_the_equations_of_motion(model, vibrations, frequencies):
    """Energies of exact rotations, differentiated, against screws and direct stiffness."""
    mass, stiffness = on_springs(model)
    assert mass == pytest.approx(vibrations.mass(), abs=1e-9)
    assert stiffness == pytest.approx(vibrations.stiffness(), abs=1e-9 * np.abs(stiffness).max())
    ours = undamped_frequencies(mass, stiffness)
    assert len(ours) == 82
    assert np.abs(ours / frequencies - 1.0).max() < TOLERANCE


def test_a_number_that_is_wrong_by_a_thousandth_is_seen(model, frequencies):
    wrong = model.with_numbers({"drive.ratio": 1.001 * model.numbers["drive.ratio"]})
    assert np.abs(undamped_frequencies(*on_springs(wrong)) / frequencies - 1.0).max() > TOLERANCE


def test_82_eigenfrequencies_by_exudyn(model, vibrations, frequencies):
    pytest.importorskip("exudyn", reason="exudyn is missing; install wspd-design[verify]")
    theirs = eigenfrequencies(model, vibrations)
    assert len(theirs) == 82
    assert np.abs(theirs / frequencies - 1.0).max() < TOLERANCE


def test_a_preload_that_is_missing_is_seen(vibrations, frequencies):
    without = SmallVibrations(vibrations.model, GROUND)
    without.preloads = vibrations.preloads | {"secondary_1_left": 0.0}
    wrong = undamped_frequencies(without.mass(), without.stiffness())
    assert np.abs(wrong / frequencies - 1.0).max() > 100.0 * TOLERANCE
