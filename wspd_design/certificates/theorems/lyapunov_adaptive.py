"""Theorems about the two Lyapunov functions of the adaptive law: V2 of (43) as printed, and the repaired V.

Ideal weights b* and psi are part of a place: any that satisfy (34) at a state may be named.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple, TypeAlias

from wspd_design.certificates.kernel.arb import below, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Finding, Place
from wspd_design.certificates.kernel.obligation import Ends, Sampled, Special
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.certificates.theorems.adaptive_error import CHOICE, Ideal, signals
from wspd_design.certificates.theorems.evidence import supported
from wspd_design.certificates.theorems.ideal_loop import (
    ASSUMPTIONS,
    EVALUATION_WORK,
    State,
    adaptive_flow,
    exact_rate,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis
from wspd_design.certificates.theorems.whom import adaptive, adaptive_law
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.model.generated import adaptive_fuzzy as generated
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH

Function: TypeAlias = Callable[[State], Number]
Loop: TypeAlias = tuple[Vehicle, Rail, AdaptiveFuzzyGains]

TOLERANCE = 1e-6  # of the largest V; what counts as rounding
RATE_TOLERANCE = 1e-4  # of the largest rate, for a formula against differences
RUN = ("rise", "first", "last", "before", "after", "since", "until", "slip", "instants", "cut short")
FORMULA = ("deviation", "scale")
INTEGRAL = "integral of the slip error"
SLIPS = (0.0, 1.0)


class Candidate(NamedTuple):
    """A function of the states that must not rise, and formulas for its derivative."""

    value: Function
    claimed: Function  # derivative as the paper claims it, or as the repair does
    corrected: Function


def printed(loop: Loop, target: Ideal) -> Candidate:
    """Return V2 of (43), its derivative as (44) claims it, and with the terms of G', of states in whatever numbers."""
    gains = loop[2]
    # In the numbers of the target, so that products of two gains are exact in balls.
    unit = gains.torque_unit + 0 * target.bound
    rates = (unit * gains.weight_rate, unit * gains.bound_rate)

    def value(states: State) -> Number:
        at = signals(*loop, states, target)
        errors = at.weight_error_squared, at.bound_error
        return generated.lyapunov_printed(at.surface, at.gain, *errors, gains.proportional_gain, *rates)

    def claimed(states: State) -> Number:
        at = signals(*loop, states, target)
        return generated.lyapunov_printed_rate_claimed(at.surface, at.gain, at.approximation_error, at.bound)

    def corrected(states: State) -> Number:
        at = signals(*loop, states, target)
        errors = at.approximation_error, at.bound, at.weight_error_squared, at.bound_error
        return generated.lyapunov_printed_rate_true(at.surface, at.gain, at.gain_rate, *errors, *rates)

    return Candidate(value=value, claimed=claimed, corrected=corrected)


def repaired(loop: Loop, target: Ideal) -> Candidate:
    """Return the repaired V and its derivative, of states in whatever numbers."""
    gains = loop[2]
    # The law adapts with K_P s_D, so that its rates count K_P times for s_D; u is in multiples of its unit. In the
    # numbers of the target, so that products of gains are exact in balls.
    scale = (gains.torque_unit + 0 * target.bound) * gains.proportional_gain
    rates = (scale * gains.weight_rate, scale * gains.bound_rate)

    def value(states: State) -> Number:
        at = signals(*loop, states, target)
        errors = at.weight_error_squared, at.bound_error
        return generated.lyapunov_repaired(at.dead_zone, at.speed, at.gain * at.speed, *errors, *rates)

    def rate(states: State) -> Number:
        at = signals(*loop, states, target)
        return generated.lyapunov_repaired_rate(
            at.dead_zone, at.deceleration, at.gain * at.speed, at.approximation_error, at.bound
        )

    return Candidate(value=value, claimed=rate, corrected=rate)


