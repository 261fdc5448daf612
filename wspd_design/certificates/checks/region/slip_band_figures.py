"""What a report shows beside a band of slip: band over speed, basin with runs inside it, and the cells of the proof."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import Figures, series
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.quantities import QUANTITIES
from wspd_design.certificates.records import Certificate, Problem, Role, Series, Status
from wspd_design.certificates.theorems.band import CELLS, contact_held
from wspd_design.certificates.theorems.slip_band.attempt import Attempt, attempt_of, cells_of, how_it_ended
from wspd_design.certificates.theorems.slip_band.checker import steady_of
from wspd_design.certificates.theorems.slip_band.departure import SettledStop, settled_stop
from wspd_design.certificates.theorems.slip_band.loop import Steady
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid, Proof, read
from wspd_design.certificates.theorems.slip_band.reference import slip_at
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    NAMES,
    BandLaw,
    Cell,
    box_of,
    law_of,
    windows_of,
)
from wspd_design.controllers.protection import Protection
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.units import KMH
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.start import holding_torque
from wspd_design.simulation.stop import simulate

if TYPE_CHECKING:
    from wspd_design.certificates.search.matrix_inequalities import Array

POINTS = 33  # points of a reference that falls
AROUND = 97  # of an outline
SEEN = (0, 3)  # error and torque among the numbers of the state
STARTS = 4  # runs in an ellipsoid
ALONG = 121  # points of a run
LITTLE = Fraction(1, 4)  # share of the box whose cells could not be told apart within the stated ranges
BASIN = ("sliding speed above that of the reference [m/s]", "torque above what holds where it settles [kN m]")
FIRST = "utmirfv"  # letters of ranges over which cells are shown, if halved as often: friction and pads before others
REMARK = (
    "The ellipsoids are those of the nominal numbers, as error and torque see them; the runs are simulated stops of "
    "the quarter model that begin on them with settled observers."
)
CELLS_REMARK = (
    "Cells are shown over the two numbers whose ranges were halved most often, and seen along all others, so that they "
    "may cover each other."
)
TRIED_REMARK = (
    "Of the larger share what the search says of itself is shown: no checker decided about its cells, and the one at "
    "which it ended is hatched."
)
UNKNOWN_REMARK = "Where the search for a larger share ended is not known."


def figures(problem: Problem, certificate: Certificate) -> Figures:
    """Band over speed; with a proof, ellipsoids of the nominal numbers with runs; cells, and the one that failed."""
    finding = certificate.findings[CELLS]
    attempt = attempt_of(problem, finding.effort)
    if finding.status is not Status.PROVED or finding.stated.proof is None:
        shown = tuple(_cells(problem, None, attempt))
        return Figures(series=(_reference(problem), *shown), remark=_remark(attempt, shown, whole=False))
    proof = read(finding.stated.proof, len(windows_of(problem)))
    cells = cells_of(box_of(problem, proof.share), proof.steps)[0]
    nominal = tuple(Fraction(problem.nominal(name)) for name in NAMES)
    inside = (all(low <= x <= high for x, (low, high) in zip(nominal, cell, strict=True)) for cell in cells)
    place, ellipsoids = next(
        (cell, found) for cell, found, holds in zip(cells, proof.cells, inside, strict=True) if holds
    )
    sets = [
        (each, steady_of(contact_held(problem), proof, (place, k), each))
        for k, each in enumerate(ellipsoids)
        if each is not None
    ]
    shown = tuple(_cells(problem, proof, attempt))
    return Figures(
        series=(*_band(problem, finding.numbers), *_basin(problem, sets), *shown),
        remark=f"{REMARK} {_remark(attempt, shown, whole=proof.share == 1)}".strip(),
    )


def _remark(attempt: Attempt | None, cells: Sequence[Series], *, whole: bool) -> str:
    """Say how cells are seen, and what is known of a search that ended."""
    ended = TRIED_REMARK if attempt is not None else "" if whole else UNKNOWN_REMARK
    return " ".join(filter(None, (CELLS_REMARK if cells else "", ended)))


def _law(problem: Problem) -> BandLaw:
    return law_of(problem.controller)


def _held(problem: Problem, speeds: "Array") -> "Array":
    import numpy as np

    law, radius = _law(problem), problem.vehicle.wheel_radius
    return np.array([slip_at(law, float(speed), radius) for speed in speeds])


_SLIP = ("speed [km/h]", "slip [-]")


def _reference(problem: Problem) -> Series:
    import numpy as np

    speeds = np.linspace(*problem.speeds, POINTS if _law(problem).falls else 2)
    return series("reference", *_SLIP, speeds * KMH, _held(problem, speeds))


def _band(problem: Problem, numbers: Mapping[str, float]) -> tuple[Series, ...]:
    """Largest and smallest slip that are proved."""
    import numpy as np

    windows = windows_of(problem)
    speeds = np.array([speed for window in windows for speed in window])
    above, below = (
        np.array([numbers[f"band {k} {side}"] for k in range(len(windows)) for _ in range(2)])
        for side in ("above", "below")
    )
    held = _held(problem, speeds)
    return (
        series("largest slip", *_SLIP, speeds * KMH, held + above),
        series("smallest slip", *_SLIP, speeds * KMH, held - below),
        _reference(problem),
    )


def _basin(problem: Problem, sets: Sequence[tuple[Ellipsoid, Steady]]) -> Iterator[Series]:
    """Yield the ellipsoids of the slowest and of a middle window as error and torque see them, and runs in them."""
    windows = windows_of(problem)
    for k in sorted({0, len(windows) // 2}):
        low, high = (speed * KMH for speed in windows[k])
        name = f"{low:.0f} to {high:.0f} km/h"
        yield _outline(problem, f"ellipsoid, {name}", *sets[k])
        if isinstance(
            problem.controller, Protection
        ):  # how the observers of another law have settled is not known
            yield from _runs(problem, f"runs, {name}", sets[k][0], windows[k])


def _scales(problem: Problem) -> tuple[float, float]:
    """What errors and torques of the state are multiplied by for the plot [m, kN m s]."""
    law = _law(problem)
    return -problem.vehicle.wheel_radius, float(law.inertia / law.sample_time) / 1e3


def _outline(problem: Problem, name: str, each: Ellipsoid, steady: Steady) -> Series:
    """Shadow of an ellipsoid on error and torque, about all centers that the steady drift moves it to."""
    import numpy as np

    spread = np.array(each.matrix, dtype=float)[np.ix_(SEEN, SEEN)]
    center = np.array(each.center, dtype=float)[list(SEEN)]
    center[0] += float(each.settled)
    turn = np.linspace(0.0, 2.0 * math.pi, AROUND)
    root, directions = np.linalg.cholesky(spread), np.array([np.cos(turn), np.sin(turn)])
    moved = np.array(each.moves, dtype=float)[list(SEEN)] * float(steady.away(point(each.drift)).mid())
    # Where the outline looks the way that the center moves, it is that about the last center.
    edge = root @ directions + np.outer(moved, np.sign(np.linalg.inv(root) @ moved @ directions))
    slide, torque = _scales(problem)
    return series(name, *BASIN, slide * (center[0] + edge[0]), torque * (center[1] + edge[1]), Role.OUTLINE)


def _runs(problem: Problem, name: str, each: Ellipsoid, window: Ends) -> Iterator[Series]:
    """Yield simulated runs that begin on the ellipsoid, with observers that have settled, down to its lowest speed."""
    import numpy as np

    nominal = {number: problem.nominal(number) for number in NAMES}
    at = settled_stop(problem, {**nominal, "speed": window[1]})
    slide, torque = _scales(problem)
    pads = at.vehicle.brake.max_torque / float(_law(problem).full_torque)
    error_there = float(each.settled)
    held = _holding(problem, at, window[1], error_there)
    for error, step in _starts(each):
        start = replace(
            at.start,
            slip=at.start.slip + slide * (error_there + error) / window[1],
            torque=held + 1e3 * torque * pads * step,
        )
        scenario = Scenario(rail=at.rail, initial_speed=window[1], start=start)
        run = simulate(at.vehicle, at.law, scenario, plant="quarter")
        shown = np.flatnonzero(run.speed >= window[0])
        shown = shown[:: max(1, len(shown) // ALONG)]
        speeds = run.speed[shown]
        holding = [_holding(problem, at, float(speed), error_there) for speed in speeds]
        x = (run.slip[shown, 0] - _held(problem, speeds)) * speeds
        yield series(name, *BASIN, x, (run.torque[shown, 0] / pads - np.array(holding) / pads) / 1e3)


def _starts(each: Ellipsoid) -> "Array":
    """Errors and torques at the edge of the ellipsoid where the observer has settled [rad/s]."""
    import numpy as np

    p, center = np.linalg.inv(np.array(each.matrix, dtype=float)), np.array(each.center, dtype=float)
    seen = np.ix_(SEEN, SEEN)
    pull = (p @ center)[list(SEEN)]
    middle = np.linalg.solve(p[seen], pull)
    left = 1.0 - center @ p @ center + pull @ middle
    turn = (np.arange(STARTS) + 0.5) * 2.0 * math.pi / STARTS
    edge = np.linalg.solve(np.linalg.cholesky(p[seen]).T, np.array([np.cos(turn), np.sin(turn)]))
    starts: Array = (middle[:, None] + max(left, 0.0) ** 0.5 * edge).T
    return starts


def _holding(problem: Problem, at: SettledStop, speed: float, error: float) -> float:
    """Torque that holds an error of the wheel speed beside the reference [N m]."""
    radius = at.vehicle.wheel_radius
    slip = slip_at(_law(problem), speed, radius) - error * radius / speed
    return holding_torque(at.vehicle, at.rail, slip=slip, speed=speed, braking_time=at.start.braking_time)


def _cells(problem: Problem, proof: Proof | None, attempt: Attempt | None) -> Iterator[Series]:
    """Yield the stated ranges, the cells of the proof, and those of a larger share with the one at which it ended."""
    if attempt is None and (proof is None or (len(proof.cells) == 1 and proof.share == 1)):
        return  # the box itself
    letters = _halved_most("".join(each.steps for each in (proof, attempt) if each is not None))
    if attempt is None or attempt.share > LITTLE:
        yield _rectangle("stated ranges", letters, box_of(problem, Fraction(1)))
    if proof is not None:
        for cell in _seen(letters, cells_of(box_of(problem, proof.share), proof.steps)[0]):
            yield _rectangle("cells with ellipsoids", letters, cell)
    if attempt is None:
        return
    tried, box = f"{100.0 * float(attempt.share):.3g} % of each range", box_of(problem, attempt.share)
    closed, waiting = cells_of(box, attempt.steps)
    if attempt.share < 1:
        yield _rectangle(f"tried: {tried}", letters, box, Role.TRIED)
    for cell in _seen(letters, closed):
        yield _rectangle(f"closed by the search on {tried}, not proved", letters, cell, Role.TRIED)
    yield _rectangle(f"{how_it_ended(problem, attempt)} on {tried}", letters, waiting[-1], Role.FAILED)


def _halved_most(steps: str) -> tuple[str, str]:
    """Letters of the two ranges that steps halve most often, in the order of the table."""
    first, second, *_ = sorted(FIRST, key=lambda letter: -steps.count(letter))
    return (first, second) if LETTERS.index(first) < LETTERS.index(second) else (second, first)


def _seen(letters: tuple[str, str], cells: Sequence[Cell]) -> Iterator[Cell]:
    """Yield one of all cells that look alike."""
    places = [LETTERS.index(letter) for letter in letters]
    yield from {tuple(cell[place] for place in places): cell for cell in cells}.values()


def _rectangle(name: str, letters: tuple[str, str], cell: Cell, role: Role = Role.OUTLINE) -> Series:
    """Return what a cell looks like over two of its ranges."""
    import numpy as np

    ((left, right), x_label), ((low, high), y_label) = (_side(LETTERS.index(each), cell) for each in letters)
    x, y = np.array([left, right, right, left, left]), np.array([low, low, high, high, low])
    return series(name, x_label, y_label, x, y, role)


def _side(place: int, cell: Cell) -> tuple[tuple[float, float], str]:
    """Ends of a range of a cell in the unit of the plot, and the label of the axis."""
    unit = QUANTITIES[NAMES[place]].unit
    factor, shown = (1e-3, "kN m") if unit == "N m" else (1.0, unit)
    low, high = (factor * float(end) for end in cell[place])
    return (low, high), f"{NAMES[place]} [{shown}]"
