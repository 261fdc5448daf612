"""Where the adhesion of a wheel is extreme, so that no claim has to search all numbers of rail and contact at once.

With q the stiffness of the contact over the load, times the slip, the adhesion is

    f = (2/pi) load friction H,   H = w/(1 + w^2) + atan(s),   w = kA q / friction,   s = kS q / friction.

At a given slip, speed and load

* f rises with the friction: its slope is that of 2 w^3/(1 + w^2)^2 + atan(s) - s/(1 + s^2), which is not negative.
  Hence with mu0 and with the friction ratio, and it falls with the friction decay;
* f rises with kS, since atan does;
* at a given w, f rises with s/w = kS/kA. Every w that kA in [kA1, kA2] and q in [q1, q2] give is also that of kA1 and
  some q, or of q2 and some kA: there f is largest. It is smallest at kA2 and some q, or at q1 and some kA;
* q is a product of powers of the numbers of the contact: changed one after the other from the end that makes q small to
  the end that makes it large, they give every q.

What rises with f at a given slip, speed, load and deceleration is therefore extreme on the edges that are named here.
The deceleration of a train whose wheels are all alike rises with f as well. Where the deceleration is a quantity of its
own, the load counts for f alone. q falls with a power of the load that is at most 1, so that the slope of f over the
load has at least the sign of H - (w H_w + s H_s), the slope over the friction, or of H: f rises with the load, that is
with the mass and the share of the axle. The resistance then counts for the deceleration alone.
"""

from collections.abc import Iterator, Mapping
from typing import TypeAlias

from wspd_design.certificates.quantities import AXLE, CONTACT, RAIL
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain
from wspd_design.parameters.bounds import Ends

Ranges: TypeAlias = Mapping[str, float | Ends]

RISING = ("mu0", "friction ratio", "slip reduction")
FALLING = ("friction decay",)
LESS_STIFF = ("reference load",)
"""Number of the contact that makes q smaller; all others make it larger."""
LOAD = ("mass", AXLE[0])
RESISTANCE = ("resistance constant", "resistance linear", "resistance quadratic")


def adhesion_edges(problem: Problem, *, most: bool, axle: bool) -> dict[str, Ranges]:
    """Return ranges of the numbers of rail and contact on which the adhesion takes its extreme.

    Parameters
    ----------
    problem : Problem
        With the bounds of rail and contact.
    most : bool
        Whether the largest adhesion is meant.
    axle : bool
        Whether the claim is one about every axle, with load share and deceleration as quantities of their own.

    Returns
    -------
    dict
        Ranges by the name of the number that varies on the edge; a number without bounds makes no edge.
    """
    end = int(most)
    base: dict[str, float | Ends] = {name: problem.span(name)[end] for name in RISING}
    base |= {name: problem.span(name)[1 - end] for name in FALLING}
    if axle:
        base |= {name: domain.span(problem, name)[end] for name in LOAD}
        base |= {name: problem.nominal(name) for name in RESISTANCE}
    weak = problem.span("adhesion reduction")
    found: dict[str, Ranges] = {
        name: base | {"adhesion reduction": weak[1 - end]} | ranges for name, ranges in _stiffening(problem)
    }
    if weak[0] < weak[1] or not found:
        found["adhesion reduction"] = base | {"adhesion reduction": weak} | _stiffness(problem, end)
    return found


def _stiffening(problem: Problem) -> Iterator[tuple[str, dict[str, float | Ends]]]:
    """Yield the edges from the smallest to the largest stiffness."""
    loose, stiff = (_stiffness(problem, end) for end in (0, 1))
    for place, name in enumerate(CONTACT):
        low, high = problem.span(name)
        if low < high:
            ends = {each: stiff[each] for each in CONTACT[:place]} | {
                each: loose[each] for each in CONTACT[place + 1 :]
            }
            yield name, {**ends, name: (low, high)}


def _stiffness(problem: Problem, end: int) -> dict[str, float | Ends]:
    return {name: problem.span(name)[1 - end if name in LESS_STIFF else end] for name in CONTACT}


assert set(RAIL) == {*RISING, *FALLING, "adhesion reduction"}  # every number of a rail has its place
