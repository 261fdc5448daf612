"""What each check has to show about a closed loop, made from the design and never from a certificate."""

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial

from wspd_design.certificates.checks.adaptive import adaptive_energy, afsmc_energy, printed_energy, sigma_time
from wspd_design.certificates.checks.foundations import derivation, gain_positive, surface_hurwitz, well_posed
from wspd_design.certificates.checks.linear import routh_lag
from wspd_design.certificates.checks.sliding import reaching, sliding_exists
from wspd_design.certificates.checks.valve import hard_limits, no_go, open_loop_pole, sampling
from wspd_design.certificates.kernel.arb import below
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.obligation import (
    Answer,
    Obligation,
    answered,
    conditions,
    exact_claims,
    inequalities,
    inequality,
    on_part,
    refutable,
    whole,
)
from wspd_design.certificates.kernel.subdomain import Ends
from wspd_design.certificates.records import Problem, Status
from wspd_design.certificates.search import recovery
from wspd_design.certificates.setting import laws
from wspd_design.certificates.setting.linear_loop import outermost
from wspd_design.certificates.theorems import quadratic
from wspd_design.certificates.theorems.invariant_sets import checker as invariance
from wspd_design.certificates.theorems.invariant_sets.runs import FORMAT as SETS_FORMAT
from wspd_design.certificates.theorems.shortest_stop import adhesion_peaks
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.offers import Linear, Surface
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.parameters.units import KMH

BOTH = (Status.PROVED, Status.VACUOUS)


def _strange(problem: Problem, name: str) -> Refused:
    return Refused(f"{name} does not speak about the law of {problem.controller.name}")


def _surface_hurwitz(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, Surface):
        raise _strange(problem, "surface_hurwitz")
    claims = surface_hurwitz.claims(law)
    return (*exact_claims(claims), *conditions(("two gains that define a surface", bool(claims))))


def _reaching(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, SlidingMode):
        raise _strange(problem, "reaching")
    return inequalities(reaching.claims(problem, problem.controller))


def _boundary_layer(problem: Problem) -> tuple[Obligation, ...]:
    """It rests on the inequalities of ``reaching`` and on a layer inside the domain."""
    law = problem.controller
    if not isinstance(law, SlidingMode):
        raise _strange(problem, "boundary_layer")
    low, reference, high = map(Fraction, (problem.slips[0], problem.slip, problem.slips[1]))
    band = 2 * Fraction(law.gains.boundary_layer)
    return (
        *_reaching(problem),
        *conditions(
            ("a layer with a width, Phi/K_P > 0", band > 0),
            ("a stable surface, c > 0", law.gains.surface_rate > 0.0),
            ("a band of 2 Phi/K_P inside the domain", band < min(reference - low, high - reference)),
        ),
    )


def _feedback(problem: Problem) -> tuple[Obligation, ...]:
    """Return the condition of the no-go theorem on the law."""
    form = laws.slip_feedback_only(problem)
    return conditions((form.text, form.status is not Status.REFUTED))


def _open_loop_pole(problem: Problem) -> tuple[Obligation, ...]:
    low, high = open_loop_pole.valve_rate(problem)
    return (
        inequality(open_loop_pole.pole_claim(problem, "<=", low)),
        inequality(open_loop_pole.pole_claim(problem, ">=", high), needed=()),
        *_feedback(problem),
    )


def _no_go(problem: Problem) -> tuple[Obligation, ...]:
    low, high = open_loop_pole.valve_rate(problem)
    nowhere = no_go.interval_claim(problem, low, problem.speeds, "<=")
    return (
        on_part(
            lambda speeds: no_go.interval_claim(problem, high, speeds, ">="),
            "speed",
            problem.speeds,
            " m/s",
            needed=(Status.PROVED,),
            longer=True,
        ),
        inequality(nowhere, needed=(Status.VACUOUS,), where=" with the nominal parameters"),
        *_feedback(problem),
    )


def _sliding_exists(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, Surface):
        raise _strange(problem, "sliding_exists")
    limit = problem.vehicle.brake.max_torque

    def enough(mu0: Ends) -> Claim:
        return sliding_exists.torque_claim(problem, law, "<=", limit, mu0=mu0)

    return (
        inequality(sliding_exists.torque_claim(problem, law, ">=", 0.0), needed=BOTH),
        inequality(enough(problem.span("mu0")), needed=()),
        on_part(enough, "mu0", problem.span("mu0"), "", needed=(), longer=False),
        inequality(sliding_exists.least_demand(problem, law), needed=(Status.VACUOUS,)),
    )


def _afsmc_energy(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, AdaptiveFuzzy):
        raise _strange(problem, "afsmc_energy")
    constant = conditions(
        ("rates of adaptation that do not depend on the speed", not law.gains.scheduled_rates)
    )
    printed = (
        () if law.gains.dead_zone else (refutable("(44) at s = 0", partial(_printed_rate, problem, law)),)
    )
    return (
        *inequalities(afsmc_energy.claims(problem, law), decisive=False),
        *_adaptation(law),
        *constant,
        *printed,
    )