def repaired_gains(gains: AdaptiveFuzzyGains) -> AdaptiveFuzzyGains:
    """Return gains with the repaired adaptation: dead zone and constant rates."""
    return replace(gains, dead_zone=True, scheduled_rates=False)


def state_place(problem: Problem, state: list[float], target: Ideal) -> Place:
    """Name the numbers of a state and of the ideal weights and bound."""
    names = list(_within(problem))
    return dict(zip(names, [*state, *target.weights, target.bound], strict=True))


def _within(problem: Problem) -> dict[str, Ends]:
    rules = range(1, len(adaptive_law(problem).gains.initial_weights) + 1)
    free = [INTEGRAL, *(f"weight {k}" for k in rules), "bound"]
    free += [*(f"ideal weight {k}" for k in rules), "ideal bound"]
    return {"speed": problem.speeds, "slip": SLIPS} | dict.fromkeys(free, (-math.inf, math.inf))


def _split(problem: Problem, at: Place) -> tuple[list[float], Ideal]:
    values = [at[name] for name in _within(problem)]
    rules = len(adaptive_law(problem).gains.initial_weights)
    state, weights, bound = values[: rules + 4], values[rules + 4 : -1], values[-1]
    return state, Ideal(weights=tuple(weights), bound=bound)


def admits(loop: Loop, target: Ideal, state: State) -> bool:
    """Whether psi bounds the approximation error at a state of balls, as (34) asks for, and the train slows down."""
    here = signals(*loop, state, target)
    return bool(abs(here.approximation_error) <= here.bound) and bool(here.deceleration >= 0)


Make: TypeAlias = Callable[[Loop, Ideal], Candidate]


def _rises(
    problem: Problem, gains: AdaptiveFuzzyGains, make: Make, at: Place, work: Work
) -> Mapping[str, float]:
    work.spend(EVALUATION_WORK)
    loop = (*exact_plant(problem), gains)
    state, target = _split(problem, at)
    exact = target.exact()
    rate = exact_rate(make(loop, exact).value, adaptive_flow(*loop), state)
    if not (rate > 0 and admits(loop, exact, tuple(map(point, state)))):
        raise Refused(
            "the place denies nothing: V does not rise there for certain, or (34) does not hold there"
        )
    return {"least rate": below(rate)}


def _differs(problem: Problem, make: Make, formula: str, at: Place, work: Work) -> Mapping[str, float]:
    work.spend(EVALUATION_WORK)
    gains = adaptive_law(problem).gains
    loop = (*exact_plant(problem), gains)
    state, target = _split(problem, at)
    candidate, balls = make(loop, target.exact()), tuple(map(point, state))
    difference = exact_rate(candidate.value, adaptive_flow(*loop), state) - getattr(candidate, formula)(balls)
    outside = abs(signals(*loop, balls, target.exact()).surface) > gains.boundary_layer
    if difference.contains(0) or not outside:
        raise Refused("the place denies nothing: the formula may be right there, or it lies in the layer")
    return {"difference": below(abs(difference))}


def _falls(numbers: Mapping[str, float]) -> bool:
    return numbers["rise"] <= TOLERANCE and numbers["cut short"] == 0.0


def _agrees(numbers: Mapping[str, float]) -> bool:
    return numbers["scale"] > 0.0 and numbers["deviation"] <= RATE_TOLERANCE * numbers["scale"]


def _printed_obligations(problem: Problem) -> tuple[Special | Sampled, ...]:
    domain.box(problem)
    within, gains = _within(problem), adaptive_law(problem).gains
    claimed, corrected = "dV2/dt is what (44) says", "dV2/dt is (44) plus the terms of G'"
    return (
        Special(
            key="rise",
            text="V2 does not rise",
            evaluate=partial(_rises, problem, gains, printed),
            within=within,
        ),
        Sampled(key="run", text="V2 does not rise in a run", names=RUN, holds=_falls),
        Special(
            key="claimed",
            text=claimed,
            evaluate=partial(_differs, problem, printed, "claimed"),
            within=within,
        ),
        Sampled(key="claimed in the run", text=claimed, names=FORMULA, holds=_agrees),
        Special(
            key="corrected",
            text=corrected,
            evaluate=partial(_differs, problem, printed, "corrected"),
            within=within,
        ),
        Sampled(key="corrected in the run", text=corrected, names=FORMULA, holds=_agrees),
    )


