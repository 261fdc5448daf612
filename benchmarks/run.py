"""Measure the ways to compute one stop side by side and compare the ratios with their goals.

``make bench`` runs it; it writes docs/benchmarks.md. Times are CPU times of interleaved rounds in one process, the
ratios medians over the rounds with their quartiles. Exit code 1 if a goal is missed.
"""

import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import date
from pathlib import Path

import references
from case import LAW, SAMPLE_TIME, VEHICLE, Scalar, given, scenario, without_compiler
from locomotive import measure_locomotive
from proofs import measure_proofs
from rows import Row, process_cpu

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.compiler import FLAGS, find_compiler
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.plants.planar import Planar
from wspd_design.simulation.loop_input import loop_input

PAGE = Path(__file__).parents[1] / "docs" / "benchmarks.md"
ROUNDS = 5
QUICK = 8  # repetitions of a fast way within a round
SIDE_BY_SIDE = 16
CAMPAIGN = 1000
FREE = 0.5  # load average below which the cores count as free
SHORT = 3.0  # s, of the stop, for what takes too long otherwise
ONE_STOP = (
    "from wspd_design.parameters.loading import load_rail, load_vehicle\n"
    "from wspd_design.controllers.baselines.unprotected import Unprotected\n"
    "from wspd_design.simulation.records import Scenario\n"
    "from wspd_design.simulation.stop import simulate\n"
    "scenario = Scenario.stop(from_kmh=120, rail=load_rail('polach-wet'))\n"
    "simulate(load_vehicle('er24pc'), Unprotected(name='none', sample_time=0.1), scenario)\n"
)


def cpu(work: Callable[[], object], repetitions: int = 1) -> float:
    """CPU time of one call: the median over the repetitions [s]."""
    times = []
    for _ in range(repetitions):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return statistics.median(times)


def measure_stops(scalar: Scalar) -> list[Row]:
    """One stop and the campaign, each against the ways that are usual."""
    single = load_closed_loop(Planar(VEHICLE), LAW)
    several = load_closed_loop(Planar(VEHICLE), LAW, stops=SIDE_BY_SIDE)
    one, many = given(), given(stops=SIDE_BY_SIDE)
    short = given(time_limit=SHORT - 0.5 * SAMPLE_TIME)
    distance = references.reference_stop()  # of another method, which takes a minute

    def error(value: float) -> str:
        return f"{abs(value / distance - 1.0):.0e}"

    def virtual() -> object:
        return run_virtual(Planar(VEHICLE), LAW, one, sample_rows=70_000, disturbed=False)

    virtual()  # builds its functions
    from_wheel = without_compiler()
    ways: dict[str, Callable[[], object]] = {
        "loop": lambda: single.run(one),
        "scalar": scalar.run,
        "campaign": lambda: several.run(many),
        "short loop": lambda: single.run(short),
        "short control": lambda: references.control_stop(SHORT),
        "from wheel": lambda: from_wheel.run(one),
        "virtual": virtual,
        "rk4": references.rk4_stop,
        "scipy": references.scipy_stop,
        "scipy numpy": lambda: references.scipy_stop(references.make_numpy_rates),
    }
    slow = {"short control", "virtual", "rk4", "scipy", "scipy numpy"}
    seconds: dict[str, list[float]] = {name: [] for name in ways}
    for round_ in range(ROUNDS):
        print(f"round {round_ + 1} of {ROUNDS}", file=sys.stderr)
        for name, work in ways.items():
            seconds[name].append(cpu(work, 1 if name in slow else QUICK))

    def ratios(slower: str, faster: str, factor: float = 1.0) -> list[float]:
        return [factor * a / b for a, b in zip(seconds[slower], seconds[faster], strict=True)]

    own = error(distance_of(single.run(one)))
    theirs = error(references.scipy_stop())
    return [
        Row(
            what="one compiled stop against SciPy RK45 1e-6",
            goal=500.0,
            at_least=True,
            ratios=ratios("scipy", "loop"),
            note=f"errors of the distance {own} and {theirs}; right-hand side in plain Python",
        ),
        Row(
            what="the same, right-hand side in NumPy",
            goal=300.0,
            at_least=True,
            ratios=ratios("scipy numpy", "loop"),
        ),
        Row(
            what="one compiled stop against Runge-Kutta in plain Python, one step per segment",
            goal=200.0,
            at_least=True,
            ratios=ratios("rk4", "loop"),
            note=f"errors of the distance {own} and {error(references.rk4_stop())}",
        ),
        Row(
            what="time of one stop over that of the hand-written scalar C program at equal error",
            goal=0.15,
            at_least=False,
            ratios=ratios("loop", "scalar"),
            note=f"-O3 -march=native, libm; errors {own} and {error(scalar.run()[0])}, {single.run(one).steps} and "
            f"{scalar.run()[1]} steps",
        ),
        Row(
            what="one stop against python-control `input_output_response`",
            goal=700.0,
            at_least=True,
            ratios=ratios("short control", "short loop"),
            note=f"first {SHORT:g} s of the stop",
        ),
        Row(
            what="without a compiler against SciPy, plain Python",
            goal=50.0,
            at_least=True,
            ratios=ratios("scipy", "from wheel"),
            note="plant as it comes with a wheel, law in CasADi's virtual machine",
        ),
        Row(
            what="the same without a wheel",
            goal=50.0,
            at_least=True,
            ratios=ratios("scipy", "virtual"),
            note="plant in the virtual machine as well",
            judged=False,
        ),
        Row(
            what="campaign per core against the scalar C program",
            goal=15.0,
            at_least=True,
            ratios=ratios("scalar", "campaign", SIDE_BY_SIDE),
            note=f"{SIDE_BY_SIDE} stops side by side",
        ),
    ]


