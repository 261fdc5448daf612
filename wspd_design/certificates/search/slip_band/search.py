"""Search for a cover of the box by cells that have an ellipsoid in every window; nothing here is trusted."""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.slip_band.chain import (
    FIRST,
    Chain,
    OutOfBudget,
    Sought,
    Spent,
    begun,
    best,
    continued,
    far,
    left_of,
    still_holding,
)
from wspd_design.certificates.theorems.slip_band.attempt import Attempt
from wspd_design.certificates.theorems.slip_band.checker import least_delay
from wspd_design.certificates.theorems.slip_band.loop import Conditions
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid, Proof
from wspd_design.certificates.theorems.slip_band.statement import LETTERS, BandLaw, Cell, box_of, halved
from wspd_design.parameters.records import Vehicle

NARROWEST = 1.02  # ratio of the ends of a range that is not worth halving
SHARES = tuple(Fraction(k, 8) for k in range(1, 9))
RESERVES = tuple(map(Fraction, ("0.5", "0.6", "0.7", "0.75", "0.8", "0.85")))
HOPELESS = 1.4  # square of what is reached over what limits leave, from which on the widest range is halved
BINDS = (
    1.1  # of the same without the ellipsoid of the next faster window, from which on that one is in the way
)
WORTH = 0.3  # of the widest range, that another one has at least to be looked at
MATTERS = {"m": 1.0, "i": 1.0, "r": 2.0, "u": 1.0, "t": 1.0, "f": 0.3, "v": 0.3}
"""How much the logarithm of a range spreads the loop."""


def cover(sought: Sought, share: Fraction, spent: Spent) -> Proof | Attempt:
    """Find ellipsoids for a share of each range of the box, around its nominal value."""
    waiting: list[tuple[Cell, Chain | None, float]] = [(box_of(sought.problem, share), None, 1.0)]
    cells: list[tuple[Ellipsoid | None, ...]] = []
    steps = ""
    try:
        while waiting:
            cell, inherited, part = waiting.pop()
            chain = _chain(sought, cell, inherited, spent)
            window = left_of(sought, chain)
            if window < 0:
                steps, cells = f"{steps}.", [*cells, chain.ellipsoids[::-1]]
                spent.closed += part
                continue
            anew = begun(sought, cell, chain.choice)
            anew = replace(anew, choice=best(sought, cell, window, anew, spent)[0])
            letter = None
            if _middle_has(sought, cell, window, anew, spent):
                letter = _letter(sought, cell, window, anew, spent)
            if letter is None:
                return Attempt(share=share, steps=steps, window=window, tried=spent.count, cut=False)
            steps += letter
            waiting += [(half, chain, part / 2.0) for half in halved(cell, letter)[::-1]]
    except OutOfBudget:
        return Attempt(share=share, steps=steps, window=spent.window, tried=spent.count, cut=True)
    return proof_of(sought, share, steps, cells)


def _chain(sought: Sought, cell: Cell, inherited: Chain | None, spent: Spent) -> Chain:
    """Go on with the ellipsoids of the larger cell; if faster ones bind, let the lag go with the steady drift."""
    chain = _carried_on(sought, cell, inherited, spent)
    window, lags = left_of(sought, chain), [each for each in sought.lags if each > chain.choice.lag]
    if window < 0 or not lags:
        return chain

    def ahead(one: Chain) -> tuple[int, float]:
        return -left_of(sought, one), -far(sought, cell, window, one, spent)

    anew = begun(sought, cell, chain.choice)
    if far(sought, cell, window, chain, spent) < BINDS * far(sought, cell, window, anew, spent):
        return chain
    others = [continued(sought, cell, begun(sought, cell, FIRST._replace(lag=each)), spent) for each in lags]
    return max((chain, *others), key=ahead)


