"""Theorems about the linear loop near its reference: Routh's conditions, and stability at nominal numbers.

q^3 + a2 q^2 + a1 q + a0 is stable exactly if a2, a0 and a2 a1 - a0 are positive; q^2 + a2 q + a1 if both are; and
q^4 + a3 q^3 + a2 q^2 + a1 q + a0 if a3, a1, a0 and (a3 a2 - a1) a1 - a3^2 a0 are.
"""

import math
from collections.abc import Callable
from fractions import Fraction

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.claim import Claim, Expression, variable
from wspd_design.certificates.kernel.finding import Finding, Place
from wspd_design.certificates.kernel.obligation import Inequality, Numbers, Obligation, Sampled, Special
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.assumptions import BUILT_UP
from wspd_design.certificates.setting.linear_loop import (
    BRAKE,
    DECAY,
    RATE,
    SHARE,
    Quartic,
    holding_torque,
    law_of,
    linear_law,
    loop_at,
    one_time,
    outermost,
    quartic,
    slips,
    variables,
)
from wspd_design.certificates.setting.plant import OTHERS, Values, place
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis, left_open
from wspd_design.controllers.offers import Feedback
from wspd_design.model.number import Number
from wspd_design.parameters.units import KMH

LEAST = Fraction(1, 10**6)
"""What is shown is a bound above zero, so that the expression is positive and not only not negative."""
UNIT = "unit of speed"
LEAST_GAIN = 1e-3  # of the brake torque per slip
STATIC = "axle at static load, all axles alike"
VARIED = tuple(name for name in (*PLANT, *BRAKE) if name not in ("slip", *OTHERS))
MARGINS = ("speed", "gain up", "gain down", "phase", "delay", "disk")
WORK_OF_POLES = 20_000
SPEEDS = 25  # at which margins are worked out, evenly spaced in the logarithm


def conditions(problem: Problem) -> dict[str, Claim]:
    """Return what must be positive, by name, each in multiples of what it would be without slip pole and lag."""
    law, quantities = law_of(problem), (*variables(problem), variable(UNIT, 1.0, "m/s"))
    at_top = law.linear_form(problem.speeds[1])
    top = problem.vehicle.brake.max_torque

    # Any positive scale serves: the gain on the slip, if it has one sign at all speeds, else its size at the highest
    # speed. A magnitude in it would keep the checker from seeing that both forms are one function.
    usual = max(abs(at_top.proportional), LEAST_GAIN * top)
    steady = at_top.proportional != 0.0 and law.linear_model is None
    slow = law.linear_form(0.5 * problem.speeds[1])
    by_speed = steady and 2.0 * slow.proportional == at_top.proportional
    sides = [-1.0 if each < 0.0 else 1.0 for each in (at_top.proportional, at_top.torque)]

    def parts(values: Values, arranged: bool) -> tuple[Quartic, Number, Number, Feedback]:
        plant, rates, gains = loop_at(problem, values, arranged=arranged)
        size = gains.proportional * sides[0] if steady else usual
        back = rates.decay + rates.rate * gains.torque * sides[1]
        return quartic(plant, rates, gains), rates.rate * plant.gain * size, back, gains

    def third(values: Values, arranged: bool) -> Number:
        found, _, back, _ = parts(values, arranged)
        if arranged and sides[1] > 0.0:
            return 1.0 - loop_at(problem, values, arranged=True)[0].pole / back
        return found.third / back

    def second(values: Values, arranged: bool) -> Number:
        found, scale, _, _ = parts(values, arranged)
        if arranged and by_speed:
            plant, rates, gains = loop_at(problem, values, arranged=True)
            drifting = (rates.decay / rates.rate + gains.torque) * plant.pole
            # The speed cancels in G P; both are taken at 1 m/s.
            unit = loop_at(problem, {**values, "speed": values[UNIT]}, arranged=True)
            return sides[0] * (1.0 - drifting / (unit[0].gain * unit[2].proportional))
        return found.second / scale

    def determinant(values: Values, arranged: bool) -> Number:
        found, scale, back, gains = parts(values, arranged)
        moved = found.third * found.second - found.first
        if at_top.twice:
            moved = moved - found.third * found.third * (gains.twice / gains.integral)
        return moved / (scale * back)

    def integral(values: Values, arranged: bool) -> Number:
        return parts(values, arranged)[3].integral / abs(at_top.integral)

    def twice(values: Values, arranged: bool) -> Number:
        return parts(values, arranged)[3].twice / abs(at_top.twice)

    wanted = {"p < a + b K": third}
    if at_top.twice:
        wanted |= {"I > 0": integral, "J > 0": twice}
        wanted |= {"(a3 a2 - G b I) G b I > a3^2 G b J": determinant}
    elif at_top.integral:
        wanted |= {"I > 0": integral, "a2 a1 > G b I": determinant}
    else:
        wanted |= {"G b P > (a + b K) p": second}
    return {
        name: Claim(
            name=name,
            variables=quantities,
            expression=_bound(expression, arranged=False),
            form=_bound(expression, arranged=True),
            relation=">=",
            bound=LEAST,
            unit="-",
        )
        for name, expression in wanted.items()
    }


