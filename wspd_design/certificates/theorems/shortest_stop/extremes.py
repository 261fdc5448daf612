"""The ends of all bounds at which a stop is shortest: every plant of a box stops later than the bound computed there.

The bound falls, or at least does not rise, if one of these numbers changes and the others stay:

* **Friction up** (mu0 or friction ratio up, friction decay down): f grows with the friction, see ``adhesion_peaks.py``.
* **Contact stiffer for its load** (shear modulus, semi axes, c11 up, reference load down, wheel load down): with C/Q
  larger, the slip s C/C' <= s has the same gradient, slides less and finds no less friction, so that the peak of f/Q
  over the slips does not fall. The stiffness grows slower than the load, C ~ Q^(2/3), or not at all: the peak of f/Q
  falls with the load. An axle with the least load therefore bounds all: sum Q_i mu(Q_i) <= m g mu(least Q).
* **Reductions**: x = k_A eps and y = k_S eps. A larger k_A at the same k_S/k_A only scales the slip, as a stiffer
  contact does; a larger k_S/k_A raises atan y. So k_A and k_S/k_A at their upper ends bound all.
* **Less mass, more resistance, more damping**: f_d/m and the share of momentum that resistance, damping and brake take
  grow.
* **More torque, a faster supply, quicker filling**: p' = (P - p)/T_F with P >= p grows.
* **Wheelset**: in the momentum m + n I/R^2 least inertia and largest radius; in the torque T/R, the damping B/R^2 and
  the overspeed I s/R^2 largest inertia and least radius. Each is taken at its own end.

That a wheel does not outrun the train is asked for at the opposite ends: the force at the small slip -s grows with
friction and load at the same C, and of x/(1 + x^2) the smaller end of the range of x counts. The other wheelsets slow
the train down by g mu0 at most, times 1 + 1/pi where k_S may exceed k_A.
"""

from dataclasses import dataclass, replace

from wspd_design.certificates.kernel.arb import above
from wspd_design.certificates.quantities import BRAKE, CONTACT, RAIL, VEHICLE
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.axle import grip
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

IDLE = ("max pressure", "vent time")
"""Numbers of the brake on which the bound does not depend: only torque and filling count."""
USED = tuple(name for name in (*VEHICLE, *CONTACT, *RAIL, *BRAKE) if name not in IDLE)
LOWEST = ("mass", "wheelset inertia", "friction decay", "reference load", "fill time")
"""Numbers that are at their lower end where a stop is shortest."""
WEAKER = ("wheelset inertia", "friction decay", "reference load")
"""Numbers that are at their upper end where a wheel is held back least."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Extremes:
    """Plants at the ends of all bounds; they are the same where every number is known."""

    strong: Vehicle  # stops shortest
    strong_rail: Rail
    weak: Vehicle  # its wheels are held back least
    weak_rail: Rail
    share: float = 1.0  # least load of an axle over its static load
    most: float = 1.0  # largest load of an axle over the static load of the lightest vehicle
    others: float | None = None  # m/s2 over mu0, what the other wheelsets may take; None if all are alike


def exactly(vehicle: Vehicle, rail: Rail) -> Extremes:
    """Return one known plant with static wheel loads, all wheelsets alike."""
    return Extremes(strong=vehicle, strong_rail=rail, weak=vehicle, weak_rail=rail)


def over_bounds(problem: Problem) -> Extremes:
    """Return the ends of the box of a problem, with wheelsets that may differ in load and torque.

    Raises
    ------
    OutsideModel
        If the load transfer may lift a wheel.
    """
    strong = {name: problem.span(name)[name not in LOWEST] for name in USED}
    weak = {name: problem.span(name)[name in WEAKER] for name in USED}
    for name in ("resistance constant", "resistance linear", "resistance quadratic"):
        weak[name] = strong[name]
    vehicle, rail = plant_with(problem, strong)
    least = problem.span("adhesion reduction")[0]
    if least < rail.adhesion_reduction:
        wide = rail.adhesion_reduction / least * rail.slip_reduction
        rail = replace(rail, slip_reduction=wide * (1.0 + 1e-12))
    least_share, most_share = domain.span(problem, "axle load share")
    light, heavy = problem.span("mass")
    weakest, slippery = plant_with(problem, weak)
    return Extremes(
        strong=vehicle,
        strong_rail=rail,
        weak=weakest,
        weak_rail=slippery,
        share=least_share,
        most=most_share * heavy / light * (1.0 + 1e-12),
        others=above(grip(problem) * constants().gravity),
    )
