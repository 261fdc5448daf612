"""Search for groups and cells of the way from rolling into a band; nothing here is trusted."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import log
from random import Random

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

TOLERANCES = dict(zip(ALL, (0.48, 0.24, 0.19, 0.5, 0.3, 0.45, 1.5, 0.7), strict=True))
"""Logarithms of the higher over the lower end of ranges that make cells about as hard to follow."""
CELLS = 0.42, 0.3, 0.21, 0.15  # of that width, cells that may be tried first
SMALLEST = 0.06  # at which a cell is given up
TRIED, HOLD = 24, 0.5  # cells that are tried before others, and the part of them that has to hold
DRAWN = 48  # cells that are drawn to guess how many there are
MOST = 3_000  # cells that are followed, with an effort of 1
UNTIL = 0.6, 0.75  # of the reference, slips at which cells end
WAY = 0.9  # of the way of a whole sample, that wheels of a cell want at most when it ends
FAILED = 4  # groups that may fail, with an effort of 1
GROUP = "ususvtium"  # ranges that groups are halved by, one after the other


@dataclass(slots=True)
class Search:
    """What is sought, and what may be spent."""

    problem: Problem
    asked: Sequence[tuple[Cell, Asked]]
    until: float  # -, slip at which cells end
    size: float  # of cells that are tried first
    left: int  # cells that may be followed yet
    fails: int  # groups that may fail yet


def ways(
    problem: Problem, share: Fraction, asked: Sequence[tuple[Cell, Asked]], effort: float
) -> Proof | None:
    """Find a proof for the box of a problem, which is a share of another one; None if none was found."""
    most, box = int(MOST * effort), box_around(problem)
    begins = _begins(problem, box)
    if begins is None:
        return None
    search = Search(problem, asked, *begins, most, int(FAILED * effort))
    if _drawn(search, box, DRAWN)[1] > most:
        return None
    found = _grouped(search, box, GROUP)
    return None if found is None else Proof(share, search.until, *found)


def _begins(problem: Problem, box: Box) -> tuple[float, float] | None:
    """Where cells end, and how large those are that are tried first, of which most hold."""
    for size in CELLS:
        cells = _some(_divided(box, size), TRIED)
        for part in UNTIL:
            if len(_tight(problem, cells, part * problem.slip)) >= HOLD * len(cells):
                return part * problem.slip, size
    return None


def _divided(box: Box, size: float) -> list[Box]:
    todo, cells = [box], []
    while todo:
        here = todo.pop()
        letter, width = _widest(here)
        if width > size:
            todo += halves(here, letter)[::-1]
        else:
            cells.append(here)
    return cells


def _some(cells: list[Box], count: int) -> list[Box]:
    """Return some cells from all over a list."""
    return [cells[k * len(cells) // count] for k in range(count)] if len(cells) > count else cells


def _tight(problem: Problem, cells: Sequence[Box], until: float) -> list[Start]:
    """What wheels have at the end, of those cells that hold."""
    found = [each[0] for each in caught_of(problem, cells, until) if each is not None]
    return [each for each in found if _is_tight(problem, each)]


def _drawn(search: Search, box: Box, count: int) -> tuple[list[Start], float]:
    """Follow cells that are drawn by halving a box until they hold; with a guess of how many cells there are."""
    random, starts, total = Random(0), [], 0.0
    todo = [(box, 1.0 / count)] * count
    while todo:
        drawn = []
        for here, weight in todo:
            letter, width = _widest(here)
            while width > search.size:
                here, weight = random.choice(halves(here, letter)), 2.0 * weight
                letter, width = _widest(here)
            drawn.append((here, weight))
        todo = []
        found = caught_of(search.problem, [here for here, _ in drawn], search.until)
        for (here, weight), each in zip(drawn, found, strict=True):
            letter, width = _widest(here)
            if each is not None and _is_tight(search.problem, each[0]):
                starts.append(each[0])
                total += weight
            elif width < SMALLEST:
                return starts, float("inf")
            else:
                todo.append((random.choice(halves(here, letter)), 2.0 * weight))
        if total + sum(weight for _, weight in todo) > 4.0 * search.left:
            return starts, float("inf")
    return starts, total


def _grouped(search: Search, box: Box, letters: str) -> tuple[str, tuple[Group, ...]] | None:
    """Divide a box into groups, and find cells and a plan for each; by some letters, where it is one group too many."""
    found = _group(search, box)
    if found is not None:
        return ".", (found,)
    search.fails -= 1
    if not letters or search.left <= 0 or search.fails < 0:
        return None
    parts = []
    for half in halves(box, letters[0]):
        part = _grouped(search, half, letters[1:])
        if part is None:
            return None
        parts.append(part)
    (steps, groups), (others, more) = parts
    return letters[0] + steps + others, groups + more


def _group(search: Search, box: Box) -> Group | None:
    """Find cells of a group and a plan for it: first for some of them, then for all."""
    problem, met = search.problem, met_by(search.asked, box)
    numbers = dict(zip(ALL, box, strict=True))
    some, count = _drawn(search, box, TRIED)
    if count > search.left or isinstance(plan_for(problem, numbers, together(some), met), str):
        return None
    found = _celled(search, box)
    if found is None:
        return None
    steps, start = found
    plan = plan_for(problem, numbers, start, met)
    return None if isinstance(plan, str) else Group(steps=steps, plan=plan[0])


def _celled(search: Search, box: Box) -> tuple[str, Start] | None:
    """Divide a box into cells that hold, the widest range first; with what their wheels have together."""
    tree: dict[str, str] = {}  # letter of each node that is halved, by its path
    todo = [("", box)]
    starts: list[Start] = []
    while todo:
        if search.left <= 0:
            return None
        batch: list[tuple[str, Box]] = []
        while todo and len(batch) < AT_ONCE:
            path, here = todo.pop()
            if _widest(here)[1] > search.size:
                todo += _halved(tree, path, here)
            else:
                batch.append((path, here))
        search.left -= len(batch)
        found = caught_of(search.problem, [here for _, here in batch], search.until)
        for (path, here), each in zip(batch, found, strict=True):
            if each is not None and _is_tight(search.problem, each[0]):
                starts.append(each[0])
            elif _widest(here)[1] < SMALLEST:
                return None
            else:
                todo += _halved(tree, path, here)
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


def _halved(tree: dict[str, str], path: str, box: Box) -> list[tuple[str, Box]]:
    letter = _widest(box)[0]
    tree[path] = letter
    low, high = halves(box, letter)
    return [(path + "1", high), (path + "0", low)]


def _widest(box: Box) -> tuple[str, float]:
    """Letter of the widest range for its tolerance, and that width."""
    sizes = [log(high / low) / TOLERANCES[name] for (low, high), name in zip(box, ALL, strict=True)]
    k = max(range(len(sizes)), key=lambda i: sizes[i])
    return EVERY[k], sizes[k]


def _written(tree: dict[str, str], path: str) -> str:
    """Steps of a tree."""
    letter = tree.get(path)
    return "." if letter is None else letter + _written(tree, path + "0") + _written(tree, path + "1")
