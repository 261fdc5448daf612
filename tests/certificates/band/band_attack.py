"""Runs that attack a proved band of slip: starts on the boundary of its ellipsoids, and stops from rolling wheels.

Plant and protection are those of :mod:`tests.certificates.band.sampled_runs`; of the package comes only the proof that
is attacked, with the numbers of the law::

    python -m tests.certificates.band.band_attack DESIGN CERTIFICATE --starts 100000 --stops 10000

Of the stops from rolling half are drawn; from the worst of them differential evolution looks for the largest slip on
the way into the ellipsoid, and for the largest share of the band that is used afterwards.
"""

import argparse
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.certificates.band.sampled_runs import (
    BESIDE,
    BOX,
    Disturbance,
    Law,
    Memory,
    Runs,
    motion,
    plant_of,
    rolling,
    sampled,
    supplied,
)
from wspd_design.certificates.theorems.band import CELLS
from wspd_design.certificates.theorems.slip_band.proof import read
from wspd_design.certificates.theorems.slip_band.statement import LETTERS, box_of, halved, windows_of
from wspd_design.design.certification import check, problem_of

ROUNDING = 1e-12  # relative, by which a number that was drawn at the end of a range may lie outside
CHUNK = 5000  # runs at once
SETTLED = 50  # samples that starts on the boundary are followed
LONGEST = 200.0  # s, that a stop is followed
GENERATIONS, FEWEST = 10, 5  # of the evolution of the worst stops, and stops in each at least
SLOWEST_START = 2.0  # times the lowest speed, from which stops may begin


@dataclass(frozen=True)
class Sets:
    """What was proved: windows, cells, ellipsoids and bands, as arrays."""

    speeds: Any  # (windows,) upper ends, the slowest first [m/s]
    lowest: float  # m/s
    cells: Any  # (cells, numbers, 2)
    matrices: Any  # (cells, windows, 5, 5)
    centers: Any  # (cells, windows, 5)
    moves: Any  # (cells, windows, 5), of the centers with the steady drift
    drifts: Any  # (cells, windows), steady drift that the centers are for [rad/s]
    settled: Any  # (cells, windows), error that errors are counted from [rad/s]
    supplies: Any  # (cells, windows), least share of the full pressure [-]
    bands: Any  # (windows, 2): below and above the reference [-]

    def window(self, speed):
        """Number of the window of each speed."""
        return np.minimum(np.searchsorted(self.speeds, speed), len(self.speeds) - 1)

    def cell(self, plant):
        """Number of the cell that each plant lies in."""
        numbers = np.array([getattr(plant, name) for name in BOX.values()])
        low, high = (1.0 - ROUNDING) * self.cells[:, :, :1], (1.0 + ROUNDING) * self.cells[:, :, 1:]
        inside = np.all((numbers >= low) & (numbers <= high), axis=1)
        assert np.all(np.any(inside, axis=0)), "a plant lies in no cell"
        return np.argmax(inside, axis=0)


def sets_of(problem, proof, numbers):
    """Read a proof and the numbers that its checker tells."""
    windows = windows_of(problem)
    found = read(proof, len(windows))
    waiting, cells = [box_of(problem, found.share)], []
    for step in found.steps:
        cell = waiting.pop()
        if step in LETTERS:
            waiting += halved(cell, step)[::-1]
        else:
            cells.append(cell)
    return Sets(
        speeds=np.array([high for _, high in windows]),
        lowest=problem.speeds[0],
        cells=np.array(cells, dtype=float),
        matrices=np.linalg.inv(
            np.array([[each.matrix for each in cell] for cell in found.cells], dtype=float)
        ),
        centers=np.array([[each.center for each in cell] for cell in found.cells], dtype=float),
        moves=np.array([[each.moves for each in cell] for cell in found.cells], dtype=float),
        drifts=np.array([[each.drift for each in cell] for cell in found.cells], dtype=float),
        settled=np.array([[each.settled for each in cell] for cell in found.cells], dtype=float),
        supplies=np.array([[each.supply for each in cell] for cell in found.cells], dtype=float),
        bands=np.array(
            [[numbers[f"band {k} {side}"] for side in ("below", "above")] for k in range(len(windows))]
        ),
    )


