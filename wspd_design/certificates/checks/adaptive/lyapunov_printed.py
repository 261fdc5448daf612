"""V2 of (43) as printed, along the loop of the adaptive fuzzy law in exactly the setting of its proof."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.adaptive.ideal_weights import ideal
from wspd_design.certificates.checks.adaptive.sampled_run import in_run, inside
from wspd_design.certificates.checks.certain_rise import certain_rise
from wspd_design.certificates.checks.frame import Check, Figures, series
from wspd_design.certificates.checks.ideal_run import ProofRun, adaptive_run, cut_short, numeric_rate
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.memory import recall
from wspd_design.certificates.records import Certificate, Problem, Role
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.certificates.theorems import ideal_loop
from wspd_design.certificates.theorems.adaptive_error import Ideal, signals
from wspd_design.certificates.theorems.ideal_loop import adaptive_flow
from wspd_design.certificates.theorems.lyapunov_adaptive import (
    LYAPUNOV_PRINTED,
    RATE_TOLERANCE,
    TOLERANCE,
    admits,
    printed,
    state_place,
)
from wspd_design.certificates.theorems.sliding import reserve
from wspd_design.certificates.theorems.whom import adaptive_law

if TYPE_CHECKING:
    from wspd_design.certificates.checks.ideal_run import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class PrintedRun:
    """The idealized loop of the printed law with V2 and its derivatives."""

    target: Ideal
    run: ProofRun
    values: "Array"
    measured: "Array"  # derivative by differences
    claimed: "Array"  # by (44)
    corrected: "Array"  # with the terms of G'
    outside: "Array"  # whether the state lies outside the layer, where sgn(s) stands in the formulas


def printed_run(problem: Problem) -> PrintedRun:
    """Run the printed law as its proof assumes."""
    return recall(["run of V2", model_hash(problem)], lambda: _run(problem))


def _run(problem: Problem) -> PrintedRun:
    import numpy as np

    gains = adaptive_law(problem).gains
    plant = (problem.vehicle, problem.rail, gains)
    run = adaptive_run(*plant, speeds=problem.speeds)
    target = ideal(*plant, run, reserve(problem))
    candidate = printed(plant, target)
    at = signals(*plant, run.states, target)
    return PrintedRun(
        target=target,
        run=run,
        values=candidate.value(run.states),
        measured=numeric_rate(candidate.value, run),
        claimed=candidate.claimed(run.states),
        corrected=candidate.corrected(run.states),
        outside=np.abs(at.surface) > gains.boundary_layer,
    )


def search(problem: Problem) -> Mapping[str, Stated]:
    """Follow V2 and its derivative along the run; look for states that deny in balls what floats deny."""
    import numpy as np

    found, gains = printed_run(problem), adaptive_law(problem).gains
    exact = (*exact_plant(problem), gains)
    target = found.target.exact()
    candidate, flow = printed(exact, target), adaptive_flow(*exact)
    numbers = in_run(found.run, found.values)
    stated: dict[str, Stated] = {}
    if numbers["rise"] > TOLERANCE:
        # Where (44) itself speaks first, which has sgn(s) in it, then inside the layer.
        order = np.lexsort((-found.measured, np.logical_not(found.outside)))
        index = certain_rise(
            candidate.value,
            flow,
            found.run,
            inside(found.run, order, problem.speeds),
            speaks=lambda state: admits(exact, target, state),
        )
        if index is not None:
            place = state_place(problem, found.run.states[:, index].tolist(), found.target)
            stated["rise"] = Stated(place=place)
    if "rise" not in stated:
        stated["run"] = Stated(numbers=numbers)
    scale = float(np.abs(found.measured[found.outside]).max(initial=0.0))
    for key, formula, exact_formula in (
        ("claimed", found.claimed, candidate.claimed),
        ("corrected", found.corrected, candidate.corrected),
    ):
        differences = np.where(found.outside, np.abs(found.measured - formula), 0.0)
        deviation = float(differences.max())
        (worst, *_) = inside(found.run, np.argsort(-differences), problem.speeds)
        state = found.run.states[:, worst].tolist()
        if scale > 0.0 and deviation > RATE_TOLERANCE * scale:
            rate = ideal_loop.exact_rate(candidate.value, flow, state)
            if not (rate - exact_formula(tuple(map(point, state)))).contains(0):
                stated[key] = Stated(place=state_place(problem, state, found.target))
                continue
        stated[f"{key} in the run"] = Stated(numbers={"deviation": deviation, "scale": scale})
    return stated


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - the run shows more
    """V2, its derivatives and the slip over time."""
    found = printed_run(problem)
    time, rate = found.run.time, ("time [s]", "dV2/dt [1/s]")
    return Figures(
        series=(
            series("V2 as printed", "time [s]", "V2 [-]", time, found.values, Role.LYAPUNOV),
            series("measured", *rate, time, found.measured),
            series("claimed by (44)", *rate, time, found.claimed),
            series("with the terms of G'", *rate, time, found.corrected),
            series("slip", "time [s]", "slip [-]", time, found.run.slip),
        ),
        remark=f"In the run V2 starts at {found.values[0]:.3g} and rises as high as {found.values.max():.3g}; the slip "
        f"ends at {found.run.slip[-1]:.4f}.{cut_short([found.run])}",
    )


CHECK = Check(theorem=LYAPUNOV_PRINTED, search=search, figures=figures)
