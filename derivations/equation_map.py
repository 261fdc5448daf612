"""The equation map: each verdict follows from the residual that SymPy finds for the printed form.

Zero: holds. Not zero, but zero for the corrected form: misprint. Not zero, and zero
(if at all) only under an assumption that the paper does not state: gap. Nothing to prove: definition.
"""

from dataclasses import dataclass
from types import ModuleType

import sympy as sp

from derivations.printing import Form, plain
from wspd_design.parameters.equations import Equation


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One equation of the paper, printed and corrected, with what SymPy computed about it.

    ``residual`` is what the printed form leaves over, None for a definition. ``corrected_residual`` is the
    same for the corrected form, or for the printed form under ``assumption``; it has to vanish.
    """

    number: str
    title: str
    derivation: ModuleType
    test: str
    printed: Form
    residual: sp.Expr | None = None
    corrected: Form | None = None
    corrected_residual: sp.Expr | None = None
    assumption: str = ""
    remark: str = ""
    functions: tuple[str, ...] = ()


def vanishes(residual: sp.Expr) -> bool:
    """Return whether an expression is identically zero."""
    return bool(sp.simplify(residual) == 0)


def verdict(claim: Claim) -> str:
    """Judge a claim by its residuals alone."""
    if claim.corrected_residual is not None and not vanishes(claim.corrected_residual):
        raise ValueError(f"({claim.number}): the corrected form leaves {claim.corrected_residual}")
    if claim.residual is None:
        return "definition"
    if vanishes(claim.residual):
        return "holds"
    if claim.assumption:
        return "gap"
    if claim.corrected is None or claim.corrected_residual is None:
        raise ValueError(f"({claim.number}) is wrong as printed, and no corrected form is shown to be right")
    return "misprint"


def equation(claim: Claim) -> Equation:
    """Return the record of the equation map for one claim."""
    found = verdict(claim)
    residual = "" if claim.residual is None else "0" if found == "holds" else plain(claim.residual)
    corrected = claim.corrected or Form("")
    return Equation(
        number=claim.number,
        title=claim.title,
        verdict=found,
        printed=claim.printed.plain,
        corrected=corrected.plain,
        residual=residual,
        assumption=claim.assumption,
        remark=claim.remark,
        file=f"derivations/{claim.derivation.__name__.rpartition('.')[2]}.py",
        functions=claim.functions,
        test=f"tests/paper/{claim.test}",
        typst_printed=claim.printed.typst,
        typst_corrected=corrected.typst,
    )


def equations() -> tuple[Equation, ...]:
    """Return the whole map in the order of the paper."""
    from derivations.claims import brake, convergence, fuzzy, model, sliding, track

    return tuple(
        equation(claim)
        for part in (model, brake, sliding, fuzzy, convergence, track)
        for claim in part.CLAIMS
    )
