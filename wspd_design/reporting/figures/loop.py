"""Block diagram of the control loop: what is measured, sampled, commanded, and what moves."""

import textwrap
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.reporting.figure_style import INK, MUTED, SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 2.6  # in
WIDTH, TALL = 1.05, 0.86  # of a box [in]
GAP = 0.26  # between boxes [in]
TOP, BOTTOM = 1.9, 0.5  # middle of the rows [in]
TURN = 1.2  # height at which the creep force goes back [in]
LETTERS = 18  # of a line in a box


@dataclass(frozen=True, slots=True, kw_only=True)
class Loop:
    """The words of the diagram."""

    law: str
    period: str  # sample time
    valves: str
    brake: str
    vehicle: str
    rail: str
    measured: tuple[str, ...]  # what the law goes by
    reads_brake: (
        bool  # whether the pressure of the cylinders, or the torque that follows from it, is among it
    )
    disturbed: str  # what comes between the loop and its measurement; empty if nothing does


def loop_diagram(figure: "Figure", loop: Loop) -> "Figure":
    """Draw the loop: from the law to the wheel above, and back through what is measured below.

    Parameters
    ----------
    figure : Figure
        Empty figure, :data:`HEIGHT` high.
    loop : Loop
        What stands in it.
    """
    axes = figure.subplots()
    width, height = figure.get_size_inches()
    axes.set(xlim=(0.0, width), ylim=(0.0, height))
    axes.axis("off")
    chain = (
        ("Law", loop.law, SERIES[0]),
        ("Valves", loop.valves, INK),
        ("Brake", loop.brake, INK),
        ("Wheelset, train", loop.vehicle, INK),
        ("Contact", loop.rail, INK),
    )
    places = [0.08 + WIDTH / 2 + place * (WIDTH + GAP) for place in range(len(chain))]
    for (title, words, color), x in zip(chain, places, strict=True):
        _box(axes, x, TOP, title, words, color)
    for signal, left, right in zip(
        ("command", "pressure", "torque", "slip"), places[:-1], places[1:], strict=True
    ):
        sampled = signal == "command"
        _arrow(axes, (left + WIDTH / 2, TOP), (right - WIDTH / 2, TOP), sampled=sampled)
        axes.text(
            (left + right) / 2,
            TOP + TALL / 2 + 0.1,
            signal,
            ha="center",
            va="bottom",
            fontsize=7.0,
            color=MUTED,
        )
    _back(axes, places, loop)
    return figure


def _back(axes: "Axes", places: list[float], loop: Loop) -> None:
    """Draw the way back: the adhesion to the wheel and the train, and the measurement to the law."""
    wheel, contact = places[3], places[4]
    axes.plot([contact, contact], [TOP - TALL / 2, TURN], color=INK, linestyle="-", linewidth=0.9)
    _arrow(axes, (contact, TURN), (wheel, TURN), end=False)
    _arrow(axes, (wheel, TURN), (wheel, TOP - TALL / 2))
    axes.text(
        (wheel + contact) / 2,
        TURN + 0.03,
        "creep force",
        ha="center",
        va="bottom",
        fontsize=7.0,
        color=MUTED,
    )
    middle = (places[1] + places[2]) / 2
    room = 2 * WIDTH + GAP + 0.5
    words = "; ".join((*loop.measured, *([loop.disturbed] if loop.disturbed else [])))
    _box(axes, middle, BOTTOM, "Measurement", words, SERIES[2], width=room, letters=48)
    axes.plot([wheel - 0.3, wheel - 0.3], [TOP - TALL / 2, BOTTOM], color=INK, linestyle="-", linewidth=0.9)
    _arrow(axes, (wheel - 0.3, BOTTOM), (middle + room / 2, BOTTOM))
    axes.plot(
        [middle - room / 2, places[0]], [BOTTOM, BOTTOM], color=SERIES[0], linestyle="--", linewidth=1.1
    )
    _arrow(axes, (places[0], BOTTOM), (places[0], TOP - TALL / 2), sampled=True)
    if loop.reads_brake:
        _arrow(axes, (places[2], TOP - TALL / 2), (places[2], BOTTOM + TALL / 2))
    said = f"sampled\nevery {loop.period}"
    axes.text(places[0] + 0.06, (TOP + BOTTOM) / 2, said, ha="left", va="center", fontsize=7.0, color=MUTED)


def _box(
    axes: "Axes",
    x: float,
    y: float,
    title: str,
    words: str,
    color: str,
    *,
    width: float = WIDTH,
    letters: int = LETTERS,
) -> None:
    from matplotlib.patches import FancyBboxPatch

    axes.add_patch(
        FancyBboxPatch(
            (x - width / 2, y - TALL / 2),
            width,
            TALL,
            boxstyle="round,pad=0,rounding_size=0.06",
            facecolor="none",
            edgecolor=color,
            linewidth=1.2,
        )
    )
    axes.text(x, y + TALL / 2 - 0.06, title, ha="center", va="top", fontsize=8.0, fontweight="bold")
    said = textwrap.fill(textwrap.shorten(words, 4 * letters, placeholder=" …"), letters)
    axes.text(x, y - 0.07, said, ha="center", va="center", fontsize=7.0, linespacing=1.15)


def _arrow(
    axes: "Axes",
    start: tuple[float, float],
    stop: tuple[float, float],
    *,
    sampled: bool = False,
    end: bool = True,
) -> None:
    axes.annotate(
        "",
        stop,
        start,
        arrowprops={
            "arrowstyle": "-|>" if end else "-",
            "color": SERIES[0] if sampled else INK,
            "linestyle": "--" if sampled else "-",
            "linewidth": 1.1 if sampled else 0.9,
            "shrinkA": 0.0,
            "shrinkB": 0.0,
        },
    )


def loop_alt(loop: Loop) -> str:
    """Say in words what the diagram shows."""
    disturbed = f" Between them: {loop.disturbed}." if loop.disturbed else ""
    return (
        f"A loop of blocks. Every {loop.period} the law ({loop.law}) reads what is measured "
        f"({'; '.join(loop.measured)}) and commands the valves ({loop.valves}). They set the pressure of the brake "
        f"({loop.brake}), its torque slows down the wheelset ({loop.vehicle}), and the slip of the wheel in the "
        f"contact ({loop.rail}) brings about the creep force that acts back on wheel and train.{disturbed}"
    )
