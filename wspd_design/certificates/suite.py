"""All checks of a closed loop, in the order in which an argument would use them."""

from collections.abc import Callable, Collection
from difflib import get_close_matches

from wspd_design.certificates.checks.adaptive import (
    afsmc_energy,
    barbalat,
    lyapunov_printed,
    lyapunov_repaired,
)
from wspd_design.certificates.checks.foundations import (
    conservation,
    derivation,
    gain_positive,
    surface_hurwitz,
    well_posed,
)
from wspd_design.certificates.checks.linear import margins, routh_lag
from wspd_design.certificates.checks.region import lpv_lyapunov, sampled_invariance
from wspd_design.certificates.checks.sliding import boundary_layer, lyapunov_surface, reaching, sliding_exists
from wspd_design.certificates.checks.stop import stop_bound, tracking
from wspd_design.certificates.checks.valve import hard_limits, no_go, open_loop_pole, sampling
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.progress import Listener, listening
from wspd_design.certificates.search.prover import DEFAULT_BUDGET, Budget, within
from wspd_design.certificates.setting.linear_loop import LinearLaw
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.parameters.errors import UserError

MODULES = (
    derivation,
    surface_hurwitz,
    gain_positive,
    well_posed,
    sliding_exists,
    reaching,
    boundary_layer,
    lyapunov_surface,
    lyapunov_printed,
    lyapunov_repaired,
    afsmc_energy,
    barbalat,
    open_loop_pole,
    no_go,
    hard_limits,
    sampling,
    routh_lag,
    margins,
    lpv_lyapunov,
    sampled_invariance,
    tracking,
    conservation,
    stop_bound,
)
NAMES = tuple(module.NAME for module in MODULES)


def verify(
    problem: Problem,
    *,
    only: Collection[str] | None = None,
    progress: Callable[[str], None] = lambda _: None,
    budget: Budget = DEFAULT_BUDGET,
) -> tuple[Certificate, ...]:
    """Run the checks.

    Parameters
    ----------
    problem : Problem
        Closed loop and domain.
    only : collection of str, optional
        Names of the checks to run, from :data:`NAMES`; all by default.
    progress : callable, optional
        Told the title of each check before it starts, and while it searches how far it has come.
    budget : Budget, optional
        Of each search on boxes; a claim on which it is used up stays undecided.

    Returns
    -------
    tuple of Certificate
        In the order of :data:`NAMES`.

    Raises
    ------
    UserError
        If a name is unknown, or problem and controller state different references, sample times or wheel radii.
    """
    for name in only or ():
        if name not in NAMES:
            near = get_close_matches(name, NAMES, n=1)
            offer = f', did you mean "{near[0]}"?' if near else ""
            raise UserError(f'unknown check "{name}"{offer}; available: {", ".join(NAMES)}')
    _agree("sample time", problem.sample_time, problem.controller.sample_time)
    if isinstance(problem.controller, LinearLaw):
        _agree("slip reference", problem.slip, problem.controller.gains.slip_reference)
        _agree("wheel radius", problem.vehicle.wheel_radius, _wheel_radius(problem.controller))
    certificates = []
    for module in MODULES:
        if only is None or module.NAME in only:
            progress(module.TITLE)
            with listening(_at(module.TITLE, progress)), within(budget):
                certificates.append(module.check(problem))
    return tuple(certificates)


def _wheel_radius(law: LinearLaw) -> float:
    """Return the radius from which a law works out its slip [m]."""
    return law.wheel_radius if isinstance(law, AdaptiveFuzzy) else law.vehicle.wheel_radius


def _at(title: str, progress: Callable[[str], None]) -> Listener:
    return lambda share: progress(f"{title}: {share:.0%} of the box decided")


def _agree(name: str, stated: float, used: float) -> None:
    """Refuse a problem that speaks about another loop than its controller."""
    if stated != used:
        raise UserError(f"the problem states {name} {stated:g}, its controller {used:g}; make them the same")
