"""Ellipsoids of one cell from the fastest window on, each in that of the next slower one; nothing here is trusted."""

import math
from dataclasses import dataclass, replace
from fractions import Fraction

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.slip_band.ellipsoids import Faster, Loops, ellipsoid, excess
from wspd_design.certificates.search.slip_band.task import settling
from wspd_design.certificates.theorems.slip_band.checker import errors, holds_more, lies_in
from wspd_design.certificates.theorems.slip_band.friction import REACHES, Parts, reached
from wspd_design.certificates.theorems.slip_band.loop import Conditions, Loop, Steady, loop_of
from wspd_design.certificates.theorems.slip_band.proof import ROOM, Choice, Ellipsoid
from wspd_design.certificates.theorems.slip_band.statement import BandLaw, Cell, windows_of
from wspd_design.parameters.errors import WspdError

PULSES = tuple(map(Fraction, ("1", "3/4", "5/8", "1/2", "1/4")))
"""Longest pulses that an ellipsoid is sought for; shorter ones leave less room, and less to be uncertain about."""
FITTED = 2  # times that the reach is fitted to the errors of an ellipsoid
MARGIN = 1.2  # times these, that the reach has at least
BEYOND = tuple(
    (Fraction(beyond), Fraction(curve)) for beyond, curve in (("3/2", "1"), ("3/2", "3/2"), ("2", "2"))
)
"""What may be wanted over what the longest pulse does, and predicted over where the braking curve begins."""
LONG = Fraction(
    45, 4
)  # 1/s, room for a long sample over its time: ten times what a supply of 1.125 1/s may rise by
LONGER = 4.0  # times as many ellipsoids may be sought for a box that is about to close
FIRST, NARROW, WIDEST = (Choice(Fraction(1, 2), near) for near in (1, 2, 0))


class OutOfBudget(WspdError):
    """More ellipsoids were sought than may be."""


class Spent:
    """Ellipsoids that were sought, how many may be, and how far those that were looked at go to their limits.

    More may be sought the more of the box has closed, up to :data:`LONGER` times as many.
    """

    def __init__(self, most: float = math.inf) -> None:
        self.most, self.count = most, 0
        self.closed = 0.0  # share of the box, each half of a cell counting as half of it
        self.window = 0  # in which one was sought last
        self.known: dict[object, tuple[float, tuple[float, float]]] = {}

    def one(self, window: int) -> None:
        """Count one more in a window, or end the search."""
        self.count, self.window = self.count + 1, window
        if self.count > self.most * max(1.0, LONGER * self.closed):
            raise OutOfBudget


@dataclass(frozen=True, slots=True, kw_only=True)
class Sought:
    """What ellipsoids are sought for."""

    problem: Problem
    law: BandLaw
    friction: tuple[Parts, ...]  # proved bounds for each window
    conditions: Conditions

    @property
    def windows(self) -> tuple[tuple[float, float], ...]:
        """Windows of speed, the slowest first."""
        return windows_of(self.problem)

    def loops(self, cell: Cell, window: int, choice: Choice) -> Loops:
        """Return the loop of a cell and a window for a share of the full pressure."""

        def loop(supply: Fraction) -> Loop:
            return loop_of(
                self.problem,
                self.law,
                cell,
                self.windows[window],
                self.friction[window],
                choice,
                self.conditions._replace(supply=supply),
            )

        return loop

    @property
    def room(self) -> Fraction:
        """Room above the cylinder over what the supply lacks: with as much a rising supply adds little to a pulse."""
        return max(ROOM, LONG * self.law.sample_time)

    @property
    def lags(self) -> tuple[Fraction, ...]:
        """Shares of what the lag of the filter drifts by, that may go with the steady drift, if there is one."""
        steady = not self.law.falls and not self.law.slip_error and not self.law.slip_drift
        return (Fraction(0), Fraction(1)) if steady else (Fraction(0),)

    def in_time(self, choice: Choice) -> Choice:
        """Shorten pulses so that they end in their sample, however late they begin."""
        return choice._replace(pulse=min(choice.pulse, 1 - self.conditions.delay))


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """Ellipsoids of a cell from the fastest window on, as far as they were found."""

    ellipsoids: tuple[Ellipsoid | None, ...] = ()
    steady: Steady | None = None  # drift in the window of the last
    choice: Choice  # for which the last was found; what errors are counted from is the same in all windows
    hints: tuple[int, ...] = ()

    @property
    def faster(self) -> Faster:
        """Ellipsoid that that of the next slower window must hold."""
        last = self.ellipsoids[-1] if self.ellipsoids else None
        return None if last is None or self.steady is None else (last, self.steady)


def begun(sought: Sought, cell: Cell, choice: Choice = FIRST) -> Chain:
    """Return a chain without ellipsoids that counts errors from where the loop settles at the lowest speeds.

    It keeps what of the lag goes with the steady drift in that choice.
    """

    def settled(like: Choice) -> Fraction:
        there = sought.in_time(like._replace(room=sought.room, lag=choice.lag))
        return settling(
            sought.law,
            lambda error: sought.loops(cell, 0, there._replace(settled=error))(sought.conditions.supply),
        )

    try:
        error = settled(NARROW)
    except Refused:  # it settles outside of that reach
        error = settled(WIDEST)
    return Chain(choice=choice._replace(settled=error, room=sought.room))


