"""A common quadratic Lyapunov function: found in doubles, shown in exact arithmetic.

In x = (y, t), y = v e the error of the sliding speed [m/s] and t the error of the torque over T_max, a static law
with torque feedback makes x' = A x with

    A = [[q, -gamma], [kappa/tau, -(1 + K)/tau]],   q = p - a/v,   gamma = R T_max / (inertia of the wheelset).

The deceleration a enters because v changes while e does; only the difference q of slip pole p and a/v matters, so
that the polytope of (p, a/v) becomes an interval. A is affine in q and gamma: one P with A'P + PA < -2 alpha P at
the four vertices serves for every course of q and gamma in between.

With the command held over a sample, x -> x exp(A) is not affine in q: the interval of q is covered by parts whose
matrix exponential is enclosed. It is affine in gamma, and x'Px is convex, so that the two ends of gamma suffice.
"""

import json
import re
import time
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.arb import Ball, ball, point
from wspd_design.certificates.kernel.checker import Verdict
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.plant import Values, plant_dynamics, plant_forces, plant_variables
from wspd_design.controllers.torque_feedback import TorqueFeedback
from wspd_design.model.number import Number

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FORMAT = "wspd-quadratic/1"
STATEMENT = "one quadratic function falls along the continuous and the sampled loop"
MOST_BYTES = 4_000_000
MOST_DIGITS = 60  # of a number in a certificate
NUMBER = re.compile(r"-?[0-9]+(/[0-9]+)?")
MOST_PARTS = 20_000  # of the interval of q

Interval: TypeAlias = tuple[Fraction, Fraction]
Symmetric: TypeAlias = tuple[Any, Any, Any]
"""Entries 11, 12, 22 of a symmetric matrix."""
Matrix: TypeAlias = tuple[tuple[Any, Any], tuple[Any, Any]]


class Loop(NamedTuple):
    """Exact numbers of a loop with torque feedback."""

    gamma: Interval  # m/s2 per duty, R T_max / inertia
    lag: Fraction  # s
    sliding_gain: Fraction  # duty per m/s, kappa
    torque_gain: Fraction  # -, K
    sample_time: Fraction  # s


@dataclass(frozen=True, slots=True, kw_only=True)
class Quadratic:
    """V = x'Px with its guaranteed decay, for the continuous loop and for the sampled one."""

    poles: Interval  # of q, 1/s
    continuous: Symmetric
    decay: Fraction  # 1/s, V falls at least as exp(-2 decay t)
    sampled: Symmetric
    contraction: Fraction  # V falls at least by this factor squared per sample


def loop_of(problem: Problem, law: TorqueFeedback) -> Loop:
    """Exact numbers of the loop."""
    brake = problem.vehicle.brake
    torque = Fraction(problem.vehicle.wheel_radius) * Fraction(brake.max_torque)
    light, heavy = (Fraction(each) for each in problem.inertia_bounds)
    # The law counts in its own T_max.
    share = Fraction(brake.max_torque) / Fraction(law.vehicle.brake.max_torque)
    return Loop(
        gamma=(torque / heavy, torque / light),
        lag=Fraction(max(brake.fill_time, brake.vent_time)),
        sliding_gain=Fraction(law.gains.sliding_gain),
        torque_gain=Fraction(law.gains.torque_gain) * share,
        sample_time=Fraction(problem.sample_time),
    )


def pole_claim(problem: Problem, relation: Relation, bound: Fraction) -> Claim:
    """Claim that q = p - a/v stays on one side of a bound, on the domain with the slip at its reference."""

    def difference(values: Values) -> Number:
        plant = plant_dynamics(problem, values)
        return plant.pole - plant.deceleration / values["speed"]

    def arranged(values: Values) -> Number:
        plant = plant_forces(problem, values)
        return plant.pole - plant.deceleration / values["speed"]

    return Claim(
        name="slip pole less a/v",
        variables=plant_variables(problem, slip=problem.slip),
        expression=difference,
        form=arranged,
        relation=relation,
        bound=bound,
        unit="1/s",
    )


def rates(loop: Loop, q: Any, gamma: Any) -> Matrix:
    """Matrix A of x' = A x."""
    return ((q, -gamma), (loop.sliding_gain / loop.lag, -(1 + loop.torque_gain) / loop.lag))


def decays(p: Symmetric, a: Matrix, decay: Any) -> Symmetric:
    """Return -(A'P + PA) - 2 decay P, which must be positive definite."""
    p11, p12, p22 = p
    (a11, a12), (a21, a22) = a
    return (
        -2 * (p11 * a11 + p12 * a21) - 2 * decay * p11,
        -(p11 * a12 + p12 * a22 + p12 * a11 + p22 * a21) - 2 * decay * p12,
        -2 * (p12 * a12 + p22 * a22) - 2 * decay * p22,
    )


def contracts(p: Symmetric, a: Matrix, contraction: Any) -> Symmetric:
    """Return contraction^2 P - A'PA, which must be positive definite."""
    p11, p12, p22 = p
    (a11, a12), (a21, a22) = a
    left = (p11 * a11 + p12 * a21, p12 * a11 + p22 * a21)
    right = (p11 * a12 + p12 * a22, p12 * a12 + p22 * a22)
    kept = contraction * contraction
    return (
        kept * p11 - (a11 * left[0] + a21 * left[1]),
        kept * p12 - (a12 * left[0] + a22 * left[1]),
        kept * p22 - (a12 * right[0] + a22 * right[1]),
    )


def is_positive(p: Symmetric) -> bool:
    """Whether a symmetric matrix is positive definite for certain: the pivots of LDL' are positive."""
    p11, p12, p22 = p
    return bool(p11 > 0) and bool(p22 - p12 * p12 / p11 > 0)


