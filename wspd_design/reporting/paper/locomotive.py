"""Section 7 on the multibody model, beside the small one and the paper."""

from collections.abc import Callable

from wspd_design.reporting.blocks import (
    Block,
    Figure,
    Heading,
    Paragraph,
    Table,
)
from wspd_design.reporting.figures.drawing import KILO
from wspd_design.reporting.paper.changes import IRREGULAR, SMALL, SMOOTH, changes
from wspd_design.reporting.paper.figures import Setting, figures_of
from wspd_design.reporting.tables import ColumnOf, Uncertain, build
from wspd_design.reporting.text import references, rich
from wspd_design.simulation.metrics import Metrics
from wspd_design.studies.inferred import mark
from wspd_design.studies.paper.disturbances import LOAD_SPREAD
from wspd_design.studies.paper.evidence import CONSTANT_RAILS, CONTROLLERS, RAILS, UNPROTECTED
from wspd_design.studies.paper.locomotive import OnLocomotive
from wspd_design.studies.paper.published import PublishedStop
from wspd_design.studies.paper.section7 import Section7
from wspd_design.studies.paper.table10 import Table10Row


def locomotive(small: Section7, made: OnLocomotive) -> tuple[Block, ...]:
    """Return the section about the stops on the multibody model."""
    setting = Setting(
        stops=made.smooth, prefix="locomotive", remark=f" On the multibody model. {mark(made.model)}"
    )
    drawn = figures_of(setting)
    rough = _irregular_forces(made)
    return (
        Heading(text="Section 7 on the locomotive", anchor="locomotive"),
        Paragraph(
            text=rich(
                "The same laws, rails and stops on the model with 82 degrees of freedom, on smooth track and on one "
                f"with the irregularities of Table 9 (seed {made.seed}). The friction was fitted to Table 10 on "
                "the small model and is not fitted again: [](#locomotive-table10) and [](#locomotive-torques) set both "
                "models beside the paper, [](#locomotive-distances) and [](#locomotive-slips) have all rails, "
                "[](#locomotive-loads) what becomes of the wheel loads. "
                "[](#locomotive-conclusions) tells which of the paper's conclusions change."
            )
        ),
        _table10(small, made),
        _torques(small, made),
        _distances(small, made),
        _slips(small, made),
        _loads(made),
        *changes(small, made),
        Heading(text="The figures on the locomotive", anchor="locomotive-figures", level=2),
        Paragraph(
            text=(
                "Figures 9 to 21 of the paper once more: ",
                *references([each.anchor for each in (*drawn, rough)]),
                ".",
            )
        ),
        *drawn,
        rough,
    )


def _table10(small: Section7, made: OnLocomotive) -> Table:
    return build(
        small.table10,
        (
            ColumnOf(title="Controller", read=lambda row: row.published.controller),
            ColumnOf(title="Rail", read=lambda row: row.published.rail.removeprefix("table10-")),
            *_beside_the_paper(small, made, "Distance", "m", 1, lambda m: m.distance, lambda p: p.distance_m),
            *_beside_the_paper(
                small, made, "Time", "s", 2, lambda m: m.stopping_time, lambda p: p.stopping_time_s
            ),
        ),
        caption="Distances and times of Table 10 of the paper, on the small model, on the multibody model and on that "
        f"on irregular track. {mark(made.model)}",
        anchor="locomotive-table10",
    )


def _torques(small: Section7, made: OnLocomotive) -> Table:
    return build(
        small.table10,
        (
            ColumnOf(title="Controller", read=lambda row: row.published.controller),
            ColumnOf(title="Rail", read=lambda row: row.published.rail.removeprefix("table10-")),
            *_beside_the_paper(
                small,
                made,
                "Torque integral",
                "kN m s",
                1,
                lambda m: m.torque_integral / KILO,
                lambda p: p.torque_integral_kNms,
            ),
        ),
        caption="Torque integrals of Table 10 likewise: a balance of momentum on every model, as the effective inertia "
        f"of a wheelset is the same. {mark(made.model)}",
        anchor="locomotive-torques",
    )


def _beside_the_paper(
    small: Section7,
    made: OnLocomotive,
    title: str,
    unit: str,
    decimals: int,
    ours: Callable[[Metrics], float],
    paper: Callable[[PublishedStop], float],
) -> tuple[ColumnOf[Table10Row], ...]:
    """Return the columns of one figure: the paper's, and those of our stops on each model."""

    def of(name: str, stops: Section7) -> ColumnOf[Table10Row]:
        return ColumnOf(
            title=name,
            unit=unit,
            decimals=decimals,
            read=lambda row: ours(stops.trials[row.published.controller, row.published.rail].metrics),
        )

    return (
        ColumnOf(
            title=f"{title}, paper", unit=unit, decimals=decimals, read=lambda row: paper(row.published)
        ),
        of(SMALL, small),
        of(SMOOTH, made.smooth),
        of(IRREGULAR, made.irregular),
    )


