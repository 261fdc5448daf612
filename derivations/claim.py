"""A claim about one equation of the paper, and the verdicts that follow from what SymPy computed.

The printed form leaves nothing over: holds. It does, and the corrected form does not: misprint. It is right only
under an assumption, without which something is left over: gap, alone or beside a misprint. Nothing to prove:
definition. Nothing to read: lost.
"""

from dataclasses import dataclass
from functools import cache
from types import ModuleType

import sympy as sp

from derivations import unit_check
from derivations.printing import Form, plain
from derivations.unit_check import Units
from wspd_design.parameters.equations import Equation

TORQUE_IS_COMMAND = "T_brake = u: no lag, no pulses (PWM), 0 <= dc <= 1"
FULL_SUPPLY = "P_cin = P_max"


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One equation of the paper, printed and corrected, with what SymPy computed about it.

    ``residual`` is what the printed form leaves over under the assumption, None for a definition.
    ``corrected_residual`` is the same for the corrected form; it has to vanish. ``gap`` is what is left over without
    the ``assumption``; it must not vanish. ``sides`` are the expressions that share a unit, those of the printed form
    unless told otherwise; the units of ``unknown`` symbols are solved for.
    """

    number: str
    title: str
    derivation: ModuleType
    test: str
    printed: Form
    domain: str
    residual: sp.Expr | None = None
    corrected: Form | None = None
    corrected_residual: sp.Expr | None = None
    gap: sp.Expr | None = None
    assumption: str = ""
    certainty: tuple[str, ...] = ()
    remark: str = ""
    functions: tuple[str, ...] = ()
    sides: tuple[sp.Expr, ...] = ()
    unknown: tuple[str, ...] = ()
    keep_angles: bool = False
    lost: bool = False


@cache
def vanishes(residual: sp.Expr) -> bool:
    """Return whether an expression is identically zero."""
    return bool(sp.simplify(residual) == 0)


def verdicts(claim: Claim) -> tuple[str, ...]:
    """Judge a claim by its residuals alone.

    Raises
    ------
    ValueError
        If what is claimed is not what was computed.
    """
    if claim.corrected_residual is not None and not vanishes(claim.corrected_residual):
        raise ValueError(f"({claim.number}): the corrected form leaves {claim.corrected_residual}")
    if bool(claim.assumption) != (claim.gap is not None):
        raise ValueError(
            f"({claim.number}): an assumption needs what is left over without it, and the reverse"
        )
    if claim.gap is not None and vanishes(claim.gap):
        raise ValueError(f"({claim.number}) holds without the assumption {claim.assumption}")
    gap = ("gap",) if claim.gap is not None else ()
    if claim.lost:
        return ("lost",)
    if claim.residual is None:
        return gap or ("definition",)
    if vanishes(claim.residual):
        return gap or ("holds",)
    if claim.corrected is None or claim.corrected_residual is None:
        raise ValueError(f"({claim.number}) is wrong as printed, and no corrected form is shown to be right")
    return ("misprint", *gap)


def units(claim: Claim) -> Units:
    """Check the units of a claim; an entry without an equation has none."""
    sides = claim.sides or claim.printed.sides
    if not sides:
        return Units("", "", {})
    return unit_check.check(sides, claim.unknown, keep_angles=claim.keep_angles)


def certainty(claim: Claim, found: tuple[str, ...]) -> tuple[str, ...]:
    """Return how sure a correction is.

    Raises
    ------
    ValueError
        If a misprint does not say how sure its correction is, or calls proved what nothing proves.
    """
    how = set(claim.certainty) & {"proved", "inferred"}
    if "misprint" in found and len(how) != 1:
        raise ValueError(f"({claim.number}): is the correction proved or inferred?")
    if "proved" in how and claim.corrected_residual is None and not units(claim).fault:
        raise ValueError(f"({claim.number}): nothing proves the correction")
    return claim.certainty


def equation(claim: Claim) -> Equation:
    """Return the record of the equation map for one claim."""
    found = verdicts(claim)
    checked = units(claim)
    zero = claim.residual is not None and vanishes(claim.residual)
    residual = "" if claim.residual is None else "0" if zero else plain(claim.residual)
    solved = "".join(f"; {plain(sp.Symbol(name))} in {unit}" for name, unit in checked.solved.items())
    corrected = claim.corrected or Form("")
    return Equation(
        number=claim.number,
        title=claim.title,
        verdicts=found,
        certainty=certainty(claim, found),
        domain=claim.domain,
        unit=checked.unit + solved,
        unit_fault=checked.fault,
        printed=claim.printed.plain,
        corrected=corrected.plain,
        residual=residual,
        gap="" if claim.gap is None else plain(claim.gap),
        assumption=claim.assumption,
        remark=claim.remark,
        file=f"derivations/{claim.derivation.__name__.rpartition('.')[2]}.py",
        functions=claim.functions,
        test=f"tests/paper/{claim.test}",
        typst_printed=claim.printed.typst,
        typst_corrected=corrected.typst,
    )