def _bound(expression: Callable[[Values, bool], Number], *, arranged: bool) -> Expression:
    return lambda values: expression(values, arranged)


def _routh_obligations(problem: Problem) -> tuple[Obligation, ...]:
    return tuple(Inequality(key=name, claim=claim) for name, claim in conditions(problem).items())


def _status(found: Finding) -> Status:
    """Return the status of a condition; a value between zero and its bound refutes nothing."""
    return Status.UNDECIDED if found.status is Status.REFUTED and found.high > 0.0 else found.status


def _worst(findings: Findings) -> str:
    """Return the condition that decides: that on the sign of a gain has no margin of interest."""
    order = (Status.REFUTED, Status.UNDECIDED, Status.PROVED)

    def rank(name: str) -> tuple[int, bool, float]:
        found = findings[name]
        return order.index(_status(found)), name.endswith("> 0"), found.high

    return min(findings, key=rank)


def _tell_routh(problem: Problem, findings: Findings) -> Certificate:
    law, name = law_of(problem), _worst(findings)
    worst = findings[name]
    status = min(
        (_status(each) for each in findings.values()),
        key=(Status.REFUTED, Status.UNDECIDED, Status.PROVED).index,
    )
    where: tuple[Point, ...] = ()
    spot = ""
    if worst.values:
        at = dict(worst.values)
        plant, _, gains = loop_at(problem, at)
        where = (
            *place(at, [each for each in (*PLANT, *BRAKE) if each in at]),
            *(Point(name=each, value=at[each], unit="-") for each in (SHARE,) if at.get(each)),
            *(Point(name=each, value=at[each], unit="1/s") for each in (DECAY, RATE) if each in at),
            Point(name="slip pole", value=plant.pole, unit="1/s"),
            Point(name="G P", value=plant.gain * gains.proportional, unit="1/s"),
        )
        spot = f" at {at['speed'] * KMH:.3g} km/h with a slip pole of {plant.pole:.3g} 1/s"
    near = slips(problem)
    rest = (
        f"slip {near:g}"
        if isinstance(near, float)
        else f"any slip from {near[0]:.6g} to {near[1]:.6g}, taken as the equilibrium"
    )
    adapting = bool(law.linear_form(problem.speeds[1]).twice)
    included = ", the adaptation of the weights included" if adapting else ""
    uncertain = domain.uncertain(problem)
    varied = tuple(each for each in VARIED if each in uncertain)
    held = tuple(each for each in OTHERS if each in uncertain)
    within = domain.domain_of(problem, ("speed", *varied), held)
    return Certificate(
        claim=f"At every frozen speed the loop near {rest}, with the averaged valve"
        f"{'' if one_time(problem) else ' at any share of T_max'}{included}, is stable: "
        f"{'; '.join(findings)}. {STATIC.capitalize()}; on {within.text}.",
        status=status,
        explanation={
            Status.PROVED: f"Tightest{spot}. Small deviations of the slip die out despite the lag, in continuous time.",
            Status.REFUTED: f"Violated{spot}: {name}. The slip cannot settle there and swings or drifts away.",
            Status.UNDECIDED: f"Open{spot}: {name}. {left_open(findings.values())}",
        }[status],
        margin=_margin(worst),
        worst_point=where,
        witness=where if status is Status.REFUTED else (),
        hypotheses=tuple(
            hypothesis(each, Finding(status=_status(found), asked=found.asked))
            for each, found in findings.items()
        ),
        assumptions=(
            "frozen train speed",
            "averaged valve; no sampling; nothing saturates",
            *_held_of_law(problem),
            STATIC,
        ),
        domain=within,
        varied=varied,
        held=held,
        method="Routh's conditions of the linearized loop by interval branch and bound, replayed by the independent "
        "checker",
        reference="eqs. (14), (19); docs/theory.md#routh",
    )


