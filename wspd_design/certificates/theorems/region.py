"""Theorems about a region around the reference: quadratic functions for all speeds.

See :mod:`wspd_design.certificates.theorems.quadratic` for the functions and
:mod:`wspd_design.certificates.theorems.equilibrium` for the place around which they are stated.
"""

from fractions import Fraction
from math import isfinite

from wspd_design.certificates.kernel.arb import Ball, ball, below, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Finding, Place
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, Special
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import creep_slope, domain
from wspd_design.certificates.setting.assumptions import BUILT_UP
from wspd_design.certificates.setting.plant import complete, place, plant_forces
from wspd_design.certificates.setting.pulsed_valve import Sample, Times, may_hold, sample_of
from wspd_design.certificates.setting.traced_law import OF_VEHICLE, law_of_theorem
from wspd_design.certificates.theorems import equilibrium, quadratic
from wspd_design.certificates.theorems.equilibrium import BRAKE
from wspd_design.certificates.theorems.invariant_sets import checker as invariance
from wspd_design.certificates.theorems.quadratic import Matrix, law_of, one_sample
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis
from wspd_design.controllers.protocol import Measurement, acts_on_vehicle
from wspd_design.parameters.units import KMH

SLOWEST, FASTEST, FUNCTION = "smallest slope", "largest slope", "functions"
DUTIES = 64  # parts of the range of the duty in which a loop must be unstable to be called so
WORK_OF_A_SAMPLE = 1_000
STATIC = "axle at static load, all axles alike"
NUMBERS = ("fill time", "vent time", "max torque")


def torque_feedback(problem: Problem) -> str:
    """Say why the theorems do not speak about a law: its step is not the static law with torque feedback."""
    reason = law_of_theorem(problem, "torque-feedback")
    if reason is None:
        held: float = problem.wheelset_law.slip_reference  # type: ignore[attr-defined]
        return "" if held == problem.slip else f"holds slip {held:g}, not {problem.slip:g}"
    return f"is not the static law with torque feedback: {reason}"


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem, creep_slope.USED)
    return (
        Inequality(key=SLOWEST, claim=creep_slope.slope_claim(problem, problem.near, ">=", Fraction(0))),
        Inequality(key=FASTEST, claim=creep_slope.slope_claim(problem, problem.near, "<=", Fraction(0))),
        Special(
            key=FUNCTION,
            text="the functions fall along the continuous and the sampled loop at every corner of their numbers",
            check=quadratic.checker(problem),
            evaluate=lambda at, work: _unstable(problem, at, work),
            within=loop_ranges(problem),
        ),
        *equilibrium.obligations(problem),
    )


def loop_ranges(problem: Problem) -> dict[str, tuple[float, float]]:
    """Ranges of the quantities that a place of an unstable loop names."""
    spans = {name: domain.span(problem, name) for name in (*creep_slope.USED, *NUMBERS)}
    return {"slip": problem.near} | {name: ends for name, ends in spans.items() if ends[0] < ends[1]}


def _unstable(problem: Problem, at: Place, work: Work) -> dict[str, float]:
    """Tell how far the loop at a place is from stability, with q and the duty held, or refuse."""
    law = law_of(problem)
    numbers = {name: problem.nominal(name) for name in NUMBERS}
    values = {name: point(each) for name, each in complete(problem, {**numbers, **at}).items()}
    plant = plant_forces(problem, values)
    q = plant.pole - plant.deceleration / values["speed"]
    tops = Fraction(float(values["max torque"]))
    inertia = Fraction(float(values["wheelset inertia"]))
    g, back = law.slide * tops / inertia, law.torque * tops
    fill, vent = (Fraction(float(values[name])) for name in ("fill time", "vent time"))
    times = Times((fill, fill), (vent, vent))
    poles = (Fraction(below(q)), -Fraction(below(-q)))
    parts = [(Fraction(k, DUTIES), Fraction(k + 1, DUTIES)) for k in range(DUTIES)]
    continuous = []
    for part in parts:
        work.spend(WORK_OF_A_SAMPLE)
        continuous.append(_grows(_average(q, times, part, g, back)))
    found = []
    held = equilibrium.holding_torque(plant, values, "") / values["max torque"]
    for part in parts:
        work.spend(WORK_OF_A_SAMPLE)
        if not may_hold(times, law.sample_time, part, held):
            continue
        sample = sample_of(times, poles, law.sample_time, part)
        balls = Sample(*((ball(*each), ball(*each)) for each in sample))
        found.append(_leaves(one_sample(balls, point(g), point(back))))
    if (found and all(found)) or all(continuous):
        return {"pole": below(q)}
    raise Refused("the loop may be stable at this place")


