"""The input gain G = R/(2 I v) of (19) is positive: more torque always means more slip."""

from fractions import Fraction

from wspd_design.certificates.checking import certified, enclosure
from wspd_design.certificates.domain import KMH
from wspd_design.certificates.records import Certificate, Point, Problem, Status

NAME, TITLE = "gain_positive", "Sign of the input gain"


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Decide the sign of G on the box in exact arithmetic.

    A quotient of three factors is positive on a box exactly if each factor is; then it is smallest where both
    inertia and speed are largest.
    """
    radius = Fraction(problem.vehicle.wheel_radius)
    factors = (
        ("wheel radius", (problem.vehicle.wheel_radius,) * 2, 1.0, "m"),
        ("wheelset inertia", problem.inertia_bounds, 1.0, "kg m2"),
        ("speed", problem.speeds, KMH, "km/h"),
    )
    witness = tuple(
        Point(name=name, value=low * scale, unit=unit)
        for name, (low, _), scale, unit in factors
        if Fraction(low) <= 0
    )
    claim = (
        f"G = R/(2 I v) > 0 for wheelset inertia {problem.inertia_bounds[0]:g} to "
        f"{problem.inertia_bounds[1]:g} kg m2 and {problem.speeds[0] * KMH:.3g} to "
        f"{problem.speeds[1] * KMH:.3g} km/h."
    )
    method = "exact rational arithmetic at the end points of the monotone quotient"
    if witness:
        return Certificate(
            name=NAME,
            title=TITLE,
            claim=claim,
            status=Status.REFUTED,
            explanation="A factor of G is zero or negative in the box, so that G has no sign there; "
            "correct the bounds.",
            witness=witness,
            method=method,
            resolution="exact",
            reference="eq. (19)",
        )
    # The inertia of the bounds is that of a wheelset, 2 I.
    smallest = radius / (Fraction(problem.inertia_bounds[1]) * Fraction(problem.speeds[1]))
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=claim,
        status=Status.PROVED,
        explanation="More torque means more slip wherever the train is. G is smallest at the highest "
        f"speed and inertia, {float(smallest) * 1e6:.4g} 1/s per MN m.",
        margin=enclosure(smallest, smallest, "1/(N m s)"),
        worst_point=(
            Point(name="wheelset inertia", value=problem.inertia_bounds[1], unit="kg m2"),
            Point(name="speed", value=problem.speeds[1] * KMH, unit="km/h"),
        ),
        assumptions=("wheel radius without bounds",),
        method=method,
        resolution="exact",
        reference="eq. (19)",
    )
