"""The same design with one sensor lost, one valve stuck, and on patches."""

from wspd_design.design.stop_requirements import LONGEST_LOCK
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Cell, Heading, Paragraph, Status, Table
from wspd_design.reporting.figures.drawing import KILO, KMH
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import escape, rich
from wspd_design.simulation.description import rails_of
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.faults import PATCHES, SINCE, FaultedStop, Robustness

ROBUSTNESS, FAULTS = "robustness", "robustness-table"
"""Anchors of the section and of its table."""

_FAULTS = {
    "sensor-lost": "speed sensor lost",
    "valve-holds": "valve stuck, holds",
    "valve-vents": "valve stuck, vents",
    "valve-fills": "valve stuck, fills",
}


def robustness(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about faults and patches."""
    found = dossier.robustness
    if found is None:
        return ()
    judged = numbers.significant(JUDGING_SPEED * KMH)
    rails = rails_of(dossier.scenario)
    return (
        Heading(text="Faults and patches", anchor=ROBUSTNESS),
        Paragraph(
            text=rich(
                f"The same design, unchanged, where one wheelset has a fault from {SINCE:g} s on; of the axles the "
                f"one where it does most harm. The stop on {escape(rails)} without a fault takes "
                f"{numbers.decimals(found.plain, 1)} m. A stop holds if the train stops and no wheel that a law could "
                f"keep turning is locked for more than {LONGEST_LOCK:g} s above {judged} km/h. [](#robustness-table) "
                "lists them."
            )
        ),
        _table(found, judged),
        Paragraph(text=_filled(found)),
    )


def _table(found: Robustness, judged: str) -> Table:
    return build(
        found.stops,
        (
            ColumnOf(title="What fails", read=what_fails),
            ColumnOf(title="Axle", read=lambda each: str(each.fault.axle) if each.fault else numbers.NONE),
            ColumnOf(title="Distance", unit="m", decimals=1, read=lambda each: each.distance),
            ColumnOf(
                title="Longer by",
                unit="%",
                decimals=1,
                read=lambda each: 100.0 * (each.distance / found.plain - 1.0) if each.fault else float("nan"),
            ),
            ColumnOf(
                title="Lock of this axle",
                unit="s",
                decimals=2,
                read=lambda each: each.own_lock if each.fault else float("nan"),
            ),
            ColumnOf(title="Lock of the others", unit="s", decimals=2, read=lambda each: each.other_lock),
            ColumnOf(title="Finding", read=lambda each: _finding(found, each)),
        ),
        caption=f"One fault at a time, and a rail that changes along the track. Lock: the longest one of a wheelset "
        f"above {judged} km/h.",
        anchor=FAULTS,
    )


def what_fails(stop: FaultedStop) -> str:
    """Name what is not as it was designed for."""
    return f"rail {PATCHES}" if stop.fault is None else _FAULTS[stop.fault.kind]


def _finding(found: Robustness, stop: FaultedStop) -> Cell:
    if not stop.stopped:
        return Cell(status=Status.BAD, text="does not stop")
    if not found.holds(stop):
        return Cell(status=Status.FAILS)
    if found.forced(stop) and stop.own_lock > LONGEST_LOCK:
        return Cell(status=Status.PARTLY, text="this axle locks, as it must")
    return Cell(status=Status.HOLDS)


def _filled(found: Robustness) -> str:
    """Say what a valve that fills comes to on this rail, and why."""
    low, high = (numbers.decimals(torque / KILO, 1) for torque in found.most_adhesion)
    full = numbers.decimals(found.full_torque / KILO, 1)
    if found.fills_lock:
        return (
            f"A valve that fills brings the full torque of {full} kN m to its wheelset; at its adhesion peak the rail "
            f"takes {low} to {high} kN m, depending on the speed. No law keeps that wheelset from locking: its valve "
            "follows no command."
        )
    return (
        f"A valve that fills brings the full torque of {full} kN m to its wheelset, which the rail takes at every "
        f"judged speed ({low} to {high} kN m at its adhesion peak)."
    )
