"""Theorem about small deviations of the sampled loop of any law: its step is taken as it runs, and differentiated.

It needs no form of the law. Where a law switches, never rests or holds its valves while it rests, small deviations say
nothing about it, and the theorem says so.
"""

import math
from collections import Counter

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.kernel.obligation import Numbers, Obligation, Sampled, Special
from wspd_design.certificates.memory import recall
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import BUILT_UP
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.setting.linear_loop import BRAKE, linear_law
from wspd_design.certificates.setting.traced_law import trace
from wspd_design.certificates.setting.traced_loop import NoRest, Rest, TracedLoop
from wspd_design.certificates.theorems.evidence import supported
from wspd_design.certificates.theorems.linear import decibel
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis
from wspd_design.parameters.units import KMH

SPEEDS = 9  # at which a rest is looked for, evenly spaced in the logarithm
ROUNDING = 1e-6  # by which a pole must lie outside of the unit circle to count
WORK = 20_000
POLES = ("speed", "slip", "radius", "speeds", "lowest slip", "highest slip")
MARGINS = ("speed", "gain up", "gain down", "phase", "delay", "disk")


def rests(problem: Problem) -> tuple[Rest | NoRest, ...]:
    """Look for a rest at each of the sampled speeds; the law can be traced."""
    law = trace(problem.controller)
    assert not isinstance(law, str)

    def work_out() -> tuple[Rest | NoRest, ...]:
        loop = TracedLoop(problem, law)
        return tuple(loop.rest(speed) for speed in speeds(problem))

    return recall(["rests of the traced loop", model_hash(problem)], work_out)


def speeds(problem: Problem) -> tuple[float, ...]:
    """Sampled speeds [m/s]."""
    low, high = problem.speeds
    return tuple(low * (high / low) ** (k / (SPEEDS - 1)) for k in range(SPEEDS))


def _with_slopes(problem: Problem) -> str:
    """Say why small deviations say nothing about a law."""
    law = trace(problem.controller)
    if isinstance(law, str):
        return f"is not judged: {law}"
    if problem.speeds[0] <= 0.0:
        return "is not judged: the model has no slip at standstill"
    found = rests(problem)
    reasons = Counter(each.reason for each in found if isinstance(each, NoRest))
    if len(found) > reasons.total():
        return ""
    examples = {each.reason: each.detail for each in reversed(found) if isinstance(each, NoRest)}
    said = (
        f"at {count} of {len(found)} speeds it {reason} ({examples[reason]})"
        for reason, count in reasons.most_common()
    )
    return f"has no small deviations to speak of near slip {problem.slip:g}: {'; '.join(said)}"


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem)
    return (
        Special(
            key="growing",
            text="no small deviation of the sampled loop grows",
            evaluate=lambda at, work: _grows(problem, at, work),
            within={"speed": problem.speeds},
        ),
        Sampled(
            key="poles",
            text="small deviations die out at all sampled speeds at which the loop rests",
            names=POLES,
            holds=lambda numbers: numbers["radius"] < 1.0,
        ),
        Sampled(
            key="margins",
            text="the loop bears changes of gain and phase at its valve there",
            names=MARGINS,
            holds=lambda numbers: numbers["disk"] > 0.0,
        ),
    )


def _grows(problem: Problem, at: Place, work: Work) -> Numbers:
    work.spend(WORK)
    law = trace(problem.controller)
    if isinstance(law, str):
        raise Refused(law)
    found = TracedLoop(problem, law).rest(at["speed"])
    if isinstance(found, NoRest) or not found.radius > 1.0 + ROUNDING:
        raise Refused("at this speed no small deviation was found to grow")
    return {"radius": found.radius, "slip": found.slip}


