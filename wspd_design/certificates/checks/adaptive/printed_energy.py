"""Why (44) as printed is false: a state at which V2 of (43) rises, whatever the ideal weights."""

from collections.abc import Sequence

from wspd_design.certificates.checks.frame import level, series
from wspd_design.certificates.kernel.arb import Ball, ball, below, point
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Series, Status
from wspd_design.certificates.search.settle import versions
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, firing_strengths
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics

SPEEDS = 41


def refutation(problem: Problem, law: AdaptiveFuzzy) -> Certificate:
    """Refute (44) at a state with s = 0; the certificate is completed by :mod:`afsmc_energy`.

    Parameters
    ----------
    problem : Problem
        Its parameters are taken at their nominal values.
    law : AdaptiveFuzzy
        As the paper prints it, without dead zone.
    """
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    rates = [printed_rate(problem, law, float(v)) for v in speeds]
    lowest = [below(rate) for rate in rates]
    worst = max(range(SPEEDS), key=lowest.__getitem__)
    refuted = lowest[worst] > 0.0
    where = (
        Point(name="speed", value=float(speeds[worst]) * KMH, unit="km/h"),
        Point(name="slip", value=problem.slip, unit="-"),
        Point(name="integral of the slip error", value=0.0, unit="s"),
        Point(name="least dV2/dt", value=lowest[worst], unit="1/s"),
    )
    share = sum(value > 0.0 for value in lowest)
    return Certificate(
        name="afsmc_energy",
        title="afsmc_energy",
        claim="V2 of (43) falls along the printed law as (44) says, dV2/dt <= -G abs(s) (psi - abs(xi)), for some "
        "ideal weights and a psi that bounds the approximation error.",
        status=Status.REFUTED if refuted else Status.UNDECIDED,
        explanation=(
            f"With the slip at its reference, no integral and the initial weights and bound, s = 0 and (44) asks for "
            f"dV2/dt <= 0. At {where[0].value:.3g} km/h it is at least {lowest[worst]:.3g} 1/s, whatever the ideal "
            f"weights: (44) leaves out G'/2 times the squared errors, and G' > 0. The same happens at {share} of "
            f"{SPEEDS} speeds. With the dead zone and the held adaptation the repaired V gives bounds in its place."
            if refuted
            else "At s = 0 the initial weights and bound may be ideal ones, so that this point decides nothing."
        ),
        margin=Range(low=None, high=-lowest[worst], unit="1/s"),
        worst_point=where,
        witness=where if refuted else (),
        assumptions=(
            "T = u: no valve lag, no sampling, no limit of the brake torque, continuous adaptation",
            "nominal parameters",
            "initial weights and bound of the law",
        ),
        method="V2' at s = 0 in balls, minimized over all ideal weights and bounds that (34) admits",
        resolution=f"{SPEEDS} speeds",
        reference="eqs. (33), (34), (39)-(44); docs/theory.md#printed",
        engine=f"python-flint {versions()['python-flint']}",
        series=_plots((speeds * KMH).tolist(), lowest),
    )


def printed_rate(problem: Problem, law: AdaptiveFuzzy, speed: float) -> Ball:
    """Least dV2/dt at s = 0 over all admissible ideal weights and bounds [1/s].

    At s = 0 nothing adapts and V2' = (G'/2)(abs(b~)^2/alpha1 + psi~^2/alpha2) with G' = G a/v. (34) asks for
    psi >= abs(u* - b*'w). With the law's own w, b_hat and psi_hat the errors have to make up for
    d = abs(u* - b_hat'w) - psi_hat; the cheapest way costs d^2/(alpha1 abs(w)^2 + alpha2).
    """
    gains = law.gains
    plant = slip_dynamics(*exact_plant(problem), point(problem.slip), point(speed))
    ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, 0.0, 0.0) / gains.torque_unit
    strengths = firing_strengths(gains, point(0.0))
    fuzzy = sum((w * b for w, b in zip(strengths, gains.initial_weights, strict=True)), point(0.0))
    lacking = abs(ideal - fuzzy) - gains.initial_bound
    if not lacking > 0:
        return ball(0.0, 0.0)
    cost = lacking**2 / (gains.weight_rate * sum((w * w for w in strengths), point(0.0)) + gains.bound_rate)
    return plant.gain * plant.deceleration / speed / 2 * gains.torque_unit * cost


def _plots(speeds: Sequence[float], lowest: Sequence[float]) -> tuple[Series, ...]:
    import numpy as np

    axes = ("speed [km/h]", "dV2/dt at s = 0 [1/s]")
    return (
        series("at least, as printed", *axes, np.asarray(speeds), np.asarray(lowest)),
        level("at most, as (44) says", *axes, speeds, 0.0),
    )