def box(problem, sets):
    """Ranges of all numbers that differ between the runs."""
    covered = np.stack([sets.cells[:, :, 0].min(axis=0), sets.cells[:, :, 1].max(axis=0)], axis=1)
    return dict(zip(BOX, covered, strict=True)) | {name: problem.span(name) for name in BESIDE}


def deviations(law, runs, settled):
    """State of the theorem [rad/s]: errors of wheel speed, observer, friction, torque and filtered acceleration."""
    plant, h = runs.plant, law.h
    there = (1.0 - law.slip) * runs.speed / plant.wheel_radius + settled
    held, rate = holds(law, plant, runs.speed, runs.wheel, there)
    friction = h * (runs.memory.friction / law.inertia - held - rate)
    seen = runs.torque * law.full / plant.max_torque
    known = (1.0 - law.slip) / law.radius * runs.memory.unspoiled
    return np.array(
        [
            runs.wheel - there,
            runs.memory.observed - runs.wheel,
            friction,
            h * (seen / law.inertia - held),
            h * (rate - known),
        ]
    )


def holds(law, plant, speed, wheel, there):
    """Torque that keeps a wheel beside the reference over the inertia, as the law counts it; rate of the reference.

    The train slows down as the slip of its wheels makes it.
    """
    slowing = -motion(plant, speed, wheel, 0.0)[0]
    rate = -(1.0 - law.slip) / plant.wheel_radius * slowing
    torque = plant.wheelset_inertia * (motion(plant, speed, there, 0.0)[1] - rate)
    return torque * law.full / plant.max_torque / law.inertia, rate


def drift(law, plant, speed, wheel, settled):
    """Steady drift over a sample of the torque that holds a wheel beside the reference, but for what turns it.

    By differences over the train speed, which falls as the slip of the wheels makes it.
    """

    def holding(v):
        there = (1.0 - law.slip) * v / plant.wheel_radius + settled
        torque = plant.wheelset_inertia * motion(plant, v, there, 0.0)[1]
        return torque * law.full / plant.max_torque / law.inertia

    d = 1e-4 * speed
    change = (holding(speed + d) - holding(speed - d)) / (2.0 * d)
    return law.h**2 * change * motion(plant, speed, wheel, 0.0)[0]


def centers(law, sets, at, runs, settled):
    """Centers of the ellipsoids of some cells and windows, for the drift that runs have there."""
    away = drift(law, runs.plant, runs.speed, runs.wheel, settled) - sets.drifts[at]
    return sets.centers[at].T + sets.moves[at].T * away


@dataclass
class Seen:
    """What runs have done."""

    entered: Any  # whether the state has been in its ellipsoid, and the supply has been what that asks for
    left: Any  # whether state or slip have left it, or the band, afterwards
    way_in: Any  # largest slip before
    used: Any  # (windows, 2): largest deviation below and above the reference afterwards, over all runs [-]
    share: Any  # largest of them over the band, for each run


def follow(law, sets, runs, *, samples, disturbance=None, seed=3):
    """Follow runs down to the lowest speed, or for a number of samples."""
    count, random = len(runs.speed), np.random.default_rng(seed)
    disturbance = disturbance or Disturbance()
    seen = Seen(
        entered=np.zeros(count, bool),
        left=np.zeros(count, bool),
        way_in=np.zeros(count),
        used=np.zeros_like(sets.bands),
        share=np.zeros(count),
    )
    cells, bound = sets.cell(runs.plant), np.zeros(count, bool)
    for _ in range(samples):
        runs = runs.some(runs.speed > sets.lowest)
        if not len(runs.speed):
            break
        now, window = runs.number, sets.window(runs.speed)
        settled = sets.settled[cells[now], window]
        apart = deviations(law, runs, settled) - centers(law, sets, (cells[now], window), runs, settled)
        size = np.einsum("ik,kij,jk->k", apart, sets.matrices[cells[now], window], apart)
        inside = size <= 1.0 + 1e-9
        # As long as the supply is below what a slower window asks for, nothing is claimed.
        enough = supplied(runs) >= sets.supplies[cells[now], window] - 1e-9
        seen.left[now] |= bound[now] & enough & ~inside
        bound[now] = enough & (bound[now] | inside)
        seen.entered[now] |= bound[now]
        runs, lowest, highest = sampled(law, runs, disturbance.draw(random, len(runs.speed)))
        entered = bound[now]
        seen.way_in[now] = np.where(
            seen.entered[now], seen.way_in[now], np.maximum(seen.way_in[now], highest)
        )
        strayed = np.where(entered, np.array([law.slip - lowest, highest - law.slip]), 0.0)
        for side in range(2):
            np.maximum.at(seen.used[:, side], window, strayed[side])
        # A side of the band may be 0: what is not there yet has no share, and must not be lost as 0/0.
        share = np.where(entered, np.max(strayed.T / sets.bands[window], axis=1), 0.0)
        seen.share[now] = np.maximum(seen.share[now], share)
    seen.left |= seen.share > 1.0
    return seen


