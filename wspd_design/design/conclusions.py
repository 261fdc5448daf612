"""Which of the paper's conclusions hold: each is judged by a stated rule from computed numbers alone."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from wspd_design.design.evidence import (
    CONSTANT_RAILS,
    CONTROLLERS,
    FALLING_RAILS,
    RAILS,
    UNPROTECTED,
    Evidence,
    StopFigures,
)
from wspd_design.design.table10 import relative_range
from wspd_design.simulation.stop import JUDGING_SPEED

AS_SHORT = 1.01  # a stop within 1 % is as short
MOSTLY = 0.5  # share of a difference that explains it
SAME = 0.01  # relative change of the distance that is none
RELAY_SHARE = 0.95  # of samples with full or no brake: a relay
RELAY_WEIGHT = 10.0  # maximum torques: beyond it the rules only choose a sign
PROPORTIONAL = 0.1  # relative range of a ratio that is constant
SLIP_LIMIT = 0.3  # -, that the paper reads from Figure 13


class Verdict(Enum):
    """What the numbers say about a conclusion."""

    HOLDS = "holds"
    PARTLY = "holds in part"
    FAILS = "does not hold"


@dataclass(frozen=True, slots=True, kw_only=True)
class Conclusion:
    """A conclusion of the paper with what our stops say about it."""

    name: str
    claim: str  # in the paper's sense, and where it stands
    place: str
    verdict: Verdict
    rule: str  # when it would hold
    finding: str  # the numbers, and why


def conclusions(evidence: Evidence) -> tuple[Conclusion, ...]:
    """Judge the conclusions of the paper.

    Parameters
    ----------
    evidence : Evidence
        Computed stops, the printed table and the paper's law with parts taken out.
    """
    return tuple(judge(evidence) for judge in _JUDGES)


def _shortest(evidence: Evidence) -> Conclusion:
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
        claim="The adaptive fuzzy law shortens time and distance of the stop on every rail.",
        place="Table 10, Section 8",
        verdict=_verdict(first),
        rule="its stop is the shortest of the four on each rail",
        finding="; ".join(said) + ".",
    )


def _ahead(first: StopFigures, second: StopFigures) -> str:
    gap = second.metrics.distance - first.metrics.distance
    return f"{gap:.1f} m ahead of {second.controller}"


def _build_up(evidence: Evidence) -> Conclusion:
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
        claim="The differences of Table 10 are differences in the control of slip.",
        place="Table 10, Section 7",
        verdict=_verdict([share < MOSTLY for share in shares]),
        rule=f"the brake build-up, v0 times the lag, makes less than {MOSTLY:.0%} of the gap between the longest "
        "and the shortest stop",
        finding="; ".join(said) + ".",
    )


def _locked(evidence: Evidence) -> Conclusion:
    pairs = [
        (evidence.stop(UNPROTECTED, rail).metrics, evidence.stop("afsmc", rail).metrics) for rail in RAILS
    ]
    said = [
        f"{rail}: locked {locked.distance:.1f} m, adaptive fuzzy {law.distance:.1f} m"
        for rail, (locked, law) in zip(RAILS, pairs, strict=True)
    ]
    return Conclusion(
        name="locked",
        claim="Short stops show that the slip is well controlled.",
        place="Section 7",
        verdict=_verdict([locked.distance > AS_SHORT * law.distance for locked, law in pairs]),
        rule="without any protection, wheels locked, the stop is more than 1 % longer",
        finding="; ".join(said) + ". Where the friction does not fall with the sliding speed, a locked wheel "
        "loses nothing, and no ranking can show the control of slip.",
    )


def _convergence(evidence: Evidence) -> Conclusion:
    late = [evidence.stop("afsmc", rail).history.late_rms for rail in RAILS]
    said = [f"{rail} {rms:.3f}" for rail, rms in zip(RAILS, late, strict=True)]
    ripples = [f"{each.rail} {each.ripple:.3f} to {each.ideal_ripple:.3f}" for each in evidence.ablations]
    settled = sum(each.ideal_ripple <= evidence.slip_tolerance for each in evidence.ablations)
    return Conclusion(
        name="convergence",
        claim=f"The slip converges to {evidence.slip_reference:g}.",
        place="eq. (48), Section 7, Figure 15",
        verdict=_verdict([rms <= evidence.slip_tolerance for rms in late]),
        rule=f"its rms about {evidence.slip_reference:g} in the second half of the time above 10 km/h is at most "
        f"{evidence.slip_tolerance:g}",
        finding=f"rms {', '.join(said)}. It circles in a limit cycle: the proof knows nothing of the valve with "
        f"its {evidence.fill_time:g} s. With a near-ideal actuator ({evidence.ideal_fill_time * 1e3:g} ms, sampled "
        f"every {evidence.ideal_sample_time * 1e3:g} ms) the ripple falls ({', '.join(ripples)}) and is inside "
        f"the tolerance on {settled} of {len(evidence.ablations)} rails.",
    )


def _standstill(evidence: Evidence) -> Conclusion:
    better, said = [], []
    for rail in RAILS:
        own, *others = (
            evidence.stop(name, rail).history.standstill_rms
            for name in ("afsmc", "trenitalia", "knorr-bremse")
        )
        better.append(own < min(others))
        said.append(f"{rail} {own:.2f} against {others[0]:.2f} and {others[1]:.2f}")
    rest = [JUDGING_SPEED**2 / (2.0 * evidence.stop("afsmc", rail).metrics.plateau) for rail in RAILS]
    return Conclusion(
        name="standstill",
        claim="It overcomes the divergence near standstill of Trenitalia and Knorr-Bremse.",
        place="Section 7, Figures 9, 11, 15",
        verdict=_verdict(better),
        rule="its slip rms between 10 and 1 km/h is below that of both",
        finding=f"{'; '.join(said)}. From 10 km/h to standstill the train runs {min(rest):.1f} to "
        f"{max(rest):.1f} m: what happens there hardly counts.",
    )


def _mitsubishi(evidence: Evidence) -> Conclusion:
    good, said = [], []
    for dry, wet in (CONSTANT_RAILS, FALLING_RAILS):
        on_dry, on_wet = (evidence.stop("mitsubishi", rail).metrics.slip_max for rail in (dry, wet))
        good.append(on_dry <= SLIP_LIMIT < on_wet)
        said.append(f"{dry} {on_dry:.2f}, {wet} {on_wet:.2f}")
    return Conclusion(
        name="mitsubishi",
        claim="With Mitsubishi the slip stays below 0.3 on dry rails and diverges on wet ones.",
        place="Section 7, Figure 13",
        verdict=_verdict(good),
        rule=f"its largest slip above 10 km/h is at most {SLIP_LIMIT:g} dry and larger wet",
        finding=f"largest slip {'; '.join(said)}. The rule table is a reconstruction: its shape is lost with "
        "Figure 5.",
    )


def _air(evidence: Evidence) -> Conclusion:
    stops = [evidence.stop(name, rail).metrics for rail in CONSTANT_RAILS for name in CONTROLLERS]
    torques, air = [each.torque_integral for each in stops], [each.vented_air for each in stops]
    printed = [each.torque_integral_kNms for each in evidence.published.stops]
    ratio = relative_range([a / t for a, t in zip(air, torques, strict=True)])
    return Conclusion(
        name="air",
        claim="The torque integral measures the consumption of air.",
        place="Section 7, Table 10",
        verdict=Verdict.HOLDS if ratio <= PROPORTIONAL else Verdict.FAILS,
        rule=f"vented air over torque integral varies by at most {PROPORTIONAL:.0%} over the stops of the table",
        finding=f"the torque integral follows from the initial momentum, whatever the controller does: its range is "
        f"{100.0 * relative_range(printed):.2f} % as printed and {100.0 * relative_range(torques):.2f} % here, "
        f"while the vented air goes from {min(air):.1f} to {max(air):.1f} full cylinders per wheelset.",
    )


def _relay(evidence: Evidence) -> Conclusion:
    saturated = [evidence.stop("afsmc", rail).metrics.saturated_share for rail in RAILS]
    changes = [abs(each.relay / each.printed - 1.0) for each in evidence.ablations]
    smooth = [share < RELAY_SHARE and change > SAME for share, change in zip(saturated, changes, strict=True)]
    return Conclusion(
        name="relay",
        claim="The law avoids the excessive switching of sliding-mode control.",
        place="Section 8",
        verdict=_verdict(smooth),
        rule=f"it commands more than full or no brake in at least {1.0 - RELAY_SHARE:.0%} of the samples, and a "
        "plain relay on s stops differently by more than 1 %",
        finding=f"the duty is 0 or 1 in {100.0 * min(saturated):.1f} to {100.0 * max(saturated):.1f} % of the "
        "samples. A relay that fills where s > 0 and vents elsewhere, with neither rules nor adaptation, changes "
        f"the distance by {100.0 * min(changes):.2f} to {100.0 * max(changes):.2f} %.",
    )


def _adaptation(evidence: Evidence) -> Conclusion:
    changes = [abs(each.unadapted / each.as_share - 1.0) for each in evidence.ablations]
    weights = [each.largest_weight for each in evidence.ablations]
    useful = [
        change > SAME and weight < RELAY_WEIGHT for change, weight in zip(changes, weights, strict=True)
    ]
    growth = [each.bound_growth for each in evidence.ablations]
    stranded = [each.unadapted_printed for each in evidence.ablations]
    return Conclusion(
        name="adaptation",
        claim="The unknown bound of the uncertainty is estimated online, and the rules are learned.",
        place="Sections 6 and 8",
        verdict=_verdict(useful),
        rule=f"without adaptation the distance changes by more than 1 %, and the weights stay below "
        f"{RELAY_WEIGHT:g} times the maximum torque",
        finding=f"with the command read as a share of the maximum torque, switching the adaptation off changes the "
        f"distance by {100.0 * min(changes):.2f} to {100.0 * max(changes):.2f} %. Read in kN m, the weights grow to "
        f"{min(weights):.0f} to {max(weights):.0f} times the maximum torque and the bound to "
        f"{min(growth):.0f} to {max(growth):.0f} times its start, until the law is a relay; without adaptation the "
        f"brake then hardly acts, and the train runs {min(stranded):.0f} to {max(stranded):.0f} m.",
    )


def _frequency(evidence: Evidence) -> Conclusion:
    extremes, wetter = [], []
    for dry, wet in (CONSTANT_RAILS, FALLING_RAILS):
        for rail in (dry, wet):
            by = sorted(CONTROLLERS, key=lambda name: evidence.stop(name, rail).history.torque_frequency)
            extremes.append(by[0] == "trenitalia" and by[-1] == "mitsubishi")
        wetter += [
            evidence.stop(name, wet).history.torque_frequency
            > evidence.stop(name, dry).history.torque_frequency
            for name in CONTROLLERS
        ]
    said = [
        f"{name} " + ", ".join(f"{evidence.stop(name, rail).history.torque_frequency:.2f}" for rail in RAILS)
        for name in CONTROLLERS
    ]
    return Conclusion(
        name="frequency",
        claim="The torque swings slowest with Trenitalia and fastest with Mitsubishi, and faster on wet rails.",
        place="Section 7, Figures 17 to 20",
        verdict=_verdict([*extremes, *wetter]),
        rule="it is so on each rail, and for each controller in each pair of rails",
        finding=f"cycles per second of more than 10 % of the maximum torque, on {', '.join(RAILS)}: "
        f"{'; '.join(said)}. The order is so on {sum(extremes)} of {len(extremes)} rails, and "
        f"wet is faster in {sum(wetter)} of {len(wetter)} pairs.",
    )


def _robustness(evidence: Evidence) -> Conclusion:
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
        claim="The law is more robust against the condition of the rail than the others.",
        place="Sections 7 and 8",
        verdict=_verdict(good),
        rule="the lower of its efficiencies (bound over distance) on dry and wet is the highest of the four",
        finding="; ".join(said) + ".",
    )


def _friction(evidence: Evidence) -> Conclusion:
    good, said = [], []
    for rail, falling in zip(CONSTANT_RAILS, FALLING_RAILS, strict=True):
        ideal = evidence.yardstick(falling)
        printed = min(each.distance_m for each in evidence.published.on(rail).values())
        good.append(printed >= ideal.bound)
        said.append(
            f"{falling}: shortest printed stop {printed:.1f} m, bound {ideal.bound:.1f} m, slip held at "
            f"{evidence.slip_reference:g} {ideal.constant_slip:.1f} m"
        )
    return Conclusion(
        name="friction",
        claim="The simulations use the friction of Polach (2005).",
        place="Section 3, Table 1",
        verdict=Verdict.HOLDS if all(good) else Verdict.FAILS,
        rule="no printed stop is shorter than a brake of the same build-up at the adhesion peak could be",
        finding="; ".join(said) + ". The table fits friction that does not fall with the sliding speed.",
    )


def _load(evidence: Evidence) -> Conclusion:
    low, high = evidence.load_range
    stop = evidence.stop("afsmc", CONSTANT_RAILS[1]).history
    return Conclusion(
        name="weight",
        claim="Braking shifts weight to the front wheelsets.",
        place="Section 7, Figure 21",
        verdict=Verdict.HOLDS if high > AS_SHORT * low else Verdict.FAILS,
        rule="on the wet rail the heaviest wheelset carries more than 1 % more than the lightest",
        finding=f"{low / 1e3:.0f} to {high / 1e3:.0f} kN on a wheelset; mean slip of the front bogie "
        f"{stop.front_mean:.3f}, of the rear bogie {stop.rear_mean:.3f}.",
    )


_JUDGES = (
    _shortest,
    _build_up,
    _locked,
    _robustness,
    _convergence,
    _relay,
    _adaptation,
    _standstill,
    _mitsubishi,
    _frequency,
    _air,
    _friction,
    _load,
)


def _verdict(parts: Sequence[bool]) -> Verdict:
    """All parts hold, some or none."""
    if all(parts):
        return Verdict.HOLDS
    return Verdict.PARTLY if any(parts) else Verdict.FAILS
