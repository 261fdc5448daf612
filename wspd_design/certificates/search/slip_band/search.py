"""Search for a cover of the box by cells that have an ellipsoid in every window; nothing here is trusted."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.slip_band.ellipsoids import Loops, ellipsoid, excess
from wspd_design.certificates.theorems.slip_band.checker import errors, holds_more, least_delay
from wspd_design.certificates.theorems.slip_band.friction import Halves
from wspd_design.certificates.theorems.slip_band.loop import Choice, Conditions, Loop, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid, Proof
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    BandLaw,
    Cell,
    box_of,
    halved,
    windows_of,
)

NARROWEST = 1.02  # ratio of the ends of a range that is not worth halving
SHARES = tuple(Fraction(k, 8) for k in range(1, 9))
RESERVES = tuple(map(Fraction, ("0.5", "0.6", "0.7", "0.75", "0.8", "0.85")))
CHOICES = tuple(
    Choice(Fraction(pulse, 4), near)
    for pulse, near in (
        (4, 2),
        (4, 1),
        (3, 2),
        (3, 1),
        (2, 1),
        (1, 1),
        (4, 0),
        (2, 0),
        (1, 0),
        (4, 3),
        (3, 3),
    )
)
"""What an ellipsoid is sought for; shorter pulses leave less room, and less to be uncertain about."""
FIRST = Choice(Fraction(1, 2), 1)
HOPELESS = 1.4  # square of what is reached over what limits leave, from which on the widest range is halved
WORTH = 0.3  # of the widest range, that another one has at least to be looked at
MATTERS = {"m": 1.0, "i": 1.0, "r": 2.0, "u": 1.0, "t": 1.0, "f": 0.3, "v": 0.3}
"""How much the logarithm of a range spreads the loop."""


class Spent:
    """Ellipsoids that were sought, how many may be, and how far those were from their limits that were not found."""

    def __init__(self, most: float = math.inf) -> None:
        self.most, self.count = most, 0
        self.known: dict[object, float] = {}

    def one(self) -> None:
        """Count one more, or end the search."""
        self.count += 1
        if self.count > self.most:
            raise _OutOfBudget


class _OutOfBudget(Exception):
    """More ellipsoids were sought than may be."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sought:
    """What ellipsoids are sought for."""

    problem: Problem
    law: BandLaw
    friction: tuple[Halves, ...]  # proved bounds for each window
    conditions: Conditions

    @property
    def windows(self) -> tuple[tuple[float, float], ...]:
        """Windows of speed, the slowest first."""
        return windows_of(self.problem)

    def loops(self, cell: Cell, window: int, choice: Choice) -> Loops:
        """Return the loop of a cell and a window for a share of the full pressure and what errors are counted from."""

        def loop(supply: Fraction, settled: Fraction) -> Loop:
            return loop_of(
                self.problem,
                self.law,
                cell,
                self.windows[window],
                self.friction[window],
                choice._replace(settled=settled),
                self.conditions._replace(supply=supply),
            )

        return loop


@dataclass(frozen=True, slots=True, kw_only=True)
class Failed:
    """A cell that is not worth halving, or the one at which the budget ended."""

    share: Fraction  # of the box
    cell: Cell
    window: int  # in which no ellipsoid was found, the slowest being 0
    tried: int  # ellipsoids
    cut: bool  # whether the budget ended the search


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """Ellipsoids of a cell from the fastest window on, as far as they were found."""

    ellipsoids: tuple[Ellipsoid | None, ...] = ()
    choice: Choice = FIRST
    hints: tuple[int, ...] = ()

    @property
    def faster(self) -> Ellipsoid | None:
        """Ellipsoid that that of the next slower window must hold."""
        return self.ellipsoids[-1] if self.ellipsoids else None


def continued(sought: Sought, cell: Cell, chain: Chain, spent: Spent) -> Chain:
    """Go on with the ellipsoids of a cell towards slower windows, as far as there are some."""
    while len(chain.ellipsoids) < len(sought.windows):
        window = len(sought.windows) - 1 - len(chain.ellipsoids)
        if holds_more(
            sought.problem,
            sought.law,
            cell,
            sought.windows[window],
            sought.friction[window],
            sought.conditions.reserve,
        ):
            return replace(chain, ellipsoids=(*chain.ellipsoids, *[None] * (window + 1)))
        found = next_slower(sought, cell, window, chain, spent)
        if found is None:
            return chain
        chain = found
    return chain


