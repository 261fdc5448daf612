"""Search for groups and cells of the way from rolling into a band; nothing here is trusted."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.slip_band.settling import plan_for
from wspd_design.certificates.theorems.from_rolling.settling import Start
from wspd_design.certificates.theorems.from_rolling.ways_in import (
    ALL,
    AT_ONCE,
    EVERY,
    Box,
    Group,
    Proof,
    box_around,
    caught_of,
    halves,
    met_by,
    together,
)
from wspd_design.certificates.theorems.slip_band.arrival import Asked
from wspd_design.certificates.theorems.slip_band.statement import Cell

TOLERANCES = dict(zip(ALL, (1.2, 0.8, 2.5, 1.0, 1.0, 0.45, 1.5, 0.7), strict=True))
"""How wide cells can be, one range against another, over half of the stated ranges."""
CELL = 0.25  # of that width, cells that are tried first
SMALLEST = 0.05  # at which a cell is given up
TRIED, HOLD = 24, 0.75  # cells that are tried before all are followed, and the part of them that has to hold
MOST = 1_200  # cells that are followed, with an effort of 1
UNTIL = 0.43, 0.6  # of the reference, slips at which cells end
WAY = 0.9  # of the way of a whole sample, that wheels of a cell want at most when it ends
GROUP = "vti"  # ranges of which groups are halves, where the box is one group too many


@dataclass(slots=True)
class Count:
    """What may be spent."""

    effort: float
    left: int  # cells that may be followed yet


def ways(
    problem: Problem, share: Fraction, asked: Sequence[tuple[Cell, Asked]], effort: float, whole: Problem
) -> Proof | None:
    """Find a proof for a box, ``problem``, that has a share of the ranges of ``whole``; None if none was found."""
    count = Count(effort, int(MOST * effort))
    widths = [0.5 * (high - low) for low, high in (whole.span(name) for name in ALL)]
    tried = max(1, int(effort))
    for part in UNTIL[:tried]:
        until = part * problem.slip
        for letters in _prefixes(GROUP[: tried - 1]):
            found = _grouped(problem, box_around(problem), letters, until, asked, widths, count)
            if found is not None:
                steps, groups = found
                return Proof(share, until, steps, groups)
            if count.left <= 0:
                return None
    return None


def _prefixes(letters: str) -> Iterator[str]:
    for k in range(len(letters) + 1):
        yield letters[:k]


def _grouped(
    problem: Problem,
    box: Box,
    letters: str,
    until: float,
    asked: Sequence[tuple[Cell, Asked]],
    widths: Sequence[float],
    count: Count,
) -> tuple[str, tuple[Group, ...]] | None:
    """Divide a box into groups by some letters, and find cells and a plan for each."""
    if letters:
        parts = [
            _grouped(problem, half, letters[1:], until, asked, widths, count)
            for half in halves(box, letters[0])
        ]
        if any(each is None for each in parts):
            return None
        one, other = (each for each in parts if each is not None)
        return letters[0] + one[0] + other[0], one[1] + other[1]
    met = met_by(asked, box)
    numbers = dict(zip(ALL, box, strict=True))
    if not _promises(problem, box, until, widths, met, count.effort):
        return None
    found = _celled(problem, box, until, widths, count)
    if found is None:
        return None
    steps, start = found
    plan = plan_for(problem, numbers, start, met, count.effort)
    return None if isinstance(plan, str) else (".", (Group(steps=steps, plan=plan[0]),))


def _promises(
    problem: Problem,
    box: Box,
    until: float,
    widths: Sequence[float],
    met: Sequence[Asked],
    effort: float,
) -> bool:
    """Whether most of some cells hold, from all over a box, and their wheels come into the band."""
    todo, cells = [box], []
    while todo:
        here = todo.pop()
        letter, size = _widest(here, widths)
        if size > CELL:
            todo += halves(here, letter)[::-1]
        else:
            cells.append(here)
    chosen = [cells[k * len(cells) // TRIED] for k in range(TRIED)] if len(cells) > TRIED else cells
    found = [each[0] for each in caught_of(problem, chosen, until) if each is not None]
    tight = [each for each in found if _is_tight(problem, each)]
    if len(found) < HOLD * len(chosen) or not tight:
        return False
    return not isinstance(
        plan_for(problem, dict(zip(ALL, box, strict=True)), together(tight), met, effort), str
    )


def _celled(
    problem: Problem, box: Box, until: float, widths: Sequence[float], count: Count
) -> tuple[str, Start] | None:
    """Divide a box into cells that hold, the widest range first; with what their wheels have together."""
    tree: dict[str, str] = {}  # letter of each node that is halved, by its path
    todo = [("", box)]
    starts: list[Start] = []
    while todo:
        if count.left <= 0:
            return None
        batch: list[tuple[str, Box]] = []
        while todo and len(batch) < AT_ONCE:
            path, here = todo.pop()
            if _widest(here, widths)[1] > CELL:
                todo += _halved(tree, path, here, widths)
            else:
                batch.append((path, here))
        count.left -= len(batch)
        found = caught_of(problem, [here for _, here in batch], until)
        for (path, here), each in zip(batch, found, strict=True):
            if each is not None and _is_tight(problem, each[0]):
                starts.append(each[0])
            elif _widest(here, widths)[1] < SMALLEST:
                return None
            else:
                todo += _halved(tree, path, here, widths)
    return _written(tree, ""), together(starts)


def _is_tight(problem: Problem, start: Start) -> bool:
    """Whether wheels of a cell want no more than a part of what a sample does, and know what they do."""
    from wspd_design.certificates.theorems.from_rolling.sample import law_numbers
    from wspd_design.certificates.theorems.slip_band.statement import law_of

    law = law_numbers(law_of(problem.controller))
    size = 6.0 * law.sigma
    return (
        start.way.high < WAY * law.fills * start.room and start.way.low > -2.0 * size and start.z.size < size
    )


def _halved(tree: dict[str, str], path: str, box: Box, widths: Sequence[float]) -> list[tuple[str, Box]]:
    letter = _widest(box, widths)[0]
    tree[path] = letter
    low, high = halves(box, letter)
    return [(path + "1", high), (path + "0", low)]


def _widest(box: Box, widths: Sequence[float]) -> tuple[str, float]:
    """Letter of the widest range for its tolerance, and that width."""
    sizes = [
        0.5 * (high - low) / width / TOLERANCES[name] if width else 0.0
        for (low, high), width, name in zip(box, widths, ALL, strict=True)
    ]
    k = max(range(len(sizes)), key=lambda i: sizes[i])
    return EVERY[k], sizes[k]


def _written(tree: dict[str, str], path: str) -> str:
    """Steps of a tree."""
    letter = tree.get(path)
    return "." if letter is None else letter + _written(tree, path + "0") + _written(tree, path + "1")