def boundary(problem, law, sets, random, count, larger=1.0):
    """Starts on the boundary of the ellipsoids, half of the numbers at their ends; ``larger`` starts outside."""
    ends = box(problem, sets)
    even = random.random((len(ends), count))
    unit = np.where(random.random(even.shape) < 0.5, np.round(even), random.random(even.shape))
    points = {name: low + (high - low) * u for (name, (low, high)), u in zip(ends.items(), unit, strict=True)}
    plant = plant_of(problem, points)
    window, cell = random.integers(0, len(sets.speeds), count), sets.cell(plant)
    edges = np.concatenate([[sets.lowest], sets.speeds])
    speed = edges[window] + (edges[window + 1] - edges[window]) * random.random(count)
    direction = random.normal(size=(count, 5))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    roots = np.linalg.cholesky(np.linalg.inv(sets.matrices[cell, window]))
    settled = sets.settled[cell, window]
    there = (1.0 - law.slip) * speed / plant.wheel_radius + settled
    # The drift goes by how the train slows down, which the error of the wheels changes a little.
    away, error = larger * np.einsum("kij,kj->ik", roots, direction), 0.0 * speed
    for _ in range(5):
        drifted = drift(law, plant, speed, there + error, settled) - sets.drifts[cell, window]
        e, p, n, y, lag = sets.centers[cell, window].T + sets.moves[cell, window].T * drifted + away
        error = e
    wheel = there + e
    held, rate = holds(law, plant, speed, wheel, there)
    scale = law.radius / plant.wheel_radius
    acceleration = (rate - lag / law.h) * law.radius / (1.0 - law.slip)
    memory = Memory(
        scale=scale,
        told=scale * speed,
        acceleration=acceleration,
        observed=wheel + p,
        friction=law.inertia * (n / law.h + held + rate),
        exact=scale * speed,
        unspoiled=acceleration,
    )
    torque = law.inertia * (y / law.h + held) * plant.max_torque / law.full
    return Runs(
        plant=plant,
        memory=memory,
        since=-np.log1p(-sets.supplies[cell, window]) / plant.supply_rate,
        measured=wheel,
        speed=speed,
        wheel=wheel,
        torque=torque,
        number=np.arange(count),
    )


@np.errstate(all="ignore")  # wheels that lock, and pulses from nothing
def attack_boundary(problem, sets, *, starts, seed=7, larger=1.0, samples=SETTLED, disturbance=None):
    """Follow starts on the boundary with as little supply as is asked for, and tell how they went."""
    law, random = Law(problem.controller, problem.slip), np.random.default_rng(seed)
    found = []
    for begin in range(0, starts, CHUNK):
        runs = boundary(problem, law, sets, random, min(CHUNK, starts - begin), larger)
        found.append(follow(law, sets, runs, samples=samples, disturbance=disturbance))
    return joined(found)


