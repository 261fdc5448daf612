"""With sampling and valve lag, feedback of the slip stabilizes a slip pole only below p_max(h, tau).

The plant 1/((s - p)(tau s + 1)) behind a zero-order hold is (b1 z + b0)/((z - alpha)(z - beta)), alpha = exp(p h),
beta = exp(-h/tau). With a gain K the polynomial of the loop is z^2 - (alpha + beta) z + alpha beta + K (b1 z + b0).

* Its value at z = 1 is positive only for K > p, since the plant has the static gain -1/p.
* At K = p its roots are 1 and r = (beta + p tau alpha)/(1 + p tau), whose product is alpha beta + p b0.
* b0 > 0, because p tau (exp(h/tau) - 1) > p h >= 1 - exp(-p h). The product of the roots thus grows with K.

Hence for p > 0 a stabilizing gain exists if and only if r < 1, which is p tau (exp(p h) - 1) < 1 - exp(-h/tau). The
left side grows with p. For small h the limit is 1/(tau + h/2): half a sample counts as lag.
"""

import math
from dataclasses import replace

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.frame import certified
from wspd_design.certificates.checks.valve import slip_pole
from wspd_design.certificates.checks.valve.open_loop_pole import TOLERANCE, pole_claim, shortest_lag
from wspd_design.certificates.kernel.arb import Ball, point
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.search.settle import Finding, engine, settle
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import place

NAME, TITLE = "sampling", "Slip pole against sampling and valve"
PRECISION = 120  # bits, so that the doubles around p_max are neighbors


def lacking(pole: float, sample_time: float, lag: float) -> Ball:
    """Enclose p tau (exp(p h) - 1) - (1 - exp(-h/tau)), positive where no gain stabilizes the pole [-].

    Parameters
    ----------
    pole : float
        Slip pole p, positive [1/s].
    sample_time : float
        Sampling interval h [s].
    lag : float
        Time constant of the valve tau [s].
    """
    growth = (point(pole) * sample_time).expm1()
    return point(pole) * lag * growth + (-point(sample_time) / lag).expm1()


def largest_pole(sample_time: float, lag: float) -> tuple[float, float]:
    """Enclose the largest slip pole that feedback of the sampled slip can stabilize [1/s].

    At the first number a gain exists for certain, at the second there is none; parameters as in :func:`lacking`.
    """
    from flint import ctx

    with ctx.workprec(PRECISION):
        low, high = 0.0, math.nextafter(1.0 / lag, math.inf)
        while low < (middle := 0.5 * (low + high)) < high:
            found = lacking(middle, sample_time, lag)
            if found < 0:
                low = middle
            elif found > 0:
                high = middle
            else:
                break
    return low, high


def claim(problem: Problem) -> Claim:
    """Claim that the slip pole stays where a gain stabilizes it, on the domain at the reference."""
    low, _ = largest_pole(problem.sample_time, shortest_lag(problem))
    return replace(pole_claim(problem, "<=", low), name="slip pole under sampling")


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Compare the slip pole on the domain with what sampled feedback can stabilize."""
    lag = shortest_lag(problem)
    found = settle(claim(problem), tolerance=TOLERANCE)
    limit = float(found.asked)
    highest, _ = found.ends
    if found.status is Status.REFUTED and not lacking(highest, problem.sample_time, lag) > 0:
        found = replace(
            found, status=Status.UNDECIDED, reason="the pole lies between the doubles around p_max"
        )
    poles = slip_pole.pole_map(problem)
    form = laws.slip_feedback_only(problem)
    where = place(found.place)
    exceeded = found.status is Status.REFUTED
    status = Status.NOT_APPLICABLE if form.status is Status.REFUTED else found.status
    growth = math.exp(max(highest, 0.0) * problem.sample_time)
    over_lag = math.exp(max(highest, 0.0) * (problem.sample_time + lag))
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"The slip pole stays below p_max = {limit:.3g} 1/s, the largest that proportional feedback of "
        f"the slip, sampled every {problem.sample_time * 1e3:g} ms, stabilizes through a valve of {lag:g} s; "
        f"at slip {problem.slip:g} on {domain.described(problem)}.",
        status=status,
        explanation=f"{_meaning(status, found)} At {found.place['speed'] * KMH:.3g} km/h a deviation of the slip "
        f"grows by a factor of {growth:.4g} within one sample and {over_lag:.4g} within sample and valve lag. "
        f"{slip_pole.unstable_speeds(poles, limit)}.",
        margin=found.margin,
        worst_point=where,
        witness=(*where, Point(name="slip pole", value=highest, unit="1/s")) if exceeded else (),
        hypotheses=(form, verdict.hypothesis(f"p <= p_max = {limit:.4g} 1/s on the domain", found)),
        assumptions=(
            "frozen train speed",
            "averaged valve with the smaller of its two time constants",
            "torque command held over a sample: pulse width modulation without ripple",
            "proportional feedback of the slip error",
        ),
        method="exact zero-order-hold discretization; interval branch and bound, replayed by the independent checker; "
        "a witness is evaluated in exact balls",
        resolution=f"{found.boxes} boxes; p_max between neighboring floating-point numbers",
        reference="eqs. (13)-(15), (19); docs/theory.md#sampling",
        undecided=found.undecided,
        engine=engine(),
        proofs=verdict.proofs(found),
        series=slip_pole.plots(poles, "p_max", limit),
    )


def _meaning(status: Status, found: Finding) -> str:
    return {
        Status.NOT_APPLICABLE: "The law uses more than the slip; this limit does not bind it.",
        Status.REFUTED: "No gain on the sampled slip is stable there.",
        Status.PROVED: "A stabilizing gain on the sampled slip exists for every point of the domain.",
        Status.UNDECIDED: f"Open: {found.reason}.",
    }[status]
