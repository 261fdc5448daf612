"""The equation map: what became of every numbered equation of the paper.

The map is computed by the SymPy derivations at development time and shipped as data.
"""

import tomllib
from dataclasses import dataclass
from importlib.resources import files


@dataclass(frozen=True, slots=True, kw_only=True)
class Equation:
    """One equation or table of the paper with its verdict.

    The verdict is ``holds``, ``misprint`` (the corrected form is given), ``gap`` (true only under an
    assumption that the paper does not state) or ``definition``. The residual is what the printed form leaves
    over; it is 0 where the equation holds.
    """

    number: str
    title: str
    verdict: str
    printed: str
    corrected: str
    residual: str
    assumption: str
    remark: str
    file: str
    functions: tuple[str, ...]
    test: str
    typst_printed: str
    typst_corrected: str


def load_equations() -> tuple[Equation, ...]:
    """Return the equation map of the paper, in the order of the paper.

    Returns
    -------
    tuple of Equation
        Equations (1) to (49), the damping B_W, and Tables 3, 5, 9 and 10.
    """
    text = files("wspd_design").joinpath("data", "equations.toml").read_text(encoding="utf-8")
    return tuple(
        Equation(**{**entry, "functions": tuple(entry["functions"])})
        for entry in tomllib.loads(text)["equation"]
    )