def next_slower(sought: Sought, cell: Cell, window: int, chain: Chain, spent: Spent) -> Chain | None:
    """Add an ellipsoid to those of a cell: for the choice of the last one, or for the one that is best."""

    def tried(choice: Choice) -> Chain | None:
        spent.one()
        loops = sought.loops(cell, window, choice)
        found = ellipsoid(sought.law, loops, choice, sought.conditions.supply, chain.faster, chain.hints)
        if found is None:
            return None
        return Chain(ellipsoids=(*chain.ellipsoids, found[0]), choice=choice, hints=found[1])

    found = tried(_in_time(sought, chain.choice))
    if found is None:
        choice, left = _best(sought, cell, window, chain, spent)
        found = tried(choice) if left < 1.0 else None
    return found


def _in_time(sought: Sought, choice: Choice) -> Choice:
    """A pulse ends in its sample, however late it begins."""
    return choice._replace(pulse=min(choice.pulse, 1 - sought.conditions.delay))


def _best(sought: Sought, cell: Cell, window: int, chain: Chain, spent: Spent) -> tuple[Choice, float]:
    """Return the choice for which an ellipsoid goes least far to its limits, and how far.

    That of the last ellipsoid is compared with those that have its reach or its pulse.
    """
    last = chain.choice
    near = (each for each in CHOICES if each.near == last.near or each.pulse == last.pulse)
    tried = dict.fromkeys(_in_time(sought, each) for each in (last, *near))
    found = {each: _excess(sought, cell, window, each, chain, spent) for each in tried}
    best = min(found, key=lambda each: found[each])
    return best, found[best]


def cover(sought: Sought, share: Fraction, spent: Spent) -> Proof | Failed:
    """Find ellipsoids for a share of each range of the box, around its nominal value."""
    waiting, steps = [(box_of(sought.problem, share), Chain())], ""
    cells: list[tuple[Ellipsoid | None, ...]] = []
    cell, window = waiting[0][0], 0
    try:
        while waiting:
            cell, inherited = waiting.pop()
            inherited = _still_holding(sought, cell, inherited)
            chain = continued(sought, cell, inherited, spent)
            window = len(sought.windows) - 1 - len(chain.ellipsoids)
            # The ellipsoids of a larger cell may be too large to lie in one of a slower window.
            anew = Chain(choice=chain.choice, hints=chain.hints)
            if window >= 0 and inherited.ellipsoids and _alone(sought, cell, window, anew, spent) < 1.0:
                chain = continued(sought, cell, Chain(), spent)
                window = len(sought.windows) - 1 - len(chain.ellipsoids)
                anew = Chain(choice=chain.choice, hints=chain.hints)
            if window < 0:
                steps, cells = f"{steps}.", [*cells, chain.ellipsoids[::-1]]
                continue
            anew = replace(anew, choice=_best(sought, cell, window, anew, spent)[0])
            letter = None
            if _middle_has(sought, cell, window, anew, spent):
                letter = _letter(sought, cell, window, anew, spent)
            if letter is None:
                return Failed(share=share, cell=cell, window=window, tried=spent.count, cut=False)
            steps += letter
            chain = replace(chain, choice=anew.choice)
            waiting += [(half, chain) for half in halved(cell, letter)[::-1]]
    except _OutOfBudget:
        return Failed(share=share, cell=cell, window=window, tried=spent.count, cut=True)
    return proof_of(sought, share, steps, cells)


def alone(sought: Sought, share: Fraction) -> Proof | None:
    """Find ellipsoids for a share of the box as one cell."""
    ellipsoids = continued(sought, box_of(sought.problem, share), Chain(), Spent()).ellipsoids
    whole = len(ellipsoids) == len(sought.windows)
    return proof_of(sought, share, ".", (ellipsoids[::-1],)) if whole else None


def _still_holding(sought: Sought, cell: Cell, chain: Chain) -> Chain:
    """Keep the ellipsoids of the larger cell up to the first that the cell does not have.

    The tangents that enclose the numbers of a sample touch elsewhere for a smaller range, and may enclose more.
    """
    for number, each in enumerate(chain.ellipsoids):
        window = len(sought.windows) - 1 - number
        if each is None:
            continue
        loop = sought.loops(cell, window, Choice(each.pulse, each.near))(each.supply, each.settled)
        try:
            errors(sought.law, loop, each)
        except Refused:
            return replace(chain, ellipsoids=chain.ellipsoids[:number])
    return chain


