"""Decide about a proof of a band of slip: ellipsoids that no sample leads out of, in balls.

For each cell and window the proof states a center c, Q, alpha, a share for the way of the center and one for each
disturbance; the ellipsoid is (X - c)'Q^-1(X - c) <= 1. What disturbs lies between two bounds, so d = m + r z with
-1 <= z <= 1, and X+ - c = A (X - c) + o + B r z with o = A_c c - c + B_c m: the change of the torque at the center has
numbers of its own. The drift s of the torque that comes from the fading friction is nearly the same in the next sample;
the center, c for a stated drift n, moves with it: c + b (s - n), which adds A b + B_s - b times s - n, and b times what
s changes by. A stated share of what the reference drifts by counts as one with it.
From the ellipsoid the next state has at most alpha + sum of the shares <= 1 if

    Q - A Q A'/alpha - o o'/(share of o) - sum of B r r B'/share

is positive definite at all corners, with the columns of s among them. Windows follow each other from the fastest to the
slowest; the ellipsoid of a faster one lies in that of the next. Between samples the error is bounded by the same state,
with the torque in between.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from operator import mul
from typing import Any, NamedTuple

from wspd_design.certificates.kernel.arb import Ball, above, least_of, most_of, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.creep_slope import STEEPNESS
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    REFERENCE_DRIFT,
    STATES,
    LoopLaw,
    Pair,
    corners,
)
from wspd_design.certificates.theorems.slip_band.center import Lengths, about
from wspd_design.certificates.theorems.slip_band.friction import Parts
from wspd_design.certificates.theorems.slip_band.loop import Conditions, Loop, Steady, loop_of, spread_of
from wspd_design.certificates.theorems.slip_band.proof import Choice, Ellipsoid, Proof, read
from wspd_design.certificates.theorems.slip_band.pulses import loop_law
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    BandLaw,
    Cell,
    box_of,
    halved,
    law_of,
    windows_of,
)
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import Law
from wspd_design.parameters.records import Vehicle

DIGITS = 128  # bits of the balls
WORK = 10_000  # operations on intervals that an ellipsoid is worth
PARTS = 4  # of a sample, for what happens within it


def checker(
    problem: Problem, law: Law, *, reserved: bool = False
) -> Callable[[Mapping[str, Any], Work], dict[str, float]]:
    """Return what decides about a proof and tells its numbers; ``reserved``: it may keep a reserve of the brake."""

    def check(proof: Mapping[str, Any], work: Work) -> dict[str, float]:
        from flint import ctx

        with ctx.workprec(DIGITS):
            found = _check(problem, law, proof, work)
        if found["reserve"] < 1.0 and not reserved:
            raise Refused(
                "the proof leaves out where holding the reference takes more than a share of the full pressure"
            )
        return found

    return check


def _check(problem: Problem, controller: Law, proof: Mapping[str, Any], work: Work) -> dict[str, float]:
    law, windows = law_of(controller), windows_of(problem)
    found = read(proof, len(windows))
    if found.delay < least_delay(problem.vehicle, law.sample_time):
        raise Refused("the valves of the vehicle begin later than the proof allows")
    if found.noise and not isinstance(controller, Protection):
        raise Refused("the law was compared with what it declares for speeds without noise")
    if isinstance(controller, Protection) and not (
        Fraction(controller.cut_out_speed) + found.noise <= Fraction(problem.speeds[0])
    ):
        raise Refused("with this noise the law may hold its valves inside the range of speed")
    waiting, cells = [box_of(problem, found.share)], iter(found.cells)
    bands: list[Pair | None] = [None] * len(windows)
    supplies = [Fraction(0)] * len(windows)
    for step in found.steps:
        if not waiting:
            raise Refused("the steps go on after the last cell")
        cell = waiting.pop()
        if step != ".":
            waiting += halved(cell, step)[::-1] if step in LETTERS else _unknown()
            continue
        ellipsoids = next(cells, None)
        if ellipsoids is None:
            raise Refused("a cell has no ellipsoids")
        slower: tuple[Ellipsoid, Steady] | None = None
        for k, (window, friction, each) in enumerate(zip(windows, found.friction, ellipsoids, strict=True)):
            work.spend(WORK)
            if each is None:
                if slower is not None:
                    raise Refused("a window without ellipsoids stands after a slower one that has some")
                if not holds_more(problem, law, cell, window, friction, found.reserve):
                    raise Refused(
                        "in a window without ellipsoids holding the reference may take less than is claimed"
                    )
                continue
            loop = _loop(problem, law, found, (cell, k), each)
            bands[k] = _joined(bands[k], errors(law, loop, each))
            supplies[k] = max(supplies[k], each.supply)
            if slower is not None and not lies_in((each, loop.steady), slower):
                raise Refused(
                    f"an ellipsoid at {window[1] * 3.6:.0f} km/h does not lie in the next slower one"
                )
            slower = each, loop.steady
    if waiting or next(cells, None) is not None:
        raise Refused("steps and cells do not match")
    radius = point(problem.span("wheel radius")[1])
    return {
        "share": float(found.share),
        "cells": float(len(found.cells)),
        "delay": float(found.delay * law.sample_time),
        "noise": float(found.noise),
        "reserve": float(found.reserve),
        **{f"supply {k}": above(point(each)) for k, each in enumerate(supplies)},
        **{
            f"band {k} {side}": max(above(radius * largest / point(window[0])), 0.0)
            for k, (band, window) in enumerate(zip(bands, windows, strict=True))
            if band is not None
            for side, largest in zip(("below", "above"), (band[1], -band[0]), strict=True)
        },
        **{
            f"{name} {part} {k} {end}": value
            for k, parts in enumerate(found.friction)
            for part, each in enumerate(parts)
            for name, ends in ((STEEPNESS, each.steepness), *each.friction.named.items())
            for end, value in zip(("low", "high"), ends, strict=True)
        },
    }


def _loop(
    problem: Problem,
    law: BandLaw,
    found: Proof,
    at: tuple[Cell, int],
    each: Ellipsoid,
    speeds: tuple[float, float] | None = None,
) -> Loop:
    """Work out the loop of an ellipsoid in a cell and a window, or at some of its speeds."""
    cell, k = at
    conditions = Conditions(each.supply, found.delay, found.noise, found.reserve)
    window = windows_of(problem)[k] if speeds is None else speeds
    return loop_of(problem, law, cell, window, found.friction[k], each.choice, conditions)


def steady_of(
    problem: Problem,
    found: Proof,
    at: tuple[Cell, int],
    each: Ellipsoid,
    speeds: tuple[float, float] | None = None,
) -> Steady:
    """Return the steady drift of the torque that an ellipsoid is about, in a cell and a window or a part of them."""
    from flint import ctx

    with ctx.workprec(DIGITS):
        return _loop(problem, law_of(problem.controller), found, at, each, speeds).steady


def holds_more(
    problem: Problem,
    law: BandLaw,
    cell: Cell,
    window: tuple[float, float],
    friction: Parts,
    reserve: Fraction,
) -> bool:
    """Whether holding the reference takes more than a share of the full pressure, everywhere in cell and window."""
    exact = Conditions(supply=Fraction(1), delay=Fraction(0), noise=Fraction(0))
    loop = loop_of(problem, law, cell, window, friction, Choice(Fraction(1), 0), exact)
    return reserve < 1 and loop.holding > reserve


def least_delay(vehicle: Vehicle, sample_time: Fraction) -> Fraction:
    """Dead time of the vehicle's valves, over the sample time."""
    return Fraction(vehicle.brake.dead_time) / sample_time


