"""Theorems about what the lag of the valve leaves possible to feedback of the slip.

At an equilibrium the poles of the loop sum to p - r + trace(A_c): p the slip pole, r the rate of the valve, which lies
between 1/T_F and 1/T_V, and A_c the dynamics of the law's own memory. A law that does not read the torque and whose
memory holds integrals alone has trace(A_c) = 0, whatever its gains. With p >= r not all poles are then in the left half
plane.

Nor is a sampled law of this class stable. Behind a zero-order hold the plant r/((s - p)(s + r)) is
(b1 z + b0)/((z - alpha)(z - beta)), alpha = exp(p h), beta = exp(-r h), with b1 > 0 and, see below, b0 > 0. A law
N(z)/(z - 1)^n gives the polynomial Q(z) = (z - 1)^n (z - alpha)(z - beta) + N(z) (b1 z + b0). At the zero of the plant,
z = -c with c = b0/b1 > 0, abs(Q) = (1 + c)^n (c + alpha)(c + beta) >= (1 + c)^(n + 2), since alpha beta >= 1 for p >= r
and alpha + beta >= 2. Were all roots inside the unit circle, abs(Q) would be less than (1 + c)^(n + 2). An integral
of the torque breaks this argument: with it a sampled law can be stable.

For proportional feedback let T_F = T_V = tau, r = 1/tau. With a gain K the polynomial of the loop is
z^2 - (alpha + beta) z + alpha beta + K (b1 z + b0).

* Its value at z = 1 is positive only for K > p, since the plant has the static gain -1/p.
* At K = p its roots are 1 and r = (beta + p tau alpha)/(1 + p tau), whose product is alpha beta + p b0.
* b0 > 0, because p tau (exp(h/tau) - 1) > p h >= 1 - exp(-p h). The product of the roots thus grows with K.

Hence for p > 0 a stabilizing gain exists if and only if r < 1, which is p tau (exp(p h) - 1) < 1 - exp(-h/tau). The
left side grows with p. For small h the limit is 1/(tau + h/2): half a sample counts as lag.
"""

import math
from fractions import Fraction

