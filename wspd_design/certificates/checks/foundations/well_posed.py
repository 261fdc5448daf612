"""What every proof takes for granted: the train slows down, adhesion brakes it, and torque raises the slip."""

from collections.abc import Callable
from fractions import Fraction
from typing import TypeAlias

from wspd_design.certificates.checks import verdict
from wspd_design.certificates.checks.frame import certified
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.search.settle import engine, settle
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import (
    Forces,
    Values,
    place,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.model.generated import slip as generated
from wspd_design.model.number import Number
from wspd_design.model.slip import SlipDynamics

NAME, TITLE = "well_posed", "Signs of the model"
MEGA = 1e6  # N m in a MN m, so that the gain is a number of common size
GAIN = "input gain G"
LEAST_GAIN = Fraction(1, 10**6)  # 1/s per MN m: above zero, where zero itself would not do
TOLERANCES = {"m/s2": 1e-3, "N": 5.0, "1/s per MN m": 0.01, "1/s2 per MN m": 0.01}


Form: TypeAlias = Callable[[Forces, Values], Number]


def claims(problem: Problem) -> tuple[Claim, ...]:
    """Return the signs that are claimed: a, f, G and G' = G a / v."""

    def of(name: str, unit: str, kernel: Callable[[SlipDynamics, Values], Number], form: Form) -> Claim:
        return Claim(
            name=name,
            variables=plant_variables(problem),
            expression=lambda x: kernel(plant_dynamics(problem, x), x),
            form=lambda x: form(plant_forces(problem, x), x),
            relation=">=",
            bound=LEAST_GAIN if name == GAIN else Fraction(0),
            unit=unit,
        )

    def gain(x: Values) -> Number:
        return generated.slip_gain(x["speed"], x["wheelset inertia"] / 2.0, x["wheel_radius"]) * MEGA

    return (
        of(
            "deceleration a",
            "m/s2",
            lambda plant, _: plant.deceleration,
            lambda arranged, _: arranged.deceleration,
        ),
        of(
            "adhesion force f",
            "N",
            lambda plant, _: plant.creep_force,
            lambda arranged, _: arranged.creep_force,
        ),
        of(GAIN, "1/s per MN m", lambda plant, _: plant.gain * MEGA, lambda _, x: gain(x)),
        of(
            "rate of the input gain G' = G a/v",
            "1/s2 per MN m",
            lambda plant, x: plant.gain * MEGA * plant.deceleration / x["speed"],
            lambda arranged, x: gain(x) * arranged.deceleration / x["speed"],
        ),
    )


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Decide the four signs on the domain."""
    found = [settle(claim, tolerance=TOLERANCES[claim.unit]) for claim in claims(problem)]
    slowing = found[0]
    status = verdict.status(*found)
    denied = next((each for each in found if each.status is Status.REFUTED), None)
    where = place((denied or slowing).place)
    values = "; ".join(f"{each.claim.name} >= {each.ends[0]:.4g} {each.claim.unit}" for each in found)
    meaning = {
        Status.PROVED: "The train slows down at every point, adhesion brakes it, more torque always means more slip, "
        "and the input gain grows during a stop",
        Status.REFUTED: f"The sign of the {denied.claim.name if denied else ''} is wrong at slip "
        f"{where[0].value:.3g}, {where[1].value:.3g} km/h, so that no proof that needs it holds there",
        Status.UNDECIDED: "Open: " + "; ".join(each.reason for each in found if each.reason),
    }[status]
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"a = (f_d + 8 f)/m >= 0, f >= 0, G > 0 and G' >= 0 on {domain.described(problem)}.",
        status=status,
        explanation=f"{meaning}. Found: {values}.",
        margin=slowing.margin,
        worst_point=place(slowing.place),
        witness=(
            *where,
            Point(name=denied.claim.name, value=denied.ends[1], unit=denied.claim.unit),
        )
        if denied
        else (),
        hypotheses=tuple(
            verdict.hypothesis(f"{each.claim.name} {'>' if each.claim.name == GAIN else '>='} 0", each)
            for each in found
        ),
        assumptions=("level track", "static wheel load"),
        method="interval branch and bound, replayed by the independent checker",
        resolution=f"{sum(each.boxes for each in found)} boxes, {problem.speeds[0] * KMH:.3g} km/h and above",
        reference="eqs. (1), (4)-(7), (19); docs/theory.md#slip-equation",
        undecided=verdict.undecided(*found),
        engine=engine(),
        proofs=verdict.proofs(*found),
        maps=margin_map(
            "deceleration",
            "deceleration a [m/s2]",
            lambda points: domain.dynamics(problem, points).deceleration,
            domain.box(problem),
            over=domain.SLIP,
            limit=0.0,
            worst=slowing.place,
            largest=False,
        ),
    )
