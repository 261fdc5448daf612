"""What a check has to show, as an object that decides about a proof of it."""

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from typing import Any, Protocol, TypeAlias

from wspd_design.certificates.kernel import checker, exact
from wspd_design.certificates.kernel.claim import Claim, number
from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.kernel.exact import ExactClaim
from wspd_design.certificates.kernel.subdomain import KEY, Ends, stated_part
from wspd_design.certificates.records import Status

Content: TypeAlias = Mapping[str, Any]

DIGITS = 6  # of the ends of a range


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
    denied: Claim | None = None  # an inequality on the whole domain, which the witness of the check denies
    refutation: Callable[[float], str] | None = None  # what a witness shows at its speed [m/s]; or refuses it


def inequality(
    claim: Claim, *, needed: tuple[Status, ...] = (Status.PROVED,), where: str = "", decisive: bool = True
) -> Obligation:
    """A claim of which every bound may be shown; one at least as tight as the claim's is enough.

    ``where`` says in words on which part of the domain it stands. A ``decisive`` one is what the check claims, so that
    its witness denies it; others only suffice for it.
    """
    return Obligation(
        text=statement(claim) + where,
        needed=needed,
        concerns=lambda content: _is_about(claim, content) and KEY not in content,
        check=lambda text: _checked(claim, text, where),
        denied=claim if decisive and Status.PROVED in needed else None,
    )


def on_part(
    claim: Callable[[Ends], Claim],
    quantity: str,
    within: Ends,
    unit: str,
    *,
    needed: tuple[Status, ...],
    longer: bool,
) -> Obligation:
    """A claim on a part of the domain that the proof names; ``longer`` refuses a part that is a single point."""
    everywhere = claim(within)

    def check(text: str) -> Answer:
        low, high = stated_part(json.loads(text), quantity, within)
        if longer and low == high:
            raise Refused(f"the proof speaks about a single {quantity}")
        return _checked(claim((low, high)), text, f" for {quantity} from {_inward(low, high)}{unit}")

    return Obligation(
        text=f"{statement(everywhere)} on a range of {quantity}",
        needed=needed,
        concerns=lambda content: _is_about(everywhere, content) and KEY in content,
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
        shown = stated.statement() + where
    except (KeyError, TypeError, ValueError, OverflowError, ZeroDivisionError):
        raise Refused("the proof states no bound") from None
    tight = stated.bound <= claim.bound if claim.relation == "<=" else stated.bound >= claim.bound
    return answered(checker.check(stated, text), shown, enough=tight)


def answered(verdict: Verdict, shown: str, *, enough: bool = True) -> Answer:
    """Return what a checker says, with what it showed in words."""
    return Answer(
        accepted=verdict.accepted, reason=verdict.reason, leaves=verdict.leaves, shown=shown, enough=enough
    )


def statement(claim: Claim) -> str:
    """Write an inequality in words."""
    return claim.with_bound(f"{float(claim.bound):.6g}")


def inequalities(claims: Iterable[Claim], *, decisive: bool = True) -> tuple[Obligation, ...]:
    """Claims on the whole domain, all of which a proof needs."""
    return tuple(inequality(claim, decisive=decisive) for claim in claims)


def exact_claims(claims: Iterable[ExactClaim]) -> tuple[Obligation, ...]:
    """Claims that need no search."""

    def of(claim: ExactClaim) -> Obligation:
        return Obligation(
            text=claim.statement(),
            concerns=lambda content: (
                (content.get("format"), content.get("claim")) == (exact.FORMAT, claim.name)
            ),
            check=lambda text: answered(exact.check(claim, text), claim.statement()),
        )

    return tuple(of(claim) for claim in claims)


def whole(text: str, form: str, check: Callable[[str], Answer]) -> tuple[Obligation, ...]:
    """A theorem with a checker of its own, whose proof names its form."""
    return (Obligation(text=text, concerns=lambda content: content.get("format") == form, check=check),)


def refutable(text: str, refutation: Callable[[float], str]) -> Obligation:
    """Something that no proof shows, but that a witness denies by its speed alone."""
    return replace(_decided(text), refutation=refutation)


def conditions(*stated: tuple[str, bool]) -> tuple[Obligation, ...]:
    """Conditions that the design alone decides; one that does not hold can be shown by no proof."""
    return tuple(_decided(text) for text, holds in stated if not holds)


def _decided(text: str) -> Obligation:
    refusal = Answer(accepted=False, reason="no proof can show this", leaves=0)
    return Obligation(text=text, concerns=lambda _content: False, check=lambda _text: refusal)
