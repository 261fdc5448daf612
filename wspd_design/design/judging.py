"""Judge a design by the requirements that it was made for, on the sets that its search never saw."""

import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from wspd_design.controllers.protocol import Law
from wspd_design.design.records import Design
from wspd_design.design.requirements import Judged, Requirements, judged_by, seen_from_here
from wspd_design.design.search.evaluation import evaluate
from wspd_design.design.search.score import score
from wspd_design.design.search.sets import draw_sets
from wspd_design.design.stability import closes
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import beside
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def judge(design: Design, rail: Rail, *, folder: Path = Path()) -> tuple[Judged, ...]:
    """Compute the figures of a design on its held-out sets again and compare them with its limits.

    Parameters
    ----------
    design : Design
        With requirements.
    rail : Rail
        The design rail.
    folder : Path
        Of the design file, from which its own files are seen.

    Returns
    -------
    tuple of Judged
        In the order of the criteria: those with a limit, and those that are told without one.

    Raises
    ------
    UserError
        If the design states no requirements, or its files are not there.
    """
    if design.requirements is None:
        raise UserError(
            f"design {design.name} states no requirements; make it from a specification: wspd design SPEC"
        )
    wanted = seen_from_here(design.requirements, folder)
    name = beside(design.vehicle_file, folder) if design.vehicle_file else design.vehicle
    vehicle = load_vehicle(name)
    return judge_law(design.build(vehicle, rail), wanted, vehicle, name, design.specification.speeds)


def judge_law(
    law: Law, wanted: Requirements, vehicle: Vehicle, vehicle_name: str, speeds: Ends
) -> tuple[Judged, ...]:
    """Compare a law with requirements on drawn stops; paths of rails as seen from here."""
    with threads() as pool:
        (figures,) = held_out([law], wanted, vehicle, vehicle_name, pool)
    return (
        *judged_by(wanted.limits, score(figures).reached),
        *judged_stability(law, wanted, vehicle, speeds),
    )


def held_out(
    laws: Sequence[Law], requirements: Requirements, vehicle: Vehicle, vehicle_name: str, pool: Executor
) -> "list[Mapping[str, Array]]":
    """Return the figures of laws on the held-out sets."""
    sets = draw_sets(requirements, vehicle, vehicle_name, requirements.held_out, pool)
    return list(evaluate(laws, sets, pool))


def judged_stability(
    law: Law, requirements: Requirements, vehicle: Vehicle, speeds: Ends
) -> tuple[Judged, ...]:
    """Tell for each rail that asks for it whether quadratic functions are found."""
    judged = []
    for rail, share in requirements.stable_within:
        found = closes(law, vehicle, load_rail(rail), speeds=speeds, share=share)
        judged.append(
            Judged(
                requirement="stable_within",
                title=f"state left per sample, {share:.0%} of the box of {Path(rail).stem}",
                limit=1.0,
                reached=found,
                met=found is not None,
            )
        )
    return tuple(judged)


@contextmanager
def threads() -> Iterator[Executor]:
    """Threads on all cores, which the compiled loop keeps busy; an error leaves no work behind."""
    pool = ThreadPoolExecutor(max_workers=os.cpu_count())
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
