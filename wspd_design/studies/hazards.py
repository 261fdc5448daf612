"""Hazards of a wheel slide protection, and what a report shows of each: from its stop, its faults and its vehicle."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from wspd_design.parameters.provenance import ParameterSet
from wspd_design.simulation.comparison import Trial
from wspd_design.studies.faults import FaultedStop, Robustness
from wspd_design.studies.figures_of_stop import longest_release


@dataclass(frozen=True, slots=True, kw_only=True)
class Hazard:
    """One hazard."""

    id: str
    title: str
    shown: str  # what the report shows of it; empty: nothing
    left: str  # what it does not show


def hazards(own: Trial, found: Robustness | None, vehicle: ParameterSet) -> tuple[Hazard, ...]:
    """Return the hazards with what is known of them.

    Parameters
    ----------
    own : Trial
        Stop of the design.
    found : Robustness or None
        What becomes of it with faults; None where none was simulated.
    vehicle : ParameterSet
        With its numbers.
    """
    rows: tuple[tuple[str, str, str], ...] = (
        (
            "brake released for long",
            f"{_released(own)}; " + _watchdog(own, vehicle),
            "a law that releases without end while its computer fails",
        ),
        (
            "speed sensor lost",
            _fault(found, "sensor-lost"),
            "two sensors lost at once, and one that tells a wrong speed",
        ),
        (
            "valve stuck",
            "; ".join(filter(None, (_fault(found, f"valve-{kind}") for kind in ("holds", "vents", "fills")))),
            "several valves, and a cock that is closed",
        ),
        ("flat wheel", _flat(own), "the size of a flat: wear and heat of the tread are not modeled"),
        ("air supply exhausted", _air(own), "repeated slides, leaks and other consumers"),
        (
            "slide below the cut-out speed",
            f"a wheelset is locked for {own.metrics.lock_time:.2g} s at all speeds, "
            f"{own.metrics.judged_lock:.2g} s at a stretch above 10 km/h",
            "slip figures below 10 km/h",
        ),
        (
            "wrong train speed",
            _speed(own),
            "all wheels sliding before a first speed is known",
        ),
        ("adhesion changes suddenly", _patches(found), "other lengths and orders of patches"),
    )
    return tuple(
        Hazard(id=f"H{place}", title=title, shown=shown, left=left)
        for place, (title, shown, left) in enumerate(rows, start=1)
    )


def _released(own: Trial) -> str:
    longest = longest_release(own.run)
    if longest == 0.0:
        return "in this stop no wheelset brakes with less than a tenth of its torque"
    return f"in this stop a wheelset brakes with less than a tenth of its torque for at most {longest:.2g} s"


def _watchdog(own: Trial, vehicle: ParameterSet) -> str:
    entry = vehicle.entries.get("brake.longest_release")
    if entry is None or not isinstance(entry.value, float):
        return "the vehicle states no watchdog that would end a release"
    return f"a watchdog fills after {entry.value:.2g} s ({own.metrics.watchdog_fills} times in this stop)"


def _fault(found: Robustness | None, kind: str) -> str:
    if found is None:
        return ""
    stop = next((each for each in found.faults if each.fault is not None and each.fault.kind == kind), None)
    return "" if stop is None else f"{kind.replace('-', ' ')}: {_told(found, stop)}"


def _patches(found: Robustness | None) -> str:
    return (
        "" if found is None or found.patches is None else f"on a patchy rail: {_told(found, found.patches)}"
    )


def _told(found: Robustness, stop: FaultedStop) -> str:
    if not stop.stopped:
        return "the train does not stop"
    longer = "" if stop.fault is None else f", {100.0 * (stop.distance / found.plain - 1.0):.1f} % longer"
    return f"{stop.distance:.0f} m{longer}, longest lock {max(stop.locks):.2g} s"


def _flat(own: Trial) -> str:
    braked = sum(bool(samples) for samples in own.run.axle_samples)
    energy = own.run.totals.sliding_work / max(braked, 1) / 1e6
    return (
        f"{energy:.2g} MJ of sliding work per braked wheelset, longest lock {own.metrics.judged_lock:.2g} s"
    )


def _air(own: Trial) -> str:
    figures = own.metrics
    said = [f"{figures.vented_air:.2g} brake cylinders vented per wheelset"]
    _add(said, figures.air_used, lambda litres: f"{litres:.0f} normal litres taken")
    _add(said, figures.lowest_reservoir, lambda pressure: f"reservoir down to {pressure / 1e5:.2g} bar")
    if math.isnan(figures.lowest_reservoir):
        said.append("the vehicle states no reservoir, whose pressure is taken as constant")
    return "; ".join(said)


def _speed(own: Trial) -> str:
    if math.isnan(own.metrics.speed_error):
        return ""
    return f"in this stop the speed that the law goes by is wrong by at most {100.0 * own.metrics.speed_error:.2g} %"


def _add(said: list[str], value: float, words: Callable[[float], str]) -> None:
    if not math.isnan(value):
        said.append(words(value))