def _margin(found: Finding) -> Range:
    """Return the smallest value of a condition, which is positive where it holds."""
    return Range(
        low=found.low if math.isfinite(found.low) else None,
        high=found.high if math.isfinite(found.high) else None,
        unit="-",
    )


def _held_of_law(problem: Problem) -> tuple[str, ...]:
    """Name what the law moves and the linear loop does not, and where the loop rests."""
    law = law_of(problem)
    if law.linear_form(problem.speeds[1]).integral == 0.0:
        return ("that an equilibrium lies within the tolerance is decided by lpv_lyapunov",)
    if law.linear_numbers(0.0):
        return (
            "psi_hat at its initial value; weights that differ from the initial ones by one common amount",
            "u* within the limits of the brake, so that the equilibrium is at the reference",
        )
    return (
        "u* within the limits of the brake and of the layer, so that the equilibrium is at the reference",
    )


ROUTH_LAG = Theorem(
    name="routh_lag",
    title="Loop near its reference with valve lag",
    claim="The loop near its reference is stable with the valve lag.",
    speaks_about=linear_law,
    obligations=_routh_obligations,
    tell=_tell_routh,
    assumes=BUILT_UP,
)


def _within_the_brake(problem: Problem) -> str:
    """Say why the theorem is not about a law, or at which speed the brake does not have what holds its slip."""
    reason = linear_law(problem)
    if reason:
        return reason
    low, high = problem.speeds
    if low <= 0.0:
        return ""  # outside the model, which the obligations say
    speeds = [low * (high / low) ** (k / (SPEEDS - 1)) for k in range(SPEEDS)]
    torque, speed = max((float(holding_torque(problem, each)), each) for each in speeds)
    limit = problem.vehicle.brake.max_torque
    if torque <= limit:
        return ""
    return (
        f"holds slip {problem.slip:g}, which takes {torque:.4g} N m at {speed * KMH:.3g} km/h, and the brake of "
        f"{problem.vehicle.name} has {limit:.4g} N m: the loop does not rest there, and a valve that fills "
        "all the time has no averaged pulses"
    )


def _margin_obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem)
    within = {"speed": problem.speeds}
    return (
        Special(
            key="continuous",
            text="no pole of the nominal continuous loop has a positive real part",
            evaluate=lambda at, work: _outside(problem, at, work, sampled=False),
            within=within,
        ),
        Special(
            key="sampled",
            text="no pole of the nominal sampled loop has a magnitude above 1",
            evaluate=lambda at, work: _outside(problem, at, work, sampled=True),
            within=within,
        ),
        Sampled(
            key="margins",
            text="the nominal loop bears changes of gain and phase at all sampled speeds",
            names=MARGINS,
            holds=lambda numbers: numbers["disk"] > 0.0,
        ),
    )


def _outside(problem: Problem, at: Place, work: Work, *, sampled: bool) -> Numbers:
    work.spend(WORK_OF_POLES)
    least = outermost(problem, at["speed"], sampled=sampled)
    if not least > (1.0 if sampled else 0.0):
        raise Refused("at this speed the nominal loop may be stable")
    return {"pole": least}


def decibel(factor: float) -> float:
    """Factor in dB."""
    return 20.0 * math.log10(factor)


