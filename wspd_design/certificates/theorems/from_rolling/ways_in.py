"""Decide about a proof of the way from rolling into a band for all numbers of a box, in cells.

The box has all of friction and supply rate, and a share of the ranges of the other numbers. Steps divide it into
groups, and each group into cells. The wheels of a cell are followed over the slip until they are on the braking curve
(:mod:`filling`, :mod:`catching`); there those of all cells of a group are put together, and followed until they are in
the ellipsoids of the band (:mod:`settling`).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from wspd_design.certificates.kernel.checker import Refused, Work, number
from wspd_design.certificates.kernel.term import text
from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.slip_band.checker import checker as checker_of_band
from wspd_design.certificates.theorems.slip_band.friction import FRICTION
from wspd_design.certificates.theorems.slip_band.statement import LETTERS, NAMES, Cell, law_of
from wspd_design.certificates.theorems.slip_band.way_in import SUPPLY, around, asks_of, supply_rises
from wspd_design.controllers.protection import Protection
from wspd_design.parameters.bounds import Ends

if TYPE_CHECKING:
    from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between
    from wspd_design.certificates.theorems.from_rolling.settling import Plan, Settled, Start
    from wspd_design.certificates.theorems.slip_band.arrival import Asked

FORMAT = "wspd-ways-in/1"
CELLS = "cells of ways"  # name of their number
ALL = (*NAMES, SUPPLY)
EVERY = LETTERS + "s"
"""Which range a step halves, in the order of :data:`ALL`; a full stop is a cell."""
MOST_CELLS, MOST_LETTERS = 50_000, 60  # of a proof, of a number
AT_ONCE = 256  # cells that are followed together
WORK = 2_000, 400_000  # operations that a cell, and the wheels of a group, are worth
LATEST = 0.13  # -, slip at which cells end at the latest

Box: TypeAlias = tuple[Ends, ...]
"""Ranges of :data:`ALL`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Cells whose wheels are put together where they are on the braking curve."""

    steps: str
    plan: "Plan"


class Proof(NamedTuple):
    """A box in groups of cells."""

    share: Fraction
    until: float  # -, slip at which cells end
    steps: str  # into groups
    groups: tuple[Group, ...]


class Followed(NamedTuple):
    """What is shown of all wheels."""

    slip: float  # -, that is not exceeded
    time: float  # s, at most
    above: float  # -, beyond the reference at the end
    below: float
    supply: float  # -, at least
    speed: float  # m/s, at least


def write(proof: Proof, band: Mapping[str, Any]) -> dict[str, Any]:
    """Write a proof as JSON, with that of the band."""
    return {
        "format": FORMAT,
        "share": text(proof.share),
        "band": band,
        "until": text(Fraction(proof.until)),
        "steps": proof.steps,
        "groups": [
            {
                "steps": each.steps,
                "first": each.plan.first,
                "pull": text(Fraction(each.plan.until)),
                "last": each.plan.last,
                "halved": each.plan.halved,
            }
            for each in proof.groups
        ],
    }


def read(written: Mapping[str, Any]) -> Proof:
    """Read a proof, or refuse it."""
    keys = {"format", "share", "band", "until", "steps", "groups"}
    if written.keys() != keys or written["format"] != FORMAT:
        raise Refused(f"the proof does not have the format {FORMAT}")
    share, until, groups = _short(written["share"]), float(_short(written["until"])), written["groups"]
    if not 0 <= share <= 1:
        raise Refused("the share of the ranges is not between 0 and 1")
    if not 0.0 < until <= LATEST:
        raise Refused(f"cells must end at a slip between 0 and {LATEST:g}")
    if not isinstance(groups, list):
        raise Refused("the groups are no list")
    found = Proof(share, until, _steps(written["steps"]), tuple(_group(each) for each in groups))
    if sum(each.steps.count(".") for each in found.groups) > MOST_CELLS:
        raise Refused(f"the proof has more than {MOST_CELLS} cells")
    return found


def _group(written: object) -> Group:
    from wspd_design.certificates.theorems.from_rolling.settling import Plan

    if not isinstance(written, dict) or written.keys() != {"steps", "first", "pull", "last", "halved"}:
        raise Refused("a group needs steps, first, pull, last and halved")
    first, last, halved = written["first"], written["last"], written["halved"]
    if type(first) is not int or type(last) is not int:
        raise Refused("samples of a group are whole numbers")
    if not isinstance(halved, str) or not set(halved) <= set(EVERY) or len(halved) > len(EVERY):
        raise Refused("ranges that are halved at the end are unknown")
    return Group(
        steps=_steps(written["steps"]), plan=Plan(first, float(_short(written["pull"])), last, halved)
    )


def _steps(written: object) -> str:
    if not isinstance(written, str) or not set(written) <= {*EVERY, "."} or len(written) > 2 * MOST_CELLS:
        raise Refused("steps are letters of the ranges and full stops")
    return written


def _short(written: object) -> Fraction:
    if len(str(written)) > MOST_LETTERS:
        raise Refused(f"a number of the proof has more than {MOST_LETTERS} letters")
    return number(written)


def boxes_of(box: Box, steps: str) -> Iterator[Box]:
    """Yield the boxes that steps divide a box into, or refuse steps that do not end with all of it."""
    waiting = [box]
    for step in steps:
        if not waiting:
            raise Refused("the steps go on after the last cell")
        here = waiting.pop()
        if step == ".":
            yield here
        else:
            waiting += halves(here, step)[::-1]
    if waiting:
        raise Refused("the steps end before the last cell")


def halves(box: Box, letter: str) -> tuple[Box, Box]:
    """Both halves of a box, the lower one first; they share the middle."""
    k = EVERY.index(letter)
    low, high = box[k]
    middle = 0.5 * (low + high)
    return (*box[:k], (low, middle), *box[k + 1 :]), (*box[:k], (middle, high), *box[k + 1 :])


def box_around(problem: Problem) -> Box:
    """Return the box of a problem around its nominal numbers."""
    return tuple(problem.span(name) for name in ALL)


def speaks_about(problem: Problem) -> str:
    """Say why ways of all numbers are not followed for a law and a brake; empty if they are."""
    law, brake = law_of(problem.controller), problem.vehicle.brake
    if law.torque_slew is None or law.falls or law.dead_band or law.least_pulse:
        return "the law has no braking curve, or a slip that falls, a dead band or a shortest pulse"
    if brake.valve != "lag" or brake.build_up != "main-pipe" or brake.dead_time or brake.hold_leak:
        return "the valve has no lag alone, or the supply does not rise as that of a main pipe"
    if float(law.sample_time) > problem.span("fill time")[0]:
        return "the valve fills in less than a sample"
    return ""


def followed(problem: Problem, proof: Proof, asked: "Sequence[tuple[Cell, Asked]]", work: Work) -> Followed:
    """Return what is shown of all wheels of the box, or refuse the proof.

    Parameters
    ----------
    problem : Problem
        The box around the nominal numbers.
    proof : Proof
        Of that box.
    asked : sequence
        What the band asks for, in each of its cells.
    work : Work
        What may be spent.
    """
    from wspd_design.certificates.theorems.from_rolling.settling import settles

    reason = speaks_about(problem)
    if reason:
        raise Refused(reason)
    groups, shown = iter(proof.groups), []
    for box in boxes_of(box_around(problem), proof.steps):
        group = next(groups, None)
        if group is None:
            raise Refused("a part of the box has no group")
        cells = list(boxes_of(box, group.steps))
        work.spend(WORK[0] * len(cells) + WORK[1])
        start, time = started(problem, cells, proof.until)
        numbers = dict(zip(ALL, box, strict=True))
        settled = settles(problem, numbers, start, met_by(asked, box), group.plan)
        shown.append(_told(problem, box, start, time, settled))
    if next(groups, None) is not None:
        raise Refused("there are more groups than parts of the box")
    return Followed(
        slip=max(each.slip for each in shown),
        time=max(each.time for each in shown),
        above=max(each.above for each in shown),
        below=max(each.below for each in shown),
        supply=min(each.supply for each in shown),
        speed=min(each.speed for each in shown),
    )


def checker(problem: Problem, law: Protection) -> Callable[[Mapping[str, Any], Work], dict[str, float]]:
    """Return what decides about a proof and tells its numbers, those of the band among them."""

    def check(proof: Mapping[str, Any], work: Work) -> dict[str, float]:
        from wspd_design.certificates.theorems.slip_band.computed_law import unlike

        found = read(proof)
        near = around(problem, found.share)
        difference = unlike(near, law)
        if difference:
            raise Refused(difference)
        of_band: Any = proof["band"]
        if not isinstance(of_band, dict):
            raise Refused("the proof of the band is no object")
        band = checker_of_band(near, law)(of_band, work)
        told = followed(near, found, asks_of(near, of_band), work)
        supply_rises(near, of_band, told.supply, told.speed)
        low, high = near.span(FRICTION)
        return {
            **band,
            "share": float(found.share),
            CELLS: float(sum(each.steps.count(".") for each in found.groups)),
            "friction low": low,
            "friction high": high,
            "largest slip": told.slip,
            "time": told.time,
            "above": told.above,
            "below": told.below,
            "supply": told.supply,
            "speed": told.speed,
        }

    return check


def met_by(asked: "Sequence[tuple[Cell, Asked]]", box: Box) -> "list[Asked]":
    """What the cells of the band ask for that a box meets."""
    return [
        each
        for cell, each in asked
        if all(low <= end and start <= high for (low, high), (start, end) in zip(cell, box, strict=False))
    ]


def _told(problem: Problem, box: Box, start: "Start", time: float, settled: "Settled") -> Followed:
    """What is shown of the wheels of a group."""
    radius = box[ALL.index("wheel radius")][1]
    return Followed(
        slip=max(start.slip.high, settled.slip),
        time=time + settled.samples * float(law_of(problem.controller).sample_time),
        above=max(-settled.errors.low, 0.0) * radius / settled.speed,
        below=max(settled.errors.high, 0.0) * radius / settled.speed,
        supply=settled.supply,
        speed=settled.speed,
    )


def started(problem: Problem, cells: Sequence[Box], until: float) -> "tuple[Start, float]":
    """Return what wheels of some cells have together at the first sample beyond a slip, and when at the latest [s]."""
    found = [
        each
        for first in range(0, len(cells), AT_ONCE)
        for each in caught_of(problem, cells[first : first + AT_ONCE], until)
    ]
    if any(each is None for each in found):
        raise Refused("the wheels of a cell are lost")
    parts = [each for each in found if each is not None]
    law = law_of(problem.controller)
    return together([each for each, _ in parts]), max(time for _, time in parts) * float(law.sample_time)


def together(starts: "Sequence[Start]") -> "Start":
    """Return what holds of all wheels."""
    from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between
    from wspd_design.certificates.theorems.from_rolling.settling import Start

    def over(name: str) -> "Between":
        ends = [getattr(each, name) for each in starts]
        return Between(min(each.low for each in ends), max(each.high for each in ends))

    return Start(
        **{name: over(name) for name in ("z", "p", "error", "way", "slip", "speed")},
        room=min(each.room for each in starts),
        supply=min(each.supply for each in starts),
    )


def caught_of(problem: Problem, cells: Sequence[Box], until: float) -> "list[tuple[Start, float] | None]":
    """Return for each cell what its wheels have at the first sample beyond a slip, with samples since; None if lost."""
    from wspd_design.certificates.theorems.from_rolling.braked_wheel import Between, wheels_of
    from wspd_design.certificates.theorems.from_rolling.catching import caught
    from wspd_design.certificates.theorems.from_rolling.cells import gathered
    from wspd_design.certificates.theorems.from_rolling.filling import filled
    from wspd_design.certificates.theorems.from_rolling.sample import law_numbers
    from wspd_design.certificates.theorems.from_rolling.settling import Start

    exact = law_of(problem.controller)
    law, fastest = law_numbers(exact), problem.speeds[1]
    gotten = gathered([wheels_of(problem, exact, dict(zip(ALL, each, strict=True))) for each in cells])
    filling = filled(law, gotten, fastest)
    found = caught(law, gotten, filling, fastest, until)

    def between(name: str, k: int) -> "Between":
        ends = found.states[name]
        return Between(float(ends.low[k]), float(ends.high[k]))

    return [
        None
        if found.lost[k]
        else (
            Start(
                z=between("z", k),
                p=between("p", k),
                error=between("error", k),
                way=between("way", k),
                slip=Between(*found.slip),
                speed=Between(float(found.speed.low[k]), float(found.speed.high[k])),
                room=float(found.states["room"].low[k]),
                supply=float(found.supply[k]),
            ),
            float(found.time[k]),
        )
        for k in range(len(cells))
    ]
