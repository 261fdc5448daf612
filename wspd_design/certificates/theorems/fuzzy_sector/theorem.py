"""The theorem on the mended adaptive fuzzy law: weights that stay bounded, and small deviations inside its layer."""

from functools import partial
from typing import cast

from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Condition, Obligation, Special
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import BUILT_UP
from wspd_design.certificates.setting.fuzzy_loop import FILL, core_of
from wspd_design.certificates.setting.plant import place
from wspd_design.certificates.setting.written_fuzzy import not_fuzzy
from wspd_design.certificates.theorems.fuzzy_sector.sector import (
    NAMES,
    falls,
    grows,
    in_words,
    one_valve,
    place_ranges,
)
from wspd_design.certificates.theorems.fuzzy_sector.weights import against_the_center, fading_time
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.references import ConstantSlip
from wspd_design.parameters.units import KMH

WEIGHTS, COURSES, LOOP = "weights", "every course", "course of the loop"


def speaks_about(problem: Problem) -> str:
    """Say why the theorem does not speak about a law; empty if it does."""
    law = problem.controller
    reason = not_fuzzy(law)
    if reason:
        return reason
    law = cast(Protection, law)
    reference, core = cast(ConstantSlip, law.reference), core_of(problem)
    if problem.vehicle.wheelsets != law.wheelsets:
        return "was made for another vehicle"
    if reference.slip != problem.slip:
        return f"holds slip {reference.slip:g}, not {problem.slip:g}"
    if law.cut_out_speed > problem.speeds[0]:
        return f"holds its valves below {law.cut_out_speed * KMH:.3g} km/h, inside the range of speed"
    if core.sample_time != law.sample_time or not core.gains.initial_bound > 0.0:
        return "counts with another sample time, or begins without a command at the edge of its layer"
    return ""


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem, NAMES)
    if problem.speeds[0] <= 0.0:
        raise OutsideModel("the model has no slip at standstill")
    core = core_of(problem)
    bound = against_the_center(core)
    within = f"by more than {bound:.3g} of a sample" if bound is not None else "beyond a bound"
    return (
        Condition(
            key=WEIGHTS,
            text=f"no weight takes the sign opposite to the center of its rule, or leaves 0 if that is at 0, {within}, "
            f"and psi_hat stays at {core.gains.initial_bound:g} or above",
            holds=bound is not None,
        ),
        Special(
            key=COURSES,
            text="a function of small deviations falls however filling and venting follow each other",
            check=lambda proof, work: falls(problem, proof, work),
            evaluate=partial(grows, problem, taken=False),
            within=place_ranges(problem),
        ),
        Special(
            key=LOOP,
            text="no small deviation grows along the course that the loop takes",
            evaluate=partial(grows, problem, taken=True),
            within=place_ranges(problem),
        ),
    )


