"""Largest set of cells that the one-sample map keeps, for each window of speed, glued from the slowest upwards.

The train slows down, so a wheelset passes from each window into the next slower one, at any state of its set. A
set is therefore kept only with images inside itself *and* inside the set of the next slower window.
"""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.invariant_sets.cells import CellSet, inside, largest_kept, touched
from wspd_design.certificates.search.invariant_sets.one_sample import (
    Images,
    Window,
    images,
    largest_deceleration,
)
from wspd_design.certificates.search.progress import tell
from wspd_design.controllers.protocol import Measurement
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

WINDOW_RATIO = 1.05  # highest over lowest speed of a window
LARGEST_SLIP = 0.4  # of the region in which the search starts
LEVEL_RANGE = 0.3  # share of T_max on either side of the torque that holds the reference
STEPS_PER_SWING = 15.0  # steps of a sample, for each unit of slip that T_max would add during it
MOST_STEPS = 40
SLACK = 0.1  # of a cell, that images are widened by
TILT_RATIO = 1.3  # from one tilt to the next
TRIALS = ((0.6, 128), (0.6, 256), (0.4, 256), (0.4, 512))
"""Tilt over that of the law, and cells per unit.

With less tilt than the law has, a cell spans less torque, so that the bounds of the slip in it are tighter; with
much less, its images reach over more levels.
"""
COARSE = 1  # of the trials; finer ones are left out where the next slower window failed already


@dataclass(frozen=True, slots=True, kw_only=True)
class Found:
    """Largest invariant set of one window, with the images of all cells of its rectangle."""

    reference: float  # slip
    cells: CellSet
    image: Images
    physical: "NDArray[np.bool_]"  # cells with a torque that the brake can have
    steps: int  # of a sample
    glued: bool  # its images also lie in the set of the next slower window, if there is one

    @property
    def states(self) -> "NDArray[np.bool_]":
        """Cells of the set that hold a state which can be."""
        return self.cells.members & self.physical

    @property
    def holds_reference(self) -> bool:
        """Whether the set holds a state at the reference slip."""
        row = math.floor(self.reference * self.cells.per_unit) - self.cells.first[0]
        return 0 <= row < len(self.states) and bool(self.states[row].any())


def windows(problem: Problem) -> list[Window]:
    """Cut the range of speed into windows, the slowest first, none of which a sample can jump over."""
    lowest, highest = problem.speeds
    whole = Window(low=lowest, high=highest, tilt=0.0)
    least = 1.001 * float(largest_deceleration(problem, whole).sup) * problem.sample_time
    found, low = [], lowest
    while low < highest:
        high = min(max(WINDOW_RATIO * low, low + least), highest)
        found.append(Window(low=low, high=high, tilt=tilt_of_law(problem, math.sqrt(low * high))))
        low = high
    return found


def tilt_of_law(problem: Problem, speed: float) -> float:
    """Torque that a law trades for slip at its reference, from differences of its command [share of T_max]."""
    share = holding_share(problem, speed)
    step = 1e-3
    per_slip = _fill(problem, speed, problem.slip - step, share) - _fill(
        problem, speed, problem.slip + step, share
    )
    per_share = _fill(problem, speed, problem.slip, share - step) - _fill(
        problem, speed, problem.slip, share + step
    )
    tilt = per_slip / (2.0 * step + per_share)
    # Windows of the same tilt share their grid, so that nothing is lost between them.
    return round(TILT_RATIO ** round(math.log(tilt, TILT_RATIO)), 4) if tilt > 0.0 else 0.0


def holding_share(problem: Problem, speed: float) -> float:
    """Torque that holds the reference slip with nominal parameters, as a share of T_max."""
    at = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speed)
    return float(-at.drift / at.gain / problem.vehicle.brake.max_torque)


def _fill(problem: Problem, speed: float, slip: float, share: float) -> float:
    wheel_speed = speed * (1.0 - slip) / problem.vehicle.wheel_radius
    torque = share * problem.vehicle.brake.max_torque
    _, command = problem.wheelset_law.step((), Measurement(speed, wheel_speed, torque))
    return float(command.fill)