def distance_of(output: object) -> float:
    return float(output.stop_totals["distance"][0])


def measure_axles() -> list[Row]:
    """One stop of vehicles with more axles, each with as much load, resistance and brake as four have."""
    loops = {}
    for axles in (VEHICLE.wheelsets, 6, 24):
        share = axles / VEHICLE.wheelsets
        parts = ("mass", "resistance_constant", "resistance_linear", "resistance_quadratic")
        longer = replace(VEHICLE, wheelsets=axles, **{name: share * getattr(VEHICLE, name) for name in parts})
        longer = replace(longer, body_mass=longer.mass - axles // 2 * VEHICLE.bogie_mass)
        plant = Planar(longer)
        loops[axles] = (load_closed_loop(plant, LAW), loop_input([(plant, scenario())], LAW))
    seconds: dict[int, list[float]] = {axles: [] for axles in loops}
    for _ in range(ROUNDS):
        for axles, (loop, numbers) in loops.items():
            seconds[axles].append(cpu(lambda: loop.run(numbers), QUICK))  # noqa: B023 - called at once
    return [
        Row(
            what=f"one compiled stop of {axles} axles on two-axle bogies over that of four",
            goal=goal,
            at_least=False,
            ratios=[a / b for a, b in zip(seconds[axles], seconds[VEHICLE.wheelsets], strict=True)],
        )
        for axles, goal in ((6, 1.6), (24, 4.0))
    ]


def measure_threads() -> Row:
    """A campaign on two threads against one, in wall time."""
    loop, many = load_closed_loop(Planar(VEHICLE), LAW, stops=SIDE_BY_SIDE), given(stops=SIDE_BY_SIDE)
    chunks = -(-CAMPAIGN // SIDE_BY_SIDE)

    def campaign(threads: int) -> tuple[float, float]:
        wall, used = time.perf_counter(), time.process_time()
        with ThreadPoolExecutor(max_workers=threads) as pool:
            list(pool.map(lambda _: loop.run(many), range(chunks)))
        return time.perf_counter() - wall, time.process_time() - used

    ratios, shares = [], []
    for _ in range(3):
        one, two = campaign(1), campaign(2)
        ratios.append(one[0] / two[0])
        shares.append(two[1] / two[0])  # cores that this process had
    free = statistics.median(shares) > 1.9
    return Row(
        what=f"{CAMPAIGN} stops on two threads against one, wall time",
        goal=1.8,
        at_least=True,
        ratios=ratios,
        note=f"the two threads had {statistics.median(shares):.2f} cores",
        judged=free,
    )


def measure_starts() -> list[Row]:
    """What a user waits for: starts of the program, and the first stop."""
    python = sys.executable
    wspd = str(Path(python).with_name("wspd"))
    importing: dict[str, list[float]] = {"control": [], "numpy": [], "help": [], "stop": [], "cold": []}
    with tempfile.TemporaryDirectory() as folder:
        for round_ in range(ROUNDS):
            cold = str(Path(folder) / str(round_))
            importing["cold"].append(process_cpu(python, "-c", ONE_STOP, XDG_CACHE_HOME=cold))
            importing["stop"].append(process_cpu(python, "-c", ONE_STOP, XDG_CACHE_HOME=cold))
            importing["numpy"].append(process_cpu(python, "-c", "import numpy"))
            importing["control"].append(process_cpu(python, "-c", "import control"))
            importing["help"].append(process_cpu(wspd, "--help"))

    def ratios(slower: str, faster: str) -> list[float]:
        return [a / b for a, b in zip(importing[slower], importing[faster], strict=True)]

    return [
        Row(
            what="`wspd --help` over `import control`",
            goal=0.15,
            at_least=False,
            ratios=ratios("help", "control"),
        ),
        Row(
            what="one stop in a fresh process, warm cache, over `import numpy`",
            goal=2.0,
            at_least=False,
            ratios=ratios("stop", "numpy"),
        ),
        Row(
            what="one stop in a fresh process, cold cache, CPU time with the compiler",
            goal=3.0,
            at_least=False,
            ratios=importing["cold"],
            unit="s",
        ),
    ]


def cpu_flags() -> str:
    info = Path("/proc/cpuinfo")
    return info.read_text() if info.exists() else ""


def machine() -> list[str]:
    """Where this was measured."""
    names = [
        line.partition(":")[2].strip() for line in cpu_flags().splitlines() if line.startswith("model name")
    ]
    compiler = find_compiler()
    assert compiler is not None
    version = subprocess.run([*compiler, "--version"], capture_output=True, text=True, check=True).stdout
    widest = next((name for name in ("avx512f", "avx2", "sse2") if name in cpu_flags()), "unknown")
    return [
        f"date: {date.today().isoformat()}",
        f"machine: {names[0] if names else platform.processor()}, {os.cpu_count()} cores, vectors: {widest}, "
        f"load average {os.getloadavg()[0]:.1f}",
        f"compiler: {version.splitlines()[0]}, flags `{' '.join(FLAGS)}`",
        f"Python {platform.python_version()}, "
        + ", ".join(f"{name} {module_version(name)}" for name in ("casadi", "numpy", "scipy", "control")),
    ]


def module_version(name: str) -> str:
    from importlib.metadata import version

    return version(name)


def page(rows: list[Row]) -> str:
    table = [
        "| what | goal | median (quartiles) | | |",
        "|---|---|---|---|---|",
        *(f"| {' | '.join(row.cells())} |" for row in rows),
    ]
    where = [f"* {line}" for line in machine()]
    return "\n".join([INTRODUCTION, *where, "", *table, "", REMARKS])


INTRODUCTION = f"""# Benchmarks

Written by `make bench` (`benchmarks/run.py`); run it to get the table of your own machine. All ways compute the same
stop: four axles with load transfer, wet rail (Polach), from 120 km/h, the printed adaptive fuzzy law at
{1.0 / SAMPLE_TIME:g} Hz with exact valve edges. Ratios of CPU times, measured in interleaved rounds of one process;
medians and quartiles.
"""

REMARKS = """The hand-written program `benchmarks/scalar_stop.c` computes the same integrals with the same method; its
distance agrees to 1e-9. Its steps are limited by the steepest slope of the creep curve, those of the compiled loop by
the present one. `benchmarks/references.py` holds the runs with SciPy and python-control. They step from valve edge to
valve edge as well, but between edges they choose their steps, while the compiled loop takes at most 5 ms. Against
solvers the ratios therefore grow with the sampling rate and with the number of valve edges.
"""


def main() -> int:
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        rows = [*measure_stops(Scalar(Path(folder))), *measure_axles(), measure_threads()]
        rows += [*measure_locomotive(ROUNDS), *measure_starts(), *measure_proofs()]
    for row in rows:
        what, goal, spread, verdict, note = row.cells()
        print(f"{verdict.strip('*'):10}  {spread:28}  {goal:20}  {what}{f' ({note})' if note else ''}")
    missed = [row for row in rows if row.judged and not row.met]
    print(f"{len(missed)} of {sum(row.judged for row in rows)} goals missed")
    if load > FREE:
        print(
            f"The load average was {load:.1f} at the start: nothing is judged, and {PAGE.name} stays as it is."
        )
        return 0
    PAGE.write_text(page(rows), encoding="utf-8")
    print(f"Written: {PAGE}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
