"""The enclosure of the one-sample map against an integration by SciPy, and faults that this comparison must see."""

from dataclasses import replace

import ival
import numpy as np
import pytest

from tests.certificates.invariance.loops import drawn, feedback_problem, one_sample
from wspd_design.certificates.search.invariant_sets import one_sample as module
from wspd_design.certificates.search.invariant_sets.duals import mean_value
from wspd_design.certificates.search.invariant_sets.one_sample import Window, images, slip_rate, torque_path
from wspd_design.model.number import atan, clip, exp
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import EXACT

WINDOWS = [(Window(low=2.8, high=2.94, tilt=0.25), 5), (Window(low=9.0, high=9.45, tilt=0.8), 2)]
WINDOWS += [(Window(low=30.0, high=31.5, tilt=2.5), 1)]
ROUNDING = 1e-9


def escapes(problem, window, steps, *, count=40, size=1.0 / 128, mapped=None):
    """Count trajectories from cells that are not where the enclosure of their cell says."""
    rng = np.random.default_rng(4)
    corners = np.stack([rng.uniform(0.05, 0.35, count), rng.uniform(0.3, 0.6, count)])
    slip, level = (ival.Interval(low, low + size) for low in corners)
    image = images(mapped or problem, window, slip, level, steps=steps)
    found, tried, known = 0, 0, 0
    for k in range(count):
        s, z = corners[:, k] + size * rng.choice([0.0, 0.5, 1.0], 2)
        v = rng.choice([window.low, window.high, rng.uniform(window.low, window.high)])
        full = problem.vehicle.brake.max_torque
        torque = min(max(full * (z - window.tilt * (s - problem.slip)), 0.0), full)
        z = torque / full + window.tilt * (s - problem.slip)
        if not level.inf[k] <= z <= level.sup[k]:
            continue  # clipped out of its cell
        tried += 1
        known += bool(np.isfinite(image.slip_high[k]))
        after, torque, _, low, high = one_sample(problem, drawn(problem, rng), s, torque, v)
        reached = torque / full + window.tilt * (after - problem.slip)
        found += not (
            image.slip_low[k] - ROUNDING <= after <= image.slip_high[k] + ROUNDING
            and image.level_low[k] - ROUNDING <= reached <= image.level_high[k] + ROUNDING
            and image.between_low[k] - ROUNDING <= low
            and high <= image.between_high[k] + ROUNDING
        )
    assert tried > 0.7 * count
    assert known > 0.7 * tried
    return found


@pytest.mark.parametrize(("window", "steps"), WINDOWS)
def test_trajectories_stay_in_the_enclosure(window, steps):
    assert escapes(feedback_problem(spread=0.05), window, steps) == 0


@pytest.mark.parametrize("rail", ["polach-dry", "eurosprinter127", "table10-wet"])
def test_on_other_rails(rail):
    window, steps = WINDOWS[1]
    assert escapes(feedback_problem(spread=0.1, rail=rail), window, steps, count=25) == 0


def test_enclosures_are_not_idle():
    """An enclosure of the whole plane would pass all of the above."""
    window, steps = WINDOWS[1]
    thin = ival.Interval(np.array([0.14]), np.array([0.14]))
    level = ival.Interval(np.array([0.45]), np.array([0.45]))
    image = images(feedback_problem(spread=0.0), window, thin, level, steps=steps)
    assert image.slip_high - image.slip_low < 0.003
    assert image.level_high - image.level_low < 0.015


def test_planted_faults_are_seen(monkeypatch):
    window, steps = WINDOWS[1]
    problem = feedback_problem(spread=0.0)
    brake = problem.vehicle.brake

    def seen(mapped=None):
        return escapes(problem, window, steps, size=1.0 / 1024, mapped=mapped)

    assert seen() == 0
    quick = replace(brake, fill_time=0.1 * brake.fill_time, vent_time=0.1 * brake.vent_time)
    assert seen(replace(problem, vehicle=replace(problem.vehicle, brake=quick))) > 0  # lag left out
    assert seen(replace(problem, bounds=problem.bounds | {"mu0": (0.33, 0.33)})) > 0  # another rail
    assert seen(replace(problem, sample_time=0.5 * problem.sample_time)) > 0  # half a sample
    right = module.slip_rate
    with monkeypatch.context() as patch:
        patch.setattr(module, "slip_rate", lambda p, s, v, t: right(p, s, v, -t))
        assert seen() > 0  # wrong sign of G
    with monkeypatch.context() as patch:
        patch.setattr(module, "slip_rate", lambda p, s, v, t: right(p, s, v.sup, t))
        assert seen() > 0  # top speed only
    with monkeypatch.context() as patch:
        patch.setattr(
            module, "mean_value", lambda f, x: f(*(ival.Interval(*2 * [(e.inf + e.sup) / 2]) for e in x))
        )
        assert seen() > 0  # the law at the center of the cell only


