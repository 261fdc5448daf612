"""V2 of (43) as printed, along the loop of the adaptive fuzzy law in exactly the setting of its proof."""

from collections.abc import Callable
from typing import TypeAlias

from wspd_design.certificates.checks.adaptive.adaptive_error import CHOICE, Ideal, ideal, signals
from wspd_design.certificates.checks.certain_rise import certain_rise, certainty, exact_rate, rising_state
from wspd_design.certificates.checks.frame import certified, series
from wspd_design.certificates.checks.ideal_run import (
    ASSUMPTIONS,
    RELATIVE_TOLERANCE,
    State,
    adaptive_flow,
    adaptive_run,
    cut_short,
    largest_rise,
    numeric_rate,
    verdict,
)
from wspd_design.certificates.checks.sliding.reaching import reserve
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains
from wspd_design.model.generated import adaptive_fuzzy as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle

Function: TypeAlias = Callable[[State], Number]

NAME, TITLE = "lyapunov_printed", "V2 of the paper"
TOLERANCE = 100.0 * RELATIVE_TOLERANCE  # of the largest V2
RATE_TOLERANCE = 1e-4  # of the largest rate, for a formula against differences


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Run the printed law as its proof assumes, and follow V2 and its derivative."""
    import numpy as np

    law = problem.controller
    claim = "V2 of (43) does not rise along the closed loop, as (44) says."
    if not isinstance(law, AdaptiveFuzzy):
        return laws.not_applicable(
            problem, NAME, claim, "is not the adaptive fuzzy law, which V2 speaks about"
        )
    gains = law.gains
    if gains.dead_zone:
        reason = "adapts with a dead zone; its Lyapunov function is the one of lyapunov_repaired"
        return laws.not_applicable(problem, NAME, claim, reason)
    domain.box(problem)
    plant = (problem.vehicle, problem.rail, gains)
    run = adaptive_run(*plant, speeds=problem.speeds)
    target = ideal(*plant, run, reserve(problem))
    candidate, claimed_rate, true_rate = _functions(plant, target)
    values = candidate(run.states)
    rise, start, end = largest_rise(values)
    rises = not rise <= TOLERANCE * float(values.max())
    at = signals(*plant, run.states, target)
    # Inside the layer sat(s) replaces the sgn(s) of both formulas.
    outside = np.abs(at.surface) > gains.boundary_layer
    claimed, true = claimed_rate(run.states), true_rate(run.states)
    measured = numeric_rate(candidate, run)
    scale = float(np.abs(measured[outside]).max(initial=0.0))
    exact = (*exact_plant(problem), gains)
    functions = _functions(exact, target.exact())
    flow = adaptive_flow(*exact)
    deviations, verdicts = [], []
    for formula, exact_formula in ((claimed, functions[1]), (true, functions[2])):
        differences = np.where(outside, np.abs(measured - formula), 0.0)
        worst = run.states[:, int(np.argmax(differences))].tolist()
        difference = exact_rate(functions[0], flow, worst) - exact_formula(tuple(map(point, worst)))
        deviations.append(float(differences.max()))
        verdicts.append(_formula_verdict(deviations[-1], scale, certain=not difference.contains(0)))
    reason = "The derivative along the run is neither the claimed one nor the one with the terms of G'."
    if verdicts == [Status.REFUTED, Status.EVIDENCE]:
        reason = "The derivative along the run is not (44), which leaves out G'/2 times the squared errors "
        reason += "of weights and bound; G' > 0 while braking. The proof fails, whatever the slip does."
    # Where (44) itself speaks first, which has sgn(s) in it, then inside the layer.
    order = np.lexsort((-measured, ~outside)).tolist() if rises else []

    def admits(state: State) -> bool:
        """Whether psi bounds the approximation error, as (34) asks for."""
        here = signals(*exact, state, target.exact())
        return bool(abs(here.approximation_error) <= here.bound)

    shown = certain_rise(functions[0], flow, run, order, speaks=admits)
    status = verdict(rises, shown is not None, [run])
    where: tuple[Point, ...] = (
        Point(name="V2 before", value=float(values[start]), unit="-"),
        Point(name="time before", value=float(run.time[start]), unit="s"),
        Point(name="V2 after", value=float(values[end]), unit="-"),
        Point(name="time after", value=float(run.time[end]), unit="s"),
    )
    if shown is not None:
        where = (*rising_state(run, shown, "dV2/dt", "1/s"), *where)
    axes = ("time [s]", "V2 [-]")
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"V2 of (43) does not rise along the closed loop, as (44) says, from "
        f"{problem.speeds[1] * KMH:.3g} to {problem.speeds[0] * KMH:.3g} km/h on {problem.rail.name}.",
        status=status,
        explanation=(
            f"V2 starts at {values[0]:.3g}, is {values[start]:.3g} at {run.time[start]:.3g} s and then "
            f"rises to {values[end]:.3g} at {run.time[end]:.3g} s. The slip ends at {run.slip[-1]:.4f}, its "
            f"reference is {gains.slip_reference:g}. {certainty(run, shown, 'dV2/dt', '1/s')} {reason}"
            if rises
            else f"V2 falls from {values[0]:.3g} to {values[-1]:.3g} without rising in this run."
        )
        + cut_short([run]),
        margin=Range(low=None, high=TOLERANCE - rise / float(values.max()), unit="of max V2"),
        worst_point=where,
        witness=where if shown is not None else (),
        hypotheses=(
            Hypothesis(
                text=f"dV2/dt is what (44) says: it differs from the differences of V2 by up to "
                f"{deviations[0]:.3g} 1/s of {scale:.3g} 1/s",
                status=verdicts[0],
            ),
            Hypothesis(
                text=f"dV2/dt is (44) plus the terms of G': it differs from the differences of V2 by up to "
                f"{deviations[1]:.3g} 1/s of {scale:.3g} 1/s",
                status=verdicts[1],
            ),
        ),
        assumptions=(*ASSUMPTIONS, "continuous adaptation", CHOICE),
        method=f"integration with Radau's method, relative tolerance {RELATIVE_TOLERANCE:g}; derivatives by "
        "differences along the flow, outside the layer; at the witness by forward derivatives in balls",
        resolution=f"{len(run.time)} instants; a rise below {TOLERANCE:g} of the maximum counts as rounding",
        reference="eqs. (39)-(44); docs/theory.md#printed",
        series=(
            series("V2 as printed", *axes, run.time, values),
            series("measured", "time [s]", "dV2/dt [1/s]", run.time, measured),
            series("claimed by (44)", "time [s]", "dV2/dt [1/s]", run.time, claimed),
            series("with the terms of G'", "time [s]", "dV2/dt [1/s]", run.time, true),
            series("slip", "time [s]", "slip [-]", run.time, run.slip),
        ),
    )


def _functions(
    plant: tuple[Vehicle, Rail, AdaptiveFuzzyGains], target: Ideal
) -> tuple[Function, Function, Function]:
    """V2, its derivative as (44) claims it, and with the terms of G', of states in whatever numbers."""
    gains = plant[2]
    # In the numbers of the target, so that products of two gains are exact in balls.
    unit = gains.torque_unit + 0 * target.bound
    rates = (unit * gains.weight_rate, unit * gains.bound_rate)

    def candidate(states: State) -> Number:
        at = signals(*plant, states, target)
        return generated.lyapunov_printed(
            at.surface, at.gain, at.weight_error_squared, at.bound_error, gains.proportional_gain, *rates
        )

    def claimed(states: State) -> Number:
        at = signals(*plant, states, target)
        return generated.lyapunov_printed_rate_claimed(at.surface, at.gain, at.approximation_error, at.bound)

    def true(states: State) -> Number:
        at = signals(*plant, states, target)
        errors = at.approximation_error, at.bound, at.weight_error_squared, at.bound_error
        return generated.lyapunov_printed_rate_true(at.surface, at.gain, at.gain_rate, *errors, *rates)

    return candidate, claimed, true


def _formula_verdict(deviation: float, scale: float, *, certain: bool) -> Status:
    """Verdict on a formula for the derivative; ``certain`` says that it is wrong at a state in balls."""
    if scale == 0.0:  # the run never leaves the layer
        return Status.UNDECIDED
    if deviation <= RATE_TOLERANCE * scale:
        return Status.EVIDENCE
    return Status.REFUTED if certain else Status.UNDECIDED
