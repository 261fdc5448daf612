"""Decides about a certificate file: rebuilds what its check has to show from the design, and asks the checkers.

Only where a check chooses a part of the domain by a search is the prover needed, to search it again. What a check has
to show stands in ``OBLIGATIONS``.
"""

import json
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Protocol, TypeAlias

from wspd_design.certificates import (
    afsmc_energy,
    laws,
    no_go,
    open_loop_pole,
    quadratic,
    reaching,
    routh_lag,
    sliding_exists,
    well_posed,
)
from wspd_design.certificates.certificate_file import read_certificate
from wspd_design.certificates.invariance import checker as invariance
from wspd_design.certificates.invariance.runs import FORMAT
from wspd_design.certificates.linear_loop import LinearLaw
from wspd_design.certificates.proof import checker
from wspd_design.certificates.proof.balls import Refused
from wspd_design.certificates.proof.claim import Claim, number
from wspd_design.certificates.records import Problem, Status
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode

Content: TypeAlias = Mapping[str, Any]


class Answer(Protocol):
    """What a checker says about a proof."""

    @property
    def accepted(self) -> bool:
        """Whether it is one."""

    @property
    def reason(self) -> str:
        """Why."""

    @property
    def leaves(self) -> int:
        """How many boxes it decided."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Obligation:
    """Something that a check shows, rebuilt from the design.

    A proof of an inequality may show a looser bound than the check needs: it then says something true, but does not
    meet the obligation.
    """

    text: str
    needed: bool  # for the check to be proved; what is not needed encloses a number
    concerns: Callable[[Content], bool]  # whether a proof is about this
    check: Callable[[str], Answer]
    meets: Callable[[Content], bool]  # whether an accepted proof shows enough
    shows: Callable[[Content], str]  # what an accepted proof shows, in words


@dataclass(frozen=True, slots=True, kw_only=True)
class Replayed:
    """What the checker says about a file."""

    check: str  # name, empty if the file tells none
    accepted: bool  # every proof in it, and all that its status needs
    reason: str
    shown: tuple[str, ...]  # statements that were proved
    missing: tuple[str, ...]  # statements that the check needs and the file does not show
    leaves: int
    seconds: float


def replay(problem: Problem, text: str) -> Replayed:
    """Decide whether the proofs of a certificate file hold for a closed loop.

    Parameters
    ----------
    problem : Problem
        The closed loop and domain that the claims are taken from.
    text : str
        The file; it may be anything.
    """
    started = time.perf_counter()
    name, leaves = "", 0
    shown: list[str] = []
    missing: list[str] = []
    try:
        stated = read_certificate(text)
        name = stated.check
        wanted = obligations(name, problem)
        done: set[str] = set()
        for proof in stated.proofs:
            met, answer = _decide(name, wanted, proof)
            content = json.loads(proof)
            if met.meets(content):
                done.add(met.text)
            shown.append(met.shows(content))
            leaves += answer.leaves
        missing = [each.text for each in wanted if each.needed and each.text not in done]
        if missing and stated.status is Status.PROVED:
            raise Refused(f"no proof of {'; '.join(missing)}")
        accepted, reason = True, "every proof holds for this design"
    except Refused as refusal:
        accepted, reason = False, str(refusal)
    return Replayed(
        check=name,
        accepted=accepted,
        reason=reason,
        shown=tuple(shown),
        missing=tuple(missing),
        leaves=leaves,
        seconds=time.perf_counter() - started,
    )


def _decide(name: str, wanted: tuple[Obligation, ...], proof: str) -> tuple[Obligation, Answer]:
    """Find what a proof shows, or refuse it."""
    content = json.loads(proof)
    concerned = [each for each in wanted if isinstance(content, dict) and each.concerns(content)]
    reason = f"a proof shows nothing that {name} needs"
    for each in concerned:
        answer = each.check(proof)
        if answer.accepted:
            return each, answer
        reason = f"{each.text}: {answer.reason}"
    raise Refused(reason)


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
    claim: Claim, *, needed: bool = True, where: str = "", box: Callable[[], Claim] | None = None
) -> Obligation:
    """A claim of which every bound may be shown; one at least as tight as the claim's meets it.

    ``where`` says on which part of the domain it stands; ``box`` searches that part, if that takes long.
    """
    return Obligation(
        text=_statement(claim) + where,
        needed=needed,
        concerns=lambda content: (
            (content.get("claim"), content.get("relation")) == (claim.name, claim.relation)
        ),
        check=lambda text: checker.check(_as_stated(box() if box else claim, json.loads(text)), text),
        meets=lambda content: _as_tight(claim, number(content["bound"])),
        shows=lambda content: _statement(_as_stated(claim, content)) + where,
    )


def _as_stated(claim: Claim, content: Content) -> Claim:
    try:
        return replace(claim, bound=number(content["bound"]))
    except (KeyError, TypeError, ValueError, OverflowError, ZeroDivisionError):
        raise Refused("the proof states no bound") from None


def _as_tight(claim: Claim, bound: Fraction) -> bool:
    return bound <= claim.bound if claim.relation == "<=" else bound >= claim.bound


def _statement(claim: Claim) -> str:
    return f"{claim.name} {claim.relation} {float(claim.bound):.6g} {claim.unit}".removesuffix(" -")


def _all(claims: Iterable[Claim]) -> tuple[Obligation, ...]:
    return tuple(_inequality(claim) for claim in claims)


def _whole(text: str, form: str, check: Callable[[str], Answer]) -> tuple[Obligation, ...]:
    """A theorem with a checker of its own, whose proof names its form."""
    return (
        Obligation(
            text=text,
            needed=True,
            concerns=lambda content: content.get("format") == form,
            check=check,
            meets=lambda _content: True,
            shows=lambda _content: text,
        ),
    )


def _strange(problem: Problem, name: str) -> Refused:
    return Refused(f"{name} does not speak about the law of {problem.controller.name}")


def _reaching(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, SlidingMode):
        raise _strange(problem, "reaching")
    return _all(reaching.claims(problem, problem.controller))


def _open_loop_pole(problem: Problem) -> tuple[Obligation, ...]:
    limit = 1.0 / open_loop_pole.shortest_lag(problem)
    return (
        _inequality(open_loop_pole.pole_claim(problem, "<=", limit)),
        _inequality(open_loop_pole.pole_claim(problem, ">=", limit), needed=False),
    )


def _no_go(problem: Problem) -> tuple[Obligation, ...]:
    """The interval of speeds is searched again; whatever it is, the checker decides about it."""
    limit = 1.0 / open_loop_pole.shortest_lag(problem)
    interval = no_go.widest_interval(problem, limit)
    low, high = interval or problem.speeds
    claim = no_go.interval_claim(problem, limit, (low, high), ">=" if interval else "<=")
    return (_inequality(claim, where=f" from {low:.4g} to {high:.4g} m/s"),)


def _sliding_exists(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, laws.SlipLaw):
        raise _strange(problem, "sliding_exists")
    limit = problem.vehicle.brake.max_torque
    enough = sliding_exists.torque_claim(problem, law, "<=", limit)

    def slippery() -> Claim:
        """Search the friction below which the brake suffices again, which needs the prover."""
        friction = sliding_exists.largest_friction(problem, law)
        if friction is None:
            raise Refused("the brake suffices at no friction")
        span = min(friction[0], problem.mu0_bounds[0]), friction[0]
        return sliding_exists.torque_claim(problem, law, "<=", limit, mu0=span)

    return (
        _inequality(sliding_exists.torque_claim(problem, law, ">=", 0.0)),
        _inequality(enough, needed=False),
        _inequality(enough, needed=False, where=" up to the largest mu0 for which it holds", box=slippery),
    )


def _afsmc_energy(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, AdaptiveFuzzy):
        raise _strange(problem, "afsmc_energy")
    return _all(afsmc_energy.claims(problem, problem.controller))


def _routh_lag(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, LinearLaw):
        raise _strange(problem, "routh_lag")
    return _all(routh_lag.claims(problem, problem.controller))


def _lpv_lyapunov(problem: Problem) -> tuple[Obligation, ...]:
    text = "one quadratic function falls along the continuous and the sampled loop"
    return _whole(text, quadratic.FORMAT, lambda proof: quadratic.check_quadratic(proof, problem))


def _sampled_invariance(problem: Problem) -> tuple[Obligation, ...]:
    text = "one sample maps the sets of slip and torque into themselves at all speeds"
    return _whole(text, FORMAT, lambda proof: invariance.check(problem, proof))


OBLIGATIONS: Mapping[str, Callable[[Problem], tuple[Obligation, ...]]] = {
    "well_posed": lambda problem: _all(well_posed.claims(problem)),
    "sliding_exists": _sliding_exists,
    "reaching": _reaching,
    "boundary_layer": _reaching,  # it rests on the same inequalities
    "afsmc_energy": _afsmc_energy,
    "open_loop_pole": _open_loop_pole,
    "no_go": _no_go,
    "routh_lag": _routh_lag,
    "lpv_lyapunov": _lpv_lyapunov,
    "sampled_invariance": _sampled_invariance,
}
