"""All eigenfrequencies of the locomotive at rest on springs, by independent methods (V2)."""

import numpy as np
import pytest
from exudyn_multibody import eigenfrequencies
from independent_multibody import GroundSprings, SmallVibrations

from wspd_design.analysis.modes import undamped_frequencies
from wspd_design.plants.multibody.loading import load_multibody

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
