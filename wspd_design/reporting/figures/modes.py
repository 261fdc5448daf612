"""Modes of a vehicle: where their energy is, their poles over speed, and critical speeds over conicity."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from wspd_design.reporting.figure_style import INK, LINE_STYLES, MUTED, SERIES
from wspd_design.reporting.figures.drawing import KMH, note

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from wspd_design.analysis.critical_speed import CriticalSpeed
    from wspd_design.analysis.modes import Mode

    Poles = NDArray[np.complex128]

_LABELED = 0.12  # share of the energy from which a part of a bar has room for its direction
_FASTEST_DECAY = -12.0  # 1/s, likewise
_HIGHEST = 15.0  # Hz, of the poles that are shown over speed


def draw_modes(
    figure: "Figure",
    modes: "Sequence[Mode]",
    locus: "Sequence[tuple[float, Poles]]",
    critical: "Sequence[CriticalSpeed]",
    *,
    title: str,
) -> "Figure":
    """Draw the energy of each mode, poles over speed, and critical speeds where there are several.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    modes : sequence of Mode
        Shown as bars, from the top.
    locus : sequence of (float, ndarray)
        Speeds [m/s] and the poles there [1/s].
    critical : sequence of CriticalSpeed
        For each conicity.
    title : str
        What vehicle is shown, and how sure its numbers are.
    """
    figure.suptitle(title, x=0.01, ha="left", fontsize=8.0, color=MUTED)
    lower = 1 + (len(critical) > 1)
    heights = [max(0.16 * len(modes) + 0.5, 1.5), *[2.6] * lower]
    panels = figure.subplots(1 + lower, 1, gridspec_kw={"height_ratios": heights})
    energy_shares(panels[0], modes)
    pole_locus(panels[1], locus)
    if lower > 1:
        critical_speeds(panels[2], critical)
    return figure


def figure_height(modes: "Sequence[Mode]", critical: "Sequence[CriticalSpeed]") -> float:
    """Return the height that :func:`draw_modes` needs [in]."""
    return max(0.16 * len(modes) + 0.5, 1.5) + 2.6 * (1 + (len(critical) > 1))


def energy_shares(axes: "Axes", modes: "Sequence[Mode]") -> None:
    """Draw a bar for each mode: the share of the kinetic energy of each kind of body and direction."""
    kinds = list(
        dict.fromkeys(share.kind for mode in modes for share in sorted(mode.shares, key=lambda s: s.kind))
    )
    for row, mode in enumerate(modes):
        at = 0.0
        for share in mode.shares:
            if share.share <= 0.0:
                continue
            color = SERIES[kinds.index(share.kind) % len(SERIES)]
            axes.barh(row, share.share, left=at, height=0.78, color=color, edgecolor="white", linewidth=0.6)
            if share.share >= _LABELED:
                dark = color == INK
                axes.text(
                    at + 0.5 * share.share,
                    row,
                    share.direction,
                    ha="center",
                    va="center",
                    fontsize=6.5,
                    color="white" if dark else INK,
                )
            at += share.share
    axes.set_yticks(range(len(modes)), [f"{mode.name}  {mode.natural_frequency:.2f} Hz" for mode in modes])
    longest = max((sum(max(each.share, 0.0) for each in mode.shares) for mode in modes), default=1.0)
    axes.grid(visible=False, axis="y")
    axes.set(xlim=(0.0, longest), ylim=(len(modes) - 0.4, -0.6), xlabel="share of the kinetic energy [-]")
    axes.set_title("Energy of the modes", pad=20.0)
    for kind in kinds:
        axes.bar(0.0, 0.0, color=SERIES[kinds.index(kind) % len(SERIES)], label=kind.replace("_", " "))
    axes.legend(
        loc="lower right",
        bbox_to_anchor=(1.02, 1.0),
        ncols=len(kinds),
        handlelength=0.9,
        handletextpad=0.4,
        columnspacing=1.0,
    )


def pole_locus(axes: "Axes", locus: "Sequence[tuple[float, Poles]]") -> None:
    """Draw the poles below 15 Hz, real ones too, with their speed as color."""
    import numpy as np
    from matplotlib.colors import LinearSegmentedColormap

    speeds = np.concatenate([np.full(len(poles), speed) for speed, poles in locus])
    poles = np.concatenate([each for _, each in locus])
    shown = (poles.imag >= 0.0) & (poles.imag < 2.0 * np.pi * _HIGHEST)
    colors = LinearSegmentedColormap.from_list("speed", [SERIES[4], SERIES[0], INK])
    dots = axes.scatter(
        poles.real[shown],
        poles.imag[shown] / (2.0 * np.pi),
        c=speeds[shown] * KMH,
        s=5.0,
        cmap=colors,
        linewidths=0.0,
    )
    left = max(float(poles.real[shown].min()), _FASTEST_DECAY)
    right = max(1.0, 1.15 * float(poles.real[shown].max()))
    axes.axvspan(0.0, right, color=SERIES[1], alpha=0.12, linewidth=0)
    axes.axvline(0.0, color=MUTED, linewidth=0.8)
    axes.set(xlim=(left, right), ylim=(0.0, _HIGHEST))
    axes.set(xlabel="growth [1/s]", ylabel="frequency [Hz]", title="Poles over speed; shaded: they grow")
    bar = axes.figure.colorbar(dots, ax=axes, pad=0.01)
    bar.set_label("speed [km/h]")


def critical_speeds(axes: "Axes", critical: "Sequence[CriticalSpeed]") -> None:
    """Draw the critical speed over the conicity; where none was found, a triangle at the highest one tried."""
    ordered = sorted(critical, key=lambda each: each.conicity)
    found = [each for each in ordered if each.speed is not None]
    axes.plot(
        [each.conicity for each in found],
        [(each.speed or 0.0) * KMH for each in found],
        color=SERIES[0],
        linestyle=LINE_STYLES[0],
        marker="o",
        markersize=4,
    )
    for each in found:
        if each.mode is not None:
            note(axes, f"{each.mode.frequency:.2g} Hz", each.conicity, (each.speed or 0.0) * KMH)
    for each in ordered:
        if each.speed is None:
            axes.plot([each.conicity], [each.tried[1] * KMH], color=SERIES[1], marker="^", linestyle="none")
            note(axes, "not up to here", each.conicity, each.tried[1] * KMH)
    top = max([(each.speed or each.tried[1]) * KMH for each in ordered])
    axes.set(ylim=(0.0, 1.15 * top), xlabel="conicity [-]", ylabel="critical speed [km/h]")
    axes.set(title="Speed from which small deviations grow")
