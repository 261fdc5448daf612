"""Stops side by side in one compiled loop, and one after another where that cannot be."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.compiler import NoCompilerError
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.loop_numbers import LoopInput, LoopOutput
from wspd_design.codegen.sampled import GOOD
from wspd_design.controllers.protocol import Law
from wspd_design.parameters.errors import UserError
from wspd_design.plants.protocol import Plant, is_coupled
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import run_loop

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Cases: TypeAlias = Sequence[tuple[Plant, Scenario]]

STOPS_SIDE_BY_SIDE = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class Batch:
    """Totals of several stops; the last axis of every array is the stop."""

    stopped: "NDArray[np.bool_]"
    lanes: "dict[str, NDArray[np.float64]]"  # by axle and stop
    stops: "dict[str, NDArray[np.float64]]"


def run_batch(cases: Cases, controller: Law, numbers: Callable[[Cases], LoopInput], *, what: str) -> Batch:
    """Run stops with one controller.

    Parameters
    ----------
    cases : sequence of (Plant, Scenario)
        Plants of one kind; ``STOPS_SIDE_BY_SIDE`` of them run in one loop, any other number one after another, and so
        do those of large plants.
    controller : Law
        Law of every wheelset, or of the vehicle.
    numbers : callable
        Makes the input of the loop.
    what : str
        Names the stops in the sentence about a bad command.

    Raises
    ------
    UserError
        If the controller commands what is no share of the sample time.
    """
    outputs = _side_by_side(cases, controller, numbers) or [
        run_loop(plant, controller, scenario, numbers([(plant, scenario)]))[0] for plant, scenario in cases
    ]
    if any(output.result != GOOD for output in outputs):
        raise UserError(
            f"controller {controller.name} commanded no share of the sample time in {what}; "
            "simulate one of them alone to see the value"
        )
    return _together(outputs, cases[0][0].axles)


def _side_by_side(cases: Cases, controller: Law, numbers: Callable[[Cases], LoopInput]) -> list[LoopOutput]:
    """Run all stops in one compiled loop; empty where their number or this machine does not allow it."""
    plant = cases[0][0]
    if len(cases) != STOPS_SIDE_BY_SIDE or (is_coupled(plant) and not plant.side_by_side):
        return []
    shaken = any(scenario.pad_vibration for _, scenario in cases)
    try:
        loop = load_closed_loop(plant, controller, stops=len(cases), disturbed=shaken)
    except (NoCompilerError, UntraceableError):
        return []
    return [loop.run(numbers(cases))]


def _together(outputs: Sequence[LoopOutput], axles: int) -> Batch:
    import numpy as np

    first = outputs[0]
    return Batch(
        stopped=np.concatenate([output.stopped for output in outputs]),
        lanes={
            name: np.hstack([output.lane_totals[name].reshape(axles, -1) for output in outputs])
            for name in first.lane_totals
        },
        stops={
            name: np.concatenate([output.stop_totals[name] for output in outputs])
            for name in first.stop_totals
        },
    )
