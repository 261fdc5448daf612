"""Conclusions from the order of the stops in Table 10."""

from wspd_design.studies.paper.conclusions.records import Conclusion, Topic, Verdict, verdict
from wspd_design.studies.paper.evidence import (
    CONSTANT_RAILS,
    CONTROLLERS,
    FALLING_RAILS,
    RAILS,
    UNPROTECTED,
    Evidence,
    StopFigures,
)

AS_SHORT = 1.01  # a stop within 1 % is as short
MOSTLY = 0.5  # share of a difference that explains it


def shortest(evidence: Evidence) -> Conclusion:
    """Does the adaptive fuzzy law stop shortest?"""
    first = [evidence.ranking(rail)[0].controller == "afsmc" for rail in RAILS]
    said = []
    for rail in RAILS:
        ranking = evidence.ranking(rail)
        names = [each.controller for each in ranking]
        place = names.index("afsmc")
        if place == 0:
            said.append(f"{rail}: shortest, {_ahead(ranking[0], ranking[1])}")
        else:
            behind = ranking[place].metrics.distance - ranking[0].metrics.distance
            said.append(f"{rail}: place {place + 1} of {len(names)}, {behind:.1f} m behind {names[0]}")
    return Conclusion(
        name="shortest",
        topic=Topic.RANKING,
        claim="The adaptive fuzzy law shortens time and distance of the stop on every rail.",
        place="Table 10, Section 8",
        verdict=verdict(first),
        rule="its stop is the shortest of the four on each rail",
        finding="; ".join(said) + ".",
    )


def _ahead(first: StopFigures, second: StopFigures) -> str:
    gap = second.metrics.distance - first.metrics.distance
    return f"{gap:.1f} m ahead of {second.controller}"


def build_up(evidence: Evidence) -> Conclusion:
    """Does the control of slip make the differences, or the build-up of the brake?"""
    shares, said = [], []
    for rail in CONSTANT_RAILS:
        printed = evidence.published.on(rail)
        best, worst = (pick(printed.values(), key=lambda each: each.distance_m) for pick in (min, max))
        gap = worst.distance_m - best.distance_m
        lost = evidence.initial_speed * (worst.lag(evidence.initial_speed) - best.lag(evidence.initial_speed))
        ranking = evidence.ranking(rail)
        our_gap = ranking[-1].metrics.distance - ranking[0].metrics.distance
        our_lost = evidence.initial_speed * (ranking[-1].metrics.lag - ranking[0].metrics.lag)
        shares += [lost / gap, our_lost / our_gap]
        said.append(
            f"{rail}: of the printed {gap:.1f} m between {best.controller} and {worst.controller} "
            f"{lost:.1f} m are lag; here {our_lost:.1f} m of {our_gap:.1f} m"
        )
    return Conclusion(
        name="build-up",
        topic=Topic.RANKING,
        claim="The differences of Table 10 are differences in the control of slip.",
        place="Table 10, implied",
        verdict=verdict([share < MOSTLY for share in shares]),
        rule=f"the brake build-up, v0 times the lag, makes less than {100.0 * MOSTLY:.0f} % of the gap "
        "between the longest and the shortest stop",
        finding="; ".join(said) + ".",
    )


def locked(evidence: Evidence) -> Conclusion:
    """Does a short stop show controlled slip?"""
    pairs = [
        (evidence.stop(UNPROTECTED, rail).metrics, evidence.stop("afsmc", rail).metrics) for rail in RAILS
    ]
    longer = [locked.distance > AS_SHORT * law.distance for locked, law in pairs]
    said = [
        f"{rail}: locked {locked.distance:.1f} m, adaptive fuzzy {law.distance:.1f} m"
        for rail, (locked, law) in zip(RAILS, pairs, strict=True)
    ]
    return Conclusion(
        name="locked",
        topic=Topic.RANKING,
        claim="Short stops show that the slip is well controlled.",
        place="Section 7, implied",
        verdict=Verdict.HOLDS
        if all(longer)
        else Verdict.FAILS,  # one short stop with locked wheels denies it
        rule="on every rail, without any protection and wheels locked, the stop is more than 1 % longer",
        finding="; ".join(said) + ". Where the friction does not fall with the sliding speed, a locked wheel "
        "loses nothing, and no ranking can show the control of slip.",
    )


def robustness(evidence: Evidence) -> Conclusion:
    """Is the law the most efficient on the worse of two rails?"""
    worst = {
        (name, kind): min(evidence.stop(name, rail).metrics.efficiency for rail in kind)
        for kind in (CONSTANT_RAILS, FALLING_RAILS)
        for name in CONTROLLERS
    }
    good, said = [], []
    for kind, title in ((CONSTANT_RAILS, "constant friction"), (FALLING_RAILS, "falling friction")):
        good.append(max(CONTROLLERS, key=lambda name: worst[name, kind]) == "afsmc")
        said.append(
            f"{title}: " + ", ".join(f"{name} {100.0 * worst[name, kind]:.1f} %" for name in CONTROLLERS)
        )
    return Conclusion(
        name="robustness",
        topic=Topic.RANKING,
        claim="The law is more robust against the condition of the rail than the others.",
        place="Sections 7 and 8",
        verdict=verdict(good),
        rule="the lower of its efficiencies (ideal stop over distance) on dry and wet is the highest of the four",
        finding="; ".join(said) + ".",
    )
