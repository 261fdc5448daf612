"""Speeds at which no law without feedback of torque or wheel acceleration can be stable with this valve.

With the averaged valve the divergence at an equilibrium is p - 1/tau whatever such a law does. Where the slip pole
p reaches 1/tau, one closed-loop pole lies in the right half plane or on its border.
"""

from typing import TYPE_CHECKING

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.frame import certified
from wspd_design.certificates.checks.valve import slip_pole
from wspd_design.certificates.checks.valve.open_loop_pole import pole_claim, valve_rate
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.subdomain import with_part
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.search.settle import engine, settle
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import place
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

NAME, TITLE = "no_go", "Speeds that slip feedback cannot master"
TOLERANCE = 1e-3  # 1/s, of the enclosed pole
GRID_SPEEDS = 401
INSET = 1e-3  # relative; the claimed interval ends this far inside the crossings


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Find the widest interval of speeds with p >= 1/tau at the nominal parameters, and prove it."""
    domain.box(problem)
    below, limit = valve_rate(problem)
    interval = widest_interval(problem, limit)
    form = laws.slip_feedback_only(problem)
    low, high = interval or problem.speeds
    finding = settle(
        interval_claim(problem, limit, (low, high), ">=")
        if interval
        else interval_claim(problem, below, (low, high), "<="),
        tolerance=TOLERANCE,
    )
    claimed = f"{low:.4g} to {high:.4g} m/s ({low * KMH:.3g} to {high * KMH:.3g} km/h)"
    bound = "p >= 1/tau" if interval else "p <= 1/tau"
    poles = slip_pole.pole_map(problem)
    # A pole on the other side of 1/tau somewhere says that the interval was chosen badly, no more.
    status = Status.PROVED if finding.status is Status.PROVED else Status.UNDECIDED
    if form.status is Status.REFUTED:
        status = Status.NOT_APPLICABLE
        meaning = f"{problem.controller.name} feeds back more than the slip and is not bound by this."
    elif interval:
        meaning = (
            "There every equilibrium is unstable whatever the gains: the slip swings around its reference."
        )
    else:
        status = Status.VACUOUS if status is Status.PROVED else status
        meaning = "There is no such speed: the valve is faster than the slip pole throughout."
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"No law without feedback of torque or wheel acceleration is asymptotically stable at slip "
        f"{problem.slip:g} from {claimed}, with the nominal parameters and tau = {1.0 / limit:g} s."
        if interval
        else f"At some speed from {claimed} no law without feedback of torque or wheel acceleration is "
        f"asymptotically stable at slip {problem.slip:g}, with the nominal parameters.",
        status=status,
        limitation=True,
        explanation=f"{meaning} {finding.reason}".rstrip(),
        margin=finding.margin,
        worst_point=place(finding.place),
        hypotheses=(form, verdict.hypothesis(f"{bound} = {limit:.4g} 1/s from {claimed}", finding)),
        assumptions=(
            "frozen train speed",
            "averaged valve with the smaller of its two time constants",
            "nominal parameters, static wheel load",
        ),
        method="crossings by bisection, then interval branch and bound, replayed by the independent checker",
        resolution=f"{GRID_SPEEDS} speeds to find the interval; {finding.boxes} boxes to prove it",
        reference="eqs. (14), (19); docs/theory.md#no-go",
        undecided=finding.undecided,
        engine=engine(),
        proofs=tuple(
            with_part(proof, "speed", interval) if interval else proof for proof in verdict.proofs(finding)
        ),
        series=slip_pole.nominal_plots(
            poles, "1/tau", limit, interval if finding.status is Status.PROVED else None
        ),
    )


def interval_claim(problem: Problem, limit: float, speeds: tuple[float, float], relation: Relation) -> Claim:
    """Return the claim that the nominal slip pole reaches (or respects) a limit [1/s] at all speeds [m/s]."""
    return pole_claim(
        problem,
        relation,
        limit,
        speed=speeds,
        mass=problem.vehicle.mass,
        inertia=problem.vehicle.wheelset_inertia,
        mu0=problem.rail.mu0,
    )


def widest_interval(problem: Problem, limit: float) -> tuple[float, float] | None:
    """Search the widest interval of speeds [m/s] on which the nominal pole exceeds a limit [1/s]."""
    import numpy as np
    from scipy.optimize import brentq

    def excess(speed: "float | Array") -> "Array":
        found: Array = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speed).pole - limit
        return found

    speeds = np.geomspace(*problem.speeds, GRID_SPEEDS)
    above = excess(speeds) > 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
    if edges.size == 0:
        return None

    def crossing(outside: int, inside: int, direction: float) -> float:
        if not 0 <= outside < GRID_SPEEDS:
            return float(speeds[inside])
        root = brentq(excess, *sorted((float(speeds[outside]), float(speeds[inside]))))
        return float(root) * (1.0 + direction * INSET)

    intervals = [
        (crossing(int(first) - 1, int(first), 1.0), crossing(int(end), int(end) - 1, -1.0))
        for first, end in zip(edges[::2], edges[1::2], strict=True)
    ]
    return max(
        (each for each in intervals if each[0] < each[1]), key=lambda each: each[1] / each[0], default=None
    )
