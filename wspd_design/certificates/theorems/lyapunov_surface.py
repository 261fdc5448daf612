"""Theorem about V = s^2/2 of (24) along the loop of the sliding-mode law: it does not rise outside its layer."""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from wspd_design.certificates.kernel.arb import below, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.kernel.obligation import Sampled, Special
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.setting.domain import BASIC, PARAMETERS
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.certificates.setting.plant import place as readable
from wspd_design.certificates.theorems.evidence import supported
from wspd_design.certificates.theorems.ideal_loop import (
    ASSUMPTIONS,
    EVALUATION_WORK,
    Flow,
    State,
    exact_law,
    exact_rate,
    sliding_flow,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem
from wspd_design.certificates.theorems.whom import sliding_law, sliding_mode
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number
from wspd_design.parameters.units import KMH

TOLERANCE = 1e-6  # of the largest V; what counts as rounding
SAMPLED = ("rise", "since", "until", *PARAMETERS, "runs", "cut short")
INTEGRAL = "integral of the slip error"


def surface_value(law: SlidingMode, states: State) -> Number:
    """Return sbar of states in whatever numbers."""
    _, slip, integral = states
    error = sliding_surface.slip_error(law.gains.slip_reference, slip)
    return sliding_surface.sliding_variable(error, integral, 1.0, law.gains.surface_rate)


def surface_energy(law: SlidingMode, states: State) -> Number:
    """Return V = sbar^2/2 of states in whatever numbers."""
    return sliding_surface.lyapunov_surface(surface_value(law, states))


def outside_layer(law: SlidingMode, state: State) -> bool:
    """Whether a state of balls lies outside the layer for certain."""
    return bool(abs(surface_value(law, state)) > law.gains.boundary_layer)


def exact_loop(problem: Problem, parameters: Mapping[str, float]) -> tuple[Callable[[State], Any], Flow]:
    """Return V and the flow of the loop in balls, for a plant with these parameters."""
    law = sliding_law(problem)
    flow = sliding_flow(*exact_plant(problem, parameters), exact_law(law))
    return partial(surface_energy, law), flow


def _rises(problem: Problem, at: Place, work: Work) -> Mapping[str, float]:
    work.spend(EVALUATION_WORK)
    state = [at["speed"], at["slip"], at[INTEGRAL]]
    energy, flow = exact_loop(problem, {name: at[name] for name in PARAMETERS})
    rate = exact_rate(energy, flow, state)
    if not (rate > 0 and outside_layer(sliding_law(problem), tuple(map(point, state)))):
        raise Refused("the place denies nothing: V does not rise there for certain, or it lies in the layer")
    return {"least dV/dt": below(rate)}


def _falls(numbers: Mapping[str, float]) -> bool:
    return numbers["rise"] <= TOLERANCE and numbers["cut short"] == 0.0


def _obligations(problem: Problem) -> tuple[Special | Sampled, ...]:
    low, high = domain.box(problem)
    within = {name: (float(low[k]), float(high[k])) for k, name in enumerate(BASIC)}
    text = "V does not rise outside the layer"
    return (
        Special(
            key="rise",
            text=text,
            evaluate=partial(_rises, problem),
            within={**within, INTEGRAL: (-math.inf, math.inf)},
        ),
        Sampled(key="runs", text=f"{text} in runs of the loop", names=SAMPLED, holds=_falls),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    law = sliding_law(problem)
    rise, runs = findings["rise"], findings["runs"]
    status = supported(rise, runs)
    numbers, at = runs.numbers, rise.place
    witness: tuple[Point, ...] = ()
    if status is Status.REFUTED:
        witness = (
            *readable(at),
            Point(name=INTEGRAL, value=at[INTEGRAL], unit="s"),
            Point(name="least dV/dt", value=rise.numbers["least dV/dt"], unit="1/s"),
        )
        told = (
            "The switching gain does not outweigh the model error everywhere. With "
            f"{at['speed'] * KMH:.3g} km/h and slip {at['slip']:.4f}, dV/dt is at least "
            f"{rise.numbers['least dV/dt']:.3g} 1/s in exact arithmetic."
        )
    elif not numbers:
        told = "No run is stated."
    elif numbers["rise"] > TOLERANCE:
        told = (
            f"V rises by {numbers['rise']:.3g} of its maximum between {numbers['since']:.3g} s and "
            f"{numbers['until']:.3g} s of a run. But at no state of the run that was tried is its derivative positive "
            "for certain."
        )
    else:
        told = (
            f"In all {numbers['runs']:.0f} runs the distance to the surface only shrinks until the layer is reached, "
            "and the state stays inside."
        )
    if status is not Status.REFUTED and numbers and numbers["cut short"]:
        told += f" {numbers['cut short']:.0f} of the runs were cut short."
    where = domain.domain_of(problem)
    return Certificate(
        claim="V = sbar^2/2, sbar = s/K_P, does not rise at any state outside the layer, abs(sbar) > "
        f"{law.gains.boundary_layer:g}, whatever the integral of the error, on {where.text}, the "
        "other numbers of vehicle and rail nominal.",
        status=status,
        explanation=told,
        margin=Range(low=None, high=TOLERANCE - numbers["rise"], unit="of max V")
        if numbers and status is not Status.REFUTED
        else None,
        worst_point=witness,
        witness=witness,
        assumptions=(
            ASSUMPTIONS[0],
            "quarter model with static wheel load; its other numbers are nominal",
            ASSUMPTIONS[2],
        ),
        domain=where,
        varied=PARAMETERS,
        held=domain.not_varied(problem, PARAMETERS),
        method="runs with the Rosenbrock method RODAS, with nominal parameters and all corners of those that are "
        f"named, each from both ends of the range of slip; a rise below {TOLERANCE:g} of the maximum counts as "
        "rounding; at a witness forward derivatives in balls",
        reference="eqs. (24), (25); docs/theory.md#reaching",
    )


LYAPUNOV_SURFACE = Theorem(
    name="lyapunov_surface",
    title="V of the sliding mode",
    claim="V = s^2/2 does not rise outside the boundary layer.",
    speaks_about=sliding_mode,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - OF_VALVES,
)