def _distances(small: Section7, made: OnLocomotive) -> Table:
    rows = [(name, rail) for rail in RAILS for name in (*CONTROLLERS, UNPROTECTED)]

    def distance(title: str, stops: Section7) -> ColumnOf[tuple[str, str]]:
        return ColumnOf(
            title=title,
            unit="m",
            decimals=1,
            read=lambda row: Uncertain(
                value=stops.trials[row].metrics.distance, spread=stops.trials[row].check.spread
            ),
        )

    def change(title: str, ours: Section7, base: Section7) -> ColumnOf[tuple[str, str]]:
        return ColumnOf(
            title=title,
            unit="%",
            decimals=2,
            read=lambda row: (
                100.0 * (ours.trials[row].metrics.distance / base.trials[row].metrics.distance - 1.0)
            ),
        )

    return build(
        rows,
        (
            ColumnOf(title="Rail", read=lambda row: row[1] if row[0] == CONTROLLERS[0] else ""),
            ColumnOf(title="Controller", read=lambda row: row[0]),
            distance(SMALL, small),
            distance(SMOOTH, made.smooth),
            change("from four axles", made.smooth, small),
            distance(IRREGULAR, made.irregular),
            change("from smooth", made.irregular, made.smooth),
        ),
        caption="Distances on all rails. ±: half the spread of a sensitive closed loop over initial "
        f"speeds that differ by millionths. {mark(made.model)}",
        anchor="locomotive-distances",
    )


def _slips(small: Section7, made: OnLocomotive) -> Table:
    rows = [(name, rail) for rail in RAILS for name in CONTROLLERS]

    def slip(title: str, stops: Section7, read: Callable[[Metrics], float]) -> ColumnOf[tuple[str, str]]:
        return ColumnOf(title=title, decimals=3, read=lambda row: read(stops.trials[row].metrics))

    return build(
        rows,
        (
            ColumnOf(title="Rail", read=lambda row: row[1] if row[0] == CONTROLLERS[0] else ""),
            ColumnOf(title="Controller", read=lambda row: row[0]),
            slip(f"Mean slip, {SMALL}", small, lambda m: m.slip_mean),
            slip(SMOOTH, made.smooth, lambda m: m.slip_mean),
            slip(IRREGULAR, made.irregular, lambda m: m.slip_mean),
            slip(f"Largest, {SMALL}", small, lambda m: m.slip_max),
            slip(SMOOTH, made.smooth, lambda m: m.slip_max),
            slip(IRREGULAR, made.irregular, lambda m: m.slip_max),
        ),
        caption="Mean and largest slip of the same stops above 10 km/h. A slip above 1 is that of a locked wheel that "
        f"follows the pads of its moving frame. {mark(made.model)}",
        anchor="locomotive-slips",
    )


def _loads(made: OnLocomotive) -> Table:
    smooth, rough = made.axles(made.smooth), made.axles(made.irregular)
    rows = list(enumerate(zip(smooth, rough, strict=True), start=1))
    return build(
        rows,
        (
            ColumnOf(title="Wheelset", read=lambda row: str(row[0])),
            ColumnOf(
                title="Load at rest", unit="kN", decimals=1, read=lambda row: row[1][0].static_load / KILO
            ),
            ColumnOf(title="braking", unit="kN", decimals=1, read=lambda row: row[1][0].braking_load / KILO),
            ColumnOf(title="transfer", unit="%", decimals=1, read=lambda row: 100.0 * row[1][0].transfer),
            ColumnOf(
                title="spread", unit="%", decimals=1, read=lambda row: 100.0 * row[1][0].relative_spread
            ),
            ColumnOf(
                title="irregular", unit="%", decimals=1, read=lambda row: 100.0 * row[1][1].relative_spread
            ),
            ColumnOf(title="least", unit="kN", decimals=1, read=lambda row: row[1][1].least_load / KILO),
        ),
        caption="Load of one wheel, mean of both wheels of a wheelset, with the adaptive fuzzy law on "
        f"{CONSTANT_RAILS[1]}; spread: standard deviation of the wheel with more of it about a moving mean over 1 s, "
        "in percent of the load at rest, on smooth and on irregular track; least: there. The small model is given "
        f"{100.0 * LOAD_SPREAD:.0f} % for irregular track. {mark(made.model)}",
        anchor="locomotive-loads",
    )


def _irregular_forces(made: OnLocomotive) -> Figure:
    setting = Setting(
        stops=made.irregular,
        prefix="irregular",
        remark=f" On the multibody model, on irregular track. {mark(made.model)}",
    )
    return figures_of(setting)[-1]
