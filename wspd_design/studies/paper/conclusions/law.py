"""Conclusions about the adaptive fuzzy law itself."""

from wspd_design.studies.paper.conclusions.records import Conclusion, Topic, extent, verdict
from wspd_design.studies.paper.evidence import RAILS, Evidence

SAME = 0.01  # relative change of the distance that is none
RELAY_SHARE = 0.95  # of samples with full or no brake: a relay
RELAY_WEIGHT = 10.0  # maximum torques: beyond it the rules only choose a sign


def relay(evidence: Evidence) -> Conclusion:
    """Is the law more than a relay?"""
    saturated = [evidence.stop("afsmc", rail).metrics.saturated_share for rail in RAILS]
    changes = [abs(each.relay / each.printed - 1.0) for each in evidence.ablations]
    smooth = [share < RELAY_SHARE and change > SAME for share, change in zip(saturated, changes, strict=True)]
    return Conclusion(
        name="relay",
        topic=Topic.LAW,
        claim="The law avoids the excessive switching of sliding-mode control.",
        place="Section 8",
        verdict=verdict(smooth),
        rule=f"it commands more than full or no brake in at least {100.0 * (1.0 - RELAY_SHARE):.0f} % of the "
        "samples, and a plain relay on s stops differently by more than 1 %",
        finding=f"the duty is 0 or 1 in {extent([100.0 * each for each in saturated], 1)} % of the "
        "samples. A relay that fills where s > 0 and vents elsewhere, with neither rules nor adaptation, changes "
        f"the distance by {extent([100.0 * each for each in changes], 2)} %.",
    )


def adaptation(evidence: Evidence) -> Conclusion:
    """Does the adaptation do something useful?"""
    changes = [abs(each.unadapted / each.as_share - 1.0) for each in evidence.ablations]
    weights = [each.largest_weight for each in evidence.ablations]
    useful = [
        change > SAME and weight < RELAY_WEIGHT for change, weight in zip(changes, weights, strict=True)
    ]
    growth = [each.bound_growth for each in evidence.ablations]
    stranded = [each.unadapted_printed for each in evidence.ablations]
    return Conclusion(
        name="adaptation",
        topic=Topic.LAW,
        claim="The bound on the uncertainty is estimated and the rules learned online.",
        place="Sections 6 and 8",
        verdict=verdict(useful),
        rule=f"without adaptation the distance changes by more than 1 %, and the weights stay below "
        f"{RELAY_WEIGHT:g} times the maximum torque",
        finding=f"with the command read as a share of the maximum torque, switching the adaptation off changes the "
        f"distance by {extent([100.0 * each for each in changes], 2)} %. Read in kN m, the weights grow to "
        f"{extent(weights, 0)} times the maximum torque and the bound to "
        f"{extent(growth, 0)} times its start, until the law is a relay; without adaptation the "
        f"brake then hardly acts, and the train runs {extent(stranded, 0)} m.",
    )
