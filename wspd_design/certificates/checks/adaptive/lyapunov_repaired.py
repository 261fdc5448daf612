"""The repaired V of the adaptive fuzzy law, divided by G and with a dead zone: it must not rise."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.adaptive.adaptive_error import CHOICE, Ideal, Signals, ideal, signals
from wspd_design.certificates.checks.certain_rise import Rise, certain_rise, certainty, rising_state
from wspd_design.certificates.checks.frame import certified, series
from wspd_design.certificates.checks.ideal_run import (
    ASSUMPTIONS,
    RELATIVE_TOLERANCE,
    ProofRun,
    State,
    adaptive_flow,
    adaptive_run,
    cut_short,
    largest_rise,
    numeric_rate,
    verdict,
)
from wspd_design.certificates.checks.sliding.reaching import reserve
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains
from wspd_design.model.generated import adaptive_fuzzy as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    from wspd_design.certificates.checks.ideal_run import Array

NAME, TITLE = "lyapunov_repaired", "Repaired V"
TOLERANCE = 100.0 * RELATIVE_TOLERANCE  # of the largest V
RATE_TOLERANCE = 1e-4  # of the largest rate


@dataclass(frozen=True, slots=True, kw_only=True)
class RepairedRun:
    """The idealized loop of the repaired law with its V and what V is made of."""

    gains: AdaptiveFuzzyGains  # of the repaired law
    target: Ideal
    run: ProofRun
    signals: Signals
    values: "Array"  # N m s, V
    rate: "Array"  # N m, dV/dt by its formula
    measured_rate: "Array"  # N m, dV/dt by differences


def repaired_run(problem: Problem, law: AdaptiveFuzzy) -> RepairedRun:
    """Run the law with dead zone and constant rates, whatever its own setting, in the setting of the proof."""
    gains = replace(law.gains, dead_zone=True, scheduled_rates=False)
    plant = (problem.vehicle, problem.rail, gains)
    run = adaptive_run(*plant, speeds=problem.speeds)
    target = ideal(*plant, run, reserve(problem))
    candidate = _function(plant, target)
    at = signals(*plant, run.states, target)
    rate = generated.lyapunov_repaired_rate(
        at.dead_zone, at.deceleration, at.gain * at.speed, at.approximation_error, at.bound
    )
    return RepairedRun(
        gains=gains,
        target=target,
        run=run,
        signals=at,
        values=candidate(run.states),
        rate=rate,
        measured_rate=numeric_rate(candidate, run),
    )


def _function(plant: tuple[Vehicle, Rail, AdaptiveFuzzyGains], target: Ideal) -> Callable[[State], Number]:
    """Return V of states in whatever numbers."""
    gains = plant[2]
    # The law adapts with K_P s_D, so that its rates count K_P times for s_D; u is in multiples of its unit. In the
    # numbers of the target, so that products of gains are exact in balls.
    scale = (gains.torque_unit + 0 * target.bound) * gains.proportional_gain
    rates = (scale * gains.weight_rate, scale * gains.bound_rate)

    def candidate(states: State) -> Number:
        at = signals(*plant, states, target)
        return generated.lyapunov_repaired(
            at.dead_zone, at.speed, at.gain * at.speed, at.weight_error_squared, at.bound_error, *rates
        )

    return candidate


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Run the repaired law as its proof assumes, and follow V."""
    import numpy as np

    law = problem.controller
    claim = "V = v s_D^2/(2 g) + |b~|^2/(2 alpha1) + psi~^2/(2 alpha2) does not rise along the closed loop"
    if not isinstance(law, AdaptiveFuzzy):
        return laws.not_applicable(
            problem, NAME, f"{claim}.", "is not the adaptive fuzzy law, which V speaks about"
        )
    domain.box(problem)
    found = repaired_run(problem, law)
    run, values = found.run, found.values
    largest = float(values.max())
    rise, start, end = largest_rise(values)
    rises = not rise <= TOLERANCE * largest
    braking = bool(np.all(found.signals.deceleration >= 0.0))
    bounded = bool(np.all(np.abs(found.signals.approximation_error) <= found.signals.bound))
    scale = float(np.abs(found.measured_rate).max())
    deviation = float(np.abs(found.measured_rate - found.rate).max())
    agrees = deviation <= RATE_TOLERANCE * scale
    shown = _certain_rise(problem, found) if rises else None
    where: tuple[Point, ...] = (
        Point(name="V before", value=float(values[start]), unit="N m s"),
        Point(name="time before", value=float(run.time[start]), unit="s"),
        Point(name="V after", value=float(values[end]), unit="N m s"),
        Point(name="time after", value=float(run.time[end]), unit="s"),
    )
    if shown is not None:
        where = (*rising_state(run, shown, "dV/dt", "N m"), *where)
    same = (
        "the adaptation of the law itself"
        if law.gains.dead_zone and not law.gains.scheduled_rates
        else "the gains of the law as they are, with the repaired adaptation (dead zone, constant rates) in place of "
        "its own"
    )
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"{claim} of the repaired law, from {problem.speeds[1] * KMH:.3g} to "
        f"{problem.speeds[0] * KMH:.3g} km/h on {problem.rail.name}.",
        status=verdict(rises, shown is not None, [run]),
        explanation=(
            f"V rises from {values[start]:.4g} to {values[end]:.4g} N m s between {run.time[start]:.3g} s "
            f"and {run.time[end]:.3g} s. {certainty(run, shown, 'dV/dt', 'N m')}"
            if rises
            else f"V falls from {values[0]:.4g} to {values[-1]:.4g} N m s and never rises, so that "
            "weights and bound stay bounded. Divided by G, the falling speed helps V to fall instead of "
            "making it rise."
        )
        + cut_short([run]),
        margin=Range(low=None, high=TOLERANCE - rise / largest, unit="of max V"),
        worst_point=where,
        witness=where if shown is not None else (),
        hypotheses=(
            _hypothesis("the train decelerates all the time", braking),
            _hypothesis("psi >= abs(u* - b*'w) all the time", bounded),
            _hypothesis(
                f"dV/dt is s_D xi - psi abs(s_D) - a s_D^2/(2 g): it differs from the differences of V by up "
                f"to {deviation:.3g} N m of {scale:.3g} N m",
                agrees,
            ),
        ),
        assumptions=(*ASSUMPTIONS, "continuous adaptation", same, CHOICE),
        method=f"integration with Radau's method, relative tolerance {RELATIVE_TOLERANCE:g}; derivatives by "
        "differences along the flow; at a witness by forward derivatives in balls",
        resolution=f"{len(run.time)} instants; a rise below {TOLERANCE:g} of the maximum counts as rounding",
        reference="eqs. (39)-(44) repaired; docs/theory.md#energy",
        series=(
            series("V repaired", "time [s]", "V [N m s]", run.time, values),
            series("slip", "time [s]", "slip [-]", run.time, run.slip),
        ),
    )


def _certain_rise(problem: Problem, found: RepairedRun) -> Rise | None:
    """Look for a state of the run at which V rises for certain."""
    import numpy as np

    exact = (*exact_plant(problem), found.gains)
    order = np.argsort(-found.measured_rate).tolist()
    return certain_rise(_function(exact, found.target.exact()), adaptive_flow(*exact), found.run, order)


def _hypothesis(text: str, holds: bool) -> Hypothesis:
    """What floats deny is open, since no state is evaluated exactly."""
    return Hypothesis(text=text, status=Status.EVIDENCE if holds else Status.UNDECIDED)
