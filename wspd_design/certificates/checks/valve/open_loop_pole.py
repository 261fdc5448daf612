"""Without feedback of torque or acceleration the valve must be faster than the slip pole: p tau < 1."""

from fractions import Fraction

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.frame import certified
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.checks.valve import slip_pole
from wspd_design.certificates.kernel.arb import above, below, point
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.search.settle import enclose, engine
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import (
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.model.number import Number

NAME, TITLE = "open_loop_pole", "Slip pole against the valve"
TOLERANCE = 1e-3  # 1/s, of the enclosures


def pole_claim(
    problem: Problem, relation: Relation, bound: float, **ranges: float | tuple[float, float]
) -> Claim:
    """Return a claim about the slip pole at the reference, by default on the whole domain.

    Parameters
    ----------
    problem : Problem
        Plant and domain.
    relation : {"<=", ">="}
        Of pole and bound.
    bound : float
        In 1/s.
    **ranges : float or tuple of float
        Other ranges of the quantities, as in :func:`plant_variables`.
    """

    def arranged(x: Values) -> Number:
        return plant_forces(problem, x).pole

    return Claim(
        name="slip pole",
        variables=plant_variables(problem, slip=problem.slip, **ranges),
        expression=lambda x: plant_dynamics(problem, x).pole,
        form=arranged,
        relation=relation,
        bound=Fraction(bound),
        unit="1/s",
    )


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Enclose the slip pole on the domain and compare it with the rate of the valve.

    At an equilibrium the sum of all closed-loop poles is p - 1/tau for every law whose memory holds integrals
    alone, whatever its gains. If it is positive, one pole is unstable.
    """
    limit, reached = valve_rate(problem)
    highest = enclose(pole_claim(problem, "<=", limit), tolerance=TOLERANCE)
    lowest = enclose(pole_claim(problem, ">=", reached), tolerance=TOLERANCE)
    least, most = highest.ends
    poles = slip_pole.pole_map(problem)
    form = laws.slip_feedback_only(problem)
    where = place(highest.place)
    spot = (
        f"between {lowest.ends[0]:.4g} and {most:.4g} 1/s, highest at {highest.place['speed'] * KMH:.3g} km/h"
    )
    exceeded = least >= reached
    if form.status is Status.REFUTED:
        status = Status.NOT_APPLICABLE
        meaning = "The law uses more than the slip, so that this limit does not bind it"
    elif exceeded:
        status = Status.REFUTED
        meaning = (
            "Every equilibrium there is unstable whatever the gains: the slip swings around its reference"
        )
    elif most < limit and highest.status is Status.PROVED:
        status = Status.PROVED
        meaning = "The valve is fast enough for feedback of the slip alone"
    else:
        status = Status.UNDECIDED
        meaning = f"Open: {highest.reason or 'the pole comes within the tolerance of the limit'}"
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"The open-loop slip pole p stays below 1/tau = {limit:.3g} 1/s at slip {problem.slip:g}, "
        f"as any law without feedback of torque or acceleration needs; on {domain.described(problem)}.",
        status=status,
        explanation=f"{meaning}: p lies {spot}. {slip_pole.unstable_speeds(poles, limit)}.",
        margin=highest.margin,
        worst_point=where,
        witness=(*where, Point(name="slip pole", value=least, unit="1/s")) if exceeded else (),
        hypotheses=(
            form,
            verdict.hypothesis(f"p <= {most:.4g} 1/s on the domain", highest),
            verdict.hypothesis(f"p >= {lowest.ends[0]:.4g} 1/s on the domain", lowest),
        ),
        assumptions=(
            "frozen train speed",
            "averaged valve with the smaller of its two time constants",
            "static wheel load",
        ),
        method="interval branch and bound, replayed by the independent checker; a witness is evaluated in exact "
        "balls",
        resolution=f"{highest.boxes + lowest.boxes} boxes; both ends within {TOLERANCE:g} 1/s",
        reference="eqs. (14), (19); docs/theory.md#no-go",
        undecided=verdict.undecided(highest, lowest),
        engine=engine(),
        proofs=verdict.proofs(highest, lowest),
        series=slip_pole.plots(poles, "1/tau", limit),
        maps=margin_map(
            "slip pole",
            "slip pole p [1/s]",
            lambda points: domain.dynamics(problem, points).pole,
            domain.slip_held(problem),
            over=domain.MU0,
            limit=limit,
            worst=highest.place,
            largest=True,
        ),
    )


def valve_rate(problem: Problem) -> tuple[float, float]:
    """Return 1/tau rounded down, to stay below, and rounded up, to exceed [1/s]."""
    rate = 1 / point(shortest_lag(problem))
    return below(rate), above(rate)


def shortest_lag(problem: Problem) -> float:
    """Return the smaller time constant of the valve, with which the limit is mildest [s]."""
    return min(problem.vehicle.brake.fill_time, problem.vehicle.brake.vent_time)
