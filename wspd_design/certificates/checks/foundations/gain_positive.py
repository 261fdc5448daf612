"""The input gain G = R/(2 I v) of (19) is positive: more torque always means more slip."""

from fractions import Fraction

from wspd_design.certificates.checks.frame import certified, enclosure
from wspd_design.certificates.kernel import exact
from wspd_design.certificates.kernel.exact import Positive
from wspd_design.certificates.records import Certificate, Point, Problem, Status
from wspd_design.certificates.setting.domain import KMH

NAME, TITLE = "gain_positive", "Sign of the input gain"
SHOWN = {"m/s": (KMH, "km/h")}  # scale and unit in which people read a quantity


def claims(problem: Problem) -> tuple[Positive, ...]:
    """Return what is claimed about the factors of G, each at its smallest.

    A quotient of three factors is positive on a box if each factor is.
    """
    factors = (
        ("wheel radius", problem.vehicle.wheel_radius, "m"),
        ("wheelset inertia", problem.inertia_bounds[0], "kg m2"),
        ("speed", problem.speeds[0], "m/s"),
    )
    return tuple(Positive(quantity=name, value=Fraction(least), unit=unit) for name, least, unit in factors)


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Decide the sign of G on the box in exact arithmetic."""
    settled = [(claim, exact.prove(claim)) for claim in claims(problem)]
    witness = tuple(_point(claim) for claim, proof in settled if proof is None)
    # The inertia of the bounds is that of a wheelset, 2 I; G is smallest where both inertia and speed are largest.
    largest = Fraction(problem.inertia_bounds[1]) * Fraction(problem.speeds[1])
    smallest = None if witness else Fraction(problem.vehicle.wheel_radius) / largest
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"G = R/(2 I v) > 0 for wheelset inertia {problem.inertia_bounds[0]:g} to "
        f"{problem.inertia_bounds[1]:g} kg m2 and {problem.speeds[0] * KMH:.3g} to "
        f"{problem.speeds[1] * KMH:.3g} km/h.",
        status=Status.PROVED if smallest is not None else Status.REFUTED,
        explanation=(
            "A factor of G is zero or negative in the box, so that G has no sign there; correct the bounds."
            if smallest is None
            else "More torque means more slip wherever the train is. G is smallest at the highest "
            f"speed and inertia, {float(smallest) * 1e6:.4g} 1/s per MN m."
        ),
        margin=None if smallest is None else enclosure(smallest, smallest, "1/(N m s)"),
        worst_point=()
        if smallest is None
        else (
            Point(name="wheelset inertia", value=problem.inertia_bounds[1], unit="kg m2"),
            Point(name="speed", value=problem.speeds[1] * KMH, unit="km/h"),
        ),
        witness=witness,
        hypotheses=tuple(exact.hypothesis(claim, proof) for claim, proof in settled),
        assumptions=("wheel radius without bounds",),
        method="exact rational arithmetic at the end points of the monotone quotient",
        resolution="exact",
        reference="eq. (19); docs/theory.md#slip-equation",
        proofs=tuple(proof for _, proof in settled if proof is not None),
    )


def _point(claim: Positive) -> Point:
    scale, unit = SHOWN.get(claim.unit, (1.0, claim.unit))
    return Point(name=claim.quantity, value=float(claim.value) * scale, unit=unit)