def _average(q: Ball, times: Times, share: tuple[Fraction, Fraction], g: Fraction, back: Fraction) -> Matrix:
    """Matrix of the averaged loop at a share of T_max."""
    fill, vent = point(times.fill[0]), point(times.vent[0])
    held = ball(*share) if times.fill != times.vent else point(0.0)
    b = (1 - held) / fill + held / vent
    a = 1 / (fill * vent * b)
    return ((q, point(-1.0)), (b * point(g), -(a + b * point(back))))


def _grows(a: Matrix) -> bool:
    """Whether a continuous loop is unstable for certain: a positive trace or a negative determinant."""
    trace, determinant = _invariants(a)
    return bool(trace > 0) or bool(determinant < 0)


def _leaves(a: Matrix) -> bool:
    """Whether a sampled loop is unstable for certain, after Jury."""
    trace, determinant = _invariants(a)
    return bool(determinant > 1) or bool(1 + trace + determinant < 0) or bool(1 - trace + determinant < 0)


def _invariants(a: Matrix) -> tuple[Ball, Ball]:
    return a[0][0] + a[1][1], a[0][0] * a[1][1] - a[0][1] * a[1][0]


def slopes(findings: Findings) -> tuple[float, float] | None:
    """Proved range of -S [s/m]."""
    low, high = findings[SLOWEST].low, findings[FASTEST].high
    return (low, high) if isfinite(low) and isfinite(high) else None


def _function(problem: Problem, findings: Findings) -> Finding:
    """Return the finding on the functions; it counts only if they cover all values of q."""
    found, proved = findings[FUNCTION], slopes(findings)
    if found.status is not Status.PROVED:
        return found
    low, high = creep_slope.poles(problem, problem.near, *proved) if proved else (-float("inf"), float("inf"))
    covered = found.numbers["lowest pole"] <= low and high <= found.numbers["highest pole"]
    return found if covered else Finding(status=Status.UNDECIDED, asked=found.asked)


def _tell(problem: Problem, findings: Findings) -> Certificate:
    function, rest = _function(problem, findings), equilibrium.status(findings)
    low, high = problem.speeds[0] * KMH, problem.speeds[1] * KMH
    near = problem.near
    functions = all_of(function)
    status = Status.REFUTED if Status.REFUTED in (functions, rest) else all_of(function)
    if status is Status.PROVED:
        status = rest
    witness: tuple[Point, ...] = ()
    if functions is Status.REFUTED:
        at = {**{name: problem.nominal(name) for name in NUMBERS}, **complete(problem, function.place)}
        witness = (
            *place(at, ("slip", *creep_slope.USED, *NUMBERS)),
            Point(name="p - a/v", value=function.numbers["pole"], unit="1/s"),
        )
    elif rest is Status.REFUTED:
        found = findings[equilibrium.NOWHERE]
        at = {**{name: problem.nominal(name) for name in NUMBERS}, **complete(problem, found.place)}
        names = [name for name in equilibrium.USED if name != "slip"]
        witness = (
            *place(at, names),
            Point(name="rate of the torque", value=found.numbers["rate"], unit="1/s"),
        )
    proved = slopes(findings)
    polytope = "The range of p - a/v is open"
    if proved is not None:
        least, most = creep_slope.poles(problem, near, *proved)
        polytope = f"p - a/v lies between {least:.3g} and {most:.3g} 1/s"
    falling = {
        Status.UNDECIDED: "no function was found that falls everywhere",
        Status.REFUTED: "at the witness the loop with these gains is unstable in exact arithmetic, so that no such "
        "function can exist",
    }
    margin = None
    if function.status is Status.PROVED:
        contraction = function.numbers["contraction"]
        margin = Range(low=1.0 - contraction, high=None, unit="per sample")
        falling[Status.PROVED] = (
            f"the deviation, measured by the root of the function, falls at least as "
            f"exp(-{function.numbers['decay']:.3g} t) in continuous time and by a factor of {contraction:.3g} "
            "per sample"
        )
    uncertain = domain.uncertain(problem)
    varied = tuple(name for name in (*creep_slope.USED, *NUMBERS) if name in uncertain)
    held = tuple(name for name in (*creep_slope.HELD, "supply rate") if name in uncertain)
    where = domain.domain_of(problem, varied, held)
    return Certificate(
        claim=f"Around any slip from {near[0]:.6g} to {near[1]:.6g}, taken as the equilibrium, a quadratic function "
        "of the deviations of sliding speed and torque falls along the loop, continuous with the averaged valve and "
        f"sampled every {problem.sample_time * 1e3:g} ms with its pulses, whatever the course of speed from {high:.3g} "
        f"to {low:.3g} km/h; and for all numbers of the domain an equilibrium lies within "
        f"{problem.slip_tolerance:g} of slip {problem.slip:g}. {STATIC.capitalize()}; on "
        f"{where.text}.",
        status=status,
        explanation=f"{polytope}; {falling[functions]}. {equilibrium.explained(problem, findings)}.",
        margin=margin,
        worst_point=witness,
        witness=witness,
        hypotheses=(
            hypothesis(
                "the slope of the creep force stays in its proved range",
                Finding(
                    status=Status.PROVED if proved is not None else Status.UNDECIDED,
                    asked=findings[SLOWEST].asked,
                ),
            ),
            hypothesis("P, and its decrease at every corner, are positive definite", function),
            hypothesis(
                equilibrium.text(problem), Finding(status=rest, asked=findings[equilibrium.NOWHERE].asked)
            ),
        ),
        assumptions=(
            "small deviations from the equilibrium; nothing saturates",
            "fill and vent time, T_max and inertia do not change; a function for each piece of their box",
            "full supply pressure; the equilibrium is that of the averaged valve",
            "sampled loop: exact pulses of filling and venting without computing time; p - a/v constant within a "
            "sample, arbitrary from one to the next",
            "the slow change of the equilibrium with the speed is left out",
            STATIC,
        ),
        domain=where,
        varied=varied,
        held=held,
        method="functions by a search over their form; exact LDL' of rational matrices at the corners; interval branch "
        "and bound of the slope and of the equilibrium, replayed by the independent checker",
        reference="eqs. (9), (14), (19); docs/theory.md#lpv",
    )


