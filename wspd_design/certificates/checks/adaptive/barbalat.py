"""Barbalat's lemma (45)-(48) speaks about t to infinity, but a stop ends: what can be said instead."""

from typing import TYPE_CHECKING

from wspd_design.certificates.checks.adaptive.lyapunov_repaired import repaired_run
from wspd_design.certificates.checks.adaptive.sigma_time import convergence
from wspd_design.certificates.checks.frame import OutsideModel, certified, level, series
from wspd_design.certificates.checks.ideal_run import ASSUMPTIONS, ProofRun, sliding_run
from wspd_design.certificates.checks.sliding.reaching import reserve
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import saturation

if TYPE_CHECKING:
    from wspd_design.certificates.checks.ideal_run import Array

NAME, TITLE = "barbalat", "Convergence after Barbalat"
QUADRATURE_TOLERANCE = 1e-3  # of the bound: trapezoids between the solver's instants


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Run the idealized loop, see that it ends, and compare the integral of abs(s_D) with its bound."""
    import numpy as np

    law = problem.controller
    if not isinstance(law, (AdaptiveFuzzy, SlidingMode)):
        return laws.no_surface(problem, NAME, "s tends to 0 as t tends to infinity.")
    domain.box(problem)
    if isinstance(law, AdaptiveFuzzy) and law.gains.scheduled_rates:
        return convergence(problem, law)
    time, dead_zone, bound, name = (
        _adaptive(problem, law) if isinstance(law, AdaptiveFuzzy) else _sliding(problem, law)
    )
    steps = np.diff(time)
    sizes = np.abs(dead_zone)
    growing = np.concatenate([[0.0], np.cumsum(0.5 * (sizes[1:] + sizes[:-1]) * steps)])
    integral = float(growing[-1])
    lipschitz = float(np.max(np.abs(np.diff(dead_zone)) / steps))
    within = integral <= bound * (1.0 + QUADRATURE_TOLERANCE)
    return Certificate(
        name=NAME,
        title=TITLE,
        claim="s tends to 0 as t tends to infinity, because the integral of abs(s_D) is finite and s_D is "
        "uniformly continuous.",
        status=Status.VACUOUS,
        explanation=f"The train has slowed down to {problem.speeds[0] * KMH:.3g} km/h after "
        f"{time[-1]:.3g} s: there is no t to infinity in a stop, and a limit says nothing about the error "
        f"at its end. {_in_sigma(law)} In its place stands the integral of abs(s_D), here {integral:.3g} s "
        f"against a bound of {bound:.3g} s.",
        margin=Range(low=None, high=bound - integral, unit="s"),
        worst_point=(
            Point(name="end of the run", value=float(time[-1]), unit="s"),
            Point(name="integral of abs(s_D)", value=integral, unit="s"),
            Point(name="bound of the integral", value=bound, unit="s"),
            Point(name="Lipschitz constant of s_D", value=lipschitz, unit="1/s"),
        ),
        hypotheses=(
            Hypothesis(text="the run goes on for ever", status=Status.REFUTED),
            _endless(law),
            Hypothesis(
                text=f"the integral of abs(s_D) is at most {name}",
                # Trapezoids between floats cannot refute a bound.
                status=Status.EVIDENCE if within else Status.UNDECIDED,
            ),
            Hypothesis(
                text=f"s_D is Lipschitz continuous, with a constant of at least {lipschitz:.3g} 1/s",
                status=Status.EVIDENCE,
            ),
        ),
        assumptions=ASSUMPTIONS,
        method="integration with Radau's method, trapezoids between its instants",
        resolution=f"{len(time)} instants; the Lipschitz constant is the steepest difference of two "
        "neighbors",
        reference="eqs. (45)-(48); docs/theory.md#barbalat",
        series=(
            series("integral of abs(s_D)", "time [s]", "integral [s]", time, growing),
            level(name, "time [s]", "integral [s]", time, bound),
        ),
    )


def _endless(law: AdaptiveFuzzy | SlidingMode) -> Hypothesis:
    """Whether the lemma can be saved in sigma = integral of dt/v, which has no end although the stop has one.

    There v s_D^2/(2 g) becomes s_D^2/(2 g) and every rate is multiplied by v, so that constant adaptation rates
    alpha would have to be alpha/v.
    """
    if isinstance(law, SlidingMode):
        text = (
            "in sigma = integral of dt/v, which has no end: nothing adapts, and reaching shows a finite sigma"
        )
        return Hypothesis(text=text, status=Status.NOT_APPLICABLE)
    text = "in sigma = integral of dt/v, which has no end, the adaptation rates are alpha/v"
    return Hypothesis(text=text, status=Status.REFUTED)


def _in_sigma(law: AdaptiveFuzzy | SlidingMode) -> str:
    if isinstance(law, SlidingMode):
        return "In sigma = integral of dt/v no lemma is needed: the surface is reached at a finite sigma."
    return "In sigma = integral of dt/v the lemma asks for adaptation rates alpha/v; those of this law are constant."


def _adaptive(problem: Problem, law: AdaptiveFuzzy) -> tuple["Array", "Array", float, str]:
    """Time, s_D and the bound V(0)/eta of its integral for the repaired law."""
    found = repaired_run(problem, law)
    _complete(found.run)
    gain_times_speed = float(found.signals.gain[0] * found.signals.speed[0])
    decrease = reserve(problem) / gain_times_speed  # psi exceeds the approximation error by it
    return found.run.time, found.signals.dead_zone, float(found.values[0]) / decrease, "V(0) g/eta"


def _sliding(problem: Problem, law: SlidingMode) -> tuple["Array", "Array", float, str]:
    """Time, s_D and the bound of its integral: abs(s_D) falls with eta in sigma, and dt <= v0 d sigma."""
    run = sliding_run(problem.vehicle, problem.rail, law, speeds=problem.speeds, slip=problem.slips[0])
    _complete(run)
    error = sliding_surface.slip_error(law.gains.slip_reference, run.slip)
    surface = sliding_surface.sliding_variable(error, run.integral, 1.0, law.gains.surface_rate)
    layer = law.gains.boundary_layer
    dead_zone = surface - layer * saturation(surface / layer)
    bound = problem.speeds[1] * float(dead_zone[0]) ** 2 / (2.0 * reserve(problem))
    return run.time, dead_zone, bound, "v0 s_D(0)^2/(2 eta)"


def _complete(run: ProofRun) -> None:
    """Refuse a run that ends before the stop does: nothing can be said about its end."""
    if run.cut:
        raise OutsideModel(run.cut)
