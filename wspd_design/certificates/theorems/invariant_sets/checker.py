"""Independent check of sets that are said to stay: nothing is taken from the search but the sets.

Balls of python-flint in place of intervals, formulas of its own for the motion, cells in blocks that are split
where a block is too coarse. The claim comes from the problem: the law's ``step``, the box of parameters, the range
of speed. What it has in common with the search is the reasoning of ``one_sample.py``.
"""

import math
from collections.abc import Mapping
from functools import reduce
from itertools import pairwise
from typing import Any

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.invariant_sets.ball_plant import BallPlant
from wspd_design.certificates.theorems.invariant_sets.ball_slopes import Ball, hull, law_slopes
from wspd_design.certificates.theorems.invariant_sets.runs import CellRuns, read
from wspd_design.controllers.protocol import Measurement

WORK_OF_AN_IMAGE, WORK_OF_A_STEP = 250, 20  # operations on intervals
BLOCK = 16  # cells along the edge of the blocks that are tried first
GROUP = 4  # cells along the edge of the groups that share slopes of the law
PIECES = 4  # of the range of slip where the rate has to be sharp


def decide(problem: Problem, document: Mapping[str, Any], work: Work) -> dict[str, float]:
    """Decide whether the sets in a document are invariant for the closed loop of a problem.

    Parameters
    ----------
    problem : Problem
        What the claim speaks about; its law must remember nothing.
    document : mapping
        From JSON; it may be anything.
    work : Work
        What may still be spent.

    Returns
    -------
    dict
        ``lowest slip`` and ``highest slip`` at and between samples, number of ``windows`` and of mapped ``blocks``.

    Raises
    ------
    Refused
        If it is not shown.
    """
    from flint import ctx

    try:
        with ctx.workprec(64):
            sets = read(problem, document)
            if problem.wheelset_law.start(Measurement(problem.speeds[1], 0.0, 0.0)) != ():
                raise Refused("the law has a memory, which the sets leave out")
            walk = _Walk(BallPlant(problem), work)
            _cover(problem, walk.plant, sets)
            for here, slower in zip(sets, [*sets[1:], None], strict=True):
                walk.window(here, slower)
    except (TypeError, ValueError, ArithmeticError) as error:  # of the law, on balls
        raise (
            error if isinstance(error, Refused) else Refused(f"the map cannot be enclosed: {error}")
        ) from None
    return {
        "lowest slip": walk.low,
        "highest slip": walk.high,
        "windows": float(len(sets)),
        "blocks": float(walk.images),
    }


def _cover(problem: Problem, plant: BallPlant, sets: list[CellRuns]) -> None:
    """Refuse windows that leave a speed out, or that a sample can jump over; fastest first."""
    lowest, highest = problem.speeds
    if sets[0].high < highest or sets[-1].low > lowest or sets[-1].low <= 0.0:
        raise Refused("the windows do not cover the range of speed")
    for faster, slower in pairwise(sets):
        if slower.high < faster.low:
            raise Refused("a gap between two windows")
        if not plant.point(faster.low) - plant.loss(faster.high) >= plant.point(slower.low):
            raise Refused("a sample can jump over a window")


