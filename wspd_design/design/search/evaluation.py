"""Laws on drawn sets: groups of sixteen stops on all cores, in any order and with one result."""

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future
from typing import TYPE_CHECKING, Any

from wspd_design.controllers.protocol import Law
from wspd_design.design.search.sets import Group, Sets, told
from wspd_design.simulation.campaign_rows import figures_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def evaluate(laws: Sequence[Law], sets: Sets, pool: Executor) -> "Iterator[Mapping[str, Array]]":
    """Simulate laws on all sets and yield the figures of each, in the order of the laws.

    Parameters
    ----------
    laws : sequence of Controller or VehicleController
        Their numbers are inputs of the compiled loop, so that laws of one kind are compiled once.
    sets : Sets
        The stops.
    pool : Executor
        Threads; they share the groups of all laws.

    Yields
    ------
    mapping
        Columns of a campaign over the sets, and ``excess``: distance over that of the ideal stop, less 1.
    """
    import numpy as np

    order = np.argsort([k for group in sets.groups for k in group.numbers])[: sets.drawn.sets]
    waiting = [[pool.submit(_figures, group, law) for group in sets.groups] for law in laws]
    try:
        for futures in waiting:
            parts = [future.result() for future in futures]
            yield {name: np.concatenate([part[name] for part in parts])[order] for name in parts[0]}
    finally:
        _cancel(waiting)


def _figures(group: Group, law: Law) -> dict[str, Any]:
    figures = figures_of(group.cases, law, group.ideal, told(group.numbers))
    return figures | {"excess": figures["distance_m"] / group.ideal - 1.0}


def _cancel(waiting: "Sequence[Sequence[Future[dict[str, Any]]]]") -> None:
    for futures in waiting:
        for future in futures:
            future.cancel()
