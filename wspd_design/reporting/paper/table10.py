"""Table 10 beside our stops, taken apart into build-up and plateau, and the same stops on other friction."""

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Equation, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import KILO
from wspd_design.reporting.tables import ColumnOf, Uncertain, build
from wspd_design.reporting.text import rich
from wspd_design.studies.paper.evidence import CONTROLLERS, RAILS, UNPROTECTED, Evidence
from wspd_design.studies.paper.reproduction import Reproduction
from wspd_design.studies.paper.table10 import Table10Row, largest, relative_range, root_mean_square


def table10(made: Reproduction) -> tuple[Block, ...]:
    """Return the section about Table 10."""
    rows = made.small.table10
    printed = [each.published.torque_integral_kNms for each in rows]
    ours = [each.metrics.torque_integral for each in rows]
    return (
        Heading(text="Table 10", anchor="table10"),
        Paragraph(
            text=rich(
                "Stops from 120 km/h on the rails `table10-dry` and `table10-wet`, with the calibrated rule "
                "tables and the printed gains of the adaptive fuzzy law. The friction, the rotating inertia "
                "and the rule tables were fitted to this table, as the paper prints too little to compute it: "
                "agreement confirms the fit, and that one set of numbers explains all of them: [](#table10-numbers)."
            )
        ),
        _numbers(rows),
        Heading(text="Build-up and plateau", anchor="build-up", level=2),
        Paragraph(
            text=rich(
                "Distance $d$ and time $t$ are those of a dead time, the lag $2 d\\/v_0 - t$, and a constant "
                "deceleration after it, the plateau $v_0\\/(2 (t - d\\/v_0))$. They part the build-up of the brake "
                "from the use of adhesion, in the paper's numbers as in ours: [](#table10-parts)."
            )
        ),
        _parts(made),
        Heading(text="The torque integral is a momentum balance", anchor="momentum", level=2),
        Equation(
            source="sum_i integral T_i dif t = R m v_0 + sum_i J_i omega_0 - R integral f_d dif t - sum_i integral B "
            "omega_i dif t",
            description="The sum of the torque integrals equals wheel radius times initial momentum plus the initial "
            "angular momentum of the wheelsets, minus radius times the integral of the running resistance, "
            "minus the integral of the wheel damping.",
            anchor="momentum-balance",
        ),
        Paragraph(
            text=rich(
                "No controller appears in it, and the resistance hardly does: the range of all rows of "
                f"[](#table10-momentum) is {numbers.decimals(100.0 * relative_range(printed), 2)} % as printed and "
                f"{numbers.decimals(100.0 * relative_range(ours), 2)} % here. The balance holds in our stops to "
                f"{numbers.significant(max(abs(each.metrics.momentum_residual) for each in rows), 2)}."
            )
        ),
        _momentum(rows),
        Heading(text="The ranking on other friction", anchor="ranking", level=2),
        Paragraph(
            text=rich(
                "The same controllers on the friction of Polach (2005), which the paper cites and which falls "
                "with the sliding speed, and beside ideal stops, simulations of a brake that holds the slip: "
                "[](#distances)."
            )
        ),
        _ranking(made),
    )


def _numbers(rows: tuple[Table10Row, ...]) -> Table:
    def off(index: int) -> ColumnOf[Table10Row]:
        return ColumnOf(
            title="off by", unit="%", decimals=2, read=lambda each: 100.0 * each.deviations[index]
        )

    return build(
        rows,
        (
            ColumnOf(title="Controller", read=lambda each: each.published.controller),
            ColumnOf(title="Rail", read=lambda each: each.published.rail.removeprefix("table10-")),
            ColumnOf(
                title="Distance, paper", unit="m", decimals=2, read=lambda each: each.published.distance_m
            ),
            ColumnOf(
                title="here",
                unit="m",
                decimals=2,
                read=lambda each: Uncertain(value=each.metrics.distance, spread=each.spread),
            ),
            off(0),
            ColumnOf(
                title="Time, paper", unit="s", decimals=1, read=lambda each: each.published.stopping_time_s
            ),
            ColumnOf(title="here", unit="s", decimals=2, read=lambda each: each.metrics.stopping_time),
            off(1),
            ColumnOf(
                title="Torque integral, paper",
                unit="kN m s",
                decimals=2,
                read=lambda each: each.published.torque_integral_kNms,
            ),
            ColumnOf(
                title="here",
                unit="kN m s",
                decimals=1,
                read=lambda each: each.metrics.torque_integral / KILO,
            ),
            off(2),
        ),
        caption=f"The 24 numbers of Table 10, {len(rows)} stops of the four-axle locomotive. Deviations: "
        f"{numbers.decimals(100.0 * root_mean_square(rows), 2)} % rms, "
        f"{numbers.decimals(100.0 * largest(rows), 2)} % at most. The paper rounds its times to 0.1 s, "
        "which is up to 0.5 %.",
        anchor="table10-numbers",
    )


