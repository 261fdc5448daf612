"""All checks of a closed loop: run them, or take what was proved before and is accepted again."""

from collections.abc import Callable, Collection, Mapping
from pathlib import Path

from wspd_design.certificates.checks.adaptive import (
    afsmc_energy,
    barbalat,
    lyapunov_printed,
    lyapunov_repaired,
)
from wspd_design.certificates.checks.foundations import (
    conservation,
    derivation,
    feedback,
    gain_positive,
    surface_hurwitz,
    well_posed,
)
from wspd_design.certificates.checks.frame import Check, illustrated
from wspd_design.certificates.checks.linear import margins, routh_lag, traced_loop
from wspd_design.certificates.checks.region import (
    fuzzy_sector,
    lpv_lyapunov,
    sampled_invariance,
    slip_band,
    slip_limit,
)
from wspd_design.certificates.checks.sliding import (
    boundary_layer,
    holding_torque,
    lyapunov_surface,
    reaching,
    sliding_exists,
)
from wspd_design.certificates.checks.stop import overshoot, stop_bound, tracking
from wspd_design.certificates.checks.valve import hard_limits, no_go, open_loop_pole, sampling
from wspd_design.certificates.memory import remembering
from wspd_design.certificates.records import Certificate, Certificates, Problem
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.budget import DEFAULT_BUDGET, Budget, within
from wspd_design.certificates.search.progress import Listener, listening
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.controllers.offers import Linear
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.taken import check_record
from wspd_design.parameters.words import did_you_mean

CHECKS: Mapping[str, Check] = {
    each.name: each
    for each in (
        derivation.CHECK,
        feedback.CHECK,
        surface_hurwitz.CHECK,
        gain_positive.CHECK,
        well_posed.CHECK,
        holding_torque.CHECK,
        sliding_exists.CHECK,
        reaching.CHECK,
        boundary_layer.CHECK,
        lyapunov_surface.CHECK,
        lyapunov_printed.CHECK,
        lyapunov_repaired.CHECK,
        afsmc_energy.CHECK,
        barbalat.CHECK,
        open_loop_pole.CHECK,
        no_go.CHECK,
        hard_limits.CHECK,
        sampling.CHECK,
        routh_lag.CHECK,
        margins.CHECK,
        traced_loop.CHECK,
        lpv_lyapunov.CHECK,
        sampled_invariance.CHECK,
        slip_band.CHECK,
        slip_limit.CHECK,
        fuzzy_sector.CHECK,
        tracking.CHECK,
        overshoot.CHECK,
        conservation.CHECK,
        stop_bound.CHECK,
    )
}
NAMES = tuple(THEOREMS)


def verify(
    problem: Problem,
    *,
    only: Collection[str] | None = None,
    progress: Callable[[str], None] = lambda _: None,
    budget: Budget = DEFAULT_BUDGET,
    stored: Path | None = None,
    figures: bool = True,
    found: Callable[[Certificate], object] = lambda _: None,
) -> Certificates:
    """Run the checks.

    Parameters
    ----------
    problem : Problem
        Closed loop and domain.
    only : collection of str, optional
        Names of the checks to run, from ``NAMES``; all by default.
    progress : callable, optional
        Told the title of each check before it starts, and while it searches how far it has come.
    budget : Budget, optional
        Of each search; a claim on which it is used up stays undecided.
    stored : Path, optional
        Folder of certificate files. One that is accepted for this problem, and decides its claim, is not searched
        again.
    figures : bool
        Whether to sample the curves and maps that a report shows beside the verdicts.
    found : callable, optional
        Told each certificate as soon as it is there, for those who keep what is finished.

    Returns
    -------
    Certificates
        A tuple in the order of ``NAMES``.

    Raises
    ------
    UserError
        If a name is unknown, or problem and controller state different references or sample times.
    """
    remedy = "make one with stability_problem, or give the design to certify"
    check_record(problem, Problem, by="verify", remedy=remedy)
    if isinstance(only, str):
        raise UserError(f'only = "{only}" must be a list of names; write only=["{only}"]')
    for name in only or ():
        if name not in NAMES:
            raise UserError(
                f'unknown check "{name}"{did_you_mean(name, NAMES)}; available: {", ".join(NAMES)}'
            )
    _agree("sample time", problem.sample_time, problem.controller.sample_time)
    if isinstance(problem.controller, Linear):
        _agree("slip reference", problem.slip, problem.controller.slip_reference)
        _agree("wheel radius", problem.vehicle.wheel_radius, problem.controller.wheel_radius)
    wanted = [CHECKS[name] for name in NAMES if only is None or name in only]
    certificates = []
    with remembering():
        for check in wanted:
            certificates.append(_run(check, problem, progress, budget, stored, figures))
            found(certificates[-1])
    return Certificates(certificates)


def _run(
    check: Check,
    problem: Problem,
    progress: Callable[[str], None],
    budget: Budget,
    stored: Path | None,
    figures: bool,
) -> Certificate:
    progress(check.theorem.title)
    found = _accepted(check.name, problem, stored)
    if found is not None:
        return illustrated(check, problem, found) if figures else found
    with listening(_at(check.theorem.title, progress)), within(budget):
        return check.run(problem, figures=figures)


def _accepted(name: str, problem: Problem, folder: Path | None) -> Certificate | None:
    """Return what a file beside the design decides, if every word of it is accepted."""
    try:
        text = (folder / f"{name}.json").read_text(encoding="utf-8", errors="replace") if folder else ""
    except OSError:
        return None
    found = replay(problem, text)
    return None if found.unchecked or found.check != name else found.certificate


def _at(title: str, progress: Callable[[str], None]) -> Listener:
    return lambda share: progress(f"{title}: {share:.0%} of the box decided")


def _agree(name: str, stated: float, used: float) -> None:
    """Refuse a problem that speaks about another loop than its controller."""
    if stated != used:
        raise UserError(f"the problem states {name} {stated:g}, its controller {used:g}; make them the same")
