"""The table of a design's gains with their reasons, for the commands that make designs."""

from pathlib import Path

from rich.text import Text

from wspd_design.cli.console import WIDE, console, print_written, spaced, table
from wspd_design.design.adhesion_use import adhesion_sentence
from wspd_design.design.records import Design, Gain, GainValue
from wspd_design.parameters.records import Rail, Vehicle

_OTHER_LINES = 14  # of a screen, for what stands around the gains


def show_design(
    made: Design,
    path: Path,
    vehicle: Vehicle,
    rail: Rail,
    *,
    on_one_screen: bool = False,
) -> None:
    """Print the gains of a design, what its brake asks of the rail, where it was written and what to do with it.

    Parameters
    ----------
    made : Design
        The design.
    path : Path
        Its file.
    vehicle, rail : Vehicle, Rail
        Of the design.
    on_one_screen : bool
        Whether the reasons of the gains, which the file holds, give way where the terminal is too low for them.
    """
    out = console()
    specification = made.specification
    low, high = specification.speeds
    out.print(f"{made.name}", style="bold", markup=False)
    out.print(
        f"slip {specification.slip:g} within {specification.slip_tolerance:g}, {low * 3.6:g} to "
        f"{high * 3.6:g} km/h, sample time {specification.sample_time * 1e3:g} ms"
    )
    out.print(adhesion_sentence(vehicle, rail, specification.speeds), markup=False)
    if made.judged_by:
        out.print(f"Judged by {made.judged_by}.", markup=False)
    wide = out.width >= WIDE
    shown = table("Gain", "Value", "Why") if wide else table("Gain", "Why")
    for gain in made.gains:
        name, value, why = Text(gain.name), Text(_quantity(gain)), Text(gain.why)
        if wide:
            shown.add_row(name, value, why)
        else:
            shown.add_row(name.append("\n= ", style="dim").append(value), why)
    if on_one_screen and out.is_terminal and len(out.render_lines(shown)) > out.height - _OTHER_LINES:
        values = ", ".join(f"{gain.name} {_quantity(gain)}" for gain in made.gains)
        out.print(f"\nGains, each with its reason in {path}: {values}.\n", markup=False)
    else:
        out.print(spaced(shown))
    print_written(
        path,
        ("Prove it", ("verify", path)),
        ("Try it", ("simulate", path)),
        ("Show it", ("report", path, "-o", path.with_suffix(".html"))),
    )


def _quantity(gain: Gain) -> str:
    return f"{_number(gain.value)} {'' if gain.unit == '-' else gain.unit}".rstrip()


def _number(value: GainValue) -> str:
    match value:
        case bool():
            return "yes" if value else "no"
        case tuple():
            same = len(set(value)) == 1
            return f"{len(value)} x {value[0]:.4g}" if same else ", ".join(f"{item:.4g}" for item in value)
    return f"{value:.4g}"
