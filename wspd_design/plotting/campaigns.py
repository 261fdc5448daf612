"""How often each value of a figure comes in a campaign."""

from typing import TYPE_CHECKING

from wspd_design.exchange.columns import unit_of
from wspd_design.exchange.forms import UNITS
from wspd_design.plotting.axes import on_axes
from wspd_design.reporting.figure_style import SERIES
from wspd_design.reporting.figures.drawing import note
from wspd_design.reporting.figures.uncertainty import BINS
from wspd_design.simulation.campaign import Campaign

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot_campaign(campaign: Campaign, figure: str, *, ax: "Axes | None" = None) -> "Axes":
    """Plot a figure of a campaign; parameters as of :meth:`wspd_design.Campaign.plot`."""
    campaign.figure(figure)  # refused before anything is drawn

    def draw(axes: "Axes") -> None:
        _panel(axes, campaign, figure)
        stopped = int(campaign.table["stopped"].sum())
        axes.set_title(f"{stopped} stops of {campaign.controller} on {campaign.rail}")

    return on_axes(ax, draw)


def distribution_panel(figure: "Figure", campaign: Campaign, name: str) -> "Figure":
    """Draw how often each value of a figure comes on an empty figure."""
    _panel(figure.subplots(), campaign, name)
    return figure


def _panel(axes: "Axes", campaign: Campaign, name: str) -> None:
    import numpy as np

    values = campaign.figure(name)[campaign.table["stopped"]].astype(float)
    known = values[np.isfinite(values)]
    if known.size:
        axes.hist(known, bins=BINS, color=SERIES[0], alpha=0.55)
        marked: dict[float, list[str]] = {}
        for level, said in ((0.05, "5 %"), (0.5, "median"), (0.95, "95 %")):
            marked.setdefault(float(np.quantile(known, level)), []).append(said)
        for place, words in marked.items():
            style = "-" if "median" in words else "--"
            axes.axvline(place, color=SERIES[1], linestyle=style, linewidth=1.2)
            top = axes.get_ylim()[1]
            note(axes, ", ".join(words), place, top, rotation=90, va="top", xytext=(2, -2))
    unit = unit_of(name)
    axes.set(xlabel=f"{_words(name, unit)} [{unit or '-'}]", ylabel="number of stops")


def _words(name: str, unit: str) -> str:
    """Name of a column without its unit."""
    end = next((each for each, spelled in UNITS.items() if spelled == unit and name.endswith(each)), "")
    return name.removesuffix(end).replace("_", " ")
