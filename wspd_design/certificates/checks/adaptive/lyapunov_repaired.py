"""The repaired V of the adaptive fuzzy law, divided by G and with a dead zone: it must not rise."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.adaptive.ideal_weights import ideal
from wspd_design.certificates.checks.adaptive.sampled_run import in_run, inside
from wspd_design.certificates.checks.certain_rise import certain_rise
from wspd_design.certificates.checks.frame import Check, Figures, series
from wspd_design.certificates.checks.ideal_run import ProofRun, adaptive_run, cut_short, numeric_rate
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.memory import recall
from wspd_design.certificates.records import Certificate, Problem, Role
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.certificates.theorems.adaptive_error import Ideal, Signals, signals
from wspd_design.certificates.theorems.ideal_loop import adaptive_flow
from wspd_design.certificates.theorems.lyapunov_adaptive import (
    LYAPUNOV_REPAIRED,
    TOLERANCE,
    admits,
    repaired,
    repaired_gains,
    state_place,
)
from wspd_design.certificates.theorems.sliding import reserve
from wspd_design.certificates.theorems.whom import adaptive_law

if TYPE_CHECKING:
    from wspd_design.certificates.checks.ideal_run import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class RepairedRun:
    """The idealized loop of the repaired law with its V and what V is made of."""

    target: Ideal
    run: ProofRun
    signals: Signals
    values: "Array"  # N m s, V
    rate: "Array"  # N m, dV/dt by its formula
    measured_rate: "Array"  # N m, dV/dt by differences


def repaired_run(problem: Problem) -> RepairedRun:
    """Run the law with dead zone and constant rates, whatever its own setting, in the setting of the proof."""
    return recall(["run of the repaired V", model_hash(problem)], lambda: _run(problem))


def _run(problem: Problem) -> RepairedRun:
    gains = repaired_gains(adaptive_law(problem).gains)
    plant = (problem.vehicle, problem.rail, gains)
    run = adaptive_run(*plant, speeds=problem.speeds)
    target = ideal(*plant, run, reserve(problem))
    candidate = repaired(plant, target)
    return RepairedRun(
        target=target,
        run=run,
        signals=signals(*plant, run.states, target),
        values=candidate.value(run.states),
        rate=candidate.claimed(run.states),
        measured_rate=numeric_rate(candidate.value, run),
    )


def search(problem: Problem) -> Mapping[str, Stated]:
    """Follow V along the run, and look for a state at which it rises for certain."""
    import numpy as np

    found = repaired_run(problem)
    numbers, at = in_run(found.run, found.values), found.signals
    stated = {
        "braking": Stated(numbers={"least deceleration": float(np.min(at.deceleration))}),
        "bounded": Stated(numbers={"excess": float(np.max(np.abs(at.approximation_error) - at.bound))}),
        "formula": Stated(
            numbers={
                "deviation": float(np.abs(found.measured_rate - found.rate).max()),
                "scale": float(np.abs(found.measured_rate).max()),
            }
        ),
    }
    index = _certain(problem, found) if numbers["rise"] > TOLERANCE else None
    if index is None:
        return {**stated, "run": Stated(numbers=numbers)}
    place = state_place(problem, found.run.states[:, index].tolist(), found.target)
    return {**stated, "rise": Stated(place=place)}


def _certain(problem: Problem, found: RepairedRun) -> int | None:
    """Look for a state of the run at which V rises for certain."""
    import numpy as np

    exact = (*exact_plant(problem), repaired_gains(adaptive_law(problem).gains))
    target = found.target.exact()
    order = inside(found.run, np.argsort(-found.measured_rate), problem.speeds)
    return certain_rise(
        repaired(exact, target).value,
        adaptive_flow(*exact),
        found.run,
        order,
        speaks=lambda state: admits(exact, target, state),
    )


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - the run shows more
    """V and the slip over time."""
    found = repaired_run(problem)
    return Figures(
        series=(
            series("V repaired", "time [s]", "V [N m s]", found.run.time, found.values, Role.LYAPUNOV),
            series("slip", "time [s]", "slip [-]", found.run.time, found.run.slip),
        ),
        remark=cut_short([found.run]).strip(),
    )


CHECK = Check(theorem=LYAPUNOV_REPAIRED, search=search, figures=figures)