from wspd_design.certificates.kernel.arb import Ball, above, below, point
from wspd_design.certificates.kernel.claim import Claim, Relation, variable
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, OnPart
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import BUILT_UP
from wspd_design.certificates.setting.plant import (
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.certificates.setting.traced_law import memory
from wspd_design.certificates.theorems.rounding import few_digits
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis, left_open
from wspd_design.model.number import Number
from wspd_design.parameters.bounds import Ends

LAG = "valve time"
STATIC = "axle at static load, all axles alike"
MEMBERS = "law that does not read the torque, is differentiable at its equilibrium and has a memory of integrals alone"
SMOOTH = "the law is differentiable at the equilibrium: nothing in it switches there"
PRECISION = 120  # bits, so that the doubles around p_max are neighbors

USED = tuple(name for name in PLANT if name != "slip")
"""What the slip pole at the reference depends on."""


def integrals_of_slip(problem: Problem) -> str:
    """Say why a law is not bound by the sum of the poles: it reads the torque, or remembers more than integrals."""
    found = memory(problem.controller)
    if isinstance(found, str):
        return f"is not bound by this, or was not shown to be: {found}"
    if found.command_reads_torque or found.memory_reads_torque:
        return "reads the braking torque and is not bound by this"
    if not found.integrals_alone:
        names = ", ".join(found.own_dynamics)
        return f"has a memory with dynamics of its own ({names}) and is not bound by this"
    return ""


def pole_claim(problem: Problem, relation: Relation, bound: float, **ranges: float | Ends) -> Claim:
    """Return a claim about the slip pole at the reference [1/s], by default for all numbers of the domain."""
    return Claim(
        name="slip pole",
        variables=plant_variables(problem, ranges={"slip": problem.slip, **ranges}),
        expression=lambda x: plant_dynamics(problem, x).pole,
        form=lambda x: plant_forces(problem, x).pole,
        relation=relation,
        bound=Fraction(bound),
        unit="1/s",
    )


def lag_claim(problem: Problem, lag: float) -> Claim:
    """Return the claim that the slip pole stays below the rate of a valve with a time constant [s]: p tau <= 1."""

    def expression(x: Values) -> Number:
        return plant_dynamics(problem, x).pole * x[LAG]

    def arranged(x: Values) -> Number:
        return plant_forces(problem, x).pole * x[LAG]

    return Claim(
        name="slip pole times valve time",
        variables=(*plant_variables(problem, ranges={"slip": problem.slip}), variable(LAG, lag, "s")),
        expression=expression,
        form=arranged,
        relation="<=",
        bound=Fraction(1),
        unit="-",
    )


def slowest_valve(problem: Problem) -> float:
    """Largest time constant that filling or venting may have [s]: its rate is the least that counts."""
    return max(problem.span("fill time")[1], problem.span("vent time")[1])


def slow_valve(problem: Problem) -> float:
    """Largest time constant that filling and venting may both reach or exceed [s]: no rate is larger than its own."""
    return min(problem.span("fill time")[1], problem.span("vent time")[1])


def common_lag(problem: Problem) -> Ends | None:
    """Time constants that filling and venting may both have [s]; None if there are none."""
    spans = problem.span("fill time"), problem.span("vent time")
    low, high = max(span[0] for span in spans), min(span[1] for span in spans)
    return (low, high) if low <= high else None


def _pole_obligations(problem: Problem) -> tuple[Obligation, ...]:
    return (
        Inequality(key="every valve", claim=lag_claim(problem, slowest_valve(problem))),
        Inequality(key="some valve", claim=lag_claim(problem, slow_valve(problem))),
    )


def _tell_pole(problem: Problem, findings: Findings) -> Certificate:
    every, some = findings["every valve"], findings["some valve"]
    slow = slow_valve(problem)
    refuted = some.status is Status.REFUTED
    status = (
        Status.PROVED if every.status is Status.PROVED else Status.REFUTED if refuted else Status.UNDECIDED
    )
    shown = some if refuted else every
    where = place(shown.values, ("slip", *USED)) if shown.values else ()
    meaning = {
        Status.PROVED: "The valve is fast enough for feedback of the slip alone.",
        Status.REFUTED: f"There, with fill and vent times of {slow:g} s or more, which the bounds allow, every "
        "equilibrium at this slip is unstable for this law and every other one of its class, whatever the gains.",
        Status.UNDECIDED: f"Open: {left_open(findings.values()) or 'it depends on the share of filling and venting'}.",
    }[status]
    within = domain.domain_of(problem, USED)
    return Certificate(
        claim=f"At every frozen speed the open-loop slip pole p at slip {problem.slip:g} does not exceed the rate of "
        f"the valve, as the equilibrium of a {MEMBERS} needs to be asymptotically stable; for fill and vent times up "
        f"to {slowest_valve(problem):g} s, {STATIC}, on {within.text}.",
        status=status,
        explanation=meaning,
        method="interval branch and bound, replayed by the independent checker",
        margin=shown.margin,
        worst_point=where,
        witness=(*where, Point(name=LAG, value=slow, unit="s")) if refuted else (),
        hypotheses=(
            hypothesis(
                f"p tau <= 1 with tau = {slowest_valve(problem):g} s, the slowest that the bounds allow",
                every,
            ),
            hypothesis(
                f"p tau <= 1 with tau = {slow:g} s, which fill and vent time may both have or exceed", some
            ),
        ),
        assumptions=(
            "frozen train speed",
            "averaged valve: its rate lies between 1/T_F and 1/T_V",
            SMOOTH,
            STATIC,
        ),
        domain=within,
        varied=(*USED[1:], "fill time", "vent time"),
        reference="eqs. (14), (19); docs/theory.md#no-go",
    )


def valve_rate(problem: Problem) -> tuple[float, float]:
    """Return two numbers around the largest nominal rate of the valve, the second above it for certain [1/s]."""
    rate = 1 / point(min(problem.nominal("fill time"), problem.nominal("vent time")))
    return below(rate), math.nextafter(above(rate), math.inf)


def interval_claim(problem: Problem, limit: float, speeds: Ends, relation: Relation) -> Claim:
    """Return the claim that the nominal slip pole reaches (or respects) a limit [1/s] at all speeds [m/s]."""
    held = {name: problem.nominal(name) for name in USED if name != "speed"}
    return pole_claim(problem, relation, limit, speed=speeds, **held)


def _no_go_obligations(problem: Problem) -> tuple[Obligation, ...]:
    low, high = valve_rate(problem)
    return (
        OnPart(
            key="beyond",
            claim=lambda speeds: interval_claim(problem, high, speeds, ">="),
            quantity="speed",
            within=problem.speeds,
        ),
        Inequality(key="nowhere", claim=interval_claim(problem, low, problem.speeds, "<=")),
    )


def _tell_no_go(problem: Problem, findings: Findings) -> Certificate:
    beyond, nowhere = findings["beyond"], findings["nowhere"]
    limit = valve_rate(problem)[1]
    proved = beyond.status is Status.PROVED
    low, high = (beyond.part if proved and beyond.part else None) or problem.speeds
    where = f"from {few_digits(low, up=True)} to {few_digits(high, up=False)} m/s"
    vacuous = nowhere.status is Status.PROVED
    status = Status.LIMITATION if proved else Status.VACUOUS if vacuous else Status.UNDECIDED
    shown = beyond if proved else nowhere
    valve = f"with the nominal parameters, {STATIC}, and a valve whose faster time constant is {1.0 / limit:.6g} s"
    return Certificate(
        claim=f"At no frozen speed {where} is an equilibrium at slip {problem.slip:g} asymptotically stable under a "
        f"{MEMBERS}, {valve}."
        if not vacuous
        else f"At no frozen speed {where} at which the slip pole exceeds 1/tau is an equilibrium at slip "
        f"{problem.slip:g} asymptotically stable under a {MEMBERS}, {valve}. There is no such speed.",
        status=status,
        explanation={
            Status.LIMITATION: "There the poles of the loop have a positive sum, whatever the gains. A law with "
            "dynamics of its own, such as a lead filter, or one that reads the torque is not bound by this.",
            Status.VACUOUS: "The nominal slip pole does not exceed 1/tau at any of these speeds.",
            Status.UNDECIDED: f"Open: {left_open(findings.values()) or 'the search found no range of speeds'}.",
        }[status],
        method="crossings by bisection, then interval branch and bound, replayed by the independent checker",
        margin=shown.margin,
        worst_point=place(shown.values, ("slip", "speed")) if shown.values else (),
        hypotheses=(
            hypothesis(f"p >= 1/tau = {limit:.4g} 1/s {where}", beyond)
            if not vacuous
            else hypothesis(f"p <= 1/tau = {limit:.4g} 1/s {where}", nowhere),
        ),
        assumptions=(
            "frozen train speed",
            "averaged valve: its rate is at most 1/min(T_F, T_V)",
            SMOOTH,
            STATIC,
        ),
        held=(*USED[1:], "fill time", "vent time"),
        reference="eqs. (14), (19); docs/theory.md#no-go",
    )


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


def _sampled(problem: Problem) -> str:
    """Say why the theorem on sampled feedback does not speak about a design."""
    reason = integrals_of_slip(problem)
    if reason or common_lag(problem):
        return reason
    return "drives a valve that never fills as fast as it vents, about which the theorem does not speak"


def _lag(problem: Problem) -> float:
    lag = common_lag(problem)
    assert lag is not None
    return lag[1]


def _sampling_obligations(problem: Problem) -> tuple[Obligation, ...]:
    low, _ = largest_pole(problem.sample_time, _lag(problem))
    return (Inequality(key="pole", claim=pole_claim(problem, "<=", low)),)


def _tell_sampling(problem: Problem, findings: Findings) -> Certificate:
    found, lag = findings["pole"], _lag(problem)
    limit, highest = float(found.limit), found.low
    status = found.status
    if status is Status.REFUTED and not lacking(highest, problem.sample_time, lag) > 0:
        status = Status.UNDECIDED
    growth = math.exp(max(highest, 0.0) * problem.sample_time) if math.isfinite(highest) else math.nan
    where = place(found.values, ("slip", *USED)) if found.values else ()
    reason = left_open(findings.values()) or "the pole lies between the doubles around p_max"
    meaning = {
        Status.REFUTED: "No gain on the sampled slip is stable there.",
        Status.PROVED: "A stabilizing gain on the sampled slip exists for every point of the domain.",
        Status.UNDECIDED: f"Open: {reason}.",
    }[status]
    low, high = common_lag(problem) or (lag, lag)
    times = f"{lag:g} s" if low == high else f"{low:g} to {high:g} s"
    within = domain.domain_of(problem, USED)
    return Certificate(
        claim=f"At every frozen speed the slip pole at slip {problem.slip:g} does not exceed p_max, up to which "
        f"proportional feedback of the slip, sampled every {problem.sample_time * 1e3:g} ms, stabilizes it through a "
        f"valve that fills and vents with one time constant of {times}; p_max = {limit:.3g} 1/s at {lag:g} s; "
        f"{STATIC}, on {within.text}.",
        status=status,
        explanation=f"{meaning} At the tightest point a deviation of the slip grows by a factor of {growth:.4g} within "
        "one sample.",
        method="exact zero-order-hold discretization; interval branch and bound, replayed by the independent checker",
        margin=found.margin,
        worst_point=where,
        witness=(*where, Point(name="slip pole", value=highest, unit="1/s"))
        if status is Status.REFUTED
        else (),
        hypotheses=(hypothesis(f"p <= p_max = {limit:.4g} 1/s on the domain", found),),
        assumptions=(
            "frozen train speed",
            "averaged valve with T_F = T_V",
            "torque command held over a sample: pulse width modulation without ripple",
            "proportional feedback of the slip error",
            STATIC,
        ),
        domain=within,
        varied=(*USED[1:], "fill time", "vent time"),
        reference="eqs. (13)-(15), (19); docs/theory.md#sampling",
    )


OPEN_LOOP_POLE = Theorem(
    name="open_loop_pole",
    title="Slip pole against the valve",
    claim=f"The slip pole does not exceed the rate of the valve, as the equilibrium of a {MEMBERS} needs to be "
    "asymptotically stable.",
    speaks_about=integrals_of_slip,
    obligations=_pole_obligations,
    tell=_tell_pole,
    assumes=BUILT_UP,
)

NO_GO = Theorem(
    name="no_go",
    title="Speeds that feedback of the slip cannot master",
    claim=f"Where the slip pole exceeds the rate of the valve, no equilibrium under a {MEMBERS} is asymptotically "
    "stable.",
    speaks_about=integrals_of_slip,
    obligations=_no_go_obligations,
    tell=_tell_no_go,
    assumes=BUILT_UP,
)

SAMPLING = Theorem(
    name="sampling",
    title="Slip pole against sampling and valve",
    claim="A proportional gain on the sampled slip stabilizes the slip pole through the valve.",
    speaks_about=_sampled,
    obligations=_sampling_obligations,
    tell=_tell_sampling,
    assumes=BUILT_UP,
)
