"""The equation map: what became of every numbered equation of the paper.

The map is computed by the SymPy derivations at development time and shipped as data.
"""

import tomllib
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

VERDICTS = ("holds", "misprint", "gap", "definition", "lost")


@dataclass(frozen=True, slots=True, kw_only=True)
class Equation:
    """One equation or table of the paper with what was found out about it.

    Attributes
    ----------
    verdicts : tuple of str
        One or two of ``holds``, ``misprint`` (the corrected form is given), ``gap`` (true only under an assumption
        that the paper does not state where it is needed), ``definition`` and ``lost`` (the text at hand does not
        show it). A misprint whose corrected form needs such an assumption has two.
    certainty : tuple of str
        How sure the correction is: ``proved`` (it follows from the paper's other equations or from units) or
        ``inferred`` (our reading; others are possible). ``scan`` in addition: one glyph differs, which the scan at
        hand may have lost, so that the paper itself may be right. Empty without a correction.
    domain : str
        Where the entry is meant to hold.
    unit, unit_fault : str
        Unit of both sides, with those of the unknowns that it determines; or what the check of units finds wrong.
    residual : str
        What the printed form leaves over: 0 where the equation holds, empty for a definition.
    gap : str
        What is left over where the assumption fails.
    """

    number: str
    title: str
    verdicts: tuple[str, ...]
    certainty: tuple[str, ...]
    domain: str
    unit: str
    unit_fault: str
    printed: str
    corrected: str
    residual: str
    gap: str
    assumption: str
    remark: str
    file: str
    functions: tuple[str, ...]
    test: str
    typst_printed: str
    typst_corrected: str

    @property
    def verdict(self) -> str:
        """The verdicts as one text."""
        return ", ".join(self.verdicts)


def load_equations() -> tuple[Equation, ...]:
    """Return the equation map of the paper, in the order of the paper.

    Returns
    -------
    tuple of Equation
        Equations (1) to (49), the damping B_W, the disturbing torque T_d, the duties of Section 4.2, and Tables 1 to
        5, 9 and 10.
    """
    text = files("wspd_design").joinpath("data", "equations.toml").read_text(encoding="utf-8")
    return tuple(_equation(entry) for entry in tomllib.loads(text)["equation"])


def _equation(entry: dict[str, Any]) -> Equation:
    fields: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()
    }
    return Equation(**fields)