def continued(sought: Sought, cell: Cell, chain: Chain, spent: Spent) -> Chain:
    """Go on with the ellipsoids of a cell towards slower windows, as far as there are some."""
    while len(chain.ellipsoids) < len(sought.windows):
        window = left_of(sought, chain)
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


def left_of(sought: Sought, chain: Chain) -> int:
    """Return the window that a chain ends before, the slowest being 0; -1 if it is whole."""
    return len(sought.windows) - 1 - len(chain.ellipsoids)


def next_slower(sought: Sought, cell: Cell, window: int, chain: Chain, spent: Spent) -> Chain | None:
    """Add an ellipsoid to those of a cell: for the choice of the last one, or for the one that is best."""

    def tried(choice: Choice) -> Chain | None:
        spent.one(window)
        loops = sought.loops(cell, window, choice)
        try:
            found = ellipsoid(sought.law, loops, choice, sought.conditions.supply, chain.faster, chain.hints)
        except Refused:  # the loop settles outside of what is reached
            return None
        if found is None:
            return None
        ellipsoid_found, steady, hints = found
        return Chain(
            ellipsoids=(*chain.ellipsoids, ellipsoid_found), steady=steady, choice=choice, hints=hints
        )

    found = tried(sought.in_time(chain.choice))
    if found is None:
        choice, left = best(sought, cell, window, chain, spent)
        found = tried(choice) if left < 1.0 else None
    return found


def best(sought: Sought, cell: Cell, window: int, chain: Chain, spent: Spent) -> tuple[Choice, float]:
    """Return the choice for which an ellipsoid goes least far to its limits, and how far.

    That of the last ellipsoid is compared with those that have its reach or its pulse.
    """
    last, found = chain.choice, dict[Choice, tuple[float, tuple[float, float]]]()

    def least() -> Choice:
        return min(found, key=lambda each: found[each][0])

    def look_at(choice: Choice) -> None:
        choice = sought.in_time(choice)
        if choice not in found:
            found[choice] = reached_by(sought, cell, window, replace(chain, choice=choice), spent)

    usual = last._replace(beyond=Fraction(1), curve=Fraction(1))
    for each in (last, usual, *(usual._replace(pulse=pulse) for pulse in PULSES)):
        look_at(each)
    if math.isinf(found[least()][0]):
        look_at(usual._replace(near=WIDEST.near))
    for _ in range(FITTED):
        best_one = least()
        look_at(best_one._replace(near=_fitting(sought, best_one, found[best_one][1])))
    if found[least()][0] >= 1.0:
        # With limits that leave a share of what is asked there is more room, and less is sure.
        for beyond, curve in BEYOND:
            before = least()
            look_at(before._replace(pulse=Fraction(1), beyond=beyond, curve=curve))
            if before == least():
                break
    return least(), found[least()][0]


def _fitting(sought: Sought, choice: Choice, errors: tuple[float, float]) -> int:
    """Return the narrowest reach that some errors lie in, the widest if there is none."""
    turning = sought.problem.speeds[0] / sought.problem.span("wheel radius")[1]
    low, high = (MARGIN * each + float(choice.settled) for each in errors)
    fitting = [
        near
        for near in range(len(REACHES))
        if reached(near)[0] * turning <= low and high <= reached(near)[1] * turning
    ]
    return min(fitting, key=lambda near: reached(near)[1] - reached(near)[0], default=WIDEST.near)


def far(sought: Sought, cell: Cell, window: int, chain: Chain, spent: Spent) -> float:
    """Return by how much an ellipsoid for the choice of a chain would exceed its tightest limit, squared."""
    return reached_by(sought, cell, window, chain, spent)[0]


def reached_by(
    sought: Sought, cell: Cell, window: int, chain: Chain, spent: Spent
) -> tuple[float, tuple[float, float]]:
    """Return the same with the errors that the ellipsoid has."""
    choice = sought.in_time(chain.choice)
    looked_at = cell, window, choice, chain.faster
    if looked_at not in spent.known:
        spent.one(window)
        loops = sought.loops(cell, window, choice)
        try:
            found = excess(sought.law, loops, sought.conditions.supply, chain.faster, chain.hints)
        except Refused:
            found = math.inf, (-math.inf, math.inf)
        spent.known[looked_at] = found
    return spent.known[looked_at]


def still_holding(sought: Sought, cell: Cell, chain: Chain) -> Chain:
    """Keep the ellipsoids of a larger cell up to the first that the cell does not have.

    The tangents that enclose the numbers of a sample touch elsewhere for a smaller range, and may enclose more.
    """
    steady: Steady | None = None
    faster: Faster = None
    for number, each in enumerate(chain.ellipsoids):
        if each is None:
            continue
        window = len(sought.windows) - 1 - number
        loop = sought.loops(cell, window, each.choice)(each.supply)
        try:
            errors(sought.law, loop, each)
            held = faster is None or lies_in(faster, (each, loop.steady))
        except Refused:
            held = False
        if not held:
            return replace(chain, ellipsoids=chain.ellipsoids[:number], steady=steady)
        steady, faster = loop.steady, (each, loop.steady)
    return replace(chain, steady=steady)
