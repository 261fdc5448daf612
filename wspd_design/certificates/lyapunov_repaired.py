"""The repaired V of the adaptive fuzzy law, divided by G and with a dead zone: it must not rise."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from wspd_design.certificates import domain, laws
from wspd_design.certificates.adaptive_error import CHOICE, Signals, ideal, signals
from wspd_design.certificates.checking import certified, series
from wspd_design.certificates.domain import KMH
from wspd_design.certificates.proof_run import (
    ASSUMPTIONS,
    RELATIVE_TOLERANCE,
    ProofRun,
    adaptive_run,
    cut_short,
    largest_rise,
    numeric_rate,
    verdict,
)
from wspd_design.certificates.reaching import reserve
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Range, Status
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.model.generated import adaptive_fuzzy as generated

if TYPE_CHECKING:
    from wspd_design.certificates.proof_run import Array

NAME, TITLE = "lyapunov_repaired", "Repaired V"
TOLERANCE = 100.0 * RELATIVE_TOLERANCE  # of the largest V
RATE_TOLERANCE = 1e-4  # of the largest rate


@dataclass(frozen=True, slots=True, kw_only=True)
class RepairedRun:
    """The idealized loop of the repaired law with its V and what V is made of."""

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
    # The law adapts with K_P s_D, so that its rates count K_P times for s_D; u is in multiples of its unit.
    scale = gains.torque_unit * gains.proportional_gain
    rates = (scale * gains.weight_rate, scale * gains.bound_rate)

    def candidate(states: "Array") -> "Array":
        at = signals(*plant, states, target)
        value: Array = generated.lyapunov_repaired(
            at.dead_zone, at.speed, at.gain * at.speed, at.weight_error_squared, at.bound_error, *rates
        )
        return value

    at = signals(*plant, run.states, target)
    rate = generated.lyapunov_repaired_rate(
        at.dead_zone, at.deceleration, at.gain * at.speed, at.approximation_error, at.bound
    )
    return RepairedRun(
        run=run,
        signals=at,
        values=candidate(run.states),
        rate=rate,
        measured_rate=numeric_rate(candidate, run),
    )


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
    where = (
        Point(name="V before", value=float(values[start]), unit="N m s"),
        Point(name="time before", value=float(run.time[start]), unit="s"),
        Point(name="V after", value=float(values[end]), unit="N m s"),
        Point(name="time after", value=float(run.time[end]), unit="s"),
        Point(name="speed after", value=float(run.speed[end]) * KMH, unit="km/h"),
        Point(name="slip after", value=float(run.slip[end]), unit="-"),
    )
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
        status=verdict(rises, [run]),
        explanation=(
            f"V rises from {values[start]:.4g} to {values[end]:.4g} N m s between {run.time[start]:.3g} s "
            f"and {run.time[end]:.3g} s."
            if rises
            else f"V falls from {values[0]:.4g} to {values[-1]:.4g} N m s and never rises, so that "
            "weights and bound stay bounded. Divided by G, the falling speed helps V to fall instead of "
            "making it rise."
        )
        + cut_short([run]),
        margin=Range(low=None, high=TOLERANCE - rise / largest, unit="of max V"),
        worst_point=where,
        witness=where if rises else (),
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
        "differences along the flow",
        resolution=f"{len(run.time)} instants; a rise below {TOLERANCE:g} of the maximum counts as rounding",
        reference="eqs. (39)-(44) repaired; docs/theory.md#energy",
        series=(
            series("V repaired", "time [s]", "V [N m s]", run.time, values),
            series("slip", "time [s]", "slip [-]", run.time, run.slip),
        ),
    )


def _hypothesis(text: str, holds: bool) -> Hypothesis:
    return Hypothesis(text=text, status=Status.EVIDENCE if holds else Status.REFUTED)