def _joined(one: Pair | None, other: Pair) -> Pair:
    return other if one is None else (one[0].min(other[0]), one[1].max(other[1]))


def _unknown() -> Sequence[Any]:
    raise Refused("a step is unknown")


def errors(law: BandLaw, loop: Loop, found: Ellipsoid) -> Pair:
    """Return between what the error of the wheel speed stays, also between samples [rad/s], or refuse the ellipsoid."""
    q, center = _balls(found.matrix), [point(each) for each in found.center]
    if not is_positive(q):
        raise Refused("a matrix Q is not positive definite")
    loop = about(law, loop, center, Lengths(found.shortest, found.longest, found.back))
    spread = [spread_of(each) for each in loop.disturbances]
    steady, moves = loop.steady, [point(each) for each in found.moves]
    away, rises = steady.away(point(found.drift)), spread_of(steady.change)
    shares = (found.offset, *found.shares, found.steady, found.change)
    if found.alpha <= 0 or any(each < 0 for each in shares) or found.alpha + sum(shares) > 1:
        raise Refused(
            "alpha and the shares of the disturbances add up to more than 1, or alpha is not positive"
        )
    if found.offset == 0 or any(
        s == 0 and not r.is_zero() for s, r in zip(shares[1:], [*spread, away, rises], strict=True)
    ):
        raise Refused("a disturbance has no share")
    blocks = [[each / point(found.alpha) for each in row] for row in q]
    blocks += [
        [point(0) if r.is_zero() else r * r / point(s)] for s, r in zip(found.shares, spread, strict=True)
    ]
    drifts = [each * point(found.drift) for each in drifting(steady)]
    settled = [
        *center,
        *((low + high) / 2 + s for (low, high), s in zip(loop.disturbances, drifts, strict=True)),
    ]
    if not all(is_positive(each) for each in _left_over(law, loop, found, q, settled, blocks)):
        raise Refused("a sample may lead out of an ellipsoid")
    there = Set(q, center, [each * away for each in moves])
    beyond = beyond_limit(loop, there)
    if beyond:
        raise Refused(f"the state may go beyond {beyond}")
    lowest, highest = (point(found.settled) + each for each in _within(loop_law(law), loop, there))
    if not highest < loop.widest[1] or not loop.widest[0] < lowest:
        raise Refused("the error may leave the range in which the slope of the friction is bounded")
    return lowest, highest