def _tell(problem: Problem, findings: Findings) -> Certificate:
    weights, courses, loop = (findings[key] for key in (WEIGHTS, COURSES, LOOP))
    if loop.status is Status.REFUTED:
        status = Status.REFUTED
    else:  # a sector that is too wide fails the argument, not the loop
        status = all_of(weights, courses)
        status = Status.UNDECIDED if status is Status.REFUTED else status
    core = core_of(problem)
    low, high = (speed * KMH for speed in problem.speeds)
    uncertain = domain.uncertain(problem)
    held = tuple(name for name in uncertain if name in (*PLANT, "supply rate") and name not in NAMES)
    within = domain.domain_of(problem, ("speed", *NAMES), held)
    worst = _place(problem, loop if loop.status is Status.REFUTED else courses)
    return Certificate(
        claim=f"Whatever the wheel does, {weights.asked}. Inside the layer, once the weights have faded and but for "
        f"the least pulse, small deviations from slip {problem.slip:g} die out with the numbers of the loop frozen at "
        f"any speed from {high:.3g} down to {low:.3g} km/h, sampled every {problem.sample_time * 1e3:g} ms. "
        f"On {within.text}.",
        status=status,
        explanation=f"{_weights(problem, weights)} {_deviations(courses, loop)}",
        margin=Range(low=1.0 - courses.numbers["contraction"], high=None, unit="per sample")
        if status is Status.PROVED
        else None,
        worst_point=worst,
        witness=worst if status is Status.REFUTED else (),
        hypotheses=tuple(
            hypothesis(each.asked, each)
            for each in (weights, courses, *((loop,) if loop.status is Status.REFUTED else ()))
        ),
        assumptions=(
            "frozen train speed: the numbers of the loop are those of one speed; that it falls counts in p - a/v alone",
            "the parameters do not change during the stop; the full pressure is demanded and there",
            "axle at static load, all axles alike",
            "wheel speed and train speed are measured exactly, without noise and dead time; the wheels have the "
            "radius of the law",
            "small deviations: short pulses begin with the sample, and the slip pole is that at the reference; what is "
            f"shorter than {core.gains.least_pulse * 1e3:g} ms is not commanded and leaves what it would answer",
            "says nothing about the way from rolling to the reference, nor about deviations that leave the layer",
        ),
        domain=within,
        varied=tuple(name for name in uncertain if name in NAMES),
        held=held,
        method="bounds of the weights in closed form; a quadratic function for each piece of the speeds by linear "
        "matrix inequalities, LDL' in balls at the corners of a sample; courses of filling and venting by eigenvalues "
        "that Arb encloses",
        reference="docs/theory.md#fuzzy-sector",
    )


def _place(problem: Problem, found: Finding) -> tuple[Point, ...]:
    if found.status is not Status.REFUTED:
        return ()
    values = {**found.place, "slip": problem.slip}
    return (
        *place(values, ("slip", "speed", *NAMES)),
        Point(name="growth of a deviation", value=found.numbers["growth"], unit="per sample"),
    )


def _weights(problem: Problem, weights: Finding) -> str:
    if weights.status is not Status.PROVED:
        return (
            "Nothing bounds the weights but their projection to a whole sample: the gains have no leakage, memberships "
            "of several widths, first weights of the wrong sign, or an adaptation that overshoots within a sample."
        )
    return (
        f"Inside the layer the weights fade with a time constant of {fading_time(core_of(problem)):.3g} s, and the "
        "command is that of a surface without adaptation."
    )


def _deviations(courses: Finding, loop: Finding) -> str:
    if loop.status is Status.REFUTED:
        numbers, speed = loop.numbers, loop.place["speed"] * KMH
        return (
            f"At {speed:.3g} km/h, at the witness, a small deviation grows by {numbers['growth']:.4g} a sample along "
            f"the course that the sign of its surface asks for, {in_words(numbers['course'])}, over and over: "
            f"{_leaves(numbers['course'])}."
        )
    if courses.status is Status.REFUTED:
        numbers, speed = courses.numbers, courses.place["speed"] * KMH
        return (
            "The argument of a sector cannot show more: the authority of the valve while it fills and while it vents "
            f"is so different that at {speed:.3g} km/h, at the point below, a small deviation grows by "
            f"{numbers['growth']:.4g} a sample along {in_words(numbers['course'])}, over and over. No function of "
            "the deviation falls along every course there. The loop was not found to take a course along which one "
            "grows."
        )
    if courses.status is Status.PROVED:
        return (
            f"A quadratic function of error, filtered rate and torque falls by {courses.numbers['contraction']:.4g} a "
            "sample in the root, however filling and venting follow each other."
        )
    return "Neither a function that falls along every course of filling and venting nor a course that grows was found."


def _leaves(course: float) -> str:
    """Say what the growth of a deviation along a course of the loop means."""
    if (valve := one_valve(course)) is None:
        return "the loop does not settle at its reference, it swings"
    if valve == FILL:
        return "filling does not catch a wheel that slips too little, which costs brake"
    return "venting does not catch a wheel that slips too much"


FUZZY_SECTOR = Theorem(
    name="fuzzy_sector",
    title="Weights and sector of the mended adaptive fuzzy law",
    claim="The weights keep the sign of their rules, and small deviations inside the layer die out.",
    speaks_about=speaks_about,
    obligations=_obligations,
    tell=_tell,
    assumes=BUILT_UP,
)
