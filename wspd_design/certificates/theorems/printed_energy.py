"""Why (44) as printed is false: a state at which V2 of (43) rises, whatever the ideal weights."""

from collections.abc import Mapping
from functools import partial

from wspd_design.certificates.kernel.arb import Ball, ball, below, point
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.kernel.obligation import Special
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.certificates.theorems.ideal_loop import EVALUATION_WORK
from wspd_design.certificates.theorems.theorem import Findings
from wspd_design.certificates.theorems.whom import adaptive_law
from wspd_design.controllers.adaptive_fuzzy import firing_strengths
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH


def printed_obligations(problem: Problem) -> tuple[Special, ...]:
    """Return (44) at s = 0, which a speed can deny."""
    return (
        Special(
            key="at s = 0",
            text="(44) at s = 0: dV2/dt <= 0 for some ideal weights and a psi that bounds the approximation error",
            evaluate=partial(_denied, problem),
            within={"speed": problem.speeds},
        ),
    )


def _denied(problem: Problem, at: Place, work: Work) -> Mapping[str, float]:
    work.spend(EVALUATION_WORK)
    rate = below(printed_rate(problem, at["speed"]))
    if not rate > 0.0:
        raise Refused("the place denies nothing: at s = 0 there (44) may hold")
    return {"least dV2/dt": rate}


def tell_printed(problem: Problem, findings: Findings) -> Certificate:
    """Tell whether (44) is refuted at a state with s = 0."""
    found = findings["at s = 0"]
    refuted = found.status is Status.REFUTED
    rate = found.numbers.get("least dV2/dt", 0.0)
    where = (
        (
            Point(name="speed", value=found.place["speed"] * KMH, unit="km/h"),
            Point(name="slip", value=problem.slip, unit="-"),
            Point(name="integral of the slip error", value=0.0, unit="s"),
            Point(name="least dV2/dt", value=rate, unit="1/s"),
        )
        if refuted
        else ()
    )
    return Certificate(
        claim="V2 of (43) falls along the printed law as (44) says, dV2/dt <= -G abs(s) (psi - abs(xi)), for some "
        f"ideal weights and a psi that bounds the approximation error, from {problem.speeds[0] * KMH:.3g} to "
        f"{problem.speeds[1] * KMH:.3g} km/h on {problem.rail.name} with the nominal parameters.",
        status=found.status,
        explanation=(
            "With the slip at its reference, no integral and the initial weights and bound, s = 0 and (44) asks for "
            f"dV2/dt <= 0. At {found.place['speed'] * KMH:.3g} km/h it is at least {rate:.3g} 1/s, whatever the ideal "
            "weights: (44) leaves out G'/2 times the squared errors, and G' > 0. With the dead zone and the held "
            "adaptation the repaired V gives bounds in its place."
            if refuted
            else "At s = 0 the initial weights and bound may be ideal ones, so that this point decides nothing."
        ),
        margin=Range(low=None, high=-rate, unit="1/s") if refuted else None,
        worst_point=where,
        witness=where,
        assumptions=(
            "T = u: no valve lag, no sampling, no limit of the brake torque, continuous adaptation",
            "nominal parameters",
            "initial weights and bound of the law",
        ),
        held=domain.not_varied(problem, ()),
        method="V2' at s = 0 in balls, minimized over all ideal weights and bounds that (34) admits",
        reference="eqs. (33), (34), (39)-(44); docs/theory.md#printed",
    )


def printed_rate(problem: Problem, speed: float) -> Ball:
    """Least dV2/dt at s = 0 over all admissible ideal weights and bounds [1/s].

    At s = 0 nothing adapts and V2' = (G'/2)(abs(b~)^2/alpha1 + psi~^2/alpha2) with G' = G a/v. (34) asks for
    psi >= abs(u* - b*'w). With the law's own w, b_hat and psi_hat the errors have to make up for
    d = abs(u* - b_hat'w) - psi_hat; the cheapest way costs d^2/(alpha1 abs(w)^2 + alpha2).
    """
    gains = adaptive_law(problem).gains
    plant = slip_dynamics(*exact_plant(problem), point(problem.slip), point(speed))
    ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, 0.0, 0.0) / gains.torque_unit
    strengths = firing_strengths(gains, point(0.0))
    fuzzy = sum((w * b for w, b in zip(strengths, gains.initial_weights, strict=True)), point(0.0))
    lacking = abs(ideal - fuzzy) - gains.initial_bound
    if not lacking > 0:
        return ball(0.0, 0.0)
    cost = lacking**2 / (gains.weight_rate * sum((w * w for w in strengths), point(0.0)) + gains.bound_rate)
    return plant.gain * plant.deceleration / speed / 2 * gains.torque_unit * cost