def search(problem: Problem, *, most_work: float) -> list[Found | None]:
    """Find the sets of all windows, the slowest first.

    Parameters
    ----------
    problem : Problem
        Closed loop with a law without memory.
    most_work : float
        Cells that are mapped, times the steps of their sample, after which windows are left out. Work is counted
        instead of seconds so that the same problem has the same sets however fast or busy the machine is.

    Returns
    -------
    list of Found or None
        None for a window in which nothing was found; windows that were left out are missing.
    """
    results: list[Found | None] = []
    slices, needed, taken = windows(problem), 0, 0
    for window in slices:
        if taken >= most_work:
            break
        tell(len(results) / len(slices))
        slower = results[-1] if results else None
        best = None
        # The faster, the finer: what did not do for the next slower window is not tried again.
        trials = range(COARSE) if results and slower is None else range(needed, len(TRIALS))
        for trial in trials:
            tilt, per_unit = TRIALS[trial]
            tilted = replace(window, tilt=tilt * window.tilt)
            start = start_region(problem, tilted, per_unit)
            steps = start.members.size * steps_of(problem, tilted)
            best, taken = largest(problem, start, slower), taken + steps
            if best is None and slower is not None:
                # Say which windows stand alone, although the stop is not covered.
                best, taken = largest(problem, start, None), taken + steps
            if best is not None and (best.glued or slower is None):
                needed = trial
                break
        results.append(best)
    return results


def start_region(problem: Problem, window: Window, per_unit: int) -> CellSet:
    """All cells from which the search starts in a window."""
    import numpy as np

    first = math.ceil(problem.slips[0] * per_unit)
    last = math.floor(min(problem.slips[1], LARGEST_SLIP) * per_unit)
    center = holding_share(problem, math.sqrt(window.low * window.high))
    lowest, highest = (round((center + side * LEVEL_RANGE) * per_unit) for side in (-1.0, 1.0))
    members = np.full((max(last - first, 1), highest - lowest), True)
    return CellSet(window=window, per_unit=per_unit, first=(first, lowest), members=members)


def largest(problem: Problem, start: CellSet, slower: Found | None) -> Found | None:
    """Find the largest invariant set in a region, or none at the reference slip.

    Parameters
    ----------
    problem : Problem
        Closed loop.
    start : CellSet
        Where the set may lie.
    slower : Found, optional
        Set of the next slower window, in which images must lie too.
    """
    window = start.window
    steps = steps_of(problem, window)
    slip, level = start.edges()
    image = _with_slack(images(problem, window, slip, level, steps=steps), SLACK / start.per_unit)
    physical = start.physical(problem)
    shape = start.members.shape
    free = ~physical.ravel()  # no state is there, so none can leave
    members = start.members
    if slower is not None:
        turned = in_window(problem, image, window, slower.cells.window)
        stays = inside(slower.cells.members, touched(slower.cells, turned)) | free
        members = members & stays.reshape(shape)
    members = largest_kept(members, touched(start, image), free)
    found = Found(
        reference=problem.slip,
        cells=replace(start, members=members),
        image=image,
        physical=physical,
        steps=steps,
        glued=slower is not None,
    )
    return found if found.holds_reference else None


def _with_slack(image: Images, slack: float) -> Images:
    """Widen images, so that the checker's somewhat wider ones still fit."""
    return replace(
        image,
        slip_low=image.slip_low - slack,
        slip_high=image.slip_high + slack,
        level_low=image.level_low - slack,
        level_high=image.level_high + slack,
    )


def steps_of(problem: Problem, window: Window) -> int:
    """Steps into which the map cuts a sample: more where the torque moves the slip faster."""
    gain = slip_dynamics(problem.vehicle, problem.rail, problem.slip, window.low).gain
    swing = float(gain) * problem.vehicle.brake.max_torque * problem.sample_time
    return max(1, min(MOST_STEPS, math.ceil(STEPS_PER_SWING * swing)))


def in_window(problem: Problem, image: Images, here: Window, there: Window) -> Images:
    """Give images the level coordinate of another window."""
    import ival
    import numpy as np

    known = np.isfinite(image.slip_high) & np.isfinite(image.slip_low)
    slip = ival.Interval(np.where(known, image.slip_low, 0.0), np.where(known, image.slip_high, 0.0))
    level = ival.Interval(image.level_low, image.level_high)
    turned = level + (ival.Interval(there.tilt, there.tilt) - here.tilt) * (slip - problem.slip)
    return replace(image, level_low=turned.inf, level_high=turned.sup)