class Set(NamedTuple):
    """States of an ellipsoid, its center anywhere on a line."""

    matrix: Sequence[Sequence[Ball]]  # Q
    center: Sequence[Ball]  # in the middle of the line
    moved: Sequence[Ball]  # from there to either end

    def at(self, row: Sequence[Ball]) -> Ball:
        """Return the value of a linear function in the middle."""
        return _product(row, self.center)

    def reach(self, row: Sequence[Ball]) -> Ball:
        """Return by how much its largest value is more, and its smallest one less."""
        return reaches(self.matrix, row) + abs(_product(row, self.moved))


def drifting(steady: Steady) -> list[Ball]:
    """Return what the disturbances have of a steady drift of 1."""
    share = {"torque drift": point(1), "mean torque drift": steady.share, REFERENCE_DRIFT: steady.lag}
    return [share.get(name, point(0)) for name in DISTURBANCES]


def _left_over(
    law: BandLaw,
    loop: Loop,
    found: Ellipsoid,
    q: Sequence[Sequence[Ball]],
    settled: Sequence[Ball],
    blocks: Sequence[Sequence[Ball]],
) -> Iterator[list[list[Ball]]]:
    """Yield Q - A Q A'/alpha - o o'/(share of o) - sum of B r r B'/share at all corners.

    ``settled`` are the center and the middle of what disturbs; ``blocks`` the rows of Q/alpha, and r^2/share.
    """
    from flint import arb_mat

    size = len(settled)
    moves, steady = [point(each) for each in found.moves], loop.steady
    with_drift = arb_mat([[each] for each in (*moves, *drifting(steady))])
    b = arb_mat([[each] for each in moves])
    diagonal = arb_mat(size, size)
    for i, row in enumerate(blocks):
        for j, each in enumerate(row):
            diagonal[i, j if i < STATES else i] = each
    whole, at = arb_mat([list(row) for row in q]), arb_mat([[each] for each in settled])
    # The center of the next sample: that of the same drift, and what it moves as the drift changes.
    center = arb_mat([[point(c) + move * steady.rise] for c, move in zip(found.center, moves, strict=True)])
    units = [arb_mat([[int(i == j) for j in range(size)]]) for i in range(size)]
    away = steady.away(point(found.drift))
    if found.change:  # the same at all corners
        rises = spread_of(steady.change)
        whole -= b * b.transpose() * (rises * rises / point(found.change))
    for rest, of_center in corners(loop_law(law), loop.ranges, units):
        ab = arb_mat([row.entries() for row in rest])
        o = arb_mat([[(row * at)[0, 0]] for row in of_center]) - center
        left = whole - ab * diagonal * ab.transpose() - o * o.transpose() / point(found.offset)
        if found.steady:
            drifted = (ab * with_drift - b) * away
            left -= drifted * drifted.transpose() / point(found.steady)
        yield left.tolist()


def beyond_limit(loop: Loop, states: Set) -> str:
    """Return which limit a state may exceed, or nothing."""
    for limit in loop.limits:
        if not states.at(limit.row) + states.reach(limit.row) < limit.bound:
            return limit.what
    return ""


def reaches(q: Sequence[Sequence[Ball]], row: Sequence[Ball]) -> Ball:
    """Return the largest value of a linear function on X'Q^-1 X <= 1."""
    return _product(row, [_product(row, each) for each in q]).sqrt()


def _product(one: Sequence[Ball], other: Sequence[Ball]) -> Ball:
    return sum(map(mul, one, other), point(0))