@np.errstate(all="ignore")
def attack_stops(problem, sets, *, stops, seed=7):
    """Look for the worst stops from rolling, and tell how all of them went.

    Half of the runs are drawn, with half of the numbers at their ends; a quarter goes to the evolution of the worst of
    them for each aim.
    """
    from scipy.optimize import differential_evolution

    law, random, found = Law(problem.controller, problem.slip), np.random.default_rng(seed), []
    ends = box(problem, sets) | {"speed": (SLOWEST_START * problem.speeds[0], problem.speeds[1])}
    low, high = (np.array([each[side] for each in ends.values()])[:, None] for side in (0, 1))

    def followed(unit):
        points = dict(zip(ends, low + (high - low) * unit, strict=True))
        found.append(follow(law, sets, rolling(problem, law, points), samples=int(LONGEST / law.h)))
        return found[-1]

    even = random.random((len(ends), stops // 2))
    drawn = np.where(random.random(even.shape) < 0.5, np.round(even), random.random(even.shape))
    seen = joined([followed(drawn[:, k : k + CHUNK]) for k in range(0, drawn.shape[1], CHUNK)])
    worst = {}
    for aim, name in (("largest slip on the way", "way_in"), ("largest share of the band", "share")):
        best = np.argsort(-getattr(seen, name))[: max(stops // (4 * GENERATIONS), FEWEST)]
        evolved = differential_evolution(
            lambda unit, name=name: -getattr(followed(unit), name),
            [(0.0, 1.0)] * len(ends),
            vectorized=True,
            updating="deferred",
            maxiter=GENERATIONS - 1,
            tol=0.0,
            polish=False,
            init=drawn[:, best].T,
            rng=np.random.default_rng(seed),
        )
        point = low[:, 0] + (high - low)[:, 0] * evolved.x
        worst[aim] = -evolved.fun, dict(zip(ends, point, strict=True))
    return joined(found), worst


def joined(found):
    """What all runs have done."""
    arrays = {
        n: np.concatenate([getattr(f, n) for f in found]) for n in ("entered", "left", "way_in", "share")
    }
    return Seen(**arrays, used=np.max([each.used for each in found], axis=0))


def told(seen, sets):
    """Say what runs have done, window by window."""
    lines = [f"{len(seen.left)} runs, {seen.entered.sum()} entered, {seen.left.sum()} left what was proved"]
    for k, (band, used) in enumerate(zip(sets.bands, seen.used, strict=True)):
        low = sets.lowest if k == 0 else sets.speeds[k - 1]
        wider = band.sum() / max(used.sum(), 1e-12)
        lines.append(
            f"  {low * 3.6:5.1f} to {sets.speeds[k] * 3.6:5.1f} km/h: proved -{band[0]:.4f} +{band[1]:.4f}, "
            f"seen -{used[0]:.4f} +{used[1]:.4f}, width over that of the worst runs {wider:.2f}"
        )
    return "\n".join(lines)


def main(arguments):
    """Attack the certificate of a design; 1 if a run left what was proved."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.certificates.band.band_attack", description=__doc__
    )
    parser.add_argument("design", type=Path)
    parser.add_argument("certificate", type=Path)
    parser.add_argument("--starts", type=int, default=100_000, help="on the boundary of the ellipsoids")
    parser.add_argument("--stops", type=int, default=10_000, help="from rolling wheels")
    given = parser.parse_args(arguments)
    replayed = check(given.certificate, given.design)
    if replayed.certificate is None:
        parser.error(f"{given.certificate} is refused: {replayed.reason}")
    finding, problem = replayed.certificate.findings[CELLS], problem_of(given.design)
    if finding.stated is None or finding.stated.proof is None:
        parser.error(f"{given.certificate} proves no band")
    sets = sets_of(problem, finding.stated.proof, finding.numbers)
    begun = time.process_time()
    starts = attack_boundary(problem, sets, starts=given.starts)
    print(f"Starts on the boundary: {told(starts, sets)}")
    stops, worst = attack_stops(problem, sets, stops=given.stops)
    print(f"Stops from rolling: {told(stops, sets)}")
    for aim, (value, point) in worst.items():
        print(f"{aim}: {value:.4g} at {', '.join(f'{name} {number:.4g}' for name, number in point.items())}")
    print(f"{time.process_time() - begun:.0f} s of CPU")
    return int(starts.left.any() or stops.left.any())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
