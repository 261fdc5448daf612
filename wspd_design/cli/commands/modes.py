"""``wspd modes``: modes of a multibody vehicle, and the speeds from which it hunts."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.arguments import parse_speed
from wspd_design.cli.completion import names_or_files
from wspd_design.cli.console import WIDE, console, print_json, print_written, progress, spaced
from wspd_design.cli.output import check_output, write_file
from wspd_design.cli.terminal_tables import terminal_table
from wspd_design.design.case import VEHICLE
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.units import KMH, parse_quantity
from wspd_design.plants.multibody.loading import available_multibodies
from wspd_design.reporting.tables import ColumnOf, build

if TYPE_CHECKING:
    from collections.abc import Sequence

    from wspd_design.analysis.critical_speed import CriticalSpeed
    from wspd_design.analysis.modes import Mode
    from wspd_design.analysis.vehicle_modes import VehicleModes

_SPEED = "72 km/h"
_UP_TO = "20 Hz"
_SHARE = 0.1  # of the energy that a motion needs to stand in the table
_PARTS = 3  # motions of a mode in the table, at most
_FORMATS = (".svg", ".pdf", ".png")
_LOCUS = 30  # speeds of the poles in the figure


def modes(
    vehicle: Annotated[
        str | None,
        typer.Argument(
            metavar="VEHICLE",
            help="A vehicle with a multibody file, a multibody vehicle such as er24pc-82, or a .toml file of either "
            f"(wspd docs multibody). Default: {VEHICLE}.",
            show_default=False,
            autocompletion=names_or_files([*available_multibodies(), *available("vehicle")], ".toml"),
        ),
    ] = None,
    speed: Annotated[
        str, typer.Option("--speed", metavar="SPEED", help="Of the modes.", rich_help_panel=options.CASE)
    ] = _SPEED,
    slip: Annotated[
        str | None,
        options.case_option("--slip", "SLIP", "That brakes hold at all wheelsets.", "0, the wheels roll"),
    ] = None,
    rail: Annotated[
        str | None,
        options.case_option(
            "--rail",
            "NAME",
            "Whose factors reduce the slope of longitudinal creep forces.",
            "none where the wheels roll, else polach-dry",
            names_or_files(available("rail"), ".toml"),
        ),
    ] = None,
    conicity: Annotated[
        list[str] | None,
        typer.Option(
            "--conicity",
            metavar="NUMBER",
            help="Of the wheels; repeat it for the critical speeds of several. The modes are those of the first. "
            "Default: that of the vehicle.",
            show_default=False,
            rich_help_panel=options.CASE,
        ),
    ] = None,
    lateral_slope: Annotated[
        str,
        typer.Option(
            "--lateral-slope",
            metavar="FACTOR",
            help="Slope of the lateral force at small creep over that of Kalker's theory.",
            rich_help_panel=options.CASE,
        ),
    ] = "1",
    up_to: Annotated[
        str,
        typer.Option("--up-to", metavar="FREQUENCY", help="Highest natural frequency in table and figure."),
    ] = _UP_TO,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot",
            metavar="FILE",
            help="Draw energies, poles over speed and critical speeds: .svg, .pdf or .png.",
        ),
    ] = None,
    force: options.ForceOption = False,
    as_json: options.JsonOption = False,
) -> None:
    """Show the modes of a multibody vehicle at one speed, and the speed from which it hunts.

    The equations are linearized where the vehicle rolls, or where brakes hold a slip at all wheelsets.
    """
    from wspd_design.analysis.vehicle_modes import vehicle_modes

    highest = parse_quantity(up_to, "frequency", what="up-to")
    if plot is not None:
        _check_plot(plot, force=force)
    with progress() as tell:
        tell("modes")
        found = vehicle_modes(
            vehicle or VEHICLE,
            speed=parse_speed(speed),
            slip=0.0 if slip is None else parse_quantity(slip, "ratio", what="slip"),
            rail=rail,
            conicities=[parse_quantity(each, "ratio", what="conicity") for each in conicity or []],
            lateral_slope=parse_quantity(lateral_slope, "ratio", what="lateral slope"),
        )
        if plot is not None:
            tell("figure")
            write_file(plot, lambda target: _draw(found, highest, target, plot.suffix.lower()), force=force)
    if as_json:
        from wspd_design.exchange.modes_objects import modes_object

        print_json(modes_object(found))
        return
    _show(found, highest)
    if plot is not None:
        print_written(plot)


def _check_plot(path: Path, *, force: bool) -> None:
    check_output(path, force=force)
    if path.suffix.lower() not in _FORMATS:
        raise UserError(
            f"{path} must end in {', '.join(_FORMATS[:-1])} or {_FORMATS[-1]}, which chooses the format"
        )


def _shown(found: "VehicleModes", highest: float) -> "list[Mode]":
    """Modes of the table: oscillations up to a frequency, and all that grow."""
    return [
        mode
        for mode in found.modes
        if mode.unstable or (mode.oscillates and mode.natural_frequency <= highest)
    ]


def _show(found: "VehicleModes", highest: float) -> None:
    out = console()
    state = f"braked at slip {found.slip:g}" if found.slip else "rolling"
    out.print(
        f"{found.vehicle} {state} at {found.running.speed * KMH:g} km/h on {found.rail}, conicity {found.conicity:g}",
        style="bold",
        markup=False,
    )
    out.print(found.title, markup=False)
    rows = _shown(found, highest)
    styles = ["yellow" if mode.unstable else "" for mode in rows]
    columns = _COLUMNS if out.width >= WIDE else _COLUMNS[:-1]
    out.print(spaced(terminal_table(build(rows, columns, caption=""), styles=styles)))
    oscillating = [mode for mode in found.modes if mode.oscillates]
    left = len(found.modes) - len(rows)
    growing = found.growing
    verdict = f"{len(growing)} of them grow, marked !" if growing else "none grows"
    out.print(
        f"{len(oscillating)} modes oscillate and {len(found.modes) - len(oscillating)} do not; {verdict}. "
        f"{left} more, up to {max(mode.natural_frequency for mode in found.modes):.3g} Hz: --up-to, --json.",
        style="yellow" if growing else "",
        markup=False,
    )
    if found.slip:
        _show_braking(found)
    _show_critical(found.critical)
    for remark in found.remarks:
        out.print(f"Note: {remark}", style="yellow", markup=False)
    if found.assumed:
        out.print(
            f"{len(found.assumed)} of {found.numbers} numbers of this vehicle are estimates (status assumed).",
            style="dim",
            markup=False,
        )


def _energies(mode: "Mode") -> str:
    return ", ".join(
        f"{each.kind.replace('_', ' ')} {each.direction} {100.0 * each.share:.0f} %"
        for each in mode.shares[:_PARTS]
        if each.share >= _SHARE
    )


_COLUMNS: "tuple[ColumnOf[Mode], ...]" = (
    ColumnOf(title="mode", read=lambda mode: mode.name),
    ColumnOf(title="natural frequency", unit="Hz", decimals=2, read=lambda mode: mode.natural_frequency),
    ColumnOf(title="damping", unit="%", decimals=1, read=lambda mode: 100.0 * mode.damping),
    ColumnOf(title="growth", unit="1/s", decimals=2, read=lambda mode: mode.pole.real),
    ColumnOf(title="", read=lambda mode: "!" if mode.unstable else ""),
    ColumnOf(title="energy of motion", read=_energies),
)


def _show_braking(found: "VehicleModes") -> None:
    running = found.running
    torques = ", ".join(f"{each / 1e3:.1f}" for each in running.torques)
    loads = ", ".join(f"{each / 1e3:.1f}" for each in running.loads.sum(axis=1))
    console().print(
        f"The train slows down by {-running.acceleration:.2f} m/s2; torques {torques} kN m and loads {loads} kN of the "
        "axles from the front hold the slip. The speed counts as fixed: a mode slower than the stop means little. "
        f"Sideways {running.sideways / 1e3:.2f} kN or kN m are left out at most.",
        markup=False,
    )


def _show_critical(critical: "Sequence[CriticalSpeed]") -> None:
    if not critical:
        return
    from wspd_design.analysis.critical_speed import STEP
    from wspd_design.analysis.vehicle_modes import SPEEDS

    out, (low, high) = console(), SPEEDS
    tried = f"tried from {low * KMH:g} to {high * KMH:g} km/h in steps of {STEP * KMH:g} km/h"
    if len(critical) > 1:
        out.print(spaced(terminal_table(build(critical, _CRITICAL_COLUMNS, caption=""))))
        out.print(f"From these speeds on small deviations grow; {tried}.", markup=False)
        return
    (only,) = critical
    if only.speed is None or only.mode is None:
        out.print(f"Small deviations do not grow at any speed; {tried}.", markup=False)
        return
    out.print(
        f"Small deviations grow from {only.speed * KMH:.1f} km/h ({only.speed:.1f} m/s) on: {only.mode.motion}, "
        f"{only.mode.frequency:.2f} Hz; {tried}.",
        markup=False,
    )


_CRITICAL_COLUMNS: "tuple[ColumnOf[CriticalSpeed], ...]" = (
    ColumnOf(title="conicity", flush_right=True, read=lambda each: f"{each.conicity:g}"),
    ColumnOf(
        title="critical speed",
        unit="km/h",
        flush_right=True,
        read=lambda each: "none" if each.speed is None else f"{each.speed * KMH:.1f}",
    ),
    ColumnOf(
        title="frequency",
        unit="Hz",
        flush_right=True,
        read=lambda each: "" if each.mode is None else f"{each.mode.frequency:.2f}",
    ),
    ColumnOf(title="mode", read=lambda each: "" if each.mode is None else each.mode.motion),
)


def _draw(found: "VehicleModes", highest: float, target: Path, ending: str) -> None:
    import numpy as np

    from wspd_design.analysis.modes import poles
    from wspd_design.analysis.running import steady
    from wspd_design.analysis.vehicle_modes import SPEEDS
    from wspd_design.reporting.figure_style import figure_style, figure_svg, new_figure
    from wspd_design.reporting.figures.modes import draw_modes, figure_height

    speeds = np.linspace(*SPEEDS, _LOCUS).tolist()
    locus = [(each, poles(steady(found.equations, each, slip=found.slip).motion)) for each in speeds]
    rows = _shown(found, highest)
    with figure_style():
        figure = new_figure(height=figure_height(rows, found.critical))
        state = f"braked at slip {found.slip:g}" if found.slip else "rolling"
        draw_modes(
            figure,
            rows,
            locus,
            found.critical,
            title=f"{found.vehicle} {state} at {found.running.speed * KMH:g} km/h on {found.rail}; "
            f"{len(found.assumed)} of {found.numbers} numbers are estimates",
        )
        if ending == ".svg":
            target.write_text(figure_svg(figure), encoding="utf-8")
        else:
            dated = {"CreationDate": None} if ending == ".pdf" else {}
            figure.savefig(target, format=ending[1:], dpi=200, facecolor="white", metadata=dated)
