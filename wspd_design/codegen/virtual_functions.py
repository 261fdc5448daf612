"""Steps of the closed loop as CasADi functions, several of them in one call."""

from collections.abc import Iterable
from typing import Any, NamedTuple

from wspd_design.codegen.kernels import Kernels
from wspd_design.codegen.virtual_coupled import CoupledStep, TrackTable
from wspd_design.codegen.virtual_layout import Layout, layout
from wspd_design.codegen.virtual_step import Step


class StepFunctions(NamedTuple):
    """What runs a stop without a compiler."""

    layout: Layout
    observe: Any  # (state, inputs, table of the track) -> state with the present stage
    single: Any  # (state, inputs, table of the track) -> state, row with what follows it
    batches: dict[int, Any]  # number of steps -> (state, inputs, table) -> state, one column per step


def step_functions(
    kernels: Kernels, *, holding: bool, batches: Iterable[int], track: TrackTable | None = None
) -> StepFunctions:
    """Build the functions of a plant; ``holding`` for the ideal brake that never exceeds a slip."""
    import casadi as ca

    places = layout(kernels)
    kind = (
        ca.MX if kernels.coupled else ca.SX
    )  # a kernel of many thousand operations is called, not written out
    state, given = kind.sym("state", places.states), kind.sym("given", places.inputs)
    table = kind.sym("table", 0 if track is None else track.numbers)
    step = (
        CoupledStep(kernels, places, state, given, table=table, track=track)
        if kernels.coupled
        else Step(kernels, places, state, given, holding=holding)
    )
    inputs: list[Any] = [state, given, table]
    observe = ca.Function("observe", inputs, ca.cse([step.observed()]))
    single = ca.Function("step", inputs, ca.cse(step.outputs()))
    repeated = {}
    for number in batches:
        following: Any = ca.MX.sym("state", places.states)
        begin, rows = following, []
        fixed = [ca.MX.sym("given", places.inputs), ca.MX.sym("table", table.size1())]
        for _ in range(number):
            following, row = single(following, *fixed)
            rows.append(row)
        repeated[number] = ca.Function(f"steps{number}", [begin, *fixed], [following, ca.horzcat(*rows)])
    return StepFunctions(layout=places, observe=observe, single=single, batches=repeated)