def test_rate_is_that_of_the_kernels():
    problem = feedback_problem(spread=0.1)
    rng = np.random.default_rng(1)
    for _ in range(200):
        vehicle, rail = drawn(problem, rng)
        slip, speed, torque = rng.uniform(0.02, 0.6), rng.uniform(2.0, 34.0), rng.uniform(0.0, 6e4)
        at = slip_dynamics(vehicle, rail, slip, speed)
        exact = at.drift + at.gain * torque
        wide = slip_rate(problem, *(ival.Interval(x, x) for x in (slip, speed, torque)))
        assert wide.inf <= exact <= wide.sup
        fixed = replace(problem, vehicle=vehicle, rail=rail, bounds=EXACT)
        thin = slip_rate(fixed, *(ival.Interval(x, x) for x in (slip, speed, torque)))
        damping = vehicle.wheel_damping / vehicle.wheel_inertia
        assert thin.inf - 1e-12 <= exact <= thin.sup + 1e-12
        assert thin.sup - thin.inf < damping + 1e-9


def test_torque_path_encloses_all_paths():
    """Filling, then venting, then holding, integrated in ten thousand steps."""
    brake = feedback_problem().vehicle.brake
    sample, steps = 0.1, 10_000
    rng = np.random.default_rng(2)
    for _ in range(20):
        start, fill = rng.uniform(0.0, brake.max_torque), rng.uniform(0.0, 0.7)
        vent = rng.uniform(0.0, 1.0 - fill)
        begin, end = np.sort(rng.integers(0, steps + 1, 2))
        torque, path = start, [start]
        for k in range(steps):
            share = (k + 0.5) / steps
            rate = 0.0
            if share < fill:
                rate = (brake.max_torque - torque) / brake.fill_time
            elif share < fill + vent:
                rate = -torque / brake.vent_time
            torque += rate * sample / steps
            path.append(torque)
        part = ival.Interval(begin / steps, end / steps)
        found = torque_path(brake, sample, *(np.array([x]) for x in (start, fill, vent)), part)
        assert found.inf[0] - 5.0 <= min(path[begin : end + 1])
        assert max(path[begin : end + 1]) <= found.sup[0] + 5.0
        assert found.sup[0] - found.inf[0] <= np.ptp(path[begin : end + 1]) + 10.0


def test_mean_value_form_encloses_and_forgets_nothing():
    def function(x, y):
        return (clip(exp(-x) * y / (1.0 + x**2) - atan(y - x), -0.5, 0.6), abs(x - y), (x * y - x * 2.0) / x)

    rng = np.random.default_rng(3)
    low = rng.uniform(0.1, 2.0, (2, 300))
    width = rng.uniform(0.0, 0.2, (2, 300))
    boxes = tuple(ival.Interval(a, a + w) for a, w in zip(low, width, strict=True))
    enclosures = mean_value(function, boxes)
    for share in (0.0, 0.3, 1.0):
        points = low + width * np.array([[share], [1.0 - share]])
        for k in range(300):
            for value, box in zip(function(*map(float, points[:, k])), enclosures, strict=True):
                assert box.inf[k] - 1e-14 <= value <= box.sup[k] + 1e-14
    # x cancels: what is left is as wide as y, up to the square of the widths.
    far = low[0] > 0.8
    excess = enclosures[2].sup - enclosures[2].inf - width[1]
    assert np.all(excess[far] <= 12.0 * width[0, far] * (width[0, far] + width[1, far]))
