"""Decide about a proof of a band of slip: ellipsoids that no sample leads out of, in balls.

For each cell and window the proof states P, a share for each disturbance and alpha. With X'PX <= 1 and disturbances
within their bounds, the next state has X+'PX+ <= alpha X'PX + sum of the shares <= 1 if

    diag(alpha P, shares) - [A B]' P [A B]

is positive definite at all corners. Windows follow each other from the fastest to the slowest; the ellipsoid of a
faster one lies in that of the next. Between samples the error is bounded by the same state, with the torque in between.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

from wspd_design.certificates.kernel.arb import Ball, above, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.slip_loop import STATES, Matrix, corners, wanted
from wspd_design.certificates.theorems.slip_band.loop import Loop, loop_law, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Ellipsoid, read
from wspd_design.certificates.theorems.slip_band.statement import (
    LETTERS,
    BandLaw,
    box_of,
    halved,
    law_of,
    windows_of,
)
from wspd_design.controllers.protection import Protection

DIGITS = 128  # bits of the balls
WORK = 150_000  # operations on intervals that an ellipsoid is worth
PARTS = 4  # of a sample, for what happens within it


def checker(problem: Problem, law: Protection) -> Callable[[Mapping[str, Any], Work], dict[str, float]]:
    """Return what decides about a proof and tells its numbers."""

    def check(proof: Mapping[str, Any], work: Work) -> dict[str, float]:
        from flint import ctx

        with ctx.workprec(DIGITS):
            return _check(problem, law_of(law), proof, work)

    return check


def _check(problem: Problem, law: BandLaw, proof: Mapping[str, Any], work: Work) -> dict[str, float]:
    windows = windows_of(problem)
    found = read(proof, len(windows))
    waiting, cells = [box_of(problem)], iter(found.cells)
    bands = [0.0] * len(windows)
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
        slower = None
        for k, (window, friction, each) in enumerate(zip(windows, found.friction, ellipsoids, strict=True)):
            work.spend(WORK)
            loop = loop_of(problem, law, cell, window, friction)
            bands[k] = max(bands[k], above(largest_error(law, loop, each)))
            if slower is not None and not is_positive(_difference(each.matrix, slower.matrix)):
                raise Refused(
                    f"an ellipsoid at {window[1] * 3.6:.0f} km/h does not lie in the next slower one"
                )
            slower = each
    if waiting or next(cells, None) is not None:
        raise Refused("steps and cells do not match")
    radius = problem.span("wheel radius")[1]
    return {
        "cells": float(len(found.cells)),
        **{
            f"band {k}": above(point(band) * point(radius) / point(window[0]))
            for k, (band, window) in enumerate(zip(bands, windows, strict=True))
        },
        **{
            f"{name} {k} {end}": value
            for k, each in enumerate(found.friction)
            for name, ends in each._asdict().items()
            for end, value in zip(("low", "high"), ends, strict=True)
        },
    }


def _unknown() -> Sequence[Any]:
    raise Refused("a step is unknown")


def largest_error(law: BandLaw, loop: Loop, found: Ellipsoid) -> Ball:
    """Return a bound of the error of the wheel speed, also between samples [rad/s], or refuse the ellipsoid."""
    p = [[point(each) for each in row] for row in found.matrix]
    if not is_positive(p):
        raise Refused("a matrix P is not positive definite")
    shares = [point(each) for each in found.shares]
    if found.alpha < 0 or any(each < 0 for each in found.shares) or found.alpha + sum(found.shares) > 1:
        raise Refused("alpha and the shares of the disturbances add up to more than 1")
    used = [k for k, each in enumerate(loop.disturbances) if not each.is_zero()]
    if any(found.shares[k] == 0 for k in used):
        raise Refused("a disturbance has no share")
    numbers = loop_law(law)
    for matrix in corners(numbers, loop.ranges):
        if not is_positive(
            _left_over(p, point(found.alpha), [shares[k] for k in used], _scaled(matrix, loop, used))
        ):
            raise Refused("a sample may lead out of an ellipsoid")
    for limit in loop.limits:
        if not limit.bound > 0 or not reaches(p, limit.row) < limit.bound:
            raise Refused(f"the state may go beyond {limit.what}")
    largest = _within(numbers, loop, p)
    if not largest < loop.widest:
        raise Refused("the error may leave the range in which the slope of the friction is bounded")
    return largest


def reaches(p: Sequence[Sequence[Ball]], row: Sequence[Ball]) -> Ball:
    """Return the largest value of a linear function on X'PX <= 1."""
    from flint import arb_mat

    solved = arb_mat([list(each) for each in p]).solve(arb_mat([[each] for each in row]))
    return sum((each * solved[k, 0] for k, each in enumerate(row)), point(0)).sqrt()


def _within(law: Any, loop: Loop, p: Sequence[Sequence[Ball]]) -> Ball:
    """Bound the error at every instant of a sample, by parts of it in which phi and psi are enclosed."""
    h, (low, high) = law.sample_time, loop.ranges.secants
    asked, largest = wanted(law), point(0)
    for part in range(PARTS):
        begin, end = h * part / PARTS, h * (part + 1) / PARTS
        phis = [(q * t).exp() for q in (low, high) for t in (begin, end)]
        psis = (_psi(low, begin) / h, _psi(high, end) / h)
        for phi, psi, g, gone in product(
            (_least(phis), _most(phis)), psis, loop.ranges.effects, (point(0), _most(loop.ranges.parts))
        ):
            way = [each - (k == 3) for k, each in enumerate(asked[:STATES])]
            row = [phi * (k == 0) - g * psi * ((k == 3) + gone * each) for k, each in enumerate(way)]
            known, command, _, mean, _, _ = loop.disturbances
            disturbed = g * psi * (gone * (abs(asked[STATES]) * known + command) + mean)
            largest = largest.max(reaches(p, row) + disturbed)
    return largest


def _psi(q: Ball, span: Ball) -> Ball:
    return (q * span).expm1() / q


def _scaled(matrix: Matrix, loop: Loop, used: Sequence[int]) -> list[list[Ball]]:
    """[A B], each disturbance in terms of its bound."""
    return [[*row[:STATES], *(row[STATES + k] * loop.disturbances[k] for k in used)] for row in matrix]


def _left_over(
    p: Sequence[Sequence[Ball]], alpha: Ball, shares: Sequence[Ball], m: Sequence[Sequence[Ball]]
) -> list[list[Ball]]:
    """diag(alpha P, shares) - M'PM."""
    size = STATES + len(shares)
    pm = [
        [sum((p[i][k] * m[k][j] for k in range(STATES)), point(0)) for j in range(size)]
        for i in range(STATES)
    ]
    left = [[point(0)] * size for _ in range(size)]
    for i in range(size):
        for j in range(i + 1):
            value = -sum((m[k][i] * pm[k][j] for k in range(STATES)), point(0))
            if i < STATES:
                value += alpha * p[i][j]
            elif i == j:
                value += shares[i - STATES]
            left[i][j] = left[j][i] = value
    return left


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


def _difference(
    one: Sequence[Sequence[Fraction]], other: Sequence[Sequence[Fraction]]
) -> list[list[Fraction]]:
    return [[a - b for a, b in zip(*rows, strict=True)] for rows in zip(one, other, strict=True)]


def _least(balls: Sequence[Ball]) -> Ball:
    found = balls[0]
    for each in balls[1:]:
        found = found.min(each)
    return found


def _most(balls: Sequence[Ball]) -> Ball:
    return -_least([-each for each in balls])
