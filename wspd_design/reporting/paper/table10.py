"""Table 10 beside our stops, taken apart into build-up and plateau, and the same stops on other friction."""

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Column, Equation, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import KILO
from wspd_design.reporting.text import Text, rich
from wspd_design.studies.paper.evidence import CONTROLLERS, RAILS, UNPROTECTED, StopFigures
from wspd_design.studies.paper.reproduction import Reproduction
from wspd_design.studies.paper.table10 import Table10Row, largest, relative_range, root_mean_square


def table10(made: Reproduction) -> tuple[Block, ...]:
    """Return the section about Table 10."""
    rows = made.table10
    printed = [each.published.torque_integral_kNms for each in rows]
    ours = [each.metrics.torque_integral for each in rows]
    return (
        Heading(text="Table 10", anchor="table10"),
        Paragraph(
            text=rich(
                "Stops from 120 km/h on the rails `table10-dry` and `table10-wet`, with the calibrated rule "
                "tables and the printed gains of the adaptive fuzzy law. The friction, the rotating inertia "
                "and the rule tables were fitted to this table, as the paper prints too little to compute it: "
                "agreement confirms the fit, and that one set of numbers explains all of them."
            )
        ),
        _numbers(rows),
        Heading(text="Build-up and plateau", anchor="build-up", level=2),
        Paragraph(
            text="Distance d and time t are those of a dead time, the lag 2 d/v0 − t, and a constant deceleration "
            "after it, the plateau v0/(2 (t − d/v0)). They part the build-up of the brake from the use of "
            "adhesion, in the paper's numbers as in ours."
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
            text="No controller appears in it, and the resistance hardly does: the range of all rows is "
            f"{numbers.decimals(100.0 * relative_range(printed), 2)} % as printed and "
            f"{numbers.decimals(100.0 * relative_range(ours), 2)} % here. The balance holds in our stops to "
            f"{numbers.significant(max(abs(each.metrics.momentum_residual) for each in rows), 2)}."
        ),
        _momentum(rows),
        Heading(text="The ranking on other friction", anchor="ranking", level=2),
        Paragraph(
            text=rich(
                "The same controllers on the friction of Polach (2005), which the paper cites and which falls "
                "with the sliding speed, and beside stops that no controller can beat."
            )
        ),
        _ranking(made),
    )


def _numbers(rows: tuple[Table10Row, ...]) -> Table:
    return Table(
        columns=(
            Column(title="Controller"),
            Column(title="Rail"),
            *(
                Column(title=title, unit=unit, align="right")
                for quantity, spelled in (("Distance", "m"), ("Time", "s"), ("Torque integral", "kN m s"))
                for title, unit in ((f"{quantity}, paper", spelled), ("here", spelled), ("off by", "%"))
            ),
        ),
        rows=tuple(
            (
                each.published.controller,
                each.published.rail.removeprefix("table10-"),
                numbers.decimals(each.published.distance_m, 2),
                numbers.uncertain(each.metrics.distance, each.spread, 2),
                _percent(each.deviations[0]),
                numbers.decimals(each.published.stopping_time_s, 1),
                numbers.decimals(each.metrics.stopping_time, 2),
                _percent(each.deviations[1]),
                numbers.decimals(each.published.torque_integral_kNms, 2),
                numbers.decimals(each.metrics.torque_integral / KILO, 1),
                _percent(each.deviations[2]),
            )
            for each in rows
        ),
        caption=f"The 24 numbers of Table 10, {len(rows)} stops of the four-axle locomotive. Deviations: "
        f"{numbers.decimals(100.0 * root_mean_square(rows), 2)} % rms, "
        f"{numbers.decimals(100.0 * largest(rows), 2)} % at most. The paper rounds its times to 0.1 s, "
        "which is up to 0.5 %.",
        anchor="table10-numbers",
    )


def _parts(made: Reproduction) -> Table:
    speed = made.evidence.initial_speed
    return Table(
        columns=(
            Column(title="Controller"),
            Column(title="Rail"),
            Column(title="Lag, paper", unit="s", align="right"),
            Column(title="here", unit="s", align="right"),
            Column(title="Plateau, paper", unit="m/s²", align="right"),
            Column(title="here", unit="m/s²", align="right"),
        ),
        rows=tuple(
            (
                each.published.controller,
                each.published.rail.removeprefix("table10-"),
                numbers.decimals(each.published.lag(speed), 2),
                numbers.decimals(each.metrics.lag, 2),
                numbers.decimals(each.published.plateau(speed), 2),
                numbers.decimals(each.metrics.plateau, 2),
            )
            for each in made.table10
        ),
        caption="Lag and plateau. The plateaus on one rail are nearly equal: the friction gives no more and no less.",
        anchor="table10-parts",
    )


def _momentum(rows: tuple[Table10Row, ...]) -> Table:
    return Table(
        columns=(
            Column(title="Controller"),
            Column(title="Rail"),
            Column(title="Paper", unit="kN m s", align="right"),
            Column(title="Integrated", unit="kN m s", align="right"),
            Column(title="From momentum", unit="kN m s", align="right"),
            Column(title="Air vented", unit="cylinders", align="right"),
        ),
        rows=tuple(
            (
                each.published.controller,
                each.published.rail.removeprefix("table10-"),
                numbers.decimals(each.published.torque_integral_kNms, 1),
                numbers.decimals(each.metrics.torque_integral / KILO, 1),
                numbers.decimals(each.momentum / KILO, 1),
                numbers.decimals(each.metrics.vented_air, 2),
            )
            for each in rows
        ),
        caption="Torque integral, what the momentum leaves for it (to standstill), and the air that is really "
        "let out: full brake cylinders per wheelset.",
        anchor="table10-momentum",
    )


def _ranking(made: Reproduction) -> Table:
    evidence = made.evidence
    rows: list[tuple[Text, ...]] = [
        (
            name,
            *(
                _place(evidence.stop(name, rail), [each.controller for each in evidence.ranking(rail)])
                for rail in RAILS
            ),
        )
        for name in (*CONTROLLERS, UNPROTECTED)
    ]
    for title, field in (
        ("slip held at the reference", "constant_slip"),
        ("bound: adhesion peak", "bound"),
        ("the same, full torque at once", "bound_at_once"),
    ):
        values = [getattr(evidence.yardstick(rail), field) for rail in RAILS]
        rows.append((title, *(numbers.decimals(value, 1) for value in values)))
    return Table(
        columns=(Column(title="Stop"), *(Column(title=rail, unit="m", align="right") for rail in RAILS)),
        rows=tuple(rows),
        caption="Distances, and in brackets the place among the four controllers of the paper. ±: half the spread of "
        "a chaotic closed loop over initial speeds that differ by millionths.",
        anchor="distances",
    )


def _place(stop: StopFigures, ranking: list[str]) -> str:
    distance = numbers.uncertain(stop.metrics.distance, stop.check.spread, 1)
    if stop.controller not in ranking:
        return distance
    return f"{distance} ({ranking.index(stop.controller) + 1})"


def _percent(share: float) -> str:
    return numbers.decimals(100.0 * share, 2)