def _carried_on(sought: Sought, cell: Cell, inherited: Chain | None, spent: Spent) -> Chain:
    """Go on with the ellipsoids of the larger cell, or begin anew where they are in the way."""
    if inherited is None:
        return continued(sought, cell, begun(sought, cell), spent)
    chain = continued(sought, cell, still_holding(sought, cell, inherited), spent)
    window = left_of(sought, chain)
    if window < 0 or not inherited.ellipsoids:
        return chain
    # Faster windows may have smaller ellipsoids for the first choice than for the last one.
    anew = begun(sought, cell, chain.choice)
    if far(sought, cell, window, anew, spent) >= 1.0:
        return chain
    found = continued(sought, cell, begun(sought, cell, FIRST._replace(lag=chain.choice.lag)), spent)
    return found if left_of(sought, found) < 0 else continued(sought, cell, anew, spent)


def alone(sought: Sought, share: Fraction) -> Proof | None:
    """Find ellipsoids for a share of the box as one cell."""
    cell = box_of(sought.problem, share)
    ellipsoids = continued(sought, cell, begun(sought, cell), Spent()).ellipsoids
    whole = len(ellipsoids) == len(sought.windows)
    return proof_of(sought, share, ".", (ellipsoids[::-1],)) if whole else None


def _middle_has(sought: Sought, cell: Cell, window: int, anew: Chain, spent: Spent) -> bool:
    """Whether the middle of a cell has an ellipsoid; no cell around it can do better."""
    middle = tuple(((low + high) / 2,) * 2 for low, high in cell)
    anew = begun(sought, middle, anew.choice)
    return best(sought, middle, window, anew, spent)[1] < 1.0


def _letter(sought: Sought, cell: Cell, window: int, anew: Chain, spent: Spent) -> str | None:
    """Return the range to halve: the widest if there is far to go, else that without which there is least."""
    widths = {
        letter: MATTERS[letter] * math.log(high / low)
        for letter, (low, high) in zip(LETTERS, cell, strict=True)
        if high / low > NARROWEST
    }
    if not widths:
        return None
    if far(sought, cell, window, anew, spent) > HOPELESS:
        return max(widths, key=lambda each: widths[each])
    left = {
        letter: far(sought, _without(cell, letter), window, anew, spent)
        for letter in widths
        if widths[letter] > WORTH * max(widths.values())
    }
    return min(left, key=lambda each: left[each])


def _without(cell: Cell, letter: str) -> Cell:
    """Return a cell with the middle of a range alone."""
    k = LETTERS.index(letter)
    middle = (cell[k][0] + cell[k][1]) / 2
    return (*cell[:k], (middle, middle), *cell[k + 1 :])


def largest_share(sought: Sought, most: float) -> tuple[Proof | None, Attempt | None]:
    """Find ellipsoids for the largest share of the box, in steps of :data:`SHARES`; none below the first.

    The smallest share that was tried in vain is returned beside it.

    Parameters
    ----------
    sought : Sought
        What they are sought for.
    most : float
        Ellipsoids that may be sought for each share.
    """
    largest: Proof | None = None
    failed: Attempt | None = None
    low, high = 0, len(SHARES)  # numbers of shares: one that is covered, and one that may be
    number = high
    while low < high:
        found = cover(sought, SHARES[number - 1], Spent(most))
        if isinstance(found, Proof):
            low, largest = number, found
        else:
            high, failed = number - 1, found
        number = (low + high + 1) // 2
    return largest, failed


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
    """Return a stop of the vehicle and law with exact speeds."""
    return usual(problem.vehicle, law.sample_time)


def usual(vehicle: Vehicle, sample_time: Fraction) -> Conditions:
    """Return a stop with the vehicle's dead time and exact speeds.

    The pressure of a main pipe comes close to the full one and never reaches it.
    """
    supply = Fraction(63, 64) if vehicle.brake.build_up == "main-pipe" else Fraction(1)
    return Conditions(supply=supply, delay=least_delay(vehicle, sample_time), noise=Fraction(0))