def held(loop: Loop, q: Ball, gamma: Ball) -> Matrix:
    """Enclose the matrix from one sample to the next, with the command held in between."""
    from flint import arb_mat

    lag, span = point(loop.lag), point(loop.sample_time)
    zero = point(0.0)
    generator = arb_mat([[q, -gamma, zero], [zero, -1 / lag, 1 / lag], [zero, zero, zero]])
    step = (generator * span).exp()
    kappa, back = point(loop.sliding_gain), point(loop.torque_gain)
    return (
        (step[0, 0] + step[0, 2] * kappa, step[0, 1] - step[0, 2] * back),
        (step[1, 0] + step[1, 2] * kappa, step[1, 1] - step[1, 2] * back),
    )


def check_quadratic(certificate: str, problem: Problem) -> Verdict:
    """Decide whether a certificate shows a common quadratic Lyapunov function of a loop.

    Plant, law, lag and sample time come from the problem, never from the certificate. Only fractions and
    python-flint's balls are used.

    Parameters
    ----------
    certificate : str
        JSON text; it may be anything.
    problem : Problem
        The loop, with a :class:`TorqueFeedback` as controller.
    """
    started = time.perf_counter()
    parts, reason = 0, "the function falls on the whole polytope, continuous and sampled"
    try:
        parts = _replay(certificate, problem)
    except Refused as refusal:
        reason = str(refusal)
    return Verdict(
        accepted=parts > 0,
        statement=STATEMENT if parts else "",
        reason=reason,
        leaves=parts,
        seconds=time.perf_counter() - started,
    )


def certificate_text(found: Quadratic, proofs: tuple[str, str]) -> str:
    """Write a certificate; ``proofs`` show the lower and the upper end of the interval of q."""
    content = {
        "format": FORMAT,
        "poles": [str(each) for each in found.poles],
        "proofs": list(proofs),
        "continuous": [str(each) for each in found.continuous],
        "decay": str(found.decay),
        "sampled": [str(each) for each in found.sampled],
        "contraction": str(found.contraction),
    }
    return json.dumps(content, indent=1)


def _replay(certificate: str, problem: Problem) -> int:
    law = problem.controller
    if not isinstance(law, TorqueFeedback):
        raise Refused("the controller is no static law with torque feedback")
    if law.gains.slip_reference != problem.slip:
        raise Refused("the problem speaks about another slip than the reference of the law")
    found, proofs = _read(certificate)
    relations: tuple[Relation, Relation] = (">=", "<=")
    for relation, bound, proof in zip(relations, found.poles, proofs, strict=True):
        verdict = checker.check(pole_claim(problem, relation, bound), proof)
        if not verdict.accepted:
            raise Refused(f"the end {float(bound):g} 1/s of the polytope is not shown: {verdict.reason}")
    loop = loop_of(problem, law)
    for name, matrix in (("continuous", found.continuous), ("sampled", found.sampled)):
        if not is_positive(matrix):
            raise Refused(f"the matrix P of the {name} loop is not positive definite")
    if found.decay < 0 or not 0 <= found.contraction <= 1:
        raise Refused("the stated decay is none")
    for q in found.poles:
        for gamma in loop.gamma:
            if not is_positive(decays(found.continuous, rates(loop, q, gamma), found.decay)):
                raise Refused(f"the continuous loop does not decay at the vertex q = {float(q):g} 1/s")
    return covered(loop, found)


def covered(loop: Loop, found: Quadratic) -> int:
    """Number of parts of the interval of q on which the sampled loop is shown to contract.

    Raises
    ------
    Refused
        If it is not shown everywhere.
    """
    matrix = tuple(point(each) for each in found.sampled)
    kept = point(found.contraction)
    waiting, parts = [found.poles], 0
    while waiting:
        low, high = waiting.pop()
        parts += 1
        sums = [contracts(matrix, held(loop, ball(low, high), point(g)), kept) for g in loop.gamma]
        if all(is_positive(each) for each in sums):
            continue
        if parts + len(waiting) > MOST_PARTS or low == high:
            raise Refused(f"the sampled loop is not shown to contract at q = {float(low):g} 1/s")
        middle = (low + high) / 2
        waiting += [(middle, high), (low, middle)]
    return parts


def _read(certificate: str) -> tuple[Quadratic, tuple[str, str]]:
    """Read a certificate, or refuse."""
    if len(certificate) > MOST_BYTES:
        raise Refused("the certificate is too long")
    try:
        content = json.loads(certificate)
        known = content["format"] == FORMAT
        low, high = (_number(each) for each in content["poles"])
        first, second = (str(each) for each in content["proofs"])
        matrices = {
            name: tuple(_number(each) for each in content[name]) for name in ("continuous", "sampled")
        }
        continuous, sampled = ((a, b, c) for a, b, c in matrices.values())
        found = Quadratic(
            poles=(low, high),
            continuous=continuous,
            decay=_number(content["decay"]),
            sampled=sampled,
            contraction=_number(content["contraction"]),
        )
    except (ValueError, TypeError, KeyError, RecursionError, ZeroDivisionError):
        raise Refused("the certificate is not of the form that is asked for") from None
    if not known:
        raise Refused(f"the certificate does not have the format {FORMAT}")
    return found, (first, second)


def _number(text: str) -> Fraction:
    """Read p or p/q; powers of ten could stand for numbers that fill the memory."""
    if not isinstance(text, str) or len(text) > MOST_DIGITS or not NUMBER.fullmatch(text):
        raise ValueError("no number")
    return Fraction(text)
