"""Theorem about one simulated stop, for every law: the slip gets to its reference and does not go far beyond it."""

import math
from collections.abc import Mapping
from functools import partial

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.kernel.obligation import Inequality, Sampled, Special
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.theorems.authority import out_of_reach
from wspd_design.certificates.theorems.evidence import supported
from wspd_design.certificates.theorems.simulated_stop import (
    NOT_FINITE,
    STOP_WORK,
    plants,
    scenario_of,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis
from wspd_design.certificates.theorems.whom import every_law
from wspd_design.codegen.sampled import places_told
from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import acts_on_vehicle
from wspd_design.parameters.units import KMH
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.held_slip import REACHED, HeldSlip, held_slip_of
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.runs import Ending, Run
from wspd_design.simulation.stop import simulate

NUMBERS = ("reached", "wheelsets", "overshoot", "undershoot", "rms", "stopped")


def plant_of(problem: Problem) -> str:
    """Return the plant of the stop: one wheelset for a law of one, all of them for a law of the vehicle."""
    return plants(problem.vehicle)[0] if acts_on_vehicle(problem.controller) else Quarter.name


def judged_stop(problem: Problem) -> tuple[Run, HeldSlip]:
    """Simulate the stop, and judge its slip from where it first reaches the reference."""
    run = simulate(problem.vehicle, problem.controller, scenario_of(problem), plant=plant_of(problem))
    return run, held_slip_of(run, problem.slip)


def numbers_of(run: Run, held: HeldSlip) -> dict[str, float]:
    """Return what is stated about a stop."""
    found = {
        "reached": held.reached,
        "wheelsets": float(held.wheelsets),
        "overshoot": held.overshoot,
        "undershoot": held.undershoot,
        "rms": held.rms,
        "stopped": float(run.ending is Ending.STOPPED),
    }
    return {name: value if math.isfinite(value) else NOT_FINITE for name, value in found.items()}


def keeps(problem: Problem, numbers: Mapping[str, float]) -> bool:
    """Whether the slip gets there, stays below the tolerance, and the train stops."""
    return (
        bool(numbers["wheelsets"])
        and numbers["overshoot"] <= problem.slip_tolerance
        and numbers["stopped"] == 1.0
    )


def _denies(problem: Problem, _place: Place, work: Work) -> Mapping[str, float]:
    work.spend(STOP_WORK)
    numbers = numbers_of(*judged_stop(problem))
    if keeps(problem, numbers):
        raise Refused("the stop denies nothing: its slip gets to the reference and not far beyond it")
    return numbers


def _obligations(problem: Problem) -> tuple[Special | Sampled | Inequality, ...]:
    scenario_of(problem)
    start = problem.speeds[1]
    text = "in the simulated stop the slip gets to its reference and not far beyond it"
    return (
        Special(
            key="beyond", text=text, evaluate=partial(_denies, problem), within={"speed": (start, start)}
        ),
        Sampled(key="stop", text=text, names=NUMBERS, holds=partial(keeps, problem)),
        *out_of_reach(problem, axle=False),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    never = findings["out of reach, nominal"]
    status = (
        Status.VACUOUS if never.status is Status.PROVED else supported(findings["beyond"], findings["stop"])
    )
    numbers = findings["beyond" if findings["beyond"].numbers else "stop"].numbers
    names = (("overshoot", "overshoot"), ("undershoot", "undershoot"), ("rms", "rms about the reference"))
    there = bool(numbers) and bool(numbers["wheelsets"])
    where = (
        Point(name="speed at the start", value=problem.speeds[1] * KMH, unit="km/h"),
        *(Point(name=title, value=numbers[key], unit="-") for key, title in names if there),
    )
    return Certificate(
        claim=f"In the simulated stop of {problem.controller.name} from {problem.speeds[1] * KMH:.3g} km/h on "
        f"{problem.rail.name}, with nominal parameters, sampling, valves and wheel lock ({plant_of(problem)}), "
        f"the slip gets to {100.0 * REACHED:.0f} % of {_which(problem)} and from then on exceeds it by at most "
        f"{problem.slip_tolerance:g} down to {JUDGING_SPEED * KMH:.0f} km/h, and the train stops.",
        status=status,
        explanation=_said(problem, status, numbers),
        margin=Range(low=None, high=problem.slip_tolerance - numbers["overshoot"], unit="-")
        if there
        else None,
        worst_point=where,
        witness=where if status is Status.REFUTED else (),
        hypotheses=(hypothesis("the brake never reaches the reference", never),)
        if status is Status.VACUOUS
        else (),
        assumptions=(
            "nominal parameters",
            "exact measurement",
            "a deviation below the reference is benign: it costs distance, by which it is judged",
        ),
        method="simulation of one stop, valve edge to valve edge",
        reference="docs/theory.md#holding",
    )


def _which(problem: Problem) -> str:
    """Name the slip by which the stop is judged: that of the specification if the law names none."""
    law = problem.controller
    if slip_reference_of(law) is not None or places_told(law)[1] >= 0:
        return "its reference"
    return f"slip {problem.slip:g}"


def _said(problem: Problem, status: Status, numbers: Mapping[str, float]) -> str:
    if status is Status.VACUOUS:
        return (
            "The brake never reaches the reference: even full torque is less than what would hold slip "
            f"{problem.slip:g} at any speed, so that wheel slide protection is idle."
        )
    if not numbers:
        return "No stop is stated."
    ends = "the train stops" if numbers["stopped"] else "the train does not stop"
    which = _which(problem)
    if not numbers["wheelsets"]:
        idle = "though the brake could bring it there: the law brakes too little"
        return f"The slip never gets to {which}, {idle}; {ends}."
    unnamed = "" if which == "its reference" else " The law names no slip that it holds."
    return (
        f"The slip first gets to {which} after {numbers['reached']:.2f} s; from then on it exceeds it by at most "
        f"{numbers['overshoot']:.3f} and falls short of it by at most {numbers['undershoot']:.3f}, "
        f"{numbers['rms']:.3f} rms; {ends}.{unnamed}"
    )


OVERSHOOT = Theorem(
    name="overshoot",
    title="Slip beyond its reference in a stop",
    claim="The slip gets to its reference and not far beyond it.",
    speaks_about=every_law,
    obligations=_obligations,
    tell=_tell,
    assumes=ALL - OF_VALVES,
)