def lies_in(faster: tuple[Ellipsoid, Steady], slower: tuple[Ellipsoid, Steady]) -> bool:
    """Whether one ellipsoid lies in another: 1 - (X-c)'P(X-c) of the slower one is at least t times that of the faster.

    Both count errors from the same one, and where both hold there is one steady drift. With D the center of the faster
    one less that of the slower one, that is Qs - Qf/t - D D'/(1 - t) positive definite, at both ends of that drift.
    """
    (inner, _), (outer, _) = faster, slower
    t = outer.inside
    return (
        inner.settled == outer.settled
        and 0 < t < 1
        and all(
            is_positive(
                [
                    [
                        s - f / point(t) - one * other / (1 - point(t))
                        for s, f, other in zip(*rows, apart, strict=True)
                    ]
                    for *rows, one in zip(_balls(outer.matrix), _balls(inner.matrix), apart, strict=True)
                ]
            )
            for apart in centers_apart(faster, slower)
        )
    )


def centers_apart(faster: tuple[Ellipsoid, Steady], slower: tuple[Ellipsoid, Steady]) -> Iterator[list[Ball]]:
    """Yield the center of one ellipsoid less that of another at the least and the largest drift that both know."""
    steadies = faster[1], slower[1]
    for drift in (most_of([each.low for each in steadies]), least_of([each.high for each in steadies])):
        one, other = (
            [
                point(c) + point(b) * (drift - point(found.drift))
                for c, b in zip(found.center, found.moves, strict=True)
            ]
            for found, _ in (faster, slower)
        )
        yield [a - b for a, b in zip(one, other, strict=True)]


def _balls(matrix: Sequence[Sequence[Fraction]]) -> list[list[Ball]]:
    return [[point(each) for each in row] for row in matrix]


def _within(law: LoopLaw, loop: Loop, states: Set) -> Pair:
    """Bound the error at every instant of a sample, by parts of it in which phi and psi are enclosed."""
    h, (low, high) = law.sample_time, loop.ranges.secants
    lowest, highest = states.center[0], states.center[0]
    farthest = most_of([end for each in loop.pulses for end in each.parts])
    _, _, _, mean, turning, _, moved, uneven, *_ = (a.union(b) for a, b in loop.disturbances)
    steady = loop.steady.low.union(loop.steady.high)
    mean += loop.steady.share * steady
    mean += loop.ranges.brought[DISTURBANCES.index("mean torque drift")] * (
        turning + loop.steady.lag * steady
    )
    for part in range(PARTS):
        begin, end = h * part / PARTS, h * (part + 1) / PARTS
        phis = [(q * t).exp() for q in (low, high) for t in (begin, end)]
        psis = (_psi(low, begin) / h, _psi(high, end) / h)
        for phi, psi, g, gone, (asked, beside) in product(
            (least_of(phis), most_of(phis)), psis, loop.ranges.effects, (point(0), farthest), loop.wants
        ):
            way = [each - (k == 3) for k, each in enumerate(asked)]
            row = [phi * (k == 0) - g * psi * ((k == 3) + gone * each) for k, each in enumerate(way)]
            # A part of the sample has seen at most the drift of the whole one.
            disturbed = (
                -g * psi * (gone * (loop.dead_band + beside[0].union(beside[1])) - mean.union(point(0)))
            )
            disturbed += (moved + uneven).union(point(0))
            there = states.at(row) + disturbed
            reach = states.reach(row)
            lowest, highest = lowest.min(there - reach), highest.max(there + reach)
    return lowest, highest


def _psi(q: Ball, span: Ball) -> Ball:
    return (q * span).expm1() / q


def inverse(matrix: Sequence[Sequence[Fraction]]) -> list[list[float]]:
    """Return P = Q^-1 in doubles, worked out in balls."""
    from flint import arb_mat, ctx

    with ctx.workprec(DIGITS):
        found = arb_mat([[point(each) for each in row] for row in matrix]).inv()
        return [[float(each.mid()) for each in row] for row in found.tolist()]


def is_positive(matrix: Sequence[Sequence[Any]]) -> bool:
    """Whether the pivots of LDL' are positive."""
    a = [list(row) for row in matrix]
    size = len(a)
    for k in range(size):
        pivot = a[k][k]
        if not pivot > 0:
            return False
        for i in range(k + 1, size):
            factor = a[i][k] / pivot
            for j in range(k + 1, i + 1):
                a[i][j] = a[i][j] - factor * a[j][k]
                a[j][i] = a[i][j]
    return True
