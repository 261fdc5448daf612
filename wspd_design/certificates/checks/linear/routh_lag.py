"""Near its reference the valve lag must leave the loop stable: Routh's conditions at every speed."""

import math
from dataclasses import replace
from fractions import Fraction
from functools import partial

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.frame import certified, level, series
from wspd_design.certificates.checks.linear.routh_region import region
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.records import Certificate, Point, Problem, Series, Status
from wspd_design.certificates.search.settle import Finding, engine
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.linear_loop import (
    Cubic,
    LinearLaw,
    cubic,
    feedback,
    lag_of,
    loop_at,
    nominal,
    on_brake,
    variables,
)
from wspd_design.certificates.setting.plant import Values, place
from wspd_design.certificates.theorems.inequality import decide, positive
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.number import Number

NAME, TITLE = "routh_lag", "Loop near its reference with valve lag"
TOLERANCE = 0.1  # of the enclosed margins
PLOT_SPEEDS = 81
LEAST_GAIN = 1e-3  # of the brake torque per slip
DETERMINANTS = {
    SlidingMode: "(1 - p tau)(c + k) > tau k c, with p of the plant",
    AdaptiveFuzzy: "(1 - p tau)(k - p) > tau k c with k = G K_P du/ds",
}


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Decide Routh's conditions for all speeds and parameters of the domain.

    tau q^3 + a2 q^2 + a1 q + a0 is stable exactly if a2 > 0, a0 > 0 and a2 a1 > tau a0. Without integral action
    a0 = 0 and the quadratic that remains is stable exactly if a2 > 0 and a1 > 0. Wherever they are positive, a2,
    a1 and a2 a1 fall as the slip pole of the plant rises, so that an upper bound of it would be the safe side; the
    interval proof covers the whole range, with speed, pole and layer gain of a point kept together.
    """
    law = problem.controller
    if not isinstance(law, LinearLaw):
        return laws.no_surface(problem, NAME, "The loop near its reference is stable with the valve lag.")
    domain.box(problem)
    lag = lag_of(problem)
    found = [decide(claim, tolerance=TOLERANCE) for claim in claims(problem, law)]
    worst = min(found, key=_rank)
    status, at = worst.status, worst.place
    speed = at["speed"]
    plant, gains = loop_at(problem, law, at)
    where = (
        *place(at),
        Point(name="slip pole", value=plant.pole, unit="1/s"),
        Point(name="G P", value=plant.gain * gains.proportional, unit="1/s"),
    )
    low, high = problem.speeds[0] * KMH, problem.speeds[1] * KMH
    tolerable = _tolerable_lag(plant.pole, cubic(plant, lag, gains), gains.torque)
    spot = f"at {speed * KMH:.3g} km/h with a slip pole of {plant.pole:.3g} 1/s"
    curves, unstable = _plots(problem, law, lag)
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"With the valve lag tau = {lag:g} s the loop near slip {problem.slip:g} is stable at every speed "
        f"from {low:.3g} to {high:.3g} km/h and for all masses, inertias and frictions of the domain: "
        f"{'; '.join(each.claim.name for each in found)}.",
        status=status,
        explanation={
            Status.PROVED: f"Tightest {spot}; a lag of up to {tolerable:.3g} s would do there. Small deviations "
            "of the slip die out despite the lag.",
            Status.REFUTED: f"Violated {spot}: {worst.claim.name}. "
            + (
                f"A lag of at most {tolerable:.3g} s would do there. "
                if tolerable > 0.0
                else "No lag, however short, would do there. "
            )
            + f"With the nominal parameters the loop is unstable at {unstable} of {PLOT_SPEEDS} speeds. The slip "
            "cannot settle at its reference and swings about it.",
            Status.UNDECIDED: f"Open {spot}: {worst.claim.name}; {worst.reason}.",
        }[status],
        margin=replace(worst, asked=Fraction(0)).margin,
        worst_point=where,
        witness=where if status is Status.REFUTED else (),
        hypotheses=tuple(verdict.hypothesis(each.claim.name, each) for each in found),
        assumptions=(
            "frozen train speed",
            "averaged valve with the slower of its two time constants",
            "no sampling",
            *_frozen(law),
        ),
        method="Routh's conditions of the linearized loop by interval branch and bound; proofs are replayed by "
        "the independent checker, a witness is evaluated in exact balls",
        resolution="; ".join(f"{each.claim.name}: {each.boxes} boxes" for each in found),
        reference="eqs. (14), (19); docs/theory.md#routh",
        undecided=worst.undecided,
        engine=engine(),
        proofs=verdict.proofs(*found),
        series=curves,
    )


def claims(problem: Problem, law: LinearLaw) -> tuple[Claim, ...]:
    """Return what must be positive, each in multiples of what it would be without slip pole and lag."""
    lag, quantities = lag_of(problem), variables(problem, law)
    most = feedback(law, problem.speeds[1]).integral

    def at(values: Values, arranged: bool) -> tuple[Cubic, Number, float]:
        plant, gains = loop_at(problem, law, values, arranged=arranged)
        # Any positive scale serves; the small part keeps it positive for a law without feedback.
        scale = plant.gain * (abs(gains.proportional) + LEAST_GAIN * problem.vehicle.brake.max_torque)
        return cubic(plant, lag, gains), scale, abs(1.0 + gains.torque) or 1.0

    def second(values: Values, arranged: bool) -> Number:
        found, _, opened = at(values, arranged)
        return found.second / opened

    def first(values: Values, arranged: bool) -> Number:
        found, scale, _ = at(values, arranged)
        return found.first / scale

    def determinant(values: Values, arranged: bool) -> Number:
        found, scale, opened = at(values, arranged)
        return (found.second * found.first - found.third * found.constant) / (scale * opened)

    def integral(values: Values, arranged: bool) -> Number:
        return loop_at(problem, law, values, arranged=arranged)[1].integral / abs(most)

    conditions = (
        (("p tau < 1 + K", second), ("G P > (1 + K) p", first))
        if most == 0.0
        else (("I > 0", integral), ("p tau < 1", second), (DETERMINANTS[type(law)], determinant))
    )
    return tuple(
        positive(
            text, quantities, partial(expression, arranged=False), partial(expression, arranged=True), "-"
        )
        for text, expression in conditions
    )


def _frozen(law: LinearLaw) -> tuple[str, ...]:
    """What is held that the law moves."""
    return ("weights and bound frozen at their initial values",) if isinstance(law, AdaptiveFuzzy) else ()


def _rank(finding: Finding) -> tuple[int, bool, float]:
    """Order from the worst condition to the best; that on the sign of a gain has no margin of interest."""
    order = (Status.REFUTED, Status.UNDECIDED, Status.PROVED)
    return order.index(finding.status), finding.claim.name.endswith("> 0"), finding.ends[1]


def _tolerable_lag(pole: float, found: Cubic, torque_gain: float) -> float:
    """Largest lag for which the loop is stable at one point: (1 + K - p tau) a1 > tau a0 solved for tau [s]."""
    if found.first <= 0.0:
        return 0.0
    growth = pole * found.first + found.constant
    return math.inf if growth <= 0.0 else (1.0 + torque_gain) * found.first / growth


def _plots(problem: Problem, law: LinearLaw, lag: float) -> tuple[tuple[Series, ...], int]:
    """Margin over speed, and the region of (c, k) with the law in it; also the number of unstable speeds."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, PLOT_SPEEDS)
    plant = nominal(problem.vehicle, problem.rail, problem.slip, speeds)
    gains = on_brake(law, feedback(law, speeds), problem.vehicle.brake.max_torque)
    found = cubic(plant, lag, gains)
    opened = 1.0 + gains.torque
    margin = np.minimum(
        found.second / opened,
        (found.second * found.first - lag * found.constant) / (plant.gain * gains.proportional * opened),
    )
    axes = ("speed [km/h]", "Routh margin [-]")
    curves = [
        series("nominal parameters", *axes, speeds * KMH, margin),
        level("limit", *axes, speeds * KMH, 0.0),
    ]
    if isinstance(law, SlidingMode | AdaptiveFuzzy):
        curves += region(law, lag, speeds, plant)
    return tuple(curves), int((margin <= 0.0).sum())
