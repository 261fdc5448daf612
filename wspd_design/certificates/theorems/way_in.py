"""The way in: what the slip does from rolling to the reference, while the brake builds up.

See :mod:`wspd_design.certificates.theorems.slip_band` for motion, proof and checker of strips, and
:mod:`wspd_design.certificates.theorems.from_rolling` for cells: what a sample makes of a state stands in
docs/theory.md#all-ways-in, and what bounds it in docs/theory.md#bounds-of-ways-in.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from math import floor
from typing import Any, cast

from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, Special
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import CONTACT, RAIL
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.theorems import band
from wspd_design.certificates.theorems.from_rolling import ways_in
from wspd_design.certificates.theorems.slip_band.friction import FRICTION
from wspd_design.certificates.theorems.slip_band.statement import NAMES, windows_of
from wspd_design.certificates.theorems.slip_band.way_in import (
    NEAR,
    VARIED,
    around,
    checker,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.references import ConstantSlip
from wspd_design.parameters.units import KMH

STRIPS = "strips"
IN_CELLS = ways_in.CELLS  # among the numbers of a proof in cells
BAND = "band 0 above"  # among the numbers if there is a band
ARRIVED = 0.01  # -, distance from the reference at which the slip has come to it
RESISTANCE = tuple(f"resistance {part}" for part in ("constant", "linear", "quadratic"))


def speaks_about(problem: Problem) -> str:
    """Say why the theorem does not speak about a law; empty if it does."""
    reason = band.speaks_about(problem)
    if reason:
        return reason
    law = problem.controller
    if not isinstance(law, Protection):
        return "is followed from rolling by no code but its own"
    if not isinstance(law.reference, ConstantSlip):
        return "holds no constant slip"
    if law.wheel_radius != problem.vehicle.wheel_radius:
        return "counts with another wheel radius than the nominal one"
    return ""


def held_names(problem: Problem) -> tuple[str, ...]:
    """Names of the numbers with bounds that the way in depends on and the claim holds."""
    used = {*NAMES, *CONTACT, *RAIL, *RESISTANCE} - {*VARIED}
    return tuple(name for name in domain.uncertain(problem) if name in used)


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem, (*NAMES, *VARIED))
    if not problem.speeds[1] > 0.0:
        raise OutsideModel("the train stands still")
    law = cast(Protection, problem.controller)
    return (
        *(Inequality(key=name, claim=claim) for name, claim in band.claims(around(problem)).items()),
        Special(
            key=STRIPS,
            text="strips of friction and supply rate, or cells of all numbers, cover both ranges, and of each, with "
            "the other numbers anywhere within a share of their ranges about the nominal values, the loop is enclosed "
            "from rolling until the slip has reached its reference, and the wheels are in the ellipsoid of a band "
            "where one is given",
            check=_decided(problem, law),
        ),
    )


def _decided(problem: Problem, law: Protection) -> Callable[[Mapping[str, Any], Work], dict[str, float]]:
    """Return what decides about a proof in strips, or in cells."""

    def check(proof: Mapping[str, Any], work: Work) -> dict[str, float]:
        decides = ways_in.checker if proof.get("format") == ways_in.FORMAT else checker
        return decides(problem, law)(proof, work)

    return check


def _tell(problem: Problem, findings: Findings) -> Certificate:
    strips, held = _after(problem, findings), held_names(problem)
    low, high = problem.span(FRICTION)
    speed, share = problem.speeds[1] * KMH, _share(strips)
    near = around(problem, share)
    claim = (
        f"From rolling at {speed:.4g} km/h, the brake demanded and its cylinders empty, the slip of every wheelset "
        f"comes to its reference {problem.slip:g} and goes beyond it no further than is told; for every supply rate "
        f"and every mu0 in their ranges, {_others(share)}; sampled every "
        f"{problem.sample_time * 1e3:g} ms."
    )
    if BAND in strips.numbers:
        claim += f" From there it stays in a band around it down to {problem.speeds[0] * KMH:.3g} km/h."
    status, margin = all_of(strips), None
    worst: tuple[Point, ...] = ()
    explanation = (
        "The enclosure of some strip or cell is lost, or there is no budget for as many as would hold."
    )
    if strips.status is Status.PROVED:
        found = strips.numbers
        explanation = (
            f"The slip is never above {found['largest slip']:.4g}, at no instant, for {found['time']:.3g} s at most; "
            f"at the end of what is followed it is within {max(found['above'], 0.0):.2g} above and "
            f"{max(found['below'], 0.0):.2g} below its reference, and the supply has {100.0 * found['supply']:.3g} % "
            "of its full pressure or more. "
            f"{_rest_of_the_stop(problem, strips)}"
        )
        if max(found["above"], found["below"]) > ARRIVED:
            status = Status.UNDECIDED
            explanation = f"What is followed ends where the slip has not come to its reference. {explanation}"
        elif found["friction low"] > low or high > found["friction high"]:
            status = Status.UNDECIDED
            explanation = (
                f"Shown for {_friction(found['friction low'], found['friction high'])}. {explanation}"
            )
        else:
            margin = Range(low=1.0 - found["largest slip"], high=None, unit="-")
            worst = (Point(name="slip", value=found["largest slip"], unit="-"),)
    return Certificate(
        claim=claim,
        status=status,
        explanation=explanation,
        margin=margin,
        worst_point=worst,
        hypotheses=(hypothesis(strips.asked, strips),),
        assumptions=(
            f"{_others(share)}; resistance, contact and shape of the friction are the nominal ones; nothing changes on "
            "the way",
            "wheel speed, cylinder pressure and train speed are measured exactly, without noise and dead time; the "
            "scale of the train speed was found while rolling",
            "all axles at static load and alike; pulses begin with the sample; the law computes with real numbers",
            "for the band: while the train slows down the deceleration rises as slip_band assumes",
        ),
        domain=domain.domain_of(
            near, (*VARIED, *_near(near)), [name for name in held if name not in _near(near)]
        ),
        varied=VARIED,
        held=held,
        method=f"{_arithmetic(strips)}; the law that is followed is compared with the one that runs at 96 points; "
        "functions of NumPy are taken to be within 8 units in the last place",
        reference="docs/theory.md#ways-in-cells" if IN_CELLS in strips.numbers else "docs/theory.md#way-in",
    )


def _arithmetic(strips: Finding) -> str:
    """Say how the loop was enclosed."""
    if IN_CELLS in strips.numbers:
        return (
            f"{strips.numbers[IN_CELLS]:g} cells of all numbers, in intervals and polytopes in doubles with outward "
            "rounding"
        )
    return "strips, in affine arithmetic in doubles with outward rounding, Picard's iteration between samples"


def _share(strips: Finding) -> Fraction:
    """Share of the ranges of the other numbers that was shown; none if nothing was."""
    shown = strips.status is Status.PROVED
    return Fraction(strips.numbers["share"]) if shown else Fraction(0)


def _others(share: Fraction) -> str:
    """Say where the numbers beside friction and supply rate are."""
    names = f"{', '.join(NEAR[:-1])} and {NEAR[-1]}"
    percent = floor(share * 10**6) / 10**4
    if not share:
        return f"{names}, and all other numbers, at their nominal values"
    return (
        f"each of {names} no farther from its nominal value than {percent:g} % of the way to either "
        "end of its range, and all other numbers at their nominal values"
    )


def _near(near: Problem) -> tuple[str, ...]:
    """Names of the numbers that lie within a share of their ranges."""
    return tuple(name for name in domain.uncertain(near) if name in NEAR)


def _after(problem: Problem, findings: Findings) -> Finding:
    """Return the finding on the strips; its band counts only for friction within the bounds that it was made for."""
    found = findings[STRIPS]
    if found.status is Status.PROVED and BAND in found.numbers:
        return band.covered(around(problem), findings, STRIPS)
    return found


def _rest_of_the_stop(problem: Problem, strips: Finding) -> str:
    """Say what comes after."""
    if BAND not in strips.numbers:
        return "What comes after is not shown."
    low, told = problem.speeds[0] * KMH, band.bands(windows_of(around(problem)), strips)
    return (
        "The wheels, with the filter of the acceleration, are then in the ellipsoid of a band, and the supply "
        f"has what the band asks for. From there down to {low:.3g} km/h: {told}"
    )


def _friction(low: float, high: float) -> str:
    return (
        f"mu0 = {low:.4g} alone"
        if low == high
        else f"mu0 from {low:.4g} to {high:.4g}, not over all of its range"
    )


SLIP_WAY_IN = Theorem(
    name="slip_way_in",
    title="Slip on the way from rolling to the reference",
    claim="From rolling, the slip comes to its reference and goes hardly beyond it.",
    speaks_about=speaks_about,
    obligations=_obligations,
    tell=_tell,
)