def _printed_rate(problem: Problem, law: AdaptiveFuzzy, speed: float) -> str:
    rate = below(printed_energy.printed_rate(problem, law, speed))
    if not rate > 0.0:
        raise Refused("the witness denies nothing: at s = 0 there (44) may hold")
    return f"(44) at s = 0: dV2/dt is at least {rate:.6g} 1/s at {speed * KMH:.6g} km/h"


def _barbalat(problem: Problem) -> tuple[Obligation, ...]:
    """Without rates alpha/v the lemma is vacuous, for which there is no proof."""
    law = problem.controller
    if not isinstance(law, AdaptiveFuzzy):
        raise _strange(problem, "barbalat")
    scheduled = conditions(("rates of adaptation alpha/v", law.gains.scheduled_rates))
    return (*inequalities(sigma_time.claims(problem, law), decisive=False), *_adaptation(law), *scheduled)


def _adaptation(law: AdaptiveFuzzy) -> tuple[Obligation, ...]:
    """Return what the repaired Lyapunov function asks of the law."""
    return conditions(
        ("an adaptation with s_D alone", law.gains.dead_zone),
        ("positive K_P, K_I, Phi and rates of adaptation", adaptive_energy.smallest_gain(law.gains) > 0.0),
        ("an adaptation that is held beyond the limits of the brake", law.gains.hold_when_saturated),
    )


def _sampling(problem: Problem) -> tuple[Obligation, ...]:
    return (inequality(sampling.claim(problem)), *_feedback(problem))


def _routh_lag(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, Linear):
        raise _strange(problem, "routh_lag")
    return inequalities(routh_lag.claims(problem, problem.controller))


def _margins(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, Linear):
        raise _strange(problem, "margins")

    def unstable(speed: float) -> str:
        place = f"with the nominal parameters at {speed * KMH:.6g} km/h"
        if (real := outermost(problem, law, speed, sampled=False)) > 0.0:
            return f"a stable loop: a pole has a real part of at least {real:.6g} 1/s {place}"
        if (size := outermost(problem, law, speed, sampled=True)) > 1.0:
            return f"a stable sampled loop: a pole has a magnitude of at least {size:.6g} {place}"
        raise Refused(f"the witness denies nothing: {place} the loop may be stable")

    return (refutable("a stable loop at every speed", unstable),)


def _hard_limits(problem: Problem) -> tuple[Obligation, ...]:
    """Its witness is an integration, which the condition on the slopes does not decide."""

    def share(speed: Ends) -> Claim:
        return recovery.share_claim(problem, hard_limits.DEVIATION, speed=speed)

    return (
        inequality(recovery.torque_claim(problem), decisive=False),
        inequality(recovery.growth_claim(problem), needed=()),
        inequality(share(problem.speeds), decisive=False),
        on_part(share, "speed", problem.speeds, " m/s", needed=(), longer=True),
        *conditions(("room for the deviation in the range of slip", hard_limits.has_room(problem))),
    )


def _lpv_lyapunov(problem: Problem) -> tuple[Obligation, ...]:
    text = "one quadratic function falls along the continuous and the sampled loop"

    def check(proof: str) -> Answer:
        return answered(quadratic.check_quadratic(proof, problem), text)

    return whole(text, quadratic.FORMAT, check)


def _sampled_invariance(problem: Problem) -> tuple[Obligation, ...]:
    text = "one sample maps the sets of slip and torque into themselves at all speeds"
    return whole(text, SETS_FORMAT, lambda proof: answered(invariance.check(problem, proof), text))


def _stop_bound(problem: Problem) -> tuple[Obligation, ...]:
    """Any bound of the adhesion peaks gives a bound of the stop; the checker says which."""

    def check(proof: str) -> Answer:
        verdict = adhesion_peaks.check(problem, proof)
        return answered(verdict, verdict.statement)

    return whole("a shortest stop of any controller", adhesion_peaks.FORMAT, check)


OBLIGATIONS: Mapping[str, Callable[[Problem], tuple[Obligation, ...]]] = {
    "derivation": lambda _problem: exact_claims(derivation.claims()),
    "surface_hurwitz": _surface_hurwitz,
    "gain_positive": lambda problem: exact_claims(gain_positive.claims(problem)),
    "well_posed": lambda problem: inequalities(well_posed.claims(problem)),
    "sliding_exists": _sliding_exists,
    "reaching": _reaching,
    "boundary_layer": _boundary_layer,
    "afsmc_energy": _afsmc_energy,
    "barbalat": _barbalat,
    "open_loop_pole": _open_loop_pole,
    "no_go": _no_go,
    "sampling": _sampling,
    "routh_lag": _routh_lag,
    "hard_limits": _hard_limits,
    "margins": _margins,
    "lpv_lyapunov": _lpv_lyapunov,
    "sampled_invariance": _sampled_invariance,
    "stop_bound": _stop_bound,
}


def obligations(name: str, problem: Problem) -> tuple[Obligation, ...]:
    """Return what a check has to show about a closed loop.

    Raises
    ------
    Refused
        If no such check keeps proofs, or it does not speak about this controller.
    """
    if name not in OBLIGATIONS:
        raise Refused(f'the claims of "{name}" cannot be rebuilt; known are {", ".join(OBLIGATIONS)}')
    return OBLIGATIONS[name](problem)
