"""What each check has to show about a closed loop, made from the design and never from a certificate."""

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from fractions import Fraction
from typing import Any, Protocol, TypeAlias

from wspd_design.certificates import (
    adhesion_peaks,
    afsmc_energy,
    derivation,
    exact,
    gain_positive,
    laws,
    no_go,
    open_loop_pole,
    quadratic,
    reaching,
    routh_lag,
    sliding_exists,
    surface_hurwitz,
    well_posed,
)
from wspd_design.certificates.exact import ExactClaim
from wspd_design.certificates.invariance import checker as invariance
from wspd_design.certificates.invariance.runs import FORMAT as SETS_FORMAT
from wspd_design.certificates.linear_loop import LinearLaw
from wspd_design.certificates.part import KEY, Ends, stated_part
from wspd_design.certificates.proof import checker
from wspd_design.certificates.proof.balls import Refused
from wspd_design.certificates.proof.claim import Claim, number
from wspd_design.certificates.records import Problem, Status
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode

Content: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """What a checker says about a proof."""

    accepted: bool
    reason: str
    leaves: int  # boxes that it decided
    shown: str = ""  # what was shown, in words with the numbers that were checked
    enough: bool = True  # whether that is all that is asked for


class Verdict(Protocol):
    """What the checkers have in common."""

    @property
    def accepted(self) -> bool:
        """Whether it is a proof."""

    @property
    def reason(self) -> str:
        """Why."""

    @property
    def leaves(self) -> int:
        """How many boxes it decided."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Obligation:
    """Something that a check shows, made from the design.

    A proof of an inequality may show a looser bound than the check needs: it then says something true, but not
    enough. What is needed for no status encloses a number.
    """

    text: str
    needed: tuple[Status, ...] = (Status.PROVED,)  # the statuses that rest on it
    concerns: Callable[[Content], bool]  # whether a proof is about this
    check: Callable[[str], Answer]
    claim: Claim | None = None  # an inequality on the whole domain, which a witness may deny


BOTH = (Status.PROVED, Status.VACUOUS)
DIGITS = 6  # of the ends of a range


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


def _inequality(
    claim: Claim, *, needed: tuple[Status, ...] = (Status.PROVED,), where: str = ""
) -> Obligation:
    """A claim of which every bound may be shown; one at least as tight as the claim's is enough.

    ``where`` says in words on which part of the domain it stands.
    """
    return Obligation(
        text=_statement(claim) + where,
        needed=needed,
        concerns=lambda content: _is_about(claim, content) and KEY not in content,
        check=lambda text: _checked(claim, text, where),
        claim=None if where else claim,
    )


def _on_part(
    claim: Callable[[Ends], Claim],
    quantity: str,
    within: Ends,
    unit: str,
    *,
    needed: tuple[Status, ...],
    longer: bool,
) -> Obligation:
    """A claim on a part of the domain that the proof names; ``longer`` refuses a part that is a single point."""
    whole = claim(within)

    def check(text: str) -> Answer:
        low, high = stated_part(json.loads(text), quantity, within)
        if longer and low == high:
            raise Refused(f"the proof speaks about a single {quantity}")
        return _checked(claim((low, high)), text, f" for {quantity} from {_inward(low, high)}{unit}")

    return Obligation(
        text=f"{_statement(whole)} on a range of {quantity}",
        needed=needed,
        concerns=lambda content: _is_about(whole, content) and KEY in content,
        check=check,
    )


def _inward(low: float, high: float) -> str:
    """Write a range so that what stands there is no wider, in few digits if it has room for that."""
    up, down = Context(prec=DIGITS, rounding=ROUND_CEILING), Context(prec=DIGITS, rounding=ROUND_FLOOR)
    first, last = up.create_decimal_from_float(low), down.create_decimal_from_float(high)
    return f"{first:f} to {last:f}" if first <= last else f"{low!r} to {high!r}"


def _is_about(claim: Claim, content: Content) -> bool:
    return (content.get("claim"), content.get("relation")) == (claim.name, claim.relation)


def _checked(claim: Claim, text: str, where: str) -> Answer:
    """Let the checker decide about the bound that a proof states."""
    try:
        stated = replace(claim, bound=number(json.loads(text)["bound"]))
    except (KeyError, TypeError, ValueError, OverflowError, ZeroDivisionError):
        raise Refused("the proof states no bound") from None
    tight = stated.bound <= claim.bound if claim.relation == "<=" else stated.bound >= claim.bound
    return _answer(checker.check(stated, text), _statement(stated) + where, enough=tight)


def _answer(verdict: Verdict, shown: str, *, enough: bool = True) -> Answer:
    return Answer(
        accepted=verdict.accepted, reason=verdict.reason, leaves=verdict.leaves, shown=shown, enough=enough
    )


def _statement(claim: Claim) -> str:
    return f"{claim.name} {claim.relation} {float(claim.bound):.6g} {claim.unit}".removesuffix(" -")


def _all(claims: Iterable[Claim]) -> tuple[Obligation, ...]:
    return tuple(_inequality(claim) for claim in claims)


def _exact(claims: Iterable[ExactClaim]) -> tuple[Obligation, ...]:
    """Claims that need no search."""

    def of(claim: ExactClaim) -> Obligation:
        return Obligation(
            text=claim.statement(),
            concerns=lambda content: (
                (content.get("format"), content.get("claim")) == (exact.FORMAT, claim.name)
            ),
            check=lambda text: _answer(exact.check(claim, text), claim.statement()),
        )

    return tuple(of(claim) for claim in claims)


def _whole(text: str, form: str, check: Callable[[str], Answer]) -> tuple[Obligation, ...]:
    """A theorem with a checker of its own, whose proof names its form."""
    return (Obligation(text=text, concerns=lambda content: content.get("format") == form, check=check),)


def _conditions(*stated: tuple[str, bool]) -> tuple[Obligation, ...]:
    """Conditions that the design alone decides; one that does not hold can be shown by no proof."""
    refusal = Answer(accepted=False, reason="the design decides this", leaves=0)
    return tuple(
        Obligation(text=text, concerns=lambda _content: False, check=lambda _text: refusal)
        for text, holds in stated
        if not holds
    )


def _strange(problem: Problem, name: str) -> Refused:
    return Refused(f"{name} does not speak about the law of {problem.controller.name}")


def _surface_hurwitz(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, laws.SlipLaw):
        raise _strange(problem, "surface_hurwitz")
    claims = surface_hurwitz.claims(law)
    return (*_exact(claims), *_conditions(("two gains that define a surface", bool(claims))))


def _reaching(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, SlidingMode):
        raise _strange(problem, "reaching")
    return _all(reaching.claims(problem, problem.controller))


def _boundary_layer(problem: Problem) -> tuple[Obligation, ...]:
    """It rests on the inequalities of ``reaching`` and on a layer inside the domain."""
    law = problem.controller
    if not isinstance(law, SlidingMode):
        raise _strange(problem, "boundary_layer")
    low, reference, high = map(Fraction, (problem.slips[0], problem.slip, problem.slips[1]))
    band = 2 * Fraction(law.gains.boundary_layer)
    return (
        *_reaching(problem),
        *_conditions(
            ("a layer with a width, Phi/K_P > 0", band > 0),
            ("a stable surface, c > 0", law.gains.surface_rate > 0.0),
            ("a band of 2 Phi/K_P inside the domain", band < min(reference - low, high - reference)),
        ),
    )


def _feedback(problem: Problem) -> tuple[Obligation, ...]:
    """Return the condition of the no-go theorem on the law."""
    form = laws.slip_feedback_only(problem)
    return _conditions((form.text, form.status is not Status.REFUTED))


def _open_loop_pole(problem: Problem) -> tuple[Obligation, ...]:
    limit = 1.0 / open_loop_pole.shortest_lag(problem)
    return (
        _inequality(open_loop_pole.pole_claim(problem, "<=", limit)),
        _inequality(open_loop_pole.pole_claim(problem, ">=", limit), needed=()),
        *_feedback(problem),
    )


def _no_go(problem: Problem) -> tuple[Obligation, ...]:
    limit = 1.0 / open_loop_pole.shortest_lag(problem)
    nowhere = no_go.interval_claim(problem, limit, problem.speeds, "<=")
    return (
        _on_part(
            lambda speeds: no_go.interval_claim(problem, limit, speeds, ">="),
            "speed",
            problem.speeds,
            " m/s",
            needed=(Status.PROVED,),
            longer=True,
        ),
        _inequality(nowhere, needed=(Status.VACUOUS,), where=" with the nominal parameters"),
        *_feedback(problem),
    )


def _sliding_exists(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, laws.SlipLaw):
        raise _strange(problem, "sliding_exists")
    limit = problem.vehicle.brake.max_torque

    def enough(mu0: Ends) -> Claim:
        return sliding_exists.torque_claim(problem, law, "<=", limit, mu0=mu0)

    return (
        _inequality(sliding_exists.torque_claim(problem, law, ">=", 0.0), needed=BOTH),
        _inequality(enough(problem.mu0_bounds), needed=()),
        _on_part(enough, "mu0", problem.mu0_bounds, "", needed=(), longer=False),
        _inequality(sliding_exists.least_demand(problem, law), needed=(Status.VACUOUS,)),
    )


def _afsmc_energy(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, AdaptiveFuzzy):
        raise _strange(problem, "afsmc_energy")
    gains = law.gains
    signs = (
        gains.weight_rate,
        gains.bound_rate,
        gains.proportional_gain,
        gains.integral_gain,
        gains.boundary_layer,
    )
    return (
        *_all(afsmc_energy.claims(problem, law)),
        *_conditions(
            ("the adaptation with a dead zone", gains.dead_zone),
            ("positive gains and rates", min(signs) > 0.0),
            ("an adaptation that is held in saturation", gains.hold_when_saturated),
        ),
    )


def _routh_lag(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, LinearLaw):
        raise _strange(problem, "routh_lag")
    return _all(routh_lag.claims(problem, problem.controller))


def _lpv_lyapunov(problem: Problem) -> tuple[Obligation, ...]:
    text = "one quadratic function falls along the continuous and the sampled loop"

    def check(proof: str) -> Answer:
        return _answer(quadratic.check_quadratic(proof, problem), text)

    return _whole(text, quadratic.FORMAT, check)


def _sampled_invariance(problem: Problem) -> tuple[Obligation, ...]:
    text = "one sample maps the sets of slip and torque into themselves at all speeds"
    return _whole(text, SETS_FORMAT, lambda proof: _answer(invariance.check(problem, proof), text))


def _stop_bound(problem: Problem) -> tuple[Obligation, ...]:
    """Any bound of the adhesion peaks gives a bound of the stop; the checker says which."""

    def check(proof: str) -> Answer:
        verdict = adhesion_peaks.check(problem, proof)
        return _answer(verdict, verdict.statement)

    return _whole("a shortest stop of any controller", adhesion_peaks.FORMAT, check)


OBLIGATIONS: Mapping[str, Callable[[Problem], tuple[Obligation, ...]]] = {
    "derivation": lambda _problem: _exact(derivation.claims()),
    "surface_hurwitz": _surface_hurwitz,
    "gain_positive": lambda problem: _exact(gain_positive.claims(problem)),
    "well_posed": lambda problem: _all(well_posed.claims(problem)),
    "sliding_exists": _sliding_exists,
    "reaching": _reaching,
    "boundary_layer": _boundary_layer,
    "afsmc_energy": _afsmc_energy,
    "open_loop_pole": _open_loop_pole,
    "no_go": _no_go,
    "routh_lag": _routh_lag,
    "lpv_lyapunov": _lpv_lyapunov,
    "sampled_invariance": _sampled_invariance,
    "stop_bound": _stop_bound,
}
