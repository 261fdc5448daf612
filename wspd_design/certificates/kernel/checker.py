"""The checker: replays a split tree and believes nothing that it did not compute itself.

It uses the standard library, SymPy's exact numbers and python-flint alone. The claim comes from the caller, never
from the certificate. The certificate holds a tree in preorder, one character per step:

* ``a``, ``b``, ...: the box is halved along the first, second, ... free variable; the lower half comes first;
* ``A``, ``B``, ...: the expression is monotone in this variable on the box, which is reduced to its worst face;
* ``.``: interval arithmetic shows the inequality on the box;
* ``~``: the mean value form shows it.
"""

import json
import time
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, TypeAlias

import flint

from wspd_design.certificates.kernel.claim import Claim, number
from wspd_design.certificates.kernel.enclosures import Ends, Program, Refused, add, exactly, finite, mul
from wspd_design.certificates.kernel.identity import same

FORMAT = "wspd-proof/1"
PRECISION = 80  # bits
MOST_STEPS = 400_000
MOST_HALVINGS = 400  # of one box
MOST_BYTES = 4_000_000

Box: TypeAlias = list[tuple[Any, Any]]
"""Exact ends of every variable (``fmpq``)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What the checker says."""

    accepted: bool
    statement: str = ""  # that was shown
    reason: str
    leaves: int
    seconds: float


def check(claim: Claim, certificate: str, *, seconds: float = 60.0) -> Verdict:
    """Decide whether a certificate proves a claim.

    Parameters
    ----------
    claim : Claim
        What is to be shown, from the problem. The certificate may show a tighter bound.
    certificate : str
        JSON text; it may be anything.
    seconds : float
        A longer check is refused [s].
    """
    started = time.perf_counter()
    leaves, statement, reason = 0, "", "every box of the tree satisfies the inequality"
    try:
        claim, tree = _read(claim, certificate)
        if claim.form is not None and not same(claim.formula(), claim.definition()):
            raise Refused("the arranged form of the expression is not the model's")
        with flint.ctx.workprec(PRECISION):
            leaves = _replay(claim, tree, started + seconds)
        statement = claim.statement()
    except Refused as refusal:
        reason = str(refusal)
    taken = time.perf_counter() - started
    return Verdict(accepted=leaves > 0, statement=statement, reason=reason, leaves=leaves, seconds=taken)


def value(claim: Claim, point: dict[str, Fraction]) -> tuple[Fraction, Fraction]:
    """Enclose the expression, as the model's kernels have it, at one point of the box.

    Where the kernels divide by zero, the arranged form stands for their limit.

    Parameters
    ----------
    claim : Claim
        Its bound does not matter.
    point : dict
        Exact value of every free variable, by name.

    Raises
    ------
    Refused
        If the point does not lie in the box, or the expression is not defined there.
    """
    box: Box = []
    for v in claim.variables:
        at = point[v.name] if v.free else v.low
        if not v.low <= at <= v.high:
            raise Refused(f"{v.name} = {float(at):g} lies outside the box")
        box.append((_fmpq(at), _fmpq(at)))
    with flint.ctx.workprec(PRECISION):
        found, _ = Program(claim.definition(), claim.variables).run(_ends(box))
        if not finite(found) and same(claim.formula(), claim.definition()):
            found, _ = Program(claim.formula(), claim.variables).run(_ends(box))
        if not finite(found):
            raise Refused("the expression is not defined at this point")
        return _rational(found[0].lower()), _rational(found[1].upper())


def _read(claim: Claim, certificate: str) -> tuple[Claim, str]:
    """Return the claim with the bound that the certificate shows, and the tree; or refuse."""
    if len(certificate) > MOST_BYTES:
        raise Refused("the certificate is too long")
    try:
        content = json.loads(certificate)
        form, stated, tree = content["format"], content["claim_sha256"], content["tree"]
        shown = replace(claim, bound=number(content["bound"]))
    except (KeyError, TypeError, ValueError, ArithmeticError, RecursionError):
        raise Refused(f"the certificate does not have the format {FORMAT}, with a bound and a tree") from None
    if form != FORMAT:
        raise Refused(f"the certificate does not have the format {FORMAT}")
    if (shown.bound > claim.bound) if claim.relation == "<=" else (shown.bound < claim.bound):
        raise Refused("the certificate shows less than is claimed")
    if stated != shown.digest():
        raise Refused("the certificate belongs to another claim")
    if not isinstance(tree, str) or len(tree) > MOST_STEPS:
        raise Refused("the certificate has no tree, or one that is too long")
    return shown, tree