def _tell_printed(problem: Problem, findings: Findings) -> Certificate:
    rise, run = findings["rise"], findings["run"]
    status = supported(rise, run)
    formulas = [
        each if each.status is Status.REFUTED else findings[f"{each_key} in the run"]
        for each_key, each in ((key, findings[key]) for key in ("claimed", "corrected"))
    ]
    reason = ""
    if [each.status for each in formulas] == [Status.REFUTED, Status.EVIDENCE]:
        reason = " The derivative is not (44), which leaves out G'/2 times the squared errors of weights and bound; "
        reason += "G' > 0 while braking. The proof fails, whatever the slip does."
    return Certificate(
        claim="V2 of (43) does not rise along the closed loop, as (44) says, at any state with "
        f"{problem.speeds[0] * KMH:.3g} to {problem.speeds[1] * KMH:.3g} km/h and slip {SLIPS[0]:g} to {SLIPS[1]:g} on "
        f"{problem.rail.name} with the nominal parameters, for any ideal weights and bound that satisfy (34) there.",
        status=status,
        explanation=_told("V2", "1/s", rise, run) + reason,
        margin=_margin("V2", status, run),
        worst_point=_witness(rise, "dV2/dt", "1/s"),
        witness=_witness(rise, "dV2/dt", "1/s"),
        hypotheses=tuple(hypothesis(each.asked, each) for each in formulas),
        assumptions=(*ASSUMPTIONS, "continuous adaptation", CHOICE),
        held=domain.not_varied(problem, ()),
        method="a run with the Rosenbrock method RODAS; derivatives by differences along the flow, outside the layer; "
        f"a rise below {TOLERANCE:g} of the maximum counts as rounding; at a witness forward derivatives in balls",
        reference="eqs. (39)-(44); docs/theory.md#printed",
    )


def _repaired_obligations(problem: Problem) -> tuple[Special | Sampled, ...]:
    domain.box(problem)
    gains = repaired_gains(adaptive_law(problem).gains)
    return (
        Special(
            key="rise",
            text="V does not rise",
            evaluate=partial(_rises, problem, gains, repaired),
            within=_within(problem),
        ),
        Sampled(key="run", text="V does not rise in a run", names=RUN, holds=_falls),
        Sampled(
            key="braking",
            text="the train decelerates all the time",
            names=("least deceleration",),
            holds=lambda numbers: numbers["least deceleration"] >= 0.0,
        ),
        Sampled(
            key="bounded",
            text="psi >= abs(u* - b*'w) all the time",
            names=("excess",),
            holds=lambda numbers: numbers["excess"] <= 0.0,
        ),
        Sampled(
            key="formula",
            text="dV/dt is s_D xi - psi abs(s_D) - a s_D^2/(2 g)",
            names=FORMULA,
            holds=_agrees,
        ),
    )


