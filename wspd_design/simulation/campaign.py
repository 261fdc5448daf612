"""Many stops: chunks of rows, computed by any executor and kept in a store as they come."""

import os
import re
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import closing, contextmanager
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wspd_design.controllers.protocol import Law
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.later import later
from wspd_design.parameters.records import Vehicle
from wspd_design.parameters.taken import check_numbers
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.campaign_rows import Plan, columns, compute_rows, make_plan, plan_key
from wspd_design.simulation.campaign_store import Store
from wspd_design.simulation.description import rails_of
from wspd_design.simulation.draws import Draw
from wspd_design.simulation.parquet import check_parquet
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.taken import check_stop

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from wspd_design.parameters.table import Table

CHUNK = 128  # stops that one worker computes at a time, and that one file of a store holds
CHECK_EVERY = 100  # rows between two that are checked with half the steps
_IN_FLIGHT = 256  # chunks that wait at an executor, so that memory does not grow with the stops


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Campaign:
    """Results of many stops: one row a stop, with its seed, its drawn numbers and its figures.

    ``table`` is the record array of them; :meth:`spread` tells how the figures spread.

    Attributes
    ----------
    controller : str
    rail : str
    plant : str
    sampled : tuple[str, ...]
        Numbers that were drawn, by their dotted names.
    check_every : int
        Runs whose number is a multiple of it were checked with half the steps; 0 for none.
    table : ndarray [columns tell theirs]
        Record array.
    complete : bool
        False after an interrupt.
    remade : tuple[str, ...]
        A sentence for each file of the store that was not what it should be.
    """

    controller: str
    rail: str
    plant: str
    sampled: tuple[str, ...]
    check_every: int
    table: "NDArray[Any]"
    complete: bool
    remade: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Say in one line what was simulated."""
        return (
            f"<Campaign of {len(self.table)} stops of {self.controller} on {self.rail} ({self.plant}), "
            f"{len(self.sampled)} drawn numbers{'' if self.complete else ', interrupted'}>"
        )

    def _repr_html_(self) -> str:
        return str(later("notebook.campaigns", "campaign_card")(self))

    def figure(self, name: str) -> "NDArray[Any]":
        """Return a column of the table, or the largest of those of the axles.

        Raises
        ------
        UserError
            If there is no such column.
        """
        import numpy as np

        names = self.table.dtype.names or ()
        found = [each for each in names if each == name or re.fullmatch(rf"{re.escape(name)}_\d+", each)]
        if not found:
            near = get_close_matches(name, names, n=1)
            offer = f'did you mean "{near[0]}"? ' if near else ""
            raise UserError(
                f'there is no figure "{name}" in this campaign; {offer}there are {", ".join(names)}'
            )
        column: NDArray[Any] = np.max([self.table[each] for each in found], axis=0)
        return column

    def spread(self) -> "Table":
        """Return how each figure spreads over the trains that came to a standstill: quantiles with their unit."""
        table: Table = later("notebook.campaigns", "campaign_table")(self)
        return table

    def to_pandas(self) -> Any:
        """Return a row for each stop as a ``pandas.DataFrame``, columns named with unit; needs the extra ``frames``."""
        return later("notebook.frames", "frame_of_campaign")(self)

    def plot(self, figure: str = "distance_m", *, ax: "Axes | None" = None) -> "Axes":
        """Plot how often each value of a figure comes, over the trains that came to a standstill.

        Parameters
        ----------
        figure : str
            Column of the table, such as ``distance_m`` or ``slip_rms``; of axles, such as ``longest_lock_s``, the
            largest.
        ax : Axes, optional
            Where to draw; new axes by default.

        Returns
        -------
        Axes
            Figure with its unit over number of stops; nothing is shown or saved.

        Raises
        ------
        UserError
            If there is no such column.
        """
        axes: Axes = later("plotting.campaigns", "plot_campaign")(self, figure, ax=ax)
        return axes


def simulate_many(
    vehicle: Vehicle,
    controller: Law,
    scenario: Scenario,
    *,
    count: int,
    first: int = 0,
    draws: Sequence[Draw] = (),
    plant: str = DEFAULT_PLANT,
    check_every: int = CHECK_EVERY,
    executor: Executor | None = None,
    store: Path | None = None,
    progress: Callable[[int], object] = abs,
) -> Campaign:
    """Simulate many stops that differ in their seed and in drawn numbers of vehicle, rail and stop.

    A row depends on its number alone: it is the same bit by bit with any ``first`` and ``count`` that contain it, with
    any executor and with any number of workers.

    Parameters
    ----------
    vehicle : Vehicle
        Nominal vehicle.
    controller : Law
        Law of every wheelset, the same for all stops.
    scenario : Scenario
        Nominal stop; its seed is that of run 0 and of the drawing.
    count : int
        Number of stops.
    first : int
        Number of the first one.
    draws : sequence of Draw
        Numbers that each stop draws anew; :func:`~wspd_design.within_bounds` makes them from
        parameter files.
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        With load transfer, without, or with all degrees of freedom.
    check_every : int
        Runs whose number is a multiple of it are simulated again with half the steps; 0 for none.
    executor : concurrent.futures.Executor, optional
        Computes the chunks; a pool of threads on all cores by default, which the compiled loop keeps busy. It stays
        open. ``Client.get_executor()`` of Dask is one as well.
    store : Path, optional
        Folder for the finished chunks. What is in it already is read, not computed again.
    progress : callable, optional
        Told the number of finished stops: first of those in the store, then after each chunk.

    Returns
    -------
    Campaign
        Rows in the order of the runs. Ctrl-C ends it early with the rows that are done.

    Raises
    ------
    UserError
        If a number cannot be drawn, the controller commands what is no share of the sample time, a worker is lost or
        the store cannot be written; finished chunks stay in the store.
    """
    import numpy as np

    check_stop(vehicle, controller, scenario, plant, by="simulate_many")
    if isinstance(draws, str):
        raise UserError(
            f'draws takes a list of Draw, not the text "{draws}"; give within_bounds(...) or [Draw(...)]'
        )
    check_numbers("simulate_many", {"count": (count, ""), "first": (first, "")})
    if count < 1:
        raise UserError(f"count = {count} must be at least 1")
    if first < 0:
        raise UserError(f"first = {first} must not be negative")
    _check_executor(executor, controller)
    plan = make_plan(vehicle, controller, scenario, plant=plant, draws=tuple(draws), check_every=check_every)
    kept = None if store is None else _store(store, plan)
    table = np.zeros(count, dtype=columns(plan))
    finished = np.zeros(count, dtype=bool)

    def take(start: int, rows: "NDArray[Any]") -> None:
        place = slice(start - first, start - first + len(rows))
        table[place], finished[place] = rows, True

    complete = True
    try:
        missing = []
        for start, length in chunks(first, count):
            rows = None if kept is None else kept.read(start, length, columns(plan))
            if rows is None:
                missing.append((start, length))
            else:
                take(start, rows)
        progress(int(finished.sum()))
        with _opened(executor) as pool, closing(_computed(plan, missing, pool, kept)) as computed:
            for start, rows in computed:
                take(start, rows)
                progress(int(finished.sum()))
    except KeyboardInterrupt:
        complete = False
    if complete and kept is not None:
        kept.clear()
    return Campaign(
        controller=controller.name,
        rail=rails_of(scenario),
        plant=plant,
        sampled=tuple(draw.name for draw in draws),
        check_every=check_every,
        table=table if complete else table[finished],
        complete=complete,
        remade=() if kept is None else tuple(kept.remade),
    )


def whole(campaign: Campaign) -> Campaign:
    """Return a campaign that has all its stops, for answers that a part of them does not give.

    Raises
    ------
    KeyboardInterrupt
        The one that ended the campaign early, which it had kept to itself.
    """
    if not campaign.complete:
        raise KeyboardInterrupt
    return campaign


def chunks(first: int, count: int) -> list[tuple[int, int]]:
    """Return first run and number of runs of every chunk: pieces between multiples of ``CHUNK``."""
    end = first + count
    starts = [first, *range((first // CHUNK + 1) * CHUNK, end, CHUNK)]
    return [(start, min(start // CHUNK * CHUNK + CHUNK, end) - start) for start in starts]


def shard(count: int, number: int, of: int) -> tuple[int, int]:
    """Return first run and number of runs of one of several parts, which end between chunks.

    Parameters
    ----------
    count : int
        Runs of all parts.
    number : int
        Of the part, from 1 on.
    of : int
        Number of parts.
    """
    whole = -(-count // CHUNK)
    begin, end = (min(k * whole // of * CHUNK, count) for k in (number - 1, number))
    return begin, end - begin


def _store(folder: Path, plan: Plan) -> Store:
    check_parquet(f"the store {folder}")
    return Store(folder, plan_key(plan))


def _check_executor(executor: Executor | None, controller: Law) -> None:
    """Refuse to send a law to another process that it could not be loaded in."""
    module = type(controller).__module__
    if isinstance(executor, ThreadPoolExecutor | None) or not module.startswith(
        ("wspd_own_controller.", "__main__")
    ):
        return
    raise UserError(
        f"controller {controller.name} comes from a file that other processes do not import; run it with threads, or "
        "put it into a module that is installed where the workers run"
    )


@contextmanager
def _opened(executor: Executor | None) -> Iterator[Executor]:
    """The given executor, or threads of our own, which end with the campaign."""
    if executor is not None:
        yield executor
        return
    pool = ThreadPoolExecutor(max_workers=os.cpu_count())
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _computed(
    plan: Plan, missing: list[tuple[int, int]], executor: Executor, store: Store | None
) -> "Generator[tuple[int, NDArray[Any]], None, None]":
    """Compute chunks, keep each in the store, and yield them as they come."""
    waiting = iter(missing)
    pending: dict[Future[NDArray[Any]], int] = {}
    try:
        while True:
            for start, length in waiting:
                pending[executor.submit(compute_rows, plan, start, length)] = start
                if len(pending) >= _IN_FLIGHT:
                    break
            if not pending:
                return
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                start = pending.pop(future)
                rows = future.result()
                if store is not None:
                    store.write(start, rows)
                yield start, rows
    except (BrokenExecutor, CancelledError) as error:
        kept = (
            ""
            if store is None
            else f"; what is done is in {store.folder}, and the same command goes on from there"
        )
        raise UserError(
            f"a worker of the campaign was lost ({error or type(error).__name__}){kept}"
        ) from None
    finally:
        for future in pending:
            future.cancel()