def _alone(sought: Sought, cell: Cell, window: int, anew: Chain, spent: Spent) -> float:
    """Return how far an ellipsoid that need not hold any other goes to its limits."""
    return _excess(sought, cell, window, _in_time(sought, anew.choice), anew, spent)


def _middle_has(sought: Sought, cell: Cell, window: int, anew: Chain, spent: Spent) -> bool:
    """Whether the middle of a cell has an ellipsoid; no cell around it can do better."""
    middle = tuple(((low + high) / 2,) * 2 for low, high in cell)
    return (
        _alone(sought, middle, window, anew, spent) < 1.0
        or min(_excess(sought, middle, window, _in_time(sought, each), anew, spent) for each in CHOICES) < 1.0
    )


def _letter(sought: Sought, cell: Cell, window: int, anew: Chain, spent: Spent) -> str | None:
    """Return the range to halve: the widest if there is far to go, else that without which there is least."""
    widths = {
        letter: MATTERS[letter] * math.log(high / low)
        for letter, (low, high) in zip(LETTERS, cell, strict=True)
        if high / low > NARROWEST
    }
    if not widths:
        return None
    if _alone(sought, cell, window, anew, spent) > HOPELESS:
        return max(widths, key=lambda each: widths[each])
    left = {
        letter: _alone(sought, _without(cell, letter), window, anew, spent)
        for letter in widths
        if widths[letter] > WORTH * max(widths.values())
    }
    return min(left, key=lambda each: left[each])


def _without(cell: Cell, letter: str) -> Cell:
    """Return a cell with the middle of a range alone."""
    k = LETTERS.index(letter)
    middle = (cell[k][0] + cell[k][1]) / 2
    return (*cell[:k], (middle, middle), *cell[k + 1 :])


def _excess(sought: Sought, cell: Cell, window: int, choice: Choice, chain: Chain, spent: Spent) -> float:
    looked_at = cell, window, choice, chain.faster
    if looked_at not in spent.known:
        spent.one()
        loops = sought.loops(cell, window, choice)
        spent.known[looked_at] = excess(
            sought.law, loops, sought.conditions.supply, chain.faster, chain.hints
        )
    return spent.known[looked_at]


def largest_share(sought: Sought, most: float) -> Proof | Failed:
    """Find ellipsoids for the largest share of the box, in steps of :data:`SHARES`; none below the first.

    Parameters
    ----------
    sought : Sought
        What they are sought for.
    most : float
        Ellipsoids that may be sought for each share.
    """
    best = cover(sought, SHARES[-1], Spent(most))
    low, high = 0, len(SHARES) - 1  # numbers of shares: one that is covered, and one that may be
    while not isinstance(best, Proof) or best.share < 1:
        if low == high:
            break
        number = (low + high + 1) // 2
        found = cover(sought, SHARES[number - 1], Spent(most))
        if isinstance(found, Proof):
            low, best = number, found
        else:
            high = number - 1
    return best


def with_reserve(sought: Sought, most: float) -> Proof | None:
    """Find ellipsoids for the whole box, with the largest of :data:`RESERVES` for which there are some."""
    best = None
    for reserve in RESERVES:  # what has none with the smallest has none with a larger one
        conditions = sought.conditions._replace(reserve=reserve)
        found = cover(replace(sought, conditions=conditions), Fraction(1), Spent(most))
        if not isinstance(found, Proof):
            break
        best = found
    return best


def proof_of(
    sought: Sought, share: Fraction, steps: str, cells: Sequence[tuple[Ellipsoid | None, ...]]
) -> Proof:
    """Put a proof together."""
    conditions = sought.conditions
    return Proof(
        share=share,
        delay=conditions.delay,
        noise=conditions.noise,
        reserve=conditions.reserve,
        friction=sought.friction,
        steps=steps,
        cells=tuple(cells),
    )


def exactly(problem: Problem, law: BandLaw) -> Conditions:
    """Return a stop with the vehicle's dead time and exact speeds.

    The pressure of a main pipe comes close to the full one and never reaches it.
    """
    supply = Fraction(63, 64) if problem.vehicle.brake.build_up == "main-pipe" else Fraction(1)
    return Conditions(supply=supply, delay=least_delay(problem, law), noise=Fraction(0))
