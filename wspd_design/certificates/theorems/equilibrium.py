"""Where a law without integral of the error comes to rest: within the tolerance of its reference, or not.

The averaged torque T of a wheelset that is held at a slip changes by

    r = u (1 - T/T_max)/T_F - (1 - u) (T/T_max)/T_V,

u the duty that the law commands when T is the torque that holds this slip. If r <= 0 at the upper end of the tolerance
and r >= 0 at the lower one, r vanishes in between: there the loop is in equilibrium. Without equilibrium r has one
sign on the whole tolerance, which a subdivision of it shows.
"""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from wspd_design.certificates.kernel.arb import ball, below, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, Special
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Problem, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.creep_slope import HELD
from wspd_design.certificates.setting.plant import (
    Values,
    complete,
    model_forces,
    model_variables,
    plant_dynamics,
    plant_forces,
    plant_variables,
    records_of,
)
from wspd_design.certificates.setting.plant import place as shown
from wspd_design.certificates.setting.traced_law import written_law
from wspd_design.certificates.theorems.theorem import Findings
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics

BRAKE = ("max torque", "fill time", "vent time")
USED = (*PLANT, *BRAKE)
ABOVE, BELOW, NOWHERE = "upper end of the tolerance", "lower end of the tolerance", "no equilibrium"
PARTS = 256  # of the tolerance
WORK_OF_A_PART = 2_000


def obligations(problem: Problem) -> tuple[Obligation, ...]:
    """Return what shows that an equilibrium lies within the tolerance, and what shows that none does."""
    low, high = problem.near
    return (
        Inequality(key=ABOVE, claim=rate_claim(problem, high, "<=")),
        Inequality(key=BELOW, claim=rate_claim(problem, low, ">=")),
        Special(
            key=NOWHERE,
            text=f"some slip from {low:.6g} to {high:.6g} is an equilibrium",
            evaluate=lambda place, work: nowhere(problem, place, work),
            within=free(problem),
        ),
    )


def status(findings: Findings) -> Status:
    """Tell whether an equilibrium lies within the tolerance for all numbers of the domain."""
    if findings[ABOVE].status is Status.PROVED and findings[BELOW].status is Status.PROVED:
        return Status.PROVED
    return Status.REFUTED if findings[NOWHERE].status is Status.REFUTED else Status.UNDECIDED


def text(problem: Problem) -> str:
    """Return the hypothesis in words."""
    tolerance = f"{problem.slip_tolerance:g} of slip {problem.slip:g}"
    return f"an equilibrium lies within {tolerance}, for all numbers of the domain"


def explained(problem: Problem, findings: Findings) -> str:
    """Say where the loop comes to rest, or that it is open."""
    found = status(findings)
    if found is Status.PROVED:
        return f"An equilibrium lies within {problem.slip_tolerance:g} of the reference for all numbers of the domain"
    if found is Status.REFUTED:
        rate, at = findings[NOWHERE].numbers["rate"], findings[NOWHERE].place
        side = "above" if rate > 0.0 else "below"
        points = shown(at, tuple(at))
        where = ", ".join(f"{each.name} {each.value:.4g} {each.unit}".removesuffix(" -") for each in points)
        return (
            f"At {where} no equilibrium lies within {problem.slip_tolerance:g} of the reference: for every slip "
            f"there the torque that holds it would change by at least {abs(rate):.3g} T_max/s, so that the loop "
            f"rests {side} it, if at all"
        )
    return f"Whether an equilibrium lies within {problem.slip_tolerance:g} of the reference is open"


def free(problem: Problem) -> Mapping[str, tuple[float, float]]:
    """Ranges of the quantities that a place of no equilibrium names."""
    names = [name for name in USED if name not in ("slip", *HELD)]
    ranges = {name: domain.span(problem, name) for name in names}
    return {name: (low, high) for name, (low, high) in ranges.items() if low < high}


def rate_claim(problem: Problem, slip: float, relation: Relation) -> Claim:
    """Claim that the torque that holds a slip falls or rises [1/s]."""
    law: Any = written_law(problem.controller, "torque-feedback")

    def expression(x: Values) -> Number:
        plant = plant_dynamics(problem, x)
        model = slip_dynamics(*records_of(x, law.vehicle, law.rail, "model "), problem.slip, x["speed"])
        return _rate(problem, x, -plant.drift / plant.gain, -model.drift / model.gain)

    def arranged(x: Values) -> Number:
        at = {**x, "slip": problem.slip}
        held = holding_torque(plant_forces(problem, x), x, "")
        return _rate(problem, x, held, holding_torque(model_forces(at, law.vehicle, law.rail), at, "model "))

    return Claim(
        name=f"rate of the torque that holds slip {slip:.6g}",
        variables=(
            *plant_variables(problem, uses=USED, hold=HELD, ranges={"slip": slip}),
            *model_variables(law.vehicle, law.rail),
        ),
        expression=expression,
        form=arranged,
        relation=relation,
        bound=Fraction(0),
        unit="1/s",
    )


def nowhere(problem: Problem, place: Place, work: Work) -> dict[str, float]:
    """Enclose the rate on parts of the tolerance at a place where it has one sign, or refuse."""
    law: Any = written_law(problem.controller, "torque-feedback")
    low, high = problem.near
    known = {v.name: point(v.low) for v in model_variables(law.vehicle, law.rail)}
    numbers = {name: problem.nominal(name) for name in BRAKE}
    values = complete(problem, {**numbers, **place})
    rates = []
    for k in range(PARTS):
        work.spend(WORK_OF_A_PART)
        ends = (Fraction(low) + (Fraction(high) - Fraction(low)) * n / PARTS for n in (k, k + 1))
        x = {name: point(each) for name, each in values.items()} | known | {"slip": ball(*ends)}
        at = {**x, "slip": point(problem.slip)}
        held = holding_torque(plant_forces(problem, x), x, "")
        rates.append(
            _rate(problem, x, held, holding_torque(model_forces(at, law.vehicle, law.rail), at, "model "))
        )
    if all(each > 0 for each in rates):
        return {"rate": min(map(below, rates))}
    if all(each < 0 for each in rates):
        return {"rate": -min(below(-each) for each in rates)}
    raise Refused("an equilibrium may lie within the tolerance at this place")


def holding_torque(at: Any, x: Values, prefix: str) -> Number:
    """Torque that holds a slip [N m]."""
    radius, inertia = x[f"{prefix}wheel radius"], x[f"{prefix}wheelset inertia"]
    rolling = inertia * at.deceleration - 2.0 * x["speed"] * x[f"{prefix}wheel damping"]
    return at.creep_force * radius * 2.0 + (1.0 - x["slip"]) * rolling / radius


def _rate(problem: Problem, x: Values, held: Number, model_held: Number) -> Number:
    """Rate r of the averaged torque, as a share of T_max [1/s]."""
    law: Any = written_law(problem.controller, "torque-feedback")
    share, model_share = held / x["max torque"], model_held / law.max_torque
    sliding = x["speed"] * (1.0 - x["model wheel radius"] / x["wheel radius"] * (1.0 - x["slip"]))
    error = problem.slip * x["speed"] - sliding
    demand = (1.0 + law.gains.torque_gain) * model_share + law.gains.sliding_gain * error
    demand = demand - law.gains.torque_gain * held / law.max_torque
    duty = (abs(demand) - abs(demand - 1.0) + 1.0) * 0.5  # limited to 0 and 1
    return duty * (1.0 - share) / x["fill time"] - (1.0 - duty) * share / x["vent time"]
