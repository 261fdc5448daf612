"""The checker alone: rebuilds the claims of a check from the design and decides about the proofs of a file.

It needs neither the prover nor CasADi. What a check has to show stands in ``OBLIGATIONS``.
"""

import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, TypeAlias

from wspd_design.certificates import no_go, open_loop_pole, quadratic, reaching, sliding_exists, well_posed
from wspd_design.certificates.certificate_file import read_certificate
from wspd_design.certificates.laws import SlipLaw
from wspd_design.certificates.proof import checker
from wspd_design.certificates.proof.balls import Refused
from wspd_design.certificates.proof.checker import Verdict
from wspd_design.certificates.proof.claim import Claim, number
from wspd_design.certificates.records import Problem, Status
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.controllers.torque_feedback import TorqueFeedback

Content: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Obligation:
    """Something that a check shows, rebuilt from the design.

    A proof of an inequality may show a looser bound than the check needs: it then says something true, but does not
    meet the obligation.
    """

    text: str
    needed: bool  # for the check to be proved; what is not needed encloses a number
    concerns: Callable[[Content], bool]  # whether a proof is about this
    check: Callable[[str], Verdict]
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
            met, verdict = _decide(name, wanted, proof)
            content = json.loads(proof)
            if met.meets(content):
                done.add(met.text)
            shown.append(met.shows(content))
            leaves += verdict.leaves
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


def _decide(name: str, wanted: tuple[Obligation, ...], proof: str) -> tuple[Obligation, Verdict]:
    """Find what a proof shows, or refuse it."""
    content = json.loads(proof)
    concerned = [each for each in wanted if isinstance(content, dict) and each.concerns(content)]
    reason = f"a proof shows nothing that {name} needs"
    for each in concerned:
        verdict = each.check(proof)
        if verdict.accepted:
            return each, verdict
        reason = f"{each.text}: {verdict.reason}"
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


def _reaching(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, SlidingMode):
        raise Refused("the design has no switching gain, so that reaching does not speak about it")
    return tuple(_inequality(claim) for claim in reaching.claims(problem, problem.controller))


def _open_loop_pole(problem: Problem) -> tuple[Obligation, ...]:
    limit = 1.0 / open_loop_pole.shortest_lag(problem)
    return (
        _inequality(open_loop_pole.pole_claim(problem, "<=", limit)),
        _inequality(open_loop_pole.pole_claim(problem, ">=", limit), needed=False),
    )


def _well_posed(problem: Problem) -> tuple[Obligation, ...]:
    return tuple(_inequality(claim) for claim in well_posed.claims(problem))


def _no_go(problem: Problem) -> tuple[Obligation, ...]:
    """The interval of speeds is searched again; whatever it is, the checker decides about it."""
    limit = 1.0 / open_loop_pole.shortest_lag(problem)
    interval = no_go.widest_interval(problem, limit)
    low, high = interval or problem.speeds
    claim = no_go.interval_claim(problem, limit, (low, high), ">=" if interval else "<=")
    return (_inequality(claim, where=f" from {low:.4g} to {high:.4g} m/s"),)


def _sliding_exists(problem: Problem) -> tuple[Obligation, ...]:
    law = problem.controller
    if not isinstance(law, SlipLaw):
        raise Refused("the design has no sliding surface, so that sliding_exists does not speak about it")
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


def _lpv_lyapunov(problem: Problem) -> tuple[Obligation, ...]:
    if not isinstance(problem.controller, TorqueFeedback):
        raise Refused("the design feeds back no torque, so that lpv_lyapunov does not speak about it")
    text = "one quadratic function falls along the continuous and the sampled loop"
    return (
        Obligation(
            text=text,
            needed=True,
            concerns=lambda content: content.get("format") == quadratic.FORMAT,
            check=lambda proof: quadratic.check_quadratic(proof, problem),
            meets=lambda _content: True,
            shows=lambda _content: text,
        ),
    )


OBLIGATIONS: Mapping[str, Callable[[Problem], tuple[Obligation, ...]]] = {
    "well_posed": _well_posed,
    "sliding_exists": _sliding_exists,
    "reaching": _reaching,
    "boundary_layer": _reaching,  # it rests on the same inequalities
    "no_go": _no_go,
    "open_loop_pole": _open_loop_pole,
    "lpv_lyapunov": _lpv_lyapunov,
}
