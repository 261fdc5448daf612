"""Conclusions about what was simulated and measured."""

from wspd_design.studies.paper.conclusions.records import Conclusion, Topic, Verdict, extent
from wspd_design.studies.paper.evidence import CONSTANT_RAILS, CONTROLLERS, FALLING_RAILS, Evidence
from wspd_design.studies.paper.table10 import relative_range

PROPORTIONAL = 0.1  # relative range of a ratio that is constant
SHIFTED = 1.01  # heaviest over lightest wheelset


def air(evidence: Evidence) -> Conclusion:
    """Is the torque integral proportional to the vented air?"""
    stops = [evidence.stop(name, rail).metrics for rail in CONSTANT_RAILS for name in CONTROLLERS]
    torques, air = [each.torque_integral for each in stops], [each.vented_air for each in stops]
    printed = [each.torque_integral_kNms for each in evidence.published.stops]
    ratio = relative_range([a / t for a, t in zip(air, torques, strict=True)])
    return Conclusion(
        name="air",
        topic=Topic.SETTING,
        claim="The torque integral measures the consumption of air.",
        place="Section 7, Table 10",
        verdict=Verdict.HOLDS if ratio <= PROPORTIONAL else Verdict.FAILS,
        rule=f"vented air over torque integral varies by at most {100.0 * PROPORTIONAL:.0f} % over the "
        "stops of the table",
        finding=f"the torque integral follows from the initial momentum, whatever the controller does: its range is "
        f"{100.0 * relative_range(printed):.2f} % as printed and {100.0 * relative_range(torques):.2f} % here, "
        f"while the vented air is {extent(air, 1)} full cylinders per wheelset.",
    )


def friction(evidence: Evidence) -> Conclusion:
    """Could the printed stops happen on the cited friction?"""
    good, said = [], []
    for rail, falling in zip(CONSTANT_RAILS, FALLING_RAILS, strict=True):
        ideal = evidence.yardstick(falling)
        printed = min(each.distance_m for each in evidence.published.on(rail).values())
        good.append(printed >= ideal.ideal_stop)
        said.append(
            f"{falling}: shortest printed stop {printed:.1f} m, ideal stop {ideal.ideal_stop:.1f} m, slip held at "
            f"{evidence.slip_reference:g} {ideal.constant_slip:.1f} m"
        )
    return Conclusion(
        name="friction",
        topic=Topic.SETTING,
        claim="The simulations use the friction of Polach (2005).",
        place="Section 3, Table 1",
        verdict=Verdict.HOLDS if all(good) else Verdict.FAILS,
        rule="no printed stop is shorter than a brake of the same build-up at the adhesion peak could be",
        finding="; ".join(said) + ". The table fits friction that does not fall with the sliding speed.",
    )


def weight(evidence: Evidence) -> Conclusion:
    """Does braking shift weight?"""
    low, high = min(evidence.mean_loads), max(evidence.mean_loads)
    stop = evidence.stop("afsmc", CONSTANT_RAILS[1]).history
    return Conclusion(
        name="weight",
        topic=Topic.SETTING,
        claim="Braking shifts weight to the front wheelsets.",
        place="Section 7, Figure 21",
        verdict=Verdict.HOLDS if high > SHIFTED * low else Verdict.FAILS,
        rule="on the wet rail the heaviest wheelset carries more than 1 % more than the lightest",
        finding=f"{low / 1e3:.0f} to {high / 1e3:.0f} kN on a wheelset; mean slip of the front bogie "
        f"{stop.front_mean:.3f}, of the rear bogie {stop.rear_mean:.3f}.",
    )


def grouping(evidence: Evidence) -> Conclusion:
    """Do both front wheelsets carry more than both rear ones?"""
    middle = len(evidence.mean_loads) // 2
    front, rear = evidence.mean_loads[:middle], evidence.mean_loads[middle:]
    by_load = sorted(enumerate(evidence.mean_loads, start=1), key=lambda pair: -pair[1])
    order = ", ".join(f"{number} with {load / 1e3:.0f} kN" for number, load in by_load)
    return Conclusion(
        name="grouping",
        topic=Topic.SETTING,
        claim="Both front wheelsets carry more than both rear ones.",
        place="Section 7, Figures 15, 16 and 21, implied",
        verdict=Verdict.HOLDS if min(front) > max(rear) else Verdict.FAILS,
        rule="on the wet rail each wheelset of the front bogie carries more than each of the rear one",
        finding=f"from the heaviest, counted from the front: {order}. How far the pitch of a bogie counts beside that "
        "of the body follows from the height of the traction rods, which the paper does not print.",
    )
