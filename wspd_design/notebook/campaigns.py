"""Campaigns: how the figures of many stops spread."""

from collections.abc import Iterator

from wspd_design.exchange.columns import unit_of
from wspd_design.notebook.html import card, small_picture
from wspd_design.parameters.table import Column, Table, table_of
from wspd_design.plotting.campaigns import distribution_panel
from wspd_design.simulation.campaign import Campaign
from wspd_design.simulation.campaign_rows import AXLE_FIGURES, CHECKED

_LEVELS = {"min": 0.0, "5 %": 0.05, "median": 0.5, "95 %": 0.95, "max": 1.0}
_NO_FIGURES = ("run", "seed", "stopped", *CHECKED)
_Row = tuple[str, str, dict[str, float]]


def campaign_table(campaign: Campaign) -> Table:
    """Return quantiles of each figure over the trains that came to a standstill."""
    columns: list[Column[_Row]] = [
        Column(title="figure", read=lambda row: row[0]),
        Column(title="unit", read=lambda row: row[1]),
        *(Column(title=name, digits=4, read=lambda row, name=name: row[2][name]) for name in _LEVELS),  # type: ignore[misc]
    ]
    return table_of(_rows(campaign), columns, caption=_title(campaign), notes=_notes(campaign))


def campaign_card(campaign: Campaign) -> str:
    """Return what a notebook shows of a campaign."""
    if not len(campaign.table):
        return card(_title(campaign), verdict=("open", "No stop was finished."))
    drawn = small_picture(
        lambda figure: distribution_panel(figure, campaign, "distance_m"),
        height=1.9,
        alt="How often each stopping distance comes; the table tells the quantiles.",
    )
    table = campaign_table(campaign)
    open_ = not campaign.complete or not campaign.table["stopped"].all()
    verdict = ("open", _notes(campaign)[0]) if open_ else None
    return card(_title(campaign), verdict=verdict, pictures=[drawn], tables=[table])


def _title(campaign: Campaign) -> str:
    interrupted = "" if campaign.complete else ", interrupted"
    return f"{len(campaign.table)} stops of {campaign.controller} on {campaign.rail} ({campaign.plant}){interrupted}"


def _notes(campaign: Campaign) -> list[str]:
    moving = int((~campaign.table["stopped"]).sum())
    drawn = f"Each stop draws {', '.join(campaign.sampled)}." if campaign.sampled else "Drawn: seeds only."
    return [
        f"{moving} of {len(campaign.table)} did not stop within the time limit, and the figures leave them out."
        if moving
        else "",
        drawn,
    ]


def _rows(campaign: Campaign) -> Iterator[_Row]:
    import numpy as np

    stopped = campaign.table["stopped"]
    names = [name for name in campaign.table.dtype.names or () if name not in _NO_FIGURES]
    single = [name for name in names if not name.startswith(AXLE_FIGURES) and name not in campaign.sampled]
    for name in (*single, *AXLE_FIGURES):
        values = campaign.figure(name)[stopped]
        known = values[~np.isnan(values)]
        if known.size:
            found = np.quantile(known, list(_LEVELS.values())).tolist()
            label = f"{name}, largest of the axles" if name in AXLE_FIGURES else name
            yield label, unit_of(name), dict(zip(_LEVELS, found, strict=True))
