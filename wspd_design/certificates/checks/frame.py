"""What all checks share: a search for what a theorem needs, and the plots beside the verdict."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.kernel.obligation import Obligation
from wspd_design.certificates.memory import remembering
from wspd_design.certificates.records import Certificate, Map, Problem, Role, Series
from wspd_design.certificates.replay import decided
from wspd_design.certificates.theorems.theorem import Theorem, asked, told

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MOST_PLOT_POINTS = 500


class Figures(NamedTuple):
    """What samples show beside a verdict; none of it is proved."""

    series: tuple[Series, ...] = ()
    maps: tuple[Map, ...] = ()
    remark: str = ""


def no_figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - a check without plots
    """Show nothing."""
    return Figures()


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """A theorem with the search that finds what it needs, and the plots of its verdict."""

    theorem: Theorem
    search: Callable[[Problem], Mapping[str, Stated]]
    figures: Callable[[Problem, Certificate], Figures] = no_figures

    @property
    def name(self) -> str:
        """Name of the theorem."""
        return self.theorem.name

    def run(self, problem: Problem, *, figures: bool = True) -> Certificate:
        """Search, let the checkers decide about what was found, and tell; with plots, if they are wanted."""
        started = time.perf_counter()
        wanted = asked(self.theorem, problem)
        if isinstance(wanted, Certificate):
            return replace(wanted, seconds=time.perf_counter() - started)
        with remembering():
            made = told(self.theorem, problem, accepted(wanted, self.search(problem)))
            made = illustrated(self, problem, made) if figures else made
        return replace(made, seconds=time.perf_counter() - started)


def accepted(wanted: Sequence[Obligation], stated: Mapping[str, Stated]) -> dict[str, Finding]:
    """Let the checkers decide about what a search states; a proof that they refuse is left out.

    What they decided about the same inequality before, in the same verification, is not decided again.
    """
    work = Work()

    def decide(obligation: Obligation, given: Stated) -> Finding:
        left = work.left
        try:
            return obligation.decide(given, work)
        except Refused:
            work.left = left  # no file holds the proof, so that it costs nothing
            return obligation.decide(replace(given, proof=None), work)

    found = {each.key: (each, stated.get(each.key, Stated())) for each in wanted}
    return {key: decided("accept", *each, partial(decide, *each)) for key, each in found.items()}


def illustrated(check: Check, problem: Problem, certificate: Certificate) -> Certificate:
    """Add the plots and the remark of a check."""
    figures = check.figures(problem, certificate)
    return replace(certificate, series=figures.series, maps=figures.maps, remark=figures.remark)


def series(
    name: str,
    x_label: str,
    y_label: str,
    x: "NDArray[np.float64]",
    y: "NDArray[np.float64]",
    role: Role = Role.CURVE,
) -> Series:
    """Keep as many samples of a curve as a plot can show."""
    step = max(1, -(-len(x) // MOST_PLOT_POINTS))
    keep = [*range(0, len(x) - 1, step), len(x) - 1]
    return Series(
        name=name,
        x_label=x_label,
        y_label=y_label,
        x=tuple(float(x[i]) for i in keep),
        y=tuple(float(y[i]) for i in keep),
        role=role,
    )


def level(
    name: str, x_label: str, y_label: str, x: "NDArray[np.float64] | Sequence[float]", value: float
) -> Series:
    """Return a horizontal line, the limit that a curve must respect."""
    return Series(
        name=name,
        x_label=x_label,
        y_label=y_label,
        x=(float(x[0]), float(x[-1])),
        y=(value, value),
        role=Role.LIMIT,
    )
