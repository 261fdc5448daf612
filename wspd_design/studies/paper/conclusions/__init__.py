"""Which of the paper's conclusions hold: each is judged by a stated rule from computed numbers alone."""

from wspd_design.studies.paper.conclusions import law, ranking, setting, slip
from wspd_design.studies.paper.conclusions.records import Conclusion
from wspd_design.studies.paper.evidence import Evidence

JUDGES = (
    ranking.shortest,
    ranking.build_up,
    ranking.locked,
    ranking.robustness,
    slip.convergence,
    slip.standstill,
    slip.mitsubishi,
    slip.frequency,
    law.relay,
    law.adaptation,
    setting.air,
    setting.friction,
    setting.weight,
    setting.grouping,
)
"""In the order of the page."""


def conclusions(evidence: Evidence) -> tuple[Conclusion, ...]:
    """Judge the conclusions of the paper.

    Parameters
    ----------
    evidence : Evidence
        Computed stops, the printed table and the paper's law with parts taken out.
    """
    return tuple(judge(evidence) for judge in JUDGES)
