"""The checker's image of a cell holds what SciPy integrates from it: at the sample, between samples, and above 0."""

import math
from dataclasses import dataclass, field
from itertools import product

import numpy as np
import pytest
from flint import ctx

from tests.certificates.invariance.loops import drawn, feedback_problem, one_sample
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.theorems.invariant_sets.ball_plant import BallPlant
from wspd_design.certificates.theorems.invariant_sets.ball_slopes import hull
from wspd_design.certificates.theorems.invariant_sets.checker import _Walk

ROUNDING = 1e-8


@dataclass
class Window:
    """A window whose set is the whole plane, and the image that the checker asked it about."""

    low: float
    high: float
    tilt: float
    per_unit: int
    steps: int
    image: list = field(default_factory=list)

    def covers(self, low, high, moved):
        self.image = [(float(each.lower()), float(each.upper())) for each in (hull(low, high), moved)]
        return True


def image(problem, window, cell):
    """Image of a cell and the slips on the way, or None if the checker refuses it."""
    with ctx.workprec(64):
        walk = _Walk(BallPlant(problem), Work())
        walk.here, walk.slower, walk.slopes = window, None, {}
        walk.speed = hull(
            walk.plant.point(window.low) - walk.plant.loss(window.high), walk.plant.point(window.high)
        )
        if not walk.stays((cell[0], cell[0] + 1, cell[1], cell[1] + 1), sharp=True):
            return None
        return (*window.image, (walk.low, walk.high))


def cell_of(problem, window, slip, share):
    """Cell that holds a slip and a torque over T_max."""
    level = share + window.tilt * (slip - problem.slip)
    return math.floor(slip * window.per_unit), math.floor(level * window.per_unit)


def states(problem, window, cell, rng, count):
    """Corners of a cell and points inside it, as slip and torque, where the torque is one that the brake has."""
    corners = [*product((0.0, 1.0), repeat=2)]
    for place in [*corners, *rng.random((count, 2))]:
        slip, level = ((each + part) / window.per_unit for each, part in zip(cell, place, strict=True))
        share = level - window.tilt * (slip - problem.slip)
        if 0.0 <= share <= 1.0:
            yield slip, share * problem.vehicle.brake.max_torque


def check_cell(problem, window, cell, rng, count=3):
    """Compare an image with runs; return its width at the end and how near the runs came to its highest slip."""
    found = image(problem, window, cell)
    if found is None:
        return None
    (low, high), (least, most), (bottom, top) = found
    nearest, tried = math.inf, 0
    for slip, torque in states(problem, window, cell, rng, count):
        speed = rng.choice([window.low, window.high])
        after, moved, _, lowest, highest = one_sample(problem, drawn(problem, rng), slip, torque, speed)
        level = moved / problem.vehicle.brake.max_torque + window.tilt * (after - problem.slip)
        assert low - ROUNDING <= after <= high + ROUNDING
        assert least - ROUNDING <= level <= most + ROUNDING
        assert bottom - ROUNDING <= lowest
        assert highest <= top + ROUNDING
        assert lowest >= -ROUNDING
        nearest, tried = min(nearest, top - highest), tried + 1
    assert tried
    return high - low, nearest


@pytest.mark.parametrize("steps", [1, 2, 5])
def test_random_cells(steps):
    rng = np.random.default_rng(10 + steps)
    problem = feedback_problem(spread=0.03)
    seen = 0
    for _ in range(12):
        low = rng.choice([3.0, 9.0, 24.0])
        window = Window(low=low, high=1.02 * low, tilt=rng.choice([0.0, 0.8, 2.5]), per_unit=512, steps=steps)
        cell = cell_of(problem, window, rng.uniform(0.06, 0.4), rng.uniform(0.05, 0.95))
        seen += check_cell(problem, window, cell, rng) is not None
    assert seen >= 8


def test_the_slip_while_the_brake_fills():
    """Thin cells, filled for a part of the sample: the torque is largest when filling ends, not when a step starts."""
    rng = np.random.default_rng(3)
    problem = feedback_problem(spread=0.0)
    slacks = []
    for speed, slip, share in product((12.0, 24.0), (0.12, 0.15), (0.40, 0.44)):
        window = Window(low=speed, high=speed + 1e-6, tilt=0.0, per_unit=1 << 18, steps=1)
        found = check_cell(problem, window, cell_of(problem, window, slip, share), rng)
        slacks += [] if found is None else [found[1]]
    assert len(slacks) == 8
    assert max(slacks) < 5e-4  # an image of the whole plane would pass all of the above


def test_a_slip_below_zero_is_outside_the_model():
    """A wheel that rolls freely lags behind a train that slows down: its slip falls below 0, which is refused."""
    rng = np.random.default_rng(5)
    problem = feedback_problem(spread=0.0, sliding_gain=-50.0)  # vents below the reference
    window = Window(low=24.0, high=24.5, tilt=0.0, per_unit=4096, steps=4)
    lowest = min(
        one_sample(problem, drawn(problem, rng), slip, torque, 24.0)[3]
        for slip, torque in states(problem, window, (0, 0), rng, 4)
    )
    assert lowest < 0.0
    assert image(problem, window, (0, 0)) is None
    above = cell_of(problem, window, 0.1, 0.5)
    assert image(problem, window, above) is not None
