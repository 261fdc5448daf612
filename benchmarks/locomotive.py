"""How much faster than real time the locomotive with 82 degrees of freedom stops, on one core."""

import time
from dataclasses import replace

from case import SPEED, VEHICLE
from rows import Row

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.names import plant_of
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import Scenario

RAIL = load_rail("table10-dry")
LAW = controller("afsmc", VEHICLE, RAIL, Specification())
SIDE_BY_SIDE = 16
SHORT = 1.0  # s, of the stop without a compiler
CASES = (
    ("locomotive", "none", 1, 15.0),
    ("locomotive", "high", 1, 8.0),
    ("locomotive-linear", "none", 1, 80.0),
    ("locomotive-linear", "high", 1, 80.0),
    ("locomotive-linear", "high", SIDE_BY_SIDE, 150.0),
)


def measure_locomotive(rounds: int) -> list[Row]:
    """Stops over real time, compiled, side by side, and without a compiler."""
    return [*(_compiled(*case, rounds) for case in CASES), _virtual(rounds)]


def _compiled(name: str, irregularities: str, stops: int, goal: float, rounds: int) -> Row:
    plant = plant_of(name, VEHICLE)
    cases = [(plant, _stop(irregularities, seed)) for seed in range(stops)]
    loop, given, ratios = load_closed_loop(plant, LAW, stops=stops), loop_input(cases, LAW), []
    for _ in range(rounds):
        start = time.process_time()
        out = loop.run(given)
        ratios.append(float(out.stop_totals["time"].sum()) / (time.process_time() - start))
    beside = f", {stops} stops side by side" if stops > 1 else ""
    step = float(given.settings.longest_step)
    return Row(
        what=f"`{name}`, irregularities {irregularities}{beside}, over real time",
        goal=goal,
        at_least=True,
        ratios=ratios,
        note=f"afsmc, 10 Hz, table10-dry, from 120 km/h, steps of at most {1e3 * step:g} ms, {out.steps} of them",
    )


def _virtual(rounds: int) -> Row:
    plant = plant_of("locomotive", VEHICLE)
    given = replace(loop_input([(plant, _stop("none", 0))], LAW), trace_rows=0)
    given.settings.time_limit = SHORT - 0.05

    def run() -> float:
        start = time.process_time()
        run_virtual(plant, LAW, given, sample_rows=sample_rows(LAW), disturbed=False)
        return SHORT / (time.process_time() - start)

    run()  # builds the functions
    return Row(
        what="`locomotive` without a compiler over real time",
        goal=0.5,
        at_least=True,
        ratios=[run() for _ in range(rounds)],
        note=f"first {SHORT:g} s of the stop, in CasADi's virtual machine",
    )


def _stop(irregularities: str, seed: int) -> Scenario:
    return Scenario(rail=RAIL, initial_speed=SPEED, irregularities=irregularities, seed=seed)


if __name__ == "__main__":
    for row in measure_locomotive(5):
        print(*row.cells(), sep=" | ")