def _tell(problem: Problem, findings: Findings) -> Certificate:
    growing, poles, bears = (findings[key] for key in ("growing", "poles", "margins"))
    status = supported(growing, poles)
    refuted = status is Status.REFUTED
    numbers = poles.numbers
    found = rests(problem)
    resting = [each for each in found if isinstance(each, Rest)]
    at = growing.place["speed"] if refuted else numbers.get("speed", math.nan)
    shown = growing.numbers if refuted else numbers
    where = (
        (
            Point(name="speed", value=at * KMH, unit="km/h"),
            Point(name="slip", value=shown["slip"], unit="-"),
            Point(name="magnitude of a pole", value=shown["radius"], unit="-"),
        )
        if shown
        else ()
    )
    uncertain = domain.uncertain(problem)
    return Certificate(
        claim=f"At those of {len(found)} sampled frozen speeds from {problem.speeds[0] * KMH:.3g} to "
        f"{problem.speeds[1] * KMH:.3g} km/h at which the loop rests near slip {problem.slip:g}, small deviations die "
        f"out: the step of {problem.controller.name} as it runs, sampled every {problem.sample_time * 1e3:g} ms, with "
        f"the nominal parameters and the pulses of its valves.{_said_before(problem)}",
        status=status,
        explanation=_said(findings, resting, len(found)),
        margin=Range(low=None, high=1.0 - shown["radius"], unit="-") if shown else None,
        worst_point=where,
        witness=where if refuted else (),
        hypotheses=tuple(
            hypothesis(each.asked, each)
            for each in ((growing,) if refuted else (poles, bears))
            if each.numbers
        ),
        assumptions=(
            "frozen train speed",
            "exact measurement, no computing time",
            "nominal parameters, axle at static load, all axles alike",
            "exact pulses; within a sample the slip pole is that at the sampled slip",
            "small deviations from where the loop rests, at the speeds that were tried",
            *_kept(resting),
        ),
        held=tuple(each for each in (*PLANT, *BRAKE) if each in uncertain),
        method="the graph of the step, differentiated by CasADi where Newton's method finds the loop at rest; slopes "
        "compared with small moves to both sides; poles in doubles",
        reference="eqs. (9), (19); docs/theory.md#traced-loop",
    )


def _said_before(problem: Problem) -> str:
    """Say what this adds to the margins of a law whose linear form is known."""
    if linear_law(problem):
        return ""
    return (
        " That is what margins says of the sampled linear form of this law, found again from the step alone."
    )


def _kept(resting: list[Rest]) -> tuple[str, ...]:
    """Name the memory that is held, since it has no slope and none other has one in it."""
    names = dict.fromkeys(name for each in resting for name in each.without_effect)
    return tuple(
        f"{name} stays: it is not differentiable there, and nothing follows it to first order"
        for name in names
    )


def _said(findings: Findings, resting: list[Rest], sampled: int) -> str:
    growing, poles, bears = (findings[key] for key in ("growing", "poles", "margins"))
    if growing.status is Status.REFUTED:
        return (
            f"At {growing.place['speed'] * KMH:.3g} km/h the loop rests at slip {growing.numbers['slip']:.3g}, and a "
            f"small deviation grows by a factor of {growing.numbers['radius']:.4g} a sample: it cannot stay there, and "
            "swings or drifts away."
        )
    numbers = poles.numbers
    if not numbers:
        return "No pole is stated."
    free = max((each.free for each in resting), default=0)
    said = (
        f"It rests at {numbers['speeds']:.0f} of {sampled} speeds, at slips from {numbers['lowest slip']:.3g} to "
        f"{numbers['highest slip']:.3g}. Slowest at {numbers['speed'] * KMH:.3g} km/h, where a deviation keeps "
        f"{numbers['radius']:.3g} of its size from sample to sample."
    )
    if free:
        said += f" Along {free} directions of its memory it rests as well, and what is moved there stays."
    if not bears.numbers:
        return f"{said} It fills and vents by two rules at once, for which no margins are worked out."
    margins = bears.numbers
    return (
        f"{said} At {margins['speed'] * KMH:.3g} km/h it bears least: gains changed by "
        f"{decibel(margins['gain down']):.3g} to {decibel(margins['gain up']):.3g} dB, the phase by "
        f"{math.degrees(margins['phase']):.3g} degrees, {margins['delay'] * 1e3:.3g} ms of delay; disk margin "
        f"{margins['disk']:.3g}."
    )


TRACED_LOOP = Theorem(
    name="traced_loop",
    title="Small deviations of the step that runs",
    claim="Small deviations of the sampled loop die out where it rests.",
    speaks_about=_with_slopes,
    obligations=_obligations,
    tell=_tell,
    assumes=BUILT_UP,
)
