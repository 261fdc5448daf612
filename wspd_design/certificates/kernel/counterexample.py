"""The point at which a claim is said to fail: evaluated again, in exact arithmetic."""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from math import isfinite

from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.claim import Claim, Variable, variable
from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.kernel.obligation import Obligation, statement
from wspd_design.certificates.records import Point
from wspd_design.certificates.setting.domain import KMH

ROUNDING = Fraction(1, 10**9)  # relative; a speed in km/h is not exactly that in m/s


def denials(
    wanted: Iterable[Obligation], witness: Iterable[Point], speeds: tuple[float, float]
) -> tuple[str, ...]:
    """Say which claims a witness denies.

    Parameters
    ----------
    wanted : iterable of Obligation
        Of a check; the inequalities are tried that its witness is to deny.
    witness : iterable of Point
        In the units that people read, from a file.
    speeds : tuple of float
        Of the domain [m/s].

    Returns
    -------
    tuple of str
        Empty if there is no claim that the witness has all quantities for.

    Raises
    ------
    Refused
        If there are such claims, and none of them is denied; or the witness leaves the domain.
    """
    wanted = tuple(wanted)
    given = {point.name: point for point in witness}
    claims = [each.denied for each in wanted if each.denied is not None]
    tried = [claim for claim in claims if all(v.name in given for v in claim.free)]
    denied = []
    for claim in tried:
        low, high = checker.value(claim, {v.name: _inside(v, given[v.name]) for v in claim.free})
        if (low > claim.bound) if claim.relation == "<=" else (high < claim.bound):
            denied.append(_sentence(claim, float((low + high) / 2), given))
    if tried and not denied:
        raise Refused(f"the witness denies nothing: there {' and '.join(map(statement, tried))} may hold")
    refutations = [each.refutation for each in wanted if each.refutation is not None]
    if refutations and "speed" in given:
        speed = float(_inside(variable("speed", speeds, "m/s"), given["speed"]))
        denied += [refutation(speed) for refutation in refutations]
    return tuple(denied)


def _inside(variable: Variable, point: Point) -> Fraction:
    """Return an exact value in the range of a variable, next to what the witness states."""
    if not isfinite(point.value):
        raise Refused(f"the witness states no {point.name}")
    value = Fraction(point.value / KMH if point.unit == "km/h" else point.value)
    within = min(max(value, variable.low), variable.high)
    if abs(within - value) > ROUNDING * abs(within):
        raise Refused(f"the witness leaves the domain: {point.name} = {point.value:g} {point.unit}")
    return within


def _sentence(claim: Claim, value: float, given: Mapping[str, Point]) -> str:
    shown = (given[v.name] for v in claim.free)
    place = ", ".join(f"{point.name} {point.value:.6g} {point.unit}".removesuffix(" -") for point in shown)
    return f"{statement(claim)}: it is {value:.6g} {claim.unit}".removesuffix(" -") + f" at {place}"