def _replay(claim: Claim, tree: str, deadline: float) -> int:
    """Walk the tree and return the number of leaves, or refuse."""
    program = Program(claim.formula(), claim.variables)
    letters = {chr(ord("a") + i): k for i, k in enumerate(program.free)}
    root: Box = [(_fmpq(v.low), _fmpq(v.high)) for v in claim.variables]
    waiting: list[tuple[Box, int, list[Ends] | None]] = [(root, 0, None)]
    leaves = 0
    for position, step in enumerate(tree):
        if not waiting:
            raise Refused(f"the tree goes on after its last leaf, at step {position}")
        if time.perf_counter() > deadline:
            raise Refused("the check takes too long")
        box, halvings, slopes = waiting.pop()
        if step in ".~":
            if not _holds(claim, program, box, mean_value=step == "~"):
                raise Refused(f"leaf {leaves} does not satisfy the inequality")
            leaves += 1
        elif step in letters:
            if halvings >= MOST_HALVINGS:
                raise Refused(f"a box is halved more than {MOST_HALVINGS} times")
            low, high = box[letters[step]]
            middle = (low + high) / 2
            for half in ((middle, high), (low, middle)):
                waiting.append((_replaced(box, letters[step], half), halvings + 1, slopes))
        elif step.lower() in letters and step.isupper():
            face, slopes = _worst_face(claim, program, box, letters[step.lower()], slopes)
            waiting.append((face, halvings, slopes))
        else:
            raise Refused(f"the tree has an unknown step at {position}")
    if waiting:
        raise Refused("the tree ends before all boxes are decided")
    return leaves


def _holds(claim: Claim, program: Program, box: Box, *, mean_value: bool) -> bool:
    """Whether the inequality is certain on a box."""
    if mean_value:
        slopes = _slopes(program, box)
        middles = [(low + high) / 2 for low, high in box]
        found, _ = program.run(_ends([(middle, middle) for middle in middles]))
        for k in program.free:
            reach = [(low - middles[k], high - middles[k]) for low, high in box[k : k + 1]]
            found = add(found, mul(slopes[k], *_ends(reach)))
    else:
        found, _ = program.run(_ends(box))
    bound, _ = exactly(claim.bound)
    return finite(found) and bool(found[1] <= bound if claim.relation == "<=" else found[0] >= bound)


def _worst_face(
    claim: Claim, program: Program, box: Box, k: int, slopes: list[Ends] | None
) -> tuple[Box, list[Ends]]:
    """Reduce a box to the end of one variable where the inequality is tightest.

    Slopes that were enclosed on a larger box hold here as well; only if they leave the sign open they are enclosed
    anew.
    """
    if slopes is None or _sign(slopes[k]) == 0:
        slopes = _slopes(program, box)
    sign = _sign(slopes[k])
    if sign == 0:
        raise Refused(f"the expression is not monotone in {claim.variables[k].name} on a box")
    end = box[k][1] if (sign > 0) == (claim.relation == "<=") else box[k][0]
    return _replaced(box, k, (end, end)), slopes


def _slopes(program: Program, box: Box) -> list[Ends]:
    """Enclose the slopes on a box on which the expression is defined."""
    found, slopes = program.run(_ends(box), derivatives=True)
    if not finite(found):
        raise Refused("the expression is not defined on a box where its slope is used")
    return slopes


def _sign(x: Ends) -> int:
    """1 or -1 if an interval certainly has no number of the other sign, else 0."""
    return 1 if x[0] >= 0 else -1 if x[1] <= 0 else 0


def _replaced(box: Box, k: int, ends: tuple[Any, Any]) -> Box:
    return [*box[:k], ends, *box[k + 1 :]]


def _ends(box: Box) -> list[Ends]:
    return [(flint.arb(low), flint.arb(high)) for low, high in box]


def _fmpq(number: Fraction) -> Any:
    return flint.fmpq(number.numerator, number.denominator)


def _rational(point: Any) -> Fraction:
    """Return the exact value of a ball without radius."""
    mantissa, exponent = point.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