def _parts(made: Reproduction) -> Table:
    speed = made.small.evidence.initial_speed
    return build(
        made.small.table10,
        (
            ColumnOf(title="Controller", read=lambda each: each.published.controller),
            ColumnOf(title="Rail", read=lambda each: each.published.rail.removeprefix("table10-")),
            ColumnOf(title="Lag, paper", unit="s", decimals=2, read=lambda each: each.published.lag(speed)),
            ColumnOf(title="here", unit="s", decimals=2, read=lambda each: each.metrics.lag),
            ColumnOf(
                title="Plateau, paper",
                unit="m/s²",
                decimals=2,
                read=lambda each: each.published.plateau(speed),
            ),
            ColumnOf(title="here", unit="m/s²", decimals=2, read=lambda each: each.metrics.plateau),
        ),
        caption="Lag and plateau. The plateaus on one rail are nearly equal: the friction gives no more and no less.",
        anchor="table10-parts",
    )


def _momentum(rows: tuple[Table10Row, ...]) -> Table:
    return build(
        rows,
        (
            ColumnOf(title="Controller", read=lambda each: each.published.controller),
            ColumnOf(title="Rail", read=lambda each: each.published.rail.removeprefix("table10-")),
            ColumnOf(
                title="Paper",
                unit="kN m s",
                decimals=1,
                read=lambda each: each.published.torque_integral_kNms,
            ),
            ColumnOf(
                title="Integrated",
                unit="kN m s",
                decimals=1,
                read=lambda each: each.metrics.torque_integral / KILO,
            ),
            ColumnOf(
                title="From momentum", unit="kN m s", decimals=1, read=lambda each: each.momentum / KILO
            ),
            ColumnOf(
                title="Air vented", unit="cylinders", decimals=2, read=lambda each: each.metrics.vented_air
            ),
        ),
        caption="Torque integral, what the momentum leaves for it (to standstill), and the air that is really "
        "let out: full brake cylinders per wheelset.",
        anchor="table10-momentum",
    )


def _ranking(made: Reproduction) -> Table:
    evidence = made.small.evidence
    rows = [(name, [_place(evidence, name, rail) for rail in RAILS]) for name in (*CONTROLLERS, UNPROTECTED)]
    for title, field in (
        ("slip held at the reference", "constant_slip"),
        ("ideal stop: adhesion peak held", "ideal_stop"),
        ("the same, full torque at once", "ideal_at_once"),
    ):
        values = [getattr(evidence.yardstick(rail), field) for rail in RAILS]
        rows.append((title, [numbers.decimals(value, 1) for value in values]))

    def on(index: int) -> ColumnOf[tuple[str, list[str]]]:
        return ColumnOf(title=RAILS[index], unit="m", flush_right=True, read=lambda row: row[1][index])

    return build(
        rows,
        (ColumnOf(title="Stop", read=lambda row: row[0]), *map(on, range(len(RAILS)))),
        caption="Distances, and in brackets the place among the four controllers of the paper. ±: half the spread of "
        "a sensitive closed loop over initial speeds that differ by millionths.",
        anchor="distances",
    )


def _place(evidence: Evidence, name: str, rail: str) -> str:
    """Write a distance, and among the controllers of the paper its place."""
    stop = evidence.stop(name, rail)
    ranking = [each.controller for each in evidence.ranking(rail)]
    distance = numbers.uncertain(stop.metrics.distance, stop.check.spread, 1)
    return f"{distance} ({ranking.index(name) + 1})" if name in ranking else distance
