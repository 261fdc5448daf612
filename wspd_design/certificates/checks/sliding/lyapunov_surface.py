"""V = s^2/2 of (24) along the loop of the sliding-mode law: it must not rise outside the boundary layer."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.certain_rise import certain_rise
from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.ideal_run import (
    ProofRun,
    cut_short,
    largest_rise,
    numeric_rate,
    sliding_runs,
)
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.memory import recall
from wspd_design.certificates.records import Certificate, Problem, Role
from wspd_design.certificates.setting.domain import PARAMETERS
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.lyapunov_surface import (
    INTEGRAL,
    LYAPUNOV_SURFACE,
    TOLERANCE,
    exact_loop,
    outside_layer,
    surface_energy,
)
from wspd_design.certificates.theorems.whom import sliding_law
from wspd_design.model.generated import sliding_surface

if TYPE_CHECKING:
    from wspd_design.certificates.checks.ideal_run import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceRun:
    """A run with its V, and how far that rises outside the layer."""

    run: ProofRun
    slip: float  # at the start
    parameters: Mapping[str, float]
    values: "Array"
    rise: float  # of the largest V
    start: int
    end: int


def surface_runs(problem: Problem) -> list[SurfaceRun]:
    """Run the idealized loop from both ends of the slip range, with nominal and extreme parameters."""
    return recall(["runs of V = s^2/2", model_hash(problem)], lambda: _runs(problem))


def _runs(problem: Problem) -> list[SurfaceRun]:
    import numpy as np

    law = sliding_law(problem)
    nominal = tuple(problem.nominal(name) for name in PARAMETERS)
    corners = product(*(problem.span(name) for name in PARAMETERS))
    edge = float(sliding_surface.lyapunov_surface(law.gains.boundary_layer))
    cases = [
        (dict(zip(PARAMETERS, chosen, strict=True)), slip)
        for chosen, slip in product(dict.fromkeys([nominal, *corners]), problem.slips)
    ]
    runs = sliding_runs(
        [plant_with(problem, parameters) for parameters, _ in cases],
        law,
        speeds=problem.speeds,
        slips=[slip for _, slip in cases],
    )
    found = []
    for (parameters, slip), run in zip(cases, runs, strict=True):
        values = surface_energy(law, run.states)
        # Inside the layer V may do as it likes, below the value at its edge.
        rise, start, end = largest_rise(np.maximum(values, edge))
        found.append(
            SurfaceRun(
                run=run,
                slip=slip,
                parameters=parameters,
                values=values,
                rise=rise / max(float(values.max()), edge),
                start=start,
                end=end,
            )
        )
    return found


def search(problem: Problem) -> Mapping[str, Stated]:
    """Run the loop, and look for a state at which V rises for certain."""
    runs = surface_runs(problem)
    worst = max(runs, key=lambda each: each.rise)
    if not worst.rise <= TOLERANCE:
        index = _certain(problem, worst)
        if index is not None:
            speed, slip, integral = worst.run.states[:, index].tolist()
            place = {"speed": speed, "slip": slip, INTEGRAL: integral, **worst.parameters}
            return {"rise": Stated(place=place)}
    numbers = {
        "rise": worst.rise,
        "since": float(worst.run.time[worst.start]),
        "until": float(worst.run.time[worst.end]),
        **worst.parameters,
        "runs": float(len(runs)),
        "cut short": float(sum(bool(each.run.cut) for each in runs)),
    }
    return {"runs": Stated(numbers=numbers)}


def _certain(problem: Problem, worst: SurfaceRun) -> int | None:
    """Look for a state in the domain and outside the layer, in the span of a run in which V rises."""
    import numpy as np

    law = sliding_law(problem)
    energy, flow = exact_loop(problem, worst.parameters)
    rates = numeric_rate(partial(surface_energy, law), worst.run)[worst.start : worst.end + 1]
    (low, high), (slow, fast) = problem.slips, problem.speeds
    order = [
        index
        for index in (worst.start + np.argsort(-rates)).tolist()
        if low <= worst.run.slip[index] <= high and slow <= worst.run.speed[index] <= fast
    ]
    return certain_rise(energy, flow, worst.run, order, speaks=partial(outside_layer, law))


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - the runs show more
    """V over time in the runs with nominal parameters."""
    runs = surface_runs(problem)
    nominal = [each for each in runs if each.parameters == {n: problem.nominal(n) for n in PARAMETERS}]
    edge = float(sliding_surface.lyapunov_surface(sliding_law(problem).gains.boundary_layer))
    axes = ("time [s]", "V [-]")
    return Figures(
        series=(
            *(
                series(f"V from slip {each.slip:g}", *axes, each.run.time, each.values, Role.LYAPUNOV)
                for each in nominal
            ),
            level("edge of the layer", *axes, runs[-1].run.time, edge),
        ),
        remark=cut_short([each.run for each in runs]).strip(),
    )


CHECK = Check(theorem=LYAPUNOV_SURFACE, search=search, figures=figures)