SETS = "sets"
VARIED_IN_SETS = ("mass", "wheelset inertia", "mu0")


def _memoryless(problem: Problem) -> str:
    if acts_on_vehicle(problem.controller):
        return OF_VEHICLE
    memory = problem.wheelset_law.start(Measurement(problem.speeds[1], problem.speeds[1], 0.0))
    if memory == ():
        return ""
    return (
        f"remembers {len(memory)} numbers from sample to sample, so that slip and torque alone do not tell its next "
        "command"
    )


def _set_obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem)
    return (
        Special(
            key=SETS,
            text="one sample maps the sets of slip and torque into themselves at all speeds",
            check=lambda proof, work: invariance.decide(problem, proof, work),
        ),
    )


def _tell_sets(problem: Problem, findings: Findings) -> Certificate:
    found = findings[SETS]
    uncertain = domain.uncertain(problem)
    varied = tuple(name for name in VARIED_IN_SETS if name in uncertain)
    held = tuple(name for name in (*PLANT, *BRAKE) if name in uncertain and name not in VARIED_IN_SETS)
    brake = problem.vehicle.brake
    where = domain.domain_of(problem, ("slip", "speed", *varied), held)
    claim = (
        f"On {where.text}, sampled every {problem.sample_time:g} s "
        f"with pulses that fill with {brake.fill_time:g} s and vent with {brake.vent_time:g} s, "
        f"{problem.controller.name} keeps slip and torque in a set around slip {problem.slip:g} once they are in it. "
        f"{STATIC.capitalize()}."
    )
    explanation, margin = "No sets were found for the whole range of speed.", None
    worst: tuple[Point, ...] = ()
    if found.status is Status.PROVED:
        low, high = found.numbers["lowest slip"], found.numbers["highest slip"]
        claim += f" The slip then stays within {low:.3f} and {high:.3f}, also between samples."
        explanation = (
            f"One set for each of {found.numbers['windows']:g} windows of speed; each also maps into that of the next "
            "slower window, so that the whole stop is covered. The wheel does not lock."
        )
        margin = Range(low=1.0 - high, high=1.0 - problem.slip, unit="-")
        worst = (Point(name="slip", value=high, unit="-"),)
    return Certificate(
        claim=claim,
        status=all_of(found),
        explanation=explanation,
        margin=margin,
        worst_point=worst,
        hypotheses=(hypothesis(found.asked, found),),
        assumptions=(
            "full supply pressure behind the valves",
            "speeds and torque measured exactly, without dead time",
            "no pad vibration",
            STATIC,
            "mass, inertia and mu0 may even change with time",
            "says nothing about the way from rolling into the set, nor below the lowest speed",
        ),
        domain=where,
        varied=varied,
        held=held,
        method="interval enclosure of the one-sample map on cells of slip and torque; cells with images that leave are "
        "removed until none is left; an independent checker maps all cells again in Arb",
        reference="eqs. (9), (14), (19); docs/theory.md#invariance",
    )


SAMPLED_INVARIANCE = Theorem(
    name="sampled_invariance",
    title="Invariant set of the sampled loop",
    claim="In one sample the closed loop maps a set of slip and torque at every speed into itself.",
    speaks_about=_memoryless,
    obligations=_set_obligations,
    tell=_tell_sets,
    assumes=BUILT_UP,
)

LPV_LYAPUNOV = Theorem(
    name="lpv_lyapunov",
    title="Quadratic function for all speeds",
    claim="A quadratic function of slip and torque deviation falls at all speeds around an equilibrium near the "
    "reference.",
    speaks_about=torque_feedback,
    obligations=_obligations,
    tell=_tell,
    assumes=BUILT_UP,
)