def _tell_repaired(problem: Problem, findings: Findings) -> Certificate:
    rise, run, gains = findings["rise"], findings["run"], adaptive_law(problem).gains
    status = supported(rise, run)
    same = (
        "the adaptation of the law itself"
        if gains.dead_zone and not gains.scheduled_rates
        else "the gains of the law as they are, with the repaired adaptation (dead zone, constant rates) in place of "
        "its own"
    )
    told = _told("V", "N m", rise, run)
    if status is Status.EVIDENCE:
        told += " Weights and bound stay bounded. Divided by G, the falling speed helps V to fall instead of making it "
        told += "rise."
    return Certificate(
        claim="V = v s_D^2/(2 g) + |b~|^2/(2 alpha1) + psi~^2/(2 alpha2) does not rise along the closed loop of the "
        f"repaired law, at any state with {problem.speeds[0] * KMH:.3g} to {problem.speeds[1] * KMH:.3g} km/h and slip "
        f"{SLIPS[0]:g} to {SLIPS[1]:g} on {problem.rail.name} with the nominal parameters, for any ideal weights and "
        "bound that satisfy (34) there.",
        status=status,
        explanation=told,
        margin=_margin("V", status, run),
        worst_point=_witness(rise, "dV/dt", "N m"),
        witness=_witness(rise, "dV/dt", "N m"),
        hypotheses=tuple(
            hypothesis(findings[key].asked, findings[key]) for key in ("braking", "bounded", "formula")
        ),
        assumptions=(*ASSUMPTIONS, "continuous adaptation", same, CHOICE),
        held=domain.not_varied(problem, ()),
        method="a run with the Rosenbrock method RODAS; derivatives by differences along the flow; a rise below "
        f"{TOLERANCE:g} of the maximum counts as rounding; at a witness forward derivatives in balls",
        reference="eqs. (39)-(44) repaired; docs/theory.md#energy",
    )


def _told(name: str, unit: str, rise: Finding, run: Finding) -> str:
    numbers = run.numbers
    if rise.status is Status.REFUTED:
        at = rise.place
        return (
            f"With {at['speed'] * KMH:.3g} km/h and slip {at['slip']:.4f}, d{name}/dt is at least "
            f"{rise.numbers['least rate']:.3g} {unit} in exact arithmetic."
        )
    if not numbers:
        return "No run is stated."
    cut = " The run was cut short." if numbers["cut short"] else ""
    if numbers["rise"] > TOLERANCE:
        return (
            f"{name} rises from {numbers['before']:.4g} to {numbers['after']:.4g} between {numbers['since']:.3g} s and "
            f"{numbers['until']:.3g} s of a run. But at no state of the run that was tried is its derivative positive "
            f"for certain.{cut}"
        )
    return (
        f"{name} falls from {numbers['first']:.4g} to {numbers['last']:.4g} without rising in this run, whose slip "
        f"ends at {numbers['slip']:.4f}.{cut}"
    )


def _margin(name: str, status: Status, run: Finding) -> Range | None:
    if status is Status.REFUTED or not run.numbers:
        return None
    return Range(low=None, high=TOLERANCE - run.numbers["rise"], unit=f"of max {name}")


def _witness(rise: Finding, name: str, unit: str) -> tuple[Point, ...]:
    if rise.status is not Status.REFUTED:
        return ()
    shown = {"speed": (KMH, "km/h"), "slip": (1.0, "-"), INTEGRAL: (1.0, "s")}
    points = [
        Point(name=each, value=value * shown.get(each, (1.0, ""))[0], unit=shown.get(each, (1.0, "of u"))[1])
        for each, value in rise.place.items()
    ]
    return (*points, Point(name=f"least {name}", value=rise.numbers["least rate"], unit=unit))


def _without_dead_zone(problem: Problem) -> str:
    reason = adaptive(problem)
    if not reason and adaptive_law(problem).gains.dead_zone:
        return "adapts with a dead zone; its Lyapunov function is the one of lyapunov_repaired"
    return reason


LYAPUNOV_PRINTED = Theorem(
    name="lyapunov_printed",
    title="V2 of the paper",
    claim="V2 of (43) does not rise along the closed loop, as (44) says.",
    speaks_about=_without_dead_zone,
    obligations=_printed_obligations,
    tell=_tell_printed,
    assumes=ALL - OF_VALVES,
)

LYAPUNOV_REPAIRED = Theorem(
    name="lyapunov_repaired",
    title="Repaired V",
    claim="V = v s_D^2/(2 g) + |b~|^2/(2 alpha1) + psi~^2/(2 alpha2) does not rise along the closed loop.",
    speaks_about=adaptive,
    obligations=_repaired_obligations,
    tell=_tell_repaired,
    assumes=ALL - OF_VALVES,
)