class _Walk:
    """Goes through the cells of all windows."""

    def __init__(self, plant: BallPlant, work: Work) -> None:
        self.plant, self.work, self.images = plant, work, 0
        self.low, self.high = 1.0, 0.0

    def window(self, here: CellRuns, slower: CellRuns | None) -> None:
        """Refuse if a cell of this window has an image outside its set, or outside that of the slower one."""
        plant, n = self.plant, here.per_unit
        reference = math.floor(plant.problem.slip * n)
        sample_end = plant.point(here.low) - plant.loss(here.high)
        self.here, self.slower = here, slower
        self.slopes: dict[tuple[int, int, int, int], list[tuple[Ball, list[Ball]]]] = {}
        self.speed = hull(sample_end, plant.point(here.high))
        if not plant.resistance(self.speed) >= 0:
            raise Refused("the train may gain speed, into a window that is not looked at")
        if not sample_end > 0 or not any(
            self.shares((reference, reference + 1, j, j + 1))
            for a, b in here.columns.get(reference, ())
            for j in range(a, b)
        ):
            raise Refused("a window holds no state at the reference slip")
        blocks = {
            (i // BLOCK, j // BLOCK)
            for i, runs in here.columns.items()
            for a, b in runs
            for j in range(a - a % BLOCK, b, BLOCK)
        }
        for i, j in sorted(blocks):
            self.block((i * BLOCK, (i + 1) * BLOCK, j * BLOCK, (j + 1) * BLOCK))

    def block(self, cells: tuple[int, int, int, int]) -> None:
        """Check a rectangle of cells at once, or its halves."""
        i0, i1, j0, j1 = cells
        present = [
            (i, max(a, j0), min(b, j1))
            for i in range(i0, i1)
            for a, b in self.here.columns.get(i, ())
            if a < j1 and b > j0
        ]
        if not present:
            return
        i0, i1 = present[0][0], present[-1][0] + 1  # no more than what is in the set
        j0, j1 = min(a for _, a, _ in present), max(b for _, _, b in present)
        cells = i0, i1, j0, j1
        single = i1 - i0 == j1 - j0 == 1
        if self.stays(cells) or (single and self.stays(cells, sharp=True)):
            return
        if single:
            raise Refused(
                f"slip {i0 / self.here.per_unit:.4f} at {self.here.low * 3.6:.1f} to {self.here.high * 3.6:.1f} km/h "
                "may leave its set"
            )
        middle = (i0 + i1) // 2, (j0 + j1) // 2
        if i1 - i0 >= j1 - j0:
            self.block((i0, middle[0], j0, j1))
            self.block((middle[0], i1, j0, j1))
        else:
            self.block((i0, i1, j0, middle[1]))
            self.block((i0, i1, middle[1], j1))

    def shares(self, cells: tuple[int, int, int, int]) -> tuple[Ball, Ball] | None:
        """Smallest and largest torque over T_max that a rectangle of cells can have, or none."""
        point, n, tilt = self.plant.point, self.here.per_unit, self.here.tilt
        slip = hull(point(cells[0]) / n, point(cells[1]) / n)
        share = hull(point(cells[2]) / n, point(cells[3]) / n) - tilt * (slip - self.plant.reference)
        low, high = share.lower(), share.upper()
        return None if high < 0 or low > 1 else (low.max(point(0)), high.min(point(1)))

    def stays(self, cells: tuple[int, int, int, int], *, sharp: bool = False) -> bool:
        """Whether the image of a rectangle of cells lies in the set, and in that of the slower window.

        To save time, the slopes of the law are worked out for groups of cells and the rate of the slip for its
        whole range at once, unless the answer is to be ``sharp``.
        """
        shares = self.shares(cells)
        if shares is None:
            return True
        self.images += 1
        self.work.spend(WORK_OF_AN_IMAGE + self.here.steps * WORK_OF_A_STEP)
        plant, here, steps = self.plant, self.here, self.here.steps
        point, n = plant.point, here.per_unit
        low, high = point(cells[0]) / n, point(cells[1]) / n
        slips, level = hull(low, high), hull(point(cells[2]) / n, point(cells[3]) / n)
        fill, vent = self.commands(cells, (slips, level), sharp)
        least = plant.full * shares[0], fill.lower(), vent.upper()
        most = plant.full * shares[1], fill.upper(), vent.lower()
        span, change = plant.sample / steps, point(0)
        bottom, top = low, high
        for k in range(steps):
            parts = point(k) / steps, point(k + 1) / steps
            crest = most[1].max(parts[0]).min(parts[1])
            weakest = plant.torque(*least, parts[0]).lower().min(plant.torque(*least, parts[1]).lower())
            strongest = plant.torque(*most, crest).upper()
            up = plant.advance(high, self.speed, strongest, span, 1)
            down = plant.advance(low, self.speed, weakest, span, -1)
            if up is None or down is None:
                return False
            high, low = up[0], down[0]
            bottom, top = bottom.min(down[1]), top.max(up[1])
            pieces, torques = (PIECES if sharp else 1), hull(weakest, strongest)
            ends = [down[1] + (up[1] - down[1]) * m / pieces for m in range(pieces + 1)]
            rates = [plant.rate(hull(a, b), self.speed, torques) for a, b in pairwise(ends)]
            change += span * reduce(hull, rates)
        if not (bottom >= 0 and top < 1):
            return False
        rise = (plant.torque(least[0], most[1], most[2], point(1)) - least[0]).upper() / plant.full
        fall = (plant.torque(most[0], least[1], least[2], point(1)) - most[0]).lower() / plant.full
        moved = level + hull(fall, rise) + here.tilt * change
        if not here.covers(low, high, moved):
            return False
        if self.slower is not None:
            turned = moved + (point(self.slower.tilt) - here.tilt) * (hull(low, high) - plant.reference)
            if not self.slower.covers(low, high, turned):
                return False
        self.low, self.high = min(self.low, float(bottom) - 1e-12), max(self.high, float(top) + 1e-12)
        return True

    def commands(
        self, cells: tuple[int, int, int, int], states: tuple[Ball, Ball], sharp: bool
    ) -> tuple[Ball, Ball]:
        """Enclose what the law commands, by its value at the center and its slopes."""
        plant, here, law = self.plant, self.here, self.plant.problem.wheelset_law
        speed, n = hull(plant.point(here.low), plant.point(here.high)), here.per_unit

        def command(slip: Any, level: Any, speed: Any) -> tuple[Any, ...]:
            torque = plant.full * (level - here.tilt * (slip - plant.reference))
            return tuple(law.step((), Measurement(speed, speed * (1 - slip) / plant.radius, torque))[1])

        i0, i1, j0, j1 = cells
        if not sharp:  # widened to the group
            i0, j0, i1, j1 = i0 - i0 % GROUP, j0 - j0 % GROUP, i1 + -i1 % GROUP, j1 + -j1 % GROUP
        key = (i0, i1, j0, j1)
        if key not in self.slopes:
            slips, levels = (hull(plant.point(a) / n, plant.point(b) / n) for a, b in ((i0, i1), (j0, j1)))
            self.slopes[key] = law_slopes(command, (slips, levels, speed))
        boxes = (*states, speed)
        centers = tuple(each.mid() for each in boxes)
        answers = []
        for middle, (plain, slopes) in zip(command(*centers), self.slopes[key], strict=True):
            value = middle + sum(
                slope * (box - center) for slope, box, center in zip(slopes, boxes, centers, strict=True)
            )
            answers.append(value.intersection(plain))
        return answers[0], answers[1]
