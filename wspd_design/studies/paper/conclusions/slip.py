"""Conclusions about the course of the slip and of the torque."""

from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.studies.paper.conclusions.records import Conclusion, Topic, extent, verdict
from wspd_design.studies.paper.evidence import CONSTANT_RAILS, CONTROLLERS, FALLING_RAILS, RAILS, Evidence

SLIP_LIMIT = 0.3  # -, that the paper reads from Figure 13


def convergence(evidence: Evidence) -> Conclusion:
    """Does the slip settle at its reference?"""
    late = [evidence.stop("afsmc", rail).history.late_rms for rail in RAILS]
    said = [f"{rail} {rms:.3f}" for rail, rms in zip(RAILS, late, strict=True)]
    ripples = [f"{each.rail} {each.ripple:.3f} to {each.ideal_ripple:.3f}" for each in evidence.ablations]
    settled = sum(each.ideal_ripple <= evidence.slip_tolerance for each in evidence.ablations)
    return Conclusion(
        name="convergence",
        topic=Topic.SLIP,
        claim=f"The slip converges to {evidence.slip_reference:g}.",
        place="eq. (48), Section 7, Figure 15",
        verdict=verdict([rms <= evidence.slip_tolerance for rms in late]),
        rule=f"its rms about {evidence.slip_reference:g} in the second half of the time above 10 km/h is at most "
        f"{evidence.slip_tolerance:g}",
        finding=f"rms {', '.join(said)}. It circles in a limit cycle: the proof knows nothing of the valve with "
        f"its {evidence.fill_time:g} s. With a near-ideal actuator ({evidence.ideal_fill_time * 1e3:g} ms, sampled "
        f"every {evidence.ideal_sample_time * 1e3:g} ms) the ripple falls ({', '.join(ripples)}) and is inside "
        f"the tolerance on {settled} of {len(evidence.ablations)} rails.",
    )


def standstill(evidence: Evidence) -> Conclusion:
    """Does the slip diverge less near standstill?"""
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
        topic=Topic.SLIP,
        claim="It overcomes the divergence near standstill of Trenitalia and Knorr-Bremse.",
        place="Section 7, Figures 9, 11, 15",
        verdict=verdict(better),
        rule="its slip rms between 10 and 1 km/h is below that of both",
        finding=f"{'; '.join(said)}. From 10 km/h to standstill the train runs {extent(rest, 1)} m: "
        "what happens there hardly counts.",
    )


def mitsubishi(evidence: Evidence) -> Conclusion:
    """Does the Mitsubishi controller slide as Figure 13 shows?"""
    good, said = [], []
    for dry, wet in (CONSTANT_RAILS, FALLING_RAILS):
        on_dry, on_wet = (evidence.stop("mitsubishi", rail).metrics.slip_max for rail in (dry, wet))
        good.append(on_dry <= SLIP_LIMIT < on_wet)
        said.append(f"{dry} {on_dry:.2f}, {wet} {on_wet:.2f}")
    return Conclusion(
        name="mitsubishi",
        topic=Topic.SLIP,
        claim="With Mitsubishi the slip stays below 0.3 dry and diverges wet.",
        place="Section 7, Figure 13",
        verdict=verdict(good),
        rule=f"its largest slip above 10 km/h is at most {SLIP_LIMIT:g} dry and larger wet",
        finding=f"largest slip {'; '.join(said)}. The rule table is a reconstruction: its shape is lost with "
        "Figure 5.",
    )


def frequency(evidence: Evidence) -> Conclusion:
    """Do the torques swing as fast as Figures 17 to 20 show?"""
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
        topic=Topic.SLIP,
        claim="Torques swing slowest with Trenitalia, fastest with Mitsubishi, faster wet.",
        place="Section 7, Figures 17 to 20",
        verdict=verdict([*extremes, *wetter]),
        rule="it is so on each rail, and for each controller in each pair of rails",
        finding=f"cycles per second of more than 10 % of the maximum torque, on {', '.join(RAILS)}: "
        f"{'; '.join(said)}. The order is so on {sum(extremes)} of {len(extremes)} rails, and "
        f"wet is faster in {sum(wetter)} of {len(wetter)} pairs.",
    )
