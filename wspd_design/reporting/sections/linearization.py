"""The linearized slip dynamics over speed."""

from functools import partial

from wspd_design.analysis.linearization import Linearization
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Figure, Heading, Paragraph, Table
from wspd_design.reporting.brakes import lag_times
from wspd_design.reporting.figures.drawing import KILO, KMH, picture
from wspd_design.reporting.figures.poles import beside_nominal, pole_map, pole_map_alt
from wspd_design.reporting.running_gear import alike_note
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import rich
from wspd_design.studies.dossier import Dossier

TABLE_ROWS = 9
MEGA = 1e6


def linearization(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the slip pole."""
    points, specification = dossier.linearizations, dossier.specification
    times = lag_times(dossier.vehicle)
    valve, tau = (
        (
            "The valve, a first-order lag,",
            "the valve has a $tau$ between its fill and its vent time, by how much it has to fill and vent to hold the "
            "torque",
        )
        if times
        else ("The valve, orifices,", "the orifices have a $tau$ that depends on the pressure that they hold")
    )
    beyond = [point for point in points if point.slip_pole > 1.0 / point.time_constant]
    unstable = [point for point in points if point.slip_pole > 0.0]
    note = alike_note(dossier.vehicle)
    series = beside_nominal(dossier.certificates, {1.0 / point.time_constant for point in points})
    return (
        Heading(text="Linearization", anchor="linearization"),
        Paragraph(
            text=rich(
                f"At the slip {specification.slip:g} of the specification and a frozen train speed the slip has the "
                "pole $p = partial F\\/partial lambda$. " + valve + " adds a pole at "
                "$-1\\/tau$ and leaves $p$ where it is. A law that does not read the torque and has a "
                "memory of integrals alone leaves the sum of the poles at $p - 1\\/tau$: where $p > 1\\/tau$ one "
                "of them is unstable whatever the gains. On average over its pulses " + tau + ". A law with "
                "dynamics of its own, such as a lead filter, is not bound by this."
            )
        ),
        Paragraph(
            text=rich(
                f"The slip pole is positive at {len(unstable)} and beyond $1\\/tau$ at {len(beyond)} of "
                f"{len(points)} speeds from {numbers.significant(points[0].speed * KMH)} to "
                f"{numbers.significant(points[-1].speed * KMH)} km/h, for the nominal parameters. [](#pole-map) shows "
                "it over speed; [](#linearization-table) lists the poles, the gain, and what holds the slip there."
            )
        ),
        *([Paragraph(text=note)] if note else []),
        Figure(
            svg=picture(
                partial(pole_map, points=points, speeds=specification.speeds, times=times, series=series),
                height=3.3,
            ),
            caption=rich(
                "Slip pole over train speed on the rail of the stops, with the limits that checks set it. Above the "
                "dashed line $1\\/tau$ no law that does not read the torque and has a memory of integrals alone has a "
                "stable equilibrium. Dotted: range of the specification."
            ),
            alt=pole_map_alt(points, specification.speeds, times, series),
            anchor="pole-map",
        ),
        _table(points),
    )


def _table(points: tuple[Linearization, ...]) -> Table:
    last = len(points) - 1
    rows = dict.fromkeys(round(last * row / (TABLE_ROWS - 1)) for row in range(TABLE_ROWS))
    return build(
        (points[row] for row in rows),
        (
            ColumnOf(
                title="At a train speed of",
                read=lambda point: f"{numbers.significant(point.speed * KMH)} km/h",
            ),
            ColumnOf(title="Slip pole", unit="1/s", decimals=3, read=lambda point: point.slip_pole),
            ColumnOf(
                title="Poles with valve",
                unit="1/s",
                flush_right=True,
                read=lambda point: "; ".join(numbers.decimals(pole, 3) for pole in point.poles()),
            ),
            ColumnOf(title="Gain G", unit="1/(MN m s)", decimals=1, read=lambda point: point.gain * MEGA),
            ColumnOf(
                title="Torque", unit="kN m", decimals=2, read=lambda point: point.equilibrium_torque / KILO
            ),
            ColumnOf(title="Duty", unit="-", decimals=3, read=lambda point: point.equilibrium_duty),
        ),
        caption="Linearization at the slip reference. The torque per wheelset and the duty hold the slip "
        "there; a duty above 1 is beyond the brake.",
        anchor="linearization-table",
    )
