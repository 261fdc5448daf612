"""Barbalat's lemma (45)-(48) speaks about t to infinity, but a stop ends: what can be said instead."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.adaptive.lyapunov_repaired import repaired_run
from wspd_design.certificates.checks.frame import Check, Figures
from wspd_design.certificates.checks.ideal_run import ProofRun, sliding_run
from wspd_design.certificates.checks.sliding.sliding_exists import torques
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.together import settle_together
from wspd_design.certificates.theorems.authority import torque_obligations
from wspd_design.certificates.theorems.barbalat import BARBALAT, in_sigma, slowing_obligations, to_standstill
from wspd_design.certificates.theorems.sliding import reserve
from wspd_design.certificates.theorems.whom import adaptive, sliding_law
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import saturation

if TYPE_CHECKING:
    from wspd_design.certificates.checks.ideal_run import Array

DECELERATION_TOLERANCE = 1e-2  # m/s2


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the torques in sigma, or see that the run ends and compare its integral of abs(s_D) with the bound."""
    import numpy as np

    if in_sigma(problem):
        return torques(torque_obligations(problem, to_standstill(problem)))
    stated = dict(settle_together(slowing_obligations(problem), tolerance=DECELERATION_TOLERANCE))
    run, dead_zone, bound = _run(problem)
    if run.cut:
        return stated
    steepest = float(np.max(np.abs(np.diff(dead_zone)) / np.diff(run.time)))
    numbers = {
        "end": float(run.time[-1]),
        "integral": float(_growing(run, dead_zone)[-1]),
        "bound": bound,
    }
    return {
        **stated,
        "integral": Stated(numbers=numbers),
        "continuity": Stated(numbers={"constant": steepest}),
    }


def _growing(run: ProofRun, dead_zone: "Array") -> "Array":
    """Integral of abs(s_D) over time."""
    import numpy as np

    sizes = np.abs(dead_zone)
    found: Array = np.concatenate([[0.0], np.cumsum(0.5 * (sizes[1:] + sizes[:-1]) * np.diff(run.time))])
    return found


def _run(problem: Problem) -> tuple[ProofRun, "Array", float]:
    """Return a run with s_D and the bound on its integral."""
    if not adaptive(problem):
        return _adaptive(problem)
    return _sliding(problem)


def _adaptive(problem: Problem) -> tuple[ProofRun, "Array", float]:
    """Bound V(0)/eta of the repaired law."""
    found = repaired_run(problem)
    gain_times_speed = float(found.signals.gain[0] * found.signals.speed[0])
    decrease = reserve(problem) / gain_times_speed  # psi exceeds the approximation error by it
    return found.run, found.signals.dead_zone, float(found.values[0]) / decrease


def _sliding(problem: Problem) -> tuple[ProofRun, "Array", float]:
    """Bound v0 s_D(0)^2/(2 eta): abs(s_D) falls with eta in sigma, and dt <= v0 d sigma."""
    law = sliding_law(problem)
    run = sliding_run(problem.vehicle, problem.rail, law, speeds=problem.speeds, slip=problem.slips[0])
    error = sliding_surface.slip_error(law.gains.slip_reference, run.slip)
    surface = sliding_surface.sliding_variable(error, run.integral, 1.0, law.gains.surface_rate)
    layer = law.gains.boundary_layer
    dead_zone: Array = surface - layer * saturation(surface / layer)
    return run, dead_zone, problem.speeds[1] * float(dead_zone[0]) ** 2 / (2.0 * reserve(problem))


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - the run tells why it was cut
    """Show no curve: the integral of abs(s_D) lies far below its bound, and the verdict names both."""
    return Figures() if in_sigma(problem) else Figures(remark=_run(problem)[0].cut)


CHECK = Check(theorem=BARBALAT, search=search, figures=figures)
