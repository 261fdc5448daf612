"""Sensitivities: one variable at a time around the chosen point, on the same sets."""

from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.design.search.evaluation import evaluate
from wspd_design.design.search.methods import Point
from wspd_design.design.search.run import Space
from wspd_design.design.search.score import objective
from wspd_design.design.search.sets import Sets

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

STEP = 0.1  # of the range of a variable, to both sides


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivity:
    """What a step of one variable changes."""

    name: str
    value: float
    objective: float  # change against the chosen point
    mean_excess: float  # change of the mean excess of the distance
    error: float  # standard error of that change, from the differences set by set


def sensitivities(space: Space, chosen: Point, sets: Sets, pool: Executor) -> tuple[Sensitivity, ...]:
    """Work out what steps of single variables change, to both sides as far as the ranges go.

    Parameters
    ----------
    space : Space
        What was searched.
    chosen : Point
        Around which the steps are made.
    sets : Sets
        Stops; all points run the same ones, so that their differences are known better than their sizes.
    pool : Executor
        Threads.
    """
    import numpy as np

    steps = [
        (place, share)
        for place in range(len(chosen))
        for share in (max(chosen[place] - STEP, 0.0), min(chosen[place] + STEP, 1.0))
        if share != chosen[place]
    ]
    points = [chosen, *((*chosen[:place], share, *chosen[place + 1 :]) for place, share in steps)]
    laws = [space.law_at(point) for point in points]
    middle, *around = (figures["excess"] for figures in evaluate(laws, sets, pool))
    found = []
    for (place, share), excess in zip(steps, around, strict=True):
        variable, difference = space.variables[place], excess - middle
        found.append(
            Sensitivity(
                name=variable.name,
                value=variable.value(share),
                objective=objective(excess) - objective(middle),
                mean_excess=float(difference.mean()),
                error=float(np.std(difference, ddof=1) / np.sqrt(len(difference)))
                if len(difference) > 1
                else 0.0,
            )
        )
    return tuple(found)
