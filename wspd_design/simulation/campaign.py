"""Many stops over seeds and over parameters within their bounds, in compiled chunks on all cores."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.compiler import NoCompilerError
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.loop_numbers import LoopOutput
from wspd_design.codegen.sampled import GOOD
from wspd_design.controllers.protocol import Controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import ParameterSet, Vehicle
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.plants.planar import bogies
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.loop_input import first_slip, loop_input
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import run_loop

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

STOPS_SIDE_BY_SIDE = 16
FIGURES = ("distance_m", "stopping_time_s", "torque_integral_Nms", "slip_mean", "slip_max", "lock_time_s")


@dataclass(frozen=True, slots=True, kw_only=True)
class Campaign:
    """Results of many stops: one row a stop, with its seed, its sampled parameters and its figures."""

    controller: str
    plant: str
    sampled: tuple[str, ...]  # parameters that were drawn, by their dotted names
    table: "NDArray[Any]"  # record array
    complete: bool  # False after an interrupt


def simulate_many(
    vehicle: Vehicle,
    controller: Controller,
    scenario: Scenario,
    *,
    runs: int,
    bounds: Sequence[ParameterSet] = (),
    plant: str = DEFAULT_PLANT,
    progress: Callable[[int], object] = abs,
) -> Campaign:
    """Simulate many stops that differ in their seed and in parameters drawn from their bounds.

    Parameters
    ----------
    vehicle : Vehicle
        Nominal vehicle.
    controller : Controller
        Law of every wheelset, the same for all stops.
    scenario : Scenario
        The stop; its seed starts the sequence of seeds.
    runs : int
        Number of stops.
    bounds : sequence of ParameterSet
        Parameter files of vehicle and rail whose numbers are drawn evenly within their bounds; none by default.
    plant : {"four-axle", "quarter"}
        With or without load transfer.
    progress : callable, optional
        Told the number of finished stops.

    Returns
    -------
    Campaign
        Rows in the order of the runs. Ctrl-C ends it early with the rows that are done.
    """
    import numpy as np

    if runs < 1:
        raise UserError(f"runs = {runs} must be at least 1")
    cases, drawn, names = _cases(plant_of(plant, vehicle), scenario, runs, bounds)
    columns = [
        ("run", "i8"),
        ("seed", "i8"),
        *((name, "f8") for name in (*names, *FIGURES)),
        ("stopped", "?"),
    ]
    table = np.zeros(runs, dtype=columns)
    finished = np.zeros(runs, dtype=bool)
    table["run"] = np.arange(runs)
    table["seed"] = [case.seed for _, case in cases]
    for k, name in enumerate(names):
        table[name] = drawn[:, k]
    complete = True
    try:
        for first, count, output in _outputs(cases, controller):
            rows = slice(first, first + count)
            for name, values in _figures(output, count, scenario).items():
                table[name][rows] = values
            finished[rows] = True
            progress(int(finished.sum()))
    except KeyboardInterrupt:
        complete = False
    return Campaign(
        controller=controller.name, plant=plant, sampled=names, table=table[finished], complete=complete
    )


def _cases(
    plant: Plant, scenario: Scenario, runs: int, bounds: Sequence[ParameterSet]
) -> tuple[list[tuple[Plant, Scenario]], "NDArray[np.float64]", tuple[str, ...]]:
    """Draw the parameters of every stop; the same seed draws the same ones."""
    import numpy as np

    varied = [
        (parameters.kind, name, limits)
        for parameters in bounds
        for name, entry in parameters.entries.items()
        if (limits := entry.bounds) is not None and limits[0] < limits[1] and isinstance(entry.value, float)
    ]
    generator = np.random.default_rng(np.random.SeedSequence([scenario.seed, 1]))
    low, high = (np.array([limits[end] for _, _, limits in varied]) for end in (0, 1))
    drawn = low + (high - low) * generator.random((runs, len(varied)))
    cases = []
    for run, row in enumerate(drawn.tolist()):
        values: dict[str, dict[str, float]] = {"vehicle": {}, "rail": {}}
        for (kind, name, _), value in zip(varied, row, strict=True):
            values[kind][name] = value
        rails = None
        if scenario.axle_rails is not None:
            rails = tuple(_with(rail, values["rail"]) for rail in scenario.axle_rails)
        case = replace(
            scenario, rail=_with(scenario.rail, values["rail"]), axle_rails=rails, seed=scenario.seed + run
        )
        cases.append((plant.on(_vehicle_with(plant.vehicle, values["vehicle"])), case))
    return cases, drawn, tuple(f"{kind}.{name}" for kind, name, _ in varied)


def _with(record: Any, values: dict[str, float]) -> Any:
    known = {field.name for field in fields(record)}
    return replace(record, **{name: value for name, value in values.items() if name in known})


def _vehicle_with(vehicle: Vehicle, values: dict[str, float]) -> Vehicle:
    """Change numbers of a vehicle; the body takes up what the mass gains or loses."""
    parts = {
        part: _with(
            getattr(vehicle, part),
            {
                name.removeprefix(f"{part}."): value
                for name, value in values.items()
                if name.startswith(f"{part}.")
            },
        )
        for part in ("brake", "contact")
    }
    changed: Vehicle = replace(_with(vehicle, values), **parts)
    if "mass" in values:
        changed = replace(changed, body_mass=changed.mass - bogies(vehicle) * changed.bogie_mass)
    return changed


def _outputs(
    cases: list[tuple[Plant, Scenario]], controller: Controller
) -> Iterator[tuple[int, int, LoopOutput]]:
    """Run the stops in chunks on all cores; yields (first run, number, output) as chunks finish."""
    plant, scenario = cases[0]
    try:
        loop = load_closed_loop(plant, controller, stops=STOPS_SIDE_BY_SIDE, disturbed=scenario.pad_vibration)
    except (NoCompilerError, UntraceableError):
        for run, case in enumerate(cases):
            each, stop = case
            yield run, 1, run_loop(each, controller, stop, loop_input([case], controller))[0]
        return

    def work(first: int) -> tuple[int, int, LoopOutput]:
        chunk = cases[first : first + STOPS_SIDE_BY_SIDE]
        filled = chunk + chunk[-1:] * (STOPS_SIDE_BY_SIDE - len(chunk))
        output = loop.run(loop_input(filled, controller))
        if output.result != GOOD:
            raise UserError(
                f"controller {controller.name} commanded no share of the sample time in runs {first} to "
                f"{first + len(chunk) - 1}; simulate one of them alone to see the value"
            )
        return first, len(chunk), output

    pool = ThreadPoolExecutor(max_workers=os.cpu_count())
    starts = iter(range(0, len(cases), STOPS_SIDE_BY_SIDE))
    pending: set[Future[tuple[int, int, LoopOutput]]] = set()
    try:
        while True:
            for first in starts:  # keep a few chunks in flight, so that memory does not grow with the runs
                pending.add(pool.submit(work, first))
                if len(pending) > 2 * (os.cpu_count() or 1):
                    break
            if not pending:
                return
            done, pending = wait(pending, return_when=FIRST_COMPLETED)
            for future in done:
                yield future.result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _figures(output: LoopOutput, count: int, scenario: Scenario) -> dict[str, Any]:
    """Columns of the table for the first ``count`` stops of a chunk."""
    import numpy as np

    stops = len(output.stopped)
    lanes = {name: x.reshape(-1, stops)[:, :count] for name, x in output.lane_totals.items()}
    totals = {name: x[:count] for name, x in output.stop_totals.items()}
    judged = np.where(totals["judged_time"] > 0.0, totals["judged_time"], np.nan)
    return {
        "distance_m": totals["distance"],
        "stopping_time_s": totals["time"],
        "torque_integral_Nms": lanes["torque"].sum(axis=0),
        "slip_mean": lanes["slip"].mean(axis=0) / judged,
        "slip_max": np.maximum(lanes["slip_max"].max(axis=0), first_slip(scenario)),
        "lock_time_s": lanes["lock_time"].max(axis=0),
        "stopped": output.stopped[:count],
    }
