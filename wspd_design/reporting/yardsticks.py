"""The two yardsticks of a stop in words: the ideal stop, which is simulated, and the bound, which is proved."""

from collections.abc import Iterable
from dataclasses import dataclass

from wspd_design.certificates.records import Certificate, Status
from wspd_design.certificates.theorems.shortest_stop.stop_bound import DISTANCE, STOP_BOUND
from wspd_design.reporting import numbers
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.runs import Ending


@dataclass(frozen=True, slots=True, kw_only=True)
class ProvedBound:
    """A distance below which no controller stops the nominal vehicle, and the certificate that proves it."""

    distance: float  # m
    certificate: Certificate


def ideal_distance(figures: Metrics) -> str:
    """Write the distance of the ideal stop; words where there is none."""
    match figures.ideal_ending:
        case Ending.STOPPED:
            return f"{numbers.decimals(figures.ideal_stop, 1)} m"
        case None:
            return "not known"
        case _:
            return "none"


def ideal_sentence(figures: Metrics) -> str:
    """Say how long the ideal stop is, or why there is none."""
    match figures.ideal_ending:
        case Ending.STOPPED:
            return (
                f"The ideal stop takes {ideal_distance(figures)}: a simulation of a brake with the same build-up "
                "that holds every wheelset at the adhesion peak."
            )
        case None:
            return (
                "The ideal stop is not known: it needs one rail from end to end, a start that rolls with empty "
                "cylinders, and the plant quarter or planar."
            )
        case ending:
            return f"There is no ideal stop: {NO_IDEAL_STOP[ending]}."


def proved_bound(certificates: Iterable[Certificate]) -> ProvedBound | None:
    """Return what the check of the shortest stop proves; None where it proves nothing."""
    for each in certificates:
        if each.name == STOP_BOUND.name and each.status is Status.PROVED:
            places = {point.name: point.value for point in each.worst_point}
            return ProvedBound(distance=places[DISTANCE], certificate=each)
    return None