def _tell_margins(problem: Problem, findings: Findings) -> Certificate:
    numbers = findings["margins"].numbers
    refuted = [key for key in ("continuous", "sampled") if findings[key].status is Status.REFUTED]
    status = Status.REFUTED if refuted else all_of(findings["margins"])
    witness: tuple[Point, ...] = ()
    meaning = "A sampled loop is unstable, but at no speed exact arithmetic shows a pole outside."
    if refuted:
        found = findings[refuted[0]]
        least = found.numbers["pole"]
        kind = "magnitude of a sampled pole" if refuted[0] == "sampled" else "real part of a pole"
        unit = "-" if refuted[0] == "sampled" else "1/s"
        witness = (
            Point(name="slip", value=problem.slip, unit="-"),
            Point(name="speed", value=found.place["speed"] * KMH, unit="km/h"),
            Point(name=kind, value=least, unit=unit),
        )
        meaning = (
            f"At {found.place['speed'] * KMH:.3g} km/h the {kind} is at least {least:.4g} {unit}".removesuffix(
                " -"
            )
            + ", in exact arithmetic: there is no margin."
        )
    elif status is Status.EVIDENCE:
        meaning = (
            f"Tightest at {numbers['speed'] * KMH:.3g} km/h: the gain may change by "
            f"{decibel(numbers['gain down']):.3g} to {decibel(numbers['gain up']):.3g} dB, "
            f"the phase by {math.degrees(numbers['phase']):.3g} degrees, "
            f"the delay may grow by {numbers['delay'] * 1e3:.3g} ms; disk margin {numbers['disk']:.3g}."
        )
    where = (
        (
            Point(name="speed", value=numbers["speed"] * KMH, unit="km/h"),
            Point(name="gain margin up", value=decibel(numbers["gain up"]), unit="dB"),
            Point(name="gain margin down", value=decibel(numbers["gain down"]), unit="dB"),
            Point(name="phase margin", value=math.degrees(numbers["phase"]), unit="deg"),
            Point(name="delay margin", value=numbers["delay"], unit="s"),
            Point(name="disk margin", value=numbers["disk"], unit="-"),
        )
        if numbers
        else witness
    )
    uncertain = domain.uncertain(problem)
    held = tuple(each for each in (*PLANT, *BRAKE) if each in uncertain)
    adapting = law_of(problem).linear_form(problem.speeds[1]).twice != 0.0
    included = ", and the adaptation of the weights," if adapting else ""
    return Certificate(
        claim=f"With the nominal parameters{included} the loop near "
        f"slip {problem.slip:g} is stable at every frozen speed from {problem.speeds[0] * KMH:.3g} to "
        f"{problem.speeds[1] * KMH:.3g} km/h, continuous with the averaged valve and sampled every "
        f"{problem.sample_time * 1e3:g} ms with its pulses, and bears changes of gain and phase at the valve. That the "
        "continuous loop is stable is what routh_lag says for the whole domain; how much both bear is said here alone.",
        status=status,
        explanation=meaning,
        margin=Range(low=None, high=numbers["disk"], unit="-") if numbers else None,
        worst_point=where,
        witness=witness,
        hypotheses=tuple(hypothesis(findings[key].asked, findings[key]) for key in (refuted or ("margins",))),
        assumptions=(
            "frozen train speed",
            "nominal parameters, axle at static load",
            "sampled loop: pulses of filling and venting around the duty that holds the torque on average, no "
            "computing time",
            *_held_of_law(problem),
        ),
        held=held,
        method="python-control on the linear loop opened at the valve command; disk margin at the extremes of "
        "abs(S - 1/2) over all frequencies; a witness by poles that Arb encloses",
        reference="eqs. (14), (19); docs/theory.md#routh; Seiler, Packard and Gahinet (2020), An introduction to "
        "disk margins",
    )


MARGINS_THEOREM = Theorem(
    name="margins",
    title="Margins of the loop near its reference",
    claim="The nominal loop near its reference has margins at every speed.",
    speaks_about=_within_the_brake,
    obligations=_margin_obligations,
    tell=_tell_margins,
    assumes=BUILT_UP,
)
