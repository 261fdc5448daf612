"""``wspd campaign``: many stops as a file says, on one machine or many, resumed where they were left."""

import re
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from wspd_design.cli import options
from wspd_design.cli.campaign import GOES_ON, Extent, simulate_series, tell_series
from wspd_design.cli.campaign_file import read_campaign
from wspd_design.cli.console import interrupted
from wspd_design.cli.executors import EXECUTORS, executor
from wspd_design.cli.tables import check_table
from wspd_design.parameters.errors import UserError
from wspd_design.simulation.campaign import shard as part_of

_WHERE = "Where it runs"
_SHARD = re.compile(r"(?P<number>\d+)/(?P<of>\d+)")


def campaign(
    *,
    file: Annotated[Path, typer.Argument(metavar="FILE", help="What to simulate (wspd docs campaigns).")],
    store: Annotated[
        Path | None,
        typer.Option(
            "--store",
            metavar="FOLDER",
            help="Finished chunks; campaigns may share it. Default: the name of FILE with .store.",
            show_default=False,
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE", help="All rows, to .csv, .parquet or .mat.", show_default=False
        ),
    ] = None,
    force: options.ForceOption = False,
    as_json: options.JsonOption = False,
    kind: Annotated[
        str,
        typer.Option("--executor", metavar="NAME", help=f"{', '.join(EXECUTORS)}.", rich_help_panel=_WHERE),
    ] = EXECUTORS[0],
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers",
            min=1,
            metavar="NUMBER",
            help="Threads or processes here. Default: all cores.",
            show_default=False,
            rich_help_panel=_WHERE,
        ),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            metavar="ADDRESS",
            help="Of Dask, such as tcp://host:8786; without one a cluster is started here.",
            show_default=False,
            rich_help_panel=_WHERE,
        ),
    ] = None,
    shard: Annotated[
        str | None,
        typer.Option(
            "--shard",
            metavar="I/N",
            help="The I-th of N parts, from 1 on, for job arrays with one store.",
            show_default=False,
            rich_help_panel=_WHERE,
        ),
    ] = None,
) -> None:
    """Simulate many stops as FILE says; what is finished stays, and the same command goes on from there.

    Rows are the same bit by bit with any executor, any number of workers and any division into parts.
    """
    if output is not None:
        check_table(output, force=force)
    wanted = read_campaign(file)
    first, count = (0, wanted.stops) if shard is None else _part(shard, wanted.stops)
    kept = file.with_suffix(".store") if store is None else store
    extent = Extent(plant=wanted.plant, first=first, count=count, check_every=wanted.check_every, store=kept)
    opened = partial(executor, kind, workers=workers, scheduler=scheduler)
    summaries = simulate_series(wanted.series, extent, opened, what=file.name)
    if all(each.campaign.complete for each in summaries):
        tell_series(wanted.series, summaries, output=output, force=force, as_json=as_json)
        return
    done, total = sum(len(each.campaign.table) for each in summaries), len(wanted.series) * count
    raise interrupted(f"{done} of {total} stops{GOES_ON.format(store=kept)}")


def _part(text: str, stops: int) -> tuple[int, int]:
    found = _SHARD.fullmatch(text)
    if found is None or not 1 <= int(found["number"]) <= int(found["of"]):
        raise UserError(f'--shard "{text}" must be I/N with I from 1 to N, such as 3/10')
    first, count = part_of(stops, int(found["number"]), int(found["of"]))
    if count == 0:
        raise UserError(
            f'--shard "{text}" is empty: {stops} stops have fewer chunks than parts; take fewer parts'
        )
    return first, count
